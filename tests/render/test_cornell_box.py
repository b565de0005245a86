"""The Cornell box against Cycles: same file, 128 x 128, 256 gather rays, a million photons."""

import json

import bpy
import numpy as np
import pytest

from scenes import common
from tests.render import pictures
from tests.render.make_references import CORNELL_RESOLUTION, REFERENCES

MEAN_TOLERANCE = 0.01
RMS_PEAK_TOLERANCE = 0.005
SETTINGS = {"gather.rays": 256, "photon_pass.photon_count": 1_000_000, "pyramid.finest_resolution": 128}


@pytest.fixture(scope="module")
def rendered() -> dict[str, pictures.Picture]:
    bpy.ops.wm.open_mainfile(filepath=str(common.SCENES / "cornell_box.blend"))
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = CORNELL_RESOLUTION
    scene.view_layers[0].rgp.use_pass_indirect = True
    pictures.use_rgp(scene, SETTINGS)
    return pictures.render(scene, ("Combined", "Indirect"))


@pytest.fixture(scope="module")
def figures() -> dict[str, list[float]]:
    return json.loads((REFERENCES / "cornell_box.json").read_text())


def test_mean_is_that_of_cycles(
    rendered: dict[str, pictures.Picture], figures: dict[str, list[float]]
) -> None:
    ratio = pictures.mean(rendered["Combined"]) / figures["mean_combined"]
    assert np.abs(ratio - 1.0).max() < MEAN_TOLERANCE, ratio


def test_indirect_mean_is_that_of_cycles(
    rendered: dict[str, pictures.Picture], figures: dict[str, list[float]]
) -> None:
    ratio = pictures.mean(rendered["Indirect"]) / figures["mean_indirect"]
    assert np.abs(ratio - 1.0).max() < MEAN_TOLERANCE, ratio


def test_indirect_light_has_the_promised_error(rendered: dict[str, pictures.Picture]) -> None:
    channels = pictures.read_channels(REFERENCES / "cornell_box.exr")
    halves = [pictures.rgb(channels, name) for name in ("Indirect1", "Indirect2")]
    error = pictures.rms_peak(rendered["Indirect"], *halves)
    assert error < RMS_PEAK_TOLERANCE, f"{100.0 * error:.3f} %"
