"""Tiny scenes for ways of light that need more than a ball and a lamp: several bounces, mirrors in mirrors, panes.

As in `cases.py` there is a floor and, where nothing else is said, the lamp is large, so that a path tracer finds it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import bpy

from scenes import common
from tests.render import cases
from tests.render.cases import BLUE, GOLD, TINT, Surface, joined, shader
from tests.render.luminaire_cases import ies_text, luminaire

MIRROR = shader("BsdfGlossy", Color=(0.9, 0.9, 0.9), Roughness=0.0)
RED = (0.7, 0.15, 0.1)
GREEN = shader("VolumeAbsorption", Color=(0.2, 0.8, 0.4), Density=1.5)


def add_polygons(name: str, polygons: Sequence[Sequence[common.Point]], surface: Surface) -> bpy.types.Object:
    """Polygons of one surface."""
    material, tree, output = common.new_material(name)
    tree.links.new(surface(tree), output)
    return common.add_polygons(name, polygons, [material])


def textured(kind: str, strength: float) -> Surface:
    """Light of a checkered or noisy color, by position."""

    def add(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
        pattern, made = tree.nodes.new(f"ShaderNode{kind}"), tree.nodes.new("ShaderNodeEmission")
        place = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(place.outputs["Object"], pattern.inputs["Vector"])
        pattern.inputs["Scale"].default_value = 1.0
        if kind == "TexChecker":
            pattern.inputs["Color1"].default_value = (1.0, 0.8, 0.5, 1.0)
            pattern.inputs["Color2"].default_value = (0.0, 0.02, 0.05, 1.0)
        tree.links.new(pattern.outputs["Color"], made.inputs["Color"])
        made.inputs["Strength"].default_value = strength
        return made.outputs[0]

    return add


def perforated() -> Surface:
    """A checkered mask of Transparent and Diffuse."""
    mixed = joined("MixShader", shader("BsdfTransparent"), shader("BsdfDiffuse", Color=RED))

    def add(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
        output = mixed(tree)
        place, pattern = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeTexChecker")
        pattern.inputs["Scale"].default_value = 2.0
        tree.links.new(place.outputs["Object"], pattern.inputs["Vector"])
        tree.links.new(pattern.outputs["Fac"], output.node.inputs[0])
        return output

    return add


def _wall(x: float = 0.0, y: float = 0.0) -> list[common.Point]:
    """A square of 4 m that stands on the floor: across at depth y, or along at x."""
    if x:
        return [(x, -2.0, 0.0), (x, 2.0, 0.0), (x, 2.0, 4.0), (x, -2.0, 4.0)]
    return [(-2.0, y, 0.0), (2.0, y, 0.0), (2.0, y, 4.0), (-2.0, y, 4.0)]


def _pane(half: float, z: float) -> list[common.Point]:
    return [(-half, -half, z), (half, -half, z), (half, half, z), (-half, half, z)]


def _room() -> None:
    add_polygons("Red", [_wall(x=-1.3)], shader("BsdfDiffuse", Color=RED))
    add_polygons("Blue", [_wall(x=1.3)], shader("BsdfDiffuse", Color=BLUE))
    add_polygons("Back", [_wall(y=1.5)], shader("BsdfDiffuse", Color=(0.8, 0.8, 0.8)))
    cases.add_ball(shader("BsdfDiffuse", Color=(0.7, 0.7, 0.7)))
    cases.add_lamp(cases.MATERIAL_LAMP)


def _closed_room(node: str, distribution: str = "", **sockets: float) -> Callable[[], None]:
    """The lamp shines at the ceiling, out of the picture: all light that is seen met it and more."""

    def add() -> None:
        walls = common.box_faces((-2.0, -4.5, 0.001), (2.0, 2.0, 3.4))
        color = "Base_Color" if node == "BsdfPrincipled" else "Color"
        add_polygons("Walls", walls, shader(node, distribution, **{color: (0.8, 0.8, 0.8)}, **sockets))
        cases.add_ball(shader(node, distribution, **{color: GOLD}, **sockets))
        where = ((0.3, -1.0, 2.7), (0.0, -0.7, 3.4))
        cases.add_lamp(cases.Lamp("AREA", 60.0, {"shape": "SQUARE", "size": 0.4}, where))

    return add


def _ball_before_a_mirror(surface: Surface) -> Callable[[], None]:
    def add() -> None:
        add_polygons("Mirror", [_wall(y=1.2)], MIRROR)
        cases.add_ball(surface)
        cases.add_lamp(cases.MATERIAL_LAMP)

    return add


def below_a_pane(surface: Surface) -> Callable[[], None]:
    """A pane between the lamp and a diffuse ball."""

    def add() -> None:
        add_polygons("Pane", [_pane(1.5, 2.5)], surface)
        cases.add_ball(shader("BsdfDiffuse", Color=BLUE))
        cases.add_lamp(cases.MATERIAL_LAMP)

    return add


def _before_a_screen() -> None:
    """A diffuse ball before a screen of paper that is lit from behind."""
    add_polygons("Screen", [_wall(y=1.2)], shader("BsdfTranslucent", Color=(0.9, 0.6, 0.3)))
    cases.add_ball(shader("BsdfDiffuse", Color=BLUE))
    where = ((0.3, 3.2, 2.6), (0.0, 1.2, 1.4))
    cases.add_lamp(cases.Lamp("AREA", 120.0, {"shape": "SQUARE", "size": 2.0}, where))


def _behind_a_pane() -> None:
    """A diffuse ball behind a pane of glass, 5 cm thick: two faces that refract."""
    low, high = (-1.2, -1.6, 0.02), (1.2, -1.55, 2.5)
    glass = shader("BsdfGlass", Color=TINT, Roughness=0.0, IOR=1.45)
    add_polygons("Pane", common.box_faces(low, high), glass)
    cases.add_ball(shader("BsdfDiffuse", Color=BLUE))
    cases.add_light("world")


def _block_of_glass() -> None:
    """Its sides mirror from within: total inner reflection."""
    glass = shader("BsdfGlass", Color=TINT, Roughness=0.0, IOR=1.6)
    add_polygons("Block", common.box_faces((-0.7, -0.5, 0.01), (0.7, 0.5, 1.2)), glass)
    cases.add_light("world")


def filled(volume: Surface, surface: Surface | None = None) -> Surface:
    """A surface, or none at all, and what is behind it."""

    def add(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
        output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
        tree.links.new(volume(tree), output.inputs["Volume"])
        if surface is not None:
            return surface(tree)
        nothing: bpy.types.NodeSocket = tree.nodes.new("NodeReroute").outputs[0]
        return nothing

    return add


def _in_a_box(surface: Surface, low: common.Point, high: common.Point) -> None:
    """A diffuse ball in a box, and one more beside it."""
    add_polygons("Box", common.box_faces(low, high), surface)
    cases.add_ball(shader("BsdfDiffuse", Color=(0.8, 0.8, 0.8)))


def _through_colored_glass() -> None:
    _in_a_box(filled(GREEN, shader("BsdfGlass", IOR=1.45)), (-1.2, -1.6, 0.02), (1.2, -1.3, 2.5))
    cases.add_light("world")


def _ball_of_colored_glass() -> None:
    cases.add_ball(filled(GREEN, shader("BsdfPrincipled", Roughness=0.0, Transmission_Weight=1.0)))
    cases.add_light("world")


def _in_clear_haze() -> None:
    """Seen, lit and casting its shadow through what has no surface."""
    _in_a_box(filled(GREEN), (-1.1, -1.3, -0.1), (0.4, 1.3, 2.2))
    cases.add_lamp(cases.MATERIAL_LAMP)


def _in_two_hazes() -> None:
    """Where they overlap both absorb light."""
    add_polygons("Other", common.box_faces((-0.3, -1.5, -0.1), (1.2, 0.9, 1.1)), filled(_mixed_volume))
    _in_clear_haze()


def _in_water() -> None:
    """Light comes to the ball and from it through a face that refracts."""
    _in_a_box(filled(GREEN, shader("BsdfGlass", IOR=1.33)), (-1.1, -1.1, 0.01), (1.1, 1.1, 2.0))
    cases.add_light("world")


def _under_water() -> None:
    """All of it, camera and lamp too."""
    _in_a_box(
        filled(shader("VolumeAbsorption", Color=GOLD, Density=0.1)), (-9.0, -9.0, -1.0), (9.0, 9.0, 9.0)
    )
    cases.add_lamp(cases.MATERIAL_LAMP)


def _mixed_volume(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    thin = shader("VolumeAbsorption", Color=RED, Density=0.3)
    return joined("AddShader", thin, joined("MixShader", thin, GREEN, factor=0.3))(tree)


def _below_an_emitter(surface: Surface) -> Callable[[], None]:
    def add() -> None:
        cases.add_ball(shader("BsdfDiffuse", Color=BLUE))
        add_polygons("Panel", [_pane(2.0, 2.5)], surface)

    return add


def _measured(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    """Light that differs from direction to direction as a luminaire's does."""
    made = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(
        luminaire(ies_text((0, 45, 90, 180, 200, 300, 360)), strength=3.0)(tree), made.inputs["Strength"]
    )
    return made.outputs[0]


ROUGH_GLASS = shader("BsdfGlass", "GGX", Color=TINT, Roughness=0.6, IOR=1.45)


def _rough_glass_in_a_world() -> None:
    cases.add_ball(ROUGH_GLASS)
    cases.add_light("world")


def _rough_glass_below_a_lamp() -> None:
    cases.add_ball(ROUGH_GLASS)
    cases.add_lamp(cases.MATERIAL_LAMP)


def _rough_glass_below_an_emitter() -> None:
    """Cycles finds it by chance: where it samples lights, it refracts to where no facet can."""
    cases.add_ball(ROUGH_GLASS)
    panel = add_polygons("Panel", [_pane(2.0, 2.5)], shader("Emission", Color=GOLD, Strength=2.0))
    panel.active_material.cycles.emission_sampling = "NONE"


def _below_a_luminaire() -> None:
    """It is turned and stretched, and with it where it shines."""
    cases.add_ball(shader("BsdfDiffuse", Color=BLUE))
    panel = add_polygons("Luminaire", [_pane(0.5, 0.0)], _measured)
    panel.location, panel.rotation_euler, panel.scale = (0.6, -0.4, 2.7), (0.4, -0.3, 0.5), (1.5, 0.7, 1.2)


PATHS: dict[str, Callable[[], None]] = {
    "diffuse_room": _room,
    "closed_room": _closed_room("BsdfDiffuse"),
    "rough_closed_room": _closed_room("BsdfDiffuse", Roughness=1.0),
    "ggx_closed_room": _closed_room("BsdfPrincipled", "GGX", Roughness=1.0),
    "ggx_metal_closed_room": _closed_room("BsdfPrincipled", "GGX", Roughness=0.8, Metallic=1.0),
    "glossy_closed_room": _closed_room("BsdfGlossy", Roughness=0.8),
    "anisotropic_closed_room": _closed_room("BsdfGlossy", Roughness=0.8, Anisotropy=0.3, Rotation=0.1),
    "mirror_in_mirror": _ball_before_a_mirror(MIRROR),
    "glossy_in_mirror": _ball_before_a_mirror(shader("BsdfGlossy", Color=GOLD, Roughness=0.3)),
    "coat_in_mirror": _ball_before_a_mirror(
        shader("BsdfPrincipled", Base_Color=BLUE, Roughness=0.6, Coat_Weight=1.0, Coat_Roughness=0.0)
    ),
    "tinted_shadow": below_a_pane(shader("BsdfTransparent", Color=(0.9, 0.3, 0.1))),
    "alpha_shadow": below_a_pane(shader("BsdfPrincipled", Base_Color=RED, Alpha=0.4)),
    "perforated_shadow": below_a_pane(perforated()),
    "translucent_screen": _before_a_screen,
    "thin_glass": _behind_a_pane,
    "total_inner_reflection": _block_of_glass,
    "rough_glass_world": _rough_glass_in_a_world,
    "rough_glass_lamp": _rough_glass_below_a_lamp,
    "rough_glass_emitter": _rough_glass_below_an_emitter,
    "colored_glass": _through_colored_glass,
    "colored_glass_ball": _ball_of_colored_glass,
    "absorbing_haze": _in_clear_haze,
    "absorbing_hazes": _in_two_hazes,
    "absorbing_water": _in_water,
    "under_water": _under_water,
    "checkered_emitter": _below_an_emitter(textured("TexChecker", 4.0)),
    "noisy_emitter": _below_an_emitter(textured("TexNoise", 3.0)),
    "measured_emitter": _below_a_luminaire,
    "coated_emitter": _below_an_emitter(
        shader("BsdfPrincipled", Base_Color=BLUE, Emission_Color=GOLD, Emission_Strength=2.0, Coat_Weight=1.0)
    ),
}
"""By name: what stands on the floor, and the light."""


def build(name: str) -> bpy.types.Scene:
    """The scene of one of `PATHS`, in place of whatever Blender holds."""
    scene = common.start_empty_file()
    cases.add_floor_and_camera()
    PATHS[name]()
    return scene
