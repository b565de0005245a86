"""Motion blur against Cycles in the same process: brightness, and how it is spread over columns and rows."""

import numpy as np
import pytest

from tests.render import motion_cases, pictures

pytestmark = pytest.mark.slow

SETTINGS = {"gather.rays": 128, "gather.camera_samples": 128, "photon_pass.photon_count": 200_000}
CYCLES_SAMPLES = 512
MEAN, PROFILE = 0.01, 0.03
"""Of the mean: what is granted between both engines in the whole, and in the mean of each column and row."""


@pytest.mark.parametrize("name", motion_cases.MOTIONS)
def test_motion_is_blurred_as_in_cycles(name: str) -> None:
    scene = motion_cases.build(name)
    pictures.use_rgp(scene, SETTINGS)
    ours = pictures.render(scene)["Combined"]
    pictures.use_cycles(scene, CYCLES_SAMPLES, 1)
    theirs = pictures.render(scene)["Combined"]
    assert ours.mean() == pytest.approx(theirs.mean(), rel=MEAN)
    for axis in (0, 1):
        difference = np.abs(ours.mean(axis=axis) - theirs.mean(axis=axis)).max()
        assert difference < PROFILE * theirs.mean(), f"axis {axis}: {difference / theirs.mean()}"
    scene.render.use_motion_blur = False
    pictures.use_rgp(scene, SETTINGS)
    still = pictures.render(scene)["Combined"]
    assert max(np.abs(still.mean(axis=axis) - theirs.mean(axis=axis)).max() for axis in (0, 1)) > (
        PROFILE * theirs.mean()
    ), "the test would not see the blur"
