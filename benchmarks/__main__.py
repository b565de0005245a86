"""Measures the engine's speed, prints it and writes it to a file.

The gather is compared with the tracing of its own rays, in one sitting and by turns, so that a machine busy with other
things slows both alike. Read the smallest and largest value beside each median.
"""

import argparse
import json
import platform
import sys
from pathlib import Path
from typing import Any

import bpy

from benchmarks import capture, effects_saved, export_speed, pyramid_build, render_speed
from benchmarks.figures import Figure, Row, Target, details, machine, table
from rgp_engine import native

_ROOT = Path(__file__).resolve().parent.parent
_SCENES = (
    _ROOT / "scenes/cornell_box.blend",
    _ROOT / "scenes/glossy_cornell.blend",
    _ROOT.parent / "shared/scenes/sibenik.blend",
)

_BUILD_SCENE = _ROOT / "scenes/nave.blend"

_GATHER_OVER_TRACE = Target(1.0)
_BUILD_OVER_PHOTON_PASS = Target(0.2)
_PYRAMID_BUILD_SECONDS = Target(1.0, "s")
_DIFFUSE_PYRAMID_BYTES = Target(40e6, "bytes")
_EXPORT_SECONDS = Target(2.0, "s")


def main() -> None:
    """Reads the command line and runs every measurement."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("scenes", metavar="SCENE.blend", type=Path, nargs="*", help="default: the usual ones")
    parser.add_argument("-o", "--output", metavar="OUT.json", type=Path, required=True)
    parser.add_argument("--threads", type=int, default=2, help="default: 2, which the targets are stated for")
    parser.add_argument("--repetitions", type=int, default=3)
    options = parser.parse_args()
    scenes = options.scenes or [path for path in _SCENES if path.is_file()]
    capture.register()
    before = machine()
    rows = []
    for blend in scenes:
        scene = render_speed.core_scene(blend)
        speed = render_speed.measure(blend.stem, scene, options.threads, options.repetitions, _say)
        rows += _render_rows(blend.stem, speed)
        saved = effects_saved.measure(blend.stem, scene, options.threads, options.repetitions, _say)
        rows += _effect_rows(blend.stem, saved)
    ratio = pyramid_build.measure(_BUILD_SCENE, options.threads, options.repetitions, _say)
    rows.append(Row("pyramid_build_over_photon_pass", _BUILD_SCENE.stem, ratio, _BUILD_OVER_PHOTON_PASS))
    exports = export_speed.measure(options.repetitions, _say)
    rows += [
        Row("export_million_triangles_seconds", kind, figure, _EXPORT_SECONDS)
        for kind, figure in exports.items()
    ]
    print(table(rows))
    print(
        ", ".join(f"{name} {value}" for name, value in before.items()), f"threads {options.threads}", sep=", "
    )
    document = {
        **_medians(rows),
        "figures": details(rows),
        "settings": {**render_speed.SETTINGS, "render": {"threads": options.threads}},
        "machine": before,
        "versions": {
            **native.versions(),
            "blender": bpy.app.version_string,
            "python": platform.python_version(),
        },
    }
    options.output.write_text(json.dumps(document, indent=2) + "\n")


def _render_rows(scene: str, speed: render_speed.RenderSpeed) -> list[Row]:
    """The figures of one scene. The gather has a target in the Cornell box, memory in diffuse scenes."""
    return [
        Row(
            "gather_over_trace",
            scene,
            speed.gather_over_trace,
            _GATHER_OVER_TRACE if scene == "cornell_box" else None,
        ),
        Row("photons_per_second", scene, speed.photons_per_second, None),
        Row("pyramid_build_seconds", scene, speed.pyramid_build_seconds, _PYRAMID_BUILD_SECONDS),
        Row(
            "pyramid_bytes", scene, speed.pyramid_bytes, _DIFFUSE_PYRAMID_BYTES if speed.is_diffuse else None
        ),
    ]


def _effect_rows(scene: str, saved: effects_saved.EffectsSaved) -> list[Row]:
    """What the effects plan saves in one scene."""
    return [
        Row("effects_not_called_for", scene, Figure([len(saved.not_called_for)]), None),
        Row("all_effects_on_over_planned_seconds", scene, saved.seconds_ratio, None),
        Row("all_effects_on_more_bytes", scene, saved.bytes_more, None),
        Row("all_effects_on_more_rays", scene, saved.rays_more, None),
    ]


def _medians(rows: list[Row]) -> dict[str, Any]:
    """{figure: {scene: median}}; of the exports the slower."""
    medians: dict[str, Any] = {}
    for row in rows:
        medians.setdefault(row.name, {})[row.subject] = row.figure.median
    name = "export_million_triangles_seconds"
    return {**medians, name: max(medians[name].values())}


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
