"""Settings of the final gather."""

# Blender reads properties from annotations, which are calls and no types.
# mypy: disable-error-code="valid-type"

import bpy


class RGPGatherSettings(bpy.types.PropertyGroup):
    """How the picture collects the stored light."""

    rays: bpy.props.IntProperty(
        name="Rays",
        description="Gather rays per pixel, shared among its camera samples; more make less noise",
        default=256,
        min=1,
        max=4096,
        soft_min=16,
        soft_max=1024,
    )
    camera_samples: bpy.props.IntProperty(
        name="Camera Samples",
        description="Camera samples per pixel, for smooth edges and shadows",
        default=16,
        min=1,
        max=1024,
        soft_max=256,
    )
    light_samples: bpy.props.IntProperty(
        name="Light Samples",
        description="Shadow rays per camera sample",
        default=1,
        min=1,
        max=64,
    )
    time_limit: bpy.props.FloatProperty(
        name="Time Limit",
        description="The render ends with the pass over the picture that fits into this time; at least two are made; "
        "0 for no limit",
        default=0.0,
        min=0.0,
        max=1e9,
        soft_max=3600.0,
        unit="TIME_ABSOLUTE",
    )
    error_target: bpy.props.FloatProperty(
        name="Error Target",
        description="The render ends when its noise falls below this share of the picture's mean; 0 to trace all rays",
        default=0.0,
        min=0.0,
        max=100.0,
        soft_max=10.0,
        precision=2,
        subtype="PERCENTAGE",
    )
    sampling: bpy.props.EnumProperty(
        name="Sampling",
        description="Gather rays follow the surface's reflection (cosine), or are uniform over the hemisphere "
        "as in the paper",
        items=(
            ("cosine", "Importance", "More rays where the surface reflects more light", 0),
            ("uniform", "Uniform", "The same number of rays in every direction", 1),
        ),
        default="cosine",
    )
    retrace_distance: bpy.props.FloatProperty(
        name="Retrace Distance",
        description="Gather rays shorter than this many cells are continued one bounce, "
        "which keeps corners right; 0 never",
        default=1.7320508,
        min=0.0,
        max=8.0,
        precision=3,
    )
    max_depth: bpy.props.IntProperty(
        name="Max Depth",
        description="Mirror, glass and short-ray bounces after which a path ends",
        default=32,
        min=1,
        max=1000,
    )
