"""The sky of Hosek and Wilkie 2012, "An Analytic Model for Full Spectral Sky-Dome Radiance", in the version that its
authors fitted to red, green and blue."""

from collections.abc import Sequence

import numpy as np

from .color import Array
from .model import directions, picture, towards

Fitted = Sequence[tuple[Sequence[float], float]]
"""For each channel the parameters A to I of the distribution and the mean radiance, as the native core has them."""

# Blender's own: the model's radiance to luminance, over half a turn.
_SCALE = 2.0 * np.pi / 683.0


def hosek_wilkie(elevation: float, fitted: Fitted) -> Array:
    """Radiance of the sky (HEIGHT, WIDTH, 3); below the horizon only the distance from the sun counts."""
    seen = directions()
    cos_gamma = np.clip(seen @ towards(elevation), -1.0, 1.0)
    cos_theta = np.maximum(seen[..., 2], np.sin(1e-3))
    channels = [_radiance(np.array(of_shape), mean, cos_theta, cos_gamma) for of_shape, mean in fitted]
    return picture(_SCALE * np.maximum(np.stack(channels, axis=-1), 0.0))


def _radiance(shape: Array, mean: float, cos_theta: Array, cos_gamma: Array) -> Array:
    """Equation 8, times the mean radiance."""
    a, b, c, d, e, f, g, i, h = shape
    gamma = np.arccos(cos_gamma)
    around_sun = (1.0 + cos_gamma**2) / (1.0 + h * h - 2.0 * h * cos_gamma) ** 1.5
    of_sun = c + d * np.exp(e * gamma) + f * cos_gamma**2 + g * around_sun + i * np.sqrt(cos_theta)
    radiance: Array = mean * (1.0 + a * np.exp(b / (cos_theta + 0.01))) * of_sun
    return radiance
