"""The error of a picture against a reference that is noisy itself."""

from dataclasses import dataclass
from math import sqrt

import numpy as np
import numpy.typing as npt

Picture = npt.NDArray[np.float32]

# Noise of neighboring pixels is alike, as the pixel filter shares their samples; that of blocks is not.
_BLOCK = 8
# An error is told from none when its square is this many times the standard error that noise gives to it.
_CERTAINTY = 2.0


@dataclass(frozen=True)
class Reference:
    """Two independent, unbiased pictures of the same, (height, width, 3)."""

    first: Picture
    second: Picture
    mean: float
    """Mean of the whole picture: what errors are percentages of."""

    @property
    def noise(self) -> float:
        """Noise of the mean of both, in percent."""
        half = (self.first.astype(np.float64) - self.second) / 2.0
        return float(100.0 * np.sqrt(np.mean(half**2)) / self.mean)

    @property
    def resolves(self) -> float:
        """Smallest error that is told from none, in percent.

        The noise of both halves gives `measured_error` a product of the two, which has no mean but spreads by the
        variance of a half, block by block.
        """
        variances = _block_means(((self.first.astype(np.float64) - self.second) ** 2 / 2.0).mean(axis=2))
        spread = np.sqrt(np.mean(variances**2) / variances.size)
        return float(100.0 * np.sqrt(_CERTAINTY * spread) / self.mean)


@dataclass(frozen=True)
class Error:
    """Root mean square error, % of the mean: `rms_mean` of the command `compare`, less the reference's noise."""

    percent: float
    is_limit: bool
    """The reference cannot tell it from a smaller one, down to none."""


def measured_error(picture: Picture, reference: Reference) -> Error:
    """Error of a picture whose noise is independent of the reference's, never below what the reference resolves.

    With halves A and B, `(picture - A)(picture - B)` has the mean of the squared true error: the noise of the reference
    drops out. That is the same as subtracting the noise of `(A + B) / 2` in quadrature.
    """
    a, b = (picture.astype(np.float64) - half for half in (reference.first, reference.second))
    square = max(float(np.mean(a * b)), 0.0)
    percent = 100.0 * sqrt(square) / reference.mean
    resolves = reference.resolves
    return Error(max(percent, resolves), is_limit=percent < resolves)


def _block_means(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Means of square blocks; the last ones of a row or column may be smaller."""
    for axis in (0, 1):
        starts = np.arange(0, values.shape[axis], _BLOCK)
        sizes = np.diff([*starts, values.shape[axis]])
        values = np.add.reduceat(values, starts, axis=axis) / np.expand_dims(sizes, 1 - axis)
    return values
