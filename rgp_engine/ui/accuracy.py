"""Render properties: what accuracy costs in time."""

from typing import Any

from bpy.types import Panel, UIList

from ..accuracy import background
from ..accuracy.figure import IMAGE_NAME
from ..accuracy.quality import Quality
from ..accuracy.result import Sweep
from ..accuracy.text import described, error_text
from ..report import last_outcome
from ..settings import core_settings
from ..stats import clock
from .base import ClosedEnginePanel

_MIN_LINES, _MAX_LINES = 4, 12


class RGP_UL_accuracy(UIList):
    """Error, time and rays of settings worth their time."""

    def draw_item(
        self,
        context: Any,
        layout: Any,
        data: Any,
        item: Any,
        icon: Any,
        active: Any,
        name: Any,
        index: int = 0,
    ) -> None:
        """Draws a line."""
        front = background.front()
        if index >= len(front):
            return
        row = front[index]
        is_current = row.quality == Quality.of(core_settings(context.scene))
        line = layout.split(factor=0.4)
        line.label(text=error_text(row), icon="CHECKMARK" if is_current else "BLANK1")
        line = line.split(factor=0.45)
        line.label(text=f"{row.seconds:.3g} s")
        line.label(text=f"{row.quality.rays} rays")


class RGP_PT_accuracy(ClosedEnginePanel, Panel):
    """Accuracy against time."""

    bl_label = "Accuracy"
    bl_context = "render"

    def draw(self, context: Any) -> None:
        """Draws the panel."""
        layout = self.layout
        _draw_last_render(layout)
        last = background.last()
        if last is not None and last.is_running:
            _draw_progress(layout, last.sweep)
        else:
            row = layout.row(align=True)
            row.operator("rgp.measure_accuracy", text="Measure").is_quick = False
            row.operator("rgp.measure_accuracy", text="Quick").is_quick = True
            if last is not None and last.error:
                layout.label(text=last.error, icon="CANCEL")
        if last is not None and last.sweep is not None and last.sweep.rows:
            _draw_front(layout, last.sweep, context.window_manager.rgp_accuracy)


def _draw_last_render(layout: Any) -> None:
    """The error of the last render, where it was measured."""
    outcome = last_outcome()
    error = outcome.stats.get("error") if outcome else None
    if outcome and error:
        seconds = outcome.stats["seconds"]["total"]
        layout.label(
            text=f"Last render: {error['rms_clipped']:.2g} % in {seconds:.3g} s", icon="RENDER_STILL"
        )


def _draw_progress(layout: Any, sweep: Sweep | None) -> None:
    row = layout.row(align=True)
    text = f"{clock(sweep.seconds_left)} left" if sweep else "Starting"
    row.progress(factor=sweep.fraction if sweep else 0.0, type="BAR", text=text)
    row.operator("rgp.stop_accuracy", text="", icon="X")
    if sweep:
        layout.label(text=sweep.message[:1].upper() + sweep.message[1:])


def _draw_front(layout: Any, sweep: Sweep, b_list: Any) -> None:
    """The list, the chosen settings in full, and the buttons."""
    front = sweep.front
    lines = min(max(len(front), _MIN_LINES), _MAX_LINES)
    layout.template_list("RGP_UL_accuracy", "", b_list, "rows", b_list, "chosen", rows=lines, sort_lock=True)
    if b_list.chosen < len(front):
        column = layout.column(align=True)
        for name, value in described(front[b_list.chosen], is_glossy=sweep.is_glossy):
            split = column.split(factor=0.6)
            split.label(text=name)
            split.label(text=value)
    layout.operator("rgp.apply_accuracy", icon="CHECKMARK")
    layout.operator("rgp.show_accuracy", icon="IMAGE_DATA")
    layout.label(text=f"The plot is the image '{IMAGE_NAME}'")


CLASSES = (RGP_UL_accuracy, RGP_PT_accuracy)
