"""A stand-in for `rgp_core` that keeps every record it is given and delivers a plain picture at once."""

import time
from typing import Any

import numpy as np

__version__ = "0.1.0"


class RenderError(Exception):
    pass


class SceneBuilder:
    def __init__(self) -> None:
        self.materials: list[dict[str, Any]] = []
        self.textures: list[dict[str, Any]] = []
        self.meshes: list[dict[str, Any]] = []
        self.objects: list[dict[str, Any]] = []
        self.lamps: list[dict[str, Any]] = []
        self.camera: dict[str, Any] = {}
        self.world: dict[str, Any] = {}

    def add_material(self, record: dict[str, Any]) -> int:
        self.materials.append(record)
        return len(self.materials) - 1

    def add_texture(self, name: str, pixels: Any, encoding: str) -> int:
        self.textures.append({"name": name, "pixels": pixels, "encoding": encoding})
        return len(self.textures) - 1

    def add_mesh(
        self, name: str, positions: Any, triangles: Any, normals: Any, layers: Any, slots: Any
    ) -> int:
        names = ("name", "positions", "triangles", "corner_normals", "layers", "slots")
        self.meshes.append(
            dict(zip(names, (name, positions, triangles, normals, layers, slots), strict=True))
        )
        return len(self.meshes) - 1

    def add_object(
        self, name: str, mesh: int, world_from_object: Any, materials: list[int], visibility: int
    ) -> int:
        names = ("name", "mesh", "world_from_object", "materials", "visibility")
        values = (name, mesh, world_from_object, materials, visibility)
        self.objects.append(dict(zip(names, values, strict=True)))
        return len(self.objects) - 1

    def set_object_info(self, index: int, record: dict[str, Any]) -> None:
        self.objects[index]["info"] = record

    def set_object_links(self, index: int, record: dict[str, Any]) -> None:
        self.objects[index]["links"] = record

    def set_object_motion(self, index: int, steps: Any) -> None:
        self.objects[index]["steps"] = steps

    def set_mesh_motion(self, index: int, steps: list[Any]) -> None:
        self.meshes[index]["steps"] = steps

    def add_lamp(self, record: dict[str, Any]) -> int:
        self.lamps.append(record)
        return len(self.lamps) - 1

    def set_camera(self, record: dict[str, Any]) -> None:
        self.camera = record

    def set_world(self, record: dict[str, Any]) -> None:
        self.world = record

    def finish(self) -> "Scene":
        Core.last = self
        return Scene(self)

    def material_of(self, name: str) -> dict[str, Any]:
        """The material record of that name."""
        return next(record for record in self.materials if record["name"] == name)

    def objects_of(self, name: str) -> list[dict[str, Any]]:
        """The objects of that name."""
        return [record for record in self.objects if record["name"] == name]


class Scene:
    def __init__(self, builder: SceneBuilder) -> None:
        self.builder = builder
        self.problems: list[dict[str, Any]] = []


class Session:
    """Ends after `Core.seconds`; its picture is 0.25 everywhere, the indirect light 0.125."""

    def __init__(self, scene: Scene, settings: dict[str, Any], _embree_library: str) -> None:
        Core.settings = settings
        self._region = scene.builder.camera["region"]
        self._is_cancelled = False

    def start(self) -> None:
        self._end = time.monotonic() + Core.seconds

    def cancel(self) -> None:
        self._is_cancelled = True

    def wait(self, timeout_seconds: float) -> bool:
        left = self._end - time.monotonic()
        if left > 0 and not self._is_cancelled:
            time.sleep(min(timeout_seconds, left))
        return self._is_cancelled or time.monotonic() >= self._end

    def progress(self) -> dict[str, Any]:
        left = max(self._end - time.monotonic(), 0.0)
        fraction = 1.0 - left / Core.seconds
        return {
            "stage": "Gathering",
            "fraction": fraction,
            "passes_done": int(fraction * 64),
            "passes_total": 64,
            "seconds_elapsed": Core.seconds - left,
            "seconds_left": left,
            "error": 0.8,
            "error_at_end": 0.4,
            "seconds_to_target": None,
            "memory_bytes": 3 << 20,
        }

    def picture(self, layer: str) -> Any:
        _, _, width, height = self._region
        channels, value = {
            "combined": (4, 0.25),
            "indirect": (3, 0.125),
            "shadow_catcher": (3, 0.5),
            "error": (1, 0.01),
            "audit": (1, 0.5),
        }[layer]
        return np.full((height, width, channels), value, np.float32)

    def stats(self) -> dict[str, Any]:
        return {
            "seconds": {"gather": 1.0, "total": 1.5},
            "rays": {"camera": 7},
            "memory_peak_bytes": 5 << 20,
            "warnings": [],
        }

    def finish(self) -> bool:
        return not self._is_cancelled


class Core:
    """What `native.core()` returns in tests, and what was last handed to it."""

    __version__ = __version__
    RenderError = RenderError
    SceneBuilder = SceneBuilder
    Session = Session
    embree_version = staticmethod(lambda _path: "4.4.0")
    hosek_wilkie = staticmethod(lambda *_params: [([0.1] * 9, 1.0)] * 3)
    last: SceneBuilder
    settings: dict[str, Any]
    seconds = 0.05
