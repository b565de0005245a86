"""Places as the camera sees them."""

from typing import TYPE_CHECKING, Any

from ..coordinates import matrix_array

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
    """Place in the picture, 0 to 1; None where a position does not have one: for cameras that see all around, and for
    directions under a camera whose rays are parallel."""
    b_scene = c.context.b_depsgraph.scene_eval
    b_camera, b_render = b_scene.camera, b_scene.render
    kind = b_camera.data.type
    if kind not in ("PERSP", "ORTHO") or (c.of_world and kind == "ORTHO"):
        return None
    share = b_render.resolution_percentage / 100.0
    b_projection = b_camera.calc_matrix_camera(
        c.context.b_depsgraph,
        x=int(b_render.resolution_x * share),
        y=int(b_render.resolution_y * share),
        scale_x=b_render.pixel_aspect_x,
        scale_y=b_render.pixel_aspect_y,
    )
    x, y, _, w = matrix_array(b_projection).tolist()
    # The camera looks along -z; places there are asked for with z forwards.
    rows = [[a, b, -z, d] for a, b, z, d in (x, y, w)]
    across = c.transformed(camera_position(c), rows)
    seen = c.vector_math("DIVIDE", across, c.emit("channel", of=across, channel=2))
    return c.vector_math("MULTIPLY_ADD", seen, (0.5, 0.5, 0.0), (0.5, 0.5, 0.0))
