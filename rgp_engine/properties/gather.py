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
    audit: bpy.props.IntProperty(
        name="Audit One In",
        description="One gather hit in so many is also followed along a path to its end, which measures how far the "
        "pyramid is off; 0 for none; changes nothing in the picture",
        default=1000,
        min=0,
        max=1_000_000,
        soft_max=10_000,
    )
    # For measurements, by `--set`: no panel shows these two.
    estimator: bpy.props.EnumProperty(
        name="Estimator",
        description="Where gather rays read the light: the pyramid, or another method to measure it against",
        items=(
            ("pyramid", "Pyramid", "The Radiance Grid Pyramid", 0),
            ("pyramid_2006", "Pyramid as Published", "The pyramid exactly as the paper has it", 1),
            ("photon_map", "Photon Map", "The nearest photons, looked up at every hit", 2),
            ("precomputed_irradiance", "Precomputed Irradiance", "Irradiance at every fourth photon", 3),
            ("uniform_grid", "Uniform Grid", "Cells, added until they hold enough photons", 4),
            ("reverse_photon_map", "Reverse Photon Map", "Photons that look for the hits near them", 5),
            ("path", "Path", "Nothing stored: every path is followed to its end", 6),
        ),
        default="pyramid",
        options={"HIDDEN"},
    )
    photons_per_estimate: bpy.props.IntProperty(
        name="Photons per Estimate",
        description="Photons an estimate reaches to, where photons are read one by one; "
        "the pyramid does not use it",
        default=50,
        min=2,
        max=10_000,
        options={"HIDDEN"},
    )
