"""Contact sheets: pictures of both engines side by side, ours on the left, each pair with its number in the table."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rgp_engine.plot.drawing import Drawing, Text
from rgp_engine.plot.png import Pixels
from rgp_engine.plot.raster import rasterize
from tests.render.pictures import Picture

EDGE = 64
"""Of each picture, pixels."""
COLUMNS = 6
_GAP, _LABEL = 8, 14
# What the mean of a picture is shown as: dark enough for what is brighter.
_EXPOSURE = 0.25


def contact_sheet(pairs: Sequence[tuple[str, Picture, Picture]]) -> Pixels:
    """Pairs of pictures with their labels, row by row."""
    width, height = 2 * EDGE + _GAP, EDGE + _LABEL + _GAP
    rows = -(-len(pairs) // COLUMNS)
    places = [(i % COLUMNS * width + _GAP // 2, i // COLUMNS * height) for i in range(len(pairs))]
    labels = [
        Text(label, (x, y + _LABEL - 3.0), 10.0, (0, 0, 0)) for (label, *_), (x, y) in zip(pairs, places)
    ]
    pixels = rasterize(Drawing(COLUMNS * width, rows * height, items=[*labels]))
    for (_, ours, theirs), (x, y) in zip(pairs, places):
        scale = _EXPOSURE / theirs.mean()
        for picture, left in ((ours, x), (theirs, x + EDGE)):
            pixels[y + _LABEL : y + _LABEL + EDGE, left : left + EDGE] = _shown(picture * scale)
    return pixels


def _shown(picture: Picture) -> Pixels:
    """As 8-bit sRGB (IEC 61966-2-1) of the size of a sheet's pictures, each pixel a square."""
    nearest = [np.arange(EDGE) * length // EDGE for length in picture.shape[:2]]
    linear = picture[np.ix_(*nearest)].clip(0.0, 1.0)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1.0 / 2.4) - 0.055)
    return (encoded * 255.0 + 0.5).astype(np.uint8)
