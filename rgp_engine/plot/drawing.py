"""What a drawing is made of. Lengths are in pixels of the SVG, x to the right, y down."""

from dataclasses import dataclass, field
from typing import Literal

Color = tuple[int, int, int]
"""Red, green and blue of sRGB, 0 to 255."""

Point = tuple[float, float]
Anchor = Literal["start", "middle", "end"]


@dataclass(frozen=True)
class Line:
    """A line through points, with round ends and joints."""

    points: tuple[Point, ...]
    color: Color
    width: float = 1.0
    dash: float = 0.0
    """Length of its dashes and of the gaps between them; 0 for a line without gaps."""


@dataclass(frozen=True)
class Disc:
    """A filled circle."""

    center: Point
    radius: float
    color: Color


@dataclass(frozen=True)
class Box:
    """A filled rectangle."""

    corner: Point
    """Upper left."""
    size: Point
    color: Color


@dataclass(frozen=True)
class Text:
    """A line of ASCII text."""

    text: str
    at: Point
    """On the baseline: where the text starts, its middle, or where it ends."""
    size: float
    color: Color
    anchor: Anchor = "start"
    upwards: bool = False
    """Turned by a quarter, to be read from below to above."""


Item = Line | Disc | Box | Text


@dataclass
class Drawing:
    """Items in the order they are painted, on a ground of one color."""

    width: int
    height: int
    ground: Color = (255, 255, 255)
    items: list[Item] = field(default_factory=list)
