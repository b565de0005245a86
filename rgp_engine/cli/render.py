"""`render SCENE.blend -o OUT.exr`: a file rendered through Blender, the way F12 does it."""

import argparse
import json
import os
import tempfile
import time
from pathlib import Path
from typing import Any

from ..files import whole_file
from ..report import last_outcome
from ..stats import effect_rows, rows
from . import CommandError, blender_scene, exr
from .audit_image import draw_audit
from .exr import Picture
from .scene_options import add_scene_options, apply_scene_options

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
        "--audit-image",
        metavar="OUT.png",
        type=Path,
        help="draw the cells that the audit found wrong over the picture",
    )
    parser.add_argument(
        "--checkpoint",
        metavar="FILE",
        type=Path,
        help="keep the unfinished picture there once a minute; the same render goes on from what it finds there",
    )
    add_scene_options(parser)
    parser.add_argument("--engine", choices=("RGP", "CYCLES"), default="RGP")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Does what the command line asks for."""
    outputs = [options.output, options.indirect, options.stats, options.png, options.audit_image]
    wants_audit = options.audit_image is not None
    if wants_audit and options.engine != "RGP":
        raise CommandError("only RGP has a pyramid to audit")
    for path in filter(None, [*outputs, options.checkpoint]):
        _check_writable(path)
    if options.checkpoint is not None and options.engine != "RGP":
        raise CommandError("only RGP keeps an unfinished picture")
    blender_scene.register_engine()
    b_scene = blender_scene.open_scene(options.scene)
    blender_scene.choose_engine(b_scene, options.engine)
    apply_scene_options(b_scene, options, options.engine)
    if wants_audit and b_scene.rgp.gather.audit == 0:
        raise CommandError("--audit-image needs an audit, and gather.audit is 0")
    start = time.perf_counter()
    b_layer = blender_scene.keep_one_layer(b_scene)
    if options.checkpoint is not None:
        b_layer.rgp.checkpoint = str(options.checkpoint.absolute())
    channels = _render(b_scene, b_layer, wants_indirect=options.indirect is not None, wants_audit=wants_audit)
    stats = _stats(options.engine, time.perf_counter() - start)
    exr.write(options.output, _layer(channels, "Combined", "RGBA"))
    if options.indirect:
        exr.write(options.indirect, _indirect(channels, options.engine))
    if options.png:
        blender_scene.save_png(b_scene, options.png)
    if wants_audit:
        audit = _layer(channels, "Audit", "X")[..., 0]
        draw_audit(options.audit_image, _layer(channels, "Combined", "RGB"), audit)
    if options.stats:
        _write_stats(options.stats, stats)
    _print_table(stats)


def _write_stats(path: Path, stats: dict[str, Any]) -> None:
    try:
        with whole_file(path) as part:
            part.write_text(json.dumps(stats, indent=2) + "\n")
    except OSError as error:
        raise CommandError(f"{path} cannot be written: {error.strerror}") from error


def _render(b_scene: Any, b_layer: Any, *, wants_indirect: bool, wants_audit: bool) -> dict[str, Picture]:
    """Renders the one view layer that is on and returns every channel of the result."""
    if wants_indirect:
        blender_scene.add_indirect_passes(b_scene, b_layer)
    if wants_audit:
        b_layer.rgp.use_pass_audit = True
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


def _check_writable(path: Path) -> None:
    """Better now than after the render. Raises CommandError."""
    folder = path.absolute().parent
    if not folder.is_dir():
        raise CommandError(f"{path} cannot be written: there is no folder {folder}")
    if path.is_dir() or not os.access(path if path.exists() else folder, os.W_OK):
        raise CommandError(f"{path} cannot be written")
