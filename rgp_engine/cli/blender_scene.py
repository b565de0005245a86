"""A .blend file opened, set up, rendered and saved through Blender."""

import platform
from pathlib import Path
from typing import Any

from .. import register
from ..files import whole_file
from . import CommandError
from .assign import assign

# Reference quality: everything Cycles leaves out or smooths for speed is switched off.
_CYCLES_REFERENCE = (
    "device=CPU",
    "use_denoising=false",
    "use_adaptive_sampling=false",
    "sample_clamp_direct=0",
    "sample_clamp_indirect=0",
    "blur_glossy=0",
    "caustics_reflective=true",
    "caustics_refractive=true",
    "light_sampling_threshold=0",
    "time_limit=0",
)
_CYCLES_KINDS = ("diffuse", "glossy", "transmission")


def register_engine() -> None:
    """Makes the engine known to Blender, unless it is: there is one in a Blender that has the add-on enabled."""
    import bpy

    if not hasattr(bpy.types.Scene, "rgp"):
        register()


def open_scene(path: Path) -> Any:
    """The scene of a .blend file. Raises CommandError when it cannot be opened."""
    import bpy

    if not path.is_file():
        raise CommandError(f"{path} does not exist")
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path.absolute()), load_ui=False)
    except RuntimeError as error:
        raise CommandError(f"{path} cannot be opened: {_reason(error)}") from error
    return bpy.context.scene


def choose_engine(b_scene: Any, engine: str) -> None:
    """Makes the scene render by RGP, or by Cycles at reference quality."""
    if engine == "CYCLES":
        import addon_utils

        addon_utils.enable("cycles")
    b_scene.render.engine = engine
    if engine == "CYCLES":
        for assignment in _CYCLES_REFERENCE:
            assign(b_scene, f"cycles.{assignment}")


def keep_one_layer(b_scene: Any) -> Any:
    """Switches all view layers off but the first that is on, and returns it."""
    b_layers = [b_layer for b_layer in b_scene.view_layers if b_layer.use]
    if not b_layers:
        raise CommandError("no view layer of the scene is enabled for rendering")
    for b_layer in b_layers[1:]:
        b_layer.use = False
    return b_layers[0]


def add_indirect_passes(b_scene: Any, b_layer: Any) -> None:
    """Asks for the passes that hold the indirect light."""
    if b_scene.render.engine == "RGP":
        b_layer.rgp.use_pass_indirect = True
        return
    for kind in _CYCLES_KINDS:
        setattr(b_layer, f"use_pass_{kind}_indirect", True)
        setattr(b_layer, f"use_pass_{kind}_color", True)


def cycles_indirect_passes() -> list[tuple[str, str]]:
    """Names of Cycles' passes of indirect light and of the color to multiply each with."""
    import bpy

    if bpy.app.version >= (5, 0):
        return [(f"{kind.capitalize()} Indirect", f"{kind.capitalize()} Color") for kind in _CYCLES_KINDS]
    return [(f"{kind}Ind", f"{kind}Col") for kind in ("Diff", "Gloss", "Trans")]


def render_to(b_scene: Any, path: Path) -> None:
    """Renders the current frame with every pass into an OpenEXR file of 32-bit floats."""
    import bpy

    b_render = b_scene.render
    b_render.use_compositing = b_render.use_sequencer = b_render.use_multiview = False
    b_render.use_overwrite, b_render.use_placeholder = True, False
    _set_format(b_render.image_settings, "MULTI_LAYER_IMAGE", "OPEN_EXR_MULTILAYER", "32")
    b_render.image_settings.exr_codec = "ZIP"
    b_render.filepath = str(path)
    try:
        bpy.ops.render.render(write_still=True, scene=b_scene.name)
    except RuntimeError as error:
        raise CommandError(_reason(error)) from error
    if not path.is_file():
        raise CommandError("Blender has written no picture")


def save_png(b_scene: Any, path: Path) -> None:
    """Saves the last render as Blender shows it, view transform and all."""
    import bpy

    b_settings = b_scene.render.image_settings
    _set_format(b_settings, "IMAGE", "PNG", "8")
    b_settings.color_mode = "RGBA" if b_scene.render.film_transparent else "RGB"
    try:
        with whole_file(path) as part:
            bpy.data.images["Render Result"].save_render(str(part), scene=b_scene)
    except RuntimeError as error:
        raise CommandError(f"{path} cannot be written: {_reason(error)}") from error
    except OSError as error:
        raise CommandError(f"{path} cannot be written: {error.strerror}") from error


def versions() -> dict[str, str]:
    """Versions of Blender and Python."""
    import bpy

    return {"blender": bpy.app.version_string, "python": platform.python_version()}


def _set_format(b_settings: Any, media_type: str, file_format: str, depth: str) -> None:
    # From Blender 5.0 on the kind of file decides which formats there are.
    if hasattr(b_settings, "media_type"):
        b_settings.media_type = media_type
    b_settings.file_format = file_format
    b_settings.color_depth = depth


def _reason(error: RuntimeError) -> str:
    """Blender's report without its "Error: "."""
    return str(error).strip().removeprefix("Error: ").strip()
