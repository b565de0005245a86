"""What the models of the sky have in common. Directions are (..., 3), z up, the sun's azimuth along +X."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

WIDTH, HEIGHT = 256, 512
"""Texels of a picture of the sky: rows from the bottom. What changes quickly is the horizon."""

# Rows from the horizon to either pole, closer at the horizon, and columns from the sun to its other side.
_ROWS, _COLUMNS = 56, 49
# Rad.
_NEXT_TO_HORIZON = 1e-5


@dataclass(frozen=True)
class Air:
    """The atmosphere, and where in it one stands."""

    altitude: float
    """Above the sea (m)."""
    air: float
    """Density of molecules, 1 for clear air."""
    aerosol: float
    """Density of dust and droplets."""
    ozone: float
    """Density of ozone."""


@dataclass(frozen=True)
class Sun:
    """Radiance of the sun's disk, red, green and blue, before it darkens towards its limb."""

    bottom: Array
    """At its lowest point."""
    top: Array
    """At its highest point."""


def directions() -> Array:
    """Where the sky is computed, and then interpolated by `picture`: (2 `_ROWS`, `_COLUMNS`, 3), from the nadir to the
    horizon and from the horizon to the zenith, on one side of the sun."""
    rows = 0.5 * np.pi * (np.arange(_ROWS) / (_ROWS - 1)) ** 2
    rows[0] = _NEXT_TO_HORIZON
    elevation = np.concatenate([-rows[::-1], rows])
    azimuth = np.pi * np.arange(_COLUMNS) / (_COLUMNS - 1)
    elevation, azimuth = np.meshgrid(elevation, azimuth, indexing="ij")
    cos = np.cos(elevation)
    return np.stack([cos * np.cos(azimuth), cos * np.sin(azimuth), np.sin(elevation)], axis=-1)


def picture(colors: Array) -> Array:
    """The sky (HEIGHT, WIDTH, 3) from its colors in `directions`."""
    elevation = 0.5 - (np.arange(HEIGHT) + 0.5) / HEIGHT
    away = np.sqrt(2.0 * np.abs(elevation)) * (_ROWS - 1)
    # Rows on either side of the horizon stay apart.
    row = np.where(elevation > 0.0, _ROWS - 1 - away, _ROWS + away)
    first = np.where(elevation > 0.0, np.minimum(row.astype(int), _ROWS - 2), row.astype(int))
    first = np.minimum(first, 2 * _ROWS - 2)
    share = (row - first)[:, None, None]
    rows = colors[first] * (1.0 - share) + colors[first + 1] * share
    azimuth = np.abs(2.0 * (np.arange(WIDTH) + 0.5) / WIDTH - 1.0) * (_COLUMNS - 1)
    left = np.minimum(azimuth.astype(int), _COLUMNS - 2)
    share = (azimuth - left)[:, None]
    whole: Array = rows[:, left] * (1.0 - share) + rows[:, left + 1] * share
    return whole


def towards(elevation: float) -> Array:
    """The sun's direction."""
    return np.array([np.cos(elevation), 0.0, np.sin(elevation)])


def length_to(radius: float, height: Array | float, sine: Array | float) -> Array:
    """Way to a sphere about the earth's middle from inside of it, at a distance `height` from the middle, along a ray
    that rises with this sine; in the unit of both."""
    along = height * sine
    return np.asarray(-along + np.sqrt(along * along - height * height + radius * radius))
