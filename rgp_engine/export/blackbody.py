"""Color of a glowing body, as Blender's Blackbody node gives it: linear Rec. 709, luminance 1."""

import numpy as np
import numpy.typing as npt

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


def blackbody(temperature: float) -> Color:
    """Color of a black body at `temperature` (K), clamped to the node's 800 to 12000 K.

    Within 2 % of Blender's from 2500 K up; the color matching fit is coarser in the deep red.
    """
    kelvin = min(max(temperature, 800.0), 12000.0)
    wavelengths = np.arange(380.0, 781.0, 2.0)
    radiance = wavelengths**-5 / np.expm1(_C2 / (wavelengths * kelvin))
    rgb = _RGB_FROM_XYZ @ (_color_matching(wavelengths) @ radiance)
    red, green, blue = np.maximum(rgb / luminance(tuple(rgb)), 0.0).tolist()
    return red, green, blue


def _color_matching(wavelengths: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """CIE 1931 color matching functions (3, N): fits of Wyman, Sloan and Shirley, JCGT 2 (2013), section 2.2."""

    def lobe(center: float, left: float, right: float) -> npt.NDArray[np.float64]:
        sharpness = np.where(wavelengths < center, left, right)
        return np.asarray(np.exp(-0.5 * ((wavelengths - center) * sharpness) ** 2))

    x = (
        0.362 * lobe(442.0, 0.0624, 0.0374)
        + 1.056 * lobe(599.8, 0.0264, 0.0323)
        - 0.065 * lobe(501.1, 0.0490, 0.0382)
    )
    y = 0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322)
    z = 1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725)
    return np.array([x, y, z])
