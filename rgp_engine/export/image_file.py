"""Images of several files: sequences, of which a node shows one, and UDIM tiles, which may be packed.

Blender hands out only the pixels it shows itself, so that each file is opened as an image of its own for a moment.
"""

import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import bpy

_NUMBER = re.compile(r"^(.*?)(\d+)(\D*)$")
"""The last digits of a file's name without its extension."""
_ROW = 10
"""Tiles in a row of the plane."""


def sequence_frame(b_user: Any, frame: int) -> int:
    """The file that a node shows of its image sequence at a frame of the scene, as Blender counts."""
    duration: int = b_user.frame_duration
    offset: int = b_user.frame_offset
    place: int = frame - b_user.frame_start + 1
    if b_user.use_cyclic and duration > 0:
        place = (place - 1) % duration + 1
    return min(max(place, 0), duration) + offset


def sequence_file(b_image: Any, number: int) -> str:
    """The path of one file of a sequence."""
    path = _path(b_image)
    folder, name = _split(path, "/\\")
    stem, extension = _split_extension(name)
    found = _NUMBER.match(stem)
    if found is None:
        return path
    before, digits, after = found.groups()
    return f"{folder}{before}{number:0{len(digits)}d}{after}{extension}"


def tile_files(b_image: Any) -> list[tuple[int, int, str]]:
    """Column, row and path of each tile."""
    files = []
    for b_tile in b_image.tiles:
        row, column = divmod(b_tile.number - 1001, _ROW)
        place = f"u{column + 1}_v{row + 1}"
        path = _path(b_image).replace("<UDIM>", str(b_tile.number)).replace("<UVTILE>", place)
        files.append((column, row, path))
    return files


@contextmanager
def unpacked(b_image: Any, path: str) -> Iterator[str]:
    """Where a file of an image can be read: itself, or a copy of what is packed under its name."""
    b_packed = next((b for b in b_image.packed_files if _absolute(b_image, b.filepath) == path), None)
    if b_packed is None:
        yield path
        return
    with tempfile.TemporaryDirectory(dir=bpy.app.tempdir) as folder:
        copy = Path(folder) / bpy.path.basename(path)
        copy.write_bytes(b_packed.packed_file.data)
        yield str(copy)


@contextmanager
def opened(b_like: Any, path: str) -> Iterator[Any | None]:
    """The image in a file, packed or not, read as another one is; None where it cannot be read."""
    with unpacked(b_like, path) as readable:
        try:
            b_image = bpy.data.images.load(readable)
        except RuntimeError:
            yield None
            return
        try:
            b_image.colorspace_settings.name = b_like.colorspace_settings.name
            b_image.alpha_mode = b_like.alpha_mode
            yield b_image
        finally:
            bpy.data.images.remove(b_image)


def _path(b_image: Any) -> str:
    return _absolute(b_image, b_image.filepath)


def _absolute(b_image: Any, path: str) -> str:
    return str(bpy.path.abspath(path, library=b_image.library))


def _split(path: str, separators: str) -> tuple[str, str]:
    end = max(path.rfind(separator) for separator in separators) + 1
    return path[:end], path[end:]


def _split_extension(name: str) -> tuple[str, str]:
    stem, dot, extension = name.rpartition(".")
    return (stem, dot + extension) if dot else (name, "")
