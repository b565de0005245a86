"""Files that make no sense: a clear message or a plain picture, never a crash, never NaN."""

import math
import sys
import types

import bpy
import numpy as np
import pytest

from rgp_engine import session
from tests.blender import build


def test_no_camera(scene):
    build.add_object("Floor", build.quad())
    with pytest.raises(RuntimeError, match="camera"):
        bpy.ops.render.render()


def test_nodes_in_a_circle(scene, rendered, problems):
    build.lit_room()
    b_material, b_tree, b_output = build.material()
    bpy.data.objects["Floor"].data.materials.append(b_material)
    one, other = (b_tree.nodes.new("ShaderNodeInvert") for _ in range(2))
    b_diffuse = b_tree.nodes.new("ShaderNodeBsdfDiffuse")
    for b_from, b_to in ((one, other), (other, one), (one, one), (one, b_diffuse)):
        b_tree.links.new(b_from.outputs[0], b_to.inputs["Color"])
    build.connect(b_tree, b_diffuse, b_output, "Surface")
    assert rendered()[..., :3].max() > 0.0
    assert any("circle" in text for text in problems()), problems()


def in_a_circle(b_id):
    """Nodes whose emission has a strength that depends on itself."""
    b_tree = build.shader_tree(b_id)
    kind = "World" if isinstance(b_id, bpy.types.World) else "Light"
    b_output = b_tree.nodes.new(f"ShaderNodeOutput{kind}")
    b_emission, b_math = (b_tree.nodes.new(f"ShaderNode{kind}") for kind in ("Emission", "Math"))
    build.connect(b_tree, b_emission, b_output, "Surface")
    build.connect(b_tree, b_math, b_emission, "Strength")
    build.connect(b_tree, b_math, b_math, "Value")


def test_nodes_of_a_world_and_a_lamp_in_a_circle(scene, rendered, problems):
    build.lit_room()
    plain = rendered()
    scene.world = bpy.data.worlds.new("Sky")
    in_a_circle(scene.world)
    in_a_circle(bpy.data.lights["Lamp"])
    assert (rendered() == plain).all(), "a black world, and the lamp's own power"
    for subject in ("Sky", "Lamp"):
        assert any(t.startswith(f"{subject}: its nodes form a circle") for t in problems()), problems()


@pytest.mark.parametrize("kind", ["Math", "AddShader", "MixShader"])
def test_nodes_that_branch_and_meet_again_are_not_followed_on_every_way(scene, rendered, problems, kind):
    """Forty of them have a trillion ways through."""
    build.lit_room()
    b_material, b_tree, b_output = build.material()
    bpy.data.objects["Floor"].data.materials.append(b_material)
    b_last = b_tree.nodes.new("ShaderNodeValue" if kind == "Math" else "ShaderNodeBsdfDiffuse")
    for _ in range(40):
        b_node = b_tree.nodes.new(f"ShaderNode{kind}")
        for b_socket in list(b_node.inputs)[-2:]:
            b_tree.links.new(b_last.outputs[0], b_socket)
        b_last = b_node
    if kind == "Math":
        b_diffuse = b_tree.nodes.new("ShaderNodeBsdfDiffuse")
        b_tree.links.new(b_last.outputs[0], b_diffuse.inputs["Roughness"])
        b_last = b_diffuse
    build.connect(b_tree, b_last, b_output, "Surface")
    assert rendered()[..., :3].max() > 0.0
    assert any("too long a chain" in text for text in problems()) == (kind != "Math"), problems()


def test_a_sky_whose_sun_is_at_no_height(scene, rendered, problems):
    build.lit_room()
    b_material, b_tree, b_output = build.material()
    bpy.data.objects["Floor"].data.materials.append(b_material)
    b_sky, b_diffuse = b_tree.nodes.new("ShaderNodeTexSky"), b_tree.nodes.new("ShaderNodeBsdfDiffuse")
    b_sky.sun_elevation = math.inf
    build.connect(b_tree, b_sky, b_diffuse, "Color")
    build.connect(b_tree, b_diffuse, b_output, "Surface")
    assert np.isfinite(rendered()).all()
    assert any("a typical value is used" in text for text in problems()), problems()


def test_no_light(scene, rendered, problems):
    build.add_camera()
    build.add_object("Floor", build.quad())
    assert (rendered()[..., :3] == 0.0).all()
    assert any("there is no light" in text for text in problems())


def test_empty_scene(scene, rendered, problems):
    build.add_camera()
    assert (rendered()[..., :3] == 0.0).all()
    assert any("there is no surface" in text for text in problems())


def test_frame_without_objects(scene, rendered, problems):
    build.lit_room()
    b_floor = bpy.data.objects["Floor"]
    for frame, is_hidden in ((1, False), (2, True)):
        b_floor.hide_render = is_hidden
        b_floor.keyframe_insert("hide_render", frame=frame)
    scene.frame_set(1)
    assert rendered()[..., :3].max() > 0.0
    scene.frame_set(2)
    assert (rendered()[..., :3] == 0.0).all()
    assert any("there is no surface" in text for text in problems())


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e38])
def test_vertices_that_are_no_numbers(scene, rendered, problems, value):
    build.lit_room()
    b_mesh = build.cube("Broken")
    b_mesh.vertices[0].co.x = value
    build.add_object("Broken", b_mesh, (0, 0, 0.5))
    picture = rendered()
    assert np.isfinite(picture).all()
    assert picture[..., :3].max() > 0.0
    assert any(text.startswith("Broken") for text in problems())


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_transform_that_is_no_number(scene, rendered, problems, value):
    build.lit_room()
    build.add_object("Broken", build.cube(), (value, 0, 0))
    picture = rendered()
    assert np.isfinite(picture).all()
    assert picture[..., :3].max() > 0.0
    assert any(text.startswith("Broken") for text in problems())


def test_object_of_no_size(scene, rendered):
    build.lit_room()
    build.add_object("Nothing", build.cube()).scale = (0, 0, 0)
    build.add_object("Flat", build.cube(), (1, 1, 1)).scale = (1, 1, 0)
    assert np.isfinite(rendered()).all()


def test_faces_without_area(scene, rendered):
    build.lit_room()
    corners = [(0, 0, 1), (1, 0, 1), (2, 0, 1), (0, 0, 1), (0, 1, 1)]
    b_mesh = build.mesh("Slivers", corners, [(0, 1, 2), (0, 3, 1), (0, 1, 4)])
    build.add_object("Slivers", b_mesh)
    assert np.isfinite(rendered()).all()


@pytest.mark.parametrize(
    ("kind", "properties"),
    [
        ("POINT", {"shadow_soft_size": 0.0}),
        ("SPOT", {"shadow_soft_size": 0.0, "spot_size": math.radians(1), "spot_blend": 0.0}),
        ("SUN", {"angle": 0.0}),
        ("AREA", {"size": 0.0}),
        ("AREA", {"size": 1.0, "spread": 0.0}),
    ],
)
def test_lamps_without_extent(scene, rendered, kind, properties):
    build.add_camera()
    build.add_object("Floor", build.quad(size=4.0))
    build.add_light(kind, **properties)
    assert np.isfinite(rendered()).all()


def test_lamp_of_no_size_by_its_objects_scale(scene, rendered):
    build.add_camera()
    build.add_object("Floor", build.quad(size=4.0))
    build.add_light("AREA").scale = (0, 0, 0)
    assert np.isfinite(rendered()).all()


@pytest.mark.parametrize("size", [1e6, 1e-4])
def test_scenes_of_any_size_look_the_same(scene, rendered, size):
    """Blender clips the lamp's power and the camera's range long before: the scene is built at that size."""

    def build_at(scale):
        b_camera = build.add_camera((0, 0, 10 * scale)).data
        b_camera.clip_start, b_camera.clip_end = max(0.1 * scale, 1e-6), 100 * scale
        build.add_object("Floor", build.quad("Floor", 4.0 * scale))
        build.add_object("Block", build.cube("Block"), (0, 0, scale)).scale = (scale,) * 3
        b_lamp = build.add_light("POINT", energy=100.0 * scale * scale, shadow_soft_size=0.1 * scale)
        b_lamp.location = (3 * scale, 3 * scale, 5 * scale)

    build_at(1.0)
    expected = rendered()[..., :3]
    for b_object in list(bpy.data.objects):
        bpy.data.objects.remove(b_object)
    build_at(size)
    found = rendered()[..., :3]
    assert np.isfinite(found).all()
    assert found.mean() == pytest.approx(expected.mean(), rel=0.02)


def test_settings_out_of_range_from_an_animation_are_refused_in_words(scene, monkeypatch):
    """A driver or key frame can go past what the buttons allow; Blender clamps numbers but not every pair."""
    build.lit_room()
    monkeypatch.setattr(session, "core_settings", lambda _scene: {"gather": {"rays": 0}})
    with pytest.raises(RuntimeError, match=r"gather\.rays is 0; allowed is a whole number from 1 to 4096"):
        bpy.ops.render.render()


def test_missing_texture(scene, rendered, problems):
    build.lit_room()
    b_material, b_tree, b_output = build.material()
    b_texture = b_tree.nodes.new("ShaderNodeTexImage")
    b_texture.image = bpy.data.images.new("Lost", 1, 1)
    b_texture.image.source, b_texture.image.filepath = "FILE", "//lost.png"
    b_shader = b_tree.nodes.new("ShaderNodeBsdfDiffuse")
    build.connect(b_tree, b_texture, b_shader, "Color")
    build.connect(b_tree, b_shader, b_output, "Surface")
    bpy.data.objects["Floor"].data.materials.append(b_material)
    picture = rendered()
    assert picture[12, 16, 1] == 0.0
    assert picture[12, 16, 0] == pytest.approx(picture[12, 16, 2])
    assert picture[12, 16, 0] > 0.0
    assert any("Lost" in text for text in problems())


def test_a_single_pixel(scene, rendered):
    build.lit_room()
    scene.render.resolution_x = scene.render.resolution_y = 4
    scene.render.resolution_percentage = 25
    assert rendered().shape == (1, 1, 4)


@pytest.mark.parametrize("what", ["missing", "another version"])
def test_wheel_missing_or_of_another_version(scene, monkeypatch, what):
    stand_in = None
    if what == "another version":
        stand_in = types.ModuleType("rgp_core")
        stand_in.__version__ = "9.9.9"
    monkeypatch.setitem(sys.modules, "rgp_core", stand_in)
    build.lit_room()
    expected = "needs rgp_core .* but 9.9.9 is installed" if stand_in else "wheel rgp_core.* cannot be loaded"
    with pytest.raises(RuntimeError, match=expected):
        bpy.ops.render.render()


@pytest.mark.parametrize("name", ["longitude", "latitude"])
def test_panoramas_of_nothing(scene, name):
    b_camera = build.add_camera().data
    b_camera.type, b_camera.panorama_type = "PANO", "EQUIRECTANGULAR"
    setattr(b_camera, f"{name}_min", 1.0)
    setattr(b_camera, f"{name}_max", 1.0)
    with pytest.raises(RuntimeError, match=f"camera '{scene.camera.name}': its field of view is empty"):
        bpy.ops.render.render()


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 3e38, 0.0])
def test_fisheyes_of_no_polynomial(scene, rendered, value):
    """What Blender lets through is black, or a message with the camera's name."""
    build.lit_room()
    b_camera = scene.camera.data
    b_camera.type, b_camera.panorama_type = "PANO", "FISHEYE_LENS_POLYNOMIAL"
    for power in range(5):
        setattr(b_camera, f"fisheye_polynomial_k{power}", value)
    try:
        assert np.isfinite(rendered()).all()
    except RuntimeError as error:
        assert f"camera '{scene.camera.name}': its lens polynomial is not a number" in str(error)  # noqa: PT017
