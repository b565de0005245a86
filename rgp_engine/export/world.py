"""Blender's world as the core's WorldRecord."""

from typing import Any

from .arithmetic import BLACK, Color
from .closures import closures
from .context import ExportContext
from .fold import Folder
from .nodes import Input, Output, node_tree, origin, output_node
from .visibility import world_bits


def world_record(context: ExportContext) -> dict[str, Any]:
    """Constant light from outside."""
    b_scene = context.b_depsgraph.scene_eval
    b_world = b_scene.world
    radiance = BLACK if b_world is None else world_radiance(context, b_world)
    context.emits |= any(radiance)
    return {
        "radiance": list(radiance),
        "visibility": world_bits(b_world),
        "film_transparent": b_scene.render.film_transparent,
    }


def world_radiance(context: ExportContext, b_world: Any) -> Color:
    """Radiance of the background (W/(m² sr)): color times strength, mixes included."""
    b_tree = node_tree(b_world)
    if b_tree is None:
        return tuple(b_world.color)
    b_output = output_node(b_tree)
    if b_output is None:
        return BLACK
    folder = Folder(b_world.name, context.log)
    if isinstance(origin(Input(b_output.inputs["Volume"], ())), Output):
        folder.report("volumes are not supported yet; left out")
    red = green = blue = 0.0
    for part in closures(folder, Input(b_output.inputs["Surface"], ()))[0]:
        if part["closure"]["kind"] == "emission":
            weight, radiance = part["weight"], part["closure"]["radiance"]
            red += weight[0] * radiance[0]
            green += weight[1] * radiance[1]
            blue += weight[2] * radiance[2]
    return red, green, blue
