"""Volume nodes as what solids absorb."""

import bpy
import pytest

from tests.blender import build


@pytest.fixture
def closures(exported):
    """Closures of a material, on the one object of the scene."""
    return lambda b_material: exported(b_material)["closures"]


def volume(name, **sockets):
    """A Volume node in a material without a surface: the material, its tree and the node."""
    b_material, b_tree, b_output = build.material()
    b_node = b_tree.nodes.new(name)
    for socket, value in sockets.items():
        b_node.inputs[socket.replace("_", " ")].default_value = value
    build.connect(b_tree, b_node, b_output, "Volume")
    return b_material, b_tree, b_node


def about_material(problems):
    return [text for text in problems() if text.startswith("Material")]


def absorption(recorded):
    return recorded.last.material_of("Material")["absorption"]


def test_volume_absorption(closures, recorded, problems):
    b_material, _, b_node = volume("ShaderNodeVolumeAbsorption", Color=(0.25, 1.5, 0.75, 1.0), Density=2.0)
    assert closures(b_material) == [
        {"weight": [1.0] * 3, "closure": {"kind": "transparent", "color": [1.0] * 3}}
    ]
    assert absorption(recorded) == pytest.approx([1.5, 0.0, 0.5])
    assert about_material(problems) == []
    b_node.inputs["Density"].default_value = -1.0
    closures(b_material)
    assert absorption(recorded) == [0.0, 0.0, 0.0]


def test_volumes_that_are_mixed(closures, recorded, problems):
    """Mix Shader scales the absorption, Add Shader adds it, and a muted node has none."""
    b_material, b_tree, b_first = volume(
        "ShaderNodeVolumeAbsorption", Color=(0.0, 0.5, 1.0, 1.0), Density=4.0
    )
    b_output = next(b_node for b_node in b_tree.nodes if b_node.type == "OUTPUT_MATERIAL")
    b_second = b_tree.nodes.new("ShaderNodeVolumeAbsorption")
    b_second.inputs["Color"].default_value = (0.5, 0.5, 0.5, 1.0)
    b_mix = b_tree.nodes.new("ShaderNodeMixShader")
    b_mix.inputs[0].default_value = 0.25
    b_add = b_tree.nodes.new("ShaderNodeAddShader")
    b_tree.links.new(b_first.outputs[0], b_mix.inputs[1])
    b_tree.links.new(b_second.outputs[0], b_mix.inputs[2])
    b_tree.links.new(b_mix.outputs[0], b_add.inputs[0])
    b_tree.links.new(b_second.outputs[0], b_add.inputs[1])
    b_tree.links.new(b_add.outputs[0], b_output.inputs["Volume"])
    closures(b_material)
    assert absorption(recorded) == pytest.approx([3.0 + 0.125 + 0.5, 1.5 + 0.125 + 0.5, 0.125 + 0.5])
    b_first.mute = True
    closures(b_material)
    assert absorption(recorded) == pytest.approx([0.625] * 3)
    assert about_material(problems) == []


def test_a_volume_that_varies_has_a_typical_value(closures, recorded, problems):
    b_material, b_tree, b_node = volume("ShaderNodeVolumeAbsorption", Color=(0.0, 0.0, 0.0, 1.0))
    b_tree.links.new(b_tree.nodes.new("ShaderNodeTexNoise").outputs[0], b_node.inputs["Density"])
    closures(b_material)
    assert all(0.0 < channel < 1.0 for channel in absorption(recorded))
    assert about_material(problems) == [
        'Material: node "Volume Absorption": volumes are even for now; a typical value is used for Density'
    ]


@pytest.mark.skipif(
    not hasattr(bpy.types, "ShaderNodeVolumeCoefficients"), reason="Blender has no such node yet"
)
def test_volume_coefficients(closures, recorded, problems):
    b_material, _, b_node = volume(
        "ShaderNodeVolumeCoefficients",
        Absorption_Coefficients=(0.5, 1.0, 2.0),
        Scatter_Coefficients=(0.0,) * 3,
    )
    b_node.inputs["Emission Coefficients"].default_value = (0.0,) * 3
    closures(b_material)
    assert absorption(recorded) == [0.5, 1.0, 2.0]
    assert about_material(problems) == []
    b_node.inputs["Scatter Coefficients"].default_value = (1.0,) * 3
    closures(b_material)
    assert about_material(problems)[-1].endswith("Scatter Coefficients are not supported yet; left out")
