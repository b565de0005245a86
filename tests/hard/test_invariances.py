"""What must not change the picture, or change it by a known factor. Bitwise where arithmetic allows."""

import numpy as np
import pytest
import rgp_core

from rgp_engine import native
from tests.hard.scenes import (
    Picture,
    Scene,
    closure,
    cuboid,
    diffuse,
    looking,
    moved,
    render,
    scaled,
    settings,
)

GROUP = "Invariances"
POWER = 5.0
GLOSSY = [closure("glossy", color=0.8, roughness=0.7)]


def walls():
    """Six meshes of two triangles."""
    corners, triangles = cuboid((-1, -1, -1), (1, 1, 1))
    return [
        (corners[np.unique(pair)], np.searchsorted(np.unique(pair), pair))
        for pair in triangles.reshape(6, 2, 3)
    ]


def split(shape):
    """Every triangle cut into four."""
    corners, triangles = shape
    a, b, c = (corners[triangles[:, i]] for i in range(3))
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    soup = np.concatenate([np.stack(part, axis=1) for part in parts]).reshape(-1, 3)
    return soup, np.arange(len(soup)).reshape(-1, 3)


def room(*, scale=1.0, power=POWER, lamps=1, matrix=None, change=lambda shapes: shapes) -> Scene:
    """A room of 2 m with an area lamp, a box and a glossy box in it, scaled, then moved by a matrix."""
    world = (np.eye(4) if matrix is None else matrix) @ scaled(scale, scale, scale)
    scene = Scene()
    boxes = [cuboid((-0.5, -0.3, -1), (0, 0.3, -0.2)), cuboid((0.3, -0.6, -1), (0.7, -0.1, 0.1))]
    shapes = [(shape, diffuse(0.3 + 0.1 * i)) for i, shape in enumerate(walls())]
    shapes += [(boxes[0], diffuse(0.6)), (boxes[1], GLOSSY)]
    for shape, closures in change(shapes):
        scene.add(shape, closures, world)
    at = world @ looking((0, 0, 0.95), (0, 0, 0), (0, 1, 0))
    for _ in range(lamps):
        scene.lamp(power / lamps, at, "rectangle", size=[0.5, 0.5])
    eye, target = ((world @ (*p, 1.0))[:3] for p in ((-0.8, -0.7, 0.3), (0.3, 0.3, -0.3)))
    scene.look(eye, target, 0.9, pixels=(24, 24), up=world[:3, 2])
    return scene


def bits_that_differ(one, other, factor: float = 1.0) -> int:
    """Channels of either picture that differ, the light of the first multiplied."""
    pairs = ((one.combined[..., :3], other.combined[..., :3]), (one.indirect, other.indirect))
    return sum(int((np.float32(factor) * a != b).sum()) for a, b in pairs)


def noise_ratio(one, other) -> float:
    """Root mean square of the difference of two pictures over that of the same with another seed."""
    reseeded = room().render(settings(render__seed=1))
    plain = room().render()
    rms = lambda a, b: float(np.sqrt(np.mean((a.gray - b.gray) ** 2)))  # noqa: E731
    return rms(one, other) / rms(plain, reseeded)


@pytest.mark.parametrize("exponent", [-10, 4])
def test_size(check, exponent):
    """Twice the size at the same watts is a quarter of the irradiance."""
    scale = 2.0**exponent
    differing = bits_that_differ(room(scale=scale).render(), room().render(), scale * scale)
    check(f"geometry scaled by 2^{exponent}: bits that differ", expected=0.0, got=differing, bound=0.0)


@pytest.mark.parametrize("scale", [0.3, 7.0])
def test_odd_size(check, scale):
    """The cells keep their place in the world: the picture is another, equally good one."""
    mean = room(scale=scale, power=POWER * scale * scale).render().mean
    check(f"geometry scaled by {scale:g}", expected=room().render().mean, got=mean, bound=0.003)


@pytest.mark.parametrize("exponent", [-20, 12])
def test_brightness(check, edge, exponent):
    differing = lambda k: bits_that_differ(room().render(), room(power=POWER * 2.0**k).render(), 2.0**k)  # noqa: E731
    case = f"light times 2^{exponent}: bits that differ"
    check(case, expected=0.0, got=differing(exponent), bound=0.0)
    step = 10 if exponent > 0 else -10
    edge(case, range(exponent, 12 * step, step), lambda k: float(differing(k)), unit=" (exponent)")


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("objects in reverse", lambda shapes: shapes[::-1]),
        ("triangles in reverse", lambda shapes: [((c, t[::-1]), m) for (c, t), m in shapes]),
    ],
)
def test_order(check, name, change):
    differing = bits_that_differ(room().render(), room(change=change).render())
    check(f"{name}: bits that differ", expected=0.0, got=differing, bound=0.0)


def test_split_triangles(check):
    other = room(change=lambda shapes: [(split(shape), closures) for shape, closures in shapes]).render()
    one = room().render()
    check("every triangle split into four", expected=one.mean, got=other.mean, bound=0.003)
    check("every triangle split into four: noise", expected=0.0, got=noise_ratio(one, other), bound=1.5)


def test_split_lamps(check):
    many = settings(photon_pass__photon_count=400_000, gather__camera_samples=64)
    one, other = room().render(many), room(lamps=2).render(many)
    check("one lamp or two halves", expected=one.mean, got=other.mean, bound=0.003)
    check("one lamp or two halves: noise", expected=0.0, got=noise_ratio(one, other), bound=1.5)


TURNS = {
    "x": [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
    "y": [[0, 0, 1], [0, 1, 0], [-1, 0, 0]],
    "z": [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
}


@pytest.mark.parametrize("axis", TURNS)
def test_quarter_turn(check, axis):
    matrix = np.eye(4)
    matrix[:3, :3] = TURNS[axis]
    values = settings(photon_pass__photon_count=1_000_000)
    one, other = room().render(values), room(matrix=matrix).render(values)
    check(f"a quarter turn about {axis}", expected=one.mean, got=other.mean, bound=0.003)
    check(f"a quarter turn about {axis}: noise", expected=0.0, got=noise_ratio(one, other), bound=1.5)


@pytest.mark.parametrize("shift", [(0.02, 0.03, 0.01), (1e6 + 0.02, -1e6 + 0.03, 3e5 + 0.01)])
def test_translation(check, shift):
    one, other = room().render(), room(matrix=moved(*shift)).render()
    case = f"moved by {np.hypot(*shift[:2]):.3g} m"
    check(case, expected=one.mean, got=other.mean, bound=0.003)
    check(f"{case}: noise", expected=0.0, got=noise_ratio(one, other), bound=1.5)


@pytest.mark.parametrize(("threads", "tile"), [(1, 64), (2, 8), (7, 20), (5, 4096)])
def test_threads_and_tiles(check, threads, tile):
    scene = room().builder.finish()
    other = render(scene, settings(render__threads=threads, film__tile_size=tile))
    differing = bits_that_differ(render(scene), other)
    check(f"{threads} threads, tiles of {tile}: bits that differ", expected=0.0, got=differing, bound=0.0)


def test_resuming(check):
    """Stopped after two of sixteen passes, and taken up by a session of its own."""
    scene = room().builder.finish()
    values, embree = settings(gather__camera_samples=16), str(native.embree_library())
    stopped = rgp_core.Session(scene, settings(gather__camera_samples=16, gather__time_limit=1e-3), embree)
    stopped.start()
    assert stopped.finish()
    passes, sums = stopped.film_state()
    assert passes == 2
    resumed = rgp_core.Session(scene, values, embree)
    assert resumed.fingerprint() == stopped.fingerprint()
    resumed.restore_film(passes, sums)
    resumed.start()
    assert resumed.finish()
    other = Picture(resumed.picture("combined"), resumed.picture("indirect"), resumed.stats(), [])
    differing = bits_that_differ(render(scene, values), other)
    check(
        "stopped after 2 of 16 passes and resumed: bits that differ", expected=0.0, got=differing, bound=0.0
    )


def test_twenty_seeds(check):
    """The scatter of twenty pictures is the error that each of them prints, which is too high rather than too low."""
    scene = room().builder.finish()
    pictures = [render(scene, settings(render__seed=seed, gather__camera_samples=16)) for seed in range(20)]
    stack = np.stack([picture.combined[..., :3] for picture in pictures]).astype(np.float64)
    scatter = 100.0 * np.sqrt(stack.var(axis=0, ddof=1).mean()) / stack.mean()
    printed = np.sqrt(np.mean([picture.stats["error"]["rms_mean"] ** 2 for picture in pictures]))
    check(
        "scatter of twenty seeds over the printed error", expected=1.0, got=scatter / printed, bound=1.0 / 3.0
    )
