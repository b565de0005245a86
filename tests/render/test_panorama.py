"""Cameras that see all around against Cycles in the same process."""

import bpy
import numpy as np
import pytest

from tests.render import panorama_cases, pictures

pytestmark = pytest.mark.slow

SAMPLES = 64
MEAN, BLOCKS = 0.01, 0.04
"""Of the mean: what is granted between both engines in the whole, and as RMS in blocks of 4 pixels."""


def renders(b_scene: bpy.types.Scene) -> list[pictures.Picture]:
    """Our picture and Cycles'."""
    settings = {"gather.rays": SAMPLES, "gather.camera_samples": SAMPLES, "gather.max_depth": 64}
    pictures.use_rgp(b_scene, {**settings, "photon_pass.photon_count": 200_000})
    pictures.use_box_filter(b_scene)
    ours = pictures.render(b_scene)["Combined"]
    pictures.use_cycles(b_scene, 4 * SAMPLES, seed=0)
    pictures.use_box_filter(b_scene)
    return [ours, pictures.render(b_scene)["Combined"]]


def blocks(picture: pictures.Picture) -> pictures.Picture:
    """Means of 4 × 4 pixels."""
    height, width, _ = picture.shape
    return picture.reshape(height // 4, 4, width // 4, 4, 3).mean(axis=(1, 3))


def rms(a: pictures.Picture, b: pictures.Picture) -> float:
    """RMS difference of blocks, as a part of the mean of the second."""
    return float(np.sqrt(((blocks(a) - blocks(b)) ** 2).mean()) / b.mean())


HAS_CYLINDERS = "central_cylindrical_radius" in bpy.types.Camera.bl_rna.properties


def where_it_can_be_compared(name: str) -> object:
    """A case, and why it is not compared in some Blenders."""
    no_cylinders = "cylindrical" in name and not HAS_CYLINDERS
    mirrored = name.startswith("window/fisheye") and bpy.app.version < (4, 5, 0)
    marks = [
        pytest.mark.skipif(no_cylinders, reason="Blender 4.2 has no cylindrical panoramas"),
        pytest.mark.skipif(mirrored, reason="Cycles of Blender 4.2 mirrors Window under fisheyes"),
    ]
    return pytest.param(name, marks=marks)


@pytest.mark.parametrize("name", [where_it_can_be_compared(name) for name in panorama_cases.PANORAMAS])
def test_panorama_looks_as_in_cycles(name: str) -> None:
    ours, theirs = renders(panorama_cases.build(name))
    assert ours.mean() == pytest.approx(theirs.mean(), rel=MEAN)
    assert rms(ours, theirs) < BLOCKS
    assert rms(ours[:, ::-1], theirs) > 2.0 * BLOCKS, "it would pass mirrored"
    assert rms(ours[::-1], theirs) > 2.0 * BLOCKS, "it would pass upside down"


def test_a_panorama_from_more_to_less_is_mirrored_as_in_cycles() -> None:
    b_scene = panorama_cases.build("window/equirectangular_part")
    b_camera = b_scene.camera.data
    b_camera.longitude_min, b_camera.longitude_max = b_camera.longitude_max, b_camera.longitude_min
    ours, theirs = renders(b_scene)
    assert rms(ours, theirs) < BLOCKS


@pytest.mark.parametrize("transparent", [False, True])
def test_beside_a_fisheye_is_black_as_in_cycles(transparent: bool) -> None:
    """Nothing is transparent there, whatever the film is."""
    b_scene = panorama_cases.build("fisheye_equidistant")
    b_scene.render.film_transparent = transparent
    found = []
    for use in (lambda: pictures.use_rgp(b_scene, {}), lambda: pictures.use_cycles(b_scene, 4, seed=0)):
        use()
        pictures.use_box_filter(b_scene)
        channels = pictures.render_channels(b_scene)
        layer = f"{b_scene.view_layers[0].name}.Combined"
        found.append([float(channels[f"{layer}.{channel}"][0, 0]) for channel in "RGBA"])
    assert found[0] == pytest.approx(found[1], abs=1e-6)
    assert found[1] == pytest.approx([0.0, 0.0, 0.0, 1.0])
