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
    if camera["projection"]["kind"] == "perspective":
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


def panorama(b_camera, kind, **settings):
    b_camera.type, b_camera.panorama_type = "PANO", kind
    for name, value in settings.items():
        setattr(b_camera, name, value)


def test_angles_of_panoramas_are_the_window(scene, export, problems):
    b_camera = build.add_camera().data
    scene.render.resolution_x, scene.render.resolution_y = 40, 20
    window = {"longitude_min": -1.0, "longitude_max": 2.0, "latitude_min": -0.5, "latitude_max": 1.0}
    panorama(b_camera, "EQUIRECTANGULAR", **window)
    camera = export().camera
    assert camera["projection"] == {"kind": "equirectangular"}
    assert camera["window"] == pytest.approx([-1.0, 2.0, -0.5, 1.0])
    b_camera.shift_x, b_camera.shift_y = 0.1, -0.2
    assert export().camera["window"] == pytest.approx([-0.7, 2.3, -0.8, 0.7])
    b_camera.shift_x = b_camera.shift_y = 0.0
    panorama(b_camera, "EQUIANGULAR_CUBEMAP_FACE")
    camera = export().camera
    assert camera["projection"] == {"kind": "cubemap_face"}
    assert camera["window"] == pytest.approx([-math.pi / 4, math.pi / 4, -math.pi / 4, math.pi / 4])
    assert not any("camera" in text.lower() for text in problems())


@pytest.mark.skipif(
    "central_cylindrical_radius" not in bpy.types.Camera.bl_rna.properties,
    reason="Blender 4.2 has no cylindrical panoramas",
)
def test_cylinders_have_a_radius(scene, export):
    b_camera = build.add_camera().data
    panorama(b_camera, "CENTRAL_CYLINDRICAL", central_cylindrical_radius=2.0)
    b_camera.central_cylindrical_range_u_min, b_camera.central_cylindrical_range_v_max = -2.0, 3.0
    camera = export().camera
    assert camera["projection"] == {"kind": "cylindrical"}
    assert camera["window"] == pytest.approx([-2.0, math.pi, -0.5, 1.5])


@pytest.mark.parametrize(
    ("fit", "width", "height"), [("AUTO", 30.0, 15.0), ("HORIZONTAL", 30.0, 15.0), ("VERTICAL", 40.0, 20.0)]
)
def test_fisheyes_have_a_lens_or_none(scene, export, fit, width, height):
    b_camera = build.add_camera().data
    scene.render.resolution_x, scene.render.resolution_y = 40, 20
    b_camera.sensor_fit, b_camera.sensor_width, b_camera.sensor_height = fit, 30.0, 20.0
    panorama(b_camera, "FISHEYE_EQUISOLID", fisheye_lens=10.0, fisheye_fov=3.0)
    camera = export().camera
    assert camera["projection"] == {"kind": "fisheye_equisolid", "field_of_view": 3.0}
    half_width, half_height = width / 2.0, height / 2.0
    frame = np.array([-half_width, half_width, -half_height, half_height])
    assert camera["window"] == pytest.approx(frame / 10.0)
    polynomial = {f"fisheye_polynomial_k{power}": -(0.5**power) for power in range(5)}
    panorama(b_camera, "FISHEYE_LENS_POLYNOMIAL", **polynomial)
    camera = export().camera
    assert camera["projection"]["coefficients"] == [1.0, 0.5, 0.25, 0.125, 0.0625]
    assert camera["window"] == pytest.approx(frame)
    panorama(b_camera, "FISHEYE_EQUIDISTANT")
    camera = export().camera
    assert camera["projection"] == {"kind": "fisheye_equidistant", "field_of_view": 3.0}
    assert camera["window"] == pytest.approx([-1.5, 1.5, -1.5, 1.5])
    panorama(b_camera, "MIRRORBALL")
    camera = export().camera
    assert camera["projection"] == {
        "kind": "fisheye_equisolid",
        "field_of_view": pytest.approx(2.0 * math.pi),
    }
    assert camera["window"] == [-2.0, 2.0, -2.0, 2.0]


def test_mirrored_panoramas_are_reported(scene, export, problems):
    b_camera = build.add_camera().data
    b_camera.name = "All Around"
    panorama(b_camera, "EQUIRECTANGULAR", longitude_min=1.0, longitude_max=-1.0)
    assert export().camera["window"][:2] == [1.0, -1.0]
    assert any("the picture is mirrored" in text for text in problems())


def test_lens(scene, export):
    b_camera = build.add_camera().data
    assert export().camera["lens"] is None
    b_dof = b_camera.dof
    b_dof.use_dof, b_dof.aperture_fstop, b_dof.focus_distance = True, 2.0, 3.5
    b_dof.aperture_blades, b_dof.aperture_rotation, b_dof.aperture_ratio = 6, 0.25, 1.5
    b_camera.lens = 80.0
    shape = {"blades": 6, "rotation": 0.25, "ratio": 1.5}
    assert export().camera["lens"] == pytest.approx({"radius": 0.02, "focus_distance": 3.5, **shape})
    b_camera.type = "ORTHO"
    assert export().camera["lens"]["radius"] == pytest.approx(0.25)


def test_focus_on_an_object_or_a_bone(scene, export):
    b_object = build.add_camera((0.0, 0.0, 10.0))
    b_object.rotation_euler, b_object.scale = (0.5, 0.0, 0.0), (2.0, 2.0, 2.0)
    b_dof = b_object.data.dof
    b_dof.use_dof = True
    b_dof.focus_object = build.add_object("Focus", None, (1.0, 0.0, 4.0))
    # Depth along the view axis: neither the distance, nor scaled by the camera.
    assert export().camera["lens"]["focus_distance"] == pytest.approx(6.0 * math.cos(0.5))
    b_armature = build.add_object("Armature", bpy.data.armatures.new("Armature"), (0.0, 0.0, 1.0))
    bpy.context.view_layer.objects.active = b_armature
    bpy.ops.object.mode_set(mode="EDIT")
    b_bone = b_armature.data.edit_bones.new("Bone")
    b_bone.head, b_bone.tail = (0.0, 0.0, 2.0), (0.0, 0.0, 3.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    b_dof.focus_object, b_dof.focus_subtarget = b_armature, "Bone"
    assert export().camera["lens"]["focus_distance"] == pytest.approx(7.0 * math.cos(0.5))
