"""Tiny scenes with a floor that catches shadows, before a world that is seen: what is behind a catcher is darkened.

The camera does not see the ball, but in one case: at its edge Cycles counts the ball's share of a pixel twice, a dark
fringe that is no light. Alpha on transparent film is compared in `test_camera.py`.
"""

from __future__ import annotations

from collections.abc import Callable

import bpy

from scenes import common
from tests.render import cases, path_cases
from tests.render.cases import BLUE, GOLD, Lamp, Surface, shader

MATTE = shader("BsdfDiffuse", Color=BLUE)
SUN = Lamp("SUN", 2.0, {"angle": 0.2})


def _scene(ball: Surface, lamp: Lamp | None, *, is_seen: bool = False) -> Callable[[], None]:
    """A ball under a lamp or a brighter world."""

    def add() -> None:
        cases.add_ball(ball)
        bpy.data.objects["Sphere"].visible_camera = is_seen
        cases.add_light("world")
        if lamp is not None:
            cases.add_lamp(lamp)

    return add


def _wall_that_catches() -> None:
    """What the ball takes from the wall, the floor lacks too."""
    _scene(MATTE, cases.MATERIAL_LAMP)()
    corners = [(-2.0, 1.5, 0.0), (2.0, 1.5, 0.0), (2.0, 1.5, 4.0), (-2.0, 1.5, 4.0)]
    surface = shader("BsdfDiffuse", Color=GOLD)
    path_cases.add_polygons("Wall", [corners], surface).is_shadow_catcher = True


def _glossy_floor() -> None:
    """Reflections of the ball take light, and give some."""
    _scene(MATTE, None)()
    (material,) = bpy.data.objects["Floor"].data.materials
    tree = material.node_tree
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(shader("BsdfGlossy", Color=(0.8, 0.8, 0.8), Roughness=0.3)(tree), output.inputs["Surface"])


def _lamp_of_the_ball() -> None:
    """Light that is not there without the ball hides its shadow."""
    _scene(MATTE, cases.MATERIAL_LAMP)()
    bpy.data.objects["Lamp"].is_shadow_catcher = False


CATCHERS: dict[str, Callable[[], None]] = {
    "ball_that_is_seen": _scene(MATTE, None, is_seen=True),
    "world": _scene(MATTE, None),
    "lamp": _scene(MATTE, cases.MATERIAL_LAMP),
    "sun": _scene(MATTE, SUN),
    "mirror_ball": _scene(path_cases.MIRROR, cases.MATERIAL_LAMP),
    "ball_that_shines": _scene(shader("Emission", Color=GOLD, Strength=2.0), cases.MATERIAL_LAMP),
    "wall_and_floor": _wall_that_catches,
    "glossy_floor": _glossy_floor,
    "lamp_that_is_no_catcher": _lamp_of_the_ball,
}
"""By name: what stands on the floor, and its lights."""


def build(name: str) -> bpy.types.Scene:
    """The scene of one of `CATCHERS`, in place of whatever Blender holds."""
    scene = common.start_empty_file()
    cases.add_floor_and_camera()
    bpy.data.objects["Floor"].is_shadow_catcher = True
    CATCHERS[name]()
    return scene
