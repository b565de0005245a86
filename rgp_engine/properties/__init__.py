"""Everything the user can set, as property groups under `scene.rgp` and `view_layer.rgp`; and what a list needs.

Names, defaults and ranges of the scene's groups are those of the core's settings; a test compares both sides.
"""

# Blender reads properties from annotations, which are calls and no types.
# mypy: disable-error-code="valid-type"

import bpy

from .accuracy import RGPAccuracyList, RGPAccuracyRow
from .effects import RGPEffectSettings
from .film import RGPFilmSettings
from .gather import RGPGatherSettings
from .photon_pass import RGPPhotonPassSettings
from .pyramid import RGPPyramidSettings
from .render import RGPRenderSettings
from .view_layer import RGPViewLayerSettings

ENGINE_ID = "RGP"
"""Name of the engine in Blender's files."""


class RGPSceneSettings(bpy.types.PropertyGroup):
    """Settings of RGP Engine for one scene."""

    photon_pass: bpy.props.PointerProperty(type=RGPPhotonPassSettings)
    pyramid: bpy.props.PointerProperty(type=RGPPyramidSettings)
    gather: bpy.props.PointerProperty(type=RGPGatherSettings)
    effects: bpy.props.PointerProperty(type=RGPEffectSettings)
    film: bpy.props.PointerProperty(type=RGPFilmSettings)
    render: bpy.props.PointerProperty(type=RGPRenderSettings)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (
        RGPPhotonPassSettings,
        RGPPyramidSettings,
        RGPGatherSettings,
        RGPEffectSettings,
        RGPFilmSettings,
        RGPRenderSettings,
        RGPSceneSettings,
        RGPViewLayerSettings,
        RGPAccuracyRow,
        RGPAccuracyList,
    )
)


def register() -> None:
    """Adds the settings to scenes and view layers."""
    _register_classes()
    bpy.types.Scene.rgp = bpy.props.PointerProperty(type=RGPSceneSettings)
    bpy.types.ViewLayer.rgp = bpy.props.PointerProperty(type=RGPViewLayerSettings)
    bpy.types.WindowManager.rgp_accuracy = bpy.props.PointerProperty(type=RGPAccuracyList)


def unregister() -> None:
    """Takes the settings away again; files keep the values."""
    del bpy.types.WindowManager.rgp_accuracy
    del bpy.types.ViewLayer.rgp
    del bpy.types.Scene.rgp
    _unregister_classes()
