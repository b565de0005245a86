"""Settings at the ends of their ranges, and the memory that photons take."""

import numpy as np
import pytest
import rgp_core

from rgp_engine import native
from tests.hard.scenes import Scene, ball, closure, cuboid, diffuse, furnace, glowing, moved, quad, settings

GROUP = "Settings"


@pytest.mark.parametrize("rays", [1, 4096])
def test_gather_rays(check, rays):
    values = settings(gather__rays=rays, gather__camera_samples=min(rays, 4))
    check(f"{rays} gather rays", expected=2.0, got=furnace().render(values).mean, bound=0.01)


@pytest.mark.parametrize(
    ("resolution", "size", "levels"), [(1, 1.0, 1), (8, 1.0, 1), (512, 1.0, 7), (32, 1.5e3, 12)]
)
def test_levels(check, resolution, size, levels):
    """In a room; the twelfth level comes with a ground of kilometres around it, which its light does not reach."""
    scene = furnace()
    if size > 1.0:
        scene.add(quad(size, -0.5), glowing(0.0, 0.0))
    grid = {"pyramid__finest_resolution": resolution, "pyramid__adaptive_levels": 0}
    picture = scene.render(settings(**grid, photon_pass__photon_count=400_000))
    case = f"{levels} levels, {resolution} cells"
    check(case, expected=2.0, got=picture.mean, bound=0.01)
    check(f"{case}: levels", expected=levels, got=picture.stats["pyramid"]["levels"], bound=0.0)


@pytest.mark.parametrize("bins", ["1x1", "8x16", "32x64"])
def test_bins(check, bins):
    """A furnace with rough reflection, read from direction bins: L = Le / (1 − ρ). What single scattering leaves of
    that differs with the direction; the viewer's gain makes up for it where the bins tell directions apart."""
    scene = Scene()
    scene.add(
        cuboid(), [closure("glossy", weight=0.5, color=1.0, roughness=0.8), closure("emission", radiance=1.0)]
    )
    picture = scene.render(settings(pyramid__bins=bins, photon_pass__photon_count=400_000, gather__rays=256))
    assert picture.stats["pyramid"]["glossy_cells"] > 0
    # One bin holds the mean over the hemisphere, whatever the direction it is read in.
    bound = 0.03 if bins == "1x1" else 0.002
    check(f"direction bins {bins}", expected=2.0, got=picture.mean, bound=bound)


def test_photons_none(check):
    values = settings(photon_pass__photon_count=0, gather__retrace_distance=0.0)
    check("0 photons: light and one bounce", expected=1.5, got=furnace().render(values).mean, bound=1e-3)


@pytest.mark.heavy
def test_photons_many(check):
    """Memory does not grow with photons: what is stored are cells."""

    def run(count):
        session = rgp_core.Session(
            furnace().builder.finish(),
            settings(photon_pass__photon_count=count),
            str(native.embree_library()),
        )
        session.start()
        peak = 0
        while not session.wait(0.05):
            peak = max(peak, session.progress()["memory_bytes"])
        session.finish()
        return peak, float(session.picture("combined")[..., 0].mean())

    run(1_000_000)
    few, _ = run(1_000_000)
    many, mean = run(100_000_000)
    check("10⁸ photons", expected=2.0, got=mean, bound=0.002)
    check("10⁸ photons: memory against 10⁶", expected=1.0, got=many / few, bound=0.02)


def hot_cell(photons: int) -> float:
    """Indirect light far above the floor that a narrow spot lights: all of its photons land in one cell, which so many
    would divide, were it not of equal cells everywhere."""
    scene = Scene()
    scene.add(quad(4.0), diffuse(0.5))
    scene.add(quad(0.05), diffuse(0.5), moved(0, 0, 3.0) @ np.diag([1, -1, -1, 1.0]))
    scene.lamp(1000.0, moved(0.6, 0.6, 1.0), "spot", cone_angle=0.02)
    scene.look((0, 0, 2.9), (0, 0, 3.0), 0.02, orthographic=True)
    grid = {"pyramid__finest_resolution": 8, "pyramid__adaptive_levels": 0}
    values = settings(photon_pass__photon_count=photons, gather__rays=1024, **grid)
    return scene.render(values, seconds=600.0).indirect_mean


@pytest.mark.parametrize("photons", [10**6, pytest.param(5 * 10**7, marks=pytest.mark.heavy)])
def test_many_photons_in_one_cell(check, photons):
    """Sums of 32 bits would lose 36 % of the light at 5·10⁷ equal photons."""
    case = f"{photons:.0e} photons into one cell against 10⁴"
    check(case, expected=hot_cell(10_000), got=hot_cell(photons), bound=0.005)


@pytest.mark.parametrize("depth", [1, 1000])
def test_depth_of_photons(check, depth):
    """n visits of surfaces give the first n terms of the sum; a last one is read there."""
    values = settings(photon_pass__max_depth=depth, gather__retrace_distance=0.0)
    exact = sum(0.5**k for k in range(min(depth, 60) + 2))
    check(f"photons of depth {depth}", expected=exact, got=furnace().render(values).mean, bound=0.005)


@pytest.mark.parametrize("depth", [1, 1000])
def test_depth_of_paths(check, depth):
    values = settings(gather__max_depth=depth)
    check(f"paths of depth {depth}", expected=2.0, got=furnace().render(values).mean, bound=0.005)


def pixels(width: int, height: int):
    scene = furnace()
    scene.look((-0.8, -0.5, 0.2), (1.0, 0.6, 0.6), 0.5, pixels=(width, height))
    values = settings(gather__rays=4 if width > 1 else 4096, gather__camera_samples=2)
    return scene.render(values, seconds=900.0)


@pytest.mark.parametrize(
    ("width", "height"), [(1, 1), (1, 64), (7, 3), pytest.param(16384, 1024, marks=pytest.mark.heavy)]
)
def test_size_of_the_picture(check, width, height):
    picture = pixels(width, height)
    assert picture.combined.shape == (height, width, 4)
    bound = 0.02 if width * height < 100 else 0.005
    check(f"picture of {width} x {height} pixels", expected=2.0, got=picture.mean, bound=bound)


def test_a_part_of_a_frame_of_16k(check):
    scene = furnace()
    part = (16_000, 9_000, 16, 16)
    scene.look((-0.8, -0.5, 0.2), (1.0, 0.6, 0.6), 1.5, pixels=(16384, 16384), region=part)
    check("a part of a frame of 16,384² pixels", expected=2.0, got=scene.render().mean, bound=0.005)


def test_retrace_of_nothing(check):
    """Without continued short rays the corners carry the pyramid's bias; the mean of a furnace has none."""
    values = settings(gather__retrace_distance=0.0)
    check("no short ray continued", expected=2.0, got=furnace().render(values).mean, bound=0.01)


def test_ball_of_many_triangles(check):
    scene = furnace()
    scene.add(ball(7, 0.3), glowing(0.5), moved(0.2, 0.1, 0.6))
    check("131,072 triangles in one object", expected=2.0, got=scene.render().mean, bound=0.005)
