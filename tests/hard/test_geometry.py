"""Geometry at its extremes, in a furnace: a closed room where every surface glows and reflects has one radiance."""

from collections.abc import Callable

import numpy as np
import pytest

from tests.hard.scenes import (
    Scene,
    ball,
    cuboid,
    diffuse,
    furnace,
    glowing,
    looking,
    moved,
    quad,
    render,
    scaled,
    settings,
)

GROUP = "Geometry"
EXACT = 2.0
"""Radiance of a furnace of albedo one half."""
MEAN, SPREAD = 0.005, 0.02
"""Bounds of the mean and of the root mean square of single pixels, in which noise and single bad cells are."""

Check = Callable[..., None]


def uniform(check: Check, case: str, picture, expected: float = EXACT, mean=MEAN, spread=SPREAD) -> None:
    check(case, expected=expected, got=picture.mean, bound=mean)
    check(f"{case}: pixels", expected=0.0, got=picture.spread(expected), bound=spread)


def off(picture, expected: float = EXACT) -> float:
    """Deviation of a picture for the search of edges: of the mean, or a quarter of the pixels' where that is more."""
    return max(abs(picture.mean / expected - 1.0), picture.spread(expected) / 4.0)


def room(size: float, position=(0.0, 0.0, 0.0), albedo: float = 0.5) -> Scene:
    """A furnace of another size elsewhere, with its camera."""
    scene = Scene()
    matrix = moved(*position) @ scaled(size, size, size)
    scene.add(cuboid(), glowing(albedo), matrix)
    eye, target = (np.array(p) * size + position for p in ((-0.8, -0.5, 0.2), (1.0, 0.6, 0.6)))
    scene.look(eye, target, 1.5)
    return scene


@pytest.mark.parametrize("size", [1e-4, 1.0, 1e5])
def test_scale(check, edge, size):
    case = f"room of {size:g} m"
    uniform(check, case, room(size).render())
    if size == 1.0:
        return
    step = 0.1 if size < 1.0 else 10.0
    edge(case, [size * step**i for i in range(34)], lambda s: off(room(s).render()), unit=" m")


def test_offset(check, edge):
    case = "room of 1 m, 10⁶ m from the origin"
    at = lambda distance: room(1.0, (distance, -distance, 0.3 * distance))  # noqa: E731
    uniform(check, case, at(1e6).render())
    edge(case, [10.0**i for i in range(6, 17)], lambda d: off(at(d).render()), unit=" m")


def test_offset_in_the_mesh(check, edge):
    """Blender's vertices are single precision: beyond some distance the room itself is no longer a box."""
    case = "vertices 10⁴ m from their object's origin"

    def at(distance: float):
        scene = Scene()
        corners, triangles = cuboid()
        scene.add((corners + distance, triangles), glowing(0.5))
        scene.look(np.array((-0.8, -0.5, 0.2)) + distance, np.array((1.0, 0.6, 0.6)) + distance, 1.5)
        return scene.render()

    uniform(check, case, at(1e4))
    edge(case, [10.0**i for i in range(4, 9)], lambda d: off(at(d)), unit=" m")


def with_extra(corners, seconds=60.0):
    """A furnace with further triangles (T, 3, 3) of its own material in it."""
    scene = furnace()
    corners = np.asarray(corners, np.float64).reshape(-1, 3)
    shape = (corners, np.arange(len(corners), dtype=np.uint32).reshape(-1, 3))
    scene.add(shape, glowing(0.5))
    return scene.render(seconds=seconds)


def slivers(count: int, width: float, length: float = 0.05):
    """Triangles of about that length and width, all over the room."""
    rng = np.random.default_rng(1)
    a = rng.uniform((-0.8, -0.5, 0.2), (0.8, 0.5, 1.0), (count, 3))
    b = a + rng.normal(size=(count, 3)) * (length / np.sqrt(3))
    return np.stack([a, b, b + rng.normal(size=(count, 3)) * width], axis=1)


def test_slivers(check, edge):
    case = "100,000 slivers, 5 cm long, 1 µm wide"
    uniform(check, case, with_extra(slivers(100_000, 1e-6)))
    long = lambda length: off(with_extra(slivers(20_000, 1e-6, length), 15.0))  # noqa: E731
    edge(case, [0.05, 0.1, 0.2, 0.4, 0.8], long, unit=" m long, by the 20,000")


def test_triangles_without_area(check):
    points = np.random.default_rng(2).uniform(-0.5, 0.5, (100_000, 1, 3))
    picture = with_extra(np.repeat(points, 3, axis=1))
    uniform(check, "100,000 triangles without area", picture)
    check(
        "100,000 triangles without area: reported", expected=1e5, got=picture.told("without area"), bound=0.0
    )


@pytest.mark.parametrize("copies", [2, 5])
def test_coincident_duplicates(check, copies):
    """The light lands on one copy; counted on all, their area would darken the room."""
    corners, triangles = cuboid()
    scene = Scene()
    scene.add((corners, np.tile(triangles, (copies, 1))), glowing(0.5))
    uniform(check, f"every face {copies} times", scene.render())


def test_coincident_objects(check):
    scene = furnace()
    scene.add(cuboid(), glowing(0.5))
    uniform(check, "two objects in one place", scene.render())


def test_inverted_faces(check):
    corners, triangles = cuboid()
    triangles[::2] = triangles[::2, ::-1]
    scene = Scene()
    scene.add((corners, triangles), glowing(0.5))
    uniform(check, "every other face inside out", scene.render())


def test_non_manifold(check):
    """Fins: more faces on an edge than two, faces that cross, and wedges of 12° between them."""
    fins = [[(-1, 0, 0), (1, 0, 0), (0, 0.1 * i, 0.3 + 0.1 * i)] for i in range(-3, 4)]
    uniform(check, "seven faces on one edge", with_extra(fins), mean=0.01)


NOT_NUMBERS = [np.nan, np.inf, -np.inf]


@pytest.mark.parametrize("value", NOT_NUMBERS)
def test_vertices_that_are_not_numbers(check, value):
    corners = np.full((1000, 3, 3), value)
    corners[:, 0] = 0.3
    case = f"1,000 triangles with {value} vertices"
    picture = with_extra(corners)
    uniform(check, case, picture)
    check(f"{case}: reported", expected=1000, got=picture.told("not a number"), bound=0.0)


@pytest.mark.parametrize("value", [*NOT_NUMBERS, 0.0])
def test_normals_that_are_not_numbers(check, value):
    corners, triangles = cuboid()
    scene = Scene()
    normals = np.full((len(triangles), 3, 3), value, np.float32)
    scene.add((corners, triangles), glowing(0.5), corner_normals=normals)
    uniform(check, f"corner normals of {value}", scene.render())


@pytest.mark.parametrize("value", NOT_NUMBERS)
def test_matrices_that_are_not_numbers(check, value):
    scene = furnace()
    matrix = np.eye(4)
    matrix[1, 2] = value
    scene.add(ball(0), glowing(0.5), matrix)
    picture = scene.render()
    uniform(check, f"an object whose matrix holds {value}", picture)
    check(
        f"an object whose matrix holds {value}: reported",
        expected=1,
        got=picture.told("not a number"),
        bound=0.0,
    )


SHEAR = np.array([[1, 0.7, -0.4, 0], [0, 1, 0.6, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])


@pytest.mark.parametrize(
    ("name", "matrix"),
    [
        ("mirrored along x", scaled(-1, 1, 1)),
        ("mirrored along all axes", scaled(-1, -1, -1)),
        ("sheared", SHEAR),
        ("sheared and mirrored", SHEAR @ scaled(1, -1, 1)),
        ("flattened a thousandfold", scaled(1, 1, 1e-3)),
    ],
)
@pytest.mark.parametrize("shared", [False, True], ids=["alone", "instance"])
def test_object_scale(check, name, matrix, shared):
    """A ball in a furnace, deformed; an instance has a mesh in a space of its own. A cell is a fifth of its radius."""
    scene = furnace()
    mesh, material = scene.mesh(ball(2, 0.3)), scene.material(glowing(0.5))
    scene.place(mesh, material, moved(0.2, 0.1, 0.6) @ matrix)
    if shared:
        scene.place(mesh, material, moved(-0.4, 0.2, 0.5) @ matrix @ scaled(0.3, 0.3, 0.3))
    uniform(check, f"ball {name}, {'an instance' if shared else 'alone'}", scene.render(), mean=0.01)


def test_scale_of_zero(check):
    scene = furnace()
    scene.add(ball(2), glowing(0.5), scaled(1, 0, 1))
    picture = scene.render()
    uniform(check, "object of scale 0", picture)
    check("object of scale 0: reported", expected=1, got=picture.told("scale is zero"), bound=0.0)


def cloud(count: int):
    """Small balls of albedo 1 in a uniform world of radiance 0.7, thin enough to see the world everywhere."""
    scene = Scene()
    mesh, material = scene.mesh(ball(0, 0.001)), scene.material(diffuse(1.0))
    rng = np.random.default_rng(3)
    matrix = np.eye(4)
    for position in rng.uniform(-1.0, 1.0, (count, 3)):
        matrix[:3, 3] = position
        scene.builder.add_object("Ball", mesh, matrix, [material], 31)
    scene.world(0.7)
    scene.look((0.0, -4.0, 1.0), (0, 0, 0), 0.3)
    return scene


@pytest.mark.parametrize("count", [1_000, pytest.param(1_000_000, marks=pytest.mark.heavy)])
def test_instances(check, count):
    picture = cloud(count).render(settings(photon_pass__photon_count=1_000_000), 600.0)
    uniform(check, f"{count:,} instances of albedo 1 in a uniform world", picture, 0.7)


def small_beside_large(small: float, height: float = 1.0):
    """A small square `height` sides above a plane of 1,000 km, both of albedo ½ under a uniform world of radiance 1."""
    scene = Scene()
    scene.add(quad(5e5), diffuse(0.5))
    scene.add(quad(small / 2), diffuse(0.5), moved(0, 0, small * height))
    scene.world(1.0)
    scene.look((0, 0, small * (height + 1)), (0, 0, small * height), 0.25 * small, orthographic=True)
    return scene


def test_small_beside_large(check, edge):
    """Convex and seen from above: each reflects half of the world, exactly, wherever it is."""
    case = "1 mm beside 1,000 km"
    uniform(check, case, small_beside_large(1e-3).render(), 0.5, 1e-4, 1e-4)
    deviation = lambda s: off(small_beside_large(s).render(), 0.5)  # noqa: E731
    edge(case, [10.0**-i for i in range(3, 12)], deviation, unit=" m")


@pytest.mark.parametrize("shift", [0.0, 0.25, 0.5, 0.381966, 1.0 - 0.381966])
def test_walls_on_cell_borders(check, shift):
    """Walls at whole numbers of cells, and at the lattice's own offset; they are also the scene's bounds."""
    cell = 1.0 / 16.0
    scene = Scene()
    scene.add(cuboid((0, 0, 0), (1, 1, 1)), glowing(0.5), moved(*[shift * cell] * 3))
    eye, target = np.array((0.1, 0.2, 0.3)) + shift * cell, np.array((0.9, 0.8, 0.6)) + shift * cell
    scene.look(eye, target, 1.5)
    picture = scene.render(settings(pyramid__finest_resolution=16))
    uniform(check, f"walls {shift:g} cells off the world's grid", picture)
    lost = picture.stats["photons"]["lost"] / picture.stats["photons"]["deposited"]
    check(
        f"walls {shift:g} cells off the world's grid: photons without a cell",
        expected=0.0,
        got=lost,
        bound=1e-6,
    )


def test_flat_scene(check):
    """All surfaces in one plane: nothing is lit indirectly, the direct light is P / (4π d²)."""
    scene = Scene()
    scene.add(quad(1.0), diffuse(0.5))
    scene.add(quad(1.0), diffuse(0.5), moved(2.0, 0, 0))
    scene.lamp(100.0, moved(0, 0, 2.0))
    scene.look((0, 0, 3), (0, 0, 0), 0.01, orthographic=True)
    picture = scene.render()
    exact = 0.5 / np.pi * 100.0 / (4 * np.pi * 4.0)
    check("flat scene", expected=exact, got=picture.mean, bound=1e-4)
    check("flat scene: indirect", expected=0.0, got=picture.indirect_mean, bound=0.0)


def test_camera_inside_a_solid(check):
    """No light comes in: what is seen is black, not a leak."""
    scene = Scene()
    scene.add(quad(10.0, -1.0), diffuse(0.5))
    scene.add(cuboid((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)), diffuse(0.8))
    scene.lamp(1000.0, moved(0, 0, 3.0))
    scene.world(1.0)
    scene.look((-0.3, -0.2, 0.1), (0.5, 0.4, 0.0), 1.0)
    check("camera inside a solid", expected=0.0, got=float(scene.render().combined[..., :3].max()), bound=0.0)


def test_empty_scene(check):
    scene = Scene()
    scene.world(0.7)
    scene.lamp(1.0, moved(0, 0, 1))
    check("scene without surfaces", expected=0.7, got=scene.render().mean, bound=1e-6)


def test_no_photons_in_a_furnace_are_noticed():
    """The furnace can fail: without photons there is the walls' own light, and theirs by one bounce."""
    picture = render(
        furnace().builder.finish(), settings(photon_pass__photon_count=0, gather__retrace_distance=0.0)
    )
    assert picture.mean == pytest.approx(1.5, rel=1e-3)


def test_looking_gives_a_rotation():
    matrix = looking((1, 2, 3), (4, 5, 7))
    assert matrix[:3, :3] @ matrix[:3, :3].T == pytest.approx(np.eye(3))
