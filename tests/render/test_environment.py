"""Worlds that differ from direction to direction, against Cycles in the same process: a floor and a ball under the sky,
whose picture has to have the same mean, and the sky alone, pixel by pixel."""

import math
from typing import Any

import bpy
import numpy as np
import pytest

from tests.blender import build
from tests.render import pictures

pytestmark = pytest.mark.slow

SIZE = 32
SETTINGS = {"film.filter": "box", "film.filter_width": 1.0, "photon_pass.photon_count": 100_000}
SAMPLES = {"gather.rays": 256, "gather.camera_samples": 64, "gather.light_samples": 1}
CYCLES_SAMPLES = 256
MEAN = 0.01


def scene_with(b_world: Any, *, sky_alone: bool) -> bpy.types.Scene:
    """The scene under a world; `sky_alone`: looking past everything."""
    scene = bpy.context.scene
    scene.world = b_world
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    b_camera = build.add_camera((0.0, -5.0, 2.2))
    b_camera.rotation_euler = (1.25, 0.0, 0.0)
    b_white = build.surface("ShaderNodeBsdfDiffuse", Color=(0.6, 0.5, 0.4))
    b_floor = build.quad(size=8.0)
    b_floor.materials.append(b_white)
    build.add_object("Floor", b_floor, (0.0, 0.0, -1e3 if sky_alone else 0.0))
    if sky_alone:
        b_camera.rotation_euler, b_camera.data.angle = (math.pi / 2 + 0.3, 0.0, 0.4), 2.0
        return scene
    b_cube = build.cube()
    b_cube.materials.append(b_white)
    build.add_object("Cube", b_cube, (0.0, 0.0, 1.0))
    return scene


def world() -> tuple[Any, Any, Any]:
    """A world, its nodes and its Background."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    b_world = bpy.data.worlds.new("World")
    b_tree = build.shader_tree(b_world)
    b_background = build.node(b_tree, "ShaderNodeBackground", Strength=1.0)
    build.connect(b_tree, b_background, b_tree.nodes.new("ShaderNodeOutputWorld"), "Surface")
    return b_world, b_tree, b_background


def panorama(projection: str = "EQUIRECTANGULAR", turn: float = 0.0) -> Any:
    """A world that shows a picture with a bright spot, turned about the vertical."""
    b_world, b_tree, b_background = world()
    b_image = bpy.data.images.new("Panorama", 64, 32, float_buffer=True)
    v, u = (np.mgrid[0:32, 0:64] + 0.5) / np.array([32, 64])[:, None, None]
    texels = np.ones((32, 64, 4), np.float32)
    texels[..., :3] = np.stack([0.3 + v, 0.5 + 0.3 * np.cos(2.0 * np.pi * u), 0.2 + v * v], axis=-1)
    texels[24, 20, :3] = 200.0
    b_image.pixels.foreach_set(texels.ravel())
    b_image.pack()
    b_texture = b_tree.nodes.new("ShaderNodeTexEnvironment")
    b_texture.image, b_texture.projection = b_image, projection
    b_mapping = build.node(b_tree, "ShaderNodeMapping", Rotation=(0.0, 0.0, turn))
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeTexCoord"), b_mapping, "Vector", "Generated")
    build.connect(b_tree, b_mapping, b_texture, "Vector")
    build.connect(b_tree, b_texture, b_background, "Color")
    return b_world


def sky(kind: str, *, sun: bool) -> Any:
    """A world with a Sky Texture."""
    b_world, b_tree, b_background = world()
    b_background.inputs["Strength"].default_value = 0.1
    b_sky = b_tree.nodes.new("ShaderNodeTexSky")
    b_sky.sky_type, b_sky.sun_disc = kind, sun
    b_sky.sun_elevation, b_sky.sun_rotation, b_sky.sun_direction = 0.5, 2.7, (0.6, 0.3, 0.5)
    build.connect(b_tree, b_sky, b_background, "Color")
    return b_world


def split_by_camera() -> Any:
    """What the camera sees of it is red."""
    b_world = panorama()
    b_tree = b_world.node_tree
    b_output = next(b_node for b_node in b_tree.nodes if b_node.type == "OUTPUT_WORLD")
    b_lit = next(b_node for b_node in b_tree.nodes if b_node.type == "BACKGROUND")
    b_mix = b_tree.nodes.new("ShaderNodeMixShader")
    build.connect(b_tree, b_tree.nodes.new("ShaderNodeLightPath"), b_mix, "Fac", "Is Camera Ray")
    build.connect(b_tree, b_lit, b_mix, "Shader")
    b_red = build.node(b_tree, "ShaderNodeBackground", Color=(1.0, 0.0, 0.0), Strength=1.0)
    build.connect(b_tree, b_red, b_mix, "Shader_001")
    build.connect(b_tree, b_mix, b_output, "Surface")
    return b_world


def both(scene: bpy.types.Scene) -> tuple[Any, Any]:
    """Our picture and that of Cycles."""
    pictures.use_rgp(scene, {**SETTINGS, **SAMPLES})
    ours = pictures.render(scene)["Combined"]
    scene.render.engine = "CYCLES"
    b_cycles = scene.cycles
    b_cycles.samples, b_cycles.use_denoising, b_cycles.use_adaptive_sampling = CYCLES_SAMPLES, False, False
    b_cycles.pixel_filter_type, b_cycles.filter_width = "BOX", 1.0
    b_cycles.max_bounces = b_cycles.diffuse_bounces = 32
    b_cycles.sample_clamp_indirect = 0.0
    return ours, pictures.render(scene)["Combined"]


def skies() -> list[str]:
    """Models of the Blender in use that are rendered as they are."""
    kinds = bpy.types.ShaderNodeTexSky.bl_rna.properties["sky_type"].enum_items.keys()
    return [kind for kind in kinds if kind != "HOSEK_WILKIE"]


@pytest.mark.parametrize(
    "make",
    [
        panorama,
        lambda: panorama("MIRROR_BALL"),
        lambda: panorama(turn=math.pi / 2),
        split_by_camera,
        *(lambda kind=kind: sky(kind, sun=True) for kind in skies()),
    ],
    ids=["panorama", "mirror_ball", "turned", "split_by_camera", *skies()],
)
def test_scene_has_the_mean_of_cycles(make: Any) -> None:
    ours, theirs = both(scene_with(make(), sky_alone=False))
    assert pictures.mean(ours) == pytest.approx(pictures.mean(theirs), rel=MEAN)


@pytest.mark.parametrize("turn", [0.0, math.pi / 2])
def test_panorama_looks_as_in_cycles(turn: float) -> None:
    ours, theirs = both(scene_with(panorama(turn=turn), sky_alone=True))
    assert np.sqrt(((ours - theirs) ** 2).mean()) < 0.02 * np.sqrt((theirs**2).mean())


@pytest.mark.parametrize("kind", skies())
def test_sky_looks_as_in_cycles(kind: str) -> None:
    """The edge of the ground is sharper here than in Cycles' own table, so rows at the horizon differ."""
    ours, theirs = both(scene_with(sky(kind, sun=False), sky_alone=True))
    above = slice(0, SIZE // 2)
    difference = np.sqrt(((ours[above] - theirs[above]) ** 2).mean()) / theirs[above].mean()
    assert difference < 0.02
