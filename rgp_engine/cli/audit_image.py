"""Draws the cells that an audit found wrong over the picture."""

from pathlib import Path

import numpy as np

from ..files import whole_file
from ..plot import write_png
from . import CommandError
from .difference import display, exposure_of
from .exr import Picture

# Cells with too much light, and cells that lack it.
_TOO_BRIGHT, _TOO_DARK = (1.0, 0.1, 0.0), (0.0, 0.35, 1.0)
# Share of the color where a cell is hardly wrong.
_LEAST = 0.35


def draw_audit(path: Path, picture: Picture, audit: Picture) -> None:
    """Writes a PNG: the picture (height, width, 3) in gray, and in red what is too bright, in blue what is too dark.

    `audit` (height, width) is the part of the light that is wrong, from -1 to 1: the more, the stronger the color.
    """
    gray = display(picture.mean(axis=2, keepdims=True) * exposure_of(picture))
    color = np.where(audit[..., None] > 0.0, _TOO_BRIGHT, _TOO_DARK) * 255.0
    size = np.clip(np.abs(audit[..., None]), 0.0, 1.0)
    share = np.where(size > 0.0, _LEAST + (1.0 - _LEAST) * size, 0.0)
    pixels = (gray * (1.0 - share) + color * share + 0.5).astype(np.uint8)
    try:
        with whole_file(path) as part:
            write_png(part, pixels)
    except OSError as error:
        raise CommandError(f"{path} cannot be written: {error.strerror}") from error
