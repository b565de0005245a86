"""Instances within instances, made by geometry nodes, each with attributes of its own."""

from typing import Any

import bpy

from tests.blender import build


def scatter(b_shown: Any, *, as_instance: bool, joined: bool = False, has_ids: bool = False) -> Any:
    """An object that shows another four times, at (±0.25, ±0.25, 0): pairs along x, one on either side along y.

    Instances of both levels have the attribute `place`, where they lie within their level; those of the pairs have its
    x as `inner`, the pairs its y as `outer`. `as_instance`: the innermost are of the object, else of its mesh.
    `joined`: beside each pair lies a mesh. `has_ids`: they have ids, by which Blender names them.
    """
    b_group = build.nodes_group("Scatter")
    b_in, b_out = b_group.nodes.new("NodeGroupInput"), b_group.nodes.new("NodeGroupOutput")
    b_source = b_group.nodes.new("GeometryNodeObjectInfo")
    b_source.inputs["Object"].default_value = b_shown
    b_source.inputs["As Instance"].default_value = as_instance
    b_pair = _level(b_group, b_in.outputs[0], b_source.outputs["Geometry"], "inner", has_ids)
    if joined:
        b_join = b_group.nodes.new("GeometryNodeJoinGeometry")
        b_grid = b_group.nodes.new("GeometryNodeMeshGrid")
        for name in ("Size X", "Size Y"):
            b_grid.inputs[name].default_value = 0.001
        for b_output in (b_grid.outputs["Mesh"], b_pair):
            b_group.links.new(b_output, b_join.inputs[0])
        b_pair = b_join.outputs[0]
    b_turn = b_group.nodes.new("GeometryNodeTransform")
    b_turn.inputs["Rotation"].default_value = (0.0, 0.0, build.quarter_turn())
    b_group.links.new(b_in.outputs[0], b_turn.inputs["Geometry"])
    b_all = _level(b_group, b_turn.outputs[0], b_pair, "outer", has_ids)
    b_group.links.new(b_all, b_out.inputs[0])
    b_points = bpy.data.meshes.new("Points")
    b_points.from_pydata([(-0.25, 0.0, 0.0), (0.25, 0.0, 0.0)], [], [])
    b_object = build.add_object("Scatter", b_points)
    b_object.modifiers.new("Scatter", "NODES").node_group = b_group
    return b_object


def _level(b_group: Any, b_points: Any, b_instance: Any, name: str, has_ids: bool) -> Any:
    """Instances on points, with attributes."""
    if has_ids:
        b_ids = b_group.nodes.new("GeometryNodeSetID")
        b_number = build.node(b_group, "ShaderNodeMath")
        b_number.operation = "MULTIPLY_ADD"
        b_number.inputs[1].default_value, b_number.inputs[2].default_value = -1e6, 3e7
        b_group.links.new(b_group.nodes.new("GeometryNodeInputIndex").outputs[0], b_number.inputs[0])
        b_group.links.new(b_points, b_ids.inputs["Geometry"])
        b_group.links.new(b_number.outputs[0], b_ids.inputs["ID"])
        b_points = b_ids.outputs[0]
    b_instances = b_group.nodes.new("GeometryNodeInstanceOnPoints")
    b_group.links.new(b_points, b_instances.inputs["Points"])
    b_group.links.new(b_instance, b_instances.inputs["Instance"])
    if name == "inner":
        b_instances.inputs["Scale"].default_value = (1 / 6, 1 / 6, 1 / 6)
    b_position, b_axes = (
        b_group.nodes.new(kind) for kind in ("GeometryNodeInputPosition", "ShaderNodeSeparateXYZ")
    )
    b_group.links.new(b_position.outputs[0], b_axes.inputs[0])
    b_stored = _store(b_group, b_instances.outputs[0], "place", "FLOAT_VECTOR", b_position.outputs[0])
    axis = b_axes.outputs["X" if name == "inner" else "Y"]
    return _store(b_group, b_stored, name, "FLOAT", axis)


def _store(b_group: Any, b_geometry: Any, name: str, data_type: str, b_value: Any) -> Any:
    b_store = b_group.nodes.new("GeometryNodeStoreNamedAttribute")
    b_store.domain, b_store.data_type = "INSTANCE", data_type
    b_store.inputs["Name"].default_value = name
    b_group.links.new(b_geometry, b_store.inputs["Geometry"])
    b_entry = next(b_socket for b_socket in b_store.inputs if b_socket.name == "Value" and b_socket.enabled)
    b_group.links.new(b_value, b_entry)
    return b_store.outputs[0]
