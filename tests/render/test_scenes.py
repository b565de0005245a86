"""The committed scenes and references are what they say they are. Nothing here needs the engine."""

import json
import math

import bpy
import numpy as np
import pytest

from scenes import build, common, cornell_box, furnace, two_rooms
from tests.render import cases, pictures
from tests.render.make_references import REFERENCES, use_cycles

DIFFERENT_DEFAULTS = ("Subsurface Scale",)
"""Sockets no script sets and whose defaults differ from Blender to Blender."""


def open_scene(name: str) -> bpy.types.Scene:
    bpy.ops.wm.open_mainfile(filepath=str(common.SCENES / f"{name}.blend"))
    return bpy.context.scene


def triangle_count(scene: bpy.types.Scene) -> int:
    meshes = [thing.data for thing in scene.objects if thing.type == "MESH"]
    return sum(len(polygon.vertices) - 2 for mesh in meshes for polygon in mesh.polygons)


def contents(scene: bpy.types.Scene) -> dict[str, object]:
    """Everything about a scene that a picture of it depends on and a script could change."""
    described: dict[str, object] = {"resolution": (scene.render.resolution_x, scene.render.resolution_y)}
    for thing in scene.objects:
        figures = [round(value, 5) for row in thing.matrix_basis for value in row]
        if thing.type == "MESH":
            figures += [round(value, 5) for vertex in thing.data.vertices for value in vertex.co]
            for material in thing.data.materials:
                for node in material.node_tree.nodes:
                    described[f"{material.name}/{node.name}"] = [
                        (s.name, tuple(s.default_value) if s.type == "RGBA" else s.default_value)
                        for s in node.inputs
                        if s.type in ("RGBA", "VALUE") and s.name not in DIFFERENT_DEFAULTS
                    ]
        elif thing.type == "LIGHT":
            lamp = thing.data
            is_area = lamp.type == "AREA"
            shape = (lamp.size, lamp.size_y) if is_area else (lamp.spot_size, lamp.shadow_soft_size)
            figures += [lamp.energy, *lamp.color, *shape, thing.visible_camera]
        else:
            figures += [round(thing.data.angle, 5), round(thing.data.shift_y, 5)]
        described[thing.name] = figures
    return described


@pytest.mark.parametrize(
    ("name", "triangles"),
    [
        ("cornell_box", 30),
        ("glossy_cornell", 30),
        ("two_rooms", 16),
        ("furnace", 22),
        ("table", 58_624),
        ("nave", 139_332),
    ],
)
def test_scene_opens_with_clean_settings(name: str, triangles: int) -> None:
    scene = open_scene(name)
    assert triangle_count(scene) == triangles
    assert scene.camera is not None
    assert scene.render.engine == "CYCLES"
    assert scene.view_settings.view_transform == "Standard"
    assert not scene.cycles.use_denoising
    assert not scene.cycles.use_adaptive_sampling
    assert scene.cycles.sample_clamp_indirect == 0.0


@pytest.mark.parametrize("name", build.SCENES)
def test_committed_scene_is_what_its_script_builds(name: str) -> None:
    committed = contents(open_scene(name))
    build.SCENES[name].build()
    assert contents(bpy.context.scene) == committed


def test_known_answers_are_what_the_scripts_say() -> None:
    committed = json.loads((common.SCENES / "known_answers.json").read_text())
    assert committed == {name: answer() for name, answer in build.KNOWN_ANSWERS.items()}


def test_cornell_lamp_has_the_published_radiance_and_place() -> None:
    scene = open_scene("cornell_box")
    lamp = scene.objects["Lamp"]
    area = lamp.data.size * lamp.data.size_y
    assert area == pytest.approx(1.30 * 1.05, rel=1e-5)
    radiance = [lamp.data.energy * channel / (math.pi * area) for channel in lamp.data.color]
    assert radiance == pytest.approx(cornell_box.LAMP_RADIANCE, rel=1e-5)
    assert lamp.location.z < 5.488 < lamp.location.z + 0.002


def test_dark_room_is_black_in_cycles() -> None:
    scene = open_scene("two_rooms")
    use_cycles(scene, samples=64, seed=1)
    scene.render.resolution_percentage = 25
    picture = pictures.render(scene)["Combined"]
    answer = two_rooms.known_answer()
    assert pictures.part(picture, answer["dark_room"]).max() == answer["dark_room_radiance"]
    assert pictures.part(picture, answer["lit_room"]).mean() > 0.05


def test_furnace_is_uniform_in_cycles() -> None:
    halves = []
    for seed in (1, 2):
        scene = open_scene("furnace")
        use_cycles(scene, samples=64, seed=seed)
        scene.render.resolution_percentage = 20
        halves.append(pictures.render(scene)["Combined"])
    error = pictures.standard_error_of_mean(*halves)
    assert error.max() < 0.002 * furnace.RADIANCE
    assert np.abs(pictures.mean((halves[0] + halves[1]) / 2.0) - furnace.RADIANCE).max() < 4.0 * error.max()


def test_cornell_reference_is_what_its_figures_say() -> None:
    figures = json.loads((REFERENCES / "cornell_box.json").read_text())
    channels = pictures.read_channels(REFERENCES / "cornell_box.exr")
    combined, *halves = (pictures.rgb(channels, name) for name in ("Combined", "Indirect1", "Indirect2"))
    assert pictures.mean(combined) == pytest.approx(figures["mean_combined"], rel=1e-3)
    assert pictures.mean((halves[0] + halves[1]) / 2.0) == pytest.approx(figures["mean_indirect"], rel=1e-3)
    assert pictures.noise_peak(*halves) == pytest.approx(figures["noise_peak_indirect"], rel=0.02)
    assert figures["noise_peak_indirect"] < 0.003
    assert max(figures["standard_error_combined"]) < 0.001 * max(figures["mean_combined"])
    # Indirect light is a part of the picture, and the lamp itself has next to none.
    assert (pictures.mean(combined) > pictures.mean(halves[0])).all()


def test_every_case_has_a_precise_reference() -> None:
    references = json.loads((REFERENCES / "cases.json").read_text())["cases"]
    new = () if bpy.app.version >= (4, 3) else tuple(f"material/{name}/" for name in cases.NEW_MATERIALS)
    assert [name for name in references if not name.startswith(new)] == list(cases.CASES)
    for case, reference in references.items():
        for region, allowed in (("whole", 0.001), ("ball", 0.0025)):
            figures = reference[region]
            assert max(figures["standard_error"]) < allowed * np.mean(figures["mean"]), (case, region)
