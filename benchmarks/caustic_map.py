"""How many photons a caustic is averaged over, and which lights leave theirs to photons: sweeps of both settings.

`python -m benchmarks.caustic_map` prints, for the same number of photons, the error of the caustics alone (RMS, in
parts of their mean) for each number of nearest photons, and for lamps of several sizes the error and the CPU time of
photons and of gather rays. The reference is the mean of several pictures of more photons, read over fewer of them.
"""

import argparse
import math
import time
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from rgp_engine import native

if TYPE_CHECKING:
    import rgp_core

Array = npt.NDArray[np.float64]
Point = tuple[float, float, float]

_ALL_RAYS = 31
_EDGE = 40  # of the picture (pixels)
_NEAREST = (16, 32, 64, 128)
_RADII = (0.1, 0.25, 0.4, 0.6, 0.8)  # of lamps (m)
_WIDEST = 12.0  # every light is smaller (sr)
_REFERENCES = (100, 101)  # seeds
_GLASS = {"kind": "glass", "color": [1.0] * 3, "roughness": 0.0, "ior": 1.5}
_METAL = {"kind": "glossy", "color": [0.9] * 3, "roughness": 0.0}


def main() -> None:
    """Reads the command line, measures, prints."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.caustic_map", description=__doc__)
    parser.add_argument("--photons", type=int, default=300_000)
    parser.add_argument("--seeds", type=int, default=2)
    options = parser.parse_args()
    for name, scene in (("glass ball", ball(0.02)), ("metal ring", ring()), ("wavy water", water())):
        truth = _mean(scene, 4 * options.photons, nearest=8)
        errors = []
        for nearest in _NEAREST:
            found = [
                _error(caustics(scene, options.photons, seed, nearest=nearest)[0], truth)
                for seed in range(options.seeds)
            ]
            errors.append(f"{nearest}: {np.mean(found):.1%}")
        print(f"{name}, error by nearest photons: {', '.join(errors)}", flush=True)
    for radius in _RADII:
        scene = ball(radius)
        truth = _mean(scene, 4 * options.photons, nearest=8)
        found = []
        for kind, angle in (("photons", _WIDEST), ("rays", 0.0)):
            drawn = [caustics(scene, options.photons, seed, angle=angle) for seed in range(options.seeds)]
            error = np.mean([_error(picture, truth) for picture, _ in drawn])
            found.append(f"{kind} {error:.1%} in {np.mean([seconds for _, seconds in drawn]):.1f} s")
        print(f"lamp of {radius} m, {solid_angle(radius):.2f} sr: {', '.join(found)}", flush=True)


def caustics(
    scene: "rgp_core.Scene", photons: int, seed: int, *, nearest: int = 64, angle: float = _WIDEST
) -> tuple[Array, float]:
    """A picture of caustics, without the lamps that mirrors and glass show, and the CPU time it took (s)."""
    settings: dict[str, dict[str, Any]] = {
        "photon_pass": {
            "photon_count": 1000,
            "caustic_count": photons,
            "caustic_nearest": nearest,
            "caustic_solid_angle": angle,
        },
        "pyramid": {"finest_resolution": 16},
        "gather": {"rays": 16 if angle else 256, "camera_samples": 16},
        "effects": dict.fromkeys(("direct_light", "indirect_diffuse", "indirect_glossy"), "off"),
        "render": {"seed": seed},
    }
    start = time.process_time()
    lit = _picture(scene, settings)
    seconds = time.process_time() - start
    settings["effects"]["caustics"] = "off"
    return lit - _picture(scene, settings), seconds


def _picture(scene: "rgp_core.Scene", settings: dict[str, dict[str, Any]]) -> Array:
    session = native.core().Session(scene, settings, str(native.embree_library()))
    session.start()
    session.finish()
    return np.asarray(session.picture("combined")[..., :3].mean(axis=-1), np.float64)


def _mean(scene: "rgp_core.Scene", photons: int, nearest: int) -> Array:
    found = [caustics(scene, photons, seed, nearest=nearest)[0] for seed in _REFERENCES]
    return np.asarray(np.mean(found, axis=0))


def _error(picture: Array, truth: Array) -> float:
    return float(np.sqrt(((picture - truth) ** 2).mean()) / truth.mean())


def solid_angle(radius: float) -> float:
    """Of a lamp above the ball, as the engine takes it: its disk over the squared distance to the ball."""
    distance = math.dist(_LAMP, _BALL) - _BALL_RADIUS
    return math.pi * (radius / distance) ** 2


_BALL, _BALL_RADIUS, _LAMP = (0.0, 0.0, 0.32), 0.3, (0.4, 0.5, 1.4)


def ball(radius: float) -> "rgp_core.Scene":
    """A ball of glass on a floor below a lamp of that radius; the camera looks at the side away from the lamp."""
    builder = _room()
    u, v = np.meshgrid(np.linspace(0.0, 2.0 * math.pi, 129), np.linspace(0.0, math.pi, 65))
    normals = np.stack([np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)], axis=-1)
    _grid(builder, np.array(_BALL) + _BALL_RADIUS * normals, _GLASS)
    _lamp(builder, _LAMP, radius)
    return _seen(builder, (-0.3, -0.75, 0.35), (-0.12, -0.2, 0.0), 0.14)


def ring() -> "rgp_core.Scene":
    """A ring of metal on a floor, lit from the side: a cusp of light within."""
    builder = _room()
    u, z = np.meshgrid(np.linspace(0.0, 2.0 * math.pi, 257), np.linspace(0.0, 0.15, 2))
    _grid(builder, np.stack([0.4 * np.cos(u), 0.4 * np.sin(u), z], axis=-1), _METAL)
    _lamp(builder, (1.2, 0.3, 0.9), 0.02)
    return _seen(builder, (0.0, -0.4, 1.4), (0.0, 0.0, 0.0), 0.25)


def water() -> "rgp_core.Scene":
    """A floor below waves."""
    builder = _room()
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, 257), np.linspace(-1.0, 1.0, 257))
    z = 0.5 + 0.01 * (np.sin(17.0 * x + 5.0 * y) + np.sin(23.0 * y - 7.0 * x) + np.sin(11.0 * (x + y)))
    _grid(builder, np.stack([x, y, z], axis=-1), {"kind": "refraction", **_REFRACTS})
    _lamp(builder, (0.2, 0.1, 2.5), 0.02)
    return _seen(builder, (0.0, -0.6, 0.45), (0.0, 0.0, 0.0), 0.35)


_REFRACTS = {"color": [1.0] * 3, "roughness": 0.0, "ior": 1.33}


def _room() -> "rgp_core.SceneBuilder":
    """A floor, and nothing else."""
    builder = native.core().SceneBuilder()
    side = np.linspace(-1.5, 1.5, 2)
    x, y = np.meshgrid(side, side)
    _grid(builder, np.stack([x, y, 0.0 * x], axis=-1), {"kind": "diffuse", "color": [0.5] * 3})
    return builder


def _grid(builder: "rgp_core.SceneBuilder", points: Array, closure: dict[str, Any]) -> None:
    """A mesh of the squares between points (rows, columns, 3), flat triangles."""
    rows, columns = points.shape[:2]
    corner = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    triangles = np.concatenate([np.stack(three, axis=-1).reshape(-1, 3) for three in ((a, b, c), (a, c, d))])
    material = builder.add_material(
        {"name": closure["kind"], "closures": [{"weight": [1.0] * 3, "closure": closure}]}
    )
    mesh = builder.add_mesh("grid", points.reshape(-1, 3).astype(np.float32), triangles.astype(np.uint32))
    builder.add_object(closure["kind"], mesh, np.eye(4), [material], _ALL_RAYS)


def _lamp(builder: "rgp_core.SceneBuilder", place: Point, radius: float) -> None:
    matrix = np.eye(4)
    matrix[:3, 3] = place
    builder.add_lamp(
        {
            "name": "Lamp",
            "shape": {"kind": "point", "radius": radius, "soft_falloff": False},
            "power": [40.0] * 3,
            "world_from_lamp": matrix.tolist(),
            "visibility": _ALL_RAYS - 1,
            "casts_shadow": True,
        }
    )


def _seen(builder: "rgp_core.SceneBuilder", eye: Point, target: Point, half: float) -> "rgp_core.Scene":
    """The scene, seen from one point towards another, half a picture under an angle of that tangent."""
    z = np.subtract(eye, target) / math.dist(eye, target)
    x = np.cross([0.0, 0.0, 1.0], z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3] = np.stack([x, np.cross(z, x), z, eye], axis=1)
    builder.set_camera(
        {
            "name": "Camera",
            "projection": {"kind": "perspective"},
            "world_from_camera": matrix.tolist(),
            "window": [-half, half, -half, half],
            "resolution": [_EDGE, _EDGE],
            "region": [0, 0, _EDGE, _EDGE],
            "clip": [0.01, 1000.0],
        }
    )
    return builder.finish()


if __name__ == "__main__":
    main()
