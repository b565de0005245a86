"""Geometry tools of the larger scenes: turned, swept, bent and boxed shapes as plain points and faces, in metres.

A shape is made around its own origin, then moved; z is up. Faces look outwards when the curves that make them run as
the functions say. Nothing here needs a scene but `add_shape` and `add_copies`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import bpy
import numpy as np
import numpy.typing as npt

from scenes import common

Points = npt.NDArray[np.float64]
Curve = Sequence[tuple[float, float]] | Points
CREASE = math.radians(35.0)
"""Edges whose faces meet at a larger angle are shaded as edges, all others as parts of a smooth surface (rad)."""
WELD = 1e-7
"""Points of one surface that are closer than this are one point (m)."""


@dataclass
class Shape:
    """A mesh without a name."""

    points: Points
    """(V, 3)"""
    faces: list[tuple[int, ...]]
    """Indices of the corners, counterclockwise as seen from outside."""
    slots: list[int]
    """Index of the material of each face."""


def join(shapes: Iterable[Shape]) -> Shape:
    """All shapes as one; their points stay apart."""
    points: list[Points] = []
    faces: list[tuple[int, ...]] = []
    slots: list[int] = []
    first = 0
    for shape in shapes:
        points.append(shape.points)
        faces += [tuple(first + corner for corner in face) for face in shape.faces]
        slots += shape.slots
        first += len(shape.points)
    return Shape(np.concatenate(points), faces, slots)


def in_slot(shape: Shape, slot: int) -> Shape:
    """The shape, all of one material."""
    return Shape(shape.points, shape.faces, [slot] * len(shape.faces))


def moved(
    shape: Shape, location: common.Point = (0.0, 0.0, 0.0), turn: float = 0.0, size: float = 1.0
) -> Shape:
    """The shape scaled, turned about z (rad), then moved."""
    return mapped(shape, lambda points: size * points @ rotation(turn, 2).T + np.array(location))


def turned(shape: Shape, angle: float, axis: int) -> Shape:
    """The shape turned by `angle` (rad) about axis 0, 1 or 2."""
    return mapped(shape, lambda points: points @ rotation(angle, axis).T)


def mapped(shape: Shape, function: Callable[[Points], Points]) -> Shape:
    """The shape with `function` applied to its points, (V, 3) to (V, 3). It must not turn the shape inside out."""
    return Shape(function(shape.points), shape.faces, shape.slots)


def rotation(angle: float, axis: int) -> Points:
    """The 3×3 matrix that turns by `angle` (rad) about axis 0, 1 or 2."""
    matrix = np.eye(3)
    u, v = (axis + 1) % 3, (axis + 2) % 3
    matrix[u, u] = matrix[v, v] = math.cos(angle)
    matrix[v, u] = math.sin(angle)
    matrix[u, v] = -math.sin(angle)
    return matrix


def smooth_curve(controls: Sequence[Sequence[float]], steps: int) -> Points:
    """A curve through all control points (Catmull and Rom), `steps` pieces between two of them: (P, dimensions)."""
    points = np.array(controls, float)
    before, after = 2.0 * points[0] - points[1], 2.0 * points[-1] - points[-2]
    p = np.vstack([before, points, after])
    t = np.arange(steps)[:, None] / steps
    pieces = [
        p1 + 0.5 * t * (p2 - p0 + t * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3 + t * (3.0 * (p1 - p2) + p3 - p0)))
        for p0, p1, p2, p3 in zip(p, p[1:], p[2:], p[3:])
    ]
    return np.vstack([*pieces, points[-1:]])


def surface(points: Points, wrap_rows: bool = False, wrap_columns: bool = False) -> Shape:
    """Four-sided faces over rows and columns of points, (R, C, 3). Points that coincide are welded, which makes
    triangles at poles. The normal is along (next column) × (next row)."""
    rows, columns, _ = points.shape
    kept: dict[tuple[int, ...], int] = {}
    flat = points.reshape(-1, 3)
    index = [
        kept.setdefault(tuple(key), len(kept)) for key in np.round(flat / WELD).astype(np.int64).tolist()
    ]
    faces = []
    for row in range(rows if wrap_rows else rows - 1):
        below, above = row * columns, (row + 1) % rows * columns
        for column in range(columns if wrap_columns else columns - 1):
            following = (column + 1) % columns
            corners = (below + column, below + following, above + following, above + column)
            face = tuple(dict.fromkeys(index[corner] for corner in corners))
            if len(face) > 2:
                faces.append(face)
    welded = np.zeros((len(kept), 3))
    welded[index] = flat
    return Shape(welded, faces, [0] * len(faces))


def lathe(profile: Curve, segments: int) -> Shape:
    """A profile of (radius, height), turned about z. The outside is on the right of the profile's way."""
    curve = np.array(profile, float)
    angles = np.linspace(0.0, 2.0 * math.pi, segments, endpoint=False)
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = np.empty((len(curve), segments, 3))
    points[:, :, :2] = curve[:, None, :1] * ring
    points[:, :, 2] = curve[:, 1:]
    return surface(points, wrap_columns=True)


def sweep(
    section: Curve, path: Sequence[Sequence[float]] | Points, up: common.Point, closed: bool = False
) -> Shape:
    """A closed section carried along a path, (P, 3), and capped at its ends unless the path is `closed`.

    The section's y is as near `up` as the path allows, its x is to the left of one who walks the path: up × path. It
    runs counterclockwise in x and y. Kinks of the path are mitered.
    """
    points, outline = np.array(path, float), np.array(section, float)
    if closed:
        pieces = _normalized(np.roll(points, -1, axis=0) - points)
        before, after = np.roll(pieces, 1, axis=0), pieces
    else:
        pieces = _normalized(np.diff(points, axis=0))
        before, after = np.vstack([pieces[:1], pieces]), np.vstack([pieces, pieces[-1:]])
    along = _normalized(before + after)
    side = _normalized(np.cross(np.array(up, float), along))
    upward = np.cross(along, side)
    # Only what lies across the kink is stretched: the part of the section along the bisector.
    bend = after - before
    stretch = 1.0 / np.sqrt(np.maximum(0.5 + 0.5 * np.sum(before * after, axis=1), 0.1)) - 1.0
    length = np.linalg.norm(bend, axis=1, keepdims=True)
    bisector = np.divide(bend, length, out=np.zeros_like(bend), where=length > 1e-9)
    offsets = outline[None, :, :1] * side[:, None] + outline[None, :, 1:] * upward[:, None]
    across = np.sum(offsets * bisector[:, None], axis=2, keepdims=True) * bisector[:, None]
    grid = points[:, None] + offsets + stretch[:, None, None] * across
    swept = surface(grid, wrap_rows=closed, wrap_columns=True)
    if closed:
        return swept
    return join([swept, _cap(grid[0][::-1]), _cap(grid[-1])])


def tube(
    path: Sequence[Sequence[float]] | Points, radii: float | Sequence[float] | Points, sides: int
) -> Shape:
    """A round bar along a path, (P, 3), that may turn anywhere; one radius or one per point. The ends are capped."""
    points = np.array(path, float)
    along = _normalized(np.gradient(points, axis=0))
    side = np.cross(along[0], np.eye(3)[np.argmin(np.abs(along[0]))])
    angles = np.linspace(0.0, 2.0 * math.pi, sides, endpoint=False)[:, None]
    rings = []
    for point, direction, radius in zip(points, along, np.broadcast_to(radii, len(points))):
        side = side - direction * (side @ direction)
        side = side / np.linalg.norm(side)
        rings.append(point + radius * (np.cos(angles) * side + np.sin(angles) * np.cross(direction, side)))
    return join([surface(np.array(rings), wrap_columns=True), _cap(rings[0][::-1]), _cap(rings[-1])])


def sheet(points: Points, thickness: float) -> Shape:
    """A closed sheet: the surface over (R, C, 3) points and its underside, `thickness` along the inner normal."""
    normal = _normalized(np.cross(np.gradient(points, axis=1), np.gradient(points, axis=0)))
    below = points - thickness * normal
    rim = np.concatenate([points[0, :-1], points[:-1, -1], points[-1, :0:-1], points[:0:-1, 0]])
    rim_below = np.concatenate([below[0, :-1], below[:-1, -1], below[-1, :0:-1], below[:0:-1, 0]])
    edge = surface(np.stack([rim_below, rim]), wrap_columns=True)
    return join([surface(points), surface(below[:, ::-1]), edge])


def box(low: common.Point, high: common.Point, chamfer: float = 0.0) -> Shape:
    """An axis-aligned box; `chamfer` is how much of each edge is cut off at 45 degrees (m)."""
    if chamfer == 0.0:
        faces = common.box_faces(low, high)
        corners = [corner for face in faces for corner in face]
        return Shape(np.array(corners), [tuple(range(i, i + 4)) for i in range(0, 24, 4)], [0] * 6)
    (x0, y0, z0), (x1, y1, z1) = low, high
    c = chamfer
    rings = [
        (x0 + c, y0 + c, x1 - c, y1 - c, z0),
        (x0, y0, x1, y1, z0 + c),
        (x0, y0, x1, y1, z1 - c),
        (x0 + c, y0 + c, x1 - c, y1 - c, z1),
    ]
    grid = np.array([_octagon(*ring, c) for ring in rings])
    return join([surface(grid, wrap_columns=True), _cap(grid[0][::-1]), _cap(grid[-1])])


def rectangle_rings(rings: Sequence[tuple[float, float, float, float, float]], wrap: bool = True) -> Shape:
    """Nested rectangles (low x, low y, high x, high y, z) joined one to the next, the last to the first if `wrap`:
    frames, moldings around a room, walls with an opening. The outside is on the right of their way from axis to rim."""
    points = [[(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)] for x0, y0, x1, y1, z in rings]
    return surface(np.array(points), wrap_rows=wrap, wrap_columns=True)


def prism(outline: Curve, low: float, high: float) -> Shape:
    """A counterclockwise outline in x and y, carried from height `low` to `high`, with both ends."""
    flat = np.array(outline, float)
    grid = np.stack([np.column_stack([flat, np.full(len(flat), height)]) for height in (low, high)])
    return join([surface(grid, wrap_columns=True), _cap(grid[0][::-1]), _cap(grid[1])])


def add_shape(
    name: str, shape: Shape, materials: Sequence[bpy.types.Material], crease: float = CREASE
) -> bpy.types.Object:
    """An object of the shape; edges sharper than `crease` (rad) are shaded as edges."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(shape.points.tolist(), [], shape.faces)
    for material in materials:
        mesh.materials.append(material)
    mesh.polygons.foreach_set("material_index", shape.slots)
    mesh.polygons.foreach_set("use_smooth", [True] * len(shape.faces))
    mesh.set_sharp_from_angle(angle=crease)
    return common.add_object(name, mesh)


def add_copies(original: bpy.types.Object, places: Sequence[tuple[common.Point, float]]) -> None:
    """Instances: more objects that share the original's mesh, each at a location and turned about z (rad)."""
    for location, turn in places:
        copy = common.add_object(original.name, original.data)
        copy.location, copy.rotation_euler = location, (0.0, 0.0, turn)


def _normalized(vectors: Points) -> Points:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def _cap(ring: Points) -> Shape:
    """One face with many corners."""
    return Shape(np.array(ring), [tuple(range(len(ring)))], [0])


def _octagon(x0: float, y0: float, x1: float, y1: float, z: float, c: float) -> list[common.Point]:
    """A rectangle with its corners cut, counterclockwise."""
    return [
        (x0 + c, y0, z),
        (x1 - c, y0, z),
        (x1, y0 + c, z),
        (x1, y1 - c, z),
        (x1 - c, y1, z),
        (x0 + c, y1, z),
        (x0, y1 - c, z),
        (x0, y0 + c, z),
    ]
