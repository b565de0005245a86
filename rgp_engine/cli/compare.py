"""`compare A.exr B.exr`: how far a picture is from its reference."""

import argparse
import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..accuracy.error import CLIPPED_AT
from . import CommandError, exr
from .difference import draw_difference
from .exr import Picture


@dataclass(frozen=True)
class Comparison:
    """Error of a picture against a reference, over all pixels and the three channels."""

    rms_peak: float
    """Root mean square error in percent; the brightest reference pixel is 100 % (the paper's metric)."""
    rms_mean: float
    """Root mean square error in percent of the reference's mean."""
    rms_clipped: float
    """The same of pictures that are clipped at eight times that mean: what a render's statistics call its error."""
    relmse: float
    """Mean of squared error over squared reference, plus 1 % of its squared mean so that black does not divide."""
    bias: float
    """Mean of the picture over mean of the reference, less one, in percent."""
    nonfinite: int
    """Pixels of either picture that are NaN or infinite; they are left out of the other figures."""


def compare_pictures(picture: Picture, reference: Picture) -> Comparison:
    """Error of `picture` against `reference`, both (height, width, 3). Raises CommandError when sizes differ."""
    if picture.shape != reference.shape:
        sizes = [f"{p.shape[1]} x {p.shape[0]}" for p in (picture, reference)]
        raise CommandError(f"the pictures differ in size: {sizes[0]} and {sizes[1]} pixels")
    is_finite = np.isfinite(picture).all(axis=2) & np.isfinite(reference).all(axis=2)
    if not is_finite.any():
        raise CommandError("no pixel of the two pictures is finite in both")
    a, b = picture[is_finite].astype(np.float64), reference[is_finite].astype(np.float64)
    mean, peak = b.mean(), b.max()
    if mean <= 0.0:
        raise CommandError("the reference is black; errors relative to it mean nothing")
    rms = np.sqrt(np.mean((a - b) ** 2))
    a_clipped, b_clipped = (np.minimum(part, CLIPPED_AT * mean) for part in (a, b))
    return Comparison(
        rms_peak=float(100.0 * rms / peak),
        rms_mean=float(100.0 * rms / mean),
        rms_clipped=float(100.0 * np.sqrt(np.mean((a_clipped - b_clipped) ** 2)) / b_clipped.mean()),
        relmse=float(np.mean((a - b) ** 2 / (b**2 + 0.01 * mean**2))),
        bias=float(100.0 * (a.mean() / mean - 1.0)),
        nonfinite=int(is_finite.size - is_finite.sum()),
    )


def add_arguments(commands: Any) -> None:
    """Adds the command to the parser."""
    parser = commands.add_parser(
        "compare",
        help="measure a picture against its reference",
        description="Prints how far the picture A is from the reference B.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog=(
            "rms_peak     root mean square error, brightest reference pixel = 100 %\n"
            "rms_mean     root mean square error, mean of the reference = 100 %\n"
            "rms_clipped  the same, both clipped at 8 times that mean\n"
            "relmse       mean of squared error over squared reference\n"
            "bias         mean of A over mean of B, less one\n"
            "nonfinite    pixels that are NaN or infinite, left out of the rest"
        ),
    )
    parser.add_argument("picture", metavar="A.exr", type=Path)
    parser.add_argument("reference", metavar="B.exr", type=Path)
    parser.add_argument("--png", metavar="D.png", type=Path, help="draw A, B and their difference")
    parser.add_argument("--json", action="store_true", help="print JSON instead of a table")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Does what the command line asks for."""
    picture, reference = exr.read(options.picture), exr.read(options.reference)
    comparison = compare_pictures(picture, reference)
    if options.png:
        draw_difference(options.png, picture, reference)
    if options.json:
        print(json.dumps(asdict(comparison), indent=2))
        return
    for name in ("rms_peak", "rms_mean", "rms_clipped"):
        print(f"{name:11} {getattr(comparison, name):9.4f} %")
    print(f"{'relmse':11} {comparison.relmse:9.6f}")
    print(f"{'bias':11} {comparison.bias:+9.4f} %")
    print(f"{'nonfinite':11} {comparison.nonfinite:9d} pixels")
