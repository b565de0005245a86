"""Options of every command that renders a scene."""

import argparse
from typing import Any

from .assign import assign


def add_scene_options(parser: argparse.ArgumentParser) -> None:
    """Adds them to a command's parser."""
    parser.add_argument(
        "--set", metavar="GROUP.NAME=VALUE", action="append", default=[], help="change a setting"
    )
    parser.add_argument("--resolution", metavar="WxH", type=resolution, help="pixels of the full frame")
    parser.add_argument(
        "--frame", metavar="N", type=int, help="frame to render instead of the file's current"
    )
    parser.add_argument("--threads", metavar="N", type=int, help="processor threads; 0 takes all")
    parser.add_argument("--seed", metavar="N", type=int, help="another seed gives other noise")


def apply_scene_options(b_scene: Any, options: argparse.Namespace, engine: str = "RGP") -> None:
    """Frame, size and settings, for rendering with that engine. Raises CommandError."""
    if options.frame is not None:
        b_scene.frame_set(options.frame)
    if options.resolution:
        b_render = b_scene.render
        b_render.resolution_x, b_render.resolution_y = options.resolution
        b_render.resolution_percentage = 100
    group = "render" if engine == "RGP" else "cycles"
    if options.seed is not None:
        assign(b_scene, f"{group}.seed={options.seed}")
    if options.threads is not None:
        # Blender's own number of threads is Cycles'; 0 is ours for all.
        assign(b_scene, f"render.threads={options.threads}")
        b_scene.render.threads_mode = "FIXED" if options.threads else "AUTO"
        b_scene.render.threads = max(options.threads, 1)
    for assignment in options.set:
        assign(b_scene, assignment)


def resolution(text: str) -> tuple[int, int]:
    """Parses 640x480."""
    width, _, height = text.partition("x")
    if not (width.isdecimal() and height.isdecimal() and int(width) and int(height)):
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form WxH, such as 640x480")
    return int(width), int(height)
