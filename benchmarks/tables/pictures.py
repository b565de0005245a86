"""The plots and the pictures of the results."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.tables.assemble import Renders
from benchmarks.tables.plan import PHOTON_MAP, PYRAMID, PYRAMID_2006, ScenePlan
from benchmarks.tables.store import Picture
from benchmarks.tables.subjects import Subject
from rgp_engine.cli.difference import draw_difference
from rgp_engine.plot import Axis, Chart, Label, Level, Series, draw_chart, to_svg
from rgp_engine.plot.chart import BLUE, GREEN, GREY, ORANGE, PURPLE

Rows = dict[str, dict[str, Any]]

# Of the paper's larger pictures.
_STRIP_PIXELS = 320


def draw_pictures(plan: ScenePlan, renders: Renders, folder: Path) -> None:
    """Table 4: the pyramid, the photon map and their difference."""
    ours, theirs = (_shrunk(renders[plan.timed[name]].indirect) for name in (PYRAMID, PHOTON_MAP))
    path = folder / f"table4_{plan.subject.name}.png"
    draw_difference(path, ours, theirs, titles=(PYRAMID, PHOTON_MAP, "difference"))


def draw_plots(subject: Subject, tables: dict[str, Rows], folder: Path) -> None:
    """The plots of one scene from its rows, by table and setting. Errors that are none have no place on their axes."""
    bins = _error_chart(subject, tables["table1"], "Direction bins", subject.published.rms_by_bins)
    grids = {str(finest): rms for finest, rms in subject.published.rms_by_finest.items()}
    finest = _error_chart(subject, tables["table2"], "Cells along the longest side", grids)
    charts = {"table1": bins, "table2": finest, "table3": _time_chart(subject, tables["table3"])}
    for name, chart in charts.items():
        (folder / f"{name}_{subject.name}.svg").write_text(to_svg(draw_chart(chart)), encoding="utf-8")


def _shrunk(picture: Picture) -> Picture:
    """Means of so many pixels that the picture fits."""
    height, width, _ = picture.shape
    step = max(round(width / _STRIP_PIXELS), 1)
    rows, columns = height // step, width // step
    blocks = picture[: rows * step, : columns * step].reshape(rows, step, columns, step, 3)
    return np.asarray(blocks.mean(axis=(1, 3), dtype=np.float64), np.float32)


def _error_chart(subject: Subject, rows: Rows, title: str, published: dict[str, float]) -> Chart:
    def points(estimator: str, kind: str) -> list[tuple[float, float]]:
        prefix = f"{estimator} "
        settings = [setting for setting in rows if setting.startswith(prefix)]
        found = [(_number(setting.removeprefix(prefix)), rows[setting][kind]) for setting in settings]
        return [(x, rms) for x, rms in found if rms > 0.0]

    series = [
        Series([(_number(value), rms) for value, rms in published.items()], GREY, "paper", width=1.5),
        *_lines(points, PYRAMID, BLUE, GREEN),
        *_lines(points, PYRAMID_2006, ORANGE, PURPLE),
    ]
    return Chart(
        title=subject.name,
        note=f"RMS of the indirect light, against the photon map unless it says truth; paper: {subject.published.name}",
        x=Axis(title, ticks=sorted({x for line in series for x, _ in line.points})),
        y=Axis("RMS (% of the brightest pixel)", is_log=True),
        series=series,
        levels=[Level(rows[PHOTON_MAP]["rms_truth"], "photon map against the truth")],
    )


def _lines(points: Any, estimator: str, against_photon_map: Any, against_truth: Any) -> Sequence[Series]:
    return [
        Series(points(estimator, "rms_paper"), against_photon_map, f"{estimator}", width=2.0),
        Series(points(estimator, "rms_truth"), against_truth, f"{estimator}, truth", width=2.0),
    ]


def _time_chart(subject: Subject, rows: Rows) -> Chart:
    series = [
        Series(
            [(row["seconds"], row["rms_truth"])],
            BLUE if setting.startswith(PYRAMID) else ORANGE if setting.startswith(PHOTON_MAP) else GREY,
            radius=5.0,
            labels=[Label(setting, (row["seconds"], row["rms_truth"]))],
        )
        for setting, row in rows.items()
        if row["rms_truth"] > 0.0
    ]
    return Chart(
        title=f"Time against error: {subject.name}",
        note="RMS of the indirect light against the truth",
        x=Axis("Photon pass, building and gather (s)"),
        y=Axis("RMS (% of the brightest pixel)"),
        series=series,
    )


def _number(setting: str) -> float:
    """Bins in all, or cells."""
    return float(np.prod([int(part) for part in setting.split("x")]))
