"""Colors of images from one space to another, as the OpenColorIO configuration of the running Blender has them."""

from typing import Any

import bpy
import numpy as np
import numpy.typing as npt

Colors = npt.NDArray[np.float32]


def scene_linear(colors: Colors, space: str) -> Colors:
    """Colors (height, width, 3) of a space that Blender knows by name. Blender converts an image of floats when it is
    told of which space its file is; a packed one has its file in memory."""
    height, width, _ = colors.shape
    b_image: Any = bpy.data.images.new("Colors", width, height, float_buffer=True, is_data=True)
    try:
        pixels = np.ones((height, width, 4), np.float32)
        pixels[..., :3] = colors
        b_image.pixels.foreach_set(pixels.reshape(-1))
        b_image.pack()
        b_image.colorspace_settings.name = space
        b_image.pixels.foreach_get(pixels.reshape(-1))
    finally:
        bpy.data.images.remove(b_image)
    return pixels[..., :3]


def srgb_encoded(linear: Colors) -> Colors:
    """The sRGB transfer function (IEC 61966-2-1), which goes on beyond 1."""
    curved = 1.055 * np.maximum(linear, 0.0031308) ** (1.0 / 2.4) - 0.055
    encoded: Colors = np.where(linear <= 0.0031308, 12.92 * linear, curved).astype(np.float32)
    return encoded
