"""`accuracy SCENE.blend -o DIR`: what accuracy costs in time, for one scene."""

import argparse
import os
import sys
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING

from ..accuracy.text import table
from ..native import is_render_error
from ..report import UserError
from ..stats import clock
from . import CommandError, blender_scene
from .scene_options import add_scene_options, apply_scene_options, resolution

if TYPE_CHECKING:
    from ..accuracy.result import Sweep

_SECONDS, _QUICK_SECONDS = 60.0, 15.0
_STOP_SECONDS = 5.0

_EPILOG = """\
Renders a part of the picture with many settings around those of the file (finest level, direction bins where there
are glossy cells, gather rays, camera samples, photons), and measures each against a reference that it makes first. The
error is rms_clipped of the command compare, less the noise of the reference: root mean square of the picture clipped at
eight times its mean, which is 100 %. DIR gets accuracy.json with all rows, the front and the cheapest settings for
errors of 2, 1, 0.5 and 0.25 %, and the plot as accuracy.svg and accuracy.png. Ctrl+C ends it with what there is.
"""


def add_arguments(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Adds the command to the parser."""
    parser = commands.add_parser(
        "accuracy",
        help="measure what accuracy costs in time",
        description="Measures error and time of many settings and names the cheapest ones.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog=_EPILOG,
    )
    parser.add_argument("scene", metavar="SCENE.blend", type=Path)
    parser.add_argument("-o", "--output", metavar="DIR", type=Path, required=True)
    add_scene_options(parser)
    parser.add_argument(
        "--crop",
        metavar="WxH|SHARE",
        type=_crop,
        help="size of the part that is rendered, in pixels or as a share of each side; 1 is the whole picture",
    )
    parser.add_argument(
        "--reference-seconds",
        metavar="S",
        type=_seconds,
        help=f"time for the reference (default {_SECONDS:g}, with --quick {_QUICK_SECONDS:g})",
    )
    parser.add_argument(
        "--until-stdin-ends",
        action="store_true",
        help="stop, with what there is, once standard input is closed",
    )
    parser.add_argument("--quick", action="store_true", help="fewer settings, a coarser reference")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> None:
    """Does what the command line asks for."""
    folder = options.output
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CommandError(f"{folder} cannot be made: {error.strerror}") from error
    blender_scene.register_engine()
    from ..sweep import Request, measure

    if options.until_stdin_ends:
        threading.Thread(target=_obey, args=(sys.stdin.fileno(),), daemon=True).start()
    b_scene = blender_scene.open_scene(options.scene)
    apply_scene_options(b_scene, options)
    blender_scene.keep_one_layer(b_scene)
    seconds = options.reference_seconds or (_QUICK_SECONDS if options.quick else _SECONDS)
    try:
        sweep = measure(b_scene, Request(seconds, options.quick, options.crop), folder, _print_step)
    except KeyboardInterrupt as error:
        raise CommandError("stopped before anything was measured") from error
    except OSError as error:
        raise CommandError(f"{folder} cannot be written: {error.strerror}") from error
    except Exception as error:
        if isinstance(error, UserError) or is_render_error(error):
            raise CommandError(str(error)) from error
        raise
    print("\n".join(table(sweep)))
    if sweep.state == "stopped":
        print(f"stopped after {len(sweep.rows)} runs", file=sys.stderr)


def _print_step(sweep: "Sweep") -> None:
    left = f"{clock(sweep.seconds_left)} left"
    print(f"{clock(sweep.seconds_spent)}  {sweep.message}, about {left}", flush=True)


def _obey(stream: int) -> None:
    """Stops the sweep once the stream ends; the process too when the sweep does not."""
    from ..sweep import request_stop

    while os.read(stream, 4096):
        pass
    request_stop()
    time.sleep(_STOP_SECONDS)
    os._exit(1)


def _crop(text: str) -> tuple[int, int] | float:
    """Parses 128x96, or 0.25."""
    try:
        share = float(text)
    except ValueError:
        return resolution(text)
    if not 0.0 < share <= 1.0:
        raise argparse.ArgumentTypeError(f"{text!r} is neither WxH, such as 128x128, nor a share from 0 to 1")
    return share


def _seconds(text: str) -> float:
    """Parses a positive number."""
    seconds = float(text)
    if not 0.0 < seconds < 1e6:
        raise argparse.ArgumentTypeError(f"{text!r} is no time in seconds")
    return seconds
