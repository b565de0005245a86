"""F12 with the real core."""

import time

import bpy
import numpy as np
import pytest

from rgp_engine import engine, session
from tests.blender import build


def set_world(scene, radiance):
    scene.world = bpy.data.worlds.new("World")
    b_tree = build.shader_tree(scene.world)
    b_background = build.node(b_tree, "ShaderNodeBackground", Color=(radiance,) * 3, Strength=1.0)
    build.connect(b_tree, b_background, b_tree.nodes.new("ShaderNodeOutputWorld"), "Surface")


def test_lamp_above_a_floor(scene, rendered):
    """Straight below a point lamp of P watts at d metres the irradiance is P / (4 pi d^2)."""
    build.add_camera((0.0, 0.0, 10.0)).data.lens = 500.0
    b_floor = build.add_object("Floor", build.quad(size=4.0))
    b_floor.data.materials.append(build.surface("ShaderNodeBsdfDiffuse", Color=(0.5, 0.25, 1.0)))
    build.add_light("POINT", energy=100.0, shadow_soft_size=0.0).location = (0, 0, 2)
    center = rendered()[10:14, 14:18, :3].mean(axis=(0, 1))
    irradiance = 100.0 / (4 * np.pi * 2.0**2)
    assert center == pytest.approx(np.array([0.5, 0.25, 1.0]) * irradiance / np.pi, rel=0.01)


def test_background_and_transparent_film(scene, rendered):
    build.add_camera()
    set_world(scene, 0.5)
    picture = rendered()
    assert picture == pytest.approx(np.broadcast_to([0.5, 0.5, 0.5, 1.0], picture.shape))
    scene.render.film_transparent = True
    assert (rendered() == 0.0).all()


def test_emission_is_its_own_color(scene, rendered):
    build.add_camera((0.0, 0.0, 1.0))
    b_panel = build.add_object("Panel", build.quad(size=4.0))
    b_panel.data.materials.append(build.surface("ShaderNodeEmission", Color=(1.0, 0.5, 0.25), Strength=3.0))
    picture = rendered()[..., :3]
    assert picture == pytest.approx(np.broadcast_to([3.0, 1.5, 0.75], picture.shape), rel=1e-5)


def two_colored_floor():
    """Red where x is positive, blue where y is positive, emissive."""
    parts = (("Red", (1, 1), (1, 0, 0)), ("Blue", (-1, 1), (0, 0, 1)), ("Green", (1, -1), (0, 1, 0)))
    for name, corner, color in parts:
        b_object = build.add_object(name, build.quad(name), (corner[0], corner[1], 0))
        b_object.data.materials.append(build.surface("ShaderNodeEmission", name, Color=color, Strength=1.0))


def test_right_way_up(scene, rendered):
    build.add_camera((0.0, 0.0, 5.0))
    two_colored_floor()
    picture = rendered()
    assert picture[15, 20, 0] == pytest.approx(1.0, rel=1e-3)
    assert picture[15, 12, 2] == pytest.approx(1.0, rel=1e-3)
    assert picture[9, 20, 1] == pytest.approx(1.0, rel=1e-3)
    assert picture[9, 12, :3] == pytest.approx([0, 0, 0])


@pytest.mark.parametrize("crops", [False, True])
def test_border_shows_the_same_part_of_the_picture(scene, rendered, crops):
    build.add_camera((0.3, -0.2, 5.0))
    two_colored_floor()
    scene.render.resolution_x, scene.render.resolution_y = 60, 40
    scene.rgp.film.filter = "box"
    scene.rgp.film.filter_width = 1.0
    scene.rgp.gather.camera_samples = 16
    full = rendered()
    scene.render.use_border, scene.render.use_crop_to_border = True, crops
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.8
    scene.render.border_min_y, scene.render.border_max_y = 0.2, 0.75
    part = rendered()
    expected = full[8:30, 15:48, :3]
    if crops:
        assert part.shape[:2] == (22, 33)
        part = part[..., :3]
    else:
        assert part.shape[:2] == (40, 60)
        assert (part[:8, :, :3] == 0).all()
        part = part[8:30, 15:48, :3]
    # Samples differ with the tiles, so edges may; nothing is shifted by a pixel.
    assert np.abs(part - expected).mean() < 0.01


def test_every_view_layer_is_rendered(scene, rendered, tmp_path):
    build.add_camera((0.0, 0.0, 5.0))
    two_colored_floor()
    b_collection = bpy.data.collections.new("Red only")
    scene.collection.children.link(b_collection)
    b_red = bpy.data.objects["Red"]
    b_collection.objects.link(b_red)
    scene.collection.objects.unlink(b_red)
    scene.view_layers.new("Without red").layer_collection.children[0].exclude = True
    scene.view_layers[0].use = False
    assert rendered()[15, 20, 0] == 0.0
    scene.view_layers[0].use = True
    scene.view_layers["Without red"].use = False
    assert rendered()[15, 20, 0] == pytest.approx(1.0, rel=1e-3)


def test_two_renders_are_the_same_to_the_bit(scene, rendered):
    build.lit_room()
    first = rendered()
    assert (first[..., :3] > 0).any()
    assert np.array_equal(first, rendered())


def test_stats_have_everything_that_is_promised(scene, rendered, outcome):
    build.lit_room()
    rendered()
    stats = outcome().stats
    assert {"export", "accel", "photon_pass", "pyramid", "gather", "total"} <= stats["seconds"].keys()
    assert {"camera", "gather", "shadow", "photon"} <= stats["rays"].keys()
    assert {"emitted", "deposited"} <= stats["photons"].keys()
    assert {"levels", "cells", "bins", "bytes"} <= stats["pyramid"].keys()
    assert stats["memory_peak_bytes"] > 1 << 20
    promised = {"name", "switch", "called_for", "computed", "because", "pass", "seconds", "bytes", "rays"}
    assert all(promised <= effect.keys() for effect in stats["effects"])
    assert stats["settings"]["gather"]["rays"] == 4
    assert {"blender", "python", "rgp_core", "embree"} <= stats["versions"].keys()
    assert stats["photons"]["emitted"] == 1000


class Stopped:
    """Blender's engine with Esc pressed after some seconds of rendering."""

    def __init__(self, b_engine, seconds):
        self._b_engine = b_engine
        self.press_at = time.monotonic() + seconds

    def __getattr__(self, name):
        return getattr(self._b_engine, name)

    def test_break(self):
        return time.monotonic() >= self.press_at


@pytest.mark.parametrize("seconds", [0.0, 0.1, 0.3, 1.0, 2.0])
def test_esc_at_any_moment_returns_within_half_a_second(scene, rendered, monkeypatch, outcome, seconds):
    ends = []

    class Session(session.RenderSession):
        def __init__(self, b_engine, b_depsgraph):
            super().__init__(Stopped(b_engine, seconds), b_depsgraph)

        def render(self):
            super().render()
            ends.append(time.monotonic() - self._engine.press_at)

    monkeypatch.setattr(engine, "RenderSession", Session)
    build.lit_room()
    scene.render.resolution_x = scene.render.resolution_y = 512
    scene.rgp.photon_pass.photon_count = 2_000_000
    scene.rgp.gather.rays, scene.rgp.gather.camera_samples = 1024, 64
    picture = rendered()
    assert outcome().cancelled
    assert outcome().error == ""
    assert picture.shape == (512, 512, 4)
    assert np.isfinite(picture).all()
    assert ends[0] < 0.5


def test_animation_renders_every_frame(scene, tmp_path):
    build.lit_room()
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(tmp_path / "frame_")
    bpy.ops.render.render(animation=True)
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"frame_{n:04}.png" for n in (1, 2, 3)]


def test_persistent_data_does_not_freeze_the_scene(scene, rendered):
    build.add_camera((0.0, 0.0, 1.0))
    b_panel = build.add_object("Panel", build.quad(size=4.0))
    b_material = build.surface("ShaderNodeEmission", Strength=1.0)
    b_panel.data.materials.append(b_material)
    scene.render.use_persistent_data = True
    assert rendered()[10, 10, 0] == pytest.approx(1.0, rel=1e-5)
    b_material.node_tree.nodes["Emission"].inputs["Strength"].default_value = 2.0
    assert rendered()[10, 10, 0] == pytest.approx(2.0, rel=1e-5)


def test_cycles_renders_before_and_after_in_the_same_process(scene, rendered):
    """Blender has an Embree and a TBB of its own; ours live beside them."""
    assert hasattr(scene, "cycles"), "every Blender that is tested comes with Cycles"
    build.lit_room()
    pictures = {}
    for turn, name in enumerate(("CYCLES", "RGP", "CYCLES", "RGP")):
        scene.render.engine = name
        scene.cycles.samples, scene.cycles.use_denoising = 4, False
        pictures[turn] = rendered()
    assert np.array_equal(pictures[1], pictures[3])
    assert pictures[0] == pytest.approx(pictures[2], abs=1e-6)
    assert pictures[1][..., :3].mean() == pytest.approx(pictures[0][..., :3].mean(), rel=0.2)
