"""Constant folding of value and color nodes, each against a number worked out by hand or by Blender."""

import math

import bpy
import pytest

from rgp_engine.export.arithmetic import MATH, blend
from rgp_engine.export.fold import Folder
from rgp_engine.export.nodes import Input
from rgp_engine.report import ProblemLog
from tests.blender import build


@pytest.fixture
def tree(scene):
    return build.material()[1]


@pytest.fixture
def fold(tree):
    """What the node's output folds to, read by a color or by a value input; fails on any report."""

    def run(b_node, identifier=None, into="color"):
        b_shader = tree.nodes.new("ShaderNodeBsdfPrincipled")
        name = {"color": "Base Color", "value": "Roughness"}[into]
        build.connect(tree, b_node, b_shader, name, identifier)
        log = ProblemLog()
        folder = Folder("Material", log)
        result = getattr(folder, into)(Input(build.socket(b_shader.inputs, name), ()))
        assert log.problems == []
        return result

    return run


@pytest.mark.parametrize(
    ("operation", "operands", "expected"),
    [
        ("ADD", (1, 2, 0), 3),
        ("SUBTRACT", (1, 2, 0), -1),
        ("MULTIPLY", (3, 2, 0), 6),
        ("DIVIDE", (3, 2, 0), 1.5),
        ("DIVIDE", (3, 0, 0), 0),
        ("MULTIPLY_ADD", (3, 2, 1), 7),
        ("POWER", (2, 3, 0), 8),
        ("POWER", (-2, 0.5, 0), 0),
        ("LOGARITHM", (8, 2, 0), 3),
        ("SQRT", (9, 0, 0), 3),
        ("INVERSE_SQRT", (4, 0, 0), 0.5),
        ("ABSOLUTE", (-4, 0, 0), 4),
        ("EXPONENT", (1, 0, 0), math.e),
        ("MINIMUM", (1, 2, 0), 1),
        ("MAXIMUM", (1, 2, 0), 2),
        ("LESS_THAN", (1, 2, 0), 1),
        ("GREATER_THAN", (1, 2, 0), 0),
        ("SIGN", (-3, 0, 0), -1),
        ("COMPARE", (1, 1.05, 0.1), 1),
        ("ROUND", (1.5, 0, 0), 2),
        ("FLOOR", (-1.5, 0, 0), -2),
        ("CEIL", (-1.5, 0, 0), -1),
        ("TRUNC", (-1.5, 0, 0), -1),
        ("FRACT", (-0.25, 0, 0), 0.75),
        ("MODULO", (-5, 3, 0), -2),
        ("FLOORED_MODULO", (-5, 3, 0), 1),
        ("WRAP", (7, 5, 2), 4),
        ("SNAP", (7.4, 2, 0), 6),
        ("PINGPONG", (3.5, 2, 0), 0.5),
        ("PINGPONG", (0, 1, 0), 0),
        ("SINE", (1, 0, 0), math.sin(1)),
        ("COSINE", (1, 0, 0), math.cos(1)),
        ("TANGENT", (1, 0, 0), math.tan(1)),
        ("ARCSINE", (0.5, 0, 0), math.asin(0.5)),
        ("ARCCOSINE", (0.5, 0, 0), math.acos(0.5)),
        ("ARCTANGENT", (2, 0, 0), math.atan(2)),
        ("ARCTAN2", (1, -1, 0), math.atan2(1, -1)),
        ("RADIANS", (180, 0, 0), math.pi),
        ("DEGREES", (math.pi, 0, 0), 180),
    ],
)
def test_math(tree, fold, operation, operands, expected):
    b_node = tree.nodes.new("ShaderNodeMath")
    b_node.operation = operation
    for b_socket, operand in zip(b_node.inputs, operands, strict=True):
        b_socket.default_value = operand
    assert fold(b_node, into="value") == pytest.approx(expected, rel=1e-5, abs=1e-6)


def test_every_operation_is_one_of_blenders(scene):
    known = bpy.types.ShaderNodeMath.bl_rna.properties["operation"].enum_items.keys()
    assert set(MATH) <= set(known)


def test_clamped_math(tree, fold):
    b_node = tree.nodes.new("ShaderNodeMath")
    b_node.operation, b_node.use_clamp = "ADD", True
    b_node.inputs[0].default_value, b_node.inputs[1].default_value = 3.0, 4.0
    assert fold(b_node, into="value") == 1.0


@pytest.mark.parametrize(
    ("kind", "at_full_factor"),
    [
        ("MIX", 0.6),
        ("ADD", 1.0),
        ("SUBTRACT", -0.2),
        ("MULTIPLY", 0.24),
        ("DIVIDE", 2 / 3),
        ("DIFFERENCE", 0.2),
        ("EXCLUSION", 0.52),
        ("DARKEN", 0.4),
        ("LIGHTEN", 0.6),
        ("SCREEN", 0.76),
        ("OVERLAY", 0.48),
        ("SOFT_LIGHT", 0.6 * 0.6 * 0.4 + 0.4 * 0.76),
        ("LINEAR_LIGHT", 0.6),
    ],
)
def test_blend_types(kind, at_full_factor):
    """Worked out from the definitions for 0.4 and 0.6, then mixed halfway."""
    expected = 0.5 * 0.4 + 0.5 * at_full_factor
    assert blend(kind, (0.4,) * 3, (0.6,) * 3, 0.5) == pytest.approx((expected,) * 3)


def test_mix_color(tree, fold):
    b_node = tree.nodes.new("ShaderNodeMix")
    b_node.data_type, b_node.blend_type = "RGBA", "MULTIPLY"
    build.socket(b_node.inputs, "Factor_Float").default_value = 0.5
    build.socket(b_node.inputs, "A_Color").default_value = (0.8, 0.4, 0.2, 1.0)
    build.socket(b_node.inputs, "B_Color").default_value = (0.5, 0.5, 1.0, 1.0)
    assert fold(b_node, "Result_Color") == pytest.approx((0.6, 0.3, 0.2))


def test_mix_value(tree, fold):
    b_node = tree.nodes.new("ShaderNodeMix")
    build.socket(b_node.inputs, "Factor_Float").default_value = 0.25
    build.socket(b_node.inputs, "A_Float").default_value = 2.0
    build.socket(b_node.inputs, "B_Float").default_value = 4.0
    assert fold(b_node, "Result_Float", into="value") == pytest.approx(2.5)


def test_old_mix_rgb(tree, fold):
    b_node = build.node(tree, "ShaderNodeMixRGB", Fac=0.5, Color1=(1.0, 0.0, 0.0), Color2=(0.0, 0.0, 1.0))
    assert fold(b_node) == pytest.approx((0.5, 0.0, 0.5))


def test_color_nodes(tree, fold):
    color = (0.2, 0.5, 0.8)
    assert fold(build.node(tree, "ShaderNodeInvert", Fac=1.0, Color=color)) == pytest.approx((0.8, 0.5, 0.2))
    assert fold(build.node(tree, "ShaderNodeGamma", Gamma=2.0, Color=color)) == pytest.approx(
        (0.04, 0.25, 0.64)
    )
    b_bright = build.node(tree, "ShaderNodeBrightContrast", Color=color)
    b_bright.inputs[1].default_value, b_bright.inputs[2].default_value = 0.1, 1.0
    assert fold(b_bright) == pytest.approx((0.0, 0.6, 1.2), abs=1e-6)
    unchanged = build.node(tree, "ShaderNodeHueSaturation", Color=color)
    assert fold(unchanged) == pytest.approx(color)
    gray = build.node(tree, "ShaderNodeHueSaturation", Saturation=0.0, Color=color)
    assert fold(gray) == pytest.approx((0.8,) * 3)
    turned = build.node(tree, "ShaderNodeHueSaturation", Hue=0.5 + 1 / 3, Color=(1.0, 0.0, 0.0))
    assert fold(turned) == pytest.approx((0.0, 1.0, 0.0), abs=1e-5)


def test_channels(tree, fold):
    b_separate = build.node(tree, "ShaderNodeSeparateColor", Color=(0.2, 0.5, 0.8))
    assert fold(b_separate, "Blue", into="value") == pytest.approx(0.8)
    b_combine = build.node(tree, "ShaderNodeCombineColor", Red=0.1, Green=0.2, Blue=0.3)
    assert fold(b_combine) == pytest.approx((0.1, 0.2, 0.3))
    b_xyz = build.node(tree, "ShaderNodeCombineXYZ", X=0.3, Y=0.6, Z=0.9)
    assert fold(b_xyz, into="value") == pytest.approx(0.6), "a vector counts by its mean"
    b_gray = build.node(tree, "ShaderNodeRGBToBW", Color=(0.0, 1.0, 0.0))
    assert fold(b_gray, into="value") == pytest.approx(0.7152)


def test_range_nodes(tree, fold):
    b_clamp = build.node(tree, "ShaderNodeClamp", Value=2.0, Min=0.1, Max=0.6)
    assert fold(b_clamp, into="value") == pytest.approx(0.6)
    b_map = tree.nodes.new("ShaderNodeMapRange")
    for identifier, value in (
        ("Value", 3.0),
        ("From Min", 2.0),
        ("From Max", 4.0),
        ("To Min", 0.2),
        ("To Max", 0.6),
    ):
        build.socket(b_map.inputs, identifier).default_value = value
    assert fold(b_map, "Result", into="value") == pytest.approx(0.4)


def test_a_range_of_nothing_gives_nothing(tree, fold):
    b_map = tree.nodes.new("ShaderNodeMapRange")
    for identifier, value in (("From Min", 2.0), ("From Max", 2.0), ("To Min", 0.2), ("To Max", 0.6)):
        build.socket(b_map.inputs, identifier).default_value = value
    b_map.clamp = False
    assert fold(b_map, "Result", into="value") == 0.0
    b_map.clamp = True
    assert fold(b_map, "Result", into="value") == pytest.approx(0.2)


def test_what_has_no_result_is_nothing(tree, fold):
    b_huge = build.node(tree, "ShaderNodeMath")
    b_huge.operation = "MULTIPLY"
    b_huge.inputs[0].default_value = b_huge.inputs[1].default_value = 1e38
    b_beyond = b_huge
    for _ in range(9):  # past what a double holds
        b_square = build.node(tree, "ShaderNodeMath")
        b_square.operation = "MULTIPLY"
        tree.links.new(b_beyond.outputs[0], b_square.inputs[0])
        tree.links.new(b_beyond.outputs[0], b_square.inputs[1])
        b_beyond = b_square
    b_floor = build.node(tree, "ShaderNodeMath")
    b_floor.operation = "FLOOR"
    tree.links.new(b_beyond.outputs[0], b_floor.inputs[0])
    assert fold(b_floor, into="value") == 0.0
    b_gamma = build.node(tree, "ShaderNodeGamma", Gamma=1000.0)
    tree.links.new(b_huge.outputs[0], b_gamma.inputs["Color"])
    assert fold(b_gamma) == (0.0, 0.0, 0.0)


def test_color_ramp_and_curves_are_blenders_own(tree, fold):
    b_ramp = tree.nodes.new("ShaderNodeValToRGB")
    b_ramp.inputs[0].default_value = 0.3
    b_ramp.color_ramp.elements[1].color = (1.0, 0.5, 0.0, 1.0)
    assert fold(b_ramp) == pytest.approx(tuple(b_ramp.color_ramp.evaluate(0.3))[:3])
    b_curves = build.node(tree, "ShaderNodeRGBCurve", Color=(0.2, 0.5, 0.8))
    b_curves.mapping.curves[0].points.new(0.5, 0.9)
    b_curves.mapping.update()
    red, green, blue = fold(b_curves)
    assert red > 0.3
    assert (green, blue) == pytest.approx((0.5, 0.8), abs=1e-3)


def test_color_into_value_is_luminance(tree, fold):
    b_rgb = tree.nodes.new("ShaderNodeRGB")
    b_rgb.outputs[0].default_value = (1.0, 0.0, 0.0, 1.0)
    assert fold(b_rgb, into="value") == pytest.approx(0.2126)


@pytest.mark.skipif("temperature" not in bpy.types.Light.bl_rna.properties, reason="Blender 4.5 and later")
@pytest.mark.parametrize("kelvin", [900.0, 1500.0, 2500.0, 3200.0, 5000.0, 6500.0, 11000.0])
def test_blackbody_is_blenders(tree, fold, kelvin):
    b_light = bpy.data.lights.new("Lamp", "POINT")
    b_light.use_temperature, b_light.temperature = True, kelvin
    expected = tuple(b_light.temperature_color)
    found = fold(build.node(tree, "ShaderNodeBlackbody", Temperature=kelvin))
    assert found == pytest.approx(expected, rel=2e-3, abs=1e-3)
