"""Lamps and the world as records."""

import math

import bpy
import numpy as np
import pytest

from rgp_engine.export.visibility import ALL, CAMERA, CATCHER
from tests.blender import build

has_exposure = pytest.mark.skipif(
    "exposure" not in bpy.types.Light.bl_rna.properties, reason="Blender 4.5 and later"
)

has_world_override = pytest.mark.skipif(
    "world_override" not in bpy.types.ViewLayer.bl_rna.properties, reason="Blender 4.3 and later"
)


@pytest.fixture
def lamp(export):
    """The one lamp of the exported scene."""

    def get():
        build.add_camera()
        (record,) = export().lamps
        return record

    return get


def test_point(scene, lamp):
    build.add_light(
        "POINT", energy=60.0, color=(1.0, 0.5, 0.25), shadow_soft_size=0.3, use_soft_falloff=False
    )
    record = lamp()
    assert record["power"] == pytest.approx([60.0, 30.0, 15.0])
    assert record["shape"] == {"kind": "point", "radius": pytest.approx(0.3), "soft_falloff": False}
    assert np.array(record["world_from_lamp"])[:3, 3] == pytest.approx([0, 0, 3])
    assert record["casts_shadow"] is True
    expected = ALL - CAMERA | CATCHER
    assert record["visibility"] == expected, "hidden from the camera, as Blender makes new lights"


def test_a_lamp_that_belongs_to_the_objects_on_a_shadow_catcher(scene, lamp):
    build.add_light("POINT").is_shadow_catcher = False
    assert lamp()["visibility"] == ALL - CAMERA


def test_spot(scene, lamp):
    build.add_light("SPOT", energy=8.0, spot_size=math.radians(50), spot_blend=0.4, shadow_soft_size=0.0)
    shape = lamp()["shape"]
    assert shape["kind"] == "spot"
    assert (shape["cone_angle"], shape["blend"]) == pytest.approx((math.radians(50), 0.4))
    assert shape["radius"] == 0.0


def test_sun(scene, lamp):
    build.add_light("SUN", energy=3.5, angle=0.05, use_shadow=False)
    record = lamp()
    assert record["power"] == pytest.approx([3.5] * 3)
    assert record["shape"] == {"kind": "sun", "angle": pytest.approx(0.05)}
    assert record["casts_shadow"] is False


@pytest.mark.parametrize(
    ("shape", "kind", "size"),
    [
        ("SQUARE", "rectangle", [2, 2]),
        ("RECTANGLE", "rectangle", [2, 3]),
        ("DISK", "ellipse", [2, 2]),
        ("ELLIPSE", "ellipse", [2, 3]),
    ],
)
def test_area(scene, lamp, shape, kind, size):
    b_object = build.add_light("AREA", energy=5.0, shape=shape, size=2.0, size_y=3.0, spread=1.5)
    b_object.scale = (2.0, 4.0, 1.0)
    record = lamp()
    assert record["shape"] == {"kind": kind, "size": size, "spread": pytest.approx(1.5)}
    assert record["power"] == pytest.approx([5.0] * 3)
    assert np.linalg.norm(np.array(record["world_from_lamp"])[:3, :2], axis=0) == pytest.approx([2.0, 4.0])


@has_exposure
def test_exposure_and_temperature(scene, lamp):
    b_light = build.add_light("POINT", energy=10.0, color=(1.0, 0.5, 1.0), exposure=1.5).data
    b_light.use_temperature, b_light.temperature = True, 3000.0
    expected = np.array(b_light.temperature_color) * (1.0, 0.5, 1.0) * 10.0 * 2**1.5
    assert lamp()["power"] == pytest.approx(expected, rel=1e-5)


@has_exposure
def test_power_that_is_not_normalized_grows_with_the_area(scene, lamp):
    b_object = build.add_light("AREA", energy=5.0, shape="RECTANGLE", size=2.0, size_y=3.0, normalize=False)
    b_object.scale = (2.0, 1.0, 1.0)
    assert lamp()["power"] == pytest.approx([5.0 * 12.0] * 3, rel=1e-5)


def test_emission_nodes_multiply_the_power(scene, lamp):
    b_light = build.add_light("POINT", energy=10.0).data
    b_tree = build.shader_tree(b_light)
    b_emission = build.node(b_tree, "ShaderNodeEmission", Color=(1.0, 0.5, 0.0), Strength=3.0)
    build.connect(b_tree, b_emission, b_tree.nodes.new("ShaderNodeOutputLight"), "Surface")
    assert lamp()["power"] == pytest.approx([30.0, 15.0, 0.0])


def test_quadratic_falloff_is_the_usual_one(scene, lamp):
    b_light = build.add_light("POINT", energy=1.0).data
    b_tree = build.shader_tree(b_light)
    b_emission = build.node(b_tree, "ShaderNodeEmission", Color=(1.0, 1.0, 1.0))
    b_falloff = build.node(b_tree, "ShaderNodeLightFalloff", Strength=40.0)
    build.connect(b_tree, b_falloff, b_emission, "Strength", output="Quadratic")
    build.connect(b_tree, b_emission, b_tree.nodes.new("ShaderNodeOutputLight"), "Surface")
    assert lamp()["power"] == pytest.approx([40.0] * 3)


def lamp_nodes(kind="AREA", **properties):
    """A lamp whose nodes are an Emission of strength 1, alone: its light, tree and Emission."""
    b_light = build.add_light(kind, energy=10.0, **properties).data
    b_tree = build.shader_tree(b_light)
    b_emission = build.node(b_tree, "ShaderNodeEmission", Color=(1.0, 1.0, 1.0), Strength=1.0)
    build.connect(b_tree, b_emission, b_tree.nodes.new("ShaderNodeOutputLight"), "Surface")
    return b_light, b_tree, b_emission


def asked(record):
    """What the program of a lamp asks of the point of it that is seen."""
    return {step["quantity"] for step in record["program"]["instructions"] if step["op"] == "geometry"}


def test_constant_nodes_need_no_program(scene, lamp, problems):
    _, b_tree, b_emission = lamp_nodes()
    b_emission.inputs["Strength"].default_value = 3.0
    b_color = b_tree.nodes.new("ShaderNodeRGB")
    b_color.outputs[0].default_value = (1.0, 0.5, 0.0, 1.0)
    build.connect(b_tree, b_color, b_emission, "Color")
    record = lamp()
    assert record["power"] == pytest.approx([30.0, 15.0, 0.0])
    assert record["program"] is None
    assert not problems()


def test_mixed_emissions_of_constants(scene, lamp):
    _, b_tree, b_emission = lamp_nodes()
    b_output = next(b_node for b_node in b_tree.nodes if b_node.type == "OUTPUT_LIGHT")
    b_mix = build.node(b_tree, "ShaderNodeMixShader", Fac=0.25)
    b_other = build.node(b_tree, "ShaderNodeEmission", Color=(1.0, 0.0, 0.0), Strength=4.0)
    build.connect(b_tree, b_emission, b_mix, "Shader")
    build.connect(b_tree, b_other, b_mix, "Shader_001")
    build.connect(b_tree, b_mix, b_output, "Surface")
    assert lamp()["power"] == pytest.approx([17.5, 7.5, 7.5])


def test_an_image_becomes_a_program(scene, export, problems):
    build.add_camera()
    _, b_tree, b_emission = lamp_nodes()
    b_texture = b_tree.nodes.new("ShaderNodeTexImage")
    b_texture.image = panorama()
    build.connect(b_tree, b_texture, b_emission, "Color")
    recording = export()
    (record,) = recording.lamps
    assert record["power"] == pytest.approx([10.0] * 3), "the program computes a factor of it"
    assert asked(record) == {"parametric"}
    operations = [step["op"] for step in record["program"]["instructions"]]
    assert "image" in operations
    assert record["program"]["factor"] < len(operations)
    assert recording.textures[0]["pixels"].shape == (4, 8, 4)
    assert not problems()


@pytest.mark.parametrize(
    ("output", "quantity"),
    [
        ("Normal", "object_normal"),
        ("UV", "parametric"),
        ("Object", "object_position"),
        ("Generated", "object_position"),
    ],
)
def test_coordinates_are_those_of_the_lamp(scene, lamp, problems, output, quantity):
    _, b_tree, b_emission = lamp_nodes("POINT")
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeTexCoord"), b_emission, "Color", output)
    assert asked(lamp()) == {quantity}
    assert not problems()


@pytest.mark.parametrize(
    ("kind", "output", "smooth", "varies"),
    [
        ("POINT", "Quadratic", 0.0, False),
        ("POINT", "Quadratic", 2.0, True),
        ("AREA", "Linear", 0.0, True),
        ("SPOT", "Constant", 0.0, True),
        ("SUN", "Quadratic", 0.0, False),
    ],
)
def test_falloff_asks_how_far_the_lamp_is(scene, lamp, problems, kind, output, smooth, varies):
    _, b_tree, b_emission = lamp_nodes(kind)
    b_falloff = build.node(b_tree, "ShaderNodeLightFalloff", Strength=4.0, Smooth=smooth)
    build.connect(b_tree, b_falloff, b_emission, "Strength", output)
    record = lamp()
    if varies:
        assert asked(record) == {"ray_length"}
    else:
        assert record["program"] is None
        assert record["power"] == pytest.approx([40.0] * 3)
    assert not problems()


def test_suns_do_not_fall_off(scene, lamp, problems):
    _, b_tree, b_emission = lamp_nodes("SUN")
    b_falloff = build.node(b_tree, "ShaderNodeLightFalloff", Strength=4.0, Smooth=2.0)
    build.connect(b_tree, b_falloff, b_emission, "Strength", "Linear")
    record = lamp()
    assert asked(record) == set()
    assert [4.0] * 4 in [step.get("value") for step in record["program"]["instructions"]]
    assert not problems()


def test_lamps_tell_what_they_are_asked(scene, lamp):
    _, b_tree, b_emission = lamp_nodes("POINT")
    bpy.data.objects["Lamp"].color, bpy.data.objects["Lamp"].pass_index = (0.1, 0.2, 0.3, 0.4), 7
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeObjectInfo"), b_emission, "Color", "Color")
    record = lamp()
    assert asked(record) == {"object_color"}
    assert record["info"]["color"] == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert record["info"]["index"] == 7.0


def test_what_lamps_do_not_know_is_reported(scene, lamp, problems):
    _, b_tree, b_emission = lamp_nodes("POINT")
    b_info = b_tree.nodes.new("ShaderNodeNewGeometry")
    b_info.label = "Where"
    build.connect(b_tree, b_info, b_emission, "Strength", "Pointiness")
    lamp()
    assert any('Lamp: node "Where"' in text for text in problems())


def test_lamps_have_no_layers(scene, lamp, problems):
    _, b_tree, b_emission = lamp_nodes("POINT")
    b_layer = b_tree.nodes.new("ShaderNodeAttribute")
    b_layer.attribute_name = "Paint"
    build.connect(b_tree, b_layer, b_emission, "Color", "Color")
    lamp()
    assert "Lamp: lamps have no attribute Paint; 0 is used" in problems()


def test_lamps_whose_nodes_emit_nothing_are_left_out(scene, export, problems):
    build.add_camera()
    b_light = build.add_light("POINT", energy=10.0).data
    b_tree = build.shader_tree(b_light)
    b_mix = b_tree.nodes.new("ShaderNodeMixShader")
    build.connect(b_tree, b_mix, b_tree.nodes.new("ShaderNodeOutputLight"), "Surface")
    assert export().lamps == []
    assert "Lamp: its nodes emit nothing; it is left out" in problems()


def test_lamps_without_light_are_left_out(scene, export):
    build.add_camera()
    build.add_light("POINT", "Off", energy=0.0)
    build.add_light("POINT", "Black", color=(0.0, 0.0, 0.0))
    assert export().lamps == []


def test_lamps_are_instanced(scene, export):
    build.add_camera()
    b_collection = bpy.data.collections.new("Lanterns")
    b_collection.objects.link(bpy.data.objects.new("Lantern", bpy.data.lights.new("Lantern", "POINT")))
    for x in (1, 2):
        b_empty = build.add_object(f"Empty{x}", None, (x, 0, 0))
        b_empty.instance_type, b_empty.instance_collection = "COLLECTION", b_collection
    assert sorted(record["world_from_lamp"][0][3] for record in export().lamps) == [1, 2]


def test_portals_give_no_light(scene, export, problems):
    build.add_camera()
    b_light = build.add_light("AREA", "Portal").data
    assert hasattr(b_light, "cycles"), "every Blender that is tested comes with Cycles"
    b_light.cycles.is_portal = True
    assert export().lamps == []
    assert "Portal: light portals are not needed; left out" in problems()


def world_of(scene):
    b_world = bpy.data.worlds.new("World")
    scene.world = b_world
    b_tree = build.shader_tree(b_world)
    return b_tree, b_tree.nodes.new("ShaderNodeOutputWorld")


def test_world_color_times_strength(scene, export):
    build.add_camera()
    b_tree, b_output = world_of(scene)
    b_background = build.node(b_tree, "ShaderNodeBackground", Color=(0.5, 0.25, 1.0), Strength=3.0)
    build.connect(b_tree, b_background, b_output, "Surface")
    scene.render.film_transparent = True
    world = export().world
    assert world["radiance"] == pytest.approx([1.5, 0.75, 3.0])
    assert world["film_transparent"] is True
    assert world["visibility"] == 31


def test_view_layer_without_environment(scene, export):
    build.add_camera()
    b_tree, b_output = world_of(scene)
    b_background = build.node(b_tree, "ShaderNodeBackground", Color=(1.0, 1.0, 1.0), Strength=1.0)
    build.connect(b_tree, b_background, b_output, "Surface")
    scene.view_layers[0].use_sky = False
    assert export().world["radiance"] == [0.0] * 3


@has_world_override
def test_view_layer_with_another_world(scene, export):
    build.add_camera()
    world_of(scene)
    b_other = bpy.data.worlds.new("Other")
    b_tree = build.shader_tree(b_other)
    b_background = build.node(b_tree, "ShaderNodeBackground", Color=(1.0, 0.5, 0.5), Strength=2.0)
    b_output = b_tree.nodes.new("ShaderNodeOutputWorld")
    build.connect(b_tree, b_background, b_output, "Surface")
    b_output.is_active_output = True
    scene.view_layers[0].world_override = b_other
    world = export().world
    assert world["name"] == "Other"
    assert world["radiance"] == pytest.approx([2.0, 1.0, 1.0])


def test_mixed_backgrounds(scene, export):
    build.add_camera()
    b_tree, b_output = world_of(scene)
    b_mix = build.node(b_tree, "ShaderNodeMixShader", Fac=0.25)
    for identifier, strength in (("Shader", 1.0), ("Shader_001", 5.0)):
        b_background = build.node(b_tree, "ShaderNodeBackground", Color=(1.0, 1.0, 1.0), Strength=strength)
        build.connect(b_tree, b_background, b_mix, identifier)
    build.connect(b_tree, b_mix, b_output, "Surface")
    assert export().world["radiance"] == pytest.approx([2.0] * 3)


def environment(scene, b_image):
    """A world that shows an image."""
    b_tree, b_output = world_of(scene)
    b_texture = b_tree.nodes.new("ShaderNodeTexEnvironment")
    b_texture.image = b_image
    b_background = build.node(b_tree, "ShaderNodeBackground", Strength=1.0)
    build.connect(b_tree, b_texture, b_background, "Color")
    build.connect(b_tree, b_background, b_output, "Surface")
    return b_texture


def panorama(texel=2.0):
    """Black below the horizon."""
    b_image = bpy.data.images.new("Panorama", 8, 4, float_buffer=True)
    rows = np.zeros((4, 8, 4), np.float32)
    rows[2:] = texel
    b_image.pixels.foreach_set(rows.ravel())
    return b_image


def test_environment_texture_becomes_a_program(scene, export, problems):
    build.add_camera()
    environment(scene, panorama())
    recording = export()
    assert recording.world["name"] == scene.world.name
    assert recording.world["radiance"] == pytest.approx([1.0] * 3, rel=1e-5), "its mean over the sphere"
    program = recording.world["program"]
    operations = [step["op"] for step in program["instructions"]]
    assert {"geometry", "panorama", "image"} <= set(operations)
    assert program["radiance"] < len(operations)
    assert recording.textures[0]["pixels"].shape == (4, 8, 4)
    assert not problems()


def test_a_constant_world_has_no_program(scene, export):
    build.add_camera()
    b_tree, b_output = world_of(scene)
    b_background = build.node(b_tree, "ShaderNodeBackground", Color=(0.5, 0.25, 1.0), Strength=3.0)
    build.connect(b_tree, b_background, b_output, "Surface")
    recording = export()
    assert recording.world["program"] is None
    assert not recording.textures


def test_missing_environment_picture_is_named(scene, export, problems):
    build.add_camera()
    environment(scene, None)
    assert export().world["program"] is None
    assert any("Environment Texture" in text and "it has no image" in text for text in problems())
    b_image = bpy.data.images.new("Lost", 8, 4)
    b_image.source, b_image.filepath = "FILE", "//nowhere.hdr"
    environment(scene, b_image)
    world = export().world
    assert world["program"] is None
    assert world["radiance"] == [1.0, 0.0, 1.0]
    assert any(scene.world.name in text and '"Lost" cannot be read' in text for text in problems())


def test_pixels_that_are_no_numbers_are_replaced(scene, export, problems):
    build.add_camera()
    b_image = panorama()
    texels = np.ones((4, 8, 4), np.float32)
    texels[1, 2, 0], texels[2, 3, 1], texels[3, 3, 2] = np.nan, np.inf, -np.inf
    b_image.pixels.foreach_set(texels.ravel())
    environment(scene, b_image)
    pixels = export().textures[0]["pixels"]
    assert np.isfinite(pixels).all()
    assert pixels[1, 2, 0] == 0.0
    assert pixels[2, 3, 1] == 65504.0
    assert pixels[3, 3, 2] == 0.0
    assert any(b_image.name in text and "3 pixels are not finite" in text for text in problems())


def test_every_sky_is_a_picture_and_a_sun(scene, export, problems):
    build.add_camera()
    b_tree, b_output = world_of(scene)
    b_sky = b_tree.nodes.new("ShaderNodeTexSky")
    b_background = build.node(b_tree, "ShaderNodeBackground", Strength=1.0)
    build.connect(b_tree, b_sky, b_background, "Color")
    build.connect(b_tree, b_background, b_output, "Surface")
    for b_kind in b_sky.bl_rna.properties["sky_type"].enum_items:
        b_sky.sky_type = b_kind.identifier
        recording = export()
        assert np.isfinite(recording.textures[0]["pixels"]).all()
        has_sun = any(step["op"] == "sun_disk" for step in recording.world["program"]["instructions"])
        assert has_sun == (b_kind.identifier not in ("PREETHAM", "HOSEK_WILKIE"))
        assert not problems()


def test_no_world_is_black(scene, export):
    build.add_camera()
    scene.world = None
    assert export().world["radiance"] == [0.0, 0.0, 0.0]


def test_hidden_world(scene, export):
    build.add_camera()
    world_of(scene)
    assert hasattr(scene.world, "cycles_visibility"), "every Blender that is tested comes with Cycles"
    scene.world.cycles_visibility.camera = False
    scene.world.cycles_visibility.glossy = False
    assert export().world["visibility"] == 31 - 1 - 4


def test_darkness_is_reported_once_nothing_gives_light(scene, export, problems):
    build.add_camera()
    build.add_object("Quad", build.quad())
    export()
    assert any("there is no light" in text for text in problems())
    build.add_light("POINT")
    export()
    assert not any("there is no light" in text for text in problems())
