"""Settings of the photon pass."""

# Blender reads properties from annotations, which are calls and no types.
# mypy: disable-error-code="valid-type"

import bpy


class RGPPhotonPassSettings(bpy.types.PropertyGroup):
    """How many photons carry the light into the scene."""

    photon_count: bpy.props.IntProperty(
        name="Photons",
        description="Photons emitted by all lights together; more make smoother indirect light",
        default=1_000_000,
        min=0,
        max=1_000_000_000,
        soft_min=10_000,
        soft_max=100_000_000,
    )
    caustic_count: bpy.props.IntProperty(
        name="Caustic Photons",
        description=(
            "Photons sent to mirrors and glass for caustics, where the scene has any; more make them sharper; "
            "0 leaves out those of small lights"
        ),
        default=1_000_000,
        min=0,
        max=1_000_000_000,
        soft_min=10_000,
        soft_max=100_000_000,
    )
    caustic_nearest: bpy.props.IntProperty(
        name="Caustic Nearest",
        description="Photons over which caustics are averaged; fewer make them sharper and noisier",
        default=64,
        min=2,
        max=1000,
    )
    caustic_solid_angle: bpy.props.FloatProperty(
        name="Caustic Solid Angle",
        description=(
            "Caustics of lights that mirrors and glass see smaller than this are made of photons, "
            "of wider ones of gather rays"
        ),
        default=0.5,
        min=0.0,
        max=12.0,
    )
    max_depth: bpy.props.IntProperty(
        name="Max Depth",
        description="Surfaces a photon may visit before it is dropped; low values darken the picture",
        default=64,
        min=1,
        max=1000,
    )
    aim: bpy.props.EnumProperty(
        name="Aim",
        description=(
            "Photons of suns and the world go where the picture looks; Auto: where most would miss it"
        ),
        items=(
            ("auto", "Auto", "Where most photons would land where nothing looks", 0),
            ("on", "On", "In any case", 1),
            ("off", "Off", "Photons are spread evenly over the whole scene", 2),
        ),
        default="auto",
    )
