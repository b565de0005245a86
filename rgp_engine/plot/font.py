"""A stroke font for printable ASCII: letters as lines, drawn with a round pen of any width."""

from functools import cache
from itertools import pairwise

from .drawing import Point

Polyline = tuple[Point, ...]

# A glyph is a list of strokes, a stroke a list of points: two digits each, x to the right and y up. The baseline is
# y = 2, small letters end at 7, capitals at 9. A stroke of straight lines stands as it is; "~" marks a curve (a
# quadratic B-spline) from the first point to the last, "@" a closed one. A point twice is a dot.
_GLYPHS = {
    " ": "", "!": "0904 0202", '"': "0907 2927", "#": "1218 3238 0444 0646",
    "$": "~4849090645420203 2921", "%": "0259 @07272909 @32525434", "&": "~5218092949041242 4254",
    "'": "0907", "(": "~29060320", ")": "~09262300", "*": "2529 0638 0836", "+": "0545 2327", ",": "1201",
    "-": "0535", ".": "0202", "/": "0149", ":": "0202 0606", ";": "1201 1616", "<": "470543", "=": "0444 0646",
    ">": "074503", "?": "~0809494625 2524 2222", "@": "@23535636 ~535464693909040242", "[": "29090020", "\\": "0941",
    "]": "09292000", "^": "072947", "_": "0141", "`": "0918", "{": "~291916 1505 ~151020", "|": "0900",
    "}": "~091916 1525 ~151000", "~": "~04084347",
    "0": "@02424909", "1": "173932", "2": "~0709494602 0242", "3": "~0809494626 ~2646420203", "4": "32390444",
    "5": "490906 ~061747420203", "6": "~4849090242460604", "7": "094912", "8": "@06464909 @02424606",
    "9": "~0302424909054547",
    "A": "022942 1535", "B": "0209 0929 ~29494626 0626 ~26464222 2202", "C": "~484909024243",
    "D": "0209 0919 ~19494212 1202", "E": "49090242 0636", "F": "490902 0636", "G": "~484909024245 4525",
    "H": "0209 4249 0646", "I": "0209", "J": "3934 ~34320204", "K": "0209 4905 1642", "L": "090242",
    "M": "0209254942", "N": "02094249", "O": "@02525909", "P": "0209 0929 ~29494525 2505",
    "Q": "@02525909 3451", "R": "0209 0929 ~29494525 2505 2542", "S": "~4849090645420203", "T": "0949 2922",
    "U": "0905 ~05024245 4549", "V": "092249", "W": "0912375269", "X": "0942 0249", "Y": "0925 4925 2522",
    "Z": "09490242",
    "a": "@02424707 4742", "b": "0902 @02424707", "c": "~464707024243", "d": "4942 @02424707",
    "e": "0545 ~454707024243", "f": "~391917 1712 0737", "g": "@02424707 4742 ~42400001", "h": "0902 ~04074744 4442",
    "i": "0702 0909", "j": "1712 ~121000 1919", "k": "0902 4704 1542", "l": "0904 ~040212",
    "m": "0702 ~04073734 3432 ~34376764 6462", "n": "0702 ~04074744 4442", "o": "@02424707", "p": "0700 @02424707",
    "q": "4740 @02424707", "r": "0702 ~040737", "s": "~4647070544420203", "t": "1913 ~131232 0737",
    "u": "0705 ~05024245 4742", "v": "072247", "w": "0712375267", "x": "0742 0247", "y": "0722 4710", "z": "07470242",
}  # fmt: skip

_CAP_HEIGHT = 7
_SPACE_WIDTH = 2
_GAP = 1.9
_BASELINE = 2
_UNKNOWN = "0249 0942"

# Height of capitals and width of a unit, for a text of size 1.
_HEIGHT = 0.72
_UNIT = 0.092

_STEPS = 6


def text_width(text: str, size: float) -> float:
    """Width of a text, as long as the text is set in the stroke font."""
    return _UNIT * size * max(sum(_width(letter) + _GAP for letter in text) - _GAP, 0.0)


def text_strokes(text: str, size: float) -> list[Polyline]:
    """Lines of a text that starts at the origin, x to the right and y down."""
    strokes: list[Polyline] = []
    left = 0.0
    unit = (_UNIT * size, -_HEIGHT * size / _CAP_HEIGHT)
    for letter in text:
        strokes += [
            tuple(((left + x) * unit[0], (y - _BASELINE) * unit[1]) for x, y in stroke)
            for stroke in _strokes(letter)
        ]
        left += _width(letter) + _GAP
    return strokes


def _width(letter: str) -> float:
    if letter == " ":
        return _SPACE_WIDTH
    return max(x for stroke in _strokes(letter) for x, _ in stroke)


@cache
def _strokes(letter: str) -> tuple[Polyline, ...]:
    """Lines of a letter, in units of the table."""
    return tuple(_stroke(code) for code in _GLYPHS.get(letter, _UNKNOWN).split())


def _stroke(code: str) -> Polyline:
    digits = code.lstrip("~@")
    points = tuple((float(x), float(y)) for x, y in zip(digits[::2], digits[1::2], strict=True))
    if code.startswith("~"):
        return _curve(points)
    if code.startswith("@"):
        # The curve runs from the middle of one side to the middle of the next.
        first = _between(points[0], points[-1])
        return _curve((first, *points, first))
    return points


def _curve(controls: Polyline) -> Polyline:
    """A quadratic B-spline from the first control point to the last."""
    inner = controls[1:-1]
    joints = [controls[0], *(_between(a, b) for a, b in pairwise(inner)), controls[-1]]
    points = [controls[0]]
    for (a, b), control in zip(pairwise(joints), inner, strict=True):
        for step in range(1, _STEPS + 1):
            t = step / _STEPS
            points.append(_between(_between(a, control, t), _between(control, b, t), t))
    return tuple(points)


def _between(a: Point, b: Point, t: float = 0.5) -> Point:
    return (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t)
