"""Blender's world as the core's WorldRecord."""

from typing import Any

from .arithmetic import BLACK, Color
from .closures import emissions
from .compiler import Compiler, summed
from .context import ExportContext
from .fold import TOO_DEEP
from .nodes import Input, Output, node_tree, origin, output_node
from .visibility import world_bits


class WorldCompiler(Compiler):
    """Compiles a world: what is asked of the surface is asked of the direction."""

    of_world = True


def world_record(context: ExportContext) -> dict[str, Any]:
    """Light from outside."""
    b_scene = context.b_depsgraph.scene_eval
    b_world = _world(b_scene, context.b_depsgraph.view_layer_eval)
    radiance, program = (BLACK, None) if b_world is None else world_radiance(context, b_world)
    context.emits |= any(radiance) or program is not None
    return {
        "name": "World" if b_world is None else b_world.name,
        "radiance": list(radiance),
        "program": program,
        "visibility": world_bits(b_world),
        "film_transparent": b_scene.render.film_transparent,
    }


def _world(b_scene: Any, b_view_layer: Any) -> Any:
    """The world of a view layer, which may have another than the scene, or none."""
    if not b_view_layer.use_sky:
        return None
    # Blender 4.3 and later.
    return getattr(b_view_layer, "world_override", None) or b_scene.world


def world_radiance(context: ExportContext, b_world: Any) -> tuple[Color, dict[str, Any] | None]:
    """Radiance of the background (W/(m² sr)): color times strength, mixes included. Where it differs from direction to
    direction a typical value, and the core's WorldProgramRecord."""
    b_tree = node_tree(b_world)
    if b_tree is None:
        return tuple(b_world.color), None
    b_output = output_node(b_tree, "OUTPUT_WORLD")
    if b_output is None:
        return BLACK, None
    compiler = WorldCompiler(context, b_world.name)
    try:
        return _compiled(compiler, b_output)
    except TOO_DEEP:
        compiler.report("its nodes form a circle, or too long a chain; black is used")
        return BLACK, None


def _compiled(compiler: WorldCompiler, b_output: Any) -> tuple[Color, dict[str, Any] | None]:
    if isinstance(origin(Input(b_output.inputs["Volume"], ())), Output):
        compiler.report("volumes are not supported yet; left out")
    radiance, register = summed(compiler, emissions(compiler, Input(b_output.inputs["Surface"], ())))
    if register is None:
        return radiance, None
    return radiance, {"instructions": compiler.instructions, "radiance": register.index}
