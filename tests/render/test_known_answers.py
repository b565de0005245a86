"""Scenes whose picture is known without rendering it."""

import bpy
import numpy as np
import pytest

from scenes import common, furnace, two_rooms
from tests.render import pictures

LEAK_TOLERANCE = 0.001
"""Dark room over lit room, means."""
FURNACE_MEAN_TOLERANCE = 0.003
FURNACE_RMS_TOLERANCE = 0.01
SETTINGS = {"gather.rays": 256, "photon_pass.photon_count": 1_000_000, "pyramid.finest_resolution": 128}


@pytest.mark.parametrize("cells", [1.0, 0.2])
def test_no_light_leaks_through_a_thin_wall(cells: float) -> None:
    thickness = cells * two_rooms.ONE_CELL
    two_rooms.build(thickness)
    answer = two_rooms.known_answer(thickness)
    scene = bpy.context.scene
    scene.render.resolution_percentage = 25
    pictures.use_rgp(scene, SETTINGS)
    picture = pictures.render(scene)["Combined"]
    lit, dark = (pictures.part(picture, answer[room]).mean() for room in ("lit_room", "dark_room"))
    assert lit > 0.05
    assert dark < LEAK_TOLERANCE * lit, f"{100.0 * dark / lit:.4f} %"


def test_furnace_has_the_same_radiance_everywhere() -> None:
    bpy.ops.wm.open_mainfile(filepath=str(common.SCENES / "furnace.blend"))
    scene = bpy.context.scene
    scene.render.resolution_percentage = 25
    pictures.use_rgp(scene, SETTINGS)
    ratio = pictures.render(scene)["Combined"] / furnace.RADIANCE
    assert np.abs(pictures.mean(ratio) - 1.0).max() < FURNACE_MEAN_TOLERANCE, pictures.mean(ratio)
    assert np.sqrt(((ratio - 1.0) ** 2).mean()) < FURNACE_RMS_TOLERANCE
