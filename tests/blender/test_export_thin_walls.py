"""Thin Wall of the Principled BSDF."""

import bpy
import pytest

from tests.blender import build

pytestmark = pytest.mark.skipif(bpy.app.version < (5, 2), reason="no Thin Wall before Blender 5.2")


@pytest.fixture
def closure(exported):
    """The closure of a material of one, on the one object of the scene."""
    return lambda b_material: exported(b_material)["closures"][0]["closure"]


@pytest.mark.parametrize("thin_wall", [False, True])
def test_thin_walls_scatter_what_is_subsurface_to_both_sides(scene, closure, problems, thin_wall):
    inputs = {"Subsurface_Weight": 0.4, "Subsurface_Anisotropy": 0.3, "Thin_Wall": thin_wall}
    record = closure(build.surface("ShaderNodeBsdfPrincipled", **inputs))
    names = ("thin_wall", "subsurface_weight", "subsurface_anisotropy")
    assert [record.get(name) for name in names] == (
        [True, pytest.approx(0.4), pytest.approx(0.3)] if thin_wall else [None] * 3
    )
    assert any("subsurface" in text for text in problems()) != thin_wall


def test_a_thin_wall_here_and_there_is_reported(scene, closure, problems):
    b_material = build.surface("ShaderNodeBsdfPrincipled")
    b_tree = b_material.node_tree
    (b_node,) = (node for node in b_tree.nodes if node.type == "BSDF_PRINCIPLED")
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeTexNoise"), b_node, "Thin Wall")
    assert closure(b_material)["thin_wall"]
    assert any("only a typical value is used here; 0.5 is used" in text for text in problems())
