"""Places as the camera sees them."""

from typing import TYPE_CHECKING, Any

from ..coordinates import matrix_array
from ..panorama import Panorama, panorama

if TYPE_CHECKING:
    from .compiler import Compiler, Register


def inverse_rows(b_matrix: Any) -> list[list[float]]:
    """The upper three rows of a matrix's inverse."""
    rows: list[list[float]] = matrix_array(b_matrix.inverted_safe())[:3].tolist()
    return rows


def camera_position(c: "Compiler") -> "Register":
    """Position in the camera's space, z forwards."""
    return c.transformed(c.quantity("position"), _camera_rows(c))


def _camera_rows(c: "Compiler") -> list[list[float]]:
    b_camera = c.context.b_depsgraph.scene_eval.camera
    rows = inverse_rows(b_camera.matrix_world.normalized())
    rows[2] = [-x for x in rows[2]]
    return [[*row[:3], 0.0] for row in rows] if c.of_world else rows


def window_position(c: "Compiler") -> "Register | None":
    """Place in the picture, 0 to 1; None where a position does not have one: for directions under a camera whose rays
    are parallel, and for cameras whose picture cannot be told from a direction."""
    b_scene = c.context.b_depsgraph.scene_eval
    b_camera, b_render = b_scene.camera, b_scene.render
    kind = b_camera.data.type
    share = b_render.resolution_percentage / 100.0
    resolution = (int(b_render.resolution_x * share), int(b_render.resolution_y * share))
    aspect = (b_render.pixel_aspect_x, b_render.pixel_aspect_y)
    if kind == "PANO":
        size = (resolution[0] * aspect[0], resolution[1] * aspect[1])
        return _panorama_position(c, panorama(b_camera.data, size))
    if kind not in ("PERSP", "ORTHO") or (c.of_world and kind == "ORTHO"):
        return None
    b_projection = b_camera.calc_matrix_camera(
        c.context.b_depsgraph, x=resolution[0], y=resolution[1], scale_x=aspect[0], scale_y=aspect[1]
    )
    x, y, _, w = matrix_array(b_projection).tolist()
    # The camera looks along -z; places there are asked for with z forwards.
    rows = [[a, b, -z, d] for a, b, z, d in (x, y, w)]
    across = c.transformed(camera_position(c), rows)
    seen = c.vector_math("DIVIDE", across, c.emit("channel", of=across, channel=2))
    return c.vector_math("MULTIPLY_ADD", seen, (0.5, 0.5, 0.0), (0.5, 0.5, 0.0))


def _panorama_position(c: "Compiler", seen: Panorama) -> "Register | None":
    """Place in a panorama without its shift, 0 to 1, as in Cycles; None for lenses with a polynomial."""
    left, right, bottom, top = seen.window
    if left == right or bottom == top:
        return None
    x, y, z = (c.emit("channel", of=camera_position(c), channel=channel) for channel in range(3))
    longitude = c.math("ARCTAN2", x, z)
    kind = seen.projection["kind"]
    if kind in ("equirectangular", "cylindrical"):
        upwards = "ARCTAN2" if kind == "equirectangular" else "DIVIDE"
        place = (longitude, c.math(upwards, y, _length(c, x, z)))
    elif kind == "cubemap_face":
        place = (longitude, c.math("ARCTAN2", y, z))
    elif kind == "fisheye_polynomial":
        return None
    else:
        across = _length(c, x, y)
        distance = c.math("ARCTAN2", across, z)
        if kind == "fisheye_equisolid":
            distance = c.math("MULTIPLY", c.math("SINE", c.math("MULTIPLY", distance, 0.5)), 2.0)
        per_length = c.math("DIVIDE", distance, across)
        place = (c.math("MULTIPLY", x, per_length), c.math("MULTIPLY", y, per_length))
    size = (right - left, top - bottom, 1.0)
    flat = c.emit("combine", x=place[0], y=place[1], z=c.register(0.0))
    return c.vector_math("DIVIDE", c.vector_math("SUBTRACT", flat, (left, bottom, 0.0)), size)


def _length(c: "Compiler", x: "Register", y: "Register") -> "Register":
    return c.math("SQRT", c.math("MULTIPLY_ADD", x, x, c.math("MULTIPLY", y, y)))
