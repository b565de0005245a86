"""Render properties: the effects plan. What is computed and why, what each effect cost, and the switches."""

from collections.abc import Mapping
from typing import Any

from bpy.types import Panel

from ..report import last_outcome
from ..settings import setting_names
from ..stats import effect_answer, effect_costs, effect_label
from .base import ClosedEnginePanel, draw_settings


class RGP_PT_effects(ClosedEnginePanel, Panel):
    """A switch for each effect; below it what the last render found."""

    bl_label = "Effects"
    bl_context = "render"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        found = _last_plan()
        b_effects = context.scene.rgp.effects
        for name in setting_names(b_effects):
            draw_settings(self.layout, b_effects, name)
            if name in found:
                self.layout.label(text=effect_answer(found[name]), icon="BLANK1")


class RGP_PT_effect_costs(ClosedEnginePanel, Panel):
    """What each effect of the last render cost."""

    bl_label = "Effects"
    bl_context = "render"
    bl_parent_id = "RGP_PT_statistics"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True when there is a plan to show."""
        return super().poll(context) and bool(_last_plan())

    def draw(self, _context: Any) -> None:
        """Draws the panel."""
        column = self.layout.column(align=True)
        for effect in (effect for effect in _last_plan().values() if effect["computed"]):
            for label, cost in zip((effect_label(effect), ""), effect_costs(effect)):
                split = column.split(factor=0.65)
                split.label(text=label)
                split.label(text=cost)


def _last_plan() -> dict[str, Mapping[str, Any]]:
    """The effects of the last render by name; empty where there is none."""
    outcome = last_outcome()
    effects = outcome.stats.get("effects", ()) if outcome else ()
    return {effect["name"]: effect for effect in effects}


CLASSES = (RGP_PT_effects, RGP_PT_effect_costs)
