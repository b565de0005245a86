"""Text as `--set` takes it: refused with what exists, or it becomes settings that the core takes."""

from __future__ import annotations

import contextlib

import atheris
import bpy
import rgp_core

with atheris.instrument_imports(include=["rgp_engine"]):
    import rgp_engine
    from rgp_engine.cli import CommandError
    from rgp_engine.cli.assign import assign
    from rgp_engine.settings import core_settings, set_core_value

from tests.fuzz.draw import Draw, fuzz

KNOBS = rgp_core.settings_schema()
GROUPS = ["cycles", "rgp", "name", "rna_type", "", "bl_rna", "__class__"]
VALUES = [
    "",
    "0",
    "1",
    "-1",
    "nan",
    "inf",
    "1e999",
    "1_0",
    "8x16",
    "0x0",
    "x",
    "true",
    "auto",
    "9" * 30,
    "٣",
    "54",
]


def try_settings(draw: Draw) -> None:
    b_scene = bpy.context.scene
    for _ in range(draw.below(6)):
        knob = draw.choice(KNOBS)
        group = knob["group"] if draw.below(8) else draw.choice([*GROUPS, draw.text(8)])
        name = knob["name"] if draw.below(8) else draw.choice([*GROUPS, draw.text(8)])
        kind = draw.below(4)
        value = [str(draw.number()), str(draw.whole()), draw.text(12), draw.choice(VALUES)][kind]
        assignment = f"{group}.{name}={value}" if draw.below(16) else draw.text(20)
        with contextlib.suppress(CommandError):
            assign(b_scene, assignment)
    settings = core_settings(b_scene)
    rgp_core.check_settings(settings)
    for group, names in settings.items():
        for name, value in names.items():
            set_core_value(getattr(b_scene.rgp, group), name, value)
    assert core_settings(b_scene) == settings


if __name__ == "__main__":
    rgp_engine.register()
    fuzz(try_settings)
