"""Images as the core's textures: single ones, one of a sequence, and UDIM tiles."""

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ..color_space import scene_linear, srgb_encoded
from ..image import pixels_of
from ..image_file import opened, sequence_file, sequence_frame, tile_files

if TYPE_CHECKING:
    from .compiler import Compiler

_LINEAR = ("Non-Color", "Raw", "Linear", "Linear Rec.709", "Generic Data", "Utility - Raw")
_DATA = ("Non-Color", "Raw", "Generic Data", "Utility - Raw")


def texture_of(c: "Compiler", b_node: Any) -> int | None:
    """The core's number of a texture node's image, handed over when it is met first; None where it cannot be read."""
    b_image = b_node.image
    if b_image is None:
        return None
    if b_image.source == "SEQUENCE":
        frame = sequence_frame(b_node.image_user, c.context.b_depsgraph.scene_eval.frame_current)
        return _texture_in(c, b_image, sequence_file(b_image, frame))
    if b_image.source not in ("FILE", "GENERATED"):
        return None
    textures = c.context.textures
    key = b_image.name_full
    if key not in textures:
        textures[key] = _add_texture(c, b_image, b_image.name)
    return textures[key]


def tiles_of(c: "Compiler", b_node: Any) -> list[dict[str, int]]:
    """The core's tiles of a texture node's image; none where it has no tiles that can be read."""
    b_image = b_node.image
    if b_image is None or b_image.source != "TILED":
        return []
    tiles = []
    for column, row, path in tile_files(b_image):
        texture = _texture_in(c, b_image, path)
        if texture is not None and column >= 0 and row >= 0:
            tiles.append({"column": column, "row": row, "texture": texture})
    return tiles


def _texture_in(c: "Compiler", b_image: Any, path: str) -> int | None:
    """The core's number of one file of an image of several."""
    textures = c.context.textures
    key = f"{b_image.name_full}\n{path}"
    if key not in textures:
        with opened(b_image, path) as b_file:
            textures[key] = None if b_file is None else _add_texture(c, b_file, b_image.name)
        if textures[key] is None:
            c.context.log.add(b_image.name, f'the file "{path}" cannot be read')
    return textures[key]


def _add_texture(c: "Compiler", b_image: Any, name: str) -> int | None:
    pixels = image_pixels(b_image)
    if pixels is None:
        return None
    _make_finite(c, name, pixels)
    index: int = c.context.builder.add_texture(name, pixels, _encoding(b_image))
    return index


def _encoding(b_image: Any) -> str:
    """Blender hands out floats as scene linear; bytes of other spaces than sRGB are made so."""
    if b_image.is_float:
        return "srgb" if _filtered_encoded(b_image) else "linear"
    return "srgb" if b_image.colorspace_settings.name == "sRGB" else "linear"


def _filtered_encoded(b_image: Any) -> bool:
    """True for floats that Cycles reads from the file itself, in sRGB, as from PNG files of 16 bits: between texels it
    interpolates what they are encoded as."""
    is_read = b_image.source == "FILE" and b_image.packed_file is None
    return is_read and b_image.colorspace_settings.name == "sRGB"


# The largest number of a half, which is what a pixel too bright for one becomes.
_BRIGHTEST_HALF = 65504.0


def _make_finite(c: "Compiler", name: str, pixels: npt.NDArray[Any]) -> None:
    """Replaces what is no finite number, in place, and says so."""
    bad = int(np.count_nonzero(~np.isfinite(pixels).all(axis=2)))
    if bad:
        np.nan_to_num(pixels, copy=False, nan=0.0, posinf=_BRIGHTEST_HALF, neginf=0.0)
        c.context.log.add(
            name,
            f"{bad} pixels are not finite numbers; 0 is used, or {_BRIGHTEST_HALF:.0f} for infinity",
        )


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
    space = b_image.colorspace_settings.name
    if b_image.is_float:
        if _filtered_encoded(b_image):
            _encode(texels, is_associated=_associates(b_image))
    elif space != "sRGB" and space not in _LINEAR:
        texels = _converted(texels, space, associates=_associates(b_image))
    elif _associates(b_image):
        _associate(texels)
    return texels


def _encode(texels: npt.NDArray[np.float32], is_associated: bool) -> None:
    """Encodes scene linear floats as sRGB, in place; alpha stays multiplied in where it is."""
    alpha = texels[..., 3:]
    shares: npt.NDArray[np.float32] = np.where(is_associated & (alpha > 0.0), alpha, 1.0).astype(np.float32)
    texels[..., :3] = srgb_encoded(texels[..., :3] / shares) * shares


def _converted(texels: npt.NDArray[np.uint8], space: str, associates: bool) -> npt.NDArray[np.float32]:
    """Bytes of another space as scene linear floats, beyond 1 too; the color multiplied by alpha where asked for."""
    linear = texels.astype(np.float32) / np.float32(255.0)
    linear[..., :3] = scene_linear(linear[..., :3], space)
    if associates:
        linear[..., :3] *= linear[..., 3:]
    return linear


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
