"""Building a scene: what is refused, what is repaired and reported."""

import math

import numpy as np
import pytest
import rgp_core


def messages(scene):
    return [f"{problem['subject']}: {problem['message']}" for problem in scene.problems]


def test_a_plain_scene(room):
    scene = room.finish()
    assert scene.triangle_count == 2
    assert scene.problems == []


def test_instances_are_counted_each(room):
    mesh = room.builder.add_mesh("Quad", room.positions, room.triangles)
    for _ in range(5):
        room.builder.add_object("Quad", mesh, np.eye(4), [], 31)
    assert room.finish().triangle_count == 12


def test_no_camera():
    with pytest.raises(rgp_core.SceneError, match="camera"):
        rgp_core.SceneBuilder().finish()


@pytest.mark.parametrize(
    ("positions", "triangles", "more"),
    [
        (np.zeros((3, 2), np.float32), np.zeros((1, 3), np.uint32), {}),
        (np.zeros((3, 3), np.float32), np.zeros((1, 4), np.uint32), {}),
        (np.zeros((3, 3), np.float32), np.array([[0, 1, 3]], np.uint32), {}),
        (np.zeros((3, 3), np.float32), np.zeros((1, 3), np.uint32), {"slots": np.zeros(2, np.uint16)}),
        (
            np.zeros((3, 3), np.float32),
            np.zeros((1, 3), np.uint32),
            {"layers": [(0, np.zeros((2, 3, 2), np.float32))]},
        ),
        (
            np.zeros((3, 3), np.float32),
            np.zeros((1, 3), np.uint32),
            {"corner_normals": np.zeros((1, 3), np.float32)},
        ),
    ],
)
def test_arrays_that_do_not_fit_are_refused(room, positions, triangles, more):
    with pytest.raises((rgp_core.SceneError, TypeError)):
        room.builder.add_mesh("Mesh", positions, triangles, **more)


def test_steps_of_what_moves(room):
    mesh = room.builder.add_mesh("Quad", room.positions, room.triangles)
    index = room.builder.add_object("Quad", mesh, np.eye(4), [], 31)
    room.builder.set_object_motion(index, np.stack([np.eye(4)] * 2))
    room.builder.set_mesh_motion(mesh, [None, room.positions + np.float32(1.0)])
    for wrong in (np.stack([np.eye(4)] * 3), np.zeros((2, 3, 4)), np.eye(4)):
        with pytest.raises(rgp_core.SceneError):
            room.builder.set_object_motion(index, wrong)
    for wrong in (
        [room.positions],
        [room.positions, room.positions[:3]],
        [None, room.positions[:, :2].copy()],
    ):
        with pytest.raises(rgp_core.SceneError):
            room.builder.set_mesh_motion(mesh, wrong)
    assert room.finish().problems == []


def test_indices_that_do_not_exist_are_refused(room):
    with pytest.raises(rgp_core.SceneError, match="mesh"):
        room.builder.add_object("Object", 7, np.eye(4), [], 31)
    mesh = room.builder.add_mesh("Quad", room.positions, room.triangles)
    with pytest.raises(rgp_core.SceneError, match="material"):
        room.builder.add_object("Object", mesh, np.eye(4), [7], 31)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_bad_vertices_cost_their_triangles_alone(room, value):
    room.positions[1] = value
    scene = room.finish()
    assert scene.triangle_count == 1
    assert any(text.startswith("Floor: ") for text in messages(scene))


def test_triangles_without_area_are_left_out(room):
    room.positions[2] = room.positions[1]
    scene = room.finish()
    assert scene.triangle_count == 1
    assert any("without area" in text for text in messages(scene))


def test_a_transform_that_is_no_number_costs_the_object(room):
    room.matrix[0, 3] = math.nan
    scene = room.finish()
    assert scene.triangle_count == 0
    assert any(text.startswith("Floor: ") for text in messages(scene))


@pytest.mark.parametrize(
    "closure",
    [
        {"kind": "velvet", "color": [1, 1, 1]},
        {"kind": "diffuse"},
        {"kind": "diffuse", "color": [1, 1]},
        {"kind": "diffuse", "color": [1, 1, 1], "shine": 3},
    ],
)
def test_records_that_make_no_sense_are_refused(room, closure):
    material = {"name": "Odd", "closures": [{"weight": [1.0] * 3, "closure": closure}]}
    with pytest.raises((rgp_core.SceneError, ValueError, TypeError)):
        room.builder.add_material(material)


def test_the_builder_is_empty_afterwards(room):
    room.finish()
    with pytest.raises(rgp_core.SceneError):
        room.builder.finish()
