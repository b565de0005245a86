"""Values at the corners of a mesh that materials read: texture coordinates, colors, attributes."""

from typing import Any

import numpy as np
import numpy.typing as npt

from .islands import island_numbers

Layer = npt.NDArray[np.float32]

ATTRIBUTE_TYPES = {
    "FLOAT": ("value", 1),
    "INT": ("value", 1),
    "INT8": ("value", 1),
    "BOOLEAN": ("value", 1),
    "FLOAT2": ("vector", 2),
    "FLOAT_VECTOR": ("vector", 3),
    "FLOAT_COLOR": ("color", 4),
    "BYTE_COLOR": ("color", 4),
}
"""Property that holds an attribute's values, and how many there are, by its type."""


def corner_layer(b_mesh: Any, name: str, corners: npt.NDArray[np.int32]) -> Layer | None:
    """The layer of that name (see `ExportContext.attribute_number`) at `corners` (T, 3); None where there is none."""
    kind, _, which = name.partition(":")
    if kind == "generated":
        return np.asarray(_generated(b_mesh)[_corner_vertices(b_mesh)[corners]])
    if kind == "island":
        return island_numbers(b_mesh)[_corner_vertices(b_mesh)[corners], None]
    if kind == "uv":
        return _uvs(b_mesh, which, corners)
    if kind == "color":
        index = b_mesh.color_attributes.render_color_index
        which = b_mesh.color_attributes[index].name if 0 <= index < len(b_mesh.color_attributes) else ""
    return _attribute(b_mesh, which, corners)


def _uvs(b_mesh: Any, name: str, corners: npt.NDArray[np.int32]) -> Layer | None:
    """A UV map; without name the one that is active for rendering."""
    chosen = (b for b in b_mesh.uv_layers if (b.name == name if name else b.active_render))
    b_layer = next(chosen, None)
    if b_layer is None:
        return None
    uvs = np.empty((len(b_mesh.loops), 2), np.float32)
    b_layer.uv.foreach_get("vector", uvs.reshape(-1))
    return np.asarray(uvs[corners])


def _attribute(b_mesh: Any, name: str, corners: npt.NDArray[np.int32]) -> Layer | None:
    b_attribute = b_mesh.attributes.get(name)
    if b_attribute is None or b_attribute.data_type not in ATTRIBUTE_TYPES:
        return None
    prop, channels = ATTRIBUTE_TYPES[b_attribute.data_type]
    values = np.empty((len(b_attribute.data), channels), np.float32)
    b_attribute.data.foreach_get(prop, values.reshape(-1))
    if b_attribute.domain == "CORNER":
        return np.asarray(values[corners])
    if b_attribute.domain == "POINT":
        return np.asarray(values[_corner_vertices(b_mesh)[corners]])
    if b_attribute.domain == "FACE":
        faces = np.empty(len(b_mesh.loop_triangles), np.int32)
        b_mesh.loop_triangle_polygons.foreach_get("value", faces)
        return np.asarray(np.repeat(values[faces][:, None], 3, axis=1))
    return None


def _generated(b_mesh: Any) -> Layer:
    """Positions in the mesh's texture space, before modifiers moved the vertices: 0 to 1 in a box around them."""
    positions = np.empty((len(b_mesh.vertices), 3), np.float32)
    b_mesh.vertices.foreach_get("undeformed_co", positions.reshape(-1))
    center = np.array(b_mesh.texspace_location, np.float32)
    half = np.array(b_mesh.texspace_size, np.float32)
    scale = np.divide(0.5, half, out=np.zeros(3, np.float32), where=half != 0.0)
    generated: Layer = (positions - center) * scale + np.float32(0.5)
    return generated


def _corner_vertices(b_mesh: Any) -> npt.NDArray[np.int32]:
    vertices = np.empty(len(b_mesh.loops), np.int32)
    b_mesh.attributes[".corner_vert"].data.foreach_get("value", vertices)
    return vertices
