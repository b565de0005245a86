"""Lamps whose nodes compute their light, over a floor and a ball."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import bpy

from scenes import common
from tests.blender import build as nodes
from tests.render import cases
from tests.render.cases import BESIDE, HALF_SPREAD, Lamp
from tests.render.luminaire_cases import ies_text, luminaire
from tests.render.node_scene import noise_image

POINT = Lamp("POINT", 200.0, {"shadow_soft_size": 0.0})
TURNED = Lamp("POINT", 200.0, POINT.settings, scale=(1.0, 1.5, 0.7))
SPHERE = Lamp("POINT", 200.0, {"shadow_soft_size": 0.4, "use_soft_falloff": False})
SOFT = Lamp("POINT", 200.0, {"shadow_soft_size": 0.4, "use_soft_falloff": True})
SPOT = Lamp("SPOT", 400.0, {"shadow_soft_size": 0.0, "spot_size": 1.2, "spot_blend": 0.3})
SPOT_SPHERE = Lamp("SPOT", 400.0, {**SPOT.settings, "shadow_soft_size": 0.3, "use_soft_falloff": False})
SUN = Lamp("SUN", 2.0, {"angle": 0.0})
WIDE_SUN = Lamp("SUN", 2.0, {"angle": math.radians(40.0)})
AREA = Lamp("AREA", 120.0, {"shape": "RECTANGLE", "size": 1.6, "size_y": 0.8})
DISK = Lamp("AREA", 120.0, {"shape": "DISK", "size": 1.4})
NARROW = Lamp("AREA", 60.0, {**AREA.settings, "spread": HALF_SPREAD}, scale=(1.0, 1.5, 1.0))
SEEN = Lamp("AREA", 60.0, {"shape": "RECTANGLE", "size": 0.8, "size_y": 0.6}, BESIDE)
SPHERE_SEEN = Lamp("POINT", 60.0, {"shadow_soft_size": 0.3, "use_soft_falloff": False}, BESIDE)


@dataclass(frozen=True)
class LampNodes:
    """A lamp, and what adds nodes to its tree: from tree and Emission, whose Strength is 1."""

    lamp: Lamp
    add: Callable[[Any, Any], None]


def _image(coordinate: str = "", scale: float = 1.0) -> Callable[[Any, Any], None]:
    """A picture as the color, by default where the lamp itself puts it."""

    def add(b_tree: Any, b_emission: Any) -> None:
        b_image = b_tree.nodes.new("ShaderNodeTexImage")
        b_image.image = noise_image()
        if coordinate:
            b_mapping = nodes.node(b_tree, "ShaderNodeMapping", Scale=(scale, scale, scale))
            nodes.connect(b_tree, b_tree.nodes.new("ShaderNodeTexCoord"), b_mapping, "Vector", coordinate)
            nodes.connect(b_tree, b_mapping, b_image, "Vector")
        nodes.connect(b_tree, b_image, b_emission, "Color")

    return add


def _noise(coordinate: str, scale: float) -> Callable[[Any, Any], None]:
    """Noise as the color, steep and partly black."""

    def add(b_tree: Any, b_emission: Any) -> None:
        b_noise = nodes.node(b_tree, "ShaderNodeTexNoise", Scale=scale, Detail=1.0)
        nodes.connect(b_tree, b_tree.nodes.new("ShaderNodeTexCoord"), b_noise, "Vector", coordinate)
        b_contrast = nodes.node(b_tree, "ShaderNodeBrightContrast", Contrast=2.0)
        nodes.connect(b_tree, b_noise, b_contrast, "Color", "Color")
        nodes.connect(b_tree, b_contrast, b_emission, "Color")

    return add


def _gobo(b_tree: Any, b_emission: Any) -> None:
    """A chessboard thrown ahead: places at distance 1 along the lamp's axis, from the direction of the light."""
    b_ahead = b_tree.nodes.new("ShaderNodeVectorMath")
    b_ahead.operation = "DIVIDE"
    b_coordinate, b_separate = (b_tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "SeparateXYZ"))
    nodes.connect(b_tree, b_coordinate, b_separate, "Vector", "Normal")
    nodes.connect(b_tree, b_coordinate, b_ahead, "Vector", "Normal")
    nodes.connect(b_tree, b_separate, b_ahead, "Vector_001", "Z")
    b_checker = nodes.node(b_tree, "ShaderNodeTexChecker", Scale=6.0)
    nodes.connect(b_tree, b_ahead, b_checker, "Vector")
    nodes.connect(b_tree, b_checker, b_emission, "Color")


def _gradient_strength(b_tree: Any, b_emission: Any) -> None:
    """A strength that a color ramp makes of the way across the lamp."""
    b_gradient, b_ramp = (b_tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexGradient", "ValToRGB"))
    b_ramp.color_ramp.elements[0].position, b_ramp.color_ramp.elements[1].position = 0.3, 0.7
    nodes.connect(b_tree, b_tree.nodes.new("ShaderNodeTexCoord"), b_gradient, "Vector", "UV")
    nodes.connect(b_tree, b_gradient, b_ramp, "Fac")
    b_math = nodes.node(b_tree, "ShaderNodeMath")
    b_math.operation, b_math.inputs[1].default_value = "MULTIPLY", 3.0
    nodes.connect(b_tree, b_ramp, b_math, "Value")
    nodes.connect(b_tree, b_math, b_emission, "Strength")


def _falloff(output: str, smooth: float) -> Callable[[Any, Any], None]:
    def add(b_tree: Any, b_emission: Any) -> None:
        b_falloff = nodes.node(b_tree, "ShaderNodeLightFalloff", Strength=0.8, Smooth=smooth)
        nodes.connect(b_tree, b_falloff, b_emission, "Strength", output)

    return add


def _blackbody(b_tree: Any, b_emission: Any) -> None:
    nodes.connect(b_tree, nodes.node(b_tree, "ShaderNodeBlackbody", Temperature=2500.0), b_emission, "Color")


def _mixed(b_tree: Any, b_emission: Any) -> None:
    """Two emissions by a picture, and a third added."""
    b_output = next(b_node for b_node in b_tree.nodes if b_node.type == "OUTPUT_LIGHT")
    b_image, b_mix, b_add = (
        b_tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexImage", "MixShader", "AddShader")
    )
    b_image.image = noise_image()
    nodes.connect(b_tree, b_image, b_mix, "Fac")
    for b_to, identifier, color in (
        (b_mix, "Shader_001", (1.0, 0.2, 0.1)),
        (b_add, "Shader_001", (0.0, 0.3, 0.1)),
    ):
        b_other = nodes.node(b_tree, "ShaderNodeEmission", Color=color, Strength=1.0)
        nodes.connect(b_tree, b_other, b_to, identifier)
    nodes.connect(b_tree, b_emission, b_mix, "Shader")
    nodes.connect(b_tree, b_mix, b_add, "Shader")
    nodes.connect(b_tree, b_add, b_output, "Surface")


def _of_the_lamp(b_tree: Any, b_emission: Any) -> None:
    """The color of the object, and what Light Path says of rays that lamps do not tell apart."""
    b_add = b_tree.nodes.new("ShaderNodeVectorMath")
    nodes.connect(b_tree, b_tree.nodes.new("ShaderNodeObjectInfo"), b_add, "Vector", "Color")
    nodes.connect(b_tree, b_tree.nodes.new("ShaderNodeLightPath"), b_add, "Vector_001", "Is Shadow Ray")
    nodes.connect(b_tree, b_add, b_emission, "Color")


def _attribute(b_tree: Any, b_emission: Any) -> None:
    """A property of the object."""
    b_attribute = b_tree.nodes.new("ShaderNodeAttribute")
    b_attribute.attribute_type, b_attribute.attribute_name = "OBJECT", "color"
    nodes.connect(b_tree, b_attribute, b_emission, "Color", "Color")


def _luminaire(*horizontal: float) -> Callable[[Any, Any], None]:
    """An IES Texture of planes at these angles (degrees) as the strength."""

    def add(b_tree: Any, b_emission: Any) -> None:
        strength = luminaire(ies_text(horizontal))(b_tree)
        b_tree.links.new(strength, b_emission.inputs["Strength"])

    return add


LAMPS = {
    "area_image": LampNodes(AREA, _image()),
    "area_image_narrow": LampNodes(NARROW, _image()),
    "area_image_seen": LampNodes(SEEN, _image()),
    "area_image_by_uv_mapped": LampNodes(AREA, _image("UV", 0.4)),
    "disk_image": LampNodes(DISK, _image()),
    "area_gradient_through_ramp": LampNodes(AREA, _gradient_strength),
    "area_mix_and_add": LampNodes(AREA, _mixed),
    "area_falloff_smooth": LampNodes(AREA, _falloff("Quadratic", 4.0)),
    "point_blackbody": LampNodes(POINT, _blackbody),
    "point_image_around": LampNodes(POINT, _image()),
    "point_noise_by_normal": LampNodes(POINT, _noise("Normal", 3.0)),
    "sphere_noise_by_object": LampNodes(SPHERE, _noise("Object", 5.0)),
    "sphere_noise_seen": LampNodes(SPHERE_SEEN, _noise("Normal", 3.0)),
    "point_falloff_smooth": LampNodes(POINT, _falloff("Quadratic", 4.0)),
    "point_falloff_linear": LampNodes(POINT, _falloff("Linear", 0.0)),
    "soft_falloff_constant": LampNodes(SOFT, _falloff("Constant", 1.0)),
    "sphere_falloff_linear_seen": LampNodes(SPHERE_SEEN, _falloff("Linear", 0.0)),
    "spot_gobo_by_normal": LampNodes(SPOT, _gobo),
    "spot_image": LampNodes(SPOT, _image()),
    "spot_sphere_noise_by_object": LampNodes(SPOT_SPHERE, _noise("Object", 4.0)),
    "point_luminaire": LampNodes(TURNED, _luminaire(0, 45, 90, 180, 270, 360)),
    "sphere_luminaire": LampNodes(SPHERE, _luminaire(0, 30, 90)),
    "spot_luminaire": LampNodes(SPOT, _luminaire(0)),
    "sun_blackbody": LampNodes(SUN, _blackbody),
    "sun_image": LampNodes(WIDE_SUN, _image()),
    "object_color": LampNodes(POINT, _of_the_lamp),
    # In Blender 4.2 lamps had no attributes.
    **({"object_attribute": LampNodes(POINT, _attribute)} if bpy.app.version >= (4, 5) else {}),
}
"""By name."""


def build(name: str) -> bpy.types.Scene:
    """The scene of one of `LAMPS`, in place of whatever Blender holds."""
    scene = common.start_empty_file()
    cases.add_floor_and_camera()
    cases.add_ball(cases.shader("BsdfDiffuse", Color=cases.BLUE))
    case = LAMPS[name]
    cases.add_lamp(case.lamp)
    b_object = bpy.data.objects["Lamp"]
    b_object.color = (0.2, 0.5, 0.9, 1.0)
    b_tree = nodes.shader_tree(b_object.data)
    b_emission = nodes.node(b_tree, "ShaderNodeEmission", Color=(1.0, 1.0, 1.0), Strength=1.0)
    nodes.connect(b_tree, b_emission, b_tree.nodes.new("ShaderNodeOutputLight"), "Surface")
    case.add(b_tree, b_emission)
    return scene
