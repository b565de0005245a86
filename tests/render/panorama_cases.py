"""Cameras that see all around, in a room of colored walls: every kind of panorama, and what else a camera does."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import bpy

from scenes import common
from tests.render import cases, motion_cases, path_cases
from tests.render.cases import BLUE, GOLD, shader

RESOLUTION = (48, 36)
"""Not square: some panoramas are stretched with the frame, others are cropped by it."""
_GREEN, _GRAY = (0.15, 0.5, 0.2), (0.7, 0.7, 0.7)
KINDS = {
    "equirectangular": {"panorama_type": "EQUIRECTANGULAR"},
    "equirectangular_part": {
        "panorama_type": "EQUIRECTANGULAR",
        "longitude_min": -1.0,
        "longitude_max": 2.0,
        "latitude_min": -1.2,
        "latitude_max": 0.4,
        "shift_x": 0.1,
        "shift_y": -0.2,
    },
    "cubemap_face": {"panorama_type": "EQUIANGULAR_CUBEMAP_FACE"},
    "mirror_ball": {"panorama_type": "MIRRORBALL"},
    "fisheye_equidistant": {"panorama_type": "FISHEYE_EQUIDISTANT", "fisheye_fov": 3.8},
    "fisheye_equisolid": {"panorama_type": "FISHEYE_EQUISOLID", "fisheye_fov": 3.4, "fisheye_lens": 9.0},
    "fisheye_polynomial": {
        "panorama_type": "FISHEYE_LENS_POLYNOMIAL",
        "fisheye_fov": 1.9,
        "sensor_width": 60.0,
        "fisheye_polynomial_k0": -0.01,
        "fisheye_polynomial_k1": -0.03,
        "fisheye_polynomial_k2": -2e-4,
        "fisheye_polynomial_k3": 1e-6,
        "fisheye_polynomial_k4": 1e-8,
    },
    "cylindrical": {
        "panorama_type": "CENTRAL_CYLINDRICAL",
        "central_cylindrical_range_u_min": -2.5,
        "central_cylindrical_range_v_min": -1.5,
        "central_cylindrical_range_v_max": 1.0,
        "central_cylindrical_radius": 1.2,
    },
}
"""Settings of the camera, by name."""
WINDOWS = tuple(name for name in KINDS if name != "fisheye_polynomial")
"""Those whose place in the picture nodes can ask for."""


def see_all_around(settings: dict[str, Any]) -> None:
    """Makes the camera panoramic."""
    b_camera = bpy.context.scene.camera.data
    b_camera.type = "PANO"
    for name, value in settings.items():
        setattr(b_camera, name, value)


def _level(z: float) -> list[common.Point]:
    return [(-3.0, -3.0, z), (3.0, -3.0, z), (3.0, 3.0, z), (-3.0, 3.0, z)]


def _wall(x: float = 0.0, y: float = 0.0) -> list[common.Point]:
    """A square that stands across at y, or along at x."""
    ends = [(x, -3.0), (x, 3.0)] if x else [(-3.0, y), (3.0, y)]
    (a, b), (c, d) = ends
    return [(a, b, 0.0), (c, d, 0.0), (c, d, 3.3), (a, b, 3.3)]


def add_room(surface: Callable[[common.Color], cases.Surface]) -> None:
    """A room and a ball; the camera stands beside it and looks down a little."""
    common.add_camera(cases.CAMERA, (0.0, 0.0, 0.0), 1.0, RESOLUTION)
    for name, wall, color in (
        ("Floor", _level(0.0), cases.FLOOR_ALBEDO),
        ("Ceiling", _level(3.3), _GRAY),
        ("Left", _wall(x=-3.0), path_cases.RED),
        ("Right", _wall(x=3.0), _GREEN),
        ("Back", _wall(y=3.0), _GRAY),
        ("Front", _wall(y=-3.0), BLUE),
    ):
        path_cases.add_polygons(name, [wall], surface(color))
    cases.add_ball(surface(GOLD))
    scene = bpy.context.scene
    scene.camera.location, scene.camera.rotation_euler = (-0.7, -1.6, 1.3), (math.radians(75.0), 0.1, -0.2)


def _lit_room(settings: dict[str, Any]) -> None:
    add_room(lambda color: shader("BsdfDiffuse", Color=color))
    where = ((0.4, 0.3, 2.9), (0.4, 0.3, 0.0))
    cases.add_lamp(cases.Lamp("AREA", 60.0, {"shape": "SQUARE", "size": 1.6}, where))
    # Its edge against the ceiling would be most of what is compared.
    bpy.data.objects["Lamp"].visible_camera = False
    see_all_around(settings)


def _blurred() -> None:
    """A wide lens with a shape of its own."""
    _lit_room(KINDS["equirectangular_part"])
    b_camera = bpy.context.scene.camera.data
    b_dof = b_camera.dof
    b_dof.use_dof, b_dof.focus_distance, b_dof.aperture_fstop = True, 1.5, b_camera.lens * 1e-3 / 0.5
    b_dof.aperture_blades, b_dof.aperture_rotation, b_dof.aperture_ratio = 3, 0.4, 1.5


def _moving() -> None:
    """The camera turns as it goes."""
    _lit_room(KINDS["equirectangular"])
    scene = bpy.context.scene
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, motion_cases.SHUTTER
    x, y, z = scene.camera.location
    motion_cases.animate(scene.camera, "location", ((x - 0.4, y, z), (x + 0.4, y, z)))
    turn, roll, yaw = scene.camera.rotation_euler
    motion_cases.animate(scene.camera, "rotation_euler", ((turn, roll, yaw - 0.4), (turn, roll, yaw + 0.4)))
    scene.frame_set(1)


def _clipped() -> None:
    """What is near, and what is far, is not seen."""
    _lit_room(KINDS["fisheye_equidistant"])
    b_camera = bpy.context.scene.camera.data
    b_camera.clip_start, b_camera.clip_end = 1.4, 4.0


def _window(settings: dict[str, Any]) -> None:
    """Everything shines with its place in the picture, and so does the world behind it."""

    def shining(_color: common.Color) -> cases.Surface:
        def add(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
            place, made = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeEmission")
            tree.links.new(place.outputs["Window"], made.inputs["Color"])
            return made.outputs[0]

        return add

    add_room(shining)
    bpy.data.objects.remove(bpy.data.objects["Ceiling"])
    tree = common.shader_tree(bpy.context.scene.world)
    place = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(place.outputs["Window"], tree.nodes["Background"].inputs["Color"])
    see_all_around({**settings, "shift_x": 0.0, "shift_y": 0.0})


PANORAMAS: dict[str, Callable[[], None]] = {
    **{name: lambda settings=settings: _lit_room(settings) for name, settings in KINDS.items()},
    "depth_of_field": _blurred,
    "motion": _moving,
    "clip": _clipped,
    **{f"window/{name}": lambda name=name: _window(KINDS[name]) for name in WINDOWS},
}
"""By name: what is in the scene."""


def build(name: str) -> bpy.types.Scene:
    """The scene of one of `PANORAMAS`, in place of whatever Blender holds."""
    scene = common.start_empty_file()
    PANORAMAS[name]()
    return scene
