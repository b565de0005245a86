"""What aiming photons is worth: a room lit by sun and sky through a window, standing on a wide plane.

`python -m benchmarks.aimed_photons` prints, with and without aiming and for the same number of photons, the share of
photons that land first where the picture looks and the error of the indirect light against a picture of many more.
"""

import argparse
import itertools
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from rgp_engine import native

if TYPE_CHECKING:
    import rgp_core

Picture = npt.NDArray[np.float64]
Point = tuple[float, float, float]

_ALL_RAYS = 31
_ROOM, _HEIGHT, _WALL = 3.0, 3.0, 0.2  # half width, height and thickness (m)
_SETTINGS: dict[str, dict[str, Any]] = {
    "pyramid": {"finest_resolution": 128},
    "gather": {"rays": 256, "camera_samples": 16},
    "effects": {"direct_light": "off"},
}


def main() -> None:
    """Reads the command line, measures, prints."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.aimed_photons", description=__doc__)
    parser.add_argument("--photons", type=int, default=200_000)
    parser.add_argument("--width", type=float, default=200.0, help="of the plane (m)")
    parser.add_argument("--seeds", type=int, default=3)
    options = parser.parse_args()
    scene = room(options.width)
    best = {"photon_pass": {"photon_count": 8_000_000}, "gather": {"rays": 1024, "camera_samples": 16}}
    reference, _ = _render(scene, {**_SETTINGS, **best, "render": {"seed": 99}})
    for aim in ("off", "auto"):
        for seed in range(options.seeds):
            photons = {"photon_count": options.photons, "aim": aim}
            picture, stats = _render(scene, {**_SETTINGS, "photon_pass": photons, "render": {"seed": seed}})
            error = np.sqrt(((picture - reference) ** 2).mean()) / reference.mean()
            aimed = stats["aim"]
            share = (
                ""
                if aimed is None
                else f", {aimed['seen_before']:.3%} of photons became {aimed['seen_after']:.1%}"
            )
            print(
                f"aim {aim}, seed {seed}: error {error:.1%}, mean {picture.mean() / reference.mean():.3f}, "
                f"photon pass {stats['seconds']['photon_pass']:.2f} s{share}"
            )


def room(width: float) -> "rgp_core.Scene":
    """The scene: one window in the wall towards +X, the camera in the corner across."""
    builder = native.core().SceneBuilder()
    walls, ground = (_diffuse(builder, name, color) for name, color in (("walls", 0.7), ("ground", 0.3)))
    a, h, t = _ROOM, _HEIGHT, _WALL
    for low, high in (
        ((-a, -a, -t), (a, a, 0.0)),
        ((-a, -a, h), (a, a, h + t)),
        ((-a - t, -a, 0.0), (-a, a, h)),
        ((-a, -a - t, 0.0), (a, -a, h)),
        ((-a, a, 0.0), (a, a + t, h)),
        ((a, -a, 0.0), (a + t, a, 1.0)),
        ((a, -a, 2.2), (a + t, a, h)),
        ((a, -a, 1.0), (a + t, -1.0, 2.2)),
        ((a, 1.0, 1.0), (a + t, a, 2.2)),
    ):
        _box(builder, low, high, walls)
    _box(builder, (-width / 2, -width / 2, -2.0 * t), (width / 2, width / 2, -t), ground)
    elevation, azimuth = math.radians(40.0), math.radians(10.0)
    towards = np.array([math.cos(elevation), math.cos(elevation) * math.sin(azimuth), math.sin(elevation)])
    builder.add_lamp(
        {
            "name": "Sun",
            "shape": {"kind": "sun", "angle": 0.009},
            "power": [4.0, 3.8, 3.5],
            "world_from_lamp": _looking_back(towards, (0.0, 0.0, 0.0)).tolist(),
            "visibility": _ALL_RAYS - 1,
            "casts_shadow": True,
        }
    )
    builder.set_world(_sky(builder))
    eye = (-2.7, -2.6, 1.7)
    builder.set_camera(
        {
            "name": "Camera",
            "projection": {"kind": "perspective"},
            "world_from_camera": _looking_back(np.array([-0.8, -0.58, 0.12]), eye).tolist(),
            "window": [-0.7, 0.7, -0.52, 0.52],
            "resolution": [96, 72],
            "region": [0, 0, 96, 72],
            "clip": [0.01, 1000.0],
        }
    )
    return builder.finish()


def _render(scene: "rgp_core.Scene", settings: dict[str, dict[str, Any]]) -> tuple[Picture, dict[str, Any]]:
    session = native.core().Session(scene, settings, str(native.embree_library()))
    session.start()
    session.finish()
    return session.picture("combined")[..., :3].astype(np.float64), session.stats()


def _diffuse(builder: "rgp_core.SceneBuilder", name: str, albedo: float) -> int:
    closure = {"kind": "diffuse", "color": [albedo] * 3}
    return builder.add_material({"name": name, "closures": [{"weight": [1.0] * 3, "closure": closure}]})


def _box(builder: "rgp_core.SceneBuilder", low: Point, high: Point, material: int) -> None:
    corners = np.array(list(itertools.product(*zip(low, high))), np.float32)
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    triangles = np.array([face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))], np.uint32)
    mesh = builder.add_mesh("box", corners, triangles)
    builder.add_object("box", mesh, np.eye(4), [material], _ALL_RAYS)


def _looking_back(back: npt.NDArray[np.float64], place: Point) -> npt.NDArray[np.float64]:
    """A matrix whose z axis points along `back`: lamps and cameras look the other way."""
    z = back / np.linalg.norm(back)
    x = np.cross([0.0, 0.0, 1.0], z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3] = np.stack([x, np.cross(z, x), z, place], axis=1)
    return matrix


def _sky(builder: "rgp_core.SceneBuilder") -> dict[str, Any]:
    """A world brighter towards the zenith, and dim below the horizon."""
    texels = np.ones((64, 128, 4), np.float32)
    height = np.clip((np.arange(64) + 0.5) / 32 - 1.0, 0.0, 1.0)[:, None, None]
    texels[..., :3] = np.where(height > 0.0, np.array([0.5, 0.7, 1.0]) * (0.5 + height), 0.05)
    texture = builder.add_texture("sky", texels, "linear")
    image = {"extension": "repeat", "interpolation": "linear", "unassociate": False}
    instructions = [
        {"op": "geometry", "quantity": "position", "aside": "here"},
        {"op": "panorama", "vector": 0, "projection": "equirectangular"},
        {"op": "image", "texture": texture, "vector": 1, **image},
    ]
    program = {"instructions": instructions, "radiance": 2}
    return {"name": "Sky", "radiance": [0.4] * 3, "program": program, "visibility": _ALL_RAYS}


if __name__ == "__main__":
    main()
