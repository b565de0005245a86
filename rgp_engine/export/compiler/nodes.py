"""Nodes that compute with numbers, vectors and colors."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..blackbody import COOLEST, HOTTEST, blackbody
from ..nodes import Output
from .mapping import mapping

if TYPE_CHECKING:
    from .compiler import Compiler, Operand, Register

# Samples of curves and color ramps.
_TABLE = 257
# Samples of the color of a black body.
_TEMPERATURES = 561
_KINDS = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color"}


def _math(c: "Compiler", source: Output) -> "Operand | None":
    a, b, d = (c.input(source, name) for name in ("Value", "Value_001", "Value_002"))
    result = c.math(source.b_node.operation, a, b, d)
    return c.clamped(result) if source.b_node.use_clamp else result


def _vector_math(c: "Compiler", source: Output) -> "Operand | None":
    function = source.b_node.operation
    third = "Scale" if function in ("SCALE", "REFRACT") else "Vector_002"
    a, b, d = (c.input(source, name) for name in ("Vector", "Vector_001", third))
    return c.vector_math(function, a, b, d)


def _mix(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    kind = _KINDS.get(b_node.data_type)
    if kind is None:
        return None
    is_uneven = kind == "Vector" and b_node.factor_mode == "NON_UNIFORM"
    factor = c.input(source, "Factor_Vector" if is_uneven else "Factor_Float")
    if b_node.clamp_factor:
        factor = c.clamped(factor)
    a, b = c.input(source, f"A_{kind}"), c.input(source, f"B_{kind}")
    if kind != "Color":
        return c.mixed(factor, a, b)
    return _blended(c, b_node.blend_type, (factor, a, b), is_clamped=b_node.clamp_result)


def _mix_rgb(c: "Compiler", source: Output) -> "Operand | None":
    factor = c.clamped(c.input(source, "Fac"))
    a, b = c.input(source, "Color1"), c.input(source, "Color2")
    return _blended(c, source.b_node.blend_type, (factor, a, b), is_clamped=source.b_node.use_clamp)


def _blended(
    c: "Compiler", mode: str, operands: "tuple[Register, Register, Register]", is_clamped: bool
) -> "Register":
    factor, a, b = operands
    result = c.emit("blend", mode=mode, factor=factor, a=a, b=b)
    return c.clamped(result) if is_clamped else result


def _clamp(c: "Compiler", source: Output) -> "Operand | None":
    value, low, high = (c.input(source, name) for name in ("Value", "Min", "Max"))
    if source.b_node.clamp_type == "RANGE":
        low, high = c.math("MINIMUM", low, high), c.math("MAXIMUM", low, high)
    return c.clamped(value, low, high)


def _map_range(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    is_vector = b_node.data_type == "FLOAT_VECTOR"
    names = ("From Min", "From Max", "To Min", "To Max", "Steps")
    if is_vector:
        operands = [c.input(source, name) for name in ("Vector", *(_vector_name(name) for name in names))]
    else:
        operands = [c.input(source, name) for name in ("Value", *names)]
    value, from_min, from_max, to_min, to_max, steps = operands
    v = c.vector_math
    span = v("SUBTRACT", from_max, from_min)
    t = v("DIVIDE", v("SUBTRACT", value, from_min), span)
    if b_node.interpolation_type == "STEPPED":
        t = v("DIVIDE", v("FLOOR", v("MULTIPLY", t, v("ADD", steps, 1.0))), steps)
    elif b_node.interpolation_type != "LINEAR":
        t = _smooth(c, c.clamped(t), is_smoother=b_node.interpolation_type == "SMOOTHERSTEP")
    result = c.mixed(t, to_min, to_max)
    if not is_vector:
        # A range of nothing gives 0, not its end as for vectors.
        result = c.math("MULTIPLY", result, c.math("SIGN", c.math("ABSOLUTE", span)))
    if b_node.clamp and b_node.interpolation_type in ("LINEAR", "STEPPED"):
        return c.clamped(result, v("MINIMUM", to_min, to_max), v("MAXIMUM", to_min, to_max))
    return result


def _vector_name(name: str) -> str:
    return {
        "From Min": "From_Min_FLOAT3",
        "From Max": "From_Max_FLOAT3",
        "To Min": "To_Min_FLOAT3",
        "To Max": "To_Max_FLOAT3",
        "Steps": "Steps_FLOAT3",
    }[name]


def _smooth(c: "Compiler", t: "Register", is_smoother: bool) -> "Register":
    """t² (3 - 2 t), or t³ (t (6 t - 15) + 10)."""
    v = c.vector_math
    if not is_smoother:
        return v("MULTIPLY", v("MULTIPLY", t, t), v("MULTIPLY_ADD", t, -2.0, 3.0))
    inner = v("MULTIPLY_ADD", t, v("MULTIPLY_ADD", t, 6.0, -15.0), 10.0)
    return v("MULTIPLY", v("MULTIPLY", v("MULTIPLY", t, t), t), inner)


def _invert(c: "Compiler", source: Output) -> "Operand | None":
    color = c.input(source, "Color")
    return c.mixed(c.input(source, "Fac"), color, c.vector_math("SUBTRACT", 1.0, color))


def _gamma(c: "Compiler", source: Output) -> "Operand | None":
    return c.emit("gamma", color=c.input(source, "Color"), gamma=c.input(source, "Gamma"))


def _bright_contrast(c: "Compiler", source: Output) -> "Operand | None":
    inputs = {name: c.input(source, name.capitalize()) for name in ("color", "bright", "contrast")}
    return c.emit("bright_contrast", **inputs)


def _hue_saturation(c: "Compiler", source: Output) -> "Operand | None":
    inputs = {name: c.input(source, name.capitalize()) for name in ("color", "hue", "saturation", "value")}
    return c.mixed(c.input(source, "Fac"), inputs["color"], c.emit("hue_saturation", **inputs))


def _separate(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    names = ("X", "Y", "Z") if b_node.type == "SEPXYZ" else ("Red", "Green", "Blue")
    entry = "Vector" if b_node.type == "SEPXYZ" else "Color"
    value = c.input(source, entry)
    mode = getattr(b_node, "mode", "RGB")
    if mode != "RGB":
        value = c.emit(f"{mode.lower()}_from_rgb", color=value)
    return c.emit("channel", of=value, channel=names.index(source.b_socket.identifier))


def _combine(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    names = ("X", "Y", "Z") if b_node.type == "COMBXYZ" else ("Red", "Green", "Blue")
    x, y, z = (c.input(source, name) for name in names)
    value = c.emit("combine", x=x, y=y, z=z)
    mode = getattr(b_node, "mode", "RGB")
    return value if mode == "RGB" else c.emit(f"rgb_from_{mode.lower()}", color=value)


def _rgb_to_bw(c: "Compiler", source: Output) -> "Operand | None":
    return c.emit("luminance", of=c.input(source, "Color"))


def _color_ramp(c: "Compiler", source: Output) -> "Operand | None":
    b_ramp = source.b_node.color_ramp
    steps = [b_ramp.evaluate(i / (_TABLE - 1)) for i in range(_TABLE)]
    table = [[float(channel) for channel in color] for color in steps]
    stepped = b_ramp.interpolation == "CONSTANT"
    color = c.emit("ramp", factor=c.input(source, "Fac"), table=table, stepped=stepped)
    return c.emit("alpha", of=color) if source.b_socket.identifier == "Alpha" else color


def _blackbody(c: "Compiler", source: Output) -> "Operand | None":
    span = HOTTEST - COOLEST
    table = [[*blackbody(COOLEST + span * i / (_TEMPERATURES - 1)), 1.0] for i in range(_TEMPERATURES)]
    factor = c.math("MULTIPLY_ADD", c.input(source, "Temperature"), 1.0 / span, -COOLEST / span)
    return c.emit("ramp", factor=factor, table=table, stepped=False)


def _curves(count: int) -> "Callable[[Compiler, Output], Operand | None]":
    """Curves on `count` channels, and for colors one more before each of them."""

    def emit(c: "Compiler", source: Output) -> "Operand | None":
        b_mapping = source.b_node.mapping
        b_mapping.initialize()
        name = {"CURVE_RGB": "Color", "CURVE_VEC": "Vector", "CURVE_FLOAT": "Value"}[source.b_node.type]
        low, high = _domain(b_mapping)
        value = c.input(source, name)
        inside = c.clamped(value, low, high) if b_mapping.extend == "HORIZONTAL" else value
        factor = "Factor" if source.b_node.type == "CURVE_FLOAT" else "Fac"
        bent = c.emit(
            "curves", color=inside, table=_curve_table(b_mapping, count, low, high), low=low, high=high
        )
        return c.mixed(c.input(source, factor), value, bent)

    return emit


def _domain(b_mapping: Any) -> tuple[float, float]:
    """From the first to the last point of any curve."""
    places = [b_point.location[0] for b_curve in b_mapping.curves for b_point in b_curve.points]
    return float(min(places)), float(max(places))


def _curve_table(b_mapping: Any, count: int, low: float, high: float) -> list[list[float]]:
    curves = b_mapping.curves
    table = []
    for i in range(_TABLE):
        x = low + (high - low) * i / (_TABLE - 1)
        if count == 3 and len(curves) > 3:
            x = b_mapping.evaluate(curves[3], x)
        row = [float(b_mapping.evaluate(curves[k % count], x)) for k in range(3)]
        table.append([*row, 1.0])
    return table


NODES: "dict[str, Callable[[Compiler, Output], Operand | None]]" = {
    "MATH": _math,
    "VECT_MATH": _vector_math,
    "MIX": _mix,
    "MIX_RGB": _mix_rgb,
    "MAPPING": mapping,
    "CLAMP": _clamp,
    "MAP_RANGE": _map_range,
    "INVERT": _invert,
    "GAMMA": _gamma,
    "BRIGHTCONTRAST": _bright_contrast,
    "HUE_SAT": _hue_saturation,
    "SEPARATE_COLOR": _separate,
    "SEPXYZ": _separate,
    "COMBINE_COLOR": _combine,
    "COMBXYZ": _combine,
    "RGBTOBW": _rgb_to_bw,
    "VALTORGB": _color_ramp,
    "BLACKBODY": _blackbody,
    "CURVE_RGB": _curves(3),
    "CURVE_VEC": _curves(3),
    "CURVE_FLOAT": _curves(1),
}
"""Instructions of the nodes that compute."""
