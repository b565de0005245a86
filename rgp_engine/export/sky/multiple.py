"""Light scattered often by the atmosphere: four wavelengths, and a fit of what is scattered more than once (Garcia
Linan, "Spectral Sky", 2024), as Blender 5 has it."""

import numpy as np

from .color import Array, rgb_from_xyz
from .model import Air, Sun, directions, length_to, picture, towards

_EARTH, _THICKNESS = 6371.0, 100.0  # km
_TOP = _EARTH + _THICKNESS
_STEPS = 64
_G = 0.8
_GROUND_ALBEDO = 0.3
# At 630, 560, 490 and 430 nm: sunlight above the atmosphere, scattering by molecules at sea level (km^-1) and cross
# sections of ozone and of aerosols.
_SUNLIGHT = np.array([1.679, 1.828, 1.986, 1.307])
_MOLECULES = np.array([6.605e-3, 1.067e-2, 1.842e-2, 3.156e-2])
_OZONE = 334.5 * np.array([3.472e-25, 3.914e-25, 1.349e-25, 11.03e-27])
_AEROSOL_ABSORPTION = np.array([2.8722e-24, 4.6168e-24, 7.9706e-24, 1.3578e-23])
_AEROSOL_SCATTERING = np.array([1.5908e-22, 1.7711e-22, 2.0942e-22, 2.4033e-22])
_AEROSOL_DENSITY, _AEROSOL_BACKGROUND, _AEROSOL_HEIGHT = 1.3681e20, 2e6, 0.73
_MULTIPLE = 0.02 * np.array([0.217, 0.347, 0.594, 1.0])
_XYZ = np.array(
    [
        [53.38691774, 22.98133751, 0.0],
        [43.90484447, 71.34779570, 0.1025069679],
        [1.613727825, 18.42296059, 31.74292119],
        [20.76266867, 2.361421352, 110.4800964],
    ]
)
# Cosines and heights at which the way to the sun is computed.
_COSINES, _HEIGHTS = 256, 64


def multiple_scattering(elevation: float, air: Air) -> Array:
    """Radiance of the sky and, below the horizon, of the ground's haze (HEIGHT, WIDTH, 3)."""
    seen, sun = directions(), towards(elevation)
    start = _EARTH + _altitude(air)
    length = _length(start, seen[..., 2])
    step = (length / _STEPS)[..., None]
    table = _table(air)
    cos = seen @ sun
    molecules_phase = (3.0 / (16.0 * np.pi) * (1.0 + cos * cos))[..., None]
    aerosol_phase = ((1.0 - _G**2) / (4.0 * np.pi * (1.0 + _G**2 - 2.0 * _G * cos) ** 1.5))[..., None]
    light, through = np.zeros((*seen.shape[:2], 4)), np.ones((*seen.shape[:2], 4))
    for i in range(_STEPS):
        place = np.array([0.0, 0.0, start]) + seen * ((i + 0.5) * step)
        from_middle = np.linalg.norm(place, axis=-1)
        height = np.maximum(from_middle - _EARTH, 0.0)
        to_sun = (place @ sun) / from_middle
        molecules, aerosol, extinction = _coefficients(height, air)
        direct = _look_up(table, to_sun, height / _THICKNESS)
        often = _scattered_often(table, to_sun, height / _THICKNESS, from_middle)
        source = molecules * (molecules_phase * direct + often) + aerosol * (aerosol_phase * direct + often)
        passed = np.exp(-step * extinction)
        light += through * source * _SUNLIGHT * (1.0 - passed) / np.maximum(extinction, 1e-7)
        through *= passed
    return picture(rgb_from_xyz(light @ _XYZ))


def multiple_sun(elevation: float, size: float, air: Air) -> Sun:
    """The sun's disk, of an angular diameter `size` (rad)."""
    solid_angle = 2.0 * np.pi * (1.0 - np.cos(0.5 * size))

    def color(height: float) -> Array:
        through = _transmittance(np.array(np.sin(height)), np.array(_altitude(air)), air)
        return rgb_from_xyz(_SUNLIGHT * through / solid_angle @ _XYZ)

    return Sun(color(elevation - 0.5 * size), color(elevation + 0.5 * size))


def _altitude(air: Air) -> float:
    """Where one stands (km)."""
    return min(max(air.altitude, 1.0), 99999.0) / 1000.0


def _length(start: float, sine: Array) -> Array:
    """Way to the ground, or out of the atmosphere (km)."""
    square = (start * sine) ** 2 - start**2 + _EARTH**2
    ground = -start * sine - np.sqrt(np.maximum(square, 0.0))
    return np.where((sine < 0.0) & (square >= 0.0), ground, length_to(_TOP, start, sine))


def _coefficients(height: Array, air: Air) -> tuple[Array, Array, Array]:
    """Scattering by molecules and by aerosols, and all that is lost (km^-1), by wavelength."""
    height = height[..., None]
    molecules = air.air * _MOLECULES * np.exp(-0.07771971 * height**1.16364243)
    log = np.log(np.maximum(height, 1e-4))
    ozone = air.ozone * _OZONE * 3.78547397e20 * np.exp(-((log - 3.22261) ** 2) * 5.55555555 - log)
    background = _AEROSOL_BACKGROUND / _AEROSOL_DENSITY
    aerosols = air.aerosol * _AEROSOL_DENSITY * (np.exp(-height / _AEROSOL_HEIGHT) + background)
    scattering = _AEROSOL_SCATTERING * aerosols
    return molecules, scattering, molecules + ozone + scattering + _AEROSOL_ABSORPTION * aerosols


def _transmittance(cos: Array, height: Array, air: Air) -> Array:
    """Share of light that comes through from outside under a cosine to the zenith, at a height (km)."""
    start = _EARTH + height
    step = length_to(_TOP, start, cos) / _STEPS
    depth = np.zeros((*np.broadcast(cos, height).shape, 4))
    for i in range(_STEPS):
        way = (i + 0.5) * step
        at = np.sqrt(start**2 + way**2 + 2.0 * start * way * cos)
        depth += _coefficients(np.maximum(at - _EARTH, 0.0), air)[2] * step[..., None]
    return np.exp(-depth)


def _table(air: Air) -> Array:
    """Transmittance by height and cosine."""
    heights = np.linspace(0.0, _THICKNESS, _HEIGHTS)[:, None]
    return _transmittance(np.linspace(-1.0, 1.0, _COSINES)[None], heights, air)


def _look_up(table: Array, cos: Array, height: Array) -> Array:
    x = np.clip(cos * 0.5 + 0.5, 0.0, 1.0) * (_COSINES - 1)
    y = np.clip(height, 0.0, 1.0) * (_HEIGHTS - 1)
    x0, y0 = np.minimum(x.astype(int), _COSINES - 2), np.minimum(y.astype(int), _HEIGHTS - 2)
    s, t = (x - x0)[..., None], (y - y0)[..., None]
    low = table[y0, x0] * (1.0 - s) + table[y0, x0 + 1] * s
    high = table[y0 + 1, x0] * (1.0 - s) + table[y0 + 1, x0 + 1] * s
    found: Array = low * (1.0 - t) + high * t
    return found


def _scattered_often(table: Array, cos: Array, height: Array, from_middle: Array) -> Array:
    """What comes from all sides, by the ground and by the air."""
    planet = 2.0 * np.pi * (1.0 - np.sqrt(np.maximum(1.0 - (_EARTH / from_middle) ** 2, 0.0)))
    zero, up = np.zeros_like(cos), np.ones_like(cos)
    to_place = _look_up(table, up, zero) / _look_up(table, up, height)
    shine = (planet * _GROUND_ALBEDO / (4.0 * np.pi * np.pi) * cos)[..., None]
    ground = shine * _look_up(table, cos, zero) * to_place
    often: Array = ground + _MULTIPLE / (1.0 + 5.0 * np.exp(-17.92 * cos))[..., None]
    return often
