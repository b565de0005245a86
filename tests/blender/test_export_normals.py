"""Shading normals of shaders, and of the coat of Principled."""

import bpy
import pytest

from tests.blender import build


@pytest.mark.parametrize("second", ["none", "other", "same"])
def test_every_shader_has_its_own_normal(scene, exported, problems, second):
    b_material, b_tree, b_output = build.material()
    b_mix = b_tree.nodes.new("ShaderNodeMixShader")
    b_shaders = [b_tree.nodes.new("ShaderNodeBsdfDiffuse") for _ in range(2)]
    b_bump = b_tree.nodes.new("ShaderNodeBump")
    build.connect(b_tree, b_bump, b_shaders[0], "Normal")
    if second != "none":
        b_other = b_bump if second == "same" else build.node(b_tree, "ShaderNodeBump", Strength=0.3)
        build.connect(b_tree, b_other, b_shaders[1], "Normal")
    for b_shader, identifier in zip(b_shaders, ("Shader", "Shader_001"), strict=True):
        build.connect(b_tree, b_shader, b_mix, identifier)
    build.connect(b_tree, b_mix, b_output, "Surface")
    program = exported(b_material)["program"]
    normals = program["normals"]
    assert [normal["closure"] for normal in normals] == ([0] if second == "none" else [0, 1])
    assert all(program["instructions"][normal["register"]]["op"] == "bump" for normal in normals)
    assert len({normal["register"] for normal in normals}) == (2 if second == "other" else 1)
    assert program["normal"] is None
    assert not any(text.startswith("Material") for text in problems())


@pytest.mark.parametrize("weight", [0.0, 1.0])
def test_a_coat_normal_is_that_of_the_coat_alone(scene, exported, problems, weight):
    b_material, b_tree, b_output = build.material()
    b_shader = build.node(b_tree, "ShaderNodeBsdfPrincipled", Coat_Weight=weight)
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeBump"), b_shader, "Coat Normal")
    build.connect(b_tree, b_shader, b_output, "Surface")
    material = exported(b_material)
    if weight == 0.0:
        assert "program" not in material
    else:
        (normal,) = material["program"]["normals"]
        assert (normal["closure"], normal["coat"]) == (0, True)
    assert not any(text.startswith("Material") for text in problems())


def test_bump_map_correction_that_is_off_is_reported(scene, exported, problems):
    b_material, b_tree, b_output = build.material()
    b_material.cycles.use_bump_map_correction = False
    b_shader = b_tree.nodes.new("ShaderNodeBsdfDiffuse")
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeBump"), b_shader, "Normal")
    build.connect(b_tree, b_shader, b_output, "Surface")
    exported(b_material)
    assert "Material: Bump Map Correction cannot be switched off" in problems()


@pytest.mark.skipif(bpy.app.version < (4, 3), reason="Blender 4.2 has no Filter Width")
@pytest.mark.parametrize(("socket", "exported_width"), [(0.25, 0.25), (-5.0, 1e-3), (1e9, 1e3)])
def test_the_slope_of_a_bump_is_taken_over_its_filter_width(scene, exported, socket, exported_width):
    b_material, b_tree, b_output = build.material()
    b_shader, b_bump = b_tree.nodes.new("ShaderNodeBsdfDiffuse"), b_tree.nodes.new("ShaderNodeBump")
    b_bump.inputs["Filter Width"].default_value = socket
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeTexNoise"), b_bump, "Height")
    build.connect(b_tree, b_bump, b_shader, "Normal")
    build.connect(b_tree, b_shader, b_output, "Surface")
    instructions = exported(b_material)["program"]["instructions"]
    (bump,) = (step for step in instructions if step["op"] == "bump")
    assert bump["filter_width"] == pytest.approx(exported_width)
    places = [step["aside"] for step in instructions if any(step.get("aside", ()))]
    width = bump["filter_width"]
    assert [tuple(place) for place in places] == [(width, 0.0), (0.0, width)]
