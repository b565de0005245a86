"""A room that a picture of the sky lights through a window: what a panorama's sampling is worth, without portals."""

from __future__ import annotations

import math

import bpy
import numpy as np

from scenes import common

CREDIT = "A room with a window, built here; its sky is a picture with a sun of 1.4° in it"

_PANORAMA = (512, 256)
_SUN = (-0.35, 0.75, 0.56)
"""Where it stands; through the window it lights the floor."""
_SUN_RADIUS = math.radians(0.7)
_SUN_RADIANCE = np.array([9000.0, 8000.0, 6500.0])
_GRAY, _RED, _WOOD = (0.7, 0.7, 0.7), (0.6, 0.15, 0.1), (0.45, 0.3, 0.15)

# The room, and the window in its far wall: low and high along x, y and z, in meters.
_ROOM = ((-2.0, -3.0, 0.0), (2.0, 3.0, 2.8))
_WINDOW = ((-0.9, 0.9), (0.9, 2.2))


def build() -> bpy.types.Scene:
    """The scene, in place of whatever Blender holds."""
    scene = common.start_empty_file()
    scene.world = _sky()
    gray, wood = common.diffuse_material("Walls", _GRAY), common.diffuse_material("Floor", _WOOD)
    red = common.diffuse_material("Box", _RED)
    left, right, front, _, floor, ceiling = (face[::-1] for face in common.box_faces(*_ROOM))
    common.add_polygons("Walls", [left, right, front, ceiling, *_far_wall()], [gray])
    common.add_polygons("Floor", [floor], [wood])
    common.add_polygons("Box", common.box_faces((0.5, 0.4, 0.0), (1.2, 1.1, 0.8)), [red])
    common.add_camera((-0.6, -2.8, 1.5), (math.radians(84.0), 0.0, math.radians(-10.0)), 1.25, (320, 240))
    return scene


def _far_wall() -> list[list[tuple[float, float, float]]]:
    """Four rectangles round the window, seen from within."""
    (x0, _, z0), (x1, y, z1) = _ROOM
    (left, right), (low, high) = _WINDOW
    spans = ((x0, left, z0, z1), (right, x1, z0, z1), (left, right, z0, low), (left, right, high, z1))
    return [[(a, y, c), (b, y, c), (b, y, d), (a, y, d)] for a, b, c, d in spans]


def _sky() -> bpy.types.World:
    """A world that shows the picture."""
    world = bpy.data.worlds.new("Sky")
    tree = common.shader_tree(world)
    tree.nodes.clear()
    texture, background, output = (
        tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexEnvironment", "Background", "OutputWorld")
    )
    texture.image = _panorama()
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    tree.links.new(background.outputs["Background"], output.inputs["Surface"])
    return world


def _panorama() -> bpy.types.Image:
    """Blue sky above, ground below, and the sun, all directions in one picture."""
    width, height = _PANORAMA
    v, u = np.mgrid[0:height, 0:width] + 0.5
    longitude, latitude = (0.5 - u / width) * math.tau, (v / height - 0.5) * math.pi
    up = np.sin(latitude)
    direction = np.stack([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), up], -1)
    sky = np.array([0.4, 0.7, 1.4]) + (1.0 - np.abs(up))[..., None] * np.array([1.0, 0.8, 0.4])
    radiance = np.where(up[..., None] > 0.0, sky, np.array([0.25, 0.22, 0.18]))
    toward_sun = direction @ (np.array(_SUN) / np.linalg.norm(_SUN))
    radiance[toward_sun > math.cos(_SUN_RADIUS)] = _SUN_RADIANCE
    texels = np.ones((height, width, 4), np.float32)
    texels[..., :3] = radiance
    image = bpy.data.images.new("Sky", width, height, float_buffer=True)
    image.pixels.foreach_set(texels.ravel())
    image.pack()
    return image
