"""Coordinates and matrices on their way to the core."""

from typing import Any

import numpy as np
import numpy.typing as npt

# Its square is infinite in single precision. Blender stores an infinite coordinate as the largest finite number.
_TOO_FAR = 1e18


def mark_infinite(coordinates: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Makes coordinates too large to work with infinite, in place, so that the core leaves them out and says so."""
    too_far = np.abs(coordinates) > _TOO_FAR
    if too_far.any():
        coordinates[too_far] = np.inf
    return coordinates


def matrix_array(b_matrix: Any) -> npt.NDArray[np.float64]:
    """A 4 x 4 matrix that acts on column vectors."""
    return mark_infinite(np.array(b_matrix, np.float64))
