"""`python -m rgp_engine`: the command line."""

import argparse
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

from .cli import CommandError, accuracy, compare, render


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs one command. Returns the exit code: 0 done, 1 failed, 2 asked for something that does not exist."""
    parser = argparse.ArgumentParser(
        prog="python -m rgp_engine",
        description="Render Blender files without Blender's window, and measure how accurate pictures are.",
    )
    commands = parser.add_subparsers(dest="command", required=True)
    render.add_arguments(commands)
    accuracy.add_arguments(commands)
    compare.add_arguments(commands)
    options = parser.parse_args(arguments)
    try:
        options.run(options)
    except CommandError as error:
        print(f"error: {error}", file=sys.stderr)
        return error.exit_code
    return 0


def leave(exit_code: int) -> NoReturn:
    """Ends the process at once where Blender is loaded: some versions hang or crash in their exit handlers."""
    sys.stdout.flush()
    sys.stderr.flush()
    if "bpy" in sys.modules:
        os._exit(exit_code)
    sys.exit(exit_code)


if __name__ == "__main__":
    leave(main())
