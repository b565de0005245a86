"""Lamps whose nodes compute their light, against Cycles in the same process."""

import bpy
import pytest

from tests.render import lamp_node_cases, pictures

pytestmark = pytest.mark.slow

SETTINGS = {"gather.rays": 64, "gather.camera_samples": 64, "photon_pass.photon_count": 100_000}
CYCLES_SAMPLES = 256
MEAN = 0.01
"""Of the mean: what is granted between both engines."""


@pytest.mark.parametrize(
    "name", ["area_image", "area_mix_and_add", "point_falloff_linear", "spot_gobo_by_normal", "sun_image"]
)
def test_lamps_shine_as_their_nodes_say(name: str) -> None:
    scene = lamp_node_cases.build(name)
    pictures.use_cycles(scene, CYCLES_SAMPLES, 1)
    theirs = pictures.render(scene)["Combined"]
    pictures.use_rgp(scene, SETTINGS)
    ours = pictures.render(scene)["Combined"]
    assert ours.mean() == pytest.approx(theirs.mean(), rel=MEAN)
    b_tree = bpy.data.objects["Lamp"].data.node_tree
    b_output = next(b_node for b_node in b_tree.nodes if b_node.type == "OUTPUT_LIGHT")
    b_plain = b_tree.nodes.new("ShaderNodeEmission")
    b_plain.inputs["Strength"].default_value = 1.0
    b_tree.links.new(b_plain.outputs[0], b_output.inputs[0])
    plain = pictures.render(scene)["Combined"]
    assert abs(plain.mean() / theirs.mean() - 1.0) > 3.0 * MEAN, "it would pass without nodes"
