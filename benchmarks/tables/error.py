"""Errors in the paper's metric: root mean square, in percent of the brightest pixel of the photon map's picture."""

from dataclasses import dataclass
from math import sqrt

import numpy as np
import numpy.typing as npt

from benchmarks.tables.store import Picture

Pair = tuple[Picture, Picture]

# Noise of neighboring pixels is alike, as the pixel filter shares their samples; that of blocks is not.
_BLOCK = 8


def peak(picture: Picture) -> float:
    """The brightest channel of all pixels."""
    return float(picture.max())


@dataclass(frozen=True)
class Truth:
    """The converged picture, known from two independent noisy halves."""

    first: Picture
    second: Picture

    def rms(self, picture: Picture, unit: float) -> float:
        """Root mean square error of a picture (% of `unit`).

        `(picture - first)(picture - second)` has the squared error as its mean: the noise of the halves does not
        correlate and drops out.
        """
        return self.systematic(picture, picture, unit)

    def systematic(self, picture: Picture, other: Picture, unit: float) -> float:
        """Root mean square of what two pictures of independent noise have wrong alike (% of `unit`).

        Of one picture's error times the other's against the other half, all noise drops out.
        """
        square = float(np.mean(self._squares((picture, other))))
        return 100.0 * sqrt(max(square, 0.0)) / unit

    def doubt(self, one: Pair, other: Pair, unit: float) -> float:
        """Root of twice the standard error of the difference of two squared errors (% of `unit`).

        Each is that of two pictures as in `systematic`, or of one picture twice as in `rms`. Errors whose squares
        differ by less than the square of this cannot be told apart.
        """
        blocks = _blocks((self._squares(one) - self._squares(other)).mean(axis=2))
        return 100.0 * sqrt(2.0 * float(np.std(blocks)) / sqrt(blocks.size)) / unit

    def noise(self, unit: float) -> float:
        """Noise of the mean of both halves (% of `unit`)."""
        return 100.0 * sqrt(float(np.mean(self._variance()))) / unit / sqrt(2.0)

    def resolves(self, unit: float) -> float:
        """Root of the standard error that noise gives to the square of `rms` (% of `unit`): smaller errors are not told
        from none."""
        blocks = _blocks(self._variance())
        return 100.0 * sqrt(sqrt(float(np.mean(blocks**2)) / blocks.size)) / unit

    def _squares(self, pictures: Pair) -> npt.NDArray[np.float64]:
        one, two = (
            [half - picture.astype(np.float64) for half in (self.first, self.second)] for picture in pictures
        )
        return np.asarray((one[0] * two[1] + one[1] * two[0]) / 2.0)

    def _variance(self) -> npt.NDArray[np.float64]:
        """Of the noise of a half, from one sample per channel (height, width)."""
        difference = self.first.astype(np.float64) - self.second
        return np.asarray((difference**2 / 2.0).mean(axis=2))


def _blocks(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Means of the blocks of a picture of one channel."""
    rows, columns = (max(size // _BLOCK, 1) for size in values.shape)
    parts = [np.array_split(row, columns, axis=1) for row in np.array_split(values, rows)]
    return np.array([[part.mean() for part in row] for row in parts])
