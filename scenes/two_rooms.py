"""A dark room beside a lit one, a thin wall between them: whatever is seen in the dark room has leaked.

Both rooms are open towards the camera and nothing stands outside, so no path of any length joins them: the dark room is
exactly black. Floor, ceiling and back wall run on behind the dividing wall, and the house is turned against the grid of
the pyramid, so that cells meet the wall at every offset.
"""

from __future__ import annotations

import math

from mathutils import Matrix, Vector

from scenes import common

ROOM = 3.0
"""Inner width, depth and height of either room (m)."""
ONE_CELL = 2.0 * ROOM / 128.0
"""About a finest cell when the longest side of the scene has 128 of them (m)."""
TURN = math.radians(17.0)
"""Angle between the house and the world's axes (rad)."""
GREY = (0.7, 0.7, 0.7)


def build(wall_thickness: float = ONE_CELL) -> None:
    """The dark room is on the left, the lit one on the right; the dividing wall's thickness is in metres."""
    common.start_empty_file()
    half = wall_thickness / 2.0
    width = ROOM + half
    left, right, _open_front, back, floor, ceiling = common.box_faces((-width, 0.0, 0.0), (width, ROOM, ROOM))
    grey = common.diffuse_material("Grey", GREY)
    wall = common.box_faces((-half, 0.0, 0.0), (half, ROOM, ROOM))[:3]
    common.add_polygons("House", [left, right, back, floor, ceiling], [grey])
    common.add_polygons("Dividing wall", wall, [grey])
    common.add_area_lamp("Lamp", (1.0, 1.0), (8.0, 8.0, 8.0), (half + ROOM / 2.0, ROOM / 2.0, ROOM - 0.01))
    distance = 6.5
    field_of_view = 2.0 * math.atan(1.04 * width / distance)
    camera = common.add_camera(
        (0.0, -distance, ROOM / 2.0), (math.pi / 2.0, 0.0, 0.0), field_of_view, (512, 256)
    )
    turn = Matrix.Rotation(TURN, 4, Vector((0.0, 0.0, 1.0)))
    for thing in camera.users_collection[0].objects:
        thing.matrix_world = turn @ thing.matrix_basis


def known_answer(wall_thickness: float = ONE_CELL) -> dict[str, object]:
    """Radiance of the dark room, and where the rooms lie in the picture: left, bottom, right, top in parts of the
    frame, one part in fifty away from the dividing wall and the openings."""
    return {
        "wall_thickness": wall_thickness,
        "dark_room_radiance": 0.0,
        "dark_room": [0.05, 0.05, 0.48, 0.95],
        "lit_room": [0.52, 0.05, 0.95, 0.95],
    }
