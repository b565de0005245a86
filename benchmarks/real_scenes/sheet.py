"""Pictures of both engines side by side, with how they differ."""

from pathlib import Path

import bpy
import numpy as np

from rgp_engine.cli.difference import display, exposure_of
from rgp_engine.cli.exr import Picture
from rgp_engine.plot import Pixels, write_png

from .measure import Comparison

RANGE = 0.5
"""Of the difference: where ours is brighter or darker by this part, its color is the strongest."""

_GAP = 4
_JPEG_QUALITY = 85

# Where a pixel is darker than this part of the mean, the difference is told as a part of that.
_DARKEST = 0.1

# Ours darker by RANGE and more, ... as bright, ... brighter.
_STOPS = (-1.0, -0.5, 0.0, 0.5, 1.0)
_COLORS = ((0.6, 0.9, 1.0), (0.1, 0.35, 0.9), (0.0, 0.0, 0.0), (0.85, 0.15, 0.1), (1.0, 0.9, 0.5))


def sheet(comparison: Comparison) -> Pixels:
    """Ours, Cycles', and ours less Cycles' as a part of Cycles' in false colors; both with one exposure.

    Ours is a single picture, as anyone would get it; Cycles' is the mean of two.
    """
    ours, theirs = comparison.ours.pictures[0], comparison.theirs.mean
    exposure = exposure_of(theirs)
    difference = false_color(relative_difference(comparison.ours.mean, theirs) / RANGE)
    gap = np.full((ours.shape[0], _GAP, 3), 255, np.uint8)
    panels = (display(ours * exposure), gap, display(theirs * exposure), gap, difference)
    return np.concatenate(panels, axis=1)


def relative_difference(ours: Picture, theirs: Picture) -> Picture:
    """Of the brightness of each pixel, as a part of theirs: (height, width)."""
    brightness, reference = ours.mean(axis=2), theirs.mean(axis=2)
    return np.asarray((brightness - reference) / np.maximum(reference, _DARKEST * reference.mean()))


def false_color(values: Picture) -> Pixels:
    """Values from -1 to 1 as colors."""
    channels = [np.interp(values, _STOPS, [color[i] for color in _COLORS]) for i in range(3)]
    return (np.stack(channels, axis=-1) * 255.0 + 0.5).astype(np.uint8)


def write_pictures(png: Path, jpeg: Path | None, pixels: Pixels) -> None:
    """Writes a picture as PNG, and as JPEG too where a path for it is given."""
    write_png(png, pixels)
    if jpeg is None:
        return
    height, width, _ = pixels.shape
    b_image = bpy.data.images.new(png.stem, width, height)
    try:
        rgba = np.ones((height, width, 4), np.float32)
        rgba[..., :3] = pixels[::-1] / 255.0
        b_image.pixels.foreach_set(rgba.ravel())
        b_image.file_format = "JPEG"
        b_image.save(filepath=str(jpeg), quality=_JPEG_QUALITY)
    finally:
        bpy.data.images.remove(b_image)
