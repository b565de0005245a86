"""Blender's lights as the core's LampRecord."""

from typing import Any

from .arithmetic import WHITE, Color, multiply, scale
from .closures import emissions
from .compiler import Compiler, Register, summed
from .context import ExportContext
from .coordinates import matrix_array
from .fold import TOO_DEEP
from .nodes import Input, node_tree, output_node
from .object_info import object_info
from .visibility import instance_bits, owner


class LampCompiler(Compiler):
    """Compiles a lamp: what is asked of the surface is asked of the point of the lamp that is seen."""

    of_lamp = True

    def __init__(self, context: ExportContext, b_light: Any) -> None:
        super().__init__(context, b_light.name)
        self.is_sun = b_light.type == "SUN"

    def attribute(self, name: str) -> Register:
        """Texture coordinates; lamps have no other layers."""
        if name == "uv":
            return self.quantity("parametric")
        self.report(f"lamps have no {name.replace(':', ' ')}; 0 is used")
        return self.register(0.0)

    def generated(self) -> Register:
        """Where textures are looked up if nothing else is said."""
        return self.quantity("object_position")


def export_light(context: ExportContext, b_instance: Any) -> None:
    """One lamp, unless it gives no light."""
    b_object = b_instance.object
    b_light = b_object.data
    if getattr(getattr(b_light, "cycles", None), "is_portal", False):
        context.log.add(b_object.name, "light portals are not needed; left out")
        return
    compiler = LampCompiler(context, b_light)
    factor, program = node_factor(compiler, b_light)
    power = scale(multiply(lamp_color(b_light), factor), lamp_power(b_light, b_instance.matrix_world))
    if not any(power):
        return
    context.emits = True
    record = {
        "name": b_object.name,
        "shape": lamp_shape(b_light),
        "power": list(power),
        "program": program,
        "world_from_lamp": matrix_array(b_instance.matrix_world).tolist(),
        "visibility": instance_bits(context, b_instance),
        "casts_shadow": b_light.use_shadow,
    }
    if compiler.asks_object:
        record["info"] = object_info(context, b_instance, compiler.object_values)
    if context.linking.is_used:
        record["links"] = context.linking.of_emitter(owner(b_instance))
    context.builder.add_lamp(record)


def lamp_color(b_light: Any) -> Color:
    """Color, with what newer versions of Blender add."""
    color: Color = tuple(b_light.color)
    # Temperature came with Blender 4.5.
    if getattr(b_light, "use_temperature", False):
        color = multiply(color, tuple(b_light.temperature_color))
    return color


def lamp_power(b_light: Any, b_matrix: Any) -> float:
    """Power (W), for a sun irradiance (W/m²), with what newer versions of Blender add."""
    power: float = b_light.energy
    # Exposure and normalization came with Blender 4.5.
    if hasattr(b_light, "exposure"):
        power *= 2.0**b_light.exposure
        if not b_light.normalize:
            power *= b_light.area(matrix_world=b_matrix)
    return power


def lamp_shape(b_light: Any) -> dict[str, Any]:
    """The core's LampShape; lengths in metres before the object's scale."""
    if b_light.type == "SUN":
        return {"kind": "sun", "angle": b_light.angle}
    if b_light.type == "AREA":
        is_round = b_light.shape in ("DISK", "ELLIPSE")
        is_even = b_light.shape in ("SQUARE", "DISK")
        return {
            "kind": "ellipse" if is_round else "rectangle",
            "size": [b_light.size, b_light.size if is_even else b_light.size_y],
            "spread": b_light.spread,
        }
    ball = {"radius": b_light.shadow_soft_size, "soft_falloff": b_light.use_soft_falloff}
    if b_light.type == "POINT":
        return {"kind": "point", **ball}
    cone = {"cone_angle": b_light.spot_size, "blend": b_light.spot_blend}
    return {"kind": "spot", **ball, **cone}


def node_factor(compiler: LampCompiler, b_light: Any) -> tuple[Color, dict[str, Any] | None]:
    """What the light's nodes multiply its power with; where that varies, 1 and the core's LampProgramRecord."""
    b_tree = node_tree(b_light)
    b_output = None if b_tree is None else output_node(b_tree, "OUTPUT_LIGHT")
    if b_output is None:
        return WHITE, None
    try:
        parts = emissions(compiler, Input(b_output.inputs["Surface"], ()))
    except TOO_DEEP:
        compiler.report(
            "its nodes form a circle, or too long a chain; the light's own power and color are used"
        )
        return WHITE, None
    if not parts:
        compiler.report("its nodes emit nothing; it is left out")
    factor, register = summed(compiler, parts)
    if register is None:
        return factor, None
    return WHITE, {"instructions": compiler.instructions, "factor": register.index}
