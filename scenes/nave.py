"""A vaulted nave of six bays with side aisles and an apse: daylight in every window, sun through the upper ones.

Both sides are instances of the same pieces: a pier, a bay of the wall, a bay of the aisle, a bay of the vault, a pew.
Each window has an area light that fills its opening from outside; the sun is a distant spot light through each upper
window on the right, so that nearly all it sends comes in.
"""

from __future__ import annotations

import math

import bpy
import numpy as np
from mathutils import Vector

from scenes import common, masonry
from scenes.masonry import Opening
from scenes.shapes import Shape, add_copies, add_shape, box, in_slot, join, lathe, moved

BAYS = 6
BAY = 5.0
"""Length of a bay (m)."""
LENGTH = BAYS * BAY
HALF_NAVE = 4.0
AISLE = (4.9, 8.9)
"""Distance of the arcade's wall and of the aisle's inner and outer wall from the middle (m)."""
WALL = 0.9
ARCADE = 4.6
"""Height of piers and springing of arcade and aisle vaults (m)."""
VAULT = 9.6
"""Springing of the high vault (m)."""
VAULT_RISE, VAULT_DOME = 4.2, 0.35
TOP = 14.6
ARCH = Opening(1.85, ARCADE, ARCADE)
UPPER = Opening(0.85, 8.75, 11.7)
LOWER = Opening(0.75, 2.0, 4.3)
CHANCEL = Opening(3.35, 0.0, 8.0)
APSE_WINDOW = Opening(0.62, 3.2, 7.2)
APSE_RADIUS, APSE_SIDES = 4.1, 5
APSE_VAULT = 8.6
SUN_TRAVEL = Vector((-0.70, 0.40, -0.45)).normalized()
SUN_DISTANCE = 20.0
SUN_POWER = 300e3
SKY = (5.2, 6.0, 7.2)
"""Radiance of the windows (W/sr/m²)."""
CAMERA = (0.0, 1.1, 2.1)
FIELD_OF_VIEW = math.radians(66.0)
SHIFT = 0.16
"""Of the lens upwards, which keeps upright lines upright (parts of the picture's width)."""
EXPOSURE = 0.0
"""Stops, in the view transform alone."""
SIDEWAYS = -0.5 * math.pi
"""Turns a wall that was made facing the camera into the right wall of the nave (rad)."""
Materials = dict[str, bpy.types.Material]


def make_materials() -> Materials:
    """Lime-washed webs, two tones of limestone, polished paving, wood, iron and cloth."""
    plain = common.diffuse_material
    paving = {
        "Slab light": (0.52, 0.46, 0.37),
        "Slab dark": (0.27, 0.235, 0.20),
        "Slab worn": (0.43, 0.37, 0.29),
    }
    shiny = {
        name: common.principled_material(name, Base_Color=color, Roughness=0.5)
        for name, color in paving.items()
    }
    return shiny | {
        "Stone": plain("Stone", (0.60, 0.54, 0.44)),
        "Band": plain("Band", (0.50, 0.39, 0.29)),
        "Wash": plain("Wash", (0.72, 0.68, 0.59)),
        "Oak": plain("Oak", (0.23, 0.13, 0.07)),
        "Iron": plain("Iron", (0.06, 0.06, 0.065)),
        "Gilt": common.principled_material(
            "Gilt", Base_Color=(0.86, 0.63, 0.27), Metallic=1.0, Roughness=0.5
        ),
        "Cloth": plain("Cloth", (0.45, 0.06, 0.05)),
        "Linen": plain("Linen", (0.76, 0.73, 0.66)),
    }


def along_nave(original: bpy.types.Object, places: list[tuple[float, float]]) -> None:
    """Puts the original and its copies at every y, as made for the right side (turn 0) or turned to the left (pi)."""
    (first, turn), *others = places
    original.location, original.rotation_euler = (0.0, first, 0.0), (0.0, 0.0, turn)
    add_copies(original, [((0.0, y, 0.0), turn) for y, turn in others])


def both_sides(ys: list[float]) -> list[tuple[float, float]]:
    """Every y once for the right side and once for the left."""
    return [(y, turn) for turn in (0.0, math.pi) for y in ys]


def string_course(x: float, z: float) -> Shape:
    """A molding along a bay on the wall that faces -x at `x`."""
    section = [(-0.02, 0.0), (0.05, 0.02), (0.12, 0.1), (0.12, 0.15), (-0.02, 0.2)]
    rows = [[(x - out, side * 0.5 * BAY, z + up) for side in (1, -1)] for out, up in section]
    return masonry.surface(np.array(rows))


def wall_bay() -> Shape:
    """One bay of the right nave wall: arcade arch, two string courses, upper window; slot 2 is iron and tracery."""
    arcade = masonry.pierced_wall(BAY, ARCADE, 7.6, ARCH, ARCH, WALL, 10)
    upper = masonry.pierced_wall(BAY, 7.6, TOP, UPPER.widened(0.25), UPPER, WALL, 10)
    lights = masonry.tracery(UPPER.widened(0.09), 0.62)
    orders = [masonry.archivolt(ARCH, 0.0)]
    # The same stones on the aisle's side of the arch.
    orders.append(moved(orders[0], (0.0, WALL, 0.0), math.pi))
    hood = masonry.archivolt(Opening(UPPER.half + 0.25, UPPER.spring, UPPER.spring), 0.0, 10)
    bay = join([arcade, upper, *orders, in_slot(hood, 0), in_slot(lights, 2)])
    bay = moved(bay, (HALF_NAVE, 0.0, 0.0), SIDEWAYS)
    courses = [in_slot(string_course(HALF_NAVE, z), 1) for z in (7.5, 8.1)]
    return join([bay, *courses])


def aisle_bay() -> Shape:
    """One bay of the right aisle: outer wall with a window, responds, vault; slot 1 bands, 2 tracery, 3 webs."""
    low, high = AISLE
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    outer = masonry.pierced_wall(BAY, -0.1, 7.6, LOWER.widened(0.3), LOWER, WALL, 10)
    lights = masonry.tracery(LOWER.widened(0.1), 0.6, 0.05)
    wall = moved(join([outer, in_slot(lights, 2)]), (high, 0.0, 0.0), SIDEWAYS)
    sill = in_slot(string_course(high, 1.45), 1)
    respond = moved(masonry.shaft(0.2, 0.0, ARCADE, 12), (high - 0.04, 0.5 * BAY, 0.0))
    rise, dome, across = 2.2, 0.2, 0.5 * BAY
    webs = in_slot(masonry.vault(half, across, rise, dome, 7), 3)
    ribs = [
        masonry.vault_rib(half, across, rise, dome, ends, 7, 0.9)
        for ends in ((-1, -1, 1, 1), (-1, 1, 1, -1), (1, -1, 1, 1), (-1, -1, -1, 1))
    ]
    main = masonry.vault_rib(half, across, rise, dome, (-1, 1, 1, 1), 10, 1.7)
    ribs.append(masonry.banded(main, 6, 2))
    stone = moved(masonry.boss(0.22), (0.0, 0.0, rise + dome))
    vault = moved(join([webs, *ribs, stone]), (middle, 0.0, ARCADE))
    return join([wall, sill, respond, vault])


def high_vault_bay() -> Shape:
    """One bay of the high vault with its ribs and, on both sides, the shafts that carry it; slot 1 bands, 3 webs."""
    half, across = HALF_NAVE, 0.5 * BAY
    webs = in_slot(masonry.vault(half, across, VAULT_RISE, VAULT_DOME, 12), 3)
    ribs = [
        masonry.vault_rib(half, across, VAULT_RISE, VAULT_DOME, ends, 14, 1.2)
        for ends in ((-1, -1, 1, 1), (-1, 1, 1, -1))
    ]
    ribs += [
        masonry.vault_rib(half, across, VAULT_RISE, VAULT_DOME, (sign, -1, sign, 1), 10, 0.9)
        for sign in (-1, 1)
    ]
    main = masonry.vault_rib(half, across, VAULT_RISE, VAULT_DOME, (-1, 1, 1, 1), 16, 2.4)
    ribs.append(masonry.banded(main, 6, 2))
    stone = moved(masonry.boss(0.4), (0.0, 0.0, VAULT_RISE + VAULT_DOME))
    parts = [moved(join([webs, *ribs, stone]), (0.0, 0.0, VAULT))]
    for sign in (-1.0, 1.0):
        parts.append(moved(masonry.shaft(0.17, ARCADE, VAULT, 12), (sign * (HALF_NAVE - 0.03), across, 0.0)))
        for beside in (-0.26, 0.26):
            small = masonry.shaft(0.09, ARCADE, VAULT, 8)
            parts.append(moved(small, (sign * (HALF_NAVE - 0.02), across + beside, 0.0)))
    return join(parts)


def apse() -> Shape:
    """Chancel arch, a polygonal apse with a window in each side, its dome and ribs; slot 1 bands, 2 tracery, 3 webs."""
    width = 2.0 * HALF_NAVE + 2.0
    arch = masonry.pierced_wall(width, 0.0, TOP, CHANCEL, CHANCEL, WALL, 20)
    stones = masonry.archivolt(Opening(CHANCEL.half, CHANCEL.spring, CHANCEL.spring), 0.0, 24)
    parts = [moved(join([arch, stones]), (0.0, LENGTH, 0.0))]
    start = LENGTH + WALL
    corners = []
    for number in range(APSE_SIDES + 1):
        angle = math.pi * number / APSE_SIDES
        corners.append((APSE_RADIUS * math.cos(angle), APSE_RADIUS * math.sin(angle)))
    side = 2.0 * APSE_RADIUS * math.sin(0.5 * math.pi / APSE_SIDES)
    distance = APSE_RADIUS * math.cos(0.5 * math.pi / APSE_SIDES)
    panel = masonry.pierced_wall(
        side, -0.1, APSE_VAULT + 0.02, APSE_WINDOW.widened(0.2), APSE_WINDOW, 0.7, 10
    )
    panel = join([panel, in_slot(masonry.tracery(APSE_WINDOW.widened(0.06), 0.45, 0.045), 2)])
    rise = 3.6
    for number in range(APSE_SIDES):
        middle = math.pi * (number + 0.5) / APSE_SIDES
        parts.append(moved(moved(panel, (0.0, distance, 0.0)), (0.0, start, 0.0), middle - 0.5 * math.pi))
        web = masonry.cloister_web(corners[number], corners[number + 1], rise)
        parts.append(in_slot(moved(web, (0.0, start, APSE_VAULT)), 3))
    for x, y in corners:
        parts.append(moved(masonry.apse_rib((0.98 * x, 0.98 * y), rise), (0.0, start, APSE_VAULT)))
        parts.append(moved(masonry.shaft(0.11, 0.4, APSE_VAULT, 12), (0.97 * x, start + 0.97 * y, 0.0)))
    parts.append(moved(masonry.boss(0.35), (0.0, start, APSE_VAULT + rise)))
    return join(parts)


def end_walls() -> Shape:
    """The west wall behind the camera and the walls in which the aisles end."""
    low, high = AISLE[0] - 0.2, AISLE[1] + WALL
    parts = [box((-high, -WALL, -0.1), (high, 0.0, TOP))]
    for x0, x1 in ((low, high), (-high, -low)):
        parts.append(box((x0, LENGTH, -0.1), (x1, LENGTH + WALL, 7.6)))
    return join(parts)


def paving() -> Shape:
    """The floor of nave and aisles, three steps up to the apse and its floor."""
    edge = AISLE[1] + 0.05
    start = LENGTH - 1.2
    parts = [masonry.slabs((-edge, -0.05), (edge, LENGTH + 0.05), 0.0, 0.62, 1)]
    for number in range(3):
        low = start + 0.4 * number
        parts.append(
            in_slot(box((-3.35, low, -0.05), (3.35, LENGTH + 6.0, 0.15 * (number + 1)), 0.01), number % 2)
        )
    return join(parts)


def altar() -> Shape:
    """An altar with its cloth, a cross and six candlesticks; slot 0 stone, 1 cloth, 2 linen, 3 gilt."""
    y, floor = LENGTH + WALL + 1.3, 0.449
    table = box((-1.1, y - 0.45, floor), (1.1, y + 0.45, floor + 1.0), 0.03)
    cloth = box((-0.95, y - 0.47, floor + 0.25), (0.95, y - 0.455, floor + 1.0), 0.004)
    linen = box((-1.25, y - 0.52, floor + 1.001), (1.25, y + 0.52, floor + 1.03), 0.008)
    parts = [table, in_slot(cloth, 1), in_slot(linen, 2)]
    top = floor + 1.031
    profile = [
        (0.0, 0.0),
        (0.1, 0.0),
        (0.1, 0.02),
        (0.03, 0.06),
        (0.02, 0.2),
        (0.035, 0.24),
        (0.018, 0.28),
        (0.015, 0.5),
    ]
    profile += [(0.05, 0.54), (0.05, 0.56), (0.0, 0.56)]
    for number in range(6):
        x = (number - 2.5) * 0.34 + (0.12 if number > 2 else -0.12)
        candle = [(0.0, 0.55), (0.02, 0.55), (0.018, 0.95), (0.0, 0.96)]
        parts.append(in_slot(moved(lathe(profile, 16), (x, y + 0.2, top)), 3))
        parts.append(in_slot(moved(lathe(candle, 12), (x, y + 0.2, top)), 2))
    cross = [
        box((-0.16, -0.1, 0.0), (0.16, 0.1, 0.12), 0.02),
        box((-0.035, -0.03, 0.11), (0.035, 0.03, 1.35), 0.01),
    ]
    cross.append(box((-0.32, -0.028, 0.88), (0.32, 0.028, 0.95), 0.01))
    parts += [in_slot(moved(part, (0.0, y + 0.2, top)), 3) for part in cross]
    return join(parts)


def add_window_light(
    name: str, opening: Opening, place: tuple[float, float], facing: float, strength: float
) -> None:
    """An area light that fills an opening from outside: its (x, y), and where its light goes as an angle from +x."""
    height = opening.spring + masonry.RISE * opening.half - opening.sill
    radiance = tuple(strength * channel for channel in SKY)
    middle = (*place, opening.sill + 0.5 * height)
    # Turned upright it shines along +y; its own y is then the world's z.
    turn = (0.5 * math.pi, 0.0, facing - 0.5 * math.pi)
    lamp = common.add_area_lamp(name, (2.0 * opening.half, height), radiance, middle, turn)
    lamp.visible_camera = True


def add_sun(x: float, y: float, z: float) -> None:
    """A distant spot light whose cone just covers an upper window around a point."""
    light = bpy.data.lights.new("Sun", "SPOT")
    light.color, light.energy = (1.0, 0.86, 0.66), SUN_POWER
    light.shadow_soft_size = 0.12
    light.spot_size, light.spot_blend = 2.0 * math.atan(2.6 / SUN_DISTANCE), 0.0
    lamp = common.add_object("Sun", light)
    lamp.location = Vector((x, y, z)) - SUN_DISTANCE * SUN_TRAVEL
    lamp.rotation_euler = SUN_TRAVEL.to_track_quat("-Z", "Y").to_euler()


def build_light() -> None:
    """Sky in every window, sun in the upper ones on the right."""
    upper, lower = HALF_NAVE + WALL + 0.01, AISLE[1] + WALL + 0.01
    for number in range(BAYS):
        y = (number + 0.5) * BAY
        for sign, facing in ((1.0, math.pi), (-1.0, 0.0)):
            add_window_light("Upper window", UPPER, (sign * upper, y), facing, 1.0)
            add_window_light("Lower window", LOWER, (sign * lower, y), facing, 0.7)
        add_sun(HALF_NAVE + 0.5 * WALL, y, 0.5 * (UPPER.sill + UPPER.spring) + 0.5)
    out = APSE_RADIUS * math.cos(0.5 * math.pi / APSE_SIDES) + 0.71
    for number in range(APSE_SIDES):
        angle = math.pi * (number + 0.5) / APSE_SIDES
        place = (out * math.cos(angle), LENGTH + WALL + out * math.sin(angle))
        add_window_light("Apse window", APSE_WINDOW, place, angle + math.pi, 1.2)


def build() -> None:
    """The nave, 640 by 480."""
    common.start_empty_file()
    stuff = make_materials()
    stone, band, wash = stuff["Stone"], stuff["Band"], stuff["Wash"]
    middles = [(number + 0.5) * BAY for number in range(BAYS)]
    masonry_slots = [stone, band, stone, wash]
    along_nave(add_shape("Wall bay", wall_bay(), masonry_slots), both_sides(middles))
    along_nave(add_shape("Aisle bay", aisle_bay(), masonry_slots), both_sides(middles))
    along_nave(add_shape("High vault", high_vault_bay(), masonry_slots), [(y, 0.0) for y in middles])
    pier = moved(masonry.pier(ARCADE), (HALF_NAVE + 0.5 * WALL, 0.0, 0.0))
    along_nave(add_shape("Pier", pier, [stone]), both_sides([number * BAY for number in range(BAYS + 1)]))
    add_shape("Apse", apse(), masonry_slots)
    add_shape("End walls", end_walls(), [stone])
    add_shape("Paving", paving(), [stuff["Slab light"], stuff["Slab dark"], stuff["Slab worn"]])
    add_shape("Altar", altar(), [stone, stuff["Cloth"], stuff["Linen"], stuff["Gilt"]])
    pews = moved(masonry.pew(2.3), (2.15, 0.0, 0.0))
    rows = [5.2 + 1.05 * number for number in range(18)]
    right = add_shape("Pew", pews, [stuff["Oak"]])
    right.location = (0.0, rows[0], 0.0)
    add_copies(right, [((x, y, 0.0), 0.0) for x in (0.0, -4.3) for y in rows if (x, y) != (0.0, rows[0])])
    build_light()
    camera = common.add_camera(CAMERA, (0.5 * math.pi, 0.0, 0.0), FIELD_OF_VIEW, (640, 480))
    camera.data.shift_y = SHIFT
    bpy.context.scene.view_settings.exposure = EXPOSURE
