"""Motion blur against Cycles in the same process: brightness, and how it is spread over columns and rows."""

import numpy as np
import pytest

from tests.render import motion_cases, pictures

pytestmark = pytest.mark.slow

SETTINGS = {"gather.rays": 128, "gather.camera_samples": 128, "photon_pass.photon_count": 200_000}
CYCLES_SAMPLES = 512
MEAN, PROFILE = 0.01, 0.015
"""Of the mean: what is granted between both engines in the whole, and as RMS in the means of columns and of rows."""


def difference(found: pictures.Picture, expected: pictures.Picture) -> float:
    """RMS difference of the means of columns, or of rows if that is larger, as a part of the mean."""
    profiles = [found.mean(axis=axis) - expected.mean(axis=axis) for axis in (0, 1)]
    return float(max(np.sqrt((profile**2).mean()) for profile in profiles) / expected.mean())


@pytest.mark.parametrize("name", motion_cases.MOTIONS)
def test_motion_is_blurred_as_in_cycles(name: str) -> None:
    scene = motion_cases.build(name)
    pictures.use_rgp(scene, SETTINGS)
    ours = pictures.render(scene)["Combined"]
    scene.render.use_motion_blur = False
    still = pictures.render(scene)["Combined"]
    scene.render.use_motion_blur = True
    pictures.use_cycles(scene, CYCLES_SAMPLES, 1)
    theirs = pictures.render(scene)["Combined"]
    assert ours.mean() == pytest.approx(theirs.mean(), rel=MEAN)
    found = difference(ours, theirs)
    assert found < PROFILE
    assert difference(still, theirs) > 3.0 * found, "it would pass without blur"
