"""Pieces of a Gothic church: pointed arches, pierced walls, tracery, ribs, vaults, piers and pews, in metres.

A pointed arch is made of two arcs whose radius is `POINT` half spans; its height is `RISE` half spans.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from scenes.shapes import (
    Curve,
    Points,
    Shape,
    box,
    join,
    lathe,
    mapped,
    moved,
    prism,
    smooth_curve,
    surface,
    sweep,
)

POINT = 1.25
RISE = math.sqrt(2.0 * POINT - 1.0)
ROLL: Curve = [(-0.09, 0.06), (-0.09, -0.02), (-0.06, -0.09), (0.0, -0.13)]
"""Left half of a rib's section, open above, around the line it follows (sideways, upwards)."""


@dataclass(frozen=True)
class Opening:
    """A window or arch with a pointed head."""

    half: float
    """Half its width."""
    sill: float
    """Height of its foot."""
    spring: float
    """Height at which its arch begins."""

    def outline(self, steps: int) -> Points:
        """From the left foot over the top to the right foot, (2 steps + 3, 2)."""
        arch = self.half * pointed_arch(steps) + np.array([0.0, self.spring])
        return np.vstack([[-self.half, self.sill], arch, [self.half, self.sill]])

    def widened(self, by: float) -> Opening:
        """The opening with its jambs moved outwards and its sill down."""
        return Opening(self.half + by, self.sill - by, self.spring)


def pointed_arch(steps: int) -> Points:
    """Over a half span of 1, from (-1, 0) over the top (0, RISE) to (1, 0), `steps` pieces on each side."""
    angles = np.linspace(math.pi, math.acos((1.0 - POINT) / POINT), steps + 1)
    left = np.stack([POINT - 1.0 + POINT * np.cos(angles), POINT * np.sin(angles)], axis=1)
    left[0], left[-1] = (-1.0, 0.0), (0.0, RISE)
    return np.vstack([left, left[-2::-1] * np.array([-1.0, 1.0])])


def pierced_wall(
    width: float, low: float, high: float, inner: Opening, outer: Opening, depth: float, steps: int = 10
) -> Shape:
    """A wall in x and z with an opening in its middle, its inner face at y = 0, its outer one at y = `depth`.

    The opening changes from `inner` to `outer` through the wall. One whose sill is at `low` has none.
    """
    parts = []
    for opening, y in ((inner, 0.0), (outer, depth)):
        parts += _wall_face(width, low, high, opening, y, steps)
    reveal = [
        np.insert(opening.outline(steps), 1, y, axis=1) for opening, y in ((outer, depth), (inner, 0.0))
    ]
    parts.append(surface(np.stack(reveal), wrap_columns=inner.sill > low))
    return join(parts)


def _wall_face(width: float, low: float, high: float, opening: Opening, y: float, steps: int) -> list[Shape]:
    """One face of a pierced wall; it looks along -y at y = 0 and along +y elsewhere."""
    heights = sorted({low, opening.sill, opening.spring, high})
    arch = opening.outline(steps)[1:-1]
    sides = []
    for edge, jamb in ((-0.5 * width, -opening.half), (opening.half, 0.5 * width)):
        sides.append([[(edge, y, z), (jamb, y, z)] for z in heights])
    above = [[(x, y, z) for x, z in arch], [(x, y, high) for x, _ in arch]]
    grids = [*sides, above]
    if opening.sill > low:
        grids.append([[(sign * opening.half, y, z) for sign in (-1, 1)] for z in (low, opening.sill)])
    points = [np.array(grid) for grid in grids]
    return [surface(grid if y == 0.0 else grid[:, ::-1]) for grid in points]


def tracery(opening: Opening, y: float, bar: float = 0.06) -> Shape:
    """A mullion, two lancets, a ring above them and iron bars, in the plane at `y` of an opening."""
    section = [
        (-bar, 0.0),
        (-0.4 * bar, -bar),
        (0.4 * bar, -bar),
        (bar, 0.0),
        (0.4 * bar, bar),
        (-0.4 * bar, bar),
    ]
    half, quarter = opening.half, 0.5 * opening.half
    spring = opening.spring - 0.1 * half
    parts = [_flat_sweep(section, [(0.0, opening.sill - 0.02), (0.0, spring + 0.4 * half)], y)]
    for middle in (-quarter, quarter):
        lancet = quarter * pointed_arch(6) + np.array([middle, spring])
        parts.append(_flat_sweep(section, lancet, y))
    angles = np.linspace(0.0, 2.0 * math.pi, 20, endpoint=False)
    ring = 0.36 * half * np.stack([np.cos(angles), np.sin(angles)], axis=1) + np.array(
        [0.0, spring + 0.88 * half]
    )
    parts.append(_flat_sweep(section, ring, y, closed=True))
    count = max(2, round((spring - opening.sill) / 0.7))
    for number in range(1, count):
        z = opening.sill + (spring - opening.sill) * number / count
        parts.append(box((-half, y - 0.012, z - 0.012), (half, y + 0.012, z + 0.012)))
    return join(parts)


def _flat_sweep(
    section: Curve, path: Sequence[Sequence[float]] | Points, y: float, closed: bool = False
) -> Shape:
    """A bar along a path of (x, z) in the plane at `y`."""
    return sweep(section, np.insert(np.array(path, float), 1, y, axis=1), (0.0, 1.0, 0.0), closed)


def archivolt(opening: Opening, y: float, steps: int = 12) -> Shape:
    """Stones of two tones (slots 0 and 1) around an arch, standing out of the wall's face at `y` towards -y."""
    section = [
        (-0.02, 0.02),
        (-0.02, -0.05),
        (0.05, -0.07),
        (0.12, -0.09),
        (0.20, -0.06),
        (0.30, -0.05),
        (0.30, 0.02),
    ]
    path = opening.outline(steps)[1:-1]
    shape = _flat_sweep(section, path, y)
    return banded(shape, len(section), 2)


def banded(shape: Shape, faces: int, stones: int) -> Shape:
    """A sweep with `faces` per step in bands of `stones` steps, slots 0 and 1 in turn."""
    slots = [(face // faces // stones) % 2 for face in range(len(shape.faces))]
    return Shape(shape.points, shape.faces, slots)


def vault_height(x: Points, y: Points, rise: float, dome: float) -> Points:
    """Of a groined vault over |x|, |y| <= 1 above its springing: two pointed barrels that cross, bulging by `dome`."""
    t = np.minimum(np.abs(x), np.abs(y))
    arch = np.sqrt(np.maximum(POINT**2 - (t + POINT - 1.0) ** 2, 0.0)) / RISE
    return rise * arch + dome * (1.0 - x**2) * (1.0 - y**2)


def vault(half_x: float, half_y: float, rise: float, dome: float, steps: int = 10) -> Shape:
    """The four webs of a groined vault around its middle, springing at z = 0."""
    across = pointed_arch(steps)[:, 0]
    outwards = np.linspace(0.0, 1.0, 6)
    v = np.broadcast_to(across[:, None], (len(across), len(outwards)))
    u = np.abs(v) + (1.0 - np.abs(v)) * outwards
    webs = []
    for sign in (1.0, -1.0):
        for x, y in ((sign * u, v), (-sign * v, u * sign)):
            z = vault_height(x, y, rise, dome)
            webs.append(surface(np.stack([half_x * x, half_y * y, z], axis=2)))
    return join(webs)


def vault_rib(
    half_x: float,
    half_y: float,
    rise: float,
    dome: float,
    ends: tuple[float, float, float, float],
    steps: int,
    size: float,
) -> Shape:
    """A rib below a groined vault, from x, y to x, y (in half spans), `size` times the usual section."""
    x0, y0, x1, y1 = ends
    half = pointed_arch(steps)[:, 0]
    t = 0.5 * (half + 1.0)
    x, y = x0 + (x1 - x0) * t, y0 + (y1 - y0) * t
    path = np.stack([half_x * x, half_y * y, vault_height(x, y, rise, dome)], axis=1)
    left = size * np.array(ROLL)
    section = np.vstack([left, left[-2::-1] * np.array([-1.0, 1.0])])
    # Both feet of a rib rise upright, where "up" is no guide: the side it has in between serves all along.
    side = np.array([-(y1 - y0) * half_y, (x1 - x0) * half_x, 0.0])
    return _rib_along(section, path, side / np.linalg.norm(side))


def _rib_along(section: Points, path: Points, side: Points) -> Shape:
    """An open section carried along a path in an upright plane with the normal `side`."""
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    upward = np.cross(along, side)
    grid = path[:, None] + section[None, :, :1] * side + section[None, :, 1:] * upward[:, None]
    return surface(grid)


def cloister_web(corner: Sequence[float], following: Sequence[float], rise: float, steps: int = 12) -> Shape:
    """The web of a domed apse between its top over the origin and the wall between two corners (x, y), z = 0 there."""
    arch = pointed_arch(steps)[: steps + 1]
    out, height = -arch[:, 0], rise * arch[:, 1] / RISE
    along = np.linspace(0.0, 1.0, 7)[:, None]
    wall = np.array(corner) + along * (np.array(following) - np.array(corner))
    points = np.empty((len(out), len(along), 3))
    points[:, :, :2] = out[:, None, None] * wall
    points[:, :, 2] = height[:, None]
    return surface(points)


def apse_rib(corner: Sequence[float], rise: float, steps: int = 14) -> Shape:
    """A rib from a corner (x, y) of a domed apse to its top over the origin."""
    arch = pointed_arch(steps)[: steps + 1]
    flat = -arch[:, :1] * np.array(corner)
    path = np.column_stack([flat, rise * arch[:, 1] / RISE])
    left = np.array(ROLL)
    section = np.vstack([left, left[-2::-1] * np.array([-1.0, 1.0])])
    x, y = corner
    side = np.array([y, -x, 0.0]) / math.hypot(x, y)
    return _rib_along(section, path, side)


def shaft(radius: float, low: float, high: float, sides: int = 16) -> Shape:
    """A slender column with a molded base and a bell capital with an abacus."""
    r = radius
    profile = [(1.9 * r, low), (1.9 * r, low + 0.10), (1.55 * r, low + 0.14), (1.6 * r, low + 0.19)]
    profile += [(1.15 * r, low + 0.24), (r, low + 0.28), (r, high - 0.55), (1.2 * r, high - 0.53)]
    profile += [(1.2 * r, high - 0.49), (r, high - 0.47), (1.15 * r, high - 0.30), (1.9 * r, high - 0.14)]
    profile += [(2.1 * r, high - 0.12), (2.1 * r, high - 0.02), (1.9 * r, high), (0.0, high)]
    return lathe(profile, sides)


def pier(height: float) -> Shape:
    """A round pier with four shafts around it, a molded base on a plinth, and a capital of two rows of leaves."""
    core, half_shaft = 0.40, 0.15
    angles = np.linspace(0.0, 2.0 * math.pi, 48, endpoint=False)
    turn = np.abs((angles + 0.25 * math.pi) % (0.5 * math.pi) - 0.25 * math.pi)
    reach = (half_shaft / core) ** 2 - np.sin(turn) ** 2
    plan = np.where(reach > 0.0, core * (np.cos(turn) + np.sqrt(np.maximum(reach, 0.0))), core)
    neck = height - 0.85
    base = [(0.16, 0.30), (0.17, 0.36), (0.13, 0.41), (0.07, 0.43), (0.06, 0.47), (0.10, 0.50), (0.10, 0.55)]
    base += [(0.03, 0.58), (0.0, 0.62)]
    collar = [
        (0.0, neck),
        (0.04, neck + 0.015),
        (0.05, neck + 0.04),
        (0.04, neck + 0.065),
        (0.0, neck + 0.08),
    ]
    bell = [(0.01, neck + 0.3), (0.05, neck + 0.5), (0.14, neck + 0.65)]
    profile = np.array([*base, *collar, *bell])
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = np.empty((len(profile), len(angles), 3))
    points[:, :, :2] = (plan + profile[:, :1])[:, :, None] * ring
    points[:, :, 2] = profile[:, 1:]
    plinth = [
        box((-0.78, -0.78, -0.1), (0.78, 0.78, 0.18), 0.03),
        box((-0.72, -0.72, 0.17), (0.72, 0.72, 0.301), 0.06),
    ]
    abacus = [box((-0.70, -0.70, height - 0.21), (0.70, 0.70, height - 0.07), 0.05)]
    abacus.append(box((-0.76, -0.76, height - 0.08), (0.76, 0.76, height), 0.03))
    leaves = []
    for row, (count, foot, size) in enumerate(((10, neck + 0.08, 0.38), (10, neck + 0.28, 0.42))):
        for number in range(count):
            angle = 2.0 * math.pi * (number + 0.5 * row) / count
            radius = float(np.interp(angle % (2.0 * math.pi), angles, plan, period=2.0 * math.pi))
            leaves.append(moved(crocket(size, min(radius, core + 0.08)), (0.0, 0.0, foot), angle))
    return join([*plinth, surface(points, wrap_columns=True), *abacus, *leaves])


def crocket(height: float, radius: float) -> Shape:
    """A leaf on a capital that stands up at distance `radius` on the +x side and curls over."""
    spine = smooth_curve([(0.0, 0.0), (0.02, 0.45), (0.10, 0.85), (0.20, 1.0), (0.27, 0.93), (0.25, 0.83)], 1)
    width = np.interp(np.linspace(0.0, 1.0, len(spine)), (0.0, 0.45, 0.8, 1.0), (0.10, 0.115, 0.08, 0.02))
    across = np.linspace(-1.0, 1.0, 4)
    points = np.empty((len(spine), len(across), 3))
    # Hollow along the middle, with a scalloped rim.
    rim = 1.0 + 0.12 * np.cos(np.arange(len(spine)) * math.pi)
    points[:, :, 0] = radius + spine[:, :1] - 0.02 + 0.035 * (1.0 - across**2)
    points[:, :, 1] = (width * rim)[:, None] * across * (height / 0.38)
    points[:, :, 2] = height * spine[:, 1:]
    return surface(points)


def boss(radius: float) -> Shape:
    """A keystone hanging below z = 0, with a flower of four petals."""
    r = radius
    stone = lathe(
        [(0.0, -0.26), (0.45 * r, -0.24), (0.6 * r, -0.16), (0.95 * r, -0.18), (r, -0.1), (r, 0.1)], 24
    )

    def petals(points: Points) -> Points:
        angle = np.arctan2(points[:, 1], points[:, 0])
        return points * np.stack([1.0 + 0.09 * np.cos(4.0 * angle)] * 2 + [np.ones_like(angle)], axis=1)

    return mapped(stone, petals)


def pew(length: float) -> Shape:
    """A bench along x around its middle, its back towards -y, between carved ends; it stands on z = 0."""
    half = 0.5 * length
    seat = box((-half, -0.18, 0.42), (half, 0.24, 0.46))
    rest = box((-half, -0.235, 0.50), (half, -0.20, 0.90))
    rail = box((-half, -0.26, 0.90), (half, -0.17, 0.95), 0.015)
    shelf = box((-half, -0.44, 0.72), (half, -0.26, 0.745))
    skirt = box((-half, 0.20, 0.05), (half, 0.225, 0.42))
    head = smooth_curve(
        [(0.30, 0.50), (0.24, 0.64), (0.10, 0.70), (0.02, 0.86), (-0.02, 1.02), (-0.12, 1.10)], 3
    )
    tail = smooth_curve([(-0.12, 1.10), (-0.22, 1.06), (-0.29, 0.94), (-0.30, 0.5)], 2)
    outline = np.vstack([[(-0.30, 0.002), (0.30, 0.002)], head[:-1], tail])
    ends = []
    for x in (-half - 0.03, half - 0.03):
        # The outline lies in x and y: x becomes y, y becomes z, z becomes x.
        end = prism(outline, x, x + 0.06)
        ends.append(mapped(end, lambda points: points[:, [2, 0, 1]]))
    return join([seat, rest, rail, shelf, skirt, *ends])


def slabs(low: tuple[float, float], high: tuple[float, float], z: float, size: float, seed: int) -> Shape:
    """A paved floor at height `z`: squares of slots 0 and 1 in turn, one in five of slot 2."""
    random = np.random.default_rng(seed)
    columns, rows = (max(1, round((end - start) / size)) for start, end in zip(low, high))
    x, y = np.linspace(low[0], high[0], columns + 1), np.linspace(low[1], high[1], rows + 1)
    grid = np.stack([*np.meshgrid(x, y), np.full((rows + 1, columns + 1), z)], axis=2)
    floor = surface(grid)
    worn = random.random((rows, columns)) < 0.2
    tones = np.where(worn, 2, np.add.outer(np.arange(rows), np.arange(columns)) % 2)
    return Shape(floor.points, floor.faces, tones.reshape(-1).tolist())
