"""Makes the truths of the error tests: `python -m tests.render.make_truths [SCENE ...]`.

Light is followed along paths (`gather.estimator=path`), twice, with seeds that share nothing. A picture's differences
from one and from the other, multiplied, have its squared error as their expectation. Written to
`tests/render/references/truth_SCENE.exr`, 96 x 72, half floats, layers `First` and `Second`; all three scenes take
about ten minutes on two cores.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenEXR

from rgp_engine.__main__ import main as rgp_engine
from rgp_engine.cli import exr
from scenes import common
from tests.render import pictures
from tests.render.pictures import Picture

REFERENCES = Path(__file__).resolve().parent / "references"
NAMES = ("cornell_box", "table", "nave")
RESOLUTION = "96x72"
SETTINGS = ("gather.estimator=path", "gather.rays=4096", "gather.camera_samples=1024")
SEEDS = {"First": 101, "Second": 102}


def make(scene: str) -> None:
    """Renders both halves of a scene and writes them."""
    channels = {}
    for layer, seed in SEEDS.items():
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "picture.exr"
            settings = [argument for setting in SETTINGS for argument in ("--set", setting)]
            command = ["render", str(common.SCENES / f"{scene}.blend"), "-o", str(picture), *settings]
            if rgp_engine([*command, "--resolution", RESOLUTION, "--seed", str(seed)]) != 0:
                sys.exit(f"error: {scene} was not rendered")
            pixels = exr.read(picture)
        for i, channel in enumerate("RGB"):
            channels[f"{layer}.{channel}"] = np.ascontiguousarray(pixels[..., i].astype(np.float16))
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, channels).write(str(REFERENCES / f"truth_{scene}.exr"))


def read(scene: str) -> tuple[Picture, Picture]:
    """Both halves, (height, width, 3)."""
    channels = pictures.read_channels(REFERENCES / f"truth_{scene}.exr")
    first, second = (pictures.rgb(channels, layer) for layer in SEEDS)
    return first, second


if __name__ == "__main__":
    for name in sys.argv[1:] or NAMES:
        make(name)
