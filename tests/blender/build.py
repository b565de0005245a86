"""Small scenes, in the words of `bpy.data`."""

import math
from collections.abc import Sequence
from typing import Any

import bpy

CUBE_CORNERS = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
CUBE_FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def link(b_object: Any) -> Any:
    bpy.context.scene.collection.objects.link(b_object)
    return b_object


def add_object(name: str, data: Any, location: Sequence[float] = (0, 0, 0)) -> Any:
    b_object = link(bpy.data.objects.new(name, data))
    b_object.location = location
    return b_object


def add_camera(location: Sequence[float] = (0, 0, 10)) -> Any:
    """Looks along -z from `location`, active."""
    b_object = add_object("Camera", bpy.data.cameras.new("Camera"), location)
    bpy.context.scene.camera = b_object
    return b_object


def add_light(kind: str, name: str = "Lamp", **properties: Any) -> Any:
    b_light = bpy.data.lights.new(name, kind)
    for key, value in properties.items():
        setattr(b_light, key, value)
    return add_object(name, b_light, (0, 0, 3))


def mesh(name: str, corners: Sequence[Sequence[float]], faces: Sequence[Sequence[int]]) -> Any:
    b_mesh = bpy.data.meshes.new(name)
    b_mesh.from_pydata(corners, [], faces)
    return b_mesh


def cube(name: str = "Cube") -> Any:
    return mesh(name, CUBE_CORNERS, CUBE_FACES)


def quad(name: str = "Quad", size: float = 1.0) -> Any:
    return mesh(
        name, [(-size, -size, 0), (size, -size, 0), (size, size, 0), (-size, size, 0)], [(0, 1, 2, 3)]
    )


def shader_tree(b_id: Any) -> Any:
    """The node tree of a material, world or light, in use and emptied."""
    b_use_nodes = b_id.bl_rna.properties.get("use_nodes")
    if b_use_nodes is not None and not getattr(b_use_nodes, "is_deprecated", False):
        b_id.use_nodes = True
    b_id.node_tree.nodes.clear()
    return b_id.node_tree


def socket(b_sockets: Any, identifier: str) -> Any:
    return next(b_socket for b_socket in b_sockets if b_socket.identifier == identifier)


def node(b_tree: Any, kind: str, **inputs: Any) -> Any:
    """A node with the values of its inputs; underscores in names stand for spaces."""
    b_node = b_tree.nodes.new(kind)
    for name, value in inputs.items():
        b_socket = b_node.inputs[name.replace("_", " ")]
        if hasattr(value, "nodes") or hasattr(value, "from_node"):
            raise TypeError("link nodes with connect()")
        b_socket.default_value = (*value, 1.0) if b_socket.type == "RGBA" and len(value) == 3 else value
    return b_node


def connect(b_tree: Any, b_from: Any, b_to: Any, identifier: str, output: str | None = None) -> None:
    """Links a node's output (the first, or the one with that identifier) to an input."""
    b_output = socket(b_from.outputs, output) if output else b_from.outputs[0]
    b_tree.links.new(b_output, socket(b_to.inputs, identifier))


def material(name: str = "Material") -> tuple[Any, Any, Any]:
    """A material whose nodes are an output alone: material, tree, output node."""
    b_material = bpy.data.materials.new(name)
    b_tree = shader_tree(b_material)
    return b_material, b_tree, b_tree.nodes.new("ShaderNodeOutputMaterial")


def surface(kind: str, name: str = "Material", **inputs: Any) -> Any:
    """A material of one shader node."""
    b_material, b_tree, b_output = material(name)
    connect(b_tree, node(b_tree, kind, **inputs), b_output, "Surface")
    return b_material


def lit_room() -> None:
    """A camera above a quad, with a lamp."""
    add_camera()
    add_object("Floor", quad(size=4.0))
    add_light("POINT", energy=100.0)


def nodes_group(name: str, kind: str = "GeometryNodeTree") -> Any:
    """A geometry nodes tree with a geometry input and output."""
    b_group = bpy.data.node_groups.new(name, kind)
    b_group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    b_group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    return b_group


def quarter_turn() -> float:
    return math.pi / 2
