"""Anisotropic shaders, and the tangents they are anisotropic about."""

import bpy
import pytest

from tests.blender import build

SHADERS = [
    (
        "Principled",
        {"Anisotropic": 0.8, "Anisotropic_Rotation": 0.25},
        ("anisotropic", "anisotropic_rotation"),
    ),
    ("Anisotropic", {"Anisotropy": -0.6, "Rotation": 0.1}, ("anisotropy", "rotation")),
]
if bpy.app.version >= (4, 3):
    SHADERS.append(
        ("Metallic", {"Anisotropy": 0.9, "Rotation": 0.1}, ("anisotropic", "anisotropic_rotation"))
    )


def instruction_of(material):
    """The instruction that computes the only tangent."""
    (tangent,) = material["program"]["tangents"]
    assert tangent["closure"] == 0
    return material["program"]["instructions"][tangent["register"]]


@pytest.mark.parametrize(("kind", "sockets", "names"), SHADERS)
def test_the_tangent_leads_around_the_object(scene, exported, problems, kind, sockets, names):
    material = exported(build.surface(f"ShaderNodeBsdf{kind}", **sockets))
    closure = material["closures"][0]["closure"]
    assert [closure[name] for name in names] == pytest.approx(list(sockets.values()))
    instruction = instruction_of(material)
    assert (instruction["op"], instruction["axis"]) == ("tangent", "z")
    assert not any(text.startswith("Material") for text in problems())


@pytest.mark.parametrize("kind", [kind for kind, _, _ in SHADERS])
def test_what_is_isotropic_needs_no_tangent(scene, exported, kind):
    assert "program" not in exported(build.surface(f"ShaderNodeBsdf{kind}", Roughness=0.5))


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ({"direction_type": "RADIAL", "axis": "X"}, {"op": "tangent", "axis": "x"}),
        ({"direction_type": "RADIAL", "axis": "Y"}, {"op": "tangent", "axis": "y"}),
        ({"direction_type": "UV_MAP", "uv_map": "Other"}, {"op": "uv_tangent"}),
        ({"direction_type": "UV_MAP"}, {"op": "uv_tangent"}),
    ],
)
def test_the_tangent_node(scene, exported, problems, settings, expected):
    b_material, b_tree, b_output = build.material()
    b_shader = build.node(b_tree, "ShaderNodeBsdfAnisotropic", Anisotropy=0.5)
    b_tangent = b_tree.nodes.new("ShaderNodeTangent")
    for name, value in settings.items():
        setattr(b_tangent, name, value)
    build.connect(b_tree, b_tangent, b_shader, "Tangent")
    build.connect(b_tree, b_shader, b_output, "Surface")
    instruction = instruction_of(exported(b_material))
    assert {name: instruction[name] for name in expected} == expected
    assert not any(text.startswith("Material") for text in problems())


def test_a_constant_tangent(scene, exported, problems):
    b_material, b_tree, b_output = build.material()
    b_shader = build.node(b_tree, "ShaderNodeBsdfAnisotropic", Anisotropy=0.5)
    b_vector = build.node(b_tree, "ShaderNodeCombineXYZ", X=0.0, Y=1.0, Z=0.5)
    build.connect(b_tree, b_vector, b_shader, "Tangent")
    build.connect(b_tree, b_shader, b_output, "Surface")
    instruction = instruction_of(exported(b_material))
    assert (instruction["op"], instruction["value"][:3]) == ("constant", [0.0, 1.0, 0.5])
    assert not any(text.startswith("Material") for text in problems())


def test_anisotropy_that_varies_has_a_tangent(scene, exported):
    b_material, b_tree, b_output = build.material()
    b_shader = b_tree.nodes.new("ShaderNodeBsdfPrincipled")
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeTexNoise"), b_shader, "Anisotropic")
    build.connect(b_tree, b_shader, b_output, "Surface")
    material = exported(b_material)
    assert instruction_of(material)["op"] == "tangent"
    assert [output["input"] for output in material["program"]["outputs"]] == ["anisotropic"]
