"""Blender's lights as the core's LampRecord."""

from typing import Any

from .arithmetic import WHITE, Color, multiply, scale
from .context import ExportContext
from .coordinates import matrix_array
from .fold import TOO_DEEP, Folder
from .nodes import Input, Output, node_tree, origin, output_node
from .visibility import instance_bits, owner


def export_light(context: ExportContext, b_instance: Any) -> None:
    """One lamp, unless it gives no light."""
    b_object = b_instance.object
    b_light = b_object.data
    if getattr(getattr(b_light, "cycles", None), "is_portal", False):
        context.log.add(b_object.name, "light portals are not needed; left out")
        return
    power = lamp_power(context, b_light, b_instance.matrix_world)
    if not any(power):
        return
    context.emits = True
    record = {
        "name": b_object.name,
        "shape": lamp_shape(b_light),
        "power": list(power),
        "world_from_lamp": matrix_array(b_instance.matrix_world).tolist(),
        "visibility": instance_bits(context, b_instance),
        "casts_shadow": b_light.use_shadow,
    }
    if context.linking.is_used:
        record["links"] = context.linking.of_emitter(owner(b_instance))
    context.builder.add_lamp(record)


def lamp_power(context: ExportContext, b_light: Any, b_matrix: Any) -> Color:
    """Power per channel (W), for a sun irradiance (W/m²): color, power, and what newer versions of Blender add."""
    color: Color = tuple(b_light.color)
    power = b_light.energy
    # Exposure, temperature and normalization came with Blender 4.5.
    if hasattr(b_light, "exposure"):
        power *= 2.0**b_light.exposure
        if b_light.use_temperature:
            color = multiply(color, tuple(b_light.temperature_color))
        if not b_light.normalize:
            power *= b_light.area(matrix_world=b_matrix)
    return scale(multiply(color, _node_factor(context, b_light)), power)


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


def _node_factor(context: ExportContext, b_light: Any) -> Color:
    """What the light's nodes multiply its power with: color times strength of its Emission node."""
    b_tree = node_tree(b_light)
    b_output = None if b_tree is None else output_node(b_tree)
    if b_output is None:
        return WHITE
    folder = Folder(b_light.name, context.log)
    try:
        source = origin(Input(b_output.inputs["Surface"], ()))
        if isinstance(source, Output) and source.b_node.type == "EMISSION":
            strength = folder.constant_value(source.input("Strength"))
            return scale(folder.constant_color(source.input("Color")), strength)
    except TOO_DEEP:
        folder.report(
            "its nodes form a circle, or too long a chain; the light's own power and color are used"
        )
        return WHITE
    folder.report("its nodes are not a single Emission; the light's own power and color are used")
    return WHITE
