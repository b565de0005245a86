"""Renders scenes that others made with both engines and writes `docs/real-scenes.md`.

Run it by `make scenes` or `python -m benchmarks.real_scenes`.

With a part of a scene's name it renders only those, into `out/real_scenes`, prints their figures and writes no page.
"""

from __future__ import annotations

import argparse
import sys
from functools import partial
from pathlib import Path

import bpy

import rgp_engine

from .measure import measure
from .page import Figures, figures, write
from .sheet import sheet, write_pictures
from .subjects import SUBJECTS

_ROOT = Path(__file__).resolve().parents[2]
_SCENES = _ROOT.parent / "shared/scenes"
_DOCS, _PICTURES = _ROOT / "docs", "real-scenes"
_OUTPUT = _ROOT / "out/real_scenes"


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.real_scenes", description=__doc__)
    parser.add_argument("only", nargs="*", metavar="NAME", help="a part of a scene's name; default: all")
    parser.add_argument("--scenes", type=Path, default=_SCENES, help="folder of the files")
    parser.add_argument("--width", type=int, default=320, help="of the pictures, pixels; default: 320")
    parser.add_argument(
        "--samples", type=int, default=512, help="of Cycles, per pixel and picture; default: 512"
    )
    parser.add_argument("--set", metavar="GROUP.NAME=VALUE", action="append", default=[], help="our settings")
    options = parser.parse_args()
    chosen = [
        subject
        for subject in SUBJECTS
        if not options.only or any(part in subject.name for part in options.only)
    ]
    rgp_engine.register()
    writes_page = not options.only
    jpegs = _DOCS / _PICTURES
    for folder in (_OUTPUT, jpegs) if writes_page else (_OUTPUT,):
        folder.mkdir(parents=True, exist_ok=True)
    found: dict[str, Figures] = {}
    for subject in chosen:
        comparison = measure(
            partial(subject.open, options.scenes), options.width, options.samples, options.set
        )
        jpeg = jpegs / f"{subject.name}.jpg" if writes_page and subject.may_be_shown else None
        write_pictures(_OUTPUT / f"{subject.name}.png", jpeg, sheet(comparison))
        found[subject.name] = figures(comparison)
        print(subject.name, found[subject.name], file=sys.stderr, flush=True)
    if writes_page:
        setup = {
            "width": options.width,
            "samples": options.samples,
            "settings": options.set,
            "blender": bpy.app.version_string,
        }
        write(_DOCS, _PICTURES, found, setup)


if __name__ == "__main__":
    main()
