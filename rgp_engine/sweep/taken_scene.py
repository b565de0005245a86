"""A scene taken from Blender once, to be rendered many times."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import bpy

from ..export import export_scene
from ..report import ProblemLog, UserError
from ..settings import core_settings

if TYPE_CHECKING:
    import rgp_core

Border = tuple[float, float, float, float]
"""Left, right, bottom and top, as fractions of the frame."""


@dataclass(frozen=True)
class TakenScene:
    """What the core needs to render."""

    scene: "rgp_core.Scene"
    settings: dict[str, dict[str, Any]]
    seconds: float
    """Time the export took."""


class _SceneTaker(bpy.types.RenderEngine):
    """An engine that exports and renders nothing: only in a render does Blender evaluate a scene as for a render."""

    bl_idname = "RGP_SCENE_TAKER"
    bl_label = "RGP Scene Taker"

    outcome: TakenScene | Exception
    """Of the last render."""

    def update(self, data: Any = None, depsgraph: Any = None) -> None:  # noqa: ARG002 (Blender's)
        self.exported = None
        try:
            self.exported = export_scene(self, depsgraph, ProblemLog())
        except Exception as error:  # noqa: BLE001 (handed to whoever asked for the scene)
            _SceneTaker.outcome = error

    def render(self, depsgraph: Any) -> None:
        layer = depsgraph.view_layer_eval.name
        b_result = self.begin_result(0, 0, self.resolution_x, self.resolution_y, layer=layer)
        try:
            if self.exported is not None:
                scene = self.exported.finish((b_result.resolution_x, b_result.resolution_y))
                settings = core_settings(depsgraph.scene_eval)
                _SceneTaker.outcome = TakenScene(scene, settings, self.exported.seconds)
        except Exception as error:  # noqa: BLE001 (handed to whoever asked for the scene)
            _SceneTaker.outcome = error
        finally:
            self.end_result(b_result)

    @classmethod
    def result(cls) -> TakenScene:
        """The outcome, or the failure raised."""
        if isinstance(cls.outcome, Exception):
            raise cls.outcome
        return cls.outcome


def take_scene(b_scene: Any, border: Border) -> TakenScene:
    """The scene as F12 would render a part of the frame. Raises UserError, and whatever the core raises."""
    b_render = b_scene.render
    b_render.use_border = b_render.use_crop_to_border = True
    b_render.border_min_x, b_render.border_max_x, b_render.border_min_y, b_render.border_max_y = border
    b_render.use_compositing = b_render.use_sequencer = b_render.use_multiview = False
    _SceneTaker.outcome = UserError("Blender has rendered nothing")
    bpy.utils.register_class(_SceneTaker)
    try:
        b_render.engine = _SceneTaker.bl_idname
        bpy.ops.render.render(scene=b_scene.name)
    except RuntimeError as error:
        raise UserError(str(error).strip().removeprefix("Error: ")) from error
    finally:
        bpy.utils.unregister_class(_SceneTaker)
    return _SceneTaker.result()


def border_of(b_scene: Any) -> Border:
    """The part of the frame that F12 renders."""
    b_render = b_scene.render
    if not b_render.use_border:
        return (0.0, 1.0, 0.0, 1.0)
    return (b_render.border_min_x, b_render.border_max_x, b_render.border_min_y, b_render.border_max_y)
