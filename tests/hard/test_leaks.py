"""Thin walls: no light comes through. What the dark side shows is given as a part of the bright side's."""

from collections.abc import Callable

import numpy as np
import pytest

from tests.hard.scenes import Array, Scene, ball, cuboid, diffuse, moved, settings

GROUP = "Leaks"
LEAK = 1e-4

Check = Callable[..., None]
RESOLUTION = 32
CELL = 1.0 / RESOLUTION
"""Of the room that the camera sees (m)."""


def turned(axis: tuple[float, float, float], angle: float) -> Array:
    """A turn about an axis by an angle in degrees (Rodrigues)."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix, radians = np.eye(4), np.radians(angle)
    matrix[:3, :3] += np.sin(radians) * cross + (1.0 - np.cos(radians)) * cross @ cross
    return matrix


def subdivided(shape: tuple[Array, Array], times: int) -> tuple[Array, Array]:
    """Every triangle cut into four, so many times."""
    faces = shape[0][shape[1]]
    for _ in range(times):
        a, b, c = faces[:, 0], faces[:, 1], faces[:, 2]
        ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
        parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = np.concatenate([np.stack(part, axis=1) for part in parts])
    return faces.reshape(-1, 3), np.arange(3 * len(faces), dtype=np.uint32).reshape(-1, 3)


def rooms(thickness: float, turn: Array, side: float, subdivisions: int = 0) -> Scene:
    """Two rooms of one meter with a wall between, the right one lit; the camera is on one side of x = 0."""
    scene = Scene()
    half = 0.5 * thickness
    walls = cuboid((-1.0 - half, 0.0, 0.0), (1.0 + half, 1.0, 1.0))
    scene.add(subdivided(walls, subdivisions), diffuse(0.7), turn)
    scene.add(cuboid((-half, 0.0, 0.0), (half, 1.0, 1.0)), diffuse(0.7), turn)
    scene.lamp(10.0, turn @ moved(0.4, 0.5, 0.6))
    eye, target = (
        (turn @ (side * (x + half), y, z, 1.0))[:3] for x, y, z in ((0.9, 0.1, 0.8), (0.1, 0.6, 0.1))
    )
    scene.look(eye, target, 1.0)
    return scene


TURNS = {
    "aligned": turned((0, 0, 1), 0.0),
    "turned by 17°": turned((0, 0, 1), 17.0),
    "turned by 41° about (1, 2, 3)": turned((1, 2, 3), 41.0),
}


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("cells", [0.2, 1.0, 3.0])
def test_two_rooms(check: Check, edge: Callable[..., None], cells: float, turn: str) -> None:
    values = settings(photon_pass__photon_count=200_000, pyramid__finest_resolution=RESOLUTION)

    def leak(cells: float) -> float:
        dark, lit = (rooms(cells * CELL, TURNS[turn], side).render(values) for side in (-1.0, 1.0))
        return dark.mean / lit.mean

    case = f"wall of {cells:g} cells, {turn}"
    check(case, expected=0.0, got=leak(cells), bound=LEAK)
    if cells == 1.0:
        edge(case, [1.0, 0.5, 0.2, 0.1, 0.05, 0.02], leak, unit=" cells")


@pytest.mark.parametrize("turn", TURNS)
def test_thin_wall_on_small_triangles(check: Check, edge: Callable[..., None], turn: str) -> None:
    """As above; each cell holds dozens of the triangles that the walls of the rooms are made of."""
    values = settings(photon_pass__photon_count=200_000, pyramid__finest_resolution=RESOLUTION)

    def leak(cells: float) -> float:
        sides = (rooms(cells * CELL, TURNS[turn], side, 7).render(values) for side in (-1.0, 1.0))
        dark, lit = (picture.mean for picture in sides)
        return dark / lit

    case = f"wall of 0.2 cells on small triangles, {turn}"
    check(case, expected=0.0, got=leak(0.2), bound=LEAK)
    edge(case, [0.5, 0.2, 0.1, 0.05], leak, unit=" cells")


@pytest.mark.parametrize("cells", [0.2, 1.0])
def test_three_shells(check: Check, cells: float) -> None:
    """Balls within each other, lit from outside; the gaps are as wide as the walls of `test_two_rooms`."""
    gap = cells * 2.0 / RESOLUTION

    def light(eye: tuple[float, float, float], target: tuple[float, float, float]) -> float:
        scene = Scene()
        for shell in range(3):
            scene.add(ball(4, 1.0 - shell * gap), diffuse(0.7))
        scene.add(cuboid((-2.0, -2.0, -2.0), (2.0, 2.0, 2.0)), diffuse(0.7))
        scene.lamp(10.0, moved(1.5, 0.4, 0.3))
        scene.look(eye, target, 0.5)
        values = settings(photon_pass__photon_count=200_000, pyramid__finest_resolution=RESOLUTION)
        return scene.render(values).mean

    ratio = light((0.0, 0.0, 0.0), (1.0, 0.2, 0.1)) / light((1.9, 0.0, 0.0), (1.0, 0.0, 0.0))
    check(f"inside three shells {cells:g} cells apart", expected=0.0, got=ratio, bound=LEAK)
