"""Export of a million triangles, from Blender's evaluated scene to the core's checked one."""

from typing import Any

import bpy
import numpy as np

from benchmarks.capture import capture
from benchmarks.figures import Figure, Progress
from scenes import common

_COLUMNS, _ROWS = 1000, 500
"""Quads, which make two triangles each."""

_MATERIALS = 4


def measure(repetitions: int, progress: Progress) -> dict[str, Figure]:
    """Seconds of the export of a mesh as it was modelled, and of one a modifier has made."""
    figures = {}
    for name, modified in (("mesh", False), ("modified mesh", True)):
        seconds = []
        for repetition in range(repetitions):
            # A new file each time: Blender keeps normals and triangles it has once computed.
            captured = capture(_scene(modified=modified))
            assert captured.scene.triangle_count == 2 * _COLUMNS * _ROWS
            seconds.append(captured.seconds)
            progress(f"export of a {name}, {repetition + 1} of {repetitions}: {captured.seconds:.2f} s")
        figures[name] = Figure(seconds)
    return figures


def _scene(*, modified: bool) -> Any:
    """A camera above a smooth, textured, wavy sheet of several materials."""
    b_scene = common.start_empty_file()
    b_object = common.add_object("Sheet", _sheet())
    if modified:
        b_object.modifiers.new("Displace", "DISPLACE").strength = 0.01
    common.add_camera((0.0, 0.0, 3.0), (0.0, 0.0, 0.0), 1.0, (64, 64))
    return b_scene


def _sheet() -> Any:
    """The mesh, a metre wide."""
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, _COLUMNS + 1), np.linspace(-0.5, 0.5, _ROWS + 1))
    positions = np.stack([x, y, 0.05 * np.sin(20.0 * x) * np.cos(20.0 * y)], axis=-1)
    vertex = np.arange(x.size).reshape(x.shape)
    corners = np.stack([vertex[:-1, :-1], vertex[:-1, 1:], vertex[1:, 1:], vertex[1:, :-1]], axis=-1)
    face_count = _COLUMNS * _ROWS
    b_mesh = bpy.data.meshes.new("Sheet")
    b_mesh.vertices.add(x.size)
    b_mesh.vertices.foreach_set("co", positions.reshape(-1).astype(np.float32))
    b_mesh.loops.add(corners.size)
    b_mesh.loops.foreach_set("vertex_index", corners.reshape(-1).astype(np.int32))
    b_mesh.polygons.add(face_count)
    b_mesh.polygons.foreach_set("loop_start", np.arange(face_count, dtype=np.int32) * 4)
    b_mesh.polygons.foreach_set("material_index", np.arange(face_count, dtype=np.int32) % _MATERIALS)
    uvs = np.stack([x, y], axis=-1).reshape(-1, 2)[corners.reshape(-1)] + 0.5
    b_mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", uvs.reshape(-1).astype(np.float32))
    b_mesh.update(calc_edges=True)
    b_mesh.shade_smooth()
    for number in range(_MATERIALS):
        grey = 0.2 + 0.15 * number
        b_mesh.materials.append(common.diffuse_material(f"Grey {number}", (grey, grey, grey)))
    return b_mesh
