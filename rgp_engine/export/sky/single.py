"""Light scattered once by the atmosphere (Nishita et al. 1993), with the constants of Blender."""

import numpy as np

from .color import Array, rgb_from_xyz
from .model import Air, Sun, directions, length_to, picture, towards

_EARTH, _TOP = 6360e3, 6420e3  # radii (m)
_RAYLEIGH_HEIGHT, _MIE_HEIGHT = 8e3, 1.2e3  # at which densities fall to 1/e (m)
_MIE, _MIE_EXTINCTION, _G = 2e-5, 1.11 * 2e-5, 0.76  # per meter; anisotropy
_STEPS = 32
_STEP_NM = 20.0
# From 380 to 780 nm: sunlight above the atmosphere (W m^-2 nm^-1), Rayleigh scattering and absorption by ozone (m^-1).
_SUNLIGHT = np.array(
    [
        1.45757,
        1.56596,
        1.65148,
        1.71496,
        1.75798,
        1.78256,
        1.79095,
        1.78542,
        1.76816,
        1.74122,
        1.70647,
        1.66556,
        1.61993,
        1.57084,
        1.51932,
        1.46628,
        1.41246,
        1.35845,
        1.30475,
        1.25175,
        1.19976,
    ]
)
_RAYLEIGH = 1e-6 * np.array(
    [
        54.2482,
        44.1855,
        36.3515,
        30.1793,
        25.2632,
        21.3086,
        18.0984,
        15.4706,
        13.3028,
        11.5018,
        9.99557,
        8.72800,
        7.65514,
        6.74217,
        5.96134,
        5.29035,
        4.71116,
        4.20910,
        3.77218,
        3.39051,
        3.05592,
    ]
)
_OZONE = 1e-9 * np.array(
    [
        3.25127,
        5.85395,
        19.7719,
        73.0957,
        200.846,
        403.840,
        635.513,
        967.070,
        1547.97,
        2090.39,
        2461.28,
        2735.51,
        2151.26,
        1590.52,
        1123.56,
        735.276,
        464.501,
        330.961,
        225.126,
        148.791,
        168.286,
    ]
)
_RAYLEIGH_MIE_OZONE = np.stack([_RAYLEIGH, np.full(21, _MIE_EXTINCTION), _OZONE])
# Color matching functions of the CIE 1931 observer.
_XYZ = np.array(
    [
        [
            0.001368,
            0.01431,
            0.13438,
            0.34828,
            0.2908,
            0.09564,
            0.0049,
            0.06327,
            0.2904,
            0.5945,
            0.9163,
            1.0622,
            0.85445,
            0.4479,
            0.1649,
            0.04677,
            0.011359,
            0.002899,
            0.00069,
            0.000166,
            0.0000415,
        ],
        [
            0.000039,
            0.000396,
            0.004,
            0.023,
            0.06,
            0.13902,
            0.323,
            0.71,
            0.954,
            0.995,
            0.87,
            0.631,
            0.381,
            0.175,
            0.061,
            0.017,
            0.004102,
            0.001047,
            0.000249,
            0.00006,
            0.000015,
        ],
        [
            0.00645,
            0.06785,
            0.6456,
            1.74706,
            1.6692,
            0.81295,
            0.272,
            0.07825,
            0.0203,
            0.0039,
            0.00165,
            0.0008,
            0.00019,
            0.00002,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
        ],
    ]
).T
# Gauss-Laguerre quadrature of eight points, whose last lies within the atmosphere: place along the way and weight.
_ALONG = np.array(
    [
        0.00681118529,
        0.0361480711,
        0.0900434652,
        0.170668007,
        0.281836216,
        0.430340640,
        0.629627146,
        0.914525270,
    ]
)
_WEIGHTS = np.array(
    [
        0.0175089364,
        0.0413547739,
        0.0667883906,
        0.0950769881,
        0.128341637,
        0.170743020,
        0.232723335,
        0.356249049,
    ]
)


def single_scattering(elevation: float, air: Air) -> Array:
    """Radiance of the sky (HEIGHT, WIDTH, 3); below the horizon it fades to black."""
    scales = np.array([air.air, air.aerosol, air.ozone])
    seen = directions()
    below, looking = seen[: len(seen) // 2], seen[len(seen) // 2 :]
    sun = towards(elevation)
    start = _EARTH + min(max(air.altitude, 1.0), 59999.0)
    step: Array = length_to(_TOP, start, looking[..., 2]) / _STEPS
    spectrum = np.zeros((*looking.shape[:2], len(_RAYLEIGH)))
    depth = np.zeros((*looking.shape[:2], 3))
    phases = _phases(looking @ sun)
    for i in range(_STEPS):
        way: Array = looking * ((i + 0.5) * step)[..., None]
        place = way + np.array([0.0, 0.0, start])
        density = scales * _densities(np.linalg.norm(place, axis=-1) - _EARTH)
        depth += step[..., None] * density
        through = np.exp(-(depth + scales * _depth_to_sun(place, sun)) @ _RAYLEIGH_MIE_OZONE)
        scattered = (
            phases[..., :1] * density[..., :1] * _RAYLEIGH + phases[..., 1:] * density[..., 1:2] * _MIE
        )
        lit = np.logical_not(_in_shadow(place, sun))
        spectrum += through * scattered * (_SUNLIGHT * (lit * step)[..., None])
    rgb = rgb_from_xyz(spectrum @ _XYZ * _STEP_NM)
    # The ground shows the horizon, ever darker.
    fade = np.maximum(1.0 + 2.5 * below[..., 2:], 0.0) ** 3
    return picture(np.concatenate([rgb[:1] * fade, rgb]))


def single_sun(elevation: float, size: float, air: Air) -> Sun:
    """The sun's disk, of an angular diameter `size` (rad)."""
    solid_angle = 2.0 * np.pi * (1.0 - np.cos(0.5 * size))
    scales = np.array([air.air, air.aerosol, 0.0])

    def color(height: float) -> Array:
        sun = towards(max(height, 0.0))
        depth = _depth_to_sun(np.array([0.0, 0.0, _EARTH + air.altitude]), sun)
        spectrum = _SUNLIGHT * np.exp(-(scales * depth) @ _RAYLEIGH_MIE_OZONE) / solid_angle
        return rgb_from_xyz(spectrum @ _XYZ * _STEP_NM)

    return Sun(color(elevation - 0.5 * size), color(elevation + 0.5 * size))


def _densities(height: Array) -> Array:
    """Of molecules, aerosols and ozone (..., 3) at a height above the sea (m)."""
    ozone = np.maximum(1.0 - np.abs(height - 25e3) / 15e3, 0.0)
    return np.stack([np.exp(-height / _RAYLEIGH_HEIGHT), np.exp(-height / _MIE_HEIGHT), ozone], axis=-1)


def _phases(cos: Array) -> Array:
    """Of molecules and aerosols (..., 2)."""
    bend = 1.0 + cos * cos
    aerosol = 3.0 * (1.0 - _G**2) * bend / (8.0 * np.pi * (2.0 + _G**2))
    aerosol = aerosol / (1.0 + _G**2 - 2.0 * _G * cos) ** 1.5
    return np.stack([0.1875 / np.pi * bend, aerosol], axis=-1)


def _depth_to_sun(place: Array, sun: Array) -> Array:
    """Densities summed along the way to the sun (m)."""
    height = np.linalg.norm(place, axis=-1)
    length = length_to(_TOP, height, (place @ sun) / height)
    depth = np.zeros((*place.shape[:-1], 3))
    for along, weight in zip(_ALONG, _WEIGHTS):
        at = place + sun * (along * length)[..., None]
        depth += weight * _densities(np.linalg.norm(at, axis=-1) - _EARTH)
    return depth * length[..., None]


def _in_shadow(place: Array, sun: Array) -> Array:
    """Where the earth hides the sun."""
    along = place @ sun
    hidden: Array = (sun[2] < 0.0) & (along**2 >= (place**2).sum(axis=-1) - _EARTH**2)
    return hidden
