"""Evaluated meshes as arrays.

Blender's collections are read through the address of their first element where that is 20 to 200 times faster than
`foreach_get`; the layout is checked on every mesh, with `foreach_get` as the way out.
"""

import ctypes
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .coordinates import mark_infinite
from .layers import corner_layer


@dataclass
class MeshArrays:
    """Triangles of a mesh, as `SceneBuilder.add_mesh` takes them."""

    positions: npt.NDArray[np.float32]
    """(V, 3)"""
    triangles: npt.NDArray[np.uint32]
    """(T, 3)"""
    corner_normals: npt.NDArray[np.float32] | None
    """(T, 3, 3); None where every face is flat."""
    slots: npt.NDArray[np.uint16] | None
    """(T,); None where every face has the first material."""
    layers: dict[str, npt.NDArray[np.float32]]
    """By name, (T, 3, 1 to 4)."""


def mesh_arrays(b_mesh: Any, layers: Iterable[str] = ()) -> MeshArrays | None:
    """Arrays of an evaluated mesh, with the layers of those names that it has; None when it has no triangle."""
    b_mesh.calc_loop_triangles()
    if not b_mesh.loop_triangles:
        return None
    attributes = b_mesh.attributes
    positions = np.empty((len(b_mesh.vertices), 3), np.float32)
    attributes["position"].data.foreach_get("vector", positions.reshape(-1))
    corner_vertices = np.empty(len(b_mesh.loops), np.int32)
    attributes[".corner_vert"].data.foreach_get("value", corner_vertices)
    corners = _elements(b_mesh.loop_triangles, "loops", np.int32)
    return MeshArrays(
        mark_infinite(positions),
        corner_vertices[corners].astype(np.uint32),
        _corner_normals(b_mesh, corners),
        _slots(b_mesh),
        {name: values for name in layers if (values := corner_layer(b_mesh, name, corners)) is not None},
    )


def _corner_normals(b_mesh: Any, corners: npt.NDArray[np.int32]) -> npt.NDArray[np.float32] | None:
    """Normals at the corners of the triangles; None for a mesh that is flat all over."""
    if b_mesh.normals_domain == "FACE":
        return None
    return _elements(b_mesh.corner_normals, "vector", np.float32)[corners]


def _slots(b_mesh: Any) -> npt.NDArray[np.uint16] | None:
    """Material slot of each triangle."""
    b_attribute = b_mesh.attributes.get("material_index")
    if b_attribute is None:
        return None
    face_slots = np.empty(len(b_mesh.polygons), np.int32)
    b_attribute.data.foreach_get("value", face_slots)
    if not face_slots.any():
        return None
    faces = np.empty(len(b_mesh.loop_triangles), np.int32)
    b_mesh.loop_triangle_polygons.foreach_get("value", faces)
    return face_slots[faces].clip(0, np.iinfo(np.uint16).max).astype(np.uint16)


def _elements(b_collection: Any, name: str, dtype: type[np.generic]) -> npt.NDArray[Any]:
    """Property `name` of a collection whose elements are three numbers of four bytes: (count, 3)."""
    view = _memory_view(b_collection, name, dtype)
    if view is not None:
        return view
    values = np.empty((len(b_collection), 3), dtype)
    b_collection.foreach_get(name, values.reshape(-1))
    return values


def _memory_view(b_collection: Any, name: str, dtype: type[np.generic]) -> npt.NDArray[Any] | None:
    """A copy of the collection's memory, or None when its first and last element do not lie as expected."""
    last = len(b_collection) - 1
    address = b_collection[0].as_pointer()
    if b_collection[last].as_pointer() - address != last * 12:
        return None
    content = ctypes.string_at(address, (last + 1) * 12)
    values: npt.NDArray[Any] = np.frombuffer(content, dtype).reshape(-1, 3)
    for index in (0, last):
        if not np.array_equal(values[index], np.array(getattr(b_collection[index], name), dtype)):
            return None
    return values
