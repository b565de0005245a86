"""A drawing as pixels, with smooth edges."""

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from .drawing import Box, Color, Disc, Drawing, Item, Line, Point, Text
from .font import Polyline, text_strokes, text_width
from .png import Pixels

_Floats = npt.NDArray[np.float32]

# Width of the pen of a text of size 1, and the least of all, in pixels of the picture.
_PEN = 0.095
_THINNEST = 1.0


def rasterize(drawing: Drawing, scale: float = 1.0) -> Pixels:
    """Pixels (height, width, 3), rows from the top; `scale` pixels for each unit of the drawing."""
    size = (round(drawing.height * scale), round(drawing.width * scale))
    canvas = _Canvas(np.empty((*size, 3), np.float32), scale)
    canvas.pixels[:] = drawing.ground
    for item in drawing.items:
        canvas.paint(item)
    return (canvas.pixels + 0.5).astype(np.uint8)


def text_lines(text: Text) -> list[Polyline]:
    """The strokes of a text where they stand in its drawing."""
    width = text_width(text.text, text.size)
    back = {"start": 0.0, "middle": 0.5, "end": 1.0}[text.anchor] * width
    x, y = text.at
    strokes = text_strokes(text.text, text.size)
    if text.upwards:
        return [tuple((x + v, y - u + back) for u, v in stroke) for stroke in strokes]
    return [tuple((x + u - back, y + v) for u, v in stroke) for stroke in strokes]


class _Canvas:
    """Pixels that items are painted on."""

    def __init__(self, pixels: _Floats, scale: float) -> None:
        self.pixels = pixels
        self._scale = scale

    def paint(self, item: Item) -> None:
        if isinstance(item, Box):
            self._fill(item)
        elif isinstance(item, Disc):
            self._stroke([(item.center, item.center)], 2.0 * item.radius, item.color)
        elif isinstance(item, Line):
            lines = dashes(item.points, item.dash) if item.dash else [item.points]
            self._stroke(lines, item.width, item.color)
        else:
            self._stroke(text_lines(item), _PEN * item.size, item.color)

    def _fill(self, box: Box) -> None:
        x, y = (round(part * self._scale) for part in box.corner)
        right, bottom = (
            round((at + part) * self._scale) for at, part in zip(box.corner, box.size, strict=True)
        )
        self.pixels[max(y, 0) : max(bottom, 0), max(x, 0) : max(right, 0)] = box.color

    def _stroke(self, lines: Iterable[Polyline], width: float, color: Color) -> None:
        """Draws lines with a round pen. Where they touch, the color is laid on once."""
        scaled = [np.array(line, np.float32) * np.float32(self._scale) for line in lines if line]
        if not scaled:
            return
        radius = max(width * self._scale, _THINNEST) / 2
        every = np.concatenate(scaled)
        left, top = np.maximum(np.floor(every.min(axis=0) - radius - 1).astype(int), 0)
        right, bottom = np.ceil(every.max(axis=0) + radius + 1).astype(int)
        part = self.pixels[top : max(bottom, 0), left : max(right, 0)]
        if not part.size:
            return
        coverage = np.zeros(part.shape[:2], np.float32)
        for line in scaled:
            corner = np.array((left, top), np.float32)
            ends = line[1:] if len(line) > 1 else line
            for a, b in zip(line, ends):
                _cover(coverage, a - corner, b - corner, radius)
        part += coverage[..., None] * (np.array(color, np.float32) - part)


def _cover(coverage: _Floats, a: _Floats, b: _Floats, radius: float) -> None:
    """Raises the coverage of each pixel to the part of it that a line from `a` to `b` covers."""
    height, width = coverage.shape
    low = np.maximum(np.floor(np.minimum(a, b) - radius - 1).astype(int), 0)
    high = np.minimum(np.ceil(np.maximum(a, b) + radius + 1).astype(int), (width, height))
    window = coverage[low[1] : high[1], low[0] : high[0]]
    x = np.arange(low[0], low[0] + window.shape[1], dtype=np.float32)[None, :] + 0.5 - a[0]
    y = np.arange(low[1], low[1] + window.shape[0], dtype=np.float32)[:, None] + 0.5 - a[1]
    along = b - a
    length = float(along @ along)
    t = np.clip((x * along[0] + y * along[1]) / length, 0.0, 1.0) if length else np.float32(0.0)
    distance = np.hypot(x - t * along[0], y - t * along[1])
    np.maximum(window, np.clip(radius + 0.5 - distance, 0.0, 1.0), out=window)


def dashes(points: tuple[Point, ...], length: float) -> list[Polyline]:
    """Every other piece of a line that is cut into pieces of a length."""
    corners = np.array(points, np.float64)
    steps = np.hypot(*np.diff(corners, axis=0).T)
    at = np.concatenate([[0.0], np.cumsum(steps)])
    pieces = []
    for start in np.arange(0.0, at[-1], 2.0 * length):
        end = min(start + length, at[-1])
        inside = at[(at > start) & (at < end)]
        stations = np.array([start, *inside, end])
        xs, ys = (np.interp(stations, at, corners[:, axis]) for axis in (0, 1))
        pieces.append(tuple(zip(xs.tolist(), ys.tolist())))
    return pieces
