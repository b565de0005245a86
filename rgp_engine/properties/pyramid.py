"""Settings of the Radiance Grid Pyramid."""

# Blender reads properties from annotations, which are calls and no types.
# mypy: disable-error-code="valid-type"

from typing import Any

import bpy

MAX_ELEVATION_BINS = 32


def _clamp_bins(group: Any, _context: Any) -> None:
    """Elevation has half the range of azimuth, which one vector property cannot say."""
    if group.bins[0] > MAX_ELEVATION_BINS:
        group.bins = (MAX_ELEVATION_BINS, group.bins[1])


class RGPPyramidSettings(bpy.types.PropertyGroup):
    """How finely the light in the scene is stored."""

    finest_resolution: bpy.props.IntProperty(
        name="Finest Resolution",
        description="Cells of the finest level along the longest side of what the camera and its gather rays see",
        default=128,
        min=1,
        max=1024,
        soft_min=16,
        soft_max=512,
    )
    adaptive_levels: bpy.props.IntProperty(
        name="Adaptive Levels",
        description=(
            "Levels with cells finer than that, made where gather rays end nearby and photons are plenty; "
            "0 for equal cells everywhere"
        ),
        default=2,
        min=0,
        max=3,
    )
    bins: bpy.props.IntVectorProperty(
        name="Direction Bins",
        description="Direction bins of glossy cells, elevation x azimuth; diffuse cells have none",
        size=2,
        default=(8, 16),
        min=1,
        max=64,
        update=_clamp_bins,
    )
    normal_classes: bpy.props.EnumProperty(
        name="Normal Classes",
        description="Directions that keep surfaces in one cell apart: the six faces of a cube, or nine parts of each",
        items=(
            ("6", "6", "The six sides of a cube", 0),
            ("54", "54", "Nine for each side of a cube: less mixing on curved surfaces", 1),
        ),
        default="54",
    )
    photons_per_cell: bpy.props.IntProperty(
        name="Photons per Cell",
        description="A cell is read from its parent where the parent holds fewer than four times as many photons",
        default=4,
        min=1,
        max=1000,
    )
