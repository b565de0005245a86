"""Blender's own panels that are shown for this engine too."""

from collections.abc import Iterator
from typing import Any

import bpy

from ..properties import ENGINE_ID

_GENERAL_ENGINE = "BLENDER_RENDER"

# Of Blender's own engines, and the same for this one.
_INCLUDED = {"DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture"}

# Panels for every engine that would show what this one does not render, or that have a twin here.
_EXCLUDED = {
    "DATA_PT_area",
    "DATA_PT_camera_stereoscopy",
    "DATA_PT_cone",
    "DATA_PT_distance",
    "DATA_PT_falloff_curve",
    "DATA_PT_light",
    "DATA_PT_preview",
    "DATA_PT_shadow",
    "DATA_PT_spot",
    "DATA_PT_volume_render",
    "MATERIAL_PT_context_material",
    "MATERIAL_PT_preview",
    "OBJECT_PT_shading",
    "OBJECT_PT_visibility",
    "RENDER_PT_output_views",
    "RENDER_PT_stereoscopy",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",
}
_FREESTYLE = ("MATERIAL_PT_freestyle", "RENDER_PT_freestyle", "VIEWLAYER_PT_freestyle")


def show() -> None:
    """Shows them for this engine."""
    for b_panel in _panels():
        b_panel.COMPAT_ENGINES.add(ENGINE_ID)


def hide() -> None:
    """Takes that back. Several panels share one set of engines, so it may be gone from theirs already."""
    for b_panel in _panels():
        b_panel.COMPAT_ENGINES.discard(ENGINE_ID)


def _panels() -> Iterator[Any]:
    for b_panel in bpy.types.Panel.__subclasses__():
        # The node editor's sidebar has twins of some, which share their set of engines.
        name = b_panel.__name__.removeprefix("NODE_")
        if name not in _INCLUDED and _GENERAL_ENGINE not in getattr(b_panel, "COMPAT_ENGINES", ()):
            continue
        if name not in _EXCLUDED and not name.startswith(_FREESTYLE):
            yield b_panel
