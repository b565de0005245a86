"""OpenEXR files as arrays."""

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ..files import whole_file
from . import CommandError

Picture = npt.NDArray[np.float32]


def read(path: Path) -> Picture:
    """Red, green and blue of a file, rows from the top: (height, width, 3)."""
    channels = read_channels(path)
    for layer in ("", "Combined"):
        picture = layer_of(channels, layer, "RGB")
        if picture is not None:
            return picture
    raise CommandError(f"{path} has no channels R, G and B; it has {', '.join(sorted(channels))}")


def read_channels(path: Path) -> dict[str, Picture]:
    """Every channel of every part of a file, by its full name: (height, width)."""
    # Blender's own Python has no OpenEXR, and not every command needs it.
    import OpenEXR

    if not path.is_file():
        raise CommandError(f"{path} does not exist")
    try:
        with OpenEXR.File(str(path), separate_channels=True) as file:
            parts = [(part.name(), dict(part.channels)) for part in file.parts]
    except Exception as error:
        raise CommandError(f"{path} cannot be read as OpenEXR: {error}") from error
    if not parts or not all(part_channels for _, part_channels in parts):
        raise CommandError(f"{path} is not whole; the disk may have been full when it was written")
    channels = {}
    for part_name, part_channels in parts:
        for name, channel in part_channels.items():
            is_full = len(parts) == 1 or name.startswith(part_name)
            full_name = name if is_full else f"{part_name}.{name}"
            channels[full_name] = np.asarray(channel.pixels, np.float32)
    return channels


def layer_of(channels: dict[str, Picture], layer: str, letters: str) -> Picture | None:
    """The channels of one layer or pass, such as "Combined" with "RGBA"; None when they are not all there."""
    ending = f"{layer}." if layer else ""
    names = []
    for letter in letters:
        wanted = f"{ending}{letter}"
        found = [n for n in channels if n == wanted or (layer and n.endswith(f".{wanted}"))]
        if not found:
            return None
        names.append(found[0])
    return np.stack([channels[name] for name in names], axis=-1)


def write(path: Path, picture: Picture) -> None:
    """Writes an RGB or RGBA picture (height, width, channels), rows from the top, as 32-bit float."""
    import OpenEXR

    header: dict[str, Any] = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    name = "RGBA" if picture.shape[2] == 4 else "RGB"
    pixels = np.ascontiguousarray(picture, np.float32)
    try:
        with whole_file(path) as part:
            OpenEXR.File(header, {name: pixels}).write(str(part))
            _check_complete(part)
    except Exception as error:
        raise CommandError(f"{path} cannot be written: {error}") from error


def _check_complete(path: Path) -> None:
    """Raises OSError when the disk was too full: OpenEXR itself does not always say."""
    import OpenEXR

    try:
        OpenEXR.File(str(path)).channels()
    except Exception as error:
        raise OSError("the file is incomplete; is the disk full?") from error
