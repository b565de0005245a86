"""Scenes made of arrays, straight through the core's public door: shapes, materials, lamps, a camera, a picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import rgp_core

from rgp_engine import native

Array = npt.NDArray[Any]
ALL = 31
"""Every ray kind."""
FRONT_CORNERS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
"""Walls of a cuboid, corners counted as bits x, y, z from the lowest bit; their normals point inwards."""


def settings(**changes: Any) -> dict[str, dict[str, Any]]:
    """Few photons and rays; `group__name=value` changes one setting."""
    groups: dict[str, dict[str, Any]] = {
        "photon_pass": {"photon_count": 100_000},
        "pyramid": {"finest_resolution": 32},
        "gather": {"rays": 64, "camera_samples": 4, "light_samples": 1},
        "film": {"filter": "box", "filter_width": 1.0},
    }
    for key, value in changes.items():
        group, _, name = key.partition("__")
        groups.setdefault(group, {})[name] = value
    return groups


def closure(kind: str, weight: float = 1.0, **inputs: Any) -> dict[str, Any]:
    """A weighted closure; gray numbers stand for colors."""
    colors = ("color", "radiance", "base_color", "emission_color", "specular_tint", "coat_tint")
    values = {k: [float(v)] * 3 if k in colors and np.isscalar(v) else v for k, v in inputs.items()}
    return {"weight": [weight] * 3, "closure": {"kind": kind, **values}}


def diffuse(albedo: float) -> list[dict[str, Any]]:
    return [closure("diffuse", color=albedo)]


def glowing(albedo: float, radiance: float = 1.0) -> list[dict[str, Any]]:
    """What a furnace is made of: in a closed one everything has the radiance `radiance / (1 - albedo)`."""
    return [*diffuse(albedo), closure("emission", radiance=radiance)]


def cuboid(low: Any = (-1.0, -0.7, 0.0), high: Any = (1.0, 0.7, 1.2)) -> tuple[Array, Array]:
    """Eight corners, twelve triangles, normals inwards."""
    corners = np.array(
        [[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)], np.float64
    )
    triangles = [t for a, b, c, d in FRONT_CORNERS for t in ((a, b, c), (a, c, d))]
    return corners, np.array(triangles, np.uint32)


def quad(half: float, height: float = 0.0) -> tuple[Array, Array]:
    """A square in the plane z = height, its normal up."""
    corners = [(-half, -half, height), (half, -half, height), (half, half, height), (-half, half, height)]
    return np.array(corners, np.float64), np.array([[0, 1, 2], [0, 2, 3]], np.uint32)


def ball(subdivisions: int = 3, radius: float = 1.0) -> tuple[Array, Array]:
    """A triangle soup of 8 · 4ⁿ triangles on a sphere about the origin."""
    axes = np.array([[sx, sy, sz] for sx in (1, -1) for sy in (1, -1) for sz in (1, -1)], np.float64)
    faces = np.stack([np.diag(signs)[:: int(signs.prod())] for signs in axes])
    for _ in range(subdivisions):
        a, b, c = faces[:, 0], faces[:, 1], faces[:, 2]
        ab, bc, ca = ((p + q) / np.linalg.norm(p + q, axis=1)[:, None] for p, q in ((a, b), (b, c), (c, a)))
        parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = np.concatenate([np.stack(part, axis=1) for part in parts])
    corners = faces.reshape(-1, 3) * radius
    return corners, np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)


def moved(x: float, y: float, z: float) -> Array:
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def scaled(x: float, y: float, z: float) -> Array:
    return np.diag([x, y, z, 1.0])


def looking(eye: Any, target: Any, up: Any = (0.0, 0.0, 1.0)) -> Array:
    """The matrix of a camera or lamp at `eye`, its -z towards `target`."""
    eye, target, up = (np.asarray(v, np.float64) for v in (eye, target, up))
    z = (eye - target) / np.linalg.norm(eye - target)
    up = up if abs(z @ up) < 0.999 * np.linalg.norm(up) else np.roll(up, -1)
    x = np.cross(up, z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = x, np.cross(z, x), z, eye
    return matrix


@dataclass(frozen=True)
class Picture:
    """What a render left behind; radiance of the first channel, rows from the bottom."""

    combined: Array
    indirect: Array
    stats: dict[str, Any]
    problems: list[dict[str, Any]]

    @property
    def gray(self) -> Array:
        return self.combined[..., 0].astype(np.float64)

    @property
    def mean(self) -> float:
        return float(self.gray.mean())

    @property
    def indirect_mean(self) -> float:
        return float(self.indirect[..., 0].astype(np.float64).mean())

    def spread(self, expected: float) -> float:
        """Root mean squared relative deviation of pixels."""
        return float(np.sqrt(np.mean((self.gray / expected - 1.0) ** 2)))

    def told(self, text: str) -> int:
        """How often a problem that holds the text was met."""
        return sum(problem["count"] for problem in self.problems if text in problem["message"])


class Scene:
    """A scene under construction. Lengths in metres, powers in watts."""

    def __init__(self) -> None:
        self.builder = rgp_core.SceneBuilder()
        self.look((-0.8, -0.5, 0.2), (1.0, 0.6, 0.6), 1.5)

    def material(self, closures: list[dict[str, Any]], program: dict[str, Any] | None = None) -> int:
        record = {"name": "Material", "closures": closures}
        return self.builder.add_material(record | ({"program": program} if program else {}))

    def mesh(self, shape: tuple[Array, Array], **more: Any) -> int:
        positions, triangles = shape
        return self.builder.add_mesh(
            "Mesh", positions.astype(np.float32), triangles.astype(np.uint32), **more
        )

    def place(self, mesh: int, material: int, matrix: Array | None = None) -> int:
        world = np.eye(4) if matrix is None else np.asarray(matrix, np.float64)
        return self.builder.add_object("Object", mesh, world, [material], ALL)

    def add(
        self,
        shape: tuple[Array, Array],
        closures: list[dict[str, Any]],
        matrix: Array | None = None,
        **more: Any,
    ) -> int:
        """A mesh of its own with a material of its own."""
        return self.place(self.mesh(shape, **more), self.material(closures), matrix)

    def lamp(self, power: float, matrix: Array, kind: str = "point", **shape: Any) -> None:
        defaults: dict[str, Any] = {
            "point": {"radius": 0.0, "soft_falloff": False},
            "spot": {"radius": 0.0, "soft_falloff": False, "cone_angle": 1.0, "blend": 0.0},
            "sun": {"angle": 0.0},
            "rectangle": {"size": [1.0, 1.0], "spread": np.pi},
            "ellipse": {"size": [1.0, 1.0], "spread": np.pi},
        }[kind]
        self.builder.add_lamp(
            {
                "name": "Lamp",
                "shape": {"kind": kind, **defaults, **shape},
                "power": [power] * 3,
                "world_from_lamp": matrix.tolist(),
                "visibility": ALL,
                "casts_shadow": True,
            }
        )

    def look(
        self,
        eye: Any,
        target: Any,
        half: float,
        *,
        pixels: tuple[int, int] = (16, 16),
        orthographic: bool = False,
        region: tuple[int, int, int, int] | None = None,
        up: Any = (0.0, 0.0, 1.0),
        tall: float | None = None,
    ) -> None:
        """A camera whose window reaches `half` to either side, and `tall` up and down where pixels are no squares: at
        distance 1, or in metres when orthographic."""
        distance = float(np.linalg.norm(np.asarray(target, float) - np.asarray(eye, float)))
        width, height = pixels
        tall = half * height / width if tall is None else tall
        self.builder.set_camera(
            {
                "name": "Camera",
                "projection": {"kind": "orthographic" if orthographic else "perspective"},
                "world_from_camera": looking(eye, target, up).tolist(),
                "window": [-half, half, -tall, tall],
                "resolution": [width, height],
                "region": list(region or (0, 0, width, height)),
                "clip": [distance * 1e-6, distance * 1e6],
            }
        )

    def world(self, radiance: float) -> None:
        record = {"radiance": [radiance] * 3, "visibility": ALL, "film_transparent": False}
        self.builder.set_world(record)

    def render(self, values: dict[str, dict[str, Any]] | None = None, seconds: float = 60.0) -> Picture:
        return render(self.builder.finish(), values, seconds)


def render(
    scene: rgp_core.Scene, values: dict[str, dict[str, Any]] | None = None, seconds: float = 60.0
) -> Picture:
    """Renders to the end; a render that does not end in time is a failure."""
    session = rgp_core.Session(scene, values or settings(), str(native.embree_library()))
    session.start()
    if not session.wait(seconds):
        stage = session.progress()["stage"]
        session.cancel()
        session.finish()
        raise TimeoutError(f"not done after {seconds:g} s ({stage})")
    session.finish()
    return Picture(session.picture("combined"), session.picture("indirect"), session.stats(), scene.problems)


def furnace(albedo: float = 0.5, matrix: Array | None = None) -> Scene:
    """A closed box of 2 m × 1.4 m × 1.2 m: every pixel has the radiance 1 / (1 - albedo)."""
    scene = Scene()
    scene.add(cuboid(), glowing(albedo), matrix)
    return scene
