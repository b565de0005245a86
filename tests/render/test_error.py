"""The error that a render states, against the error it has: from light followed along paths, see `make_truths`.

What is stated is noise; with few photons the blur of cells comes on top.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rgp_engine.__main__ import main
from rgp_engine.accuracy.error import CLIPPED_AT
from rgp_engine.cli import exr
from scenes import common
from tests.render import make_truths

FACTOR = 1.5
"""Halves of a well-spread set of rays differ more than independent ones: the error is stated rather too high."""


def render(scene: str, folder: Path, seed: int, *settings: str) -> tuple[Any, dict[str, Any]]:
    """The combined picture (height, width, 3) and the statistics."""
    picture, stats = folder / "picture.exr", folder / "stats.json"
    arguments = [argument for setting in settings for argument in ("--set", setting)]
    blend = common.SCENES / f"{scene}.blend"
    command = ["render", str(blend), "-o", str(picture), "--stats", str(stats)]
    command += ["--resolution", make_truths.RESOLUTION]
    assert main([*command, "--seed", str(seed), *arguments]) == 0
    return exr.read(picture).astype(np.float64), json.loads(stats.read_text())


@pytest.mark.slow
@pytest.mark.parametrize("scene", make_truths.NAMES)
def test_error_is_the_true_error(scene: str, tmp_path: Path) -> None:
    first, second = make_truths.read(scene)
    most = CLIPPED_AT * ((first + second) / 2.0).mean()
    clipped = [np.minimum(picture, most) for picture in (first, second)]
    mean = ((clipped[0] + clipped[1]) / 2.0).mean()
    for photons, rays, camera_samples in (
        (1_000_000, 256, 16),
        (1_000_000, 64, 16),
        (1_000_000, 1024, 64),
        (200_000, 255, 7),
    ):
        settings = (
            f"photon_pass.photon_count={photons}",
            f"gather.rays={rays}",
            f"gather.camera_samples={camera_samples}",
        )
        picture, stats = render(scene, tmp_path, 7, *settings)
        picture = np.minimum(picture, most)
        squared = ((picture - clipped[0]) * (picture - clipped[1])).mean()
        truth = 100.0 * np.sqrt(max(squared, 0.0)) / mean
        stated = stats["error"]["rms_clipped"]
        assert truth / FACTOR < stated < truth * FACTOR, f"{settings}: {stated:.3f} %, in truth {truth:.3f} %"


def test_no_second_pass_states_no_error(tmp_path: Path) -> None:
    _, stats = render("cornell_box", tmp_path, 0, "gather.rays=16", "gather.camera_samples=1")
    assert stats["error"] is None
    assert stats["stopped_by"] == "rays"


def test_render_stops_at_its_target(tmp_path: Path) -> None:
    settings = ("gather.rays=4096", "gather.camera_samples=64", "photon_pass.photon_count=100000")
    _, stats = render("cornell_box", tmp_path, 0, *settings, "gather.error_target=12")
    assert stats["stopped_by"] == "error"
    assert stats["error"]["rms_clipped"] <= 12.0
    assert 2 <= stats["passes"] < 64


def test_render_stops_when_time_is_up(tmp_path: Path) -> None:
    settings = ("gather.rays=4096", "gather.camera_samples=1024", "photon_pass.photon_count=10000")
    _, stats = render("cornell_box", tmp_path, 0, *settings, "gather.time_limit=1")
    assert stats["stopped_by"] == "time"
    assert 2 <= stats["passes"] < 1024
