"""Materials at their limits: where light comes alike from everywhere, white things cannot be seen."""

import numpy as np
import pytest

from tests.hard.scenes import Scene, ball, closure, cuboid, diffuse, furnace, glowing, moved, quad, settings

GROUP = "Materials"
WORLD = 0.7


def in_the_world(closures, shape=None, **values) -> Scene:
    """Something in a uniform world, filling the picture."""
    scene = Scene()
    scene.add(shape or ball(4), closures)
    scene.world(WORLD)
    scene.look((0.0, -4.0, 1.0), (0, 0, 0), 0.1)
    return scene


@pytest.mark.parametrize("albedo", [0.0, 0.5, 0.9, 0.99])
def test_albedo_in_a_closed_room(check, edge, albedo):
    case = f"closed room of albedo {albedo:g}"
    deep = settings(
        photon_pass__max_depth=1000, photon_pass__photon_count=1_000_000 if albedo > 0.9 else 100_000
    )

    def mean(value):
        return furnace(value).render(deep).mean

    check(case, expected=1 / (1 - albedo), got=mean(albedo), bound=0.01)
    if albedo == 0.99:
        deviation = lambda dark: abs(mean(1 - dark) * dark - 1)  # noqa: E731
        edge(case, [0.01, 0.005, 0.002, 0.001, 0.0005], deviation, unit=" absorbed")


def test_albedo_of_one(check):
    scene = in_the_world(diffuse(1.0))
    check("ball of albedo 1 in a uniform world", expected=WORLD, got=scene.render().mean, bound=1e-5)


@pytest.mark.parametrize("albedo", [1.5, 100.0, 1e30])
def test_albedo_above_one(check, albedo):
    """More than 1 counts as 1; a closed room of it has no answer, but an end."""
    ball_of = in_the_world(diffuse(albedo)).render().mean
    check(f"ball of albedo {albedo:g} in a uniform world", expected=WORLD, got=ball_of, bound=1e-5)
    one, above = (furnace(value).render() for value in (1.0, albedo))
    difference = float(np.abs(above.gray - one.gray).max())
    check(f"closed room of albedo {albedo:g} against 1", expected=0.0, got=difference, bound=0.0)
    assert np.isfinite(one.gray).all()


@pytest.mark.parametrize("roughness", [0.0, 0.01, 0.1, 0.5, 1.0])
@pytest.mark.parametrize("kind", ["glossy", "glass"])
def test_roughness(check, kind, roughness):
    more = {"ior": 1.5} if kind == "glass" else {}
    scene = in_the_world([closure(kind, color=1.0, roughness=roughness, **more)])
    values = settings(gather__rays=256, gather__camera_samples=16)
    got = scene.render(values).mean
    # One reflection keeps all light to 1 %; in a glass ball light meets the surface at least twice.
    bound = 0.02 if kind == "glass" else 0.01
    check(f"white {kind} of roughness {roughness:g} in a uniform world", expected=WORLD, got=got, bound=bound)


@pytest.mark.parametrize("ior", [1.0, 0.5, 0.1, 1.0001, 3.0, 100.0])
def test_index_of_refraction(check, ior):
    """A slab: in a ball of facets light of a high index is caught for thousands of bounces."""
    scene = in_the_world([closure("glass", color=1.0, roughness=0.0, ior=ior)], cuboid())
    got = scene.render(settings(gather__rays=256, gather__camera_samples=16, gather__max_depth=1000)).mean
    check(f"white glass of index {ior:g} in a uniform world", expected=WORLD, got=got, bound=0.005)


def test_glass_of_index_one_cannot_be_seen(check):
    def picture(*, glass: bool):
        scene = Scene()
        scene.add(quad(2.0), diffuse(0.5))
        if glass:
            scene.add(ball(3, 0.5), [closure("glass", color=1.0, roughness=0.0, ior=1.0)], moved(0, 0, 0.7))
        scene.world(WORLD)
        scene.look((0, -3, 2), (0, 0, 0.5), 0.3)
        return scene.render(settings(gather__rays=256, gather__camera_samples=16))

    without, through = picture(glass=False), picture(glass=True)
    check("floor seen through glass of index 1", expected=without.mean, got=through.mean, bound=0.01)


@pytest.mark.parametrize("reflectance", [0.5, 0.9])
def test_mirrors_facing_each_other(check, reflectance):
    """Six of them: L = Le / (1 - ρ), the sum of all reflections."""
    scene = Scene()
    mirror = [closure("glossy", color=reflectance, roughness=0.0), closure("emission", radiance=1.0)]
    scene.add(cuboid(), mirror)
    got = scene.render(settings(gather__max_depth=1000, gather__rays=256, gather__camera_samples=64)).mean
    case = f"room of six mirrors of reflectance {reflectance:g}"
    check(case, expected=1 / (1 - reflectance), got=got, bound=0.02)


def test_perfect_mirrors_end(check):
    """Light between them never ends; the render does."""
    scene = Scene()
    scene.add(cuboid(), [closure("glossy", color=1.0, roughness=0.0)])
    scene.lamp(1.0, moved(0, 0, 0.6))
    picture = scene.render(settings(gather__max_depth=1000, photon_pass__max_depth=1000))
    wrong = int((~np.isfinite(picture.combined)).sum())
    check("room of six perfect mirrors: values that are no number", expected=0.0, got=wrong, bound=0.0)


@pytest.mark.parametrize("ior", [1.0, 1.5])
def test_closed_room_of_glass(check, ior):
    """A room with walls of white glass, seen from inside: the uniform world looks the same through it."""
    scene = Scene()
    glass = [closure("glass", color=1.0, roughness=0.0, ior=ior)]
    corners, triangles = cuboid()
    scene.add((corners, triangles), glass)
    scene.add((corners * 1.1, triangles[:, ::-1]), glass)
    scene.world(WORLD)
    values = settings(gather__max_depth=1000, gather__rays=256, gather__camera_samples=64)
    check(f"room of glass of index {ior:g}", expected=WORLD, got=scene.render(values).mean, bound=0.01)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, -1.0, 1e38])
@pytest.mark.parametrize("kind", ["diffuse", "glossy", "glass", "principled", "transparent"])
def test_inputs_that_make_no_sense(kind, value):
    """Whatever a color or number is, the picture has only numbers."""
    inputs = {
        "diffuse": {"color": value, "roughness": value},
        "glossy": {"color": value, "roughness": value},
        "glass": {"color": value, "roughness": value, "ior": value},
        "principled": dict.fromkeys(
            ("base_color", "roughness", "diffuse_roughness", "ior", "metallic"), value
        ),
        "transparent": {"color": value},
    }[kind]
    scene = furnace()
    scene.add(ball(1, 0.3), [closure(kind, **inputs)], moved(0.2, 0, 0.6))
    picture = scene.render()
    assert np.isfinite(picture.combined).all()
    assert picture.stats["nonfinite_pixels"] == 0


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e38])
def test_texture_coordinates_that_are_not_numbers(check, value):
    """A white image looked up there: it is white wherever it is looked at, and what cannot be looked up is finite."""
    scene = Scene()
    corners, triangles = cuboid()
    texture = scene.builder.add_texture("White", np.full((4, 4, 4), 255, np.uint8), "linear")
    program = {
        "instructions": [
            {"op": "attribute", "attribute": 0, "aside": [0.0, 0.0]},
            {
                "op": "image",
                "texture": texture,
                "vector": 0,
                "extension": "repeat",
                "interpolation": "linear",
                "unassociate": False,
            },
        ],
        "outputs": [{"closure": 0, "input": "color", "register": 1}],
        "normal": None,
    }
    uv = np.full((len(triangles), 3, 2), value, np.float32)
    material = scene.material(glowing(0.5), program)
    scene.place(scene.mesh((corners, triangles), layers=[(0, uv)]), material)
    picture = scene.render()
    assert np.isfinite(picture.combined).all()
    got = picture.stats["nonfinite_pixels"]
    check(f"texture coordinates of {value}: pixels that are no number", expected=0.0, got=got, bound=0.0)
