"""A sweep as a plot."""

from pathlib import Path

from ..files import whole_file
from ..plot import Axis, Chart, Label, Level, Series, draw_chart, number_text, rasterize, to_svg, write_png
from ..plot.chart import BLUE, GREY, ORANGE
from .front import TARGETS, Row, cheapest
from .result import Sweep

SVG, PNG = "accuracy.svg", "accuracy.png"
IMAGE_NAME = "RGP Accuracy"
"""Of the plot among Blender's images."""

_PIXELS_PER_UNIT = 2.0


def write_figure(sweep: Sweep, folder: Path) -> None:
    """Draws time against error of all rows into the folder. Raises OSError."""
    drawing = draw_chart(_chart(sweep))
    with whole_file(folder / SVG) as part:
        part.write_text(to_svg(drawing), encoding="utf-8")
    with whole_file(folder / PNG) as part:
        write_png(part, rasterize(drawing, _PIXELS_PER_UNIT))


def _chart(sweep: Sweep) -> Chart:
    front = [(row.seconds, row.error) for row in sweep.front]
    other = [(row.seconds, row.error) for row in sweep.rows]
    named = {id(row): row for target in TARGETS if (row := cheapest(sweep.rows, target))}
    labels = [Label(_short(row), (row.seconds, row.error)) for row in named.values()]
    series = [
        Series(other, GREY, "measured", 3.0),
        Series(front, BLUE, "worth its time", 4.5, 2.0, labels),
    ]
    current = [(row.seconds, row.error) for row in sweep.rows if row.quality == sweep.current]
    if current:
        series.append(Series(current, ORANGE, "current settings", 5.5))
    width, height = sweep.resolution
    lowest, highest = (function(row.error for row in sweep.rows) for function in (min, max))
    shown = [target for target in TARGETS if lowest / 2 < target < highest]
    return Chart(
        title=f"Accuracy against time: {sweep.scene}",
        note=f"{width} x {height} pixels, {sweep.threads} threads; "
        f"the reference's noise of {sweep.reference['noise']:.2g} % is subtracted",
        x=Axis("Time of the whole picture (s)"),
        y=Axis("Root mean square error (% of the mean)"),
        series=series,
        levels=[Level(target, f"{target:g} %") for target in shown],
    )


def _short(row: Row) -> str:
    quality = row.quality
    return f"{quality.rays} rays, {number_text(quality.photons)} photons"
