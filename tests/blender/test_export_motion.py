"""What moves while the shutter is open, and what the frame is before and after."""

import bpy
import numpy as np
import pytest

from tests.blender import build

FRAME = 7
SPEED = 2.0
"""Of what moves along x (m per frame)."""


@pytest.fixture
def blurred(scene):
    """A scene at frame 7 whose shutter is open for half a frame about it; nothing moves yet."""
    build.add_camera()
    scene.render.use_motion_blur = True
    scene.render.motion_blur_shutter = 0.5
    scene.frame_set(FRAME)
    return scene


def animate(b_id, path, values, index=-1):
    """Keys at the frames 0 and 20, straight between and beyond."""
    for frame, value in zip((0, 20), values, strict=True):
        if index < 0:
            setattr(b_id, path, value)
        else:
            getattr(b_id, path)[index] = value
        b_id.keyframe_insert(path, index=index, frame=frame)
    b_action = (b_id.id_data if isinstance(b_id, bpy.types.ShapeKey) else b_id).animation_data.action
    for b_curve in curves(b_action):
        b_curve.extrapolation = "LINEAR"
        for b_key in b_curve.keyframe_points:
            b_key.interpolation = "LINEAR"


def curves(b_action):
    """The action's curves, in whatever layers this Blender keeps them."""
    if hasattr(b_action, "layers") and b_action.layers:
        return [
            b_curve
            for b_strip in b_action.layers[0].strips
            for b_bag in b_strip.channelbags
            for b_curve in b_bag.fcurves
        ]
    return list(b_action.fcurves)


def add_moving(name="Ball"):
    """A cube at x = SPEED · frame."""
    b_object = build.add_object(name, build.cube(name))
    animate(b_object, "location", (0.0, SPEED * 20), index=0)
    bpy.context.scene.frame_set(FRAME)
    return b_object


def steps_of(record):
    """Places along x of an object's steps."""
    return [step[0, 3] for step in record["steps"]]


@pytest.mark.parametrize(
    ("position", "times"),
    [("START", (7.0, 7.25, 7.5)), ("CENTER", (6.75, 7.0, 7.25)), ("END", (6.5, 6.75, 7.0))],
)
def test_the_shutter_opens_where_its_position_says(blurred, export, problems, position, times):
    add_moving()
    build.add_object("Still", build.cube("Still"))
    blurred.render.motion_blur_position = position
    core = export()
    (ball,), (still,) = core.objects_of("Ball"), core.objects_of("Still")
    opens, middle, shuts = (SPEED * time for time in times)
    assert ball["world_from_object"][0, 3] == pytest.approx(middle)
    assert steps_of(ball) == pytest.approx([opens, shuts])
    assert "steps" not in still
    assert "steps" not in core.camera
    assert core.camera["shutter"] == []
    assert (blurred.frame_current, blurred.frame_subframe) == (FRAME, 0.0)
    assert bpy.data.objects["Ball"].matrix_world[0][3] == pytest.approx(SPEED * FRAME)
    assert not any("motion" in text for text in problems())


def test_subframes_stay(blurred, export):
    add_moving()
    blurred.frame_set(FRAME, subframe=0.5)
    (ball,) = export().objects_of("Ball")
    assert steps_of(ball) == pytest.approx([SPEED * 7.25, SPEED * 7.75])
    assert (blurred.frame_current, blurred.frame_subframe) == (FRAME, 0.5)


@pytest.mark.parametrize("how", ["scene", "view layer", "effect", "shutter"])
def test_off_looks_at_no_other_frame(blurred, export, how):
    add_moving()
    if how == "scene":
        blurred.render.use_motion_blur = False
    elif how == "effect":
        blurred.rgp.effects.motion_blur = "off"
    elif how == "shutter":
        blurred.render.motion_blur_shutter = 0.0
    else:
        bpy.context.view_layer.use_motion_blur = False
    seen = []

    def note(b_scene, *_):
        seen.append(b_scene.frame_current_final)

    bpy.app.handlers.depsgraph_update_post.append(note)
    try:
        core = export()
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(note)
    assert "steps" not in core.objects_of("Ball")[0]
    assert "shutter" not in core.camera
    assert set(seen) <= {float(FRAME)}


def test_camera_and_zoom(blurred, export):
    b_camera = blurred.camera
    animate(b_camera, "location", (0.0, SPEED * 20), index=0)
    animate(b_camera.data, "lens", (50.0, 100.0))
    blurred.frame_set(FRAME)
    camera = export().camera
    assert [step["world_from_camera"][0][3] for step in camera["steps"]] == pytest.approx([13.5, 14.5])
    widths = [step["window"][1] for step in camera["steps"]]
    assert widths == pytest.approx([18.0 / (50.0 + 2.5 * time) for time in (6.75, 7.25)])
    assert camera["window"][1] == pytest.approx(18.0 / 67.5)


def test_shutter_curve(blurred, export):
    add_moving()
    b_mapping = blurred.render.motion_blur_shutter_curve
    for b_point in b_mapping.curves[0].points:
        b_point.location.y = b_point.location.x
        b_point.handle_type = "VECTOR"
    b_mapping.update()
    curve = np.array(export().camera["shutter"])
    assert curve == pytest.approx(np.linspace(0.0, 1.0, len(curve)), abs=0.01)


def test_shape_key(blurred, export):
    b_object = build.add_object("Cloth", build.quad("Cloth"))
    b_object.shape_key_add(name="Basis")
    b_key = b_object.shape_key_add(name="Up")
    for point in b_key.data:
        point.co.z = 10.0
    for frame, value in ((0, 0.0), (20, 1.0)):
        b_key.value = value
        b_key.keyframe_insert("value", frame=frame)
    for b_curve in curves(b_object.data.shape_keys.animation_data.action):
        for b_point in b_curve.keyframe_points:
            b_point.interpolation = "LINEAR"
    blurred.frame_set(FRAME)
    core = export()
    (cloth,) = core.objects_of("Cloth")
    assert "steps" not in cloth
    steps = core.meshes[cloth["mesh"]]["steps"]
    assert [step[:, 2] for step in steps] == [pytest.approx([z] * 4) for z in (3.375, 3.625)]
    assert core.meshes[cloth["mesh"]]["positions"][:, 2] == pytest.approx([3.5] * 4)


def test_other_faces_at_other_times_are_reported(blurred, export, problems):
    b_object = build.add_object("Grows", build.quad("Grows"))
    b_array = b_object.modifiers.new("Array", "ARRAY")
    b_array.count = 1
    b_array.keyframe_insert("count", frame=6)
    b_array.count = 9
    b_array.keyframe_insert("count", frame=8)
    blurred.render.motion_blur_shutter = 1.0
    blurred.frame_set(FRAME)
    core = export()
    assert "steps" not in core.meshes[core.objects_of("Grows")[0]["mesh"]]
    assert any("Grows: its mesh has other vertices or faces" in text for text in problems())


def test_instances_of_a_moving_collection(blurred, export):
    b_collection = bpy.data.collections.new("Parts")
    b_part = bpy.data.objects.new("Part", build.cube("Part"))
    b_collection.objects.link(b_part)
    for name, x in (("First", 0.0), ("Second", 5.0)):
        b_empty = build.add_object(name, None, (0.0, x, 0.0))
        b_empty.instance_type, b_empty.instance_collection = "COLLECTION", b_collection
        if name == "Second":
            animate(b_empty, "location", (0.0, SPEED * 20), index=0)
    blurred.frame_set(FRAME)
    records = export().objects_of("Part")
    moving = [record for record in records if "steps" in record]
    assert len(records) == 2
    assert len(moving) == 1
    assert steps_of(moving[0]) == pytest.approx([13.5, 14.5])


def test_what_appears_later_is_reported(blurred, export, problems):
    b_object = add_moving()
    for frame, hidden in ((0, True), (7, False)):
        b_object.hide_render = hidden
        b_object.keyframe_insert("hide_render", frame=frame)
    blurred.frame_set(FRAME)
    assert "steps" not in export().objects_of("Ball")[0]
    assert any("Ball: it is not there all the time" in text for text in problems())


def test_what_moves_is_smeared_and_said_so(blurred, rendered, outcome):
    """By the core itself: light of a shining cube, spread over what it crosses."""
    add_moving().data.materials.append(build.surface("ShaderNodeEmission", Strength=1.0))
    blurred.camera.location = (SPEED * FRAME, 0.0, 20.0)
    blurred.render.motion_blur_shutter = 1.0
    blurred.rgp.gather.camera_samples = 64
    blurred.frame_set(FRAME)
    picture = rendered()[:, :, 0]
    middle = picture[picture.shape[0] // 2]
    lit = middle[middle > 0.02]
    assert 0.8 < lit.max() < 1.01
    assert ((lit > 0.05) & (lit < 0.95)).sum() >= 3
    plan = {effect["name"]: effect for effect in outcome().stats["effects"]}
    assert plan["motion_blur"]["computed"]
    assert plan["motion_blur"]["because"] == "'Ball' moves"
    assert plan["motion_blur"]["bytes"] > 0
