"""The core's scene of the file that is open in Blender, taken the way F12 takes it."""

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import bpy

from rgp_engine.cli.blender_scene import keep_one_layer
from rgp_engine.export import export_scene
from rgp_engine.report import ProblemLog

if TYPE_CHECKING:
    import rgp_core


@dataclass(frozen=True)
class CapturedScene:
    """A checked scene and what its export took."""

    scene: "rgp_core.Scene"
    seconds: float
    """From Blender's evaluated scene to the core's checked one."""


_captured: list[CapturedScene] = []


class CaptureEngine(bpy.types.RenderEngine):
    """Exports what it is asked to render, keeps the scene and renders nothing."""

    bl_idname = "RGP_BENCHMARK"
    bl_label = "RGP Engine Benchmark"

    def update(self, _data: Any = None, depsgraph: Any = None) -> None:
        """Blender calls it before `render`, with the scene evaluated for rendering."""
        self.exported = export_scene(self, depsgraph, ProblemLog())

    def render(self, depsgraph: Any) -> None:
        """Only the result knows how many pixels there are."""
        b_result = self.begin_result(
            0, 0, self.resolution_x, self.resolution_y, layer=depsgraph.view_layer_eval.name
        )
        start = time.perf_counter()
        scene = self.exported.finish((b_result.resolution_x, b_result.resolution_y))
        _captured.append(CapturedScene(scene, self.exported.seconds + time.perf_counter() - start))
        self.end_result(b_result)


def capture(b_scene: Any) -> CapturedScene:
    """Exports the scene. Raises RuntimeError when that fails; Blender has printed why."""
    b_scene.render.engine = CaptureEngine.bl_idname
    keep_one_layer(b_scene)
    bpy.ops.render.render(scene=b_scene.name)
    if not _captured:
        raise RuntimeError(f"the scene {b_scene.name} could not be exported")
    return _captured.pop()


register, unregister = bpy.utils.register_classes_factory((CaptureEngine,))
