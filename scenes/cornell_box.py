"""The Cornell box as measured at Cornell University, one Blender metre for 100 of its millimetres.

Thirty triangles: five walls and the five upper faces of two blocks. Corners are the published ones
(graphics.cornell.edu/online/box/data.html), slant of the walls included. Reflectances and the lamp's radiance are the
usual linear RGB values of the published spectra. The lamp is a Blender area light in the published opening.
"""

from __future__ import annotations

import math

import bpy

from scenes import common

MILLIMETRES = 0.01
WHITE = (0.725, 0.71, 0.68)
GREEN = (0.14, 0.45, 0.091)
RED = (0.63, 0.065, 0.05)
LAMP_RADIANCE = (17.0, 12.0, 4.0)

FLOOR = [(552.8, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 559.2), (549.6, 0.0, 559.2)]
CEILING = [(556.0, 548.8, 0.0), (556.0, 548.8, 559.2), (0.0, 548.8, 559.2), (0.0, 548.8, 0.0)]
BACK_WALL = [(549.6, 0.0, 559.2), (0.0, 0.0, 559.2), (0.0, 548.8, 559.2), (556.0, 548.8, 559.2)]
RIGHT_WALL = [(0.0, 0.0, 559.2), (0.0, 0.0, 0.0), (0.0, 548.8, 0.0), (0.0, 548.8, 559.2)]
LEFT_WALL = [(552.8, 0.0, 0.0), (549.6, 0.0, 559.2), (556.0, 548.8, 559.2), (556.0, 548.8, 0.0)]
SHORT_BLOCK_TOP = [(130.0, 165.0, 65.0), (82.0, 165.0, 225.0), (240.0, 165.0, 272.0), (290.0, 165.0, 114.0)]
TALL_BLOCK_TOP = [(423.0, 330.0, 247.0), (265.0, 330.0, 296.0), (314.0, 330.0, 456.0), (472.0, 330.0, 406.0)]
LAMP = [(343.0, 548.8, 227.0), (343.0, 548.8, 332.0), (213.0, 548.8, 332.0), (213.0, 548.8, 227.0)]
LAMP_DROP = 0.1
"""Millimetres between ceiling and lamp, so that they do not lie in one plane."""
CAMERA = (278.0, 273.0, -800.0)
FIELD_OF_VIEW = 2.0 * math.atan(0.025 / 2.0 / 0.035)
"""Of the published camera: a square of 25 mm behind a lens of 35 mm."""
EXPOSURE = 1.0
"""Stops, in the view transform alone: white walls come out as bright as in photographs of the box."""
CENTER = 278.0
"""The camera's x, which becomes Blender's x = 0."""


def to_blender(point: common.Point) -> common.Point:
    """Published millimetres (x left, y up, z away from the camera) to Blender's metres (x right, y away, z up)."""
    x, y, z = point
    return ((CENTER - x) * MILLIMETRES, z * MILLIMETRES, y * MILLIMETRES)


def block_faces(top: list[common.Point]) -> list[list[common.Point]]:
    """The top of a block and its four sides down to the floor; it has no bottom."""
    sides = []
    for i, (x, y, z) in enumerate(top):
        next_x, _, next_z = top[(i + 1) % 4]
        sides.append([(x, y, z), (x, 0.0, z), (next_x, 0.0, next_z), (next_x, y, next_z)])
    return [top, *sides]


def add_faces(name: str, faces: list[list[common.Point]], material: bpy.types.Material) -> None:
    """One object of published polygons."""
    common.add_polygons(name, [[to_blender(corner) for corner in face] for face in faces], [material])


def build_room(
    short_block: bpy.types.Material, tall_block: bpy.types.Material, white: bpy.types.Material
) -> None:
    """Walls, blocks, lamp and camera; the materials of the blocks are the caller's."""
    add_faces("Floor", [FLOOR], white)
    add_faces("Ceiling", [CEILING], white)
    add_faces("Back wall", [BACK_WALL], white)
    add_faces("Right wall", [RIGHT_WALL], common.diffuse_material("Green", GREEN))
    add_faces("Left wall", [LEFT_WALL], common.diffuse_material("Red", RED))
    add_faces("Short block", block_faces(SHORT_BLOCK_TOP), short_block)
    add_faces("Tall block", block_faces(TALL_BLOCK_TOP), tall_block)
    corners = [to_blender(corner) for corner in LAMP]
    (x0, y0, z), (x1, y1, _) = corners[0], corners[2]
    lamp = common.add_area_lamp(
        "Lamp",
        (abs(x1 - x0), abs(y1 - y0)),
        LAMP_RADIANCE,
        ((x0 + x1) / 2.0, (y0 + y1) / 2.0, z - LAMP_DROP * MILLIMETRES),
    )
    lamp.visible_camera = True
    common.add_camera(to_blender(CAMERA), (math.pi / 2.0, 0.0, 0.0), FIELD_OF_VIEW, (512, 512))
    bpy.context.scene.view_settings.exposure = EXPOSURE


def build() -> None:
    """The Cornell box, all surfaces Lambertian."""
    common.start_empty_file()
    white = common.diffuse_material("White", WHITE)
    build_room(white, white, white)
