"""Color of a glowing body, as Blender's Blackbody node gives it: linear Rec. 709, luminance 1."""

import numpy as np

from .arithmetic import Color, luminance

# Planck's second radiation constant (nm K).
_C2 = 1.438776877e7
# XYZ to linear Rec. 709 (IEC 61966-2-1).
_RGB_FROM_XYZ = np.array(
    [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
)
_WAVELENGTHS = np.arange(380.0, 781.0, 10.0)
# Color matching functions of the CIE's standard observer of 1931 at these wavelengths (nm): x, y, z.
# fmt: off
_COLOR_MATCHING = np.array([
    [0.0014, 0.0042, 0.0143, 0.0435, 0.1344, 0.2839, 0.3483, 0.3362, 0.2908, 0.1954, 0.0956, 0.0320, 0.0049, 0.0093,
     0.0633, 0.1655, 0.2904, 0.4334, 0.5945, 0.7621, 0.9163, 1.0263, 1.0622, 1.0026, 0.8544, 0.6424, 0.4479, 0.2835,
     0.1649, 0.0874, 0.0468, 0.0227, 0.0114, 0.0058, 0.0029, 0.0014, 0.0007, 0.0003, 0.0002, 0.0001, 0.0000],
    [0.0000, 0.0001, 0.0004, 0.0012, 0.0040, 0.0116, 0.0230, 0.0380, 0.0600, 0.0910, 0.1390, 0.2080, 0.3230, 0.5030,
     0.7100, 0.8620, 0.9540, 0.9950, 0.9950, 0.9520, 0.8700, 0.7570, 0.6310, 0.5030, 0.3810, 0.2650, 0.1750, 0.1070,
     0.0610, 0.0320, 0.0170, 0.0082, 0.0041, 0.0021, 0.0010, 0.0005, 0.0003, 0.0001, 0.0001, 0.0000, 0.0000],
    [0.0065, 0.0201, 0.0679, 0.2074, 0.6456, 1.3856, 1.7471, 1.7721, 1.6692, 1.2876, 0.8130, 0.4652, 0.2720, 0.1582,
     0.0782, 0.0422, 0.0203, 0.0087, 0.0039, 0.0021, 0.0017, 0.0011, 0.0008, 0.0003, 0.0002, 0.0000, 0.0000, 0.0000,
     0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000],
])
# fmt: on


COOLEST, HOTTEST = 800.0, 12000.0
"""Temperatures (K) beyond which the color stays the same."""


def blackbody(temperature: float) -> Color:
    """Color of a black body at a temperature (K)."""
    kelvin = min(max(temperature, COOLEST), HOTTEST)
    radiance = _WAVELENGTHS**-5 / np.expm1(_C2 / (_WAVELENGTHS * kelvin))
    rgb = _RGB_FROM_XYZ @ (_COLOR_MATCHING @ radiance)
    red, green, blue = np.maximum(rgb / luminance(tuple(rgb)), 0.0).tolist()
    return red, green, blue
