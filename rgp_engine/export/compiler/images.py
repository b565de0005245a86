"""Images as the core's textures."""

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..image import pixels_of

if TYPE_CHECKING:
    from .compiler import Compiler

_LINEAR = ("Non-Color", "Raw", "Linear", "Linear Rec.709", "Generic Data", "Utility - Raw")
_DATA = ("Non-Color", "Raw", "Generic Data", "Utility - Raw")


def texture_of(c: "Compiler", b_node: Any) -> int | None:
    """The core's number of a texture node's image, handed over when it is met first; None where it cannot be read."""
    b_image = b_node.image
    if b_image is None or b_image.source not in ("FILE", "GENERATED"):
        return None
    textures = c.context.textures
    key = b_image.name_full
    if key not in textures:
        pixels = image_pixels(b_image)
        index = None
        if pixels is not None:
            index = c.context.builder.add_texture(b_image.name, pixels, _encoding(c, b_image))
        textures[key] = index
    return textures[key]


def _encoding(c: "Compiler", b_image: Any) -> str:
    space = b_image.colorspace_settings.name
    if b_image.is_float or space in _LINEAR:
        return "linear"
    if space != "sRGB":
        c.context.log.add(b_image.name, f"the color space {space} is not supported yet; sRGB is used instead")
    return "srgb"


def image_pixels(b_image: Any) -> npt.NDArray[Any] | None:
    """Texels (height, width, 4), rows from the bottom, the color multiplied by alpha where the image says so: bytes or
    float as in the file. None when it is missing or too large."""
    values: npt.NDArray[Any] | None = pixels_of(b_image)
    if values is None:
        return None
    if not b_image.is_float:
        values = np.rint(values * 255.0).clip(0, 255).astype(np.uint8)
    texels = _four_channels(values)
    if b_image.alpha_mode == "NONE":
        texels[..., 3] = 1.0 if b_image.is_float else 255
    elif not b_image.is_float and _associates(b_image):
        _associate(texels)
    return texels


def _associates(b_image: Any) -> bool:
    return b_image.alpha_mode in ("STRAIGHT", "PREMUL") and b_image.colorspace_settings.name not in _DATA


def unassociates(b_node: Any) -> bool:
    """True where Blender divides the color by alpha again: when the alpha is used too."""
    b_alpha = next((b_socket for b_socket in b_node.outputs if b_socket.identifier == "Alpha"), None)
    return b_alpha is not None and b_alpha.is_linked and _associates(b_node.image)


def _four_channels(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    height, width, channels = values.shape
    if channels == 4:
        return values
    texels = np.full((height, width, 4), 1.0 if values.dtype == np.float32 else 255, values.dtype)
    texels[..., :3] = values[..., :3] if channels == 3 else values[..., :1]
    if channels == 2:
        texels[..., 3] = values[..., 1]
    return texels


def _associate(texels: npt.NDArray[np.uint8]) -> None:
    """Multiplies bytes by alpha, in place."""
    alpha = texels[..., 3:]
    if (alpha < 255).any():
        texels[..., :3] = texels[..., :3].astype(np.uint16) * alpha // 255
