"""The scenes: whose they are, and whether their pictures may be shown. All but one are no part of the project."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import bpy

from rgp_engine.cli import blender_scene

from . import window


@dataclass(frozen=True)
class Subject:
    """One scene."""

    name: str
    """Of its file, less the ending."""
    credit: str
    """Title, author and license, for the page."""
    may_be_shown: bool = True
    """Whether pictures of it may go into the documentation."""

    def open(self, folder: Path) -> bpy.types.Scene:
        """Opens its file in the folder, or builds the scene that has none."""
        if self.name == WINDOW:
            return window.build()
        return blender_scene.open_scene(folder / f"{self.name}.blend")


WINDOW = "hdri_window"


_CC_BY = "[CC BY 3.0](https://creativecommons.org/licenses/by/3.0/), converted to Blender"

SUBJECTS = (
    Subject(WINDOW, window.CREDIT),
    Subject("awkward_cad", "Test models of trimesh, MIT"),
    Subject("bevy_gi_hall", "Bevy Baked GI Demo by DGriffin91, MIT or Apache-2.0"),
    Subject("cornell_original", "Cornell Box by Guedis Cardenas and Morgan McGuire, public domain"),
    Subject("dupliverts_nested", "Dupli verts of appleseedhq/blenderseed, MIT"),
    Subject("ignis_diamond", "Ignis technique showcase by Ömercan Yazici, MIT"),
    Subject("japanese_classroom", f"Japanese Classroom by NovaZeeke, {_CC_BY}"),
    Subject("modern_hall", f"Modern Hall by NewSee2l035, {_CC_BY}"),
    Subject("sibenik", "Sibenik Cathedral by Marko Dabrovic; its license is not clear", may_be_shown=False),
    Subject("veach_ajar", "Veach, Ajar by Benedikt Bitterli, CC0"),
    Subject(
        "water_caustic", "Water Caustic by Benedikt Bitterli, example scene of Tungsten, zlib-style license"
    ),
    Subject("wooden_staircase", f"The Wooden Staircase by Wig42, {_CC_BY}"),
)
