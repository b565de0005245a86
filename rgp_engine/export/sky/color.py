"""Colors of spectra."""

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

# XYZ to linear Rec. 709 (IEC 61966-2-1, white D65).
_RGB_FROM_XYZ = np.array(
    [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
)


def rgb_from_xyz(xyz: Array) -> Array:
    """Linear Rec. 709 colors (..., 3); what cannot be shown is cut off."""
    rgb: Array = np.maximum(xyz @ _RGB_FROM_XYZ.T, 0.0)
    return rgb
