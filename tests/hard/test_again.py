"""Cancel, reload, re-register, undo, file load and render again: nothing stays behind in Blender's process."""

import ctypes
import gc
import threading
from pathlib import Path

import bpy
import pytest

import rgp_engine
from tests.blender import build

GROUP = "Again and again"
WARM_UP = 40


def threads_of_process() -> int:
    return len(list(Path("/proc/self/task").iterdir()))


def memory_of_process() -> int:
    """Resident bytes, without what the allocator keeps for later."""
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


def prepare(path: Path) -> None:
    """A small lit room, saved."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    b_scene = bpy.context.scene
    b_scene.render.engine = "RGP"
    b_scene.render.resolution_x, b_scene.render.resolution_y = 32, 24
    b_scene.rgp.photon_pass.photon_count = 2000
    b_scene.rgp.gather.rays, b_scene.rgp.gather.camera_samples = 4, 2
    build.lit_room()
    build.add_object("Cube", build.cube())
    bpy.ops.wm.save_as_mainfile(filepath=str(path))


def one_round(i: int, path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What artists do between renders, each in its turn."""
    if i % 4 == 1:
        bpy.ops.wm.open_mainfile(filepath=str(path))
    elif i % 4 == 2:
        rgp_engine.unregister()
        rgp_engine.register()
        bpy.context.scene.render.engine = "RGP"
    elif i % 4 == 3:
        bpy.ops.ed.undo_push(message="before")
        bpy.data.objects["Cube"].location.x += 0.1
        bpy.ops.ed.undo_push(message="after")
        if bpy.ops.ed.undo.poll():
            bpy.ops.ed.undo()
    if i % 5 == 4:
        cancelled_render(monkeypatch)
    else:
        bpy.ops.render.render()


def cancelled_render(monkeypatch: pytest.MonkeyPatch) -> None:
    """A render that would take minutes and is stopped at once."""
    from rgp_engine.session import RenderSession

    with monkeypatch.context() as patch:
        real = RenderSession._watch

        def watch(self, core_session, b_result):
            core_session.cancel()
            real(self, core_session, b_result)

        patch.setattr(RenderSession, "_watch", watch)
        gather = bpy.context.scene.rgp.gather
        gather.rays, gather.camera_samples = 4096, 64
        bpy.ops.render.render()
        gather.rays, gather.camera_samples = 4, 2


@pytest.mark.slow
def test_two_hundred_renders(check, tmp_path, monkeypatch):
    if not hasattr(bpy.types.Scene, "rgp"):
        rgp_engine.register()
    path = tmp_path / "room.blend"
    prepare(path)
    for i in range(WARM_UP):
        one_round(i, path, monkeypatch)
    tasks, python = threads_of_process(), threading.active_count()
    memory = []
    for i in range(200):
        one_round(i, path, monkeypatch)
        memory.append(memory_of_process())
    # The least of many: what the allocator keeps for later comes and goes, a leak stays.
    grown = min(memory[-100:]) / min(memory[:100]) - 1.0
    check(
        "200 renders: growth of memory, second half over first", expected=0.0, got=max(0.0, grown), bound=0.02
    )
    check(
        "200 renders: threads left behind", expected=0.0, got=max(0, threads_of_process() - tasks), bound=0.0
    )
    check(
        "200 renders: Python threads left behind",
        expected=0.0,
        got=threading.active_count() - python,
        bound=0.0,
    )
