"""What the Blender tests share: an empty scene, the export recorded, renders."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest

import rgp_engine
from rgp_engine import native
from rgp_engine.report import Outcome, last_outcome
from tests.blender import build
from tests.blender.recording_core import Core, SceneBuilder


@pytest.fixture(scope="session", autouse=True)
def _engine() -> None:
    if not hasattr(bpy.types.Scene, "rgp"):
        rgp_engine.register()


@pytest.fixture
def scene() -> Any:
    """An empty scene of 32 x 24 pixels, rendered by RGP Engine at the lowest quality."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    b_scene = bpy.context.scene
    b_scene.render.engine = "RGP"
    b_scene.render.resolution_x, b_scene.render.resolution_y = 32, 24
    b_scene.rgp.photon_pass.photon_count = 1000
    b_scene.rgp.pyramid.finest_resolution = 16
    b_scene.rgp.gather.rays = 4
    b_scene.rgp.gather.camera_samples = 1
    b_scene.rgp.gather.light_samples = 1
    return b_scene


@pytest.fixture
def outcome() -> Callable[[], Outcome]:
    """How the last render ended."""

    def get() -> Outcome:
        found = last_outcome()
        assert found is not None, "nothing was rendered"
        return found

    return get


@pytest.fixture
def recorded(monkeypatch: pytest.MonkeyPatch) -> type[Core]:
    """The native core replaced by one that records."""
    monkeypatch.setattr(native, "core", lambda: Core)
    monkeypatch.setattr(Core, "seconds", 0.05)
    return Core


@pytest.fixture
def export(scene: Any, recorded: type[Core]) -> Callable[[], SceneBuilder]:
    """Exports the scene by rendering it, and returns what the core was handed."""

    def run() -> SceneBuilder:
        bpy.ops.render.render()
        return recorded.last

    return run


@pytest.fixture
def exported(export: Callable[[], SceneBuilder]) -> Callable[[Any], dict[str, Any]]:
    """The record of a material, on the one object of the scene."""

    def get(b_material: Any) -> dict[str, Any]:
        build.add_camera()
        b_mesh = build.quad()
        b_mesh.materials.append(b_material)
        build.add_object("Quad", b_mesh)
        return export().material_of(b_material.name)

    return get


@pytest.fixture
def problems(outcome: Callable[[], Outcome]) -> Callable[[], list[str]]:
    """Problems of the last render as text."""

    def get() -> list[str]:
        return [f"{problem.subject}: {problem.message}" for problem in outcome().problems]

    return get


@pytest.fixture
def rendered(scene: Any, tmp_path: Path) -> Callable[[], Any]:
    """Renders the scene and returns the picture: rows from the bottom, (height, width, 4)."""

    def run() -> Any:
        path = tmp_path / "picture.exr"
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.image_settings.color_mode = "RGBA"
        scene.render.image_settings.color_depth = "32"
        scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True)
        return _picture_of(path)

    return run


def _picture_of(path: Path) -> Any:
    b_image = bpy.data.images.load(str(path))
    width, height = b_image.size
    pixels = np.empty(width * height * 4, np.float32)
    b_image.pixels.foreach_get(pixels)
    bpy.data.images.remove(b_image)
    return pixels.reshape(height, width, 4)
