"""Corners, edges and contacts, where cells hold the light of surfaces that a point nearby does not see.

Every scene has a closed form that is constant up to the corner, or planes whose end a radiosity solution knows. Seen
is a strip of a few cells or less along it, and only the light scattered twice or more, the pyramid's: its mean,
and the worst of its rows.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tests.hard.radiosity import Face, scattered_twice, shrinking
from tests.hard.scenes import Array, Scene, ball, cuboid, diffuse, glowing, moved, settings

GROUP = "Corners"
MEAN, WORST = 0.01, 0.04

Check = Callable[..., None]
Shape = tuple[Array, Array]


def fine(photons: int) -> dict[str, dict[str, Any]]:
    """The rays and cells the bounds are promised for."""
    return settings(
        photon_pass__photon_count=photons,
        pyramid__finest_resolution=128,
        gather__rays=1024,
        gather__camera_samples=16,
    )


PHOTONS = 4_000_000
COLUMNS, ROWS = 48, 6


def strip(
    scene: Scene, eye: Any, target: Any, size: tuple[float, float], up: Any, columns: int = COLUMNS
) -> None:
    """Shows a strip of this length and depth (m) around `target`, in six rows along the corner. It is a part of a frame
    of two meters: cells are as fine as if all of that were seen."""
    pixels = (2 * round(columns / size[0]), 2 * round(ROWS / size[1]))
    region = ((pixels[0] - columns) // 2, (pixels[1] - ROWS) // 2, columns, ROWS)
    scene.look(eye, target, 1.0, pixels=pixels, orthographic=True, region=region, up=up, tall=1.0)


def points(check: Check, case: str, scene: Scene, expected: float | Array, photons: int = PHOTONS) -> None:
    """Two rows: the mean of a view and the worst of its rows, which differ in their distance from the corner. What is
    expected is the same for all or differs from row to row, counted from the bottom."""
    picture = scene.render(fine(photons), 600.0)
    rows = picture.indirect[..., 0].astype(np.float64).mean(axis=1)
    expected = np.broadcast_to(expected, rows.shape)
    check(case, expected=expected.mean(), got=rows.mean(), bound=MEAN)
    worst = np.abs(rows / expected - 1.0).argmax()
    check(f"{case}: worst point", expected=expected[worst], got=rows[worst], bound=WORST)


def quads(corners: Any) -> Shape:
    """Squares and the like, as pairs of triangles; (N, 4, 3)."""
    corners = np.asarray(corners, np.float64)
    split = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
    triangles = (4 * np.arange(len(corners), dtype=np.uint32)[:, None, None] + split).reshape(-1, 3)
    return corners.reshape(-1, 3), triangles


def cap(height: float, segments: int = 192, rings: int = 64) -> tuple[Shape, Shape]:
    """The part of the unit sphere above a height, and the disk that closes it."""
    around = np.arange(segments + 1) * (2.0 * np.pi / segments)
    angles = np.linspace(np.arccos(height), 0.0, rings + 1)
    grid = np.stack(
        [
            np.outer(np.sin(angles), np.cos(around)),
            np.outer(np.sin(angles), np.sin(around)),
            np.repeat(np.cos(angles)[:, None], segments + 1, axis=1),
        ],
        axis=-1,
    )
    dome = quads(np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], 2).reshape(-1, 4, 3))
    rim = grid[0, :-1]
    disk = np.concatenate([rim, [[0.0, 0.0, height]]])
    index = np.arange(segments, dtype=np.uint32)
    fan = np.stack([index, (index + 1) % segments, np.full(segments, segments)], axis=1)
    return dome, (disk, fan.astype(np.uint32))


HEAVY = pytest.mark.heavy


@pytest.mark.parametrize(
    ("height", "on_disk", "photons"),
    [
        (0.0, False, 400_000),
        *(
            pytest.param(height, on_disk, PHOTONS, marks=HEAVY)
            for height, on_disk in [
                (0.0, False),
                (0.0, True),
                (0.5, False),
                (0.5, True),
                (0.9, False),
                (0.9, True),
                (-0.5, False),
                (-0.5, True),
            ]
        ),
    ],
)
def test_rim_of_a_cap(check, height, on_disk, photons):
    """The cap of albedo ρ sees the disk that glows with M by the share F = (1 + z) / 2 from everywhere."""
    rho, rho_disk, share = 0.7, 0.5, (1.0 + height) / 2.0
    # B = ρ (F (M + ρ' B) + (1 - F) B) with M = 1
    cap_light = rho * share / (1.0 - rho * share * rho_disk - rho * (1.0 - share))
    seen_twice = rho_disk * cap_light if on_disk else cap_light - rho * share
    scene = Scene()
    dome, disk = cap(height)
    scene.add(dome, diffuse(rho))
    scene.add(disk, glowing(rho_disk, 1.0 / np.pi))
    radius, depth = np.sqrt(1.0 - height * height), 0.024
    size = (0.13 if radius > 0.5 else 0.08, depth)
    if on_disk:
        middle = radius - 3e-3 - depth / 2.0
        strip(scene, (middle, 0.0, height + 1e-4), (middle, 0.0, height), size, (1.0, 0.0, 0.0))
    else:
        middle = height + 1e-4 + depth / 2.0
        strip(scene, (radius - 0.1, 0.0, middle), (1.0, 0.0, middle), size, (0.0, 0.0, 1.0))
    angle = np.degrees(np.arccos(height))
    case = f"rim of {angle:.0f}°, {'disk' if on_disk else 'cap'}, {photons:g} photons"
    points(check, case, scene, seen_twice / np.pi, photons)


NEAR, FAR = 1e-3, 5e-3
"""Between these distances (m) from the edges of wedges: within a cell."""


def distances() -> Array:
    """Of the middle of the rows from the edge, nearest first."""
    return NEAR + (np.arange(ROWS) + 0.5) / ROWS * (FAR - NEAR)


OTHERS = [15, 20, 30, 45, 60, 90, 120, 150, 170]


@pytest.mark.parametrize("angle", [10, *(pytest.param(angle, marks=HEAVY) for angle in OTHERS)])
def test_wedge(check, angle):
    """Two planes, 1 m deep and 2 m long, under a sky of radiance 1. Of half planes each sees the other by the share
    F = (1 + cos) / 2, and the light is the same everywhere; these end, which the radiosity solution allows for. Next to
    the edge of an acute one both planes lie in one cell, the lit outside of one beside the dark inside of the other."""
    rho, long = 0.7, np.array((0.0, 2.0, 0.0))
    corner, x, z = np.array((0.0, -1.0, 0.0)), np.cos(np.radians(angle)), np.sin(np.radians(angle))
    faces = [Face(corner, np.array((end, 0.0, up)), long) for end, up in ((1.0, 0.0), (x, z))]
    cuts = shrinking(1e-4, 32), np.linspace(0.0, 1.0, 11)
    length = 1.4
    seen = np.meshgrid(distances()[::-1], length * ((np.arange(4) + 0.5) / 8.0), [0.0], indexing="ij")
    expected = scattered_twice(faces, rho, cuts, np.stack(seen, axis=-1).reshape(-1, 3))
    scene = Scene()
    scene.add(quads([face.outline() for face in faces]), diffuse(rho))
    scene.world(1.0)
    half = np.radians(angle) / 2.0
    # From the open side, along the bisector.
    target, back = np.array(((NEAR + FAR) / 2.0, 0.0, 0.0)), 3.0 * np.array((np.cos(half), 0.0, np.sin(half)))
    strip(scene, target + back, target, (length, (FAR - NEAR) * np.sin(half)), (0.0, 0.0, 1.0), 4 * COLUMNS)
    points(check, f"wedge of {angle}°", scene, expected.reshape(6, -1).mean(axis=1))


@pytest.mark.parametrize("angle", [10, 60, 120])
def test_radiosity_of_a_wedge(angle):
    """Of planes 1,000 times as deep as the distance from their edge it is that of half planes, but for their end."""
    rho, share = 0.7, (1.0 + np.cos(np.radians(angle))) / 2.0
    corner, x, z = np.array((0.0, -64.0, 0.0)), np.cos(np.radians(angle)), np.sin(np.radians(angle))
    faces = [
        Face(corner, 64.0 * np.array(end), np.array((0.0, 128.0, 0.0))) for end in ((1, 0, 0), (x, 0, z))
    ]
    found = scattered_twice(faces, rho, (shrinking(1e-5, 24), np.linspace(0, 1, 6)), np.array([(3e-3, 0, 0)]))
    assert found == pytest.approx(rho * (1.0 - share) * (1.0 / (1.0 - rho * share) - 1.0), rel=3e-3)


@HEAVY
def test_corner_of_three_planes(check):
    """The sky is a quarter of what the floor of a corner of planes without end sees, everywhere. These are squares of
    1 m; seen are the 0.1 m next to the corner, which the photons' own noise leaves 0.6 % off (standard deviation)."""
    rho, axes = 0.7, np.eye(3)
    faces = [Face(np.zeros(3), axes[i], axes[(i + 1) % 3]) for i in range(3)]
    cuts = (shrinking(1e-2, 24),) * 2
    size, steps = 0.1, NEAR + 0.1 * (np.arange(6) + 0.5) / 6.0
    grid = np.stack(np.meshgrid(steps, steps, [0.0], indexing="ij"), axis=-1)
    expected = scattered_twice(faces, rho, cuts, grid.reshape(-1, 3)).reshape(6, 6).mean(axis=1)
    scene = Scene()
    scene.add(quads([face.outline() for face in faces]), diffuse(rho))
    scene.world(1.0)
    middle = NEAR + size / 2.0
    strip(scene, (middle, middle, 3.0), (middle, middle, 0.0), (size, size), (1.0, 0.0, 0.0))
    points(check, "corner of three planes", scene, expected)


def rotated(angle: float) -> Array:
    """About the vertical."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


@HEAVY
@pytest.mark.parametrize("turned", [0.0, 33.0])
@pytest.mark.parametrize("what", ["floor", "side of the box"])
def test_box_on_a_floor(check, what, turned):
    """In a furnace all light is one; no photon comes under the box, and its sides meet the floor."""
    albedo, depth = 0.5, 0.024
    scene = Scene()
    turn = rotated(turned)
    scene.add(cuboid((-1, -1, 0), (1, 1, 1.2)), glowing(albedo), turn)
    scene.add(cuboid((-0.25, -0.25, 0.0), (0.25, 0.25, 0.5)), glowing(albedo), turn)
    beside, above = 0.251 + depth / 2.0, 1e-4 + depth / 2.0
    on_floor = ((beside, 0.0, 0.3), (beside, 0.0, 0.0), (1.0, 0.0, 0.0))
    on_side = ((0.5, 0.0, above), (0.25, 0.0, above), (0.0, 0.0, 1.0))
    eye, target, up = on_floor if what == "floor" else on_side
    eye, target, up = ((turn @ (*p, w))[:3] for p, w in ((eye, 1.0), (target, 1.0), (up, 0.0)))
    strip(scene, eye, target, (0.4, depth), up)
    case = f"box on a floor, {what}, turned by {turned:g}°"
    points(check, case, scene, albedo * albedo / (1.0 - albedo))


@HEAVY
@pytest.mark.parametrize(("near", "far"), [(0.001, 0.005), (0.005, 0.025)])
@pytest.mark.parametrize("what", ["floor", "ball"])
def test_ball_on_a_floor(check, what, near, far):
    """In a furnace, where a ball of 0.25 m touches the floor: at 0.005 m from there they are 0.05 mm apart."""
    albedo, radius, middle = 0.5, 0.25, (near + far) / 2.0
    scene = Scene()
    scene.add(cuboid((-1, -1, 0), (1, 1, 1.2)), glowing(albedo))
    scene.add(ball(6, radius), glowing(albedo), moved(0.0, 0.0, radius))
    # Between ball and floor a view has to graze: from floor past ball, or level below the ball's rise.
    steep = 0.8 * near / radius
    height = 0.0 if what == "floor" else (near * near + far * far) / (4.0 * radius)
    back = np.array((np.cos(steep), 0.0, np.sin(steep) if what == "floor" else 0.0))
    depth = (far - near) * np.sin(steep) if what == "floor" else (far * far - near * near) / (2.0 * radius)
    target = np.array((middle, 0.0, height))
    strip(scene, target + 0.6 * back, target, (0.002, depth), (0.0, 0.0, 1.0))
    case = f"ball on a floor, {what}, {1e3 * near:g} to {1e3 * far:g} mm from where they touch"
    points(check, case, scene, albedo * albedo / (1.0 - albedo))
