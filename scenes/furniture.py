"""The dining room of the laid table: its walls, window, floor, furniture and lampshade, in metres."""

from __future__ import annotations

import itertools
import math

import numpy as np

from scenes.shapes import (
    Points,
    Shape,
    box,
    in_slot,
    join,
    lathe,
    mapped,
    moved,
    rectangle_rings,
    sheet,
    smooth_curve,
    tube,
    turned,
)

ROOM = (-2.3, -3.7, 2.5, 2.1)
"""Low x, low y, high x, high y of the floor."""
HEIGHT = 2.75
WALL = 0.22
"""Thickness of walls, floor and ceiling."""
WINDOW = (-0.65, 0.85, 0.95, 2.3)
"""Low y, high y, low z, high z of the opening in the wall at low x."""
DADO = 0.94
"""Height of the painted paneling."""
TABLE = (1.08, 0.52, 0.75)
"""Half length along x, half width along y, height of the table."""


def walls() -> Shape:
    """Four walls that overlap in the corners; slot 1 is the ceiling, slot 2 the dado. The wall at low x has the
    window's opening. Wall and dado meet behind the chair rail."""
    x0, y0, x1, y1 = ROOM
    half, joint = 0.5 * WALL, DADO - 0.02
    parts = []
    for low, high, slot in ((-WALL, joint, 2), (joint + 0.001, HEIGHT + half, 0)):
        sides = [
            box((x0 - half, y1, low), (x1 + half, y1 + WALL, high)),
            box((x0 - half, y0 - WALL, low), (x1 + half, y0, high)),
            box((x1, y0 - WALL, low), (x1 + WALL, y1 + WALL, high)),
        ]
        parts += [in_slot(side, slot) for side in sides]
    parts.append(in_slot(box((x0 - WALL, y0 - WALL, -WALL), (x0, y1 + WALL, joint)), 2))
    outer = (y0 - WALL, joint + 0.001, y1 + WALL, HEIGHT + half)
    hole = (WINDOW[0], WINDOW[2], WINDOW[1], WINDOW[3])
    ring = rectangle_rings([(*outer, 0.0), (*outer, WALL), (*hole, WALL), (*hole, 0.0)])
    # The ring lies in x and y: x becomes the world's y, y its z and z its x.
    parts.append(mapped(ring, lambda points: points[:, [2, 0, 1]] + np.array([x0 - WALL, 0.0, 0.0])))
    ceiling = box((x0 - WALL, y0 - WALL, HEIGHT), (x1 + WALL, y1 + WALL, HEIGHT + WALL))
    return join([*parts, in_slot(ceiling, 1)])


def moldings() -> Shape:
    """Skirting board, chair rail and cornice around the room. The rail passes below the window's sill."""
    skirting = [(0.0, -0.02), (0.022, -0.02), (0.022, 0.10), (0.012, 0.125), (-0.01, 0.125)]
    rail = [
        (0.0, DADO - 0.05),
        (0.02, DADO - 0.04),
        (0.028, DADO - 0.02),
        (0.034, DADO - 0.008),
        (0.034, DADO),
    ]
    rail.append((-0.01, DADO))
    cornice = [(-0.01, HEIGHT - 0.12), (0.018, HEIGHT - 0.12), (0.026, HEIGHT - 0.10), (0.04, HEIGHT - 0.07)]
    cornice += [(0.07, HEIGHT - 0.035), (0.10, HEIGHT - 0.025), (0.10, HEIGHT + 0.01)]
    return join([_around_room(profile) for profile in (skirting, rail, cornice)])


def panels() -> Shape:
    """Raised frames on the dado of the back and right-hand walls."""
    x0, y0, x1, y1 = ROOM
    section = [(0.0, -0.01), (0.0, 0.010), (0.014, 0.016), (0.026, 0.010), (0.034, 0.004), (0.034, -0.01)]
    parts = []
    count = 6
    width = (x1 - x0) / count
    low, high = 0.22, DADO - 0.13
    for number in range(count):
        left = x0 + width * number + 0.08
        rings = [(left + d, low + d, left + width - 0.16 - d, high - d, h) for d, h in section]
        # x stays, y becomes the world's z, z comes out of the back wall.
        frame = rectangle_rings(rings)
        parts.append(
            mapped(frame, lambda points: points[:, [0, 2, 1]] * np.array([1, -1, 1]) + np.array([0, y1, 0]))
        )
    depth = (y1 - y0) / count
    for number in range(count):
        left = y0 + depth * number + 0.08
        rings = [(left + d, low + d, left + depth - 0.16 - d, high - d, h) for d, h in section]
        frame = rectangle_rings(rings)
        for wall, out in ((x0, 1.0), (x1, -1.0)):
            side = mapped(frame, lambda points: points[:, [2, 0, 1]])
            parts.append(_facing(side, wall, out))
    return join(parts)


def floor() -> Shape:
    """Oak boards along x, their edges eased by 3 mm, as one surface over the ground; slots 0 to 2 are three tones."""
    x0, y0, x1, y1 = ROOM
    random = np.random.default_rng(4)
    rows, ease = 42, 0.003
    width = (y1 - y0) / rows
    parts = []
    for row in range(rows):
        low, high = y0 + row * width, y0 + (row + 1) * width
        cuts = [x0, *(x0 + random.uniform(0.6, 1.9) + np.array([0.0, 1.9])), x1]
        for left, right in itertools.pairwise(cuts):
            rim = (left, low, right, high, -ease)
            top = (left + ease, low + ease, right - ease, high - ease, 0.0)
            middle = (0.5 * (left + right), 0.5 * (low + high))
            board = rectangle_rings([rim, top, (*middle, *middle, 0.0)], wrap=False)
            parts.append(in_slot(board, int(random.integers(3))))
    return join(parts)


def window() -> Shape:
    """Casing inside, a sill, and a frame with a post and bars deep in the opening."""
    low_y, high_y, low_z, high_z = WINDOW
    casing = [
        (-0.09, -0.01),
        (-0.09, 0.022),
        (-0.07, 0.028),
        (-0.012, 0.024),
        (-0.004, 0.016),
        (-0.004, -0.01),
    ]
    rings = [(low_y + d, low_z + d, high_y - d, high_z - d, h) for d, h in casing]
    parts = [mapped(rectangle_rings(rings), lambda p: p[:, [2, 0, 1]] + np.array([ROOM[0], 0.0, 0.0]))]
    depth = ROOM[0] - 0.15
    sash = [(-0.02, 0.0), (-0.02, 0.05), (0.05, 0.05), (0.058, 0.04), (0.058, 0.0)]
    rings = [(low_y + d, low_z + d, high_y - d, high_z - d, h) for d, h in sash]
    parts.append(mapped(rectangle_rings(rings), lambda p: p[:, [2, 0, 1]] + np.array([depth, 0.0, 0.0])))
    middle = 0.5 * (low_y + high_y)
    parts.append(box((depth + 0.002, middle - 0.04, low_z), (depth + 0.048, middle + 0.04, high_z), 0.006))
    for quarter in (0.25, 0.75):
        y = low_y + quarter * (high_y - low_y)
        parts.append(box((depth + 0.01, y - 0.011, low_z), (depth + 0.036, y + 0.011, high_z), 0.004))
    for third in (1.0 / 3.0, 2.0 / 3.0):
        z = low_z + third * (high_z - low_z)
        parts.append(box((depth + 0.012, low_y, z - 0.011), (depth + 0.034, high_y, z + 0.011), 0.004))
    sill = box(
        (ROOM[0] - 0.12, low_y - 0.13, low_z - 0.03), (ROOM[0] + 0.10, high_y + 0.13, low_z + 0.008), 0.006
    )
    return join([*parts, sill])


def curtain(width: float, folds: int, seed: float) -> Shape:
    """A curtain along y around its top middle at z = 0, hanging down to the floor in folds."""
    drop = 2.42
    across = np.linspace(-0.5, 0.5, 6 * folds + 1)[None, :]
    down = np.linspace(0.0, 1.0, 9)[:, None]
    sway = 0.35 * np.sin(2.3 * down + seed) * down
    phase = 2.0 * math.pi * folds * across + sway + 0.5 * np.sin(9.0 * across + seed)
    depth = 0.035 + 0.012 * down
    x = depth * np.sin(phase) + 0.012 * np.sin(2.0 * phase + seed) * down
    y = width * across * (1.0 - 0.10 * np.sin(math.pi * down)) + 0.012 * np.cos(phase) * down
    z = -drop * down + 0.0 * across
    return sheet(np.stack([x, y, z], axis=2), 0.003)


def curtain_rod(length: float) -> Shape:
    """A rod along y with turned ends."""
    knob = [(0.0, 0.0), (0.012, 0.0), (0.026, 0.02), (0.026, 0.035), (0.012, 0.055), (0.0, 0.058)]
    end = turned(lathe(smooth_curve(knob, 2), 14), -0.5 * math.pi, 0)
    rod = tube([(0.0, -0.5 * length, 0.0), (0.0, 0.5 * length, 0.0)], 0.012, 16)
    first = moved(end, (0.0, 0.5 * length, 0.0))
    return join([rod, first, moved(first, turn=math.pi)])


def table() -> Shape:
    """A table of boards on four turned legs, on the floor; slot 0 the varnished top, slot 1 the frame below."""
    half_x, half_y, height = TABLE
    boards = []
    count = 6
    width = 2.0 * half_y / count
    for number in range(count):
        low = -half_y + number * width
        boards.append(
            box((-half_x, low + 0.0004, height - 0.034), (half_x, low + width - 0.0004, height), 0.0016)
        )
    apron = [(0.09, height - 0.13), (0.062, height - 0.13), (0.062, height - 0.0345), (0.09, height - 0.0345)]
    rings = [(-half_x + d, -half_y + d, half_x - d, half_y - d, z) for d, z in apron]
    block = box((-0.042, -0.042, height - 0.15), (0.042, 0.042, height - 0.0348), 0.004)
    profile = [(0.0, 0.0005), (0.016, 0.0005), (0.02, 0.05), (0.027, 0.3), (0.034, 0.5), (0.036, 0.54)]
    profile += [(0.028, 0.555), (0.034, 0.57), (0.034, 0.585), (0.03, 0.605)]
    leg = join([lathe(smooth_curve(profile, 2), 14), block])
    corners = [(sx * (half_x - 0.085), sy * (half_y - 0.085), 0.0) for sx in (-1, 1) for sy in (-1, 1)]
    frame = join([rectangle_rings(rings), *(moved(leg, corner) for corner in corners)])
    return join([*boards, in_slot(frame, 1)])


def chair() -> Shape:
    """A chair with a spindle back on the floor, its back towards +y; slot 1 is the seat."""
    seat_height = 0.455
    u, v = np.meshgrid(np.linspace(-1.0, 1.0, 11), np.linspace(-1.0, 1.0, 11))
    # A square bent towards a disk: its rim is round at the corners.
    x = 0.225 * u * np.sqrt(1.0 - 0.30 * v**2) * (1.0 - 0.06 * v)
    y = 0.215 * v * np.sqrt(1.0 - 0.30 * u**2)
    saddle = 0.014 * (1.0 - u**4) * (1.0 - v**4) * (1.0 - 0.3 * np.exp(-(u**2) / 0.05) * (v < 0.2))
    seat = sheet(np.stack([x, y, seat_height - saddle], axis=2), 0.032)
    parts = [in_slot(seat, 1)]
    for sx in (-1, 1):
        for sy in (-1, 1):
            foot, top = (0.205 * sx, 0.2 * sy, 0.0005), (0.15 * sx, 0.145 * sy, 0.43)
            parts.append(_spindle(foot, top, 0.012, 0.019))
        parts.append(_spindle((0.186 * sx, -0.182, 0.15), (0.186 * sx, 0.182, 0.15), 0.008, 0.013))
        parts.append(tube(_bent((0.185 * sx, 0.165, 0.43), (0.2 * sx, 0.235, 0.9)), 0.0135, 8))
    parts.append(_spindle((-0.186, 0.0, 0.152), (0.186, 0.0, 0.152), 0.008, 0.013))
    for number in range(5):
        along = (number - 2.0) / 2.0
        back = 0.185 + 0.012 * (1.0 - along**2)
        parts.append(
            _spindle((0.12 * along, back - 0.02, 0.43), (0.145 * along, back + 0.075, 0.86), 0.006, 0.0085)
        )
    crest = np.linspace(-1.0, 1.0, 11)[None, :]
    rise = np.linspace(0.0, 1.0, 4)[:, None]
    x = 0.225 * crest + 0.0 * rise
    y = 0.235 + 0.038 * (1.0 - crest**2) + 0.016 * rise
    z = 0.845 + (0.085 - 0.035 * crest**4) * rise + 0.01 * crest**2
    parts.append(sheet(np.stack([x, y, z], axis=2), -0.02))
    return join(parts)


def sideboard() -> Shape:
    """A low cupboard along x against a wall at +y, on the floor; slot 1 is its knobs."""
    half, depth, height = 0.8, 0.42, 0.86
    parts = [
        box((-half, -depth, 0.1), (half, 0.0, height - 0.03), 0.004),
        box((-half - 0.02, -depth - 0.02, height - 0.0298), (half + 0.02, 0.0, height), 0.006),
    ]
    for sx in (-1, 1):
        feet = [(sx * (half - 0.06), y) for y in (-depth + 0.05, -0.05)]
        parts += [tube([(x, y, 0.0005), (x, y, 0.102)], [0.016, 0.026], 14) for x, y in feet]
    knob = [(0.0, -0.002), (0.006, -0.002), (0.006, 0.012), (0.015, 0.018), (0.013, 0.026), (0.0, 0.03)]
    pull = turned(lathe(smooth_curve(knob, 2), 10), 0.5 * math.pi, 0)
    for column in range(3):
        left = -half + 0.03 + column * (2.0 * half - 0.03) / 3.0
        right = left + (2.0 * half - 0.03) / 3.0 - 0.03
        for low, high in ((0.13, 0.56), (0.585, 0.8)):
            parts.append(box((left, -depth - 0.016, low), (right, -depth + 0.01, high), 0.005))
            place = (0.5 * (left + right), -depth - 0.016, 0.5 * (low + high) if low > 0.5 else high - 0.06)
            parts.append(in_slot(moved(pull, place), 1))
    return join(parts)


def picture(width: float, height: float) -> Shape:
    """A framed picture on a wall at +y around its middle: slot 0 frame, 1 mount, 2 and on the bands of a landscape."""
    section = [(0.0, -0.004), (0.0, 0.022), (0.008, 0.026), (0.024, 0.018), (0.03, 0.01), (0.03, -0.004)]
    x, z = 0.5 * width, 0.5 * height
    rings = [(-x + d, -z + d, x - d, z - d, h) for d, h in section]
    frame = turned(rectangle_rings(rings), 0.5 * math.pi, 0)
    mount = in_slot(box((-x + 0.02, -0.006, -z + 0.02), (x - 0.02, -0.001, z - 0.02)), 1)
    parts = [frame, mount]
    left, right, low, high = -x + 0.11, x - 0.11, -z + 0.11, z - 0.11
    edges = [
        lambda u: 0.0 * u,
        lambda u: 0.22 + 0.05 * np.sin(3.0 * u + 0.4),
        lambda u: 0.38 + 0.04 * np.sin(5.0 * u),
    ]
    edges += [lambda u: 0.56 + 0.07 * np.sin(2.6 * u + 2.2) + 0.02 * np.sin(9.0 * u), lambda u: 1.0 + 0.0 * u]
    u = np.linspace(0.0, 1.0, 25)
    for number, (lower, upper) in enumerate(itertools.pairwise(edges)):
        heights = low + (high - low) * np.stack([lower(u), upper(u)])
        grid = np.stack(
            [np.broadcast_to(left + (right - left) * u, heights.shape), 0.0 * heights - 0.008, heights],
            axis=2,
        )
        parts.append(in_slot(sheet(grid, 0.0015), 2 + number))
    return join(parts)


def lampshade() -> Shape:
    """A hanging shade, open above and below, around the middle of its lower rim: slot 0 outside, slot 1 inside."""
    outer = smooth_curve(
        [(0.225, 0.0), (0.215, 0.05), (0.18, 0.12), (0.12, 0.18), (0.075, 0.215), (0.062, 0.25)], 3
    )
    inner = outer - np.array([0.004, 0.0])
    rim = np.vstack([outer[-1:], inner[-1:]])
    foot = np.vstack([inner[:1], outer[:1]])
    outside = join([lathe(outer, 34), lathe(rim, 34), lathe(foot, 34)])
    return join([outside, in_slot(lathe(inner[::-1], 34), 1)])


def lamp_fitting(length: float) -> Shape:
    """Spider, socket and cord of the lamp, from the shade's upper rim up to a rose `length` above the lower rim."""
    socket = [
        (0.0, 0.15),
        (0.022, 0.15),
        (0.024, 0.17),
        (0.024, 0.23),
        (0.014, 0.25),
        (0.008, 0.28),
        (0.0, 0.285),
    ]
    rose = [(0.0, length - 0.045), (0.01, length - 0.044), (0.03, length - 0.025), (0.055, length - 0.008)]
    rose += [(0.055, length + 0.01)]
    cord = tube([(0.0, 0.0, 0.28), (0.0, 0.0, length - 0.03)], 0.0045, 10)
    arms = []
    for number in range(3):
        angle = 2.0 * math.pi * number / 3.0
        end = (0.0615 * math.cos(angle), 0.0615 * math.sin(angle), 0.245)
        arms.append(tube([(0.01 * math.cos(angle), 0.01 * math.sin(angle), 0.235), end], 0.0025, 8))
    return join([lathe(socket, 20), lathe(smooth_curve(rose, 2), 20), cord, *arms])


def _around_room(profile: list[tuple[float, float]]) -> Shape:
    """A profile of (distance from the wall, height) carried around the room; it faces inwards."""
    x0, y0, x1, y1 = ROOM
    rings = [(x0 + d, y0 + d, x1 - d, y1 - d, z) for d, z in reversed(profile)]
    return rectangle_rings(rings, wrap=False)


def _facing(shape: Shape, wall: float, out: float) -> Shape:
    """A frame whose x comes out of a wall, set on the wall at x = `wall` that faces along `out`."""
    points: Points = shape.points * np.array([out, 1.0, 1.0]) + np.array([wall, 0.0, 0.0])
    faces = shape.faces if out > 0.0 else [face[::-1] for face in shape.faces]
    return Shape(points, faces, shape.slots)


def _spindle(
    low: tuple[float, float, float], high: tuple[float, float, float], end: float, middle: float
) -> Shape:
    """A turned bar, thickest in its middle."""
    along = np.linspace(0.0, 1.0, 5)
    path = np.array(low) + along[:, None] * (np.array(high) - np.array(low))
    return tube(path, end + (middle - end) * np.sin(math.pi * along), 7)


def _bent(low: tuple[float, float, float], high: tuple[float, float, float]) -> Points:
    """A way up that leans back more and more."""
    middle = 0.5 * (np.array(low) + np.array(high)) - np.array([0.0, 0.015, 0.0])
    return smooth_curve([low, tuple(middle), high], 4)
