"""Settings of a view layer."""

# Blender reads properties from annotations, which are calls and no types.
# mypy: disable-error-code="valid-type"

from typing import Any

import bpy


def _update_passes(group: Any, _context: Any) -> None:
    for b_view_layer in group.id_data.view_layers:
        b_view_layer.update_render_passes()


class RGPViewLayerSettings(bpy.types.PropertyGroup):
    """Passes of RGP Engine, and where a picture is kept that is not finished."""

    checkpoint: bpy.props.StringProperty(
        name="Checkpoint",
        description="File that keeps the unfinished picture, once a minute and when the render is stopped: rendering "
        "the same again goes on from there. Removed when the picture is finished; none if empty",
        default="",
        subtype="FILE_PATH",
    )

    use_pass_indirect: bpy.props.BoolProperty(
        name="Indirect",
        description="Deliver the indirect light alone as a pass of its own",
        default=False,
        update=_update_passes,
    )
    use_pass_shadow_catcher: bpy.props.BoolProperty(
        name="Shadow Catcher",
        description="Deliver the share of their light that other objects leave to shadow catchers as a pass of its "
        "own, to multiply a background with",
        default=False,
        update=_update_passes,
    )
    use_pass_error: bpy.props.BoolProperty(
        name="Error",
        description="Deliver the noise of the picture, the standard error of every pixel, as a pass of its own",
        default=False,
        update=_update_passes,
    )
    use_pass_audit: bpy.props.BoolProperty(
        name="Audit",
        description="Deliver the cells that an audit found wrong as a pass of its own: from -1, all their light is "
        "missing, to 1, there should be none. Asks for Gather > Audit",
        default=False,
        update=_update_passes,
    )
