"""Shader nodes as closures."""

import bpy
import numpy as np
import pytest

from tests.blender import build

HAS_DIFFUSE_ROUGHNESS = bpy.app.version >= (4, 3)


@pytest.fixture
def closures(exported):
    """Closures of a material, on the one object of the scene."""
    return lambda b_material: exported(b_material)["closures"]


def only(closures):
    (part,) = closures
    assert part["weight"] == [1.0, 1.0, 1.0]
    return part["closure"]


def approx(closure):
    return {key: value if isinstance(value, str) else pytest.approx(value) for key, value in closure.items()}


@pytest.mark.parametrize(
    ("kind", "inputs", "expected"),
    [
        (
            "BsdfDiffuse",
            {"Color": (0.1, 0.2, 0.3)},
            {"kind": "diffuse", "color": [0.1, 0.2, 0.3], "roughness": 0.0},
        ),
        (
            "BsdfDiffuse",
            {"Color": (0.1, 0.2, 0.3), "Roughness": 0.7},
            {"kind": "diffuse", "color": [0.1, 0.2, 0.3], "roughness": 0.7},
        ),
        (
            "BsdfAnisotropic",
            {"Color": (0.1, 0.2, 0.3), "Roughness": 0.4},
            {"kind": "glossy", "color": [0.1, 0.2, 0.3], "roughness": 0.4},
        ),
        (
            "BsdfGlass",
            {"Color": (1.0, 0.9, 0.8), "Roughness": 0.0, "IOR": 1.33},
            {"kind": "glass", "color": [1.0, 0.9, 0.8], "roughness": 0.0, "ior": 1.33},
        ),
        (
            "BsdfRefraction",
            {"Color": (1.0, 0.9, 0.8), "Roughness": 0.0, "IOR": 1.6},
            {"kind": "refraction", "color": [1.0, 0.9, 0.8], "roughness": 0.0, "ior": 1.6},
        ),
        ("BsdfTransparent", {"Color": (0.5, 0.6, 0.7)}, {"kind": "transparent", "color": [0.5, 0.6, 0.7]}),
        (
            "Emission",
            {"Color": (1.0, 0.5, 0.25), "Strength": 4.0},
            {"kind": "emission", "radiance": [4.0, 2.0, 1.0]},
        ),
    ],
)
def test_simple_shaders(scene, closures, problems, kind, inputs, expected):
    closure = only(closures(build.surface(f"ShaderNode{kind}", **inputs)))
    assert closure == approx(expected)
    assert not any("Material" in text for text in problems())


def test_principled(scene, closures):
    b_material = build.surface(
        "ShaderNodeBsdfPrincipled",
        Base_Color=(0.7, 0.6, 0.5),
        Metallic=0.25,
        Roughness=0.35,
        IOR=1.4,
        Alpha=0.9,
        Specular_IOR_Level=0.6,
        Specular_Tint=(0.9, 0.8, 0.7),
        Transmission_Weight=0.1,
        Coat_Weight=0.2,
        Coat_Roughness=0.05,
        Coat_IOR=1.6,
        Coat_Tint=(0.4, 0.5, 0.6),
        Emission_Color=(0.1, 0.2, 0.3),
        Emission_Strength=2.0,
        Sheen_Weight=0.3,
        Sheen_Roughness=0.7,
        Sheen_Tint=(0.6, 0.5, 0.4),
    )
    assert only(closures(b_material)) == approx(
        {
            "kind": "principled",
            "base_color": [0.7, 0.6, 0.5],
            "metallic": 0.25,
            "roughness": 0.35,
            "ior": 1.4,
            "alpha": 0.9,
            "specular_ior_level": 0.6,
            "specular_tint": [0.9, 0.8, 0.7],
            "transmission_weight": 0.1,
            "coat_weight": 0.2,
            "coat_roughness": 0.05,
            "coat_ior": 1.6,
            "coat_tint": [0.4, 0.5, 0.6],
            "emission_color": [0.1, 0.2, 0.3],
            "emission_strength": 2.0,
            "sheen_weight": 0.3,
            "sheen_roughness": 0.7,
            "sheen_tint": [0.6, 0.5, 0.4],
            **({"diffuse_roughness": 0.0} if HAS_DIFFUSE_ROUGHNESS else {}),
        }
    )


@pytest.mark.skipif(not HAS_DIFFUSE_ROUGHNESS, reason="Blender 4.2 has no Diffuse Roughness")
def test_principled_diffuse_roughness(scene, closures, problems):
    b_material = build.surface("ShaderNodeBsdfPrincipled", Diffuse_Roughness=0.6)
    assert only(closures(b_material))["diffuse_roughness"] == pytest.approx(0.6)
    assert not any("Material" in text for text in problems())


def test_untouched_principled_has_blenders_defaults_and_no_problem(scene, closures, problems):
    closure = only(closures(build.surface("ShaderNodeBsdfPrincipled")))
    assert closure == approx(
        {
            **closure,
            "base_color": [0.8] * 3,
            "roughness": 0.5,
            "ior": 1.5,
            "specular_ior_level": 0.5,
            "coat_weight": 0.0,
            "emission_strength": 0.0,
        }
    )
    assert not any("Material" in text for text in problems())


def mixed(b_tree, factor, first, second):
    b_mix = build.node(b_tree, "ShaderNodeMixShader", Fac=factor)
    build.connect(b_tree, first, b_mix, "Shader")
    build.connect(b_tree, second, b_mix, "Shader_001")
    return b_mix


def diffuse(b_tree, value):
    return build.node(b_tree, "ShaderNodeBsdfDiffuse", Color=(value,) * 3)


def weights(closures):
    return {round(part["closure"]["color"][0], 3): pytest.approx(part["weight"]) for part in closures}


def test_mix_and_add_are_multiplied_out(scene, closures):
    b_material, b_tree, b_output = build.material()
    inner = mixed(b_tree, 0.25, diffuse(b_tree, 0.1), diffuse(b_tree, 0.2))
    b_add = b_tree.nodes.new("ShaderNodeAddShader")
    build.connect(b_tree, inner, b_add, "Shader")
    build.connect(b_tree, diffuse(b_tree, 0.3), b_add, "Shader_001")
    build.connect(b_tree, mixed(b_tree, 0.4, b_add, diffuse(b_tree, 0.4)), b_output, "Surface")
    found = weights(closures(b_material))
    assert found == {0.1: [0.45] * 3, 0.2: [0.15] * 3, 0.3: [0.6] * 3, 0.4: [0.4] * 3}


@pytest.mark.parametrize(("factor", "kept"), [(0.0, 0.1), (1.0, 0.2)])
def test_what_a_mix_shuts_out_is_gone(scene, closures, factor, kept):
    b_material, b_tree, b_output = build.material()
    build.connect(
        b_tree, mixed(b_tree, factor, diffuse(b_tree, 0.1), diffuse(b_tree, 0.2)), b_output, "Surface"
    )
    assert weights(closures(b_material)) == {kept: [1.0] * 3}


def test_reroutes_muted_nodes_and_groups(scene, closures, problems):
    b_group = bpy.data.node_groups.new("Paint", "ShaderNodeTree")
    b_group.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor")
    b_group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    b_in, b_out = b_group.nodes.new("NodeGroupInput"), b_group.nodes.new("NodeGroupOutput")
    b_shader = b_group.nodes.new("ShaderNodeBsdfDiffuse")
    b_group.links.new(b_in.outputs[0], b_shader.inputs["Color"])
    b_group.links.new(b_shader.outputs[0], b_out.inputs[0])

    b_material, b_tree, b_output = build.material()
    b_nodes = b_tree.nodes.new("ShaderNodeGroup")
    b_nodes.node_tree = b_group
    b_rgb = b_tree.nodes.new("ShaderNodeRGB")
    b_rgb.outputs[0].default_value = (0.3, 0.6, 0.9, 1.0)
    b_gamma = build.node(b_tree, "ShaderNodeGamma", Gamma=5.0)
    b_gamma.mute = True
    b_reroute = b_tree.nodes.new("NodeReroute")
    b_tree.links.new(b_rgb.outputs[0], b_gamma.inputs["Color"])
    b_tree.links.new(b_gamma.outputs[0], b_nodes.inputs[0])
    b_tree.links.new(b_nodes.outputs[0], b_reroute.inputs[0])
    b_tree.links.new(b_reroute.outputs[0], b_output.inputs["Surface"])
    assert only(closures(b_material)) == approx(
        {"kind": "diffuse", "color": [0.3, 0.6, 0.9], "roughness": 0.0}
    )
    assert not any("Material" in text for text in problems())


def test_unlinked_group_input_is_the_group_nodes_value(scene, closures):
    b_group = bpy.data.node_groups.new("Paint", "ShaderNodeTree")
    b_group.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor")
    b_group.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
    b_in, b_out = b_group.nodes.new("NodeGroupInput"), b_group.nodes.new("NodeGroupOutput")
    b_group.links.new(b_in.outputs[0], b_out.inputs[0])
    b_material, b_tree, b_output = build.material()
    b_nodes = b_tree.nodes.new("ShaderNodeGroup")
    b_nodes.node_tree = b_group
    b_nodes.inputs[0].default_value = (0.2, 0.4, 0.8, 1.0)
    b_shader = b_tree.nodes.new("ShaderNodeBsdfDiffuse")
    b_tree.links.new(b_nodes.outputs[0], b_shader.inputs["Color"])
    build.connect(b_tree, b_shader, b_output, "Surface")
    assert only(closures(b_material))["color"] == pytest.approx([0.2, 0.4, 0.8])


def test_unlinked_reroute_has_no_value(scene, closures):
    b_material, b_tree, b_output = build.material()
    b_shader = build.node(b_tree, "ShaderNodeBsdfDiffuse", Color=(0.1, 0.2, 0.3))
    b_reroute = b_tree.nodes.new("NodeReroute")
    b_tree.links.new(b_reroute.outputs[0], b_shader.inputs["Color"])
    build.connect(b_tree, b_shader, b_output, "Surface")
    assert only(closures(b_material))["color"] == pytest.approx([0.1, 0.2, 0.3])


def test_output_without_surface_is_black(scene, closures):
    b_material, _, _ = build.material()
    assert closures(b_material) == []


def test_material_without_output_is_black_and_reported(scene, closures, problems):
    b_material, b_tree, _ = build.material()
    b_tree.nodes.clear()
    assert closures(b_material) == []
    assert "Material: it has no Material Output node; black is used" in problems()


def test_an_output_of_another_kind_is_none(scene, closures, problems):
    b_material, b_tree, _ = build.material()
    b_tree.nodes.clear()
    b_tree.nodes.new("ShaderNodeOutputLight")
    assert closures(b_material) == []
    assert "Material: it has no Material Output node; black is used" in problems()


@pytest.mark.skipif(bpy.app.version >= (5, 0), reason="from Blender 5.0 on every material has nodes")
def test_material_that_does_not_use_nodes(scene, closures):
    b_material = bpy.data.materials.new("Material")
    b_material.diffuse_color = (0.1, 0.2, 0.3, 1.0)
    assert only(closures(b_material)) == approx({"kind": "diffuse", "color": [0.1, 0.2, 0.3]})


def test_driven_value_arrives(scene, closures):
    b_material = build.surface("ShaderNodeBsdfDiffuse")
    b_tree = b_material.node_tree
    b_value = b_tree.nodes.new("ShaderNodeValue")
    b_curve = b_value.outputs[0].driver_add("default_value")
    b_curve.driver.expression = "0.375"
    b_tree.links.new(b_value.outputs[0], b_tree.nodes["Diffuse BSDF"].inputs["Color"])
    assert only(closures(b_material))["color"] == pytest.approx([0.375] * 3)


def textured(kind, output=None, **properties):
    b_material, b_tree, b_output = build.material()
    b_texture = b_tree.nodes.new(kind)
    for key, value in properties.items():
        setattr(b_texture, key, value)
    b_shader = b_tree.nodes.new("ShaderNodeBsdfDiffuse")
    build.connect(b_tree, b_texture, b_shader, "Color", output)
    build.connect(b_tree, b_shader, b_output, "Surface")
    return b_material


def test_image_stands_beside_its_linear_mean(scene, closures, recorded, problems):
    b_image = bpy.data.images.new("Chess", 2, 2)
    b_image.pixels.foreach_set(np.array([[1, 1, 1, 1], [0.5, 0.5, 0.5, 1]] * 2, np.float32).ravel())
    closure = only(closures(textured("ShaderNodeTexImage", image=b_image)))
    # 0.5 is kept as 128/255, which is 0.2158 linear (IEC 61966-2-1).
    assert closure["color"] == pytest.approx([(1.0 + 0.2158605) / 2] * 3, abs=1e-5)
    assert not any("Image Texture" in text for text in problems())
    (texture,) = recorded.last.textures
    assert (texture["name"], texture["encoding"]) == ("Chess", "srgb")
    assert texture["pixels"].dtype == np.uint8
    assert texture["pixels"][..., 0].tolist() == [[255, 128], [255, 128]]
    program = recorded.last.material_of("Material")["program"]
    assert program["outputs"] == [{"closure": 0, "input": "color", "register": 1}]
    assert [step["op"] for step in program["instructions"]] == ["attribute", "image"]
    assert program["normal"] is None


def test_data_image_is_taken_as_it_is(scene, closures, recorded):
    b_image = bpy.data.images.new("Data", 2, 2)
    b_image.colorspace_settings.name = "Non-Color"
    b_image.pixels.foreach_set(np.tile(np.array([0.2, 0.4, 0.6, 1], np.float32), 4))
    color = only(closures(textured("ShaderNodeTexImage", image=b_image)))["color"]
    assert color == pytest.approx([0.2, 0.4, 0.6], abs=1 / 255)
    assert recorded.last.textures[0]["encoding"] == "linear"


def test_an_image_is_handed_over_once(scene, closures, recorded):
    b_image = bpy.data.images.new("Shared", 2, 2)
    b_other = textured("ShaderNodeTexImage", image=b_image)
    b_other.name = "Other"
    b_mesh = build.cube()
    b_mesh.materials.append(b_other)
    build.add_object("Another", b_mesh)
    closures(textured("ShaderNodeTexImage", image=b_image))
    assert len(recorded.last.textures) == 1


def test_alpha_is_multiplied_into_the_color(scene, closures, recorded):
    b_image = bpy.data.images.new("Leaf", 1, 1, alpha=True)
    b_image.pixels.foreach_set(np.array([1.0, 0.5, 0.0, 0.5], np.float32))
    closures(textured("ShaderNodeTexImage", image=b_image))
    assert recorded.last.textures[0]["pixels"].tolist() == [[[128, 64, 0, 128]]]


def test_the_mesh_carries_the_layers_that_are_read(scene, closures, recorded, problems):
    b_material = textured("ShaderNodeUVMap", uv_map="Missing")
    closures(b_material)
    assert recorded.last.meshes[0]["layers"] == []
    expected = 'Quad: its material reads the UV map "Missing", which the mesh does not have; 0 is used'
    assert expected in problems()


def test_what_varies_reaches_the_share_of_a_closure(scene, closures, recorded):
    b_material, b_tree, b_output = build.material()
    b_mix = mixed(b_tree, 0.0, diffuse(b_tree, 0.1), diffuse(b_tree, 0.2))
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeTexGradient"), b_mix, "Fac", "Fac")
    build.connect(b_tree, b_mix, b_output, "Surface")
    assert [part["weight"] for part in closures(b_material)] == [[0.5] * 3, [0.5] * 3]
    outputs = recorded.last.material_of("Material")["program"]["outputs"]
    assert [(output["closure"], output["input"]) for output in outputs] == [(0, "weight"), (1, "weight")]


def test_displacement_is_a_bump(scene, closures, recorded, problems):
    b_material, b_tree, b_output = build.material()
    b_material.displacement_method = "DISPLACEMENT"
    b_displacement = b_tree.nodes.new("ShaderNodeDisplacement")
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeTexNoise"), b_displacement, "Height")
    build.connect(b_tree, b_displacement, b_output, "Displacement")
    build.connect(b_tree, diffuse(b_tree, 0.5), b_output, "Surface")
    closures(b_material)
    program = recorded.last.material_of("Material")["program"]
    assert program["instructions"][program["normal"]]["op"] == "bump"
    assert program["outputs"] == []
    assert "Material: its Displacement is rendered as a bump" in problems()


def test_what_may_emit_somewhere_counts_as_a_light(scene, problems):
    b_material, b_tree, b_output = build.material()
    b_emission = b_tree.nodes.new("ShaderNodeEmission")
    b_path = b_tree.nodes.new("ShaderNodeLightPath")
    build.connect(b_tree, b_path, b_emission, "Strength", "Is Diffuse Ray")
    build.connect(b_tree, b_emission, b_output, "Surface")
    b_mesh = build.quad()
    b_mesh.materials.append(b_material)
    build.add_object("Quad", b_mesh)
    build.add_camera()
    bpy.ops.render.render()
    assert not any("no light" in text for text in problems())


def test_a_constant_tree_has_no_program(scene, closures, recorded):
    b_material, b_tree, b_output = build.material()
    b_value = build.node(b_tree, "ShaderNodeMath")
    b_shader = b_tree.nodes.new("ShaderNodeBsdfDiffuse")
    build.connect(b_tree, b_value, b_shader, "Color")
    build.connect(b_tree, b_shader, b_output, "Surface")
    closures(b_material)
    assert "program" not in recorded.last.material_of("Material")


def test_constants_that_only_the_core_can_compute_have_one(scene, closures, recorded, problems):
    b_material, b_tree, b_output = build.material()
    b_value = build.node(b_tree, "ShaderNodeVectorMath")
    b_value.operation = "CROSS_PRODUCT"
    b_shader = b_tree.nodes.new("ShaderNodeBsdfDiffuse")
    build.connect(b_tree, b_value, b_shader, "Color")
    build.connect(b_tree, b_shader, b_output, "Surface")
    closures(b_material)
    operations = [step["op"] for step in recorded.last.material_of("Material")["program"]["instructions"]]
    assert operations == ["constant", "vector_math"]
    assert not any("Vector Math" in text for text in problems())


def test_missing_image_is_magenta_and_reported(scene, closures, problems):
    b_image = bpy.data.images.new("Lost", 1, 1)
    b_image.source = "FILE"
    b_image.filepath = "//nowhere/lost.png"
    closure = only(closures(textured("ShaderNodeTexImage", image=b_image)))
    assert closure["color"] == [1.0, 0.0, 1.0]
    assert any('the image "Lost" cannot be read' in text for text in problems())


def test_texture_node_without_image(scene, closures, problems):
    assert only(closures(textured("ShaderNodeTexImage")))["color"] == [1.0, 0.0, 1.0]
    assert any("it has no image" in text for text in problems())


def test_checker_is_the_mean_of_its_colors(scene, closures):
    b_material = textured("ShaderNodeTexChecker")
    b_checker = b_material.node_tree.nodes["Checker Texture"]
    b_checker.inputs["Color1"].default_value = (1.0, 0.0, 0.5, 1.0)
    b_checker.inputs["Color2"].default_value = (0.0, 1.0, 0.5, 1.0)
    assert only(closures(b_material))["color"] == pytest.approx([0.5] * 3)


def test_unknown_node_is_replaced_by_the_sockets_own_value_and_reported_once(scene, closures, problems):
    b_material = textured("ShaderNodeAttribute")
    b_material.node_tree.nodes["Diffuse BSDF"].inputs["Color"].default_value = (0.1, 0.2, 0.3, 1.0)
    b_mesh = build.cube()
    b_mesh.materials.append(b_material)
    build.add_object("Another", b_mesh)
    assert only(closures(b_material))["color"] == pytest.approx([0.1, 0.2, 0.3])
    expected = 'Material: node "Attribute": not supported yet; (0.1, 0.2, 0.3) is used for Color instead'
    assert problems().count(expected) == 1


@pytest.mark.parametrize("kind", ["BsdfToon", "BsdfHair"])
def test_other_shaders_become_diffuse(scene, closures, problems, kind):
    b_material = build.surface(f"ShaderNode{kind}", Color=(0.2, 0.4, 0.6))
    assert only(closures(b_material)) == approx({"kind": "diffuse", "color": [0.2, 0.4, 0.6]})
    assert any("this shader is not supported yet; Diffuse is used instead" in text for text in problems())


@pytest.mark.parametrize(
    ("kind", "inputs", "expected"),
    [
        ("BsdfTranslucent", {"Color": (0.2, 0.4, 0.6)}, {"kind": "translucent", "color": [0.2, 0.4, 0.6]}),
        (
            "BsdfSheen",
            {"Color": (0.2, 0.4, 0.6), "Roughness": 0.3},
            {"kind": "sheen", "color": [0.2, 0.4, 0.6], "roughness": 0.3},
        ),
        ("Holdout", {}, {"kind": "holdout"}),
    ],
)
def test_translucent_sheen_and_holdout(scene, closures, problems, kind, inputs, expected):
    assert only(closures(build.surface(f"ShaderNode{kind}", **inputs))) == approx(expected)
    assert not [text for text in problems() if text.startswith("Material")]


def test_subsurface_scattering_is_diffuse_and_reported_once(scene, closures, problems):
    message = "subsurface scattering is approximated: light leaves where it enters, as from Diffuse"
    b_node = build.surface("ShaderNodeSubsurfaceScattering", Color=(0.2, 0.4, 0.6))
    assert only(closures(b_node)) == approx({"kind": "diffuse", "color": [0.2, 0.4, 0.6]})
    assert [text for text in problems() if message in text] == [
        f'Material: node "Subsurface Scattering": {message}'
    ]


@pytest.mark.parametrize("weight", [0.0, 0.5])
def test_principled_subsurface_keeps_its_albedo(scene, closures, problems, weight):
    b_material = build.surface("ShaderNodeBsdfPrincipled", Subsurface_Weight=weight)
    record = only(closures(b_material))
    assert record["kind"] == "principled"
    assert "subsurface_weight" not in record
    assert any("subsurface scattering is approximated" in text for text in problems()) == (weight > 0.0)


@pytest.mark.parametrize("name", ["Anisotropic"])
def test_principled_inputs_that_are_left_out(scene, closures, problems, name):
    closures(build.surface("ShaderNodeBsdfPrincipled", **{name.replace(" ", "_"): 0.5}))
    assert f'Material: node "Principled BSDF": {name} is not supported yet; left out' in problems()


def test_displacement_and_volume_are_reported(scene, closures, recorded, problems):
    b_material, b_tree, b_output = build.material()
    b_shader = b_tree.nodes.new("ShaderNodeBsdfDiffuse")
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeBump"), b_shader, "Normal")
    build.connect(b_tree, b_shader, b_output, "Surface")
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeVectorDisplacement"), b_output, "Displacement")
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeVolumeScatter"), b_output, "Volume")
    closures(b_material)
    found = [text for text in problems() if text.startswith("Material")]
    assert found == [
        "Material: this Displacement is not supported yet; left out",
        'Material: node "Volume Scatter": as a volume this is not supported yet; left out',
    ]
    program = recorded.last.material_of("Material")["program"]
    assert program["instructions"][program["normals"][0]["register"]]["op"] == "bump"
