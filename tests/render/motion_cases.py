"""Tiny scenes in which something moves while the shutter is open, on the floor of `cases.py`."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import bpy

from scenes import common
from tests.render import cases, path_cases
from tests.render.cases import BLUE, GOLD, shader

SHUTTER = 1.0
"""Frames: half of the time from the first key to the last."""


def animate(b_id: Any, path: str, values: tuple[Any, Any], action: Any = None) -> None:
    """Values at the frames 0 and 2, straight between."""
    for frame, value in zip((0, 2), values, strict=True):
        setattr(b_id, path, value)
        b_id.keyframe_insert(path, frame=frame)
    for curve in _curves((action or b_id).animation_data.action):
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"


def _curves(action: Any) -> Iterator[Any]:
    """The action's curves, in whatever layers this Blender keeps them."""
    if not getattr(action, "layers", None):
        yield from action.fcurves
        return
    for strip in action.layers[0].strips:
        for bag in strip.channelbags:
            yield from bag.fcurves


def _ball(surface: cases.Surface) -> bpy.types.Object:
    cases.add_ball(surface)
    return bpy.context.object


def _moving_ball() -> None:
    """Its shadow is blurred as it is."""
    ball = _ball(shader("BsdfDiffuse", Color=BLUE))
    x, y, z = ball.location
    animate(ball, "location", ((x - 1.0, y, z), (x + 1.0, y, z)))
    cases.add_lamp(cases.MATERIAL_LAMP)


def _moving_ball_under_the_sky() -> None:
    """All light is found by gather rays."""
    ball = _ball(shader("BsdfPrincipled", Base_Color=GOLD, Roughness=0.4))
    x, y, z = ball.location
    animate(ball, "location", ((x, y - 0.6, z), (x, y + 0.6, z + 0.8)))
    cases.add_light("world")


def _turning_block() -> None:
    """A quarter of a turn, textured by its own coordinates."""
    block = path_cases.add_polygons(
        "Block", common.box_faces((-0.9, -0.4, 0.01), (0.9, 0.4, 0.9)), path_cases.perforated()
    )
    animate(block, "rotation_euler", ((0.0, 0.0, 0.0), (0.0, 0.0, math.pi)))
    cases.add_lamp(cases.MATERIAL_LAMP)


def _moving_camera() -> None:
    _ball(shader("BsdfDiffuse", Color=BLUE))
    camera = bpy.context.scene.camera
    x, y, z = camera.location
    animate(camera, "location", ((x - 0.4, y, z), (x + 0.4, y, z)))
    cases.add_lamp(cases.MATERIAL_LAMP)


def _changing_shape() -> None:
    ball = _ball(shader("BsdfDiffuse", Color=BLUE))
    ball.shape_key_add(name="Basis")
    key = ball.shape_key_add(name="Flat")
    for point in key.data:
        point.co.z *= 0.4
        point.co.x *= 1.3
    animate(key, "value", (0.0, 1.0), ball.data.shape_keys)
    cases.add_lamp(cases.MATERIAL_LAMP)


def _moving_emitter() -> None:
    _ball(shader("BsdfDiffuse", Color=BLUE))
    panel = path_cases.add_polygons(
        "Panel",
        [[(-0.6, -0.6, 2.5), (0.6, -0.6, 2.5), (0.6, 0.6, 2.5), (-0.6, 0.6, 2.5)]],
        shader("Emission", Color=GOLD, Strength=10.0),
    )
    animate(panel, "location", ((-2.0, 0.0, 0.0), (2.0, 0.0, 0.0)))


def _shutter_that_opens_slowly() -> None:
    curve = bpy.context.scene.render.motion_blur_shutter_curve
    curve.curves[0].points[0].location = (0.0, 0.0)
    curve.update()
    bpy.context.scene.render.motion_blur_position = "START"
    _moving_ball()


MOTIONS: dict[str, Callable[[], None]] = {
    "object": _moving_ball,
    "object_under_the_sky": _moving_ball_under_the_sky,
    "turn": _turning_block,
    "camera": _moving_camera,
    "shape": _changing_shape,
    "emitter": _moving_emitter,
    "shutter_curve": _shutter_that_opens_slowly,
}
"""By name: what stands on the floor and moves, and the light."""


def build(name: str) -> bpy.types.Scene:
    """The scene of one of `MOTIONS`, in place of whatever Blender holds."""
    scene = common.start_empty_file()
    cases.add_floor_and_camera()
    scene.render.use_motion_blur = True
    scene.render.motion_blur_shutter = SHUTTER
    MOTIONS[name]()
    scene.frame_set(1)
    return scene
