"""Mesh arrays against Blender's slow and documented way to read them."""

import time

import bpy
import numpy as np
import pytest

from rgp_engine.export import mesh as export_mesh
from rgp_engine.export.mesh import mesh_arrays
from tests.blender import build


def slow(b_collection, name, width, dtype):
    values = np.empty(len(b_collection) * width, dtype)
    b_collection.foreach_get(name, values)
    return values.reshape(-1, width)


def wavy(side=40):
    """A curved grid of quads and triangles with UVs, two materials and smooth faces."""
    x, y = np.meshgrid(np.linspace(-1, 1, side), np.linspace(-1, 1, side))
    corners = np.stack([x, y, 0.2 * np.sin(5 * x) * np.cos(4 * y)], axis=-1).reshape(-1, 3)
    faces = []
    for row in range(side - 1):
        for column in range(side - 1):
            a = row * side + column
            quad = (a, a + 1, a + side + 1, a + side)
            faces += [quad] if (row + column) % 2 else [quad[:3], (quad[0], quad[2], quad[3])]
    b_mesh = build.mesh("Wavy", corners.tolist(), faces)
    b_mesh.shade_smooth()
    uvs = b_mesh.uv_layers.new(name="UV")
    uvs.uv.foreach_set("vector", np.random.default_rng(1).random(len(b_mesh.loops) * 2, np.float32))
    b_mesh.polygons.foreach_set("material_index", np.arange(len(b_mesh.polygons), dtype=np.int32) % 2)
    b_mesh.update()
    return b_mesh


@pytest.mark.parametrize("reads_memory", [True, False])
def test_arrays_equal_the_documented_properties(scene, monkeypatch, reads_memory):
    if not reads_memory:
        monkeypatch.setattr(export_mesh, "_memory_view", lambda *_: None)
    b_mesh = wavy()
    arrays = mesh_arrays(b_mesh, ["uv", "uv:UV", "uv:Other"])
    corners = slow(b_mesh.loop_triangles, "loops", 3, np.int32)
    assert np.array_equal(arrays.positions, slow(b_mesh.vertices, "co", 3, np.float32))
    assert np.array_equal(arrays.triangles, slow(b_mesh.loop_triangles, "vertices", 3, np.int32))
    assert np.array_equal(
        arrays.corner_normals, slow(b_mesh.corner_normals, "vector", 3, np.float32)[corners]
    )
    uvs = slow(b_mesh.uv_layers["UV"].data, "uv", 2, np.float32)[corners]
    assert sorted(arrays.layers) == ["uv", "uv:UV"]
    assert all(np.array_equal(layer, uvs) for layer in arrays.layers.values())
    assert np.array_equal(arrays.slots, slow(b_mesh.loop_triangles, "material_index", 1, np.int32)[:, 0])
    assert (arrays.positions.dtype, arrays.triangles.dtype, arrays.slots.dtype) == (
        np.float32,
        np.uint32,
        np.uint16,
    )


def test_memory_of_another_layout_is_refused(scene):
    b_mesh = wavy(4)
    b_mesh.calc_loop_triangles()
    # Vertices hold three floats; read as whole numbers their memory disagrees with the property.
    assert export_mesh._memory_view(b_mesh.vertices, "co", np.int32) is None
    # Edges hold two whole numbers: the stride is not twelve bytes.
    assert export_mesh._memory_view(b_mesh.edges, "vertices", np.int32) is None


def test_flat_mesh_has_no_normals_and_one_slot(scene):
    arrays = mesh_arrays(build.cube())
    assert arrays.corner_normals is None
    assert arrays.layers == {}
    assert arrays.slots is None
    assert arrays.triangles.shape == (12, 3)


def test_triangles_face_outwards(scene):
    arrays = mesh_arrays(build.cube())
    corners = arrays.positions[arrays.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("ij,ij->i", normals, corners.mean(axis=1)) > 0).all()


def test_partly_smooth_mesh_keeps_its_sharp_faces(scene):
    b_mesh = build.cube()
    b_mesh.shade_smooth()
    b_mesh.polygons[0].use_smooth = False
    arrays = mesh_arrays(b_mesh)
    faces = np.empty(12, np.int32)
    b_mesh.loop_triangle_polygons.foreach_get("value", faces)
    flat = arrays.corner_normals[faces == 0].reshape(-1, 3)
    assert flat == pytest.approx(np.tile(b_mesh.polygons[0].normal, (len(flat), 1)), abs=1e-3)


@pytest.mark.parametrize("corners", [[], [(0, 0, 0), (1, 0, 0)]])
def test_mesh_without_faces_is_nothing(scene, corners):
    assert mesh_arrays(build.mesh("Points", corners, [])) is None


def test_uvs_are_those_active_for_rendering(scene):
    b_mesh = build.quad()
    b_mesh.uv_layers.new(name="Other")
    b_render = b_mesh.uv_layers.new(name="Render")
    b_render.uv.foreach_set("vector", np.full(8, 0.375, np.float32))
    b_render.active_render = True
    b_mesh.uv_layers.active_index = 0
    layers = mesh_arrays(b_mesh, ["uv", "uv:Other"]).layers
    assert (layers["uv"] == 0.375).all()
    assert (layers["uv:Other"] != 0.375).any()


def test_a_million_triangles_take_less_than_two_seconds(scene):
    side = 708
    x, y = np.meshgrid(np.linspace(-1, 1, side, dtype=np.float32), np.linspace(-1, 1, side, dtype=np.float32))
    positions = np.stack([x, y, np.sin(9 * x) * y], axis=-1)
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    faces = np.stack([first, first + 1, first + side + 1, first + side], axis=-1)
    b_mesh = bpy.data.meshes.new("Million")
    b_mesh.vertices.add(side * side)
    b_mesh.vertices.foreach_set("co", positions.ravel())
    b_mesh.loops.add(faces.size)
    b_mesh.loops.foreach_set("vertex_index", faces.ravel())
    b_mesh.polygons.add(len(faces))
    b_mesh.polygons.foreach_set("loop_start", np.arange(0, faces.size, 4))
    b_mesh.update()
    b_mesh.shade_smooth()
    start = time.perf_counter()
    arrays = mesh_arrays(b_mesh)
    seconds = time.perf_counter() - start
    assert len(arrays.triangles) == 2 * len(faces) > 999_000
    assert seconds < 2.0
