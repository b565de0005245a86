"""Tiny scenes of Principled BSDFs with Thin Wall, which Blender has from 5.2 on; older ones have none of them."""

from __future__ import annotations

from collections.abc import Callable

import bpy

from scenes import common
from tests.render import cases
from tests.render.cases import BLUE, TINT, Surface, shader
from tests.render.path_cases import add_polygons, below_a_pane

_LEAF = (0.5, 0.7, 0.2)


def _glass(roughness: float, color: common.Point = TINT, **inputs: float) -> Surface:
    return shader(
        "BsdfPrincipled",
        Thin_Wall=True,
        Transmission_Weight=1.0,
        Base_Color=color,
        Roughness=roughness,
        IOR=1.45,
        **inputs,
    )


def _leaf(**inputs: float) -> Surface:
    return shader(
        "BsdfPrincipled", Thin_Wall=True, Base_Color=_LEAF, Subsurface_Weight=1.0, Roughness=0.6, **inputs
    )


def _ball(surface: Surface, light: str) -> Callable[[], None]:
    def add() -> None:
        cases.add_ball(surface)
        if light == "world":
            cases.add_light("world")
        else:
            cases.add_lamp(cases.MATERIAL_LAMP)

    return add


def _pane(surface: Surface, light: str) -> Callable[[], None]:
    """Upright, before a diffuse ball and in the way of some of its light."""

    def add() -> None:
        corners = [(-1.2, -1.5, 0.0), (1.2, -1.1, 0.0), (1.2, -1.1, 2.6), (-1.2, -1.5, 2.6)]
        add_polygons("Pane", [corners], surface)
        _ball(shader("BsdfDiffuse", Color=BLUE), light)()

    return add


_SCENES: dict[str, Callable[[], None]] = {
    **{
        f"{name}_{light}": make(_glass(roughness), light)
        for name, make, roughness in (
            ("ball", _ball, 0.0),
            ("rough_ball", _ball, 0.4),
            ("pane", _pane, 0.0),
            ("rough_pane", _pane, 0.4),
        )
        for light in cases.LIGHTS
    },
    "tinted_pane": _pane(_glass(0.0, (0.9, 0.4, 0.2)), "lamp"),
    "tinted_shadow": below_a_pane(_glass(0.0, (0.9, 0.3, 0.1))),
    "rough_shadow": below_a_pane(_glass(0.5)),
    "half_glass": _ball(_glass(0.3, BLUE, Metallic=0.3, Coat_Weight=1.0), "world"),
    "leaf_world": _ball(_leaf(), "world"),
    "leaf_lamp": _ball(_leaf(), "lamp"),
    "leaf_pane": below_a_pane(_leaf(Subsurface_Anisotropy=0.6)),
    "rough_leaf": _ball(_leaf(Diffuse_Roughness=1.0), "lamp"),
}
THIN_WALLS = _SCENES if bpy.app.version >= (5, 2) else {}
"""By name: what stands on the floor, and the light."""


def build(name: str) -> bpy.types.Scene:
    """The scene of one of `THIN_WALLS`, in place of whatever Blender holds."""
    scene = common.start_empty_file()
    cases.add_floor_and_camera()
    THIN_WALLS[name]()
    return scene
