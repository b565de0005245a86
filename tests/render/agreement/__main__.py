"""Compares every feature with Cycles and writes `docs/agreement.md`: `python -m tests.render.agreement`.

With a part of a feature's name it compares only those, prints their figures and writes nothing.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import bpy

import rgp_engine

from .features import features
from .measure import Agreement, measure
from .page import write

DOCS = Path(__file__).resolve().parents[3] / "docs"


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser(prog="python -m tests.render.agreement", description=__doc__)
    parser.add_argument("only", nargs="*", metavar="NAME", help="a part of a feature's name; default: all")
    only = parser.parse_args().only
    rgp_engine.register()
    found: dict[str, Agreement] = {}
    for feature in features():
        if only and not any(part in feature.name for part in only):
            continue
        start = time.monotonic()
        agreement = measure(feature.build, box_filter=feature.box_filter)
        found[feature.name] = agreement
        verdict = "agrees" if agreement.passes else "DIFFERS"
        print(
            f"{feature.name:44} mean {agreement.mean_ratio:.4f} beyond noise {agreement.beyond_noise:.4f}"
            f" {verdict} in {time.monotonic() - start:.1f} s",
            file=sys.stderr,
            flush=True,
        )
    if not only:
        write(DOCS, found, bpy.app.version_string)


if __name__ == "__main__":
    main()
