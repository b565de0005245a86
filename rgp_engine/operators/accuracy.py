"""Buttons of the Accuracy panel: measure, stop, show, apply."""

import atexit
import sys
import tempfile
from pathlib import Path
from typing import Any

import bpy
from bpy.app.handlers import persistent
from bpy.types import Operator

from ..accuracy import background
from ..accuracy.background import BackgroundSweep
from ..accuracy.figure import IMAGE_NAME, PNG
from ..accuracy.quality import PLACES
from ..accuracy.result import Sweep
from ..properties import ENGINE_ID
from ..settings import set_core_value
from ..stats import clock

_POLL_SECONDS = 0.5
_PACKAGE = __package__.rpartition(".")[0]
_FOLDER = Path(__file__).resolve().parents[2]


def is_running() -> bool:
    """A measurement is under way."""
    last = background.last()
    return last is not None and last.is_running


def command_line(arguments: list[str]) -> list[str]:
    """How a process runs a command of `python -m rgp_engine` with this Blender and this add-on."""
    if not bpy.app.binary_path:
        return [sys.executable, "-m", "rgp_engine", *arguments]
    add_on, _, _ = _PACKAGE.rpartition(".")
    enable = ["--addons", add_on] if add_on else []
    path = "" if add_on else f"import sys; sys.path.insert(0, {str(_FOLDER)!r}); "
    script = f"{path}from {_PACKAGE}.__main__ import leave, main; leave(main({arguments!r}))"
    trust = [] if bpy.app.autoexec_fail else ["--enable-autoexec"]
    return [bpy.app.binary_path, "--background", *trust, *enable, "--python-expr", script]


class RGP_OT_measure_accuracy(Operator):
    """Starts the measurement."""

    bl_idname = "rgp.measure_accuracy"
    bl_label = "Measure Accuracy"
    bl_description = (
        "Measure error and time of many settings around the current ones, on a part of the picture. "
        "Blender stays usable; times are true while nothing else keeps the processor busy"
    )

    is_quick: bpy.props.BoolProperty(  # type: ignore[valid-type]
        name="Quick", description="Fewer settings and a coarser reference", options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True for scenes of this engine, while none is measured."""
        return context.scene.render.engine == ENGINE_ID and not is_running()

    def execute(self, context: Any) -> set[str]:
        """Saves a copy of the file and starts another Blender with it."""
        try:
            folder = Path(tempfile.mkdtemp(prefix="rgp_accuracy_", dir=bpy.app.tempdir))
            copy = folder / f"{Path(bpy.data.filepath).stem or 'untitled'}.blend"
            bpy.ops.wm.save_as_mainfile(filepath=str(copy), copy=True, check_existing=False)
        except (OSError, RuntimeError) as error:
            reason = str(error).strip().removeprefix("Error: ")
            self.report({"ERROR"}, f"The file cannot be copied to {bpy.app.tempdir}: {reason}")
            return {"CANCELLED"}
        arguments = ["accuracy", str(copy), "-o", str(folder), "--until-stdin-ends"]
        arguments += ["--quick"] if self.is_quick else []
        try:
            background.publish(BackgroundSweep(command_line(arguments), folder, _FOLDER))
        except OSError as error:
            self.report({"ERROR"}, f"Blender cannot be started a second time: {error}")
            return {"CANCELLED"}
        if not bpy.app.timers.is_registered(_watch):
            bpy.app.timers.register(_watch, first_interval=_POLL_SECONDS, persistent=True)
        return {"FINISHED"}


class RGP_OT_stop_accuracy(Operator):
    """Stop measuring and keep what there is"""

    bl_idname = "rgp.stop_accuracy"
    bl_label = "Stop"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True while a scene is measured."""
        return is_running()

    def execute(self, context: Any) -> set[str]:
        """Asks the other Blender to end."""
        last = background.last()
        if last is not None:
            last.stop()
        return {"FINISHED"}


class RGP_OT_show_accuracy(Operator):
    """Show the plot of time against error in an Image Editor"""

    bl_idname = "rgp.show_accuracy"
    bl_label = "Show Plot"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True when there is a plot."""
        last = background.last()
        return last is not None and (last.folder / PNG).is_file()

    def execute(self, context: Any) -> set[str]:
        """Loads the plot and shows it where an Image Editor is open."""
        last = background.last()
        if last is None:
            return {"CANCELLED"}
        if not show_plot(last.folder / PNG):
            self.report({"INFO"}, f"No Image Editor is open; the plot is the image '{IMAGE_NAME}'")
        return {"FINISHED"}


class RGP_OT_apply_accuracy(Operator):
    """Use the chosen settings for the scene"""

    bl_idname = "rgp.apply_accuracy"
    bl_label = "Apply"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender's)

    @classmethod
    def poll(cls, context: Any) -> bool:
        """True when a row is chosen."""
        return bool(context.window_manager.rgp_accuracy.chosen < len(background.front()))

    def execute(self, context: Any) -> set[str]:
        """Sets every setting of the row."""
        row = background.front()[context.window_manager.rgp_accuracy.chosen]
        for field, (group, name) in PLACES.items():
            set_core_value(getattr(context.scene.rgp, group), name, getattr(row.quality, field))
        return {"FINISHED"}


def show_plot(path: Path) -> bool:
    """Makes the plot an image of this file and shows it in the first Image Editor; False where none is open."""
    b_image = bpy.data.images.get(IMAGE_NAME)
    if b_image is not None:
        bpy.data.images.remove(b_image)
    b_image = bpy.data.images.load(str(path))
    b_image.name = IMAGE_NAME
    # The file is gone when Blender ends; the picture is not.
    b_image.pack()
    for b_window, b_area in _areas("IMAGE_EDITOR"):
        b_area.spaces.active.image = b_image
        b_region = next(b_region for b_region in b_area.regions if b_region.type == "WINDOW")
        with bpy.context.temp_override(window=b_window, area=b_area, region=b_region):
            bpy.ops.image.view_all(fit_view=True)
        return True
    return False


def _watch() -> float | None:
    """Follows the measurement until it has ended; called by Blender's timer."""
    last = background.last()
    if last is None:
        return None
    is_under_way = last.is_running
    last.refresh()
    sweep = last.sweep
    if sweep is not None:
        _fill_list(sweep)
    text = None
    if is_under_way:
        step = f"{sweep.message}, about {clock(sweep.seconds_left)} left" if sweep else "starting"
        text = f"Measuring accuracy: {step}"
    elif sweep is not None and sweep.rows and (last.folder / PNG).is_file():
        show_plot(last.folder / PNG)
    for b_workspace in bpy.data.workspaces:
        b_workspace.status_text_set(text)
    for _, b_area in _areas("PROPERTIES"):
        b_area.tag_redraw()
    return _POLL_SECONDS if is_under_way else None


def _fill_list(sweep: Sweep) -> None:
    """As many lines as the front has rows. The fastest that is no worse than the current settings is chosen."""
    front = sweep.front
    now = next((row.error for row in sweep.rows if row.quality == sweep.current), 0.0)
    best = next((index for index, row in enumerate(front) if row.error <= now), 0)
    for b_manager in bpy.data.window_managers:
        b_list = b_manager.rgp_accuracy
        if len(b_list.rows) == len(front):
            continue
        b_list.rows.clear()
        for _ in front:
            b_list.rows.add()
        b_list.chosen = best


def _areas(kind: str) -> list[tuple[Any, Any]]:
    """Areas of a kind in all windows, each with its window."""
    b_windows = [b_window for b_manager in bpy.data.window_managers for b_window in b_manager.windows]
    return [
        (b_window, b_area)
        for b_window in b_windows
        for b_area in b_window.screen.areas
        if b_area.type == kind
    ]


def _end() -> None:
    """Ends the measurement, if any, and waits for it."""
    last = background.last()
    if last is not None:
        last.end()


@persistent  # type: ignore[untyped-decorator]
def _end_before_load(_path: Any) -> None:
    """Another file is another scene."""
    _end()


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (RGP_OT_measure_accuracy, RGP_OT_stop_accuracy, RGP_OT_show_accuracy, RGP_OT_apply_accuracy)
)


def register() -> None:
    """Adds the operators."""
    _register_classes()
    bpy.app.handlers.load_pre.append(_end_before_load)
    atexit.register(_end)


def unregister() -> None:
    """Removes them; no process is left behind."""
    _end()
    atexit.unregister(_end)
    if bpy.app.timers.is_registered(_watch):
        bpy.app.timers.unregister(_watch)
    bpy.app.handlers.load_pre.remove(_end_before_load)
    _unregister_classes()
