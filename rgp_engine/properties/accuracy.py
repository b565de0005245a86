"""The list of the Accuracy panel. It belongs to the window and is in no file."""

# Blender reads properties from annotations, which are calls and no types.
# mypy: disable-error-code="valid-type"

import bpy


class RGPAccuracyRow(bpy.types.PropertyGroup):
    """A line of the list; what it shows is the row of the front of the same index."""


class RGPAccuracyList(bpy.types.PropertyGroup):
    """Settings worth their time, and the chosen one."""

    rows: bpy.props.CollectionProperty(type=RGPAccuracyRow)
    chosen: bpy.props.IntProperty(name="Chosen Row", min=0)
