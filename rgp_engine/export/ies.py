"""Measured luminaires: the IES files (IESNA LM-63 of 1986 to 2002) of IES Texture nodes, read as Cycles does."""

import functools
import math
import re
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import bpy
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float32]

UNREADABLE = 100.0
"""What Cycles takes for the intensity in every direction where there is no file to read."""

_WATTS_PER_CANDELA = 4.0 * math.pi / 177.83
"""Power (W) of a lamp of 1 cd to all sides; 177.83 lm/W is the luminous efficacy of D65."""

# Larger files are not read; there is room for a table of half a degree by a quarter of one.
_MOST_BYTES = 1 << 24
_MOST_INTENSITIES = 1 << 20

_TILT = re.compile(rb"^TILT=(INCLUDE)?", re.MULTILINE)
# Candela multiplier, and factors of ballast and lamp, which multiply all intensities.
_FACTORS = (2, 10, 11)
_TYPE_C, _TYPE_B, _TYPE_A = 1, 2, 3


class IesError(Exception):
    """No table of intensities; the message says why, after the name of the file."""


class Web(NamedTuple):
    """Intensities by direction. Vertical angles are counted from -z, horizontal ones around z from -y; none falls."""

    horizontal: Array
    """Angles (rad)."""
    vertical: Array
    """Angles (rad)."""
    intensity: Array
    """Power (W) of a lamp that shines to all sides as to this one: a row for each horizontal angle."""

    @property
    def mean(self) -> float:
        """Intensity in the mean of all directions."""
        around = np.diff(np.clip(self.horizontal, 0.0, 2.0 * math.pi))
        along = -np.diff(np.cos(np.clip(self.vertical, 0.0, math.pi)))
        values = np.maximum(self.intensity, 0.0).astype(np.float64)
        rows = values[1:] + values[:-1]
        corners = 0.25 * (rows[:, 1:] + rows[:, :-1])
        return float(around @ corners @ along) / (4.0 * math.pi)

    def record(self) -> dict[str, list[float]]:
        """The core's PhotometricWeb. What it takes beyond the edges are the choices of Cycles since Blender 5.0: past
        the pole at -z the other side, past other vertical angles the last one again; past horizontal ones the lower end
        of the first and last interval, since 360 degrees as it rounds them are not seen to be a whole turn."""
        values, from_pole = self.intensity, self.vertical[0] < 1e-7
        below = values[:, :2][:, -1:] if from_pole else values[:, :1]
        rows = np.concatenate([below, values, values[:, -1:]], axis=1)
        padded = np.concatenate([rows[:1], rows, rows[-2:][:1]])
        return {
            "horizontal": self.horizontal.tolist(),
            "vertical": self.vertical.tolist(),
            "intensity": padded.ravel().tolist(),
        }


def web_of(b_node: Any) -> Web:
    """The table an IES Texture node names. Raises IesError."""
    if b_node.mode == "INTERNAL":
        if b_node.ies is None:
            raise IesError("it has no text")
        name, content = f'the text "{b_node.ies.name}"', b_node.ies.as_string().encode(errors="replace")
    else:
        if not b_node.filepath:
            raise IesError("it has no file")
        path = Path(bpy.path.abspath(b_node.filepath, library=b_node.id_data.library))
        name, content = f'the file "{path}"', _content(path)
    try:
        return read(content)
    except IesError as error:
        raise IesError(f"{name} cannot be read: {error}") from None


def _content(path: Path) -> bytes:
    try:
        if path.is_file():
            with path.open("rb") as file:
                return file.read(_MOST_BYTES + 1)
    except (OSError, ValueError):
        pass
    raise IesError(f'the file "{path}" cannot be read')


@functools.lru_cache(maxsize=4)
def read(content: bytes) -> Web:
    """The table in a file. What its angles leave out by symmetry is filled in; a tilt is skipped. Raises IesError."""
    if len(content) > _MOST_BYTES:
        raise IesError("it is too large")
    words = _words(content)
    header = words.numbers(13)
    counts = [_whole(header[i]) for i in (3, 4)]
    if min(counts) < 1 or math.prod(counts) > _MOST_INTENSITIES:
        raise IesError(f"it has {counts[0]:g} vertical and {counts[1]:g} horizontal angles")
    vertical, horizontal = (_angles(words.numbers(count)) for count in counts)
    watts = np.array(words.numbers(math.prod(counts)))
    with np.errstate(over="ignore", invalid="ignore"):
        watts *= _WATTS_PER_CANDELA * math.prod(header[i] for i in _FACTORS)
        intensity = watts.astype(np.float32).reshape(len(horizontal), len(vertical))
    if not np.isfinite(intensity).all():
        raise IesError("its intensities are beyond all numbers")
    arrange = {_TYPE_A: _from_type_a, _TYPE_B: _from_type_b, _TYPE_C: _from_type_c}.get(_whole(header[5]))
    if arrange is None:
        raise IesError(f"its photometric type is {header[5]:g}, not 1, 2 or 3")
    horizontal, vertical, intensity = arrange(horizontal, vertical, intensity)
    radian = np.float32(math.pi) / np.float32(180.0)
    return Web(horizontal * radian, vertical * radian, intensity)


class _Words:
    """What is left to read, word by word."""

    def __init__(self, words: list[bytes]) -> None:
        self._words = words
        self._read = 0

    def numbers(self, count: int) -> list[float]:
        """The next `count` numbers."""
        words = self._words[self._read : self._read + count]
        if len(words) < count:
            raise IesError("it ends too early")
        self._read += count
        return [_number(word) for word in words]


def _words(content: bytes) -> _Words:
    """From the number of lamps on."""
    tilt = _TILT.search(content)
    if tilt is None:
        raise IesError('it has no line that begins with "TILT="')
    if tilt[1] is None:
        _, _, rest = content[tilt.end() :].partition(b"\n")
        return _Words(rest.replace(b",", b" ").split())
    words = _Words(content[tilt.end() :].replace(b",", b" ").split())
    _, count = words.numbers(2)
    words.numbers(2 * max(0, _whole(count)))
    return words


def _number(word: bytes) -> float:
    try:
        number = float(word)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise IesError(f'"{word[:20].decode(errors="replace")}" is no number')
    return number


def _whole(number: float) -> int:
    if not number.is_integer():
        raise IesError(f"{number:g} is no whole number")
    return int(number)


def _angles(degrees: list[float]) -> Array:
    if max(map(abs, degrees)) > 1e6 or any(b < a for a, b in pairwise(degrees)):
        raise IesError("its angles do not rise")
    return np.array(degrees, np.float32)


def _is_close(a: float, b: float) -> bool:
    return abs(a - b) < 1e-4


def _from_type_a(horizontal: Array, vertical: Array, intensity: Array) -> tuple[Array, Array, Array]:
    """Horizontal angles from the forward direction, which is +y, to both sides; vertical ones from the horizon."""
    around, rows = 180.0 - horizontal[::-1], intensity[::-1]
    if _is_close(horizontal[0], 0.0):
        around = np.concatenate([around, 180.0 + horizontal[1:]])
        rows = np.concatenate([rows, intensity[1:]])
    return around, vertical + 90.0, rows


def _from_type_b(horizontal: Array, vertical: Array, intensity: Array) -> tuple[Array, Array, Array]:
    """A horizontal axis; Cycles takes it for the vertical one."""
    around, rows = _both_sides(vertical, intensity.T)
    along, columns = _both_sides(horizontal, rows.T)
    return around, along, columns.T


def _both_sides(angles: Array, rows: Array) -> tuple[Array, Array]:
    """Angles from -90 or, where one side is the mirror image of the other, 0 to 90 degrees as such from 0 to 180."""
    if not _is_close(angles[0], 0.0):
        return angles + 90.0, rows
    return np.concatenate([90.0 - angles[:0:-1], 90.0 + angles]), np.concatenate([rows[:0:-1], rows])


def _from_type_c(horizontal: Array, vertical: Array, intensity: Array) -> tuple[Array, Array, Array]:
    """One plane, a quarter or half of all planes, or all of them, of which some files leave out the last."""
    around, rows = horizontal, intensity
    if _is_close(around[0], 90.0):
        around = around - 90.0
    if len(around) == 1:
        around, rows = np.array([0.0, 360.0], np.float32), np.concatenate([rows, rows])
    for end in (90.0, 180.0):
        if _is_close(around[-1], end):
            around = np.concatenate([around, 2.0 * end - around[-2::-1]])
            rows = np.concatenate([rows, rows[-2::-1]])
    gap = 360.0 - around[-1]
    steps = (around[1] - around[0], around[-1] - around[-2])
    if _is_close(around[0], 0.0) and gap >= 1e-4 and any(_is_close(step, gap) for step in steps):
        around, rows = np.append(around, np.float32(360.0)), np.concatenate([rows, rows[:1]])
    return around, vertical, rows
