"""Corners, edges and contacts, where cells hold the light of surfaces that a point nearby does not see.

Every scene has a closed form that is constant up to the corner. Seen is a strip of a few cells or less along it, and
only the light scattered twice or more, which is the pyramid's: its mean, and the worst of its pixels.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tests.hard.scenes import Array, Scene, cuboid, diffuse, glowing, settings

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
COLUMNS_AND_ROWS = (48, 6)


def strip(scene: Scene, eye: Any, target: Any, size: tuple[float, float], up: Any) -> None:
    """Shows a strip of this length and depth (m) around `target`, in six rows along the corner. It is a part of a frame
    of two meters: cells are as fine as if all of that were seen."""
    columns, rows = COLUMNS_AND_ROWS
    pixels = (2 * round(columns / size[0]), 2 * round(rows / size[1]))
    region = ((pixels[0] - columns) // 2, (pixels[1] - rows) // 2, columns, rows)
    scene.look(eye, target, 1.0, pixels=pixels, orthographic=True, region=region, up=up, tall=1.0)


def points(check: Check, case: str, scene: Scene, expected: float, photons: int = PHOTONS) -> None:
    """Two rows: the mean of a view and the worst of its rows, which differ in their distance from the corner."""
    picture = scene.render(fine(photons), 600.0)
    rows = picture.indirect[..., 0].astype(np.float64).mean(axis=1)
    check(case, expected=expected, got=rows.mean(), bound=MEAN)
    worst = rows[np.abs(rows - expected).argmax()]
    check(f"{case}: worst point", expected=expected, got=worst, bound=WORST)


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
    size = (0.13, depth)
    if on_disk:
        middle = radius - 3e-3 - depth / 2.0
        strip(scene, (middle, 0.0, height + 1e-3), (middle, 0.0, height), size, (1.0, 0.0, 0.0))
    else:
        middle = height + 1e-4 + depth / 2.0
        strip(scene, (radius - 0.1, 0.0, middle), (1.0, 0.0, middle), size, (0.0, 0.0, 1.0))
    angle = np.degrees(np.arccos(height))
    case = f"rim of {angle:.0f}°, {'disk' if on_disk else 'cap'}, {photons:g} photons"
    points(check, case, scene, seen_twice / np.pi, photons)


@HEAVY
@pytest.mark.parametrize("angle", [120, 150, 170])
def test_wedge(check, angle):
    """Two half planes of albedo ρ under a sky of radiance 1 see each other by the share F = (1 + cos) / 2."""
    rho, share = 0.7, (1.0 + np.cos(np.radians(angle))) / 2.0
    expected = rho * (1.0 - share) * (1.0 / (1.0 - rho * share) - 1.0)
    x, z = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    scene = Scene()
    floor = [(0, -1, 0), (1, -1, 0), (1, 1, 0), (0, 1, 0)]
    wall = [(0, 1, 0), (x, 1, z), (x, -1, z), (0, -1, 0)]
    scene.add(quads([floor, wall]), diffuse(rho))
    scene.world(1.0)
    half = np.radians(angle) / 2.0
    # From the open side, along the bisector, 1 to 5 mm from the edge.
    target, back = np.array((3e-3, 0.0, 0.0)), 3.0 * np.array((np.cos(half), 0.0, np.sin(half)))
    strip(scene, target + back, target, (0.8, 4e-3 * np.sin(half)), (0.0, 0.0, 1.0))
    points(check, f"wedge of {angle}°", scene, expected)


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
