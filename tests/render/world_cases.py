"""Worlds: an even color, a gradient, skies, and pictures of all directions, around a floor and a ball."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np

from tests.blender import build as nodes
from tests.render import cases


def world() -> tuple[Any, Any, Any]:
    """A world, its nodes and its Background."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    b_world = bpy.data.worlds.new("World")
    b_tree = nodes.shader_tree(b_world)
    b_background = nodes.node(b_tree, "ShaderNodeBackground", Strength=1.0)
    nodes.connect(b_tree, b_background, b_tree.nodes.new("ShaderNodeOutputWorld"), "Surface")
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
    b_mapping = nodes.node(b_tree, "ShaderNodeMapping", Rotation=(0.0, 0.0, turn))
    nodes.connect(b_tree, b_tree.nodes.new("ShaderNodeTexCoord"), b_mapping, "Vector", "Generated")
    nodes.connect(b_tree, b_mapping, b_texture, "Vector")
    nodes.connect(b_tree, b_texture, b_background, "Color")
    return b_world


def sky(kind: str, *, sun: bool) -> Any:
    """A world with a Sky Texture."""
    b_world, b_tree, b_background = world()
    b_background.inputs["Strength"].default_value = 0.1
    b_sky = b_tree.nodes.new("ShaderNodeTexSky")
    b_sky.sky_type, b_sky.sun_disc = kind, sun
    b_sky.sun_elevation, b_sky.sun_rotation, b_sky.sun_direction = 0.5, 2.7, (0.6, 0.3, 0.5)
    nodes.connect(b_tree, b_sky, b_background, "Color")
    return b_world


def split_by_camera() -> Any:
    """What the camera sees of it is red."""
    b_world = panorama()
    b_tree = b_world.node_tree
    b_output = next(b_node for b_node in b_tree.nodes if b_node.type == "OUTPUT_WORLD")
    b_lit = next(b_node for b_node in b_tree.nodes if b_node.type == "BACKGROUND")
    b_mix = b_tree.nodes.new("ShaderNodeMixShader")
    nodes.connect(b_tree, b_tree.nodes.new("ShaderNodeLightPath"), b_mix, "Fac", "Is Camera Ray")
    nodes.connect(b_tree, b_lit, b_mix, "Shader")
    b_red = nodes.node(b_tree, "ShaderNodeBackground", Color=(1.0, 0.0, 0.0), Strength=1.0)
    nodes.connect(b_tree, b_red, b_mix, "Shader_001")
    nodes.connect(b_tree, b_mix, b_output, "Surface")
    return b_world


def gradient() -> Any:
    """A world that is bright on one side, a gradient of its direction."""
    b_world, b_tree, b_background = world()
    b_gradient, b_ramp = (b_tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexGradient", "ValToRGB"))
    b_ramp.color_ramp.elements[0].color = (0.1, 0.2, 0.5, 1.0)
    b_ramp.color_ramp.elements[1].color = (2.0, 1.2, 0.4, 1.0)
    nodes.connect(b_tree, b_tree.nodes.new("ShaderNodeTexCoord"), b_gradient, "Vector", "Generated")
    nodes.connect(b_tree, b_gradient, b_ramp, "Fac", "Color")
    nodes.connect(b_tree, b_ramp, b_background, "Color")
    return b_world


def skies() -> list[str]:
    """Models of the Blender in use."""
    return list(bpy.types.ShaderNodeTexSky.bl_rna.properties["sky_type"].enum_items.keys())


WORLDS: dict[str, Callable[[], Any]] = {
    "gradient": gradient,
    "panorama": panorama,
    "panorama_turned": lambda: panorama(turn=math.pi / 2),
    "mirror_ball": lambda: panorama("MIRROR_BALL"),
    "split_by_camera": split_by_camera,
    **{f"sky_{kind.lower()}": lambda kind=kind: sky(kind, sun=False) for kind in skies()},
    **{
        f"sky_{kind.lower()}_sun": lambda kind=kind: sky(kind, sun=True)
        for kind in skies()
        if kind not in ("PREETHAM", "HOSEK_WILKIE")
    },
}
"""By name; the even color is among the lamps of `cases.py`."""


def build(name: str) -> bpy.types.Scene:
    """The scene of one of `WORLDS`, in place of whatever Blender holds."""
    b_world = WORLDS[name]()
    scene = bpy.context.scene
    scene.world = b_world
    scene.render.resolution_x, scene.render.resolution_y = cases.RESOLUTION
    cases.add_floor_and_camera()
    cases.add_ball(cases.shader("BsdfDiffuse", Color=cases.BLUE))
    return scene
