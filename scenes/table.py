"""A laid table in a dining room: daylight from a window on the left, a warm lamp in an opaque shade above the table.

Both lamps are area lights: one fills the window's opening from outside, two sit in the shade, one shining down and one
up. Most of the room is lit by what floor, walls, ceiling and table top send on. Glaze and varnish are sharp lobes (GGX
alpha below 0.25), the cutlery and the brass are wide ones.
"""

from __future__ import annotations

import math

import bpy
from mathutils import Vector

from scenes import common, furniture, tableware
from scenes.shapes import Shape, add_copies, add_shape, box, in_slot, join, moved, tube, turned

TOP = furniture.TABLE[2] + 0.0004
"""Height on which things on the table stand, a hair above it (m)."""
DAYLIGHT = (12.0, 13.6, 16.0)
LAMPLIGHT = (46.0, 29.5, 14.5)
"""Radiance of the window and of the lamp (W/sr/m²)."""
LAMP_PLACE = (0.0, 0.0, 1.62)
"""Middle of the shade's lower rim (m)."""
EXPOSURE = 0.4
"""Stops, in the view transform alone."""
CAMERA = (1.42, -2.1, 1.53)
LOOK_AT = (-0.11, 0.06, 0.88)
FIELD_OF_VIEW = math.radians(48.0)
SETTINGS = [(-0.5, -0.33, 0.0), (0.42, -0.33, 0.0), (-0.46, 0.33, math.pi), (0.46, 0.33, math.pi)]
"""Middle x, y of each plate, and the turn of the guest who sits before it (rad)."""


def plain(name: str, color: common.Color) -> bpy.types.Material:
    """A matt surface."""
    return common.diffuse_material(name, color)


def shiny(name: str, color: common.Color, roughness: float) -> bpy.types.Material:
    """Glaze, varnish or polish: a diffuse ground under a reflection."""
    return common.principled_material(name, Base_Color=color, Roughness=roughness)


def metal(name: str, color: common.Color, roughness: float) -> bpy.types.Material:
    """Brushed metal."""
    return common.principled_material(name, Base_Color=color, Metallic=1.0, Roughness=roughness)


def build_room() -> None:
    """Walls, floor, window and curtains."""
    plaster = plain("Plaster", (0.79, 0.75, 0.67))
    white = plain("White paint", (0.80, 0.79, 0.76))
    sage = plain("Sage paint", (0.34, 0.40, 0.33))
    oak = [plain(f"Oak {tone}", (0.42 * tone, 0.27 * tone, 0.15 * tone)) for tone in (0.82, 0.95, 1.08)]
    add_shape("Walls", furniture.walls(), [plaster, white, sage])
    add_shape("Moldings", furniture.moldings(), [sage])
    add_shape("Panels", furniture.panels(), [sage])
    add_shape("Floor", furniture.floor(), oak)
    add_shape("Window", furniture.window(), [white])
    low, high = furniture.WINDOW[0], furniture.WINDOW[1]
    linen = plain("Curtain linen", (0.70, 0.62, 0.50))
    x = furniture.ROOM[0] + 0.12
    for number, y in enumerate((low - 0.2, high + 0.2)):
        hanging = moved(furniture.curtain(0.46, 6, 1.3 + 2.1 * number), (x, y, 2.45))
        add_shape("Curtain", hanging, [linen])
    rod = moved(furniture.curtain_rod(high - low + 1.1), (x, 0.5 * (low + high), 2.47))
    add_shape("Curtain rod", rod, [metal("Brass", (0.78, 0.58, 0.28), 0.52)])


def build_furniture() -> None:
    """Table, chairs, the sideboard with what stands on it, and a picture."""
    walnut = common.principled_material(
        "Varnished walnut",
        Base_Color=(0.24, 0.125, 0.06),
        Roughness=0.55,
        Coat_Weight=0.6,
        Coat_Roughness=0.3,
    )
    dark_wood = plain("Dark wood", (0.16, 0.085, 0.045))
    add_shape("Table", furniture.table(), [walnut, dark_wood])
    chair = add_shape("Chair", furniture.chair(), [dark_wood, plain("Seat", (0.22, 0.12, 0.065))])
    chair.location, chair.rotation_euler = (-0.5, 0.72, 0.0), (0.0, 0.0, 0.05)
    places = [
        ((0.48, 0.76, 0.0), -0.10),
        ((-0.55, -0.80, 0.0), math.pi + 0.12),
        ((-1.42, 0.02, 0.0), 0.5 * math.pi),
    ]
    add_copies(chair, places)
    board = moved(furniture.sideboard(), (0.35, furniture.ROOM[3] - 0.035, 0.0))
    brass = bpy.data.materials["Brass"]
    add_shape("Sideboard", board, [plain("Painted wood", (0.13, 0.17, 0.19)), brass])
    bands = [(0.20, 0.22, 0.10), (0.42, 0.36, 0.16), (0.22, 0.30, 0.33), (0.66, 0.64, 0.55)]
    colors = [plain(f"Landscape {number}", color) for number, color in enumerate(bands)]
    frame = moved(furniture.picture(1.0, 0.74), (0.35, furniture.ROOM[3] - 0.001, 1.62))
    add_shape(
        "Picture",
        frame,
        [shiny("Gilt", (0.45, 0.30, 0.12), 0.5), plain("Mount", (0.78, 0.76, 0.70)), *colors],
    )


def build_lamp() -> None:
    """The shade over the table and the three lamps of the scene."""
    x, y, z = LAMP_PLACE
    enamel = shiny("Green enamel", (0.035, 0.11, 0.085), 0.3)
    add_shape(
        "Shade", moved(furniture.lampshade(), LAMP_PLACE), [enamel, plain("White enamel", (0.84, 0.82, 0.77))]
    )
    fitting = moved(furniture.lamp_fitting(furniture.HEIGHT - z), LAMP_PLACE)
    add_shape("Lamp fitting", fitting, [bpy.data.materials["Brass"]])
    common.add_area_lamp("Lamp down", (0.28, 0.28), LAMPLIGHT, (x, y, z + 0.065))
    up = tuple(1.6 * channel for channel in LAMPLIGHT)
    common.add_area_lamp("Lamp up", (0.08, 0.08), up, (x, y, z + 0.212), (math.pi, 0.0, 0.0))
    low_y, high_y, low_z, high_z = furniture.WINDOW
    middle = (furniture.ROOM[0] - furniture.WALL - 0.01, 0.5 * (low_y + high_y), 0.5 * (low_z + high_z))
    sky = common.add_area_lamp(
        "Window light", (high_z - low_z, high_y - low_y), DAYLIGHT, middle, (0.0, -0.5 * math.pi, 0.0)
    )
    sky.visible_camera = True


def lay_table() -> None:
    """Four places: plate, bowl, napkin, cutlery and cup."""
    glaze = shiny("White glaze", (0.76, 0.73, 0.66), 0.18)
    blue = shiny("Blue glaze", (0.07, 0.17, 0.30), 0.2)
    steel = metal("Steel", (0.74, 0.73, 0.71), 0.5)
    linen = plain("Napkin linen", (0.55, 0.22, 0.15))
    forms: list[tuple[str, Shape, bpy.types.Material, common.Point, float]] = [
        ("Plate", tableware.turned_ware(tableware.PLATE, 32), glaze, (0.0, 0.0, 0.0), 0.0),
        ("Bowl", tableware.turned_ware(tableware.BOWL, 24), blue, (0.0, 0.0, 0.0085), 0.0),
        ("Cup", tableware.cup(), glaze, (0.155, 0.165, 0.0), -0.7),
        ("Napkin", tableware.napkin(), linen, (-0.215, -0.01, 0.0), 0.03),
        ("Fork", tableware.fork(), steel, (-0.215, -0.10, 0.0135), 0.5 * math.pi),
        ("Knife", tableware.knife(), steel, (0.168, -0.11, 0.0), 0.5 * math.pi),
        ("Spoon", tableware.spoon(), steel, (0.198, -0.10, 0.0), 0.5 * math.pi),
    ]
    for name, shape, material, place, turn in forms:
        original = add_shape(name, shape, [material])
        spots = []
        for x, y, seat in SETTINGS:
            cos, sin = math.cos(seat), math.sin(seat)
            spot = (x + cos * place[0] - sin * place[1], y + sin * place[0] + cos * place[1], TOP + place[2])
            spots.append((spot, seat + turn))
        original.location, original.rotation_euler = spots[0][0], (0.0, 0.0, spots[0][1])
        add_copies(original, spots[1:])


def build_middle() -> None:
    """What stands between the guests: fruit, bread, jug, candles and a vase of olive twigs."""
    glaze, blue = bpy.data.materials["White glaze"], bpy.data.materials["Blue glaze"]
    bowl = tableware.turned_ware(tableware.FRUIT_BOWL, 34)
    add_shape("Fruit bowl", moved(bowl, (0.06, -0.02, TOP)), [glaze])
    skins = [plain("Stem", (0.10, 0.06, 0.03))]
    reds = [shiny("Red apple", (0.42, 0.045, 0.03), 0.35), shiny("Green apple", (0.40, 0.46, 0.10), 0.35)]
    heap = [(0.0, 0.0, 0.022), (0.082, 0.01, 0.037), (0.022, 0.08, 0.037), (-0.068, 0.048, 0.037)]
    heap += [(-0.066, -0.048, 0.037), (0.024, -0.08, 0.037), (0.035, 0.03, 0.088), (-0.028, -0.012, 0.090)]
    for number, (x, y, z) in enumerate(heap):
        fruit = turned(tableware.apple(0.4 + 0.9 * (number % 4)), 2.1 * number, 2)
        add_shape("Apple", moved(fruit, (0.06 + x, -0.02 + y, TOP + z)), [reds[number % 3 == 2], *skins])
    board = box((-0.21, -0.11, 0.0), (0.21, 0.11, 0.018), 0.004)
    add_shape("Bread board", moved(board, (-0.45, 0.0, TOP), 0.15), [plain("Beech", (0.48, 0.31, 0.17))])
    crust, crumb = plain("Crust", (0.42, 0.20, 0.075)), plain("Crumb", (0.72, 0.60, 0.40))
    add_shape("Loaf", moved(tableware.loaf(), (-0.48, 0.03, TOP + 0.018), 0.2), [crust])
    slices = [
        moved(tableware.slice_of_bread(), (0.02 * k, -0.013 * k, 0.0142 * k), 0.4 * k) for k in range(2)
    ]
    add_shape("Slices", moved(join(slices), (-0.36, -0.055, TOP + 0.0185), 0.3), [crust, crumb])
    add_shape("Jug", moved(tableware.jug(), (0.72, 0.06, TOP), 2.5), [blue])
    vase = moved(tableware.turned_ware(tableware.VASE, 22), (-0.10, 0.10, TOP))
    add_shape("Vase", vase, [shiny("Grey glaze", (0.40, 0.40, 0.37), 0.25)])
    twigs = [moved(tableware.sprig(0.34 + 0.03 * k, 12, k), (0.0, 0.0, 0.12)) for k in range(4)]
    wood, green = plain("Twig", (0.13, 0.09, 0.05)), plain("Olive leaf", (0.13, 0.19, 0.085))
    add_shape("Twigs", moved(join(twigs), (-0.10, 0.10, TOP)), [wood, green])
    brass, wax = bpy.data.materials["Brass"], plain("Wax", (0.78, 0.73, 0.60))
    for x, y in ((0.34, 0.12), (-0.80, -0.02)):
        stick = tableware.turned_ware(tableware.CANDLESTICK, 16)
        candle = tube([(0.0, 0.0, 0.15), (0.0, 0.0, 0.36), (0.0, 0.0, 0.368)], [0.0105, 0.0095, 0.004], 12)
        add_shape("Candlestick", moved(join([stick, in_slot(candle, 1)]), (x, y, TOP)), [brass, wax])


def build() -> None:
    """The laid table, 640 by 480."""
    common.start_empty_file()
    build_room()
    build_furniture()
    build_lamp()
    lay_table()
    build_middle()
    aim = (Vector(LOOK_AT) - Vector(CAMERA)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.view_settings.exposure = EXPOSURE
    common.add_camera(CAMERA, tuple(aim), FIELD_OF_VIEW, (640, 480))
