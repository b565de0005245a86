"""What concerns the scene as a whole."""

from typing import Any

from ..report import ProblemLog
from .context import ExportContext


def report_unsupported(b_scene: Any, log: ProblemLog) -> None:
    """Says which settings of Blender this release does not follow."""
    b_render = b_scene.render
    if b_render.use_multiview:
        log.add(b_scene.name, "stereo is not supported yet; every view shows the same picture")


def check_light(context: ExportContext) -> None:
    """Says so when nothing in the scene can give light."""
    if not context.emits:
        context.log.add(
            context.b_depsgraph.scene_eval.name,
            "there is no light: no lamp, no emissive material, a black world; the picture is black",
        )
