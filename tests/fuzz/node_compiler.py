"""Nodes of any kind, any values in them, linked at random: the node compiler's records are those the core takes."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import atheris
import bpy
import rgp_core

with atheris.instrument_imports(include=["rgp_engine"]):
    import rgp_engine
    from rgp_engine.export.context import ExportContext
    from rgp_engine.export.light import LampCompiler, lamp_shape, node_factor
    from rgp_engine.export.material import material_index
    from rgp_engine.export.world import world_radiance
    from rgp_engine.report import ProblemLog

from tests.blender import build
from tests.fuzz.draw import Draw, fuzz

LEFT_OUT = ("ShaderNode", "ShaderNodeTree", "ShaderNodeCustomGroup", "ShaderNodeScript")
KINDS = [name for name in dir(bpy.types) if name.startswith("ShaderNode") and name not in LEFT_OUT]
OF_EVERY_NODE = {prop.identifier for prop in bpy.types.Node.bl_rna.properties} - {"mute"}
LUMINAIRES = [
    f"IES\nTILT=NONE\n1 1 1 2 2 {kind} 1 0 0 0 1 1 1 0 90 0 {end} 1 2 3 4"
    for kind in (1, 2, 3, 4)
    for end in (0, 180)
]
CAMERA = {
    "name": "Camera",
    "projection": {"kind": "perspective"},
    "world_from_camera": [[float(row == column) for column in range(4)] for row in range(4)],
    "window": [-1.0, 1.0, -1.0, 1.0],
    "resolution": [4, 4],
    "region": [0, 0, 4, 4],
    "clip": [0.1, 100.0],
}

LAMP = {
    "name": "Lamp",
    "world_from_lamp": CAMERA["world_from_camera"],
    "visibility": 31,
    "casts_shadow": True,
}


def set_properties(draw: Draw, b_node: Any) -> None:
    """The choices a node has besides its sockets."""
    for prop in b_node.bl_rna.properties:
        if prop.identifier in OF_EVERY_NODE or prop.is_readonly or getattr(prop, "is_array", False):
            continue
        choices = [item.identifier for item in prop.enum_items] if prop.type == "ENUM" else []
        values = {
            "ENUM": lambda choices=choices: draw.choice(choices),
            "BOOLEAN": draw.flag,
            "INT": draw.whole,
            "FLOAT": draw.number,
            "STRING": lambda: draw.choice(["", "UVMap", "position"]),
            "POINTER": lambda: draw.choice([None, *bpy.data.texts]),
        }
        if prop.type not in values or (prop.type == "ENUM" and not choices) or draw.flag():
            continue
        try:
            setattr(b_node, prop.identifier, values[prop.type]())
        except (TypeError, ValueError, OverflowError):
            continue  # Blender's own refusal


def set_inputs(draw: Draw, b_node: Any) -> None:
    for b_socket in b_node.inputs:
        value = getattr(b_socket, "default_value", None)
        if draw.flag():
            continue
        if isinstance(value, float):
            b_socket.default_value = draw.number()
        elif value is not None and hasattr(value, "__len__") and not isinstance(value, str):
            for i in range(len(value)):
                value[i] = draw.number()


def fill(draw: Draw, b_tree: Any, output: str) -> None:
    """Up to eight nodes and twelve links, circles included."""
    b_tree.nodes.clear()
    b_output = b_tree.nodes.new(output)
    b_nodes = [b_output]
    for _ in range(draw.below(8)):
        try:
            b_nodes.append(b_tree.nodes.new(draw.choice(KINDS)))
        except RuntimeError:
            continue  # kinds that this Blender only lists
        set_properties(draw, b_nodes[-1])
        set_inputs(draw, b_nodes[-1])
    b_from = [b_socket for b_node in b_nodes for b_socket in b_node.outputs]
    b_to = [b_socket for b_node in b_nodes for b_socket in b_node.inputs]
    if b_from:
        b_tree.links.new(draw.choice(b_from), b_output.inputs[0])
    for _ in range(draw.below(12) if b_from else 0):
        b_tree.links.new(draw.choice(b_from), draw.choice(b_to))


def try_nodes(draw: Draw, b_depsgraph: Any) -> None:
    b_scene, b_material = bpy.context.scene, bpy.data.materials["Material"]
    b_light = bpy.data.lights["Lamp"]
    fill(draw, b_material.node_tree, "ShaderNodeOutputMaterial")
    fill(draw, b_scene.world.node_tree, "ShaderNodeOutputWorld")
    fill(draw, b_light.node_tree, "ShaderNodeOutputLight")
    builder, log = rgp_core.SceneBuilder(), ProblemLog()
    engine = SimpleNamespace(test_break=lambda: False, update_stats=lambda *_: None)
    context = ExportContext(engine, b_depsgraph, builder, log)
    material_index(context, b_material)
    radiance, program = world_radiance(context, b_scene.world)
    world = {"name": "World", "radiance": list(radiance), "program": program}
    builder.set_world({**world, "visibility": 31, "film_transparent": False})
    factor, program = node_factor(LampCompiler(context, b_light), b_light)
    builder.add_lamp({**LAMP, "shape": lamp_shape(b_light), "power": list(factor), "program": program})
    builder.set_camera(CAMERA)
    builder.finish()
    assert all(problem.subject and problem.message for problem in log.problems), log.problems


def main() -> None:
    """A scene of a camera, with a material, a lamp and a world of nodes."""
    rgp_engine.register()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    build.shader_tree(bpy.data.materials.new("Material"))
    bpy.context.scene.world = bpy.data.worlds.new("World")
    build.shader_tree(bpy.context.scene.world)
    build.shader_tree(bpy.data.lights.new("Lamp", "POINT"))
    for content in LUMINAIRES:
        bpy.data.texts.new("Luminaire").write(content)
    build.add_camera()
    b_depsgraph = bpy.context.evaluated_depsgraph_get()
    fuzz(lambda draw: try_nodes(draw, b_depsgraph))


if __name__ == "__main__":
    main()
