"""The camera against Blender's own idea of where a point lies in the frame."""

import itertools
import math

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

from tests.blender import build

POINTS = [Vector(p) for p in itertools.product((-1.5, 0.2, 1.7), (-1.1, 0.4, 2.0), (-2.0, 0.5))]


def frame_position(camera, point):
    """Where our record puts a world point: 0 to 1 over the full frame, as `world_to_camera_view` says it."""
    x, y, z, _ = np.linalg.inv(np.array(camera["world_from_camera"])) @ (*point, 1.0)
    if camera["projection"] == "perspective":
        x, y = x / -z, y / -z
    left, right, bottom, top = camera["window"]
    return (x - left) / (right - left), (y - bottom) / (top - bottom)


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
@pytest.mark.parametrize("fit", ["AUTO", "HORIZONTAL", "VERTICAL"])
@pytest.mark.parametrize("resolution", [(32, 24), (20, 40)])
@pytest.mark.parametrize("aspect", [(1.0, 1.0), (2.0, 1.0), (1.0, 1.5)])
def test_points_lie_where_blender_sees_them(scene, export, kind, fit, resolution, aspect):
    b_object = build.add_camera((0.3, -7.0, 2.0))
    b_object.rotation_euler = (math.radians(75), 0.1, 0.2)
    b_object.scale = (1.0, 1.0, 1.0)
    b_camera = b_object.data
    b_camera.type, b_camera.sensor_fit = kind, fit
    b_camera.lens, b_camera.sensor_width, b_camera.sensor_height = 35.0, 30.0, 20.0
    b_camera.shift_x, b_camera.shift_y, b_camera.ortho_scale = 0.15, -0.1, 7.0
    scene.render.resolution_x, scene.render.resolution_y = resolution
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = aspect
    camera = export().camera
    for point in POINTS:
        expected = world_to_camera_view(scene, b_object, point)
        assert frame_position(camera, point) == pytest.approx((expected.x, expected.y), abs=2e-5)


def test_scaled_and_parented_camera(scene, export):
    b_object = build.add_camera((0.0, 0.0, 4.0))
    b_parent = build.add_object("Parent", None, (1.0, 2.0, 3.0))
    b_parent.scale = (2.0, 2.0, 2.0)
    b_object.parent = b_parent
    matrix = np.array(export().camera["world_from_camera"])
    assert matrix[:3, 3] == pytest.approx([1.0, 2.0, 11.0])
    directions = matrix[:3, :3] / np.linalg.norm(matrix[:3, :3], axis=0)
    assert directions == pytest.approx(np.eye(3), abs=1e-6)


def test_clip_and_percentage(scene, export):
    b_camera = build.add_camera().data
    b_camera.clip_start, b_camera.clip_end = 0.5, 40.0
    scene.render.resolution_percentage = 50
    camera = export().camera
    assert camera["clip"] == [0.5, 40.0]
    assert camera["resolution"] == [16, 12]
    assert camera["region"] == [0, 0, 16, 12]


@pytest.mark.parametrize("crops", [False, True])
def test_border_region_is_part_of_the_full_frame(scene, export, crops):
    build.add_camera()
    scene.render.resolution_x, scene.render.resolution_y = 200, 100
    scene.render.use_border, scene.render.use_crop_to_border = True, crops
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.1, 0.4
    camera = export().camera
    assert camera["resolution"] == [200, 100]
    assert camera["region"] == [50, 10, 100, 30]


def test_border_to_the_edge_stays_in_the_frame(scene, export):
    build.add_camera()
    scene.render.resolution_x, scene.render.resolution_y = 101, 67
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.333, 1.0
    scene.render.border_min_y, scene.render.border_max_y = 0.501, 1.0
    x, y, width, height = export().camera["region"]
    assert (x, y) == (33, 33)
    assert (x + width, y + height) == (101, 67)


def test_corner_of_the_border_is_rounded_down(scene, export):
    build.add_camera()
    scene.render.resolution_x, scene.render.resolution_y = 101, 67
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.333, 0.7
    scene.render.border_min_y, scene.render.border_max_y = 0.206, 0.8
    x, y, width, height = export().camera["region"]
    # 33.6, 13.8, 70.7 and 53.6 pixels.
    assert (x, y, x + width, y + height) == (33, 13, 70, 53)


def test_timeline_marker_chooses_the_camera(scene, export):
    build.add_camera((0.0, 0.0, 1.0))
    b_second = build.add_object("Second", bpy.data.cameras.new("Second"), (0.0, 0.0, 2.0))
    scene.timeline_markers.new("cut", frame=10).camera = b_second
    scene.frame_set(10)
    assert export().camera["name"] == "Second"


def test_panorama_falls_back_and_says_so(scene, export, problems):
    b_camera = build.add_camera().data
    b_camera.type = "PANO"
    assert export().camera["projection"] == "perspective"
    assert any("panoramic camera is not supported yet" in text for text in problems())


def test_depth_of_field_is_reported(scene, export, problems):
    build.add_camera().data.dof.use_dof = True
    export()
    assert "Camera: depth of field is not supported yet; everything is sharp" in problems()
