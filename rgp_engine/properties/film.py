"""Settings of the film."""

# Blender reads properties from annotations, which are calls and no types.
# mypy: disable-error-code="valid-type"

import bpy


class RGPFilmSettings(bpy.types.PropertyGroup):
    """How samples become pixels."""

    filter: bpy.props.EnumProperty(
        name="Pixel Filter",
        description="Pixel filter",
        items=(
            ("blackman_harris", "Blackman-Harris", "Smooth, as Cycles uses by default", 0),
            ("box", "Box", "All the same, one pixel wide", 1),
        ),
        default="blackman_harris",
    )
    filter_width: bpy.props.FloatProperty(
        name="Filter Width",
        description="Width of the pixel filter as in Cycles: a box is that wide, "
        "Blackman-Harris reaches that far to either side",
        default=1.5,
        min=0.1,
        max=10.0,
        subtype="PIXEL",
    )
    exposure: bpy.props.FloatProperty(
        name="Exposure",
        description="Factor of all light in the picture, as Cycles' exposure",
        default=1.0,
        min=0.0,
        max=1e6,
        soft_max=10.0,
    )
    tile_size: bpy.props.IntProperty(
        name="Tile Size",
        description="Edge of the tiles the picture is cut into; changes nothing in the picture",
        default=64,
        min=4,
        max=4096,
        subtype="PIXEL",
    )
