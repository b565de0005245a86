"""Builds the scenes of this folder: `python scenes/build.py [NAME ...]`, all of them by default.

Run it with the oldest Blender that is supported (`bpy==4.2.23` on Python 3.11): later ones open what it saves.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from scenes import common, cornell_box, furnace, glossy_cornell, nave, table, two_rooms

SCENES = {
    "cornell_box": cornell_box,
    "glossy_cornell": glossy_cornell,
    "two_rooms": two_rooms,
    "furnace": furnace,
    "table": table,
    "nave": nave,
}
"""By the name of the file."""
KNOWN_ANSWERS = {"two_rooms": two_rooms.known_answer, "furnace": furnace.known_answer}
"""Scenes whose picture is known without rendering it."""


def main() -> None:
    """Builds the scenes named on the command line."""
    parser = argparse.ArgumentParser(description="Build the scenes and their known answers.")
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"one of {', '.join(SCENES)}; all when none is given"
    )
    names = parser.parse_args().names or list(SCENES)
    if unknown := set(names) - set(SCENES):
        parser.error(f"unknown scene {', '.join(sorted(unknown))}; there are {', '.join(SCENES)}")
    os.environ["HOME"] = "/"  # Blender writes the home folder into every file
    for name in names:
        SCENES[name].build()
        print(common.save(name).name)
    answers = {name: answer() for name, answer in KNOWN_ANSWERS.items()}
    (common.SCENES / "known_answers.json").write_text(json.dumps(answers, indent=2) + "\n")


if __name__ == "__main__":
    main()
