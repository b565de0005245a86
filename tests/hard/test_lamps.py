"""Lamps at their limits, over floors and in closed rooms whose light is known."""

import numpy as np
import pytest

from tests.hard.scenes import Scene, ball, cuboid, diffuse, looking, moved, quad, settings

GROUP = "Lamps"
ALBEDO = 0.5


def floor(height: float = 2.0) -> Scene:
    """A floor seen from above, straight below where a lamp hangs."""
    scene = Scene()
    scene.add(quad(1.0), diffuse(ALBEDO))
    scene.look((0, 0, height * 0.5), (0, 0, 0), 0.002, orthographic=True)
    return scene


def below(power: float, height: float = 2.0) -> float:
    """Radiance of the floor below a point lamp: ρ / π · P / (4π d²)."""
    return ALBEDO / np.pi * power / (4 * np.pi * height**2)


@pytest.mark.parametrize("kind", ["point", "spot"])
def test_lamp_of_size_zero(check, kind):
    scene = floor()
    scene.lamp(10.0, moved(0, 0, 2.0), kind, radius=0.0)
    check(f"{kind} lamp of radius 0", expected=below(10.0), got=scene.render().mean, bound=1e-4)


def test_sun_of_angle_zero(check):
    scene = floor()
    scene.lamp(3.0, moved(0, 0, 2.0), "sun", angle=0.0)
    check("sun of angle 0", expected=ALBEDO / np.pi * 3.0, got=scene.render().mean, bound=1e-4)


@pytest.mark.parametrize("size", [1e-2, 1e-5])
def test_small_area_lamp(check, edge, size):
    """Flux P over a square: radiance P / (π A) times the solid angle, whatever A is."""

    def mean(side):
        scene = floor()
        scene.lamp(10.0, moved(0, 0, 2.0), "rectangle", size=[side, side])
        return scene.render().mean

    exact = ALBEDO / np.pi * 10.0 / np.pi / 4.0
    case = f"area lamp of {size:g} m"
    check(case, expected=exact, got=mean(size), bound=1e-3)
    if size == 1e-5:
        dial = [10.0**-i for i in range(5, 31, 2)]
        edge(case, dial, lambda side: abs(mean(side) / exact - 1), unit=" m")


@pytest.mark.parametrize(
    ("what", "kind", "power", "more", "told"),
    [
        ("area lamp of size 0", "rectangle", 10.0, {"size": [0.0, 1.0]}, "size is zero"),
        ("lamp of power 0", "point", 0.0, {}, ""),
        ("lamp of negative power", "point", -10.0, {}, "negative"),
        ("lamp whose power is no number", "point", np.nan, {}, "not a number"),
        ("lamp of infinite power", "point", np.inf, {}, "not a number"),
        ("lamp of negative radius", "point", 0.0, {"radius": -1.0}, ""),
    ],
)
def test_lamps_that_add_nothing(check, what, kind, power, more, told):
    scene = floor()
    scene.lamp(10.0, moved(0, 0, 2.0))
    scene.lamp(power, moved(0.1, 0, 1.0), kind, **more)
    picture = scene.render()
    check(f"{what}, beside one of 10 W", expected=below(10.0), got=picture.mean, bound=1e-4)
    assert not told or picture.told(told) == 1, picture.problems


def spheres(powers: tuple[float, ...], seen: int) -> Scene:
    """Closed spheres of radius 1 side by side, each with a lamp of its own; the camera is in one of them."""
    scene = Scene()
    mesh, material = scene.mesh(ball(4)), scene.material(diffuse(ALBEDO))
    for i, power in enumerate(powers):
        scene.place(mesh, material, moved(4.0 * i, 0, 0))
        scene.lamp(power, moved(4.0 * i + 0.3, 0.1, 0.4))
    x = 4.0 * seen
    scene.look((x - 0.4, 0, 0), (x + 1, 0.2, 0.1), 1.0)
    return scene


def test_dim_lamp_beside_bright(check, edge):
    """Each sphere knows its own lamp alone: indirect E = ρ P / (4π R² (1 − ρ)), wherever in it the lamp is."""
    case = "10⁻⁶ W beside 10⁶ W: indirect light of the dim room"

    def indirect(dim):
        values = settings(photon_pass__photon_count=1_000_000)
        return spheres((dim, 1e6), 0).render(values).indirect_mean

    exact = lambda power: ALBEDO / np.pi * ALBEDO * power / (4 * np.pi * (1 - ALBEDO))  # noqa: E731
    check(case, expected=exact(1e-6), got=indirect(1e-6), bound=0.02)
    dial = [10.0**-i for i in range(6, 25, 2)]
    edge(case, dial, lambda dim: abs(indirect(dim) / exact(dim) - 1), unit=" W")


def test_lamp_inside_a_solid(check):
    """What is shut in lights nothing outside."""
    scene = floor()
    scene.add(cuboid((-0.2, -0.2, 1.2), (0.2, 0.2, 1.6)), diffuse(0.9))
    scene.lamp(1e6, moved(0, 0, 1.4))
    picture = scene.render()
    check("lamp of 10⁶ W inside a solid", expected=0.0, got=float(picture.combined[..., :3].max()), bound=0.0)


@pytest.mark.parametrize("height", [1e-3, 1e-6, 0.0])
def test_area_lamp_on_a_surface(check, height):
    """An area lamp lying on the floor of a closed room, facing in, lights it as one 1 cm above does."""

    def picture(lift):
        scene = Scene()
        scene.add(cuboid((-1, -1, 0), (1, 1, 2)), diffuse(ALBEDO))
        scene.lamp(10.0, looking((0, 0, lift), (0, 0, 1)), "rectangle", size=[0.2, 0.2])
        scene.look((-0.8, -0.8, 1.0), (1, 1, 1.5), 1.0)
        return scene.render(settings(gather__camera_samples=16))

    expected = picture(0.01).mean
    check(f"area lamp {height:g} m above the floor", expected=expected, got=picture(height).mean, bound=0.02)


@pytest.mark.parametrize("lift", [1e-3, 1e-6])
def test_point_lamp_near_a_surface(check, lift):
    """Half of the light lands right beneath the lamp; a sphere's indirect light does not depend on where it hangs."""
    scene = Scene()
    scene.add(ball(5), diffuse(ALBEDO))
    # Towards the middle of a face, which lies nearer than its corners.
    scene.lamp(10.0, moved(*(np.ones(3) / np.sqrt(3) * (1.0 - 1.1e-3 - lift))))
    scene.look((-0.3, 0.2, 0.3), (-1, -0.4, -0.5), 0.7, pixels=(32, 32))
    got = scene.render(settings(photon_pass__photon_count=400_000, gather__rays=2048)).indirect_mean
    exact = ALBEDO / np.pi * ALBEDO * 10.0 / (4 * np.pi * (1 - ALBEDO))
    check(f"point lamp {lift:g} m off a wall: far side", expected=exact, got=got, bound=0.03)


def test_no_lamps(check):
    check("no lamp at all", expected=0.0, got=floor().render().mean, bound=0.0)
