"""Node inputs folded to constants: plain value and color nodes are computed, textures are replaced by their average.

What cannot be computed is reported once per material and node, with the value that is used instead.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from ..report import ProblemLog
from . import arithmetic
from .arithmetic import Color, clamp
from .blackbody import blackbody
from .named_values import view_layer_value
from .nodes import Input, Output, origin
from .texture import texture_average

Value = float | Color


class Varying(NamedTuple):
    """What differs from point to point."""

    register: int
    """The result of the material's program that computes it."""
    typical: Value
    """A value that stands for it where one is asked for."""

    @property
    def number(self) -> float:
        """The typical value of a number."""
        return self.typical if isinstance(self.typical, float) else self.typical[0]


class UnfoldableError(Exception):
    """A node whose result no constant can stand for."""


TOO_DEEP = (RecursionError, MemoryError)
"""What nodes in a circle, or in too long a chain, end with; Blender's answer to too deep a recursion is the second."""

_MOST_SHADERS = 1000
"""Shader nodes met on all ways through a tree, past which they are too many."""


class Folder:
    """Folds the inputs of one material's, lamp's or world's nodes."""

    def __init__(self, subject: str, log: ProblemLog | None = None, b_depsgraph: Any = None) -> None:
        """Without `log` nothing is reported; without `b_depsgraph` nothing is known of the view layer."""
        self.b_depsgraph = b_depsgraph
        self._subject = subject
        self._log = ProblemLog() if log is None else log
        self._folded: dict[tuple[Any, ...], Value | None] = {}
        """Results of nodes; None where no constant can stand for one."""
        self._shaders_met = 0

    def constant_color(self, entry: Input) -> Color:
        """Constant an input stands for, as a color or vector."""
        return as_color(self.fold(entry))

    def constant_value(self, entry: Input) -> float:
        """Constant an input stands for, as a number."""
        return as_number(self.fold(entry), entry.b_socket.type)

    def color(self, entry: Input) -> Color | Varying:
        """The color of an input, for those that can use what varies; here it is a constant."""
        return self.constant_color(entry)

    def value(self, entry: Input) -> float | Varying:
        """As `color`, for a number."""
        return self.constant_value(entry)

    def product(self, a: Value | Varying, b: Value | Varying) -> Value | Varying:
        """Channel by channel."""
        if isinstance(a, Varying) or isinstance(b, Varying):
            raise TypeError("only a compiler multiplies what varies")
        return arithmetic.product(a, b)

    def complement(self, a: float | Varying) -> float | Varying:
        """1 - a."""
        return 1.0 - _constant(a)

    def unit(self, a: float | Varying) -> float | Varying:
        """Clamped to 0 and 1."""
        return clamp(_constant(a))

    def note_normals(self, closure: int, source: Output) -> None:
        """Remembers the normals a closure's shader asks for: only compilers have use for them."""

    def note_tangent(self, closure: int, source: Output) -> None:
        """As `note_normals`, for the tangent of a closure that is anisotropic."""

    def meet_shader(self) -> None:
        """Counts a shader node: a few that branch and meet again can be met more often than there is time for. Raises
        RecursionError."""
        self._shaders_met += 1
        if self._shaders_met > _MOST_SHADERS:
            raise RecursionError("too many shader nodes")

    def folds(self, source: Output) -> bool:
        """Whether a constant can stand for a node's output."""
        try:
            self._node(source)
        except UnfoldableError:
            return False
        return True

    def typical(self, source: Output) -> Value:
        """A value that stands for a node's output."""
        try:
            return self._node(source)
        except UnfoldableError:
            return _default(source.b_socket)

    def report(self, message: str) -> None:
        """Adds a problem of the material, lamp or world."""
        self._log.add(self._subject, message)

    def report_node(self, b_node: Any, message: str) -> None:
        """Adds a problem that names the node."""
        self.report(f'node "{title(b_node)}": {message}')

    def fold(self, entry: Input) -> Value:
        """Constant an input stands for; its own default where the node before it cannot be computed."""
        source = origin(entry)
        if isinstance(source, Input):
            return converted(_default(source.b_socket), source.b_socket.type, entry.b_socket.type)
        try:
            return converted(self._node(source), source.b_socket.type, entry.b_socket.type)
        except UnfoldableError:
            default = _default(entry.b_socket)
            used = f"{_text(default)} is used for {entry.b_socket.name} instead"
            self.report_node(source.b_node, f"not supported yet; {used}")
            return default

    def _node(self, output: Output) -> Value:
        key = output.key
        if key not in self._folded:
            try:
                self._folded[key] = self._computed(output)
            except UnfoldableError:
                self._folded[key] = None
        found = self._folded[key]
        if found is None:
            raise UnfoldableError
        return found

    def _computed(self, output: Output) -> Value:
        b_node = output.b_node
        if b_node.mute:
            return _default(output.b_socket)
        compute = _NODES.get(b_node.type)
        if compute is not None:
            try:
                return compute(self, output)
            except (ValueError, OverflowError):
                # Beyond all numbers, where the operation has no result.
                return converted(0.0, "VALUE", output.b_socket.type)
        average = texture_average(b_node, output.b_socket, lambda name: self.fold(output.input(name)))
        if average is None:
            raise UnfoldableError
        value, why = average
        self.report_node(b_node, f"{why}; {_text(value)} is used instead")
        return value


def _constant(a: float | Varying) -> float:
    if isinstance(a, Varying):
        raise TypeError("only a compiler computes with what varies")
    return a


def as_color(value: Value) -> Color:
    """A number is gray."""
    return (value, value, value) if isinstance(value, float) else value


def as_number(value: Value, socket_type: str) -> float:
    """A color counts by its luminance, a vector by its mean, as in Blender."""
    if isinstance(value, float):
        return value
    return sum(value) / 3.0 if socket_type == "VECTOR" else arithmetic.luminance(value)


def converted(value: Value, from_type: str, to_type: str) -> Value:
    """As Blender converts between sockets of different types."""
    return as_color(value) if to_type in ("RGBA", "VECTOR") else as_number(value, from_type)


def _default(b_socket: Any) -> Value:
    """An unlinked socket's own value."""
    value = getattr(b_socket, "default_value", 0.0)
    if isinstance(value, bool | int | float):
        return float(value)
    if isinstance(value, str):
        return 0.0
    return (float(value[0]), float(value[1]), float(value[2]))


def title(b_node: Any) -> str:
    """The node's label, else its name, which is its kind unless the user renamed it."""
    return str(b_node.label or b_node.name)


def _text(value: Value) -> str:
    if isinstance(value, float):
        return f"{value:.3g}"
    return "(" + ", ".join(f"{channel:.3g}" for channel in value) + ")"


def _rgb(_folder: Folder, output: Output) -> Value:
    return _default(output.b_node.outputs[0])


def _math(folder: Folder, output: Output) -> Value:
    a, b, c = (_number(folder, output, name) for name in ("Value", "Value_001", "Value_002"))
    operation = arithmetic.MATH.get(output.b_node.operation)
    if operation is None:
        raise UnfoldableError
    result = float(operation(a, b, c))
    return clamp(result) if output.b_node.use_clamp else result


def _mix(folder: Folder, output: Output) -> Value:
    b_node = output.b_node
    kind = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color"}.get(b_node.data_type)
    if kind is None or (kind == "Vector" and b_node.factor_mode == "NON_UNIFORM"):
        raise UnfoldableError
    factor = _number(folder, output, "Factor_Float")
    factor = clamp(factor) if b_node.clamp_factor else factor
    a, b = folder.fold(output.input(f"A_{kind}")), folder.fold(output.input(f"B_{kind}"))
    blend_type = b_node.blend_type if kind == "Color" else "MIX"
    return _blended(blend_type, a, b, factor, is_clamped=kind == "Color" and b_node.clamp_result)


def _mix_rgb(folder: Folder, output: Output) -> Value:
    b_node = output.b_node
    factor = clamp(_number(folder, output, "Fac"))
    a, b = folder.fold(output.input("Color1")), folder.fold(output.input("Color2"))
    return _blended(b_node.blend_type, a, b, factor, is_clamped=b_node.use_clamp)


def _blended(kind: str, a: Value, b: Value, factor: float, *, is_clamped: bool = False) -> Value:
    mixed = arithmetic.blend(kind, as_color(a), as_color(b), factor)
    if mixed is None:
        raise UnfoldableError
    if is_clamped:
        mixed = (clamp(mixed[0]), clamp(mixed[1]), clamp(mixed[2]))
    return mixed[0] if isinstance(a, float) else mixed


def _number(folder: Folder, output: Output, name: str) -> float:
    return folder.constant_value(output.input(name))


def _triple(folder: Folder, output: Output, name: str) -> Color:
    return folder.constant_color(output.input(name))


def _invert(folder: Folder, output: Output) -> Value:
    color = _triple(folder, output, "Color")
    inverted = (1.0 - color[0], 1.0 - color[1], 1.0 - color[2])
    return _blended("MIX", color, inverted, _number(folder, output, "Fac"))


def _gamma(folder: Folder, output: Output) -> Value:
    gamma = _number(folder, output, "Gamma")
    red, green, blue = (c**gamma if c > 0.0 else c for c in _triple(folder, output, "Color"))
    return red, green, blue


def _hue_saturation(folder: Folder, output: Output) -> Value:
    color = _triple(folder, output, "Color")
    changes = [_number(folder, output, name) for name in ("Hue", "Saturation", "Value")]
    changed = arithmetic.hue_saturation(color, *changes)
    return _blended("MIX", color, changed, _number(folder, output, "Fac"))


def _bright_contrast(folder: Folder, output: Output) -> Value:
    bright, contrast = (_number(folder, output, name) for name in ("Bright", "Contrast"))
    return arithmetic.bright_contrast(_triple(folder, output, "Color"), bright, contrast)


def _clamp(folder: Folder, output: Output) -> Value:
    value, low, high = (_number(folder, output, name) for name in ("Value", "Min", "Max"))
    if output.b_node.clamp_type == "RANGE" and low > high:
        low, high = high, low
    return clamp(value, low, high)


def _map_range(folder: Folder, output: Output) -> Value:
    b_node = output.b_node
    if b_node.data_type != "FLOAT" or b_node.interpolation_type != "LINEAR":
        raise UnfoldableError
    names = ("Value", "From Min", "From Max", "To Min", "To Max")
    value, from_min, from_max, to_min, to_max = (_number(folder, output, name) for name in names)
    span = from_max - from_min
    mapped = arithmetic.lerp(to_min, to_max, (value - from_min) / span) if span else 0.0
    return clamp(mapped, min(to_min, to_max), max(to_min, to_max)) if b_node.clamp else mapped


def _attribute(folder: Folder, output: Output) -> Value:
    """Of a view layer; others differ from object to object."""
    b_node = output.b_node
    if b_node.attribute_type != "VIEW_LAYER" or not b_node.attribute_name or folder.b_depsgraph is None:
        raise UnfoldableError
    red, green, blue, alpha = view_layer_value(folder.b_depsgraph, b_node.attribute_name)
    mean = (red + green + blue) / 3.0
    return {"Fac": mean, "Alpha": alpha}.get(output.b_socket.identifier, (red, green, blue))


def _light_falloff(folder: Folder, output: Output) -> Value:
    if output.b_socket.identifier != "Quadratic":
        raise UnfoldableError
    return _number(folder, output, "Strength")


def _combine(names: tuple[str, str, str]) -> Callable[[Folder, Output], Value]:
    def compute(folder: Folder, output: Output) -> Value:
        if getattr(output.b_node, "mode", "RGB") != "RGB":
            raise UnfoldableError
        x, y, z = (_number(folder, output, name) for name in names)
        return x, y, z

    return compute


def _separate(source: str, names: tuple[str, str, str]) -> Callable[[Folder, Output], Value]:
    def compute(folder: Folder, output: Output) -> Value:
        if getattr(output.b_node, "mode", "RGB") != "RGB":
            raise UnfoldableError
        return _triple(folder, output, source)[names.index(output.b_socket.identifier)]

    return compute


def _color_ramp(folder: Folder, output: Output) -> Value:
    color = output.b_node.color_ramp.evaluate(_number(folder, output, "Fac"))
    return color[3] if output.b_socket.identifier == "Alpha" else (color[0], color[1], color[2])


def _rgb_curves(folder: Folder, output: Output) -> Value:
    color = _triple(folder, output, "Color")
    b_mapping = output.b_node.mapping
    b_mapping.initialize()
    combined = [b_mapping.evaluate(b_mapping.curves[3], channel) for channel in color]
    red, green, blue = (b_mapping.evaluate(b_mapping.curves[i], combined[i]) for i in range(3))
    return _blended("MIX", color, (red, green, blue), _number(folder, output, "Fac"))


_NODES: dict[str, Callable[[Folder, Output], Value]] = {
    "RGB": _rgb,
    "VALUE": _rgb,
    "MATH": _math,
    "MIX": _mix,
    "MIX_RGB": _mix_rgb,
    "INVERT": _invert,
    "GAMMA": _gamma,
    "HUE_SAT": _hue_saturation,
    "BRIGHTCONTRAST": _bright_contrast,
    "CLAMP": _clamp,
    "MAP_RANGE": _map_range,
    "COMBINE_COLOR": _combine(("Red", "Green", "Blue")),
    "COMBXYZ": _combine(("X", "Y", "Z")),
    "SEPARATE_COLOR": _separate("Color", ("Red", "Green", "Blue")),
    "SEPXYZ": _separate("Vector", ("X", "Y", "Z")),
    "RGBTOBW": lambda folder, output: arithmetic.luminance(_triple(folder, output, "Color")),
    "VALTORGB": _color_ramp,
    "CURVE_RGB": _rgb_curves,
    "ATTRIBUTE": _attribute,
    "LIGHT_FALLOFF": _light_falloff,
    "BLACKBODY": lambda folder, output: blackbody(_number(folder, output, "Temperature")),
}
"""What each kind of node computes, by Blender's `node.type`."""
