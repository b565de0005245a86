"""The error of a picture against a reference that is noisy itself."""

from dataclasses import dataclass
from math import sqrt

import numpy as np
import numpy.typing as npt

Picture = npt.NDArray[np.float32]
_Floats = npt.NDArray[np.float64]

CLIPPED_AT = 8.0
"""Times the picture's mean: what is brighter is white in any case, and pixels at the edge of a lamp would drown
the error of all others. The same as in the statistics of a render."""

# Noise of neighboring pixels is alike, as they share samples and strata; that of blocks is not.
_BLOCK = 4
# An error is told from none when its square is this many times the standard error that noise gives to it.
_CERTAINTY = 2.0


@dataclass(frozen=True)
class Means:
    """Of the whole picture, of which a part is measured: what errors are percentages of."""

    mean: float
    clipped: float
    """Of the picture clipped at `CLIPPED_AT`."""

    @classmethod
    def of(cls, picture: Picture) -> "Means":
        """Those of a picture."""
        mean = float(picture.mean(dtype=np.float64))
        return cls(mean, float(np.minimum(picture, CLIPPED_AT * mean).mean(dtype=np.float64)))

    def clip(self, picture: Picture) -> _Floats:
        """The picture, clipped."""
        return np.minimum(picture, CLIPPED_AT * self.mean, dtype=np.float64)


@dataclass(frozen=True)
class Reference:
    """Two independent, unbiased pictures of the same, (height, width, 3)."""

    first: Picture
    second: Picture
    means: Means

    @property
    def noise(self) -> float:
        """Noise of the mean of both, clipped, in percent."""
        half = (self.means.clip(self.first) - self.means.clip(self.second)) / 2.0
        return float(100.0 * np.sqrt(np.mean(half**2)) / self.means.clipped)

    @property
    def resolves(self) -> float:
        """Smallest error that is told from none, in percent.

        The noise of both halves gives `measured_error` a product of the two, which has no mean but spreads by the
        variance of a half, block by block.
        """
        difference = self.means.clip(self.first) - self.means.clip(self.second)
        variances = _block_means((difference**2 / 2.0).mean(axis=2))
        spread = np.sqrt(np.mean(variances**2) / variances.size)
        return float(100.0 * np.sqrt(_CERTAINTY * spread) / self.means.clipped)


@dataclass(frozen=True)
class Error:
    """Error of a picture: `rms_clipped` of the command `compare` and of a render's statistics."""

    percent: float
    """Root mean square of the clipped picture, % of its mean."""
    is_limit: bool
    """The reference cannot tell it from a smaller one, down to none."""


def measured_error(picture: Picture, reference: Reference) -> Error:
    """Error of a picture whose noise is independent of the reference's, never below what the reference resolves.

    With halves A and B, `(picture - A)(picture - B)` has the mean of the squared true error: the noise of the reference
    drops out. That is the same as subtracting the noise of `(A + B) / 2` in quadrature.
    """
    clip = reference.means.clip
    a, b = (clip(picture) - clip(half) for half in (reference.first, reference.second))
    square = max(float(np.mean(a * b)), 0.0)
    percent, resolves = 100.0 * sqrt(square) / reference.means.clipped, reference.resolves
    return Error(max(percent, resolves), is_limit=percent < resolves)


def _block_means(values: _Floats) -> _Floats:
    """Means of square blocks; the last ones of a row or column may be smaller."""
    for axis in (0, 1):
        starts = np.arange(0, values.shape[axis], _BLOCK)
        sizes = np.diff([*starts, values.shape[axis]])
        values = np.add.reduceat(values, starts, axis=axis) / np.expand_dims(sizes, 1 - axis)
    return values
