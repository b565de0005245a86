"""Switches of the effects."""

# Blender reads properties from annotations, which are calls and no types.
# mypy: disable-error-code="valid-type"

from typing import Any

import bpy

_ITEMS = (
    ("auto", "Auto", "Computed where something in the scene asks for it", 0),
    ("on", "On", "Computed in any case; changes nothing where nothing asks for it", 1),
    ("off", "Off", "Not computed: its light is left out of the picture", 2),
)


def _switch(name: str, description: str) -> Any:
    return bpy.props.EnumProperty(name=name, description=description, items=_ITEMS, default="auto")


class RGPEffectSettings(bpy.types.PropertyGroup):
    """Whether each effect is computed."""

    direct_light: _switch(
        "Direct Light",
        "Light that comes straight from lights to surfaces the camera sees; Off leaves it out",
    )
    indirect_diffuse: _switch(
        "Indirect Diffuse",
        "Light that comes by way of diffuse surfaces; Off leaves it out, and its photons",
    )
    indirect_glossy: _switch(
        "Indirect Glossy",
        "Light that comes by way of glossy surfaces; Off leaves it out, and the direction bins",
    )
    caustics: _switch(
        "Caustics", "Light that mirrors and glass throw on surfaces the camera sees; Off leaves it out"
    )
    mirrors_and_glass: _switch(
        "Mirrors and Glass", "Mirrors, glass and sharp reflections; Off makes them black"
    )
    environment_light: _switch("Environment Light", "Light of the world; Off makes the world black")
    emissive_meshes: _switch("Emissive Meshes", "Light of emissive surfaces; Off makes them dark")
    alpha_transparency: _switch(
        "Alpha Transparency",
        "Light straight through transparent surfaces; Off makes them opaque",
    )
    absorption: _switch(
        "Absorption",
        "Light that is absorbed on its way through colored glass and water; Off makes them clear",
    )
    depth_of_field: _switch(
        "Depth of Field",
        "Blur of what is not in focus, where the camera's depth of field is on; Off makes everything sharp",
    )
    motion_blur: _switch(
        "Motion Blur",
        "Blur of what moves while the shutter is open, where the scene's motion blur is on; "
        "Off makes everything stand still",
    )
    shadow_catcher: _switch(
        "Shadow Catcher",
        "Shadows on shadow catchers in place of the catchers themselves; Off shows these as ordinary objects",
    )
