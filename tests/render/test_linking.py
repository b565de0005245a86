"""Light linking and shadow linking against Cycles in the same process."""

import bpy
import pytest

from tests.render import linking_cases, pictures

pytestmark = pytest.mark.slow

SETTINGS = {"gather.rays": 64, "gather.camera_samples": 64, "photon_pass.photon_count": 100_000}
CYCLES_SAMPLES = 256
MEAN = 0.01
"""Of the mean: what is granted between both engines."""


@pytest.mark.parametrize(
    "name",
    ["lights_the_ball", "panel_lights_all_but_the_ball", "lamp_not_in_the_mirror", "ball_casts_no_shadow"],
)
def test_lights_light_what_they_are_linked_to(name: str) -> None:
    scene = linking_cases.build(name)
    pictures.use_cycles(scene, CYCLES_SAMPLES, 1)
    theirs = pictures.render(scene)["Combined"]
    pictures.use_rgp(scene, SETTINGS)
    ours = pictures.render(scene)["Combined"]
    assert ours.mean() == pytest.approx(theirs.mean(), rel=MEAN)
    links = bpy.data.objects["Lamp"].light_linking
    links.receiver_collection = links.blocker_collection = None
    unlinked = pictures.render(scene)["Combined"]
    assert abs(unlinked.mean() / theirs.mean() - 1.0) > 3.0 * MEAN, "it would pass without links"
