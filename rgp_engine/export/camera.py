"""Blender's camera and render border."""

from typing import Any

import numpy as np

from ..report import UserError
from .context import ExportContext
from .coordinates import matrix_array
from .panorama import panorama


def camera_record(context: ExportContext) -> dict[str, Any]:
    """The active camera as the core's CameraRecord, less `region`. Raises UserError without camera."""
    engine = context.engine
    b_object = _camera(context)
    b_camera = b_object.data
    matrix, window = camera_view(context)
    _report_problems(b_object.name, b_camera, window, context)
    return {
        "name": b_object.name,
        "projection": _projection(b_camera, _frame_size(context)),
        "world_from_camera": matrix,
        "window": window,
        "resolution": [engine.resolution_x, engine.resolution_y],
        "clip": [b_camera.clip_start, b_camera.clip_end],
        "lens": camera_lens(b_object) if b_camera.dof.use_dof else None,
    }


def _camera(context: ExportContext) -> Any:
    """The active camera. Raises UserError without one."""
    b_object = context.engine.camera_override or context.b_depsgraph.scene_eval.camera
    if b_object is None or b_object.type != "CAMERA":
        raise UserError(
            "There is no camera. Add one (Add > Camera) and make it the active camera of the scene"
        )
    return b_object


def camera_view(context: ExportContext) -> tuple[list[list[float]], list[float]]:
    """Where the active camera is, and its window: `world_from_camera` and `window` of the core's CameraRecord."""
    engine = context.engine
    b_object = _camera(context)
    shift = (engine.camera_shift_x(b_object), b_object.data.shift_y)
    matrix = matrix_array(engine.camera_model_matrix(b_object)).tolist()
    return matrix, camera_window(b_object.data, _frame_size(context), shift)


def _frame_size(context: ExportContext) -> tuple[float, float]:
    """Width and height of the full frame, in square pixels."""
    engine, b_render = context.engine, context.b_depsgraph.scene_eval.render
    width, height = (
        engine.resolution_x * b_render.pixel_aspect_x,
        engine.resolution_y * b_render.pixel_aspect_y,
    )
    return width, height


def _projection(b_camera: Any, size: tuple[float, float]) -> dict[str, Any]:
    """The core's Projection."""
    if b_camera.type == "PANO":
        return panorama(b_camera, size).projection
    return {"kind": "orthographic" if b_camera.type == "ORTHO" else "perspective"}


def camera_lens(b_object: Any) -> dict[str, Any]:
    """The core's LensRecord of a camera whose depth of field is on. The f-stop is taken as Cycles does: a camera with
    parallel rays has an aperture as if its focal length were a metre."""
    b_camera = b_object.data
    b_dof = b_camera.dof
    focal_length = 1.0 if b_camera.type == "ORTHO" else b_camera.lens * 1e-3
    return {
        "radius": focal_length / (2.0 * max(b_dof.aperture_fstop, 1e-5)),
        "blades": b_dof.aperture_blades,
        "rotation": b_dof.aperture_rotation,
        "ratio": b_dof.aperture_ratio,
        "focus_distance": max(_focus_distance(b_object), 1e-5),
    }


def _focus_distance(b_object: Any) -> float:
    """Depth of the plane of focus (m): of the object in focus, or of its bone, along the view axis."""
    b_dof = b_object.data.dof
    b_focus = b_dof.focus_object
    if b_focus is None:
        return float(b_dof.focus_distance)
    place = b_focus.matrix_world
    if b_focus.type == "ARMATURE" and b_dof.focus_subtarget in b_focus.pose.bones:
        place = place @ b_focus.pose.bones[b_dof.focus_subtarget].matrix
    axis = b_object.matrix_world.to_3x3().normalized().col[2]
    return float(abs(axis.dot(b_object.matrix_world.translation - place.translation)))


def camera_window(b_camera: Any, size: tuple[float, float], shift: tuple[float, float]) -> list[float]:
    """Left, right, bottom and top of the full frame, at distance 1 (perspective), in metres (orthographic), or in the
    unit of its panorama.

    The sensor spans the longer side of the frame, or the side that sensor fit names; shifts are fractions of that side,
    and of both sides of a panorama.
    """
    if b_camera.type == "PANO":
        left, right, bottom, top = panorama(b_camera, size).window
        shift_x, shift_y = shift[0] * (right - left), shift[1] * (top - bottom)
        return [left + shift_x, right + shift_x, bottom + shift_y, top + shift_y]
    width, height = size
    fit = b_camera.sensor_fit
    spans_width = width >= height if fit == "AUTO" else fit == "HORIZONTAL"
    if b_camera.type == "ORTHO":
        span = b_camera.ortho_scale
    else:
        sensor = b_camera.sensor_height if fit == "VERTICAL" else b_camera.sensor_width
        span = sensor / b_camera.lens
    pixel = span / (width if spans_width else height)
    half_width, half_height = 0.5 * width * pixel, 0.5 * height * pixel
    shift_x, shift_y = shift[0] * span, shift[1] * span
    return [
        shift_x - half_width,
        shift_x + half_width,
        shift_y - half_height,
        shift_y + half_height,
    ]


def render_region(
    resolution: list[int], border: tuple[float, float] | None, size: tuple[int, int]
) -> list[int]:
    """Rendered part of the frame in pixels: x, y (from the bottom left), width, height.

    The size is the render result's, which Blender has worked out; the corner is rounded as Blender does, in single
    precision.
    """
    if border is None:
        return [0, 0, *size]
    x, y = (int(np.float32(part) * np.float32(full)) for part, full in zip(border, resolution))
    return [min(x, resolution[0] - size[0]), min(y, resolution[1] - size[1]), *size]


def _report_problems(name: str, b_camera: Any, window: list[float], context: ExportContext) -> None:
    if b_camera.type not in ("PERSP", "ORTHO", "PANO"):
        kind = b_camera.bl_rna.properties["type"].enum_items[b_camera.type].name
        context.log.add(name, f"a {kind.lower()} camera is not supported yet; a perspective view is rendered")
    left, right, bottom, top = window
    if b_camera.type == "PANO" and (left > right or bottom > top):
        context.log.add(name, "its panorama goes from a larger Min to a smaller Max; the picture is mirrored")
