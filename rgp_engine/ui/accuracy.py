"""Render properties: what accuracy costs in time."""

from typing import Any

from bpy.types import Panel

from ..accuracy import background
from ..accuracy.figure import IMAGE_NAME, cells
from ..accuracy.quality import Quality
from ..accuracy.result import Sweep
from ..report import last_outcome
from ..settings import core_settings
from ..stats import clock
from .base import ClosedEnginePanel

_HEADS = ("Error", "Time", "Rays", "Samples", "Photons", "Finest", "Bins")


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
            _draw_front(layout, last.sweep, Quality.of(core_settings(context.scene)))
            layout.operator("rgp.show_accuracy", icon="IMAGE_DATA")
            layout.label(text=f"The plot is the image '{IMAGE_NAME}'")


def _draw_last_render(layout: Any) -> None:
    """The error of the last render, where it was measured."""
    outcome = last_outcome()
    error = outcome.stats.get("error") if outcome else None
    if outcome and error:
        seconds = outcome.stats["seconds"]["total"]
        layout.label(text=f"Last render: {error['rms_mean']:.2g} % in {seconds:.3g} s", icon="RENDER_STILL")


def _draw_progress(layout: Any, sweep: Sweep | None) -> None:
    row = layout.row(align=True)
    text = f"{clock(sweep.seconds_left)} left" if sweep else "Starting"
    row.progress(factor=sweep.fraction if sweep else 0.0, type="BAR", text=text)
    row.operator("rgp.stop_accuracy", text="", icon="X")
    if sweep:
        layout.label(text=sweep.message[:1].upper() + sweep.message[1:])


def _draw_front(layout: Any, sweep: Sweep, current: Quality) -> None:
    """One line for each settings worth their time, with a button that applies them."""
    heads = _HEADS if sweep.is_glossy else _HEADS[:-1]
    column = layout.box().column(align=True)
    _draw_line(column, list(heads)).label(text="", icon="BLANK1")
    for index, row in enumerate(sweep.front):
        line = _draw_line(column, cells(row, is_glossy=sweep.is_glossy)[: len(heads)])
        is_current = row.quality == current
        icon = "CHECKMARK" if is_current else "IMPORT"
        line.operator("rgp.apply_accuracy", text="", icon=icon, emboss=not is_current).row = index
    layout.label(text=f"Less the noise of the reference, {sweep.reference['noise']:.2g} %")


def _draw_line(column: Any, texts: list[str]) -> Any:
    line = column.row(align=True)
    grid = line.grid_flow(columns=len(texts), even_columns=True, align=True, row_major=True)
    for text in texts:
        grid.label(text=text)
    return line


CLASSES = (RGP_PT_accuracy,)
