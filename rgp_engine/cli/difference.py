"""Draws two pictures and their difference side by side."""

from math import ceil
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ..plot import Drawing, Pixels, Text, rasterize, text_width, write_png
from . import CommandError
from .exr import Picture

_GAP = 8
_BAR_HEIGHT = 12
_TEXT_SIZE, _TEXT_HEIGHT = 13, 18
_BACKGROUND = 32

# Difference / scale -1 .. 1 and its color: A darker than B is blue, A brighter is red.
_STOPS = (-1.0, -0.5, 0.0, 0.5, 1.0)
_COLORS = ((0.6, 0.9, 1.0), (0.1, 0.35, 0.9), (0.0, 0.0, 0.0), (0.85, 0.15, 0.1), (1.0, 0.9, 0.5))


def draw_difference(
    path: Path, picture: Picture, reference: Picture, titles: tuple[str, str, str] = ("A", "B", "A-B")
) -> None:
    """Writes a PNG: A, B, and A - B in false colors with a scale bar in percent of the brightest pixel of B."""
    peak = float(np.nanmax(np.where(np.isfinite(reference), reference, np.nan)))
    mean = (picture - reference).mean(axis=2, dtype=np.float64)
    difference = np.nan_to_num(mean, posinf=0.0, neginf=0.0) / max(peak, 1e-30)
    scale = max(float(np.quantile(np.abs(difference), 0.995)), 1e-6)
    exposure = exposure_of(reference)
    shown = (display(picture * exposure), display(reference * exposure), _false_color(difference / scale))
    strip = _beside([_titled(title, pixels) for title, pixels in zip(titles, shown, strict=True)])
    bar = _scale_bar(strip.shape[1], 100.0 * scale)
    try:
        write_png(path, np.concatenate([_widened(strip, bar.shape[1]), bar]))
    except OSError as error:
        raise CommandError(f"{path} cannot be written: {error.strerror}") from error


def exposure_of(picture: Picture) -> float:
    """Makes the brighter tenth of a picture just not white."""
    return 0.9 / max(float(np.quantile(np.nan_to_num(picture), 0.9)), 1e-30)


def display(picture: Picture) -> Pixels:
    """Linear to sRGB, eight bits."""
    linear = np.clip(np.nan_to_num(picture), 0.0, 1.0)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return (encoded * 255.0 + 0.5).astype(np.uint8)


def _false_color(values: npt.NDArray[np.float64]) -> Pixels:
    """Values from -1 to 1 as colors."""
    channels = [np.interp(values, _STOPS, [color[i] for color in _COLORS]) for i in range(3)]
    return (np.stack(channels, axis=-1) * 255.0 + 0.5).astype(np.uint8)


def _blank(height: int, width: int) -> Pixels:
    return np.full((height, width, 3), _BACKGROUND, np.uint8)


def _text(text: str) -> Pixels:
    """White letters on the background."""
    drawing = Drawing(ceil(text_width(text, _TEXT_SIZE)) + 4, _TEXT_HEIGHT, (_BACKGROUND,) * 3)
    drawing.items.append(Text(text, (2.0, 13.0), _TEXT_SIZE, (255, 255, 255)))
    return rasterize(drawing)


def _titled(title: str, picture: Pixels) -> Pixels:
    text = _text(title)
    width = max(picture.shape[1], text.shape[1])
    return np.concatenate([_widened(text, width), _widened(picture, width)])


def _widened(pixels: Pixels, width: int) -> Pixels:
    """With background to the right."""
    return np.concatenate([pixels, _blank(pixels.shape[0], width - pixels.shape[1])], axis=1)


def _beside(panels: list[Pixels]) -> Pixels:
    gap = _blank(panels[0].shape[0], _GAP)
    parts = [part for panel in panels for part in (panel, gap)]
    return np.concatenate(parts[:-1], axis=1)


def _scale_bar(width: int, percent: float) -> Pixels:
    """The colors from -percent to +percent, with their values below."""
    labels = [_text(f"{value:+.3g}%" if abs(percent) < 1e4 else "0") for value in (-percent, 0.0, percent)]
    width = max(width, sum(label.shape[1] for label in labels) + 2 * _GAP)
    ramp = _false_color(np.linspace(-1.0, 1.0, width))
    bar = np.broadcast_to(ramp, (_BAR_HEIGHT, width, 3))
    row = _blank(labels[0].shape[0], width)
    starts = (0, (width - labels[1].shape[1]) // 2, width - labels[2].shape[1])
    for start, label in zip(starts, labels, strict=True):
        row[:, start : start + label.shape[1]] = label
    return np.concatenate([_blank(_GAP, width), bar, row])
