"""From Blender's evaluated depsgraph to the core's scene: the table of contents of the export."""

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .. import native
from ..report import ProblemLog
from .camera import camera_record, render_region
from .context import ExportContext
from .instance import export_instances
from .motion import Moving, at_middle, shutter
from .scene import check_light, report_unsupported
from .world import world_record

if TYPE_CHECKING:
    import rgp_core


@dataclass
class ExportedScene:
    """A scene in the core's hands, complete but for the part of the frame that is rendered."""

    builder: "rgp_core.SceneBuilder"
    camera: dict[str, Any]
    border: tuple[float, float] | None
    """Lower left corner of the render border, as fractions of the frame; None without border."""
    seconds: float
    """Time the export took."""

    def finish(self, size: tuple[int, int]) -> "rgp_core.Scene":
        """The checked scene, for a picture of `size` pixels."""
        region = render_region(self.camera["resolution"], self.border, size)
        self.builder.set_camera({**self.camera, "region": region})
        return self.builder.finish()


def export_scene(engine: Any, b_depsgraph: Any, log: ProblemLog) -> ExportedScene:
    """Takes everything from Blender that a render needs. Raises UserError when nothing can be rendered."""
    start = time.perf_counter()
    b_scene = b_depsgraph.scene_eval
    context = ExportContext(engine, b_depsgraph, native.core().SceneBuilder(), log)
    report_unsupported(b_scene, log)
    times = shutter(b_depsgraph)
    if times is None:
        camera = _export_parts(context, None)
    else:
        with at_middle(context, times):
            moving = Moving()
            camera = _export_parts(context, moving)
            moving.export(context, camera, times)
    b_render = b_depsgraph.scene_eval.render
    border = (b_render.border_min_x, b_render.border_min_y) if b_render.use_border else None
    return ExportedScene(context.builder, camera, border, time.perf_counter() - start)


def _export_parts(context: ExportContext, moving: Moving | None) -> dict[str, Any]:
    """Hands everything but the camera to the core, and gives the camera's record."""
    camera = camera_record(context)
    export_instances(context, moving)
    context.builder.set_world(world_record(context))
    check_light(context)
    return camera
