"""Lens, film and visibility against Cycles in the same process."""

import math
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest

from scenes import common
from tests.render import cases, pictures

pytestmark = pytest.mark.slow

SETTINGS = {
    "gather.rays": 256,
    "gather.camera_samples": 64,
    "photon_pass.photon_count": 400_000,
    "film.filter": "box",
    "film.filter_width": 1.0,
}
CYCLES_SAMPLES = 1024
MEAN = 0.01
"""Of the mean over the channels: what is granted between both engines, in every part that is compared."""


def use_cycles(scene: bpy.types.Scene) -> None:
    scene.render.engine = "CYCLES"
    b_cycles = scene.cycles
    b_cycles.samples, b_cycles.use_denoising, b_cycles.use_adaptive_sampling = CYCLES_SAMPLES, False, False
    b_cycles.pixel_filter_type, b_cycles.filter_width = "BOX", 1.0
    b_cycles.sample_clamp_indirect = 0.0
    b_cycles.max_bounces = b_cycles.diffuse_bounces = b_cycles.glossy_bounces = 32


def both(scene: bpy.types.Scene) -> tuple[pictures.Picture, pictures.Picture]:
    """Our picture and Cycles', with alpha as the fourth channel."""
    found = []
    for use in (lambda: pictures.use_rgp(scene, SETTINGS), lambda: use_cycles(scene)):
        use()
        channels = pictures.render_channels(scene)
        layer = f"{scene.view_layers[0].name}.Combined"
        color = pictures.rgb(channels, layer)
        found.append(np.concatenate([color, channels[f"{layer}.A"][..., None]], axis=-1))
    return found[0], found[1]


def assert_same_means(ours: pictures.Picture, theirs: pictures.Picture) -> None:
    for region, box in cases.REGIONS.items():
        found, expected = (pictures.mean(pictures.part(picture, box)) for picture in (ours, theirs))
        assert np.abs(found - expected)[:3].max() < MEAN * expected[:3].mean(), (
            f"{region}: {found / expected} of {expected}"
        )
        assert abs(found[3] - expected[3]) < 0.005, f"{region}: alpha {found[3]} is not {expected[3]}"


def focus(scene: bpy.types.Scene, kind: str, distance: float, radius: float) -> Any:
    """Gives the camera a lens of that radius (m)."""
    b_camera = scene.camera.data
    b_camera.type, b_camera.ortho_scale = kind, 3.0
    focal_length = 1.0 if kind == "ORTHO" else b_camera.lens * 1e-3
    b_camera.dof.use_dof, b_camera.dof.focus_distance = True, distance
    b_camera.dof.aperture_fstop = focal_length / (2.0 * radius)
    return b_camera.dof


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
def test_blurred_scene_has_the_light_of_cycles(kind: str) -> None:
    scene = cases.build("material/diffuse/lamp")
    focus(scene, kind, 2.5, 0.25)
    assert_same_means(*both(scene))


def bokeh_scene(kind: str) -> bpy.types.Scene:
    """Two small bright squares, before the plane of focus and beyond it, seen through five blades."""
    scene = common.start_empty_file()
    common.add_camera((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), math.radians(12.0), (64, 64))
    material, tree, output = common.new_material("Bright")
    tree.links.new(cases.shader("Emission", Strength=50.0)(tree), output)
    for x, y, z in ((-0.1, 0.1, -2.0), (0.15, -0.15, -4.0)):
        side = 0.03
        corners = [(-side, -side, 0.0), (side, -side, 0.0), (side, side, 0.0), (-side, side, 0.0)]
        common.add_polygons("Square", [corners], [material]).location = (x, y, z)
    b_dof = focus(scene, kind, 2.8, 0.3)
    scene.camera.data.ortho_scale = 0.8
    b_dof.aperture_blades, b_dof.aperture_rotation, b_dof.aperture_ratio = 5, 0.3, 1.6
    return scene


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
def test_bokeh_has_the_shape_of_cycles(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Some 10,000 rays of either engine find the squares; blocks of 4 pixels are compared."""
    monkeypatch.setitem(SETTINGS, "gather.camera_samples", 1024)
    ours, theirs = (
        picture[..., 0].reshape(16, 4, 16, 4).mean(axis=(1, 3)) for picture in both(bokeh_scene(kind))
    )
    assert abs(ours.mean() / theirs.mean() - 1.0) < 0.04
    difference = np.sqrt(((ours - theirs) ** 2).mean()) / theirs.max()
    mirrored = np.sqrt(((ours[::-1] - theirs) ** 2).mean()) / theirs.max()
    assert difference < 0.02
    assert mirrored > 0.1, "the shape shows"


def _hide(*rays: str) -> Callable[[bpy.types.Scene], None]:
    def change(_scene: bpy.types.Scene) -> None:
        for ray in rays:
            setattr(bpy.data.objects["Sphere"], f"visible_{ray}", False)

    return change


def _holdout(_scene: bpy.types.Scene) -> None:
    bpy.data.objects["Sphere"].is_holdout = True


def _transparent_film(scene: bpy.types.Scene) -> None:
    scene.render.film_transparent = True


def _transparent_holdout(scene: bpy.types.Scene) -> None:
    _transparent_film(scene)
    _holdout(scene)


def _catching_floor(scene: bpy.types.Scene) -> None:
    _transparent_film(scene)
    bpy.data.objects["Floor"].is_shadow_catcher = True


def _expose(scene: bpy.types.Scene) -> None:
    scene.rgp.film.exposure = scene.cycles.film_exposure = 2.5


@pytest.mark.parametrize(
    ("case", "change"),
    [
        ("material/diffuse/lamp", _hide("camera")),
        # A true point: what of a larger lamp is hidden from shadow rays alone depends on the engine's weights.
        ("lamp/point", _hide("shadow")),
        ("material/diffuse/world", _hide("diffuse")),
        ("material/mirror/lamp", _hide("camera")),
        ("material/diffuse/world", _holdout),
        ("material/holdout_mix/world", _transparent_film),
        ("material/diffuse/world", _transparent_film),
        ("material/transparent_mix/world", _transparent_film),
        ("material/transparent_mix/world", _transparent_holdout),
        ("material/diffuse/lamp", _expose),
        ("lamp/area_square", _catching_floor),
        ("material/diffuse/world", _catching_floor),
    ],
)
def test_film_and_visibility(case: str, change: Callable[[bpy.types.Scene], None]) -> None:
    scene = cases.build(case)
    change(scene)
    assert_same_means(*both(scene))


@pytest.mark.parametrize("ray", ["glossy", "transmission"])
def test_hidden_from_mirrors_and_glass(ray: str) -> None:
    """A mirror or a pane of glass behind which stands what it shall not show."""
    scene = cases.build("material/diffuse/world")
    b_ball = bpy.data.objects["Sphere"]
    name = "Glossy" if ray == "glossy" else "Refraction"
    material, tree, output = common.new_material("Pane")
    tree.links.new(cases.shader(f"Bsdf{name}", Roughness=0.0)(tree), output)
    y = 1.2 if ray == "glossy" else -1.5
    pane = [(-1.5, y, 0.05), (1.5, y, 0.05), (1.5, y, 3.0), (-1.5, y, 3.0)]
    common.add_polygons("Pane", [pane], [material])
    setattr(b_ball, f"visible_{ray}", False)
    assert_same_means(*both(scene))


@pytest.mark.parametrize("is_seen", [False, True])
def test_lamp_hidden_from_the_camera(is_seen: bool) -> None:
    scene = cases.build("lamp/area_seen")
    bpy.data.objects["Lamp"].visible_camera = is_seen
    assert_same_means(*both(scene))
