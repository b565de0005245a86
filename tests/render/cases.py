"""Tiny scenes, one for each kind of lamp and each simple material: a floor, a ball, one light.

A case is its name and what differs from the others; `build` makes the scene in the running Blender. The ball fills the
middle of the picture, the floor the rest.

Left out, because Cycles itself has no single answer:
- a perfectly smooth glass or mirror ball under a point lamp of radius 0 or a sun of angle 0: its caustic has measure
  zero for a path tracer, which leaves the light out;
- nodes whose result depends on the sample pattern's order (Ray Portal, volumes in overlapping meshes).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import bpy
from mathutils import Vector

from scenes import common

RESOLUTION = (48, 48)
BALL_RADIUS = 0.8
FLOOR_ALBEDO = (0.6, 0.55, 0.5)
LAMP_COLOR = (1.0, 0.8, 0.6)
CAMERA = (0.0, -4.0, 2.4)
ABOVE = ((0.9, -0.6, 3.2), (0.15, -0.25, 0.7))
"""Out of the picture: where the lamp is, and where it shines."""
BESIDE = ((1.0, 0.4, 1.5), (0.2, -1.6, 0.5))
"""In the picture, beside the ball."""
BEHIND = ((2.2, 5.6, 0.3), CAMERA)
"""In the picture, beyond the floor."""
REGIONS = {"whole": (0.0, 0.0, 1.0, 1.0), "ball": (0.21, 0.27, 0.79, 0.84)}
"""Parts of the frame whose means are compared: left, bottom, right, top. The second holds the ball."""


@dataclass(frozen=True)
class Lamp:
    """A Blender lamp above the ball, tilted; `settings` are properties of the light, angles in radians."""

    kind: str
    energy: float
    settings: dict[str, Any] = field(default_factory=dict)
    where: tuple[common.Point, common.Point] = ABOVE
    """Its place, and where it shines. In the picture the camera sees its own shape, and there is a dim world."""
    scale: common.Point = (1.0, 1.0, 1.0)
    """Of the object: it stretches a spot's cone."""


HALF_SPREAD = math.radians(90.0)
LAMPS = {
    "point": Lamp("POINT", 200.0, {"shadow_soft_size": 0.0}),
    "point_soft": Lamp("POINT", 200.0, {"shadow_soft_size": 0.25, "use_soft_falloff": True}),
    "point_sphere": Lamp("POINT", 200.0, {"shadow_soft_size": 0.25, "use_soft_falloff": False}),
    "point_seen": Lamp("POINT", 60.0, {"shadow_soft_size": 0.25, "use_soft_falloff": False}, BESIDE),
    "spot": Lamp("SPOT", 300.0, {"shadow_soft_size": 0.0, "spot_size": 0.9, "spot_blend": 0.0}),
    "spot_blend": Lamp("SPOT", 300.0, {"shadow_soft_size": 0.0, "spot_size": 0.9, "spot_blend": 0.6}),
    "spot_soft": Lamp(
        "SPOT",
        300.0,
        {"shadow_soft_size": 0.25, "use_soft_falloff": True, "spot_size": 0.9, "spot_blend": 0.6},
    ),
    "spot_sphere": Lamp(
        "SPOT",
        300.0,
        {"shadow_soft_size": 0.25, "use_soft_falloff": False, "spot_size": 0.9, "spot_blend": 0.6},
    ),
    "spot_long": Lamp(
        "SPOT", 300.0, {"shadow_soft_size": 0.0, "spot_size": 0.9, "spot_blend": 0.0}, scale=(1.0, 2.0, 1.0)
    ),
    "spot_wide_blend": Lamp(
        "SPOT", 300.0, {"shadow_soft_size": 0.0, "spot_size": 0.9, "spot_blend": 0.6}, scale=(2.0, 1.0, 1.0)
    ),
    "spot_deep_soft": Lamp(
        "SPOT",
        300.0,
        {"shadow_soft_size": 0.25, "use_soft_falloff": True, "spot_size": 1.4, "spot_blend": 0.6},
        scale=(1.0, 1.0, 2.0),
    ),
    "spot_small_sphere": Lamp(
        "SPOT",
        300.0,
        {"shadow_soft_size": 0.25, "use_soft_falloff": False, "spot_size": 1.4, "spot_blend": 0.6},
        scale=(0.5, 0.5, 1.0),
    ),
    "sun": Lamp("SUN", 2.0, {"angle": 0.0}),
    "sun_angle": Lamp("SUN", 2.0, {"angle": math.radians(12.0)}),
    "sun_seen": Lamp("SUN", 0.02, {"angle": math.radians(6.0)}, BEHIND),
    "area_square": Lamp("AREA", 120.0, {"shape": "SQUARE", "size": 0.9}),
    "area_rectangle": Lamp("AREA", 120.0, {"shape": "RECTANGLE", "size": 1.4, "size_y": 0.5}),
    "area_disk": Lamp("AREA", 120.0, {"shape": "DISK", "size": 1.0}),
    "area_ellipse": Lamp("AREA", 120.0, {"shape": "ELLIPSE", "size": 1.4, "size_y": 0.6}),
    "area_spread": Lamp("AREA", 60.0, {"shape": "SQUARE", "size": 0.9, "spread": HALF_SPREAD}),
    "area_disk_spread": Lamp("AREA", 60.0, {"shape": "DISK", "size": 1.0, "spread": HALF_SPREAD}),
    "area_seen": Lamp("AREA", 60.0, {"shape": "RECTANGLE", "size": 0.6, "size_y": 0.4}, BESIDE),
}
"""By name; `emissive_quad` and `world` stand beside them in `LAMP_CASES`."""
MATERIAL_LAMP = Lamp("AREA", 120.0, {"shape": "SQUARE", "size": 2.0})
"""Large, so that a path tracer finds it behind glass and in mirrors."""

Surface = Callable[[bpy.types.NodeTree], bpy.types.NodeSocket]
"""Adds nodes to a tree and returns the shader socket that goes to the output."""


def shader(node: str, distribution: str = "", **sockets: float | common.Color) -> Surface:
    """One shader node, its distribution of microfacets if not the default, and its sockets by name with underscores
    for spaces."""

    def add(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
        made = tree.nodes.new(f"ShaderNode{node}")
        if distribution:
            made.distribution = distribution
        for name, value in sockets.items():
            target = made.inputs[name.replace("_", " ")]
            target.default_value = (*value, 1.0) if isinstance(value, tuple) else value
        return made.outputs[0]

    return add


def joined(node: str, first: Surface, second: Surface, factor: float | None = None) -> Surface:
    """Two shaders through a Mix Shader with its factor, or an Add Shader."""

    def add(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
        made = tree.nodes.new(f"ShaderNode{node}")
        if factor is not None:
            made.inputs[0].default_value = factor
        for socket, part in zip(made.inputs[-2:], (first, second), strict=True):
            tree.links.new(part(tree), socket)
        return made.outputs[0]

    return add


def bumped(shader: Surface, *normals: str) -> Surface:
    """A shader with a bump of noise for some of its normals, named as its sockets are; the others stay smooth.

    Its slope is taken over a hundredth of a ray's width. Over a tenth, the default, Cycles has no single answer: from
    Blender 5.2 on its rays are a radian wide once they left something diffuse, and what they meet is smoother.
    """

    def add(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
        made = shader(tree)
        noise, bump = tree.nodes.new("ShaderNodeTexNoise"), tree.nodes.new("ShaderNodeBump")
        noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = 3.0, 0.0
        bump.inputs["Strength"].default_value, bump.inputs["Distance"].default_value = 1.0, 0.6
        if "Filter Width" in bump.inputs:  # not in Blender 4.2
            bump.inputs["Filter Width"].default_value = 0.01
        tree.links.new(noise.outputs[0], bump.inputs["Height"])
        for normal in normals:
            tree.links.new(bump.outputs[0], made.node.inputs[normal])
        return made

    return add


def tangential(shader: Surface, axis: str | None = None) -> Surface:
    """A shader with the tangent of a Tangent node: around an axis, or of a UV map that spirals around the ball."""

    def add(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
        made, tangent = shader(tree), tree.nodes.new("ShaderNodeTangent")
        if axis is None:
            tangent.direction_type, tangent.uv_map = "UV_MAP", _add_spiral_map(bpy.context.object.data)
        else:
            tangent.axis = axis
        tree.links.new(tangent.outputs[0], made.node.inputs["Tangent"])
        return made

    return add


def _add_spiral_map(mesh: bpy.types.Mesh) -> str:
    """A second UV map, across the first; its name."""
    first, spiral = mesh.uv_layers[0], mesh.uv_layers.new(name="Spiral")
    for loop in range(len(mesh.loops)):
        u, v = first.data[loop].uv
        spiral.data[loop].uv = (u + v, v - u)
    return spiral.name


GOLD = (0.9, 0.7, 0.4)
BLUE = (0.2, 0.35, 0.7)
TINT = (0.9, 0.95, 0.8)
_diffuse = shader("BsdfDiffuse", Color=BLUE)
_rough_diffuse = shader("BsdfDiffuse", Color=GOLD, Roughness=1.0)
_coated = shader(
    "BsdfPrincipled", Base_Color=BLUE, Roughness=0.5, Metallic=0.6, Coat_Weight=1.0, Coat_Roughness=0.15
)
_brushed = shader("BsdfGlossy", Color=GOLD, Roughness=0.45, Anisotropy=0.6)
MATERIALS: dict[str, Surface] = {
    "diffuse": _diffuse,
    "diffuse_rough_0.3": shader("BsdfDiffuse", Color=BLUE, Roughness=0.3),
    "diffuse_rough_1.0": _rough_diffuse,
    "glossy_0.1": shader("BsdfGlossy", Color=GOLD, Roughness=0.1),
    "glossy_0.3": shader("BsdfGlossy", Color=GOLD, Roughness=0.3),
    "glossy_0.6": shader("BsdfGlossy", Color=GOLD, Roughness=0.6),
    "ggx_glossy": shader("BsdfGlossy", "GGX", Color=GOLD, Roughness=0.6),
    "mirror": shader("BsdfGlossy", Color=GOLD, Roughness=0.0),
    "glass": shader("BsdfGlass", Color=TINT, Roughness=0.0, IOR=1.45),
    "glass_rough": shader("BsdfGlass", Color=TINT, Roughness=0.4, IOR=1.45),
    "refraction": shader("BsdfRefraction", Color=TINT, Roughness=0.0, IOR=1.45),
    "refraction_rough": shader("BsdfRefraction", "GGX", Color=TINT, Roughness=0.4, IOR=1.45),
    "transparent": shader("BsdfTransparent", Color=(0.8, 0.5, 0.3)),
    "transparent_mix": joined("MixShader", _diffuse, shader("BsdfTransparent"), 0.4),
    "translucent": shader("BsdfTranslucent", Color=GOLD),
    "translucent_mix": joined("MixShader", _diffuse, shader("BsdfTranslucent", Color=GOLD), 0.5),
    "holdout_mix": joined("MixShader", _diffuse, shader("Holdout"), 0.4),
    "sheen": shader("BsdfSheen", Color=(0.8, 0.8, 0.8), Roughness=0.7),
    "emission": shader("Emission", Color=GOLD, Strength=1.5),
    "principled_plastic": shader("BsdfPrincipled", Base_Color=BLUE, Roughness=0.4),
    "principled_matte": shader("BsdfPrincipled", Base_Color=BLUE, Roughness=0.9, Specular_IOR_Level=0.2),
    "principled_metal": shader("BsdfPrincipled", Base_Color=GOLD, Roughness=0.35, Metallic=1.0),
    "principled_half_metal": shader("BsdfPrincipled", Base_Color=GOLD, Roughness=0.6, Metallic=0.5),
    "principled_ggx": shader("BsdfPrincipled", "GGX", Base_Color=GOLD, Roughness=1.0),
    "principled_ggx_metal": shader("BsdfPrincipled", "GGX", Base_Color=GOLD, Roughness=1.0, Metallic=1.0),
    "principled_ggx_coat": shader(
        "BsdfPrincipled",
        "GGX",
        Base_Color=GOLD,
        Roughness=0.8,
        Metallic=0.5,
        Coat_Weight=1.0,
        Coat_Roughness=0.5,
    ),
    "principled_coat": shader(
        "BsdfPrincipled", Base_Color=BLUE, Roughness=0.7, Coat_Weight=1.0, Coat_Roughness=0.1, Coat_Tint=TINT
    ),
    "principled_transmission": shader(
        "BsdfPrincipled", Base_Color=TINT, Roughness=0.0, IOR=1.45, Transmission_Weight=1.0
    ),
    "principled_rough_transmission": shader(
        "BsdfPrincipled", Base_Color=TINT, Roughness=0.4, IOR=1.45, Transmission_Weight=1.0
    ),
    "principled_sheen": shader(
        "BsdfPrincipled",
        Base_Color=BLUE,
        Roughness=0.6,
        Sheen_Weight=0.6,
        Sheen_Roughness=0.5,
        Sheen_Tint=GOLD,
    ),
    "principled_alpha": shader("BsdfPrincipled", Base_Color=BLUE, Roughness=0.5, Alpha=0.5),
    "principled_emission": shader(
        "BsdfPrincipled", Base_Color=BLUE, Roughness=0.5, Emission_Color=GOLD, Emission_Strength=0.5
    ),
    "mix": joined("MixShader", _diffuse, shader("BsdfGlossy", Color=GOLD, Roughness=0.4), 0.3),
    "bumped": bumped(_diffuse, "Normal"),
    "bumped_rough": bumped(_rough_diffuse, "Normal"),
    "bumped_glossy": bumped(shader("BsdfGlossy", Color=GOLD, Roughness=0.3), "Normal"),
    "bumped_glass": bumped(
        shader("BsdfPrincipled", Base_Color=TINT, Roughness=0.0, IOR=1.45, Transmission_Weight=1.0), "Normal"
    ),
    "coat_over_bumps": bumped(_coated, "Normal"),
    "coat_bumped": bumped(_coated, "Coat Normal"),
    "coat_and_base_bumped": bumped(_coated, "Normal", "Coat Normal"),
    "bumped_mix": joined(
        "MixShader", bumped(_diffuse, "Normal"), shader("BsdfGlossy", Color=GOLD, Roughness=0.4), 0.3
    ),
    "anisotropic_principled": shader(
        "BsdfPrincipled",
        Base_Color=GOLD,
        Roughness=0.4,
        Metallic=0.8,
        Anisotropic=0.8,
        Anisotropic_Rotation=0.25,
    ),
    "anisotropic_plastic": shader("BsdfPrincipled", Base_Color=BLUE, Roughness=0.8, Anisotropic=0.5),
    "anisotropic_glossy": shader("BsdfGlossy", Color=GOLD, Roughness=0.4, Anisotropy=-0.6, Rotation=0.1),
    "anisotropic_rough": shader("BsdfGlossy", Color=GOLD, Roughness=0.8, Anisotropy=0.3),
    "anisotropic_uv": tangential(_brushed),
    "anisotropic_radial": tangential(_brushed, "X"),
    "anisotropic_bumped": bumped(_brushed, "Normal"),
    "add": joined("AddShader", _diffuse, shader("Emission", Color=GOLD, Strength=0.3)),
}
"""The ball's surface, by name; each is rendered under a constant world and under a square lamp."""
NEW_MATERIALS = {
    f"principled_diffuse_rough_{roughness}": shader(
        "BsdfPrincipled", Base_Color=BLUE, Roughness=0.5, Diffuse_Roughness=roughness
    )
    for roughness in (0.3, 1.0)
} | {
    "anisotropic_metallic": shader(
        "BsdfMetallic", Base_Color=GOLD, Roughness=0.5, Anisotropy=0.9, Rotation=0.1
    )
}
"""Those that Blender 4.2 does not have."""
if bpy.app.version >= (4, 3):
    MATERIALS |= NEW_MATERIALS

LIGHTS = ("world", "lamp")
LAMP_CASES = (*LAMPS, "emissive_quad", "world")
MATERIAL_CASES = tuple(f"{material}/{light}" for material in MATERIALS for light in LIGHTS)
CASES = (*(f"lamp/{name}" for name in LAMP_CASES), *(f"material/{name}" for name in MATERIAL_CASES))


def build(case: str) -> bpy.types.Scene:
    """The scene of a case in `CASES`, in place of whatever Blender holds."""
    kind, name = case.split("/", 1)
    scene = common.start_empty_file()
    add_floor_and_camera()
    if kind == "lamp":
        add_ball(shader("BsdfDiffuse", Color=BLUE))
        add_light(name)
    else:
        material, light = name.split("/")
        add_ball(MATERIALS[material])
        if light == "world":
            add_light("world")
        else:
            add_lamp(MATERIAL_LAMP)
    return scene


def add_floor_and_camera() -> None:
    """A floor of 6 m, and the camera."""
    side = 3.0
    floor = [(-side, -side, 0.0), (side, -side, 0.0), (side, side, 0.0), (-side, side, 0.0)]
    common.add_polygons("Floor", [floor], [common.diffuse_material("Floor", FLOOR_ALBEDO)])
    common.add_camera(CAMERA, (math.radians(66.0), 0.0, 0.0), math.radians(40.0), RESOLUTION)


def add_ball(surface: Surface) -> None:
    """A smooth sphere that stands on the floor."""
    bpy.ops.mesh.primitive_uv_sphere_add(
        segments=96, ring_count=48, radius=BALL_RADIUS, location=(0.0, 0.0, BALL_RADIUS + 0.001)
    )
    ball = bpy.context.object
    ball.data.polygons.foreach_set("use_smooth", [True] * len(ball.data.polygons))
    material, tree, output = common.new_material("Ball")
    tree.links.new(surface(tree), output)
    ball.data.materials.append(material)


def add_light(name: str) -> None:
    """A light of `LAMP_CASES`."""
    if name == "world":
        _add_world(0.5)
    elif name == "emissive_quad":
        _add_emissive_quad()
    else:
        add_lamp(LAMPS[name])


def _add_world(strength: float) -> None:
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*LAMP_COLOR, 1.0)
    background.inputs["Strength"].default_value = strength


def add_lamp(lamp: Lamp) -> None:
    """A lamp in its place."""
    light = bpy.data.lights.new("Lamp", lamp.kind)
    light.energy = lamp.energy
    light.color = LAMP_COLOR
    for setting, value in lamp.settings.items():
        setattr(light, setting, value)
    thing = common.add_object("Lamp", light)
    aim(thing, *lamp.where)
    thing.scale = lamp.scale
    if lamp.where != ABOVE:
        thing.visible_camera = True
        _add_world(0.2)


def _add_emissive_quad() -> None:
    """Shines from both sides, as any emissive mesh does."""
    material, tree, surface = common.new_material("Emissive")
    tree.links.new(shader("Emission", Color=LAMP_COLOR, Strength=40.0)(tree), surface)
    corners = [(-0.45, -0.45, 0.0), (0.45, -0.45, 0.0), (0.45, 0.45, 0.0), (-0.45, 0.45, 0.0)]
    quad = common.add_polygons("Quad", [corners], [material])
    aim(quad, *ABOVE)


def aim(thing: bpy.types.Object, place: common.Point, target: common.Point) -> None:
    """Puts a lamp at a place, its -Z towards the target."""
    thing.location = place
    thing.rotation_euler = (Vector(target) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
