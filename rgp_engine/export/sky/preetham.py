"""The sky of Preetham, Shirley and Smits 1999, "A Practical Analytic Model for Daylight"."""

import numpy as np

from .color import Array, rgb_from_xyz
from .model import directions, picture, towards

# Coefficients of Perez' formula, turbidity and constant, for Y, x and y.
_PEREZ = np.array(
    [
        [[0.1787, -1.4630], [-0.3554, 0.4275], [-0.0227, 5.3251], [0.1206, -2.5771], [-0.0670, 0.3703]],
        [[-0.0193, -0.2592], [-0.0665, 0.0008], [-0.0004, 0.2125], [-0.0641, -0.8989], [-0.0033, 0.0452]],
        [[-0.0167, -0.2608], [-0.0950, 0.0092], [-0.0079, 0.2102], [-0.0441, -1.6537], [-0.0109, 0.0529]],
    ]
)
# Chromaticity of the zenith: by powers of turbidity (2, 1, 0) and of the sun's angle from it (3, 2, 1, 0).
_ZENITH_X = np.array(
    [
        [0.00166, -0.00375, 0.00209, 0.0],
        [-0.02903, 0.06377, -0.03202, 0.00394],
        [0.11693, -0.21196, 0.06052, 0.25886],
    ]
)
_ZENITH_Y = np.array(
    [
        [0.00275, -0.00610, 0.00317, 0.0],
        [-0.04214, 0.08970, -0.04153, 0.00516],
        [0.15346, -0.26756, 0.06670, 0.26688],
    ]
)
# Blender's own: luminance to radiance.
_SCALE = 0.06


def preetham(elevation: float, turbidity: float) -> Array:
    """Radiance of the sky (HEIGHT, WIDTH, 3); below the horizon it is that of the horizon."""
    angle = 0.5 * np.pi - elevation
    chi = (4.0 / 9.0 - turbidity / 120.0) * (np.pi - 2.0 * angle)
    luminance = (4.0453 * turbidity - 4.9710) * np.tan(chi) - 0.2155 * turbidity + 2.4192
    powers = (turbidity ** np.arange(2, -1, -1), angle ** np.arange(3, -1, -1))
    zenith = [_SCALE * luminance, *(powers[0] @ table @ powers[1] for table in (_ZENITH_X, _ZENITH_Y))]
    seen = directions()
    gamma = np.arccos(np.clip(seen @ towards(elevation), -1.0, 1.0))
    theta = np.minimum(np.arccos(np.clip(seen[..., 2], -1.0, 1.0)), 0.5 * np.pi - 1e-3)
    luminance, x, y = (
        value * _perez(perez, theta, gamma) / _perez(perez, np.zeros(()), np.array(angle))
        for value, perez in zip(zenith, _PEREZ @ np.array([turbidity, 1.0]))
    )
    xyz = np.stack([x, y, 1.0 - x - y], axis=-1) * (luminance / y)[..., None]
    return picture(rgb_from_xyz(xyz))


def _perez(perez: Array, theta: Array, gamma: Array) -> Array:
    a, b, c, d, e = perez
    value: Array = (1.0 + a * np.exp(b / np.cos(theta))) * (
        1.0 + c * np.exp(d * gamma) + e * np.cos(gamma) ** 2
    )
    return value
