"""Settings of the render as a whole."""

# Blender reads properties from annotations, which are calls and no types.
# mypy: disable-error-code="valid-type"

import bpy


class RGPRenderSettings(bpy.types.PropertyGroup):
    """Threads and randomness."""

    threads: bpy.props.IntProperty(
        name="Threads",
        description="Threads to use; 0 takes all; changes nothing in the picture",
        default=0,
        min=0,
        max=1024,
    )
    seed: bpy.props.IntProperty(
        name="Seed",
        description="Another seed gives other noise",
        default=0,
        min=0,
        max=2_147_483_647,
    )
    memory_limit: bpy.props.IntProperty(
        name="Memory Limit",
        description=(
            "Memory a render may take: past it cells are made coarser, or the render is refused; "
            "0 takes nine tenths of the machine's"
        ),
        default=0,
        min=0,
        max=16_777_216,
    )
