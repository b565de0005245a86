"""The pixels of images, and their average, which stands for an image where one value is asked for."""

from typing import Any

import numpy as np
import numpy.typing as npt

from .arithmetic import Color

# Larger images are not read: 8192 x 8192.
_MOST_PIXELS = 1 << 26
# Rows and columns that are looked at, evenly spread.
_MAX_SAMPLES = 256
_ENCODED = ("sRGB", "Filmic sRGB")


def pixels_of(b_image: Any) -> npt.NDArray[np.float32] | None:
    """Pixels of an image (height, width, channels), rows from the bottom, as the file has them; None when it is missing
    or very large."""
    width, height = b_image.size
    channels = b_image.channels
    if not (width and height and channels) or width * height > _MOST_PIXELS:
        return None
    pixels = np.empty(width * height * channels, np.float32)
    b_image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, channels)


def average(b_image: Any, is_sphere: bool = False) -> tuple[Color, float] | None:
    """Mean color (linear) and alpha of an image; None when its file is missing or it is very large.

    With `is_sphere` rows count by the solid angle they cover in an equirectangular panorama.
    """
    pixels = pixels_of(b_image)
    if pixels is None:
        return None
    height, width, channels = pixels.shape
    step_y, step_x = -(-height // _MAX_SAMPLES), -(-width // _MAX_SAMPLES)
    samples = pixels[step_y // 2 :: step_y, step_x // 2 :: step_x]
    if not b_image.is_float and b_image.colorspace_settings.name in _ENCODED:
        samples[..., :3] = _linear(samples[..., :3])
    rows = samples.mean(axis=1, dtype=np.float64)
    weights = np.sin((np.arange(len(rows)) + 0.5) * (np.pi / len(rows))) if is_sphere else None
    mean = np.average(rows, axis=0, weights=weights)
    if channels < 3:
        mean = np.repeat(mean[:1], 3)
    alpha = float(mean[3]) if channels > 3 else 1.0
    return (float(mean[0]), float(mean[1]), float(mean[2])), alpha


def _linear(encoded: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Undoes the sRGB transfer function (IEC 61966-2-1)."""
    linear: npt.NDArray[np.float32] = np.where(
        encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4
    )
    return linear
