"""Borders of cells, levels and normal classes: none of them is to be seen."""

from collections.abc import Callable

import numpy as np
import pytest

from tests.hard.scenes import Scene, ball, closure, diffuse, glowing, moved, quad, settings

GROUP = "Seams"

Check = Callable[..., None]


@pytest.mark.parametrize("classes", ["6", "54"])
@pytest.mark.parametrize("rays", [16, 256])
def test_a_curved_wall_is_flat(check: Check, classes: str, rays: int) -> None:
    """A ball that glows from within looks the same everywhere, whichever classes and levels its light is read from."""
    scene = Scene()
    scene.add(ball(5), glowing(0.5))
    scene.look((0.2, -0.1, 0.05), (1.0, 0.7, 0.5), 2.0, pixels=(32, 32))
    picture = scene.render(
        settings(
            photon_pass__photon_count=1_000_000,
            pyramid__normal_classes=classes,
            gather__rays=rays,
            gather__camera_samples=16,
        )
    )
    # Parts of 8 x 8 pixels: noise of single pixels is none of a seam.
    parts = picture.indirect[..., 0].astype(np.float64).reshape(4, 8, 4, 8).mean(axis=(1, 3))
    worst = parts.flat[np.abs(parts - 0.5).argmax()]
    check(f"inside of a ball, {classes} classes, {rays} rays", expected=0.5, got=worst, bound=0.005)


def test_a_mirror_shows_no_cells(check: Check, edge: Callable[..., None]) -> None:
    """A floor under a lamp, seen in a mirror: I cos / d² to the last pixel, on a pyramid of hardly any cells."""
    albedo, height, power = 0.8, 0.5, 10.0

    def worst(resolution: float) -> float:
        scene = Scene()
        scene.add(quad(1.0), diffuse(albedo))
        mirror = np.array([[0, 0, -1, 1], [0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1.0]])
        scene.add(quad(1.0), [closure("glossy", color=1.0, roughness=0.0)], mirror)
        scene.lamp(power, moved(0.0, 0.0, height))
        eye, pixels = np.array((0.5, 0.0, 0.5)), 24
        scene.look(eye, eye + np.array((1.0, 0.0, -1.0)), 0.2, pixels=(pixels, pixels))
        values = settings(
            pyramid__finest_resolution=int(resolution), gather__camera_samples=16, effects__caustics="off"
        )
        got = scene.render(values).gray
        # Through the center of each pixel to the floor behind the mirror, and back in front of it.
        along = (np.arange(pixels) + 0.5) / pixels * 0.4 - 0.2
        forward, right, up = (
            np.array((1, 0, -1)) / np.sqrt(2),
            np.array((0, -1, 0)),
            np.array((1, 0, 1)) / np.sqrt(2),
        )
        rays = forward + along[None, :, None] * right + along[:, None, None] * up
        floor = eye + rays * (-eye[2] / rays[..., 2])[..., None]
        floor[..., 0] = 2.0 - floor[..., 0]
        square = (floor[..., :2] ** 2).sum(axis=-1) + height**2
        expected = albedo / np.pi * power / (4.0 * np.pi) * height / square**1.5
        # The mirror begins where the floor ends.
        seen = (eye + rays * (-eye[2] / rays[..., 2])[..., None])[..., 0] > 1.02
        return float(np.abs(got / expected - 1.0)[seen].max())

    case = "a lit floor in a mirror"
    check(case, expected=0.0, got=worst(8), bound=0.01)
    edge(case, [64, 16, 4, 2, 1], worst, unit=" cells")
