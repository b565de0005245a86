"""What nodes compute, against Cycles in the same process."""

import numpy as np
import pytest

from tests.render import pictures
from tests.render.node_cases import NODES
from tests.render.node_scene import node_scene

pytestmark = pytest.mark.slow

SAMPLES = 64


@pytest.mark.parametrize("name", NODES)
def test_node_gives_what_cycles_gives(name: str) -> None:
    scene = node_scene(NODES[name])
    samples = {"gather.rays": SAMPLES, "gather.camera_samples": SAMPLES, "gather.light_samples": 1}
    pictures.use_rgp(scene, {**samples, "photon_pass.photon_count": 1000})
    pictures.use_box_filter(scene)
    ours = pictures.render(scene)["Combined"]
    pictures.use_cycles(scene, SAMPLES, seed=0)
    pictures.use_box_filter(scene)
    theirs = pictures.render(scene)["Combined"]
    assert np.sqrt(((ours - theirs) ** 2).mean()) < NODES[name].bound * theirs.mean()
