"""Tiny scenes whose lights are linked to some objects, or blocked by some alone (Blender's light linking).

As in `path_cases.py` there is a floor, and lamps are large, so that a path tracer finds them. A second lamp that is
linked to nothing fills the shadows.
"""

from __future__ import annotations

from collections.abc import Callable

import bpy

from scenes import common
from tests.render import cases, path_cases
from tests.render.cases import BLUE, GOLD, Lamp, Surface, shader

ASIDE = ((2.4, -1.2, 2.2), (0.0, 0.0, 0.8))
SUN = Lamp("SUN", 2.0, {"angle": 0.2}, ASIDE)
GRAY = shader("BsdfDiffuse", Color=(0.7, 0.7, 0.7))
MATTE = shader("BsdfDiffuse", Color=BLUE)


def collection(names: str, state: str) -> bpy.types.Collection:
    """A collection of the named objects, all included or all excluded."""
    made = bpy.data.collections.new(f"{state} {names}")
    for name in names.split():
        made.objects.link(bpy.data.objects[name])
    for settings in made.collection_objects:
        settings.light_linking.link_state = state
    return made


def _room(ball: Surface) -> None:
    """A ball before two walls, and a lamp that fills."""
    path_cases.add_polygons(
        "Back", [[(-2.0, 1.5, 0.0), (2.0, 1.5, 0.0), (2.0, 1.5, 4.0), (-2.0, 1.5, 4.0)]], GRAY
    )
    path_cases.add_polygons(
        "Side", [[(-1.3, -2.0, 0.0), (-1.3, 2.0, 0.0), (-1.3, 2.0, 4.0), (-1.3, -2.0, 4.0)]], GRAY
    )
    cases.add_ball(ball)
    bpy.context.object.name = "Ball"
    cases.add_lamp(Lamp("AREA", 30.0, {"shape": "SQUARE", "size": 2.0}, ASIDE))
    bpy.data.objects["Lamp"].name = "Fill"


def _linked(
    lamp: Lamp | None, which: str, names: str, state: str, ball: Surface = MATTE
) -> Callable[[], None]:
    """The room with one more lamp, or a panel that emits; its `which` collection is of the named objects."""

    def add() -> None:
        _room(ball)
        if lamp is None:
            corners = [(-0.8, -0.8, 2.6), (0.8, -0.8, 2.6), (0.8, 0.8, 2.6), (-0.8, 0.8, 2.6)]
            path_cases.add_polygons("Lamp", [corners], shader("Emission", Color=GOLD, Strength=8.0))
        else:
            cases.add_lamp(lamp)
        setattr(bpy.data.objects["Lamp"].light_linking, which, collection(names, state))

    return add


def _below_a_pane() -> None:
    """A pane between the lamp and all else that does not block it, and is lit."""
    _linked(cases.MATERIAL_LAMP, "blocker_collection", "Ball", "INCLUDE")()
    corners = [(-0.6, -0.9, 2.0), (0.3, -0.9, 2.0), (0.3, 0.6, 2.0), (-0.6, 0.6, 2.0)]
    path_cases.add_polygons("Pane", [corners], GRAY)


_AREA = cases.MATERIAL_LAMP
_RECEIVERS, _BLOCKERS = "receiver_collection", "blocker_collection"
LINKINGS: dict[str, Callable[[], None]] = {
    "lights_the_ball": _linked(_AREA, _RECEIVERS, "Ball", "INCLUDE"),
    "lights_all_but_the_ball": _linked(_AREA, _RECEIVERS, "Ball", "EXCLUDE"),
    "sun_lights_floor_and_wall": _linked(SUN, _RECEIVERS, "Floor Side", "INCLUDE"),
    "empty_collection": _linked(_AREA, _RECEIVERS, "", "INCLUDE"),
    "panel_lights_the_ball": _linked(None, _RECEIVERS, "Ball", "INCLUDE"),
    "panel_lights_all_but_the_ball": _linked(None, _RECEIVERS, "Ball", "EXCLUDE"),
    "lamp_not_in_the_mirror": _linked(_AREA, _RECEIVERS, "Ball", "EXCLUDE", path_cases.MIRROR),
    "panel_in_the_mirror_alone": _linked(None, _RECEIVERS, "Ball", "INCLUDE", path_cases.MIRROR),
    "lamp_not_through_glass": _linked(
        _AREA,
        _RECEIVERS,
        "Ball",
        "EXCLUDE",
        shader("BsdfGlass", Color=(1.0, 1.0, 1.0), Roughness=0.0, IOR=1.45),
    ),
    "lamp_in_rough_gloss": _linked(
        _AREA, _RECEIVERS, "Ball Floor", "INCLUDE", shader("BsdfGlossy", Color=GOLD, Roughness=0.3)
    ),
    "ball_casts_no_shadow": _linked(_AREA, _BLOCKERS, "Ball", "EXCLUDE"),
    "ball_alone_casts_shadows": _below_a_pane,
    "ball_casts_no_shadow_of_a_sun": _linked(SUN, _BLOCKERS, "Ball", "EXCLUDE"),
    "ball_casts_no_shadow_of_a_panel": _linked(None, _BLOCKERS, "Ball", "EXCLUDE"),
    "shadow_linked_lamp_in_the_mirror": _linked(_AREA, _BLOCKERS, "Side", "EXCLUDE", path_cases.MIRROR),
}
"""By name: what stands on the floor, and its lights."""


def build(name: str) -> bpy.types.Scene:
    """The scene of one of `LINKINGS`, in place of whatever Blender holds."""
    scene = common.start_empty_file()
    cases.add_floor_and_camera()
    LINKINGS[name]()
    return scene
