"""One render of one view layer: export, native render, picture, progress, and whatever goes wrong meanwhile."""

import platform
import time
import traceback
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy

from . import native, report, stats
from .checkpoint import Checkpoint
from .export import ExportedScene, export_scene
from .export.context import Cancelled
from .report import Outcome, ProblemLog, UserError
from .settings import core_settings

if TYPE_CHECKING:
    import rgp_core

_POLL_SECONDS = 0.05
_STATUS_SECONDS = 0.25
_PICTURE_SECONDS = 0.4
# Writing the picture may take this share of the time at most, however large it is.
_PICTURE_SHARE = 0.1
_CHECKPOINT_SECONDS = 60.0


class RenderSession:
    """A render from export to end result. Nothing that goes wrong leaves it as an exception."""

    def __init__(self, engine: Any, b_depsgraph: Any) -> None:
        self._engine = engine
        self._b_depsgraph = b_depsgraph
        self._log = ProblemLog()
        self._exported: ExportedScene | None = None
        self._memory_peak = 0
        self._error_target = 0.0
        self._stats: dict[str, Any] = {}
        self._error = ""
        self._cancelled = False

    def export(self) -> None:
        """Takes the scene from Blender. For `RenderEngine.update`, where Blender locks the scene."""
        try:
            self._exported = export_scene(self._engine, self._b_depsgraph, self._log)
        except Cancelled:
            self._cancelled = True
        except Exception as error:  # noqa: BLE001 (one readable message, whatever it is)
            self._fail(error)

    def render(self) -> None:
        """Renders what was exported. Afterwards there is a merged result: Blender crashes without."""
        engine = self._engine
        b_result = None
        try:
            b_result = engine.begin_result(
                0,
                0,
                engine.resolution_x,
                engine.resolution_y,
                layer=self._b_depsgraph.view_layer_eval.name,
            )
            if self._exported is not None:
                self._render(self._exported, b_result)
        except Exception as error:  # noqa: BLE001 (one readable message, whatever it is)
            self._fail(error)
        finally:
            self._exported = None
            if b_result is not None:
                engine.end_result(b_result)
        self._report()

    def _render(self, exported: ExportedScene, b_result: Any) -> None:
        """Finishes the scene for the result's part of the frame, renders it, keeps the picture."""
        scene = exported.finish((b_result.resolution_x, b_result.resolution_y))
        self._log.add_records(scene.problems)
        settings = core_settings(self._b_depsgraph.scene_eval)
        machine = settings.get("render", {})
        limit = machine.get("memory_limit") or native.memory_allowed()
        limited = {**settings, "render": {**machine, "memory_limit": limit}}
        core_session = native.core().Session(scene, limited, str(native.embree_library()))
        self._error_target = settings["gather"]["error_target"]
        checkpoint = self._take_up(core_session)
        core_session.start()
        try:
            self._watch(core_session, b_result, checkpoint)
        except BaseException:
            core_session.cancel()
            raise
        finally:
            self._cancelled = not core_session.finish()
        _write_passes(core_session, b_result)
        core_stats = core_session.stats()
        if checkpoint is not None and not self._cancelled:
            self._keep(core_session, checkpoint, is_complete=core_stats["stopped_by"] == "rays")
        for warning in core_stats["warnings"]:
            self._log.add("Render", warning)
        self._stats = self._complete(core_stats, exported.seconds, settings)

    def _take_up(self, core_session: "rgp_core.Session") -> Checkpoint | None:
        """The view layer's checkpoint, if it has one, after what it holds has been given to the core."""
        path = self._b_depsgraph.view_layer_eval.rgp.checkpoint
        if not path:
            return None
        checkpoint = Checkpoint(Path(bpy.path.abspath(path)), core_session.fingerprint())
        kept = checkpoint.read()
        if kept is not None:
            core_session.restore_film(*kept)
        return checkpoint

    def _keep(
        self, core_session: "rgp_core.Session", checkpoint: Checkpoint, *, is_complete: bool = False
    ) -> None:
        """Keeps the passes so far; of a picture that is complete nothing has to be kept."""
        try:
            if is_complete:
                checkpoint.remove()
            elif (state := core_session.film_state()) is not None:
                checkpoint.write(*state)
        except OSError as error:
            self._log.add(str(checkpoint.path), f"the checkpoint cannot be written: {error.strerror}")

    def _watch(self, core_session: "rgp_core.Session", b_result: Any, checkpoint: Checkpoint | None) -> None:
        """Until the render has ended: obeys Esc, shows progress, and the picture as it fills in; keeps its passes."""
        next_status = next_picture = time.monotonic()
        next_checkpoint = next_status + _CHECKPOINT_SECONDS
        passes_shown = 0
        self._show_status(core_session.progress())
        while not core_session.wait(_POLL_SECONDS):
            if self._engine.test_break():
                if checkpoint is not None:
                    self._keep(core_session, checkpoint)
                core_session.cancel()
                return
            now = time.monotonic()
            if now < next_status:
                continue
            next_status = now + _STATUS_SECONDS
            progress = core_session.progress()
            self._show_status(progress)
            if checkpoint is not None and now >= next_checkpoint:
                self._keep(core_session, checkpoint)
                next_checkpoint = time.monotonic() + _CHECKPOINT_SECONDS
            if progress["passes_done"] > passes_shown and now >= next_picture:
                passes_shown = progress["passes_done"]
                _write_pass(b_result, "Combined", core_session.picture("combined"))
                self._engine.update_result(b_result)
                cost = time.monotonic() - now
                next_picture = now + max(_PICTURE_SECONDS, cost / _PICTURE_SHARE)

    def _show_status(self, progress: dict[str, Any]) -> None:
        """Progress bar, stage, time left and memory (MiB)."""
        elapsed, left = progress["seconds_elapsed"], progress["seconds_left"]
        memory = progress["memory_bytes"]
        self._memory_peak = max(self._memory_peak, memory)
        status = progress["stage"]
        if left is not None:
            self._engine.update_progress(elapsed / max(elapsed + left, 1e-6))
            status += f" | Remaining {stats.clock(left)}"
        if progress["error"] is not None:
            status += f" | Error {stats.outlook(progress, self._error_target)}"
        self._engine.update_memory_stats(memory_used=memory / 2**20, memory_peak=self._memory_peak / 2**20)
        self._engine.update_stats("", f"{status} | Mem {memory / 2**20:.0f} MiB")

    def _complete(
        self, core_stats: dict[str, Any], export_seconds: float, settings: dict[str, dict[str, Any]]
    ) -> dict[str, Any]:
        """The core's figures with those only the host knows."""
        versions = {
            **native.versions(),
            "blender": bpy.app.version_string,
            "python": platform.python_version(),
        }
        figures = {**core_stats, "memory_peak_bytes": self._memory_peak}
        return stats.complete(figures, export_seconds, versions, settings, self._log.problems)

    def _fail(self, error: Exception) -> None:
        """Keeps the message for the artist; the console gets whatever is a bug in full."""
        if isinstance(error, UserError) or native.is_render_error(error):
            self._error = str(error)
            return
        traceback.print_exc()
        self._error = f"Internal error, details in the console. {type(error).__name__}: {error}"

    def _report(self) -> None:
        """Says how it went, once, in Blender's own reports and in the Problems panel."""
        report.publish(Outcome(self._log.problems, self._stats, self._error, self._cancelled))
        if self._error:
            self._engine.report({"ERROR"}, self._error)
        elif self._log.problems:
            self._engine.report({"WARNING"}, self._log.summary())


def _write_passes(core_session: "rgp_core.Session", b_result: Any) -> None:
    """All passes of the result that the core has a picture for."""
    names = {b_pass.name for b_pass in b_result.layers[0].passes}
    for name in ("Combined", "Indirect", "Shadow Catcher", "Error", "Audit"):
        if name in names:
            layer = name.lower().replace(" ", "_")
            _write_pass(b_result, name, core_session.picture(layer))


def _write_pass(b_result: Any, name: str, picture: Any) -> None:
    """Copies a picture (height, width, channels) into a pass, the same in every stereo view."""
    for b_pass in b_result.layers[0].passes:
        if b_pass.name == name:
            b_pass.rect.foreach_set(picture.reshape(-1))
