"""`render SCENE.blend -o OUT.exr`: a file rendered through Blender, the way F12 does it."""

import argparse
import json
import os
import tempfile
import time
from pathlib import Path
from typing import Any

from .. import register
from ..report import last_outcome
from ..stats import effect_rows, rows
from . import CommandError, blender_scene, exr
from .assign import assign
from .exr import Picture

_EPILOG = """\
SCENE.blend is rendered as F12 would, its compositor and sequencer left aside. Settings are those of the panels, such as

  --set photon_pass.photon_count=2000000 --set pyramid.bins=8x16 --set gather.rays=512

With --engine CYCLES the picture is a reference: processor only, no denoiser, no clamping, all caustics;
--set cycles.samples=4096 and every other property of scene.cycles can be set. An unknown name is answered with those
that exist.
"""


def add_arguments(commands: Any) -> None:
    """Adds the command to the parser."""
    parser = commands.add_parser(
        "render",
        help="render a .blend file",
        description="Renders a .blend file to a linear 32-bit OpenEXR picture.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog=_EPILOG,
    )
    parser.add_argument("scene", metavar="SCENE.blend", type=Path)
    parser.add_argument("-o", "--output", metavar="OUT.exr", type=Path, required=True)
    parser.add_argument("--indirect", metavar="OUT.exr", type=Path, help="write the indirect light alone")
    parser.add_argument("--stats", metavar="OUT.json", type=Path, help="write times, counts and settings")
    parser.add_argument("--png", metavar="OUT.png", type=Path, help="write the picture as Blender shows it")
    parser.add_argument(
        "--set", metavar="GROUP.NAME=VALUE", action="append", default=[], help="change a setting"
    )
    parser.add_argument("--resolution", metavar="WxH", type=_resolution, help="pixels of the full frame")
    parser.add_argument(
        "--frame", metavar="N", type=int, help="frame to render instead of the file's current"
    )
    parser.add_argument("--threads", metavar="N", type=int, help="processor threads; 0 takes all")
    parser.add_argument("--seed", metavar="N", type=int, help="another seed gives other noise")
    parser.add_argument("--engine", choices=("RGP", "CYCLES"), default="RGP")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Does what the command line asks for."""
    outputs = [options.output, options.indirect, options.stats, options.png]
    for path in filter(None, outputs):
        _check_writable(path)
    register()
    b_scene = blender_scene.open_scene(options.scene)
    blender_scene.choose_engine(b_scene, options.engine)
    _apply(b_scene, options)
    start = time.perf_counter()
    channels = _render(b_scene, wants_indirect=options.indirect is not None)
    stats = _stats(options.engine, time.perf_counter() - start)
    exr.write(options.output, _layer(channels, "Combined", "RGBA"))
    if options.indirect:
        exr.write(options.indirect, _indirect(channels, options.engine))
    if options.png:
        blender_scene.save_png(b_scene, options.png)
    if options.stats:
        options.stats.write_text(json.dumps(stats, indent=2) + "\n")
    _print_table(stats)


def _apply(b_scene: Any, options: argparse.Namespace) -> None:
    """Frame, size and settings."""
    if options.frame is not None:
        b_scene.frame_set(options.frame)
    if options.resolution:
        b_render = b_scene.render
        b_render.resolution_x, b_render.resolution_y = options.resolution
        b_render.resolution_percentage = 100
    group = "render" if options.engine == "RGP" else "cycles"
    if options.seed is not None:
        assign(b_scene, f"{group}.seed={options.seed}")
    if options.threads is not None:
        # Blender's own number of threads is Cycles'; 0 is ours for all.
        assign(b_scene, f"render.threads={options.threads}")
        b_scene.render.threads_mode = "FIXED" if options.threads else "AUTO"
        b_scene.render.threads = max(options.threads, 1)
    for assignment in options.set:
        assign(b_scene, assignment)


def _render(b_scene: Any, *, wants_indirect: bool) -> dict[str, Picture]:
    """Renders one view layer and returns every channel of the result."""
    b_layer = blender_scene.keep_one_layer(b_scene)
    if wants_indirect:
        blender_scene.add_indirect_passes(b_scene, b_layer)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "passes.exr"
        blender_scene.render_to(b_scene, path)
        return exr.read_channels(path)


def _layer(channels: dict[str, Picture], name: str, letters: str) -> Picture:
    picture = exr.layer_of(channels, name, letters)
    if picture is None:
        raise CommandError(f"the render has no pass {name}; it has {', '.join(sorted(channels))}")
    return picture


def _indirect(channels: dict[str, Picture], engine: str) -> Picture:
    """The indirect light; Cycles' is the sum of its indirect passes times their color passes."""
    if engine == "RGP":
        return _layer(channels, "Indirect", "RGB")
    parts = [
        _layer(channels, indirect, "RGB") * _layer(channels, color, "RGB")
        for indirect, color in blender_scene.cycles_indirect_passes()
    ]
    total: Picture = parts[0] + parts[1] + parts[2]
    return total


def _stats(engine: str, seconds: float) -> dict[str, Any]:
    """What is known about the render."""
    outcome = last_outcome()
    if engine == "RGP" and outcome and outcome.stats:
        return outcome.stats
    return {"seconds": {"total": seconds}, "versions": blender_scene.versions()}


def _print_table(stats: dict[str, Any]) -> None:
    lines = rows(stats)
    width = max(len(label) for label, _ in [*lines, *effect_rows(stats)])
    for label, value in lines:
        print(f"{label:{width}}  {value:>14}")
    for label, value in effect_rows(stats):
        print(f"{label:{width}}  {value}")
    for problem in stats.get("problems", ()):
        times = f" ({problem['count']} times)" if problem["count"] > 1 else ""
        print(f"problem: {problem['subject']}: {problem['message']}{times}")


def _resolution(text: str) -> tuple[int, int]:
    """Parses 640x480."""
    width, _, height = text.partition("x")
    if not (width.isdecimal() and height.isdecimal() and int(width) and int(height)):
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form WxH, such as 640x480")
    return int(width), int(height)


def _check_writable(path: Path) -> None:
    """Better now than after the render. Raises CommandError."""
    folder = path.absolute().parent
    if not folder.is_dir():
        raise CommandError(f"{path} cannot be written: there is no folder {folder}")
    if path.is_dir() or not os.access(path if path.exists() else folder, os.W_OK):
        raise CommandError(f"{path} cannot be written")
