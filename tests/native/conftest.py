"""The native core through its public door, without Blender."""

from typing import Any

import numpy as np
import pytest
import rgp_core

from rgp_engine import native

ALL = 31
SETTINGS = {
    "photon_pass": {"photon_count": 2000},
    "pyramid": {"finest_resolution": 16},
    "gather": {"rays": 16, "camera_samples": 4, "light_samples": 1},
}


@pytest.fixture(scope="session")
def embree() -> str:
    return str(native.embree_library())


class Room:
    """A floor below a point lamp and a camera, in parts that a test may change before they are handed over."""

    def __init__(self) -> None:
        self.builder = rgp_core.SceneBuilder()
        self.positions = np.array([[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], np.float32)
        self.triangles = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
        self.matrix = np.eye(4)
        closure = {"kind": "diffuse", "color": [0.5, 0.5, 0.5]}
        self.material: dict[str, Any] = {
            "name": "Gray",
            "closures": [{"weight": [1.0] * 3, "closure": closure}],
        }
        up = np.eye(4)
        up[2, 3] = 3.0
        self.lamp: dict[str, Any] = {
            "name": "Lamp",
            "shape": {"kind": "point", "radius": 0.0, "soft_falloff": False},
            "power": [100.0] * 3,
            "world_from_lamp": up.tolist(),
            "visibility": ALL,
            "casts_shadow": True,
        }
        above = np.eye(4)
        above[2, 3] = 5.0
        self.camera: dict[str, Any] = {
            "name": "Camera",
            "projection": {"kind": "perspective"},
            "world_from_camera": above.tolist(),
            "window": [-0.3, 0.3, -0.2, 0.2],
            "resolution": [30, 20],
            "region": [0, 0, 30, 20],
            "clip": [0.1, 100.0],
        }
        self.world: dict[str, Any] = {"radiance": [0.0] * 3, "visibility": ALL, "film_transparent": False}

    def finish(self) -> rgp_core.Scene:
        material = self.builder.add_material(self.material)
        mesh = self.builder.add_mesh("Floor", self.positions, self.triangles)
        self.builder.add_object("Floor", mesh, self.matrix, [material], ALL)
        self.builder.add_lamp(self.lamp)
        self.builder.set_camera(self.camera)
        self.builder.set_world(self.world)
        return self.builder.finish()


@pytest.fixture
def room() -> Room:
    return Room()
