"""Values against values: axes, grid, lines, points, labels."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import hypot

from .drawing import Anchor, Box, Color, Disc, Drawing, Item, Line, Point, Text
from .font import text_width
from .scale import Scale, number_text, scale_of

BLUE: Color = (0, 98, 168)
ORANGE: Color = (214, 94, 0)
GREEN: Color = (0, 138, 100)
PURPLE: Color = (150, 70, 150)
GREY: Color = (150, 155, 162)

_INK: Color = (38, 42, 48)
_FAINT_INK: Color = (105, 110, 118)
_FRAME: Color = (165, 170, 176)
_GRID: Color = (229, 231, 234)
_PAPER: Color = (255, 255, 255)

_LEFT, _RIGHT, _TOP, _BOTTOM = 68, 26, 62, 58
_TITLE, _TEXT, _SMALL = 17, 13, 12
_TICK = 5
_STEP = 4


@dataclass(frozen=True)
class Axis:
    """One side of a chart."""

    title: str
    is_log: bool = True
    ticks: Sequence[float] | None = None
    """Values that are marked; None for round ones."""


@dataclass(frozen=True)
class Label:
    """A word at a point of a series."""

    text: str
    at: Point


@dataclass(frozen=True)
class Series:
    """Points that belong together."""

    points: Sequence[Point]
    color: Color = BLUE
    name: str = ""
    """In the legend; empty for none."""
    radius: float = 4.0
    """Of its points in pixels; 0 for none."""
    width: float = 0.0
    """Of the line through them; 0 for none."""
    labels: Sequence[Label] = ()


@dataclass(frozen=True)
class Level:
    """A dashed line across the chart at a value of y."""

    value: float
    text: str
    color: Color = GREY


@dataclass(frozen=True)
class Chart:
    """What is drawn."""

    title: str
    x: Axis
    y: Axis
    series: Sequence[Series]
    levels: Sequence[Level] = ()
    note: str = ""
    """Small print under the title."""


def draw_chart(chart: Chart, width: int = 800, height: int = 500) -> Drawing:
    """The chart in pixels of the SVG. It must have a point; values on logarithmic axes must be positive."""
    return _Sheet(chart, width, height).draw()


@dataclass
class _Sheet:
    """A chart while it is drawn."""

    chart: Chart
    width: int
    height: int
    taken: list[Box] = field(default_factory=list)
    """Where no more text fits."""

    def __post_init__(self) -> None:
        points = [point for series in self.chart.series for point in series.points]
        levels = [level.value for level in self.chart.levels]
        self.x = _scale(self.chart.x, [x for x, _ in points])
        self.y = _scale(self.chart.y, [*(y for _, y in points), *levels])

    def draw(self) -> Drawing:
        chart = self.chart
        drawing = Drawing(self.width, self.height, _PAPER)
        drawing.items += [*self._grid(), *self._frame()]
        for level in chart.levels:
            drawing.items += self._level(level)
        for series in chart.series:
            drawing.items += self._lines(series)
        for series in chart.series:
            drawing.items += self._points(series)
        for series in chart.series:
            for label in series.labels:
                drawing.items += self._label(label, series)
        drawing.items += [*self._titles(), *self._legend()]
        return drawing

    def at(self, point: Point) -> Point:
        """Where a point of the chart stands in the drawing."""
        right, bottom = self.width - _RIGHT, self.height - _BOTTOM
        x, y = self.x.place(point[0]), self.y.place(point[1])
        return (_LEFT + x * (right - _LEFT), bottom - y * (bottom - _TOP))

    def _grid(self) -> Iterable[Item]:
        bottom, right = self.height - _BOTTOM, self.width - _RIGHT
        for value in _ticks(self.chart.x, self.x):
            x, _ = self.at((value, self.y.low))
            yield Line(((x, _TOP), (x, bottom)), _GRID)
            yield Line(((x, bottom), (x, bottom + _TICK)), _FRAME)
            yield Text(number_text(value), (x, bottom + _TICK + _SMALL + 2), _SMALL, _INK, "middle")
        for value in _ticks(self.chart.y, self.y):
            _, y = self.at((self.x.low, value))
            yield Line(((_LEFT, y), (right, y)), _GRID)
            yield Line(((_LEFT - _TICK, y), (_LEFT, y)), _FRAME)
            yield Text(number_text(value), (_LEFT - _TICK - 4, y + 0.36 * _SMALL), _SMALL, _INK, "end")

    def _frame(self) -> Iterable[Item]:
        bottom, right = self.height - _BOTTOM, self.width - _RIGHT
        yield Line(((_LEFT, _TOP), (_LEFT, bottom), (right, bottom)), _FRAME)

    def _titles(self) -> Iterable[Item]:
        middle = (_LEFT + self.width - _RIGHT) / 2
        yield Text(self.chart.title, (_LEFT, 27), _TITLE, _INK)
        yield Text(self.chart.note, (_LEFT, 47), _SMALL, _FAINT_INK)
        yield Text(self.chart.x.title, (middle, self.height - 14), _TEXT, _INK, "middle")
        yield Text(
            self.chart.y.title, (20, (_TOP + self.height - _BOTTOM) / 2), _TEXT, _INK, "middle", upwards=True
        )

    def _legend(self) -> Iterable[Item]:
        """In one row above the chart's right end."""
        x = float(self.width - _RIGHT)
        for series in reversed([series for series in self.chart.series if series.name]):
            x -= text_width(series.name, _SMALL)
            yield Text(series.name, (x, 27), _SMALL, _INK)
            if series.width:
                yield Line(((x - 22, 23), (x - 6, 23)), series.color, series.width)
            yield Disc((x - 14, 23), min(series.radius, 5.0), series.color)
            x -= 40

    def _level(self, level: Level) -> Iterable[Item]:
        _, y = self.at((self.x.low, level.value))
        right = self.width - _RIGHT
        yield Line(((_LEFT, y), (right, y)), level.color, 1.0, dash=5.0)
        text = Text(level.text, (right - 4, y - 5), _SMALL, level.color, "end")
        self.taken.append(_extent(text))
        self._keep_free((_LEFT, y), (right, y))
        yield text

    def _lines(self, series: Series) -> Iterable[Item]:
        if series.width and len(series.points) > 1:
            points = tuple(map(self.at, series.points))
            for a, b in pairwise(points):
                self._keep_free(a, b)
            yield Line(points, series.color, series.width)

    def _keep_free(self, a: Point, b: Point) -> None:
        """No label may stand on the line from a to b."""
        steps = max(round(hypot(b[0] - a[0], b[1] - a[1]) / _STEP), 1)
        for step in range(steps + 1):
            x, y = (start + (end - start) * step / steps for start, end in zip(a, b, strict=True))
            self.taken.append(Box((x - 1, y - 1), (2, 2), _PAPER))

    def _points(self, series: Series) -> Iterable[Item]:
        for x, y in map(self.at, series.points):
            if series.radius:
                yield Disc((x, y), series.radius, series.color)
                edge = series.radius + 1
                self.taken.append(Box((x - edge, y - edge), (2 * edge, 2 * edge), series.color))

    def _label(self, label: Label, series: Series) -> Iterable[Item]:
        """The label on the first side of its point where it covers nothing; on the last where none is free."""
        x, y = self.at(label.at)
        gap = series.radius + 5
        sides: list[tuple[float, float, Anchor]] = [
            (x + gap, y - gap, "start"),
            (x + gap, y + 0.36 * _SMALL, "start"),
            (x - gap, y + gap + 0.6 * _SMALL, "end"),
            (x - gap, y + 0.36 * _SMALL, "end"),
            (x, y - gap - 2, "middle"),
            (x, y + gap + 0.8 * _SMALL, "middle"),
            (x + 2 * gap, y - 3 * gap, "start"),
        ]
        for at_x, at_y, anchor in sides:
            text = Text(label.text, (at_x, at_y), _SMALL, series.color, anchor)
            extent = _extent(text)
            if self._is_inside(extent) and not any(_overlap(extent, other) for other in self.taken):
                break
        self.taken.append(extent)
        yield text

    def _is_inside(self, box: Box) -> bool:
        (x, y), (width, height) = box.corner, box.size
        return (
            x >= _LEFT
            and x + width <= self.width - _RIGHT
            and y >= _TOP
            and y + height <= self.height - _BOTTOM
        )


def _scale(axis: Axis, values: Sequence[float]) -> Scale:
    return scale_of([*values, *(axis.ticks or ())], is_log=axis.is_log)


def _ticks(axis: Axis, scale: Scale) -> Sequence[float]:
    return scale.ticks() if axis.ticks is None else axis.ticks


def _extent(text: Text) -> Box:
    """The rectangle a level text covers."""
    width = text_width(text.text, text.size)
    x, y = text.at
    left = x - {"start": 0.0, "middle": 0.5, "end": 1.0}[text.anchor] * width
    return Box((left - 2, y - 0.8 * text.size), (width + 4, text.size), text.color)


def _overlap(a: Box, b: Box) -> bool:
    return all(
        a.corner[axis] < b.corner[axis] + b.size[axis] and b.corner[axis] < a.corner[axis] + a.size[axis]
        for axis in (0, 1)
    )
