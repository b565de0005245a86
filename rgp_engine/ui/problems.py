"""Render properties: what the last render reported and measured."""

from typing import Any

from bpy.types import Panel

from ..report import last_outcome
from ..stats import rows
from .base import ClosedEnginePanel, EnginePanel

_MAX_PROBLEMS = 50


class RGP_PT_problems(EnginePanel, Panel):
    """Problems the last render met."""

    bl_label = "Problems"
    bl_context = "render"

    def draw_header(self, _context: Any) -> None:
        """Shows a sign when there is something to read."""
        outcome = last_outcome()
        if outcome and (outcome.error or outcome.problems):
            self.layout.label(icon="ERROR")

    def draw(self, _context: Any) -> None:
        """Draws the panel."""
        outcome = last_outcome()
        column = self.layout.column(align=True)
        if outcome is None:
            column.label(text="Nothing rendered yet")
            return
        if outcome.error:
            column.label(text=outcome.error, icon="CANCEL")
        for problem in outcome.problems[:_MAX_PROBLEMS]:
            times = f" ({problem.count} times)" if problem.count > 1 else ""
            column.label(text=f"{problem.subject}: {problem.message}{times}", icon="DOT")
        if len(outcome.problems) > _MAX_PROBLEMS:
            column.label(text=f"and {len(outcome.problems) - _MAX_PROBLEMS} more")
        if not outcome.error and not outcome.problems:
            column.label(text="None in the last render")


class RGP_PT_statistics(ClosedEnginePanel, Panel):
    """Figures of the last render."""

    bl_label = "Last Render"
    bl_context = "render"

    def draw(self, _context: Any) -> None:
        """Draws the panel."""
        outcome = last_outcome()
        if outcome is None or not outcome.stats:
            self.layout.label(text="No statistics yet")
            return
        column = self.layout.box().column(align=True)
        for label, value in rows(outcome.stats):
            split = column.split(factor=0.45)
            split.label(text=label)
            split.label(text=value)


CLASSES = (RGP_PT_problems, RGP_PT_statistics)
