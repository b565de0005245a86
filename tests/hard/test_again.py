"""Cancel, reload, re-register, undo, file load and render again: nothing stays behind in Blender's process."""

import ctypes
import gc
import json
import os
import subprocess
import sys
import threading
from pathlib import Path
from statistics import median

import bpy
import pytest

import rgp_engine
from tests.blender import build

GROUP = "Again and again"
WARM_UP = 40
ROOT = Path(__file__).resolve().parents[2]


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

        def watch(self, core_session, *others):
            core_session.cancel()
            real(self, core_session, *others)

        patch.setattr(RenderSession, "_watch", watch)
        gather = bpy.context.scene.rgp.gather
        gather.rays, gather.camera_samples = 4096, 64
        bpy.ops.render.render()
        gather.rays, gather.camera_samples = 4, 2


def two_hundred_rounds(path: Path) -> dict[str, float]:
    """What is left behind, in a Blender that has done nothing else: of other work it would keep this and that."""
    rgp_engine.register()
    prepare(path)
    memory = []
    with pytest.MonkeyPatch.context() as monkeypatch:
        for i in range(WARM_UP):
            one_round(i, path, monkeypatch)
        tasks, python = threads_of_process(), threading.active_count()
        for i in range(200):
            one_round(i, path, monkeypatch)
            memory.append(memory_of_process())
    return {
        # The middle of many: what the allocator keeps for later comes and goes, a leak stays.
        "growth of memory, second half over first": max(
            0.0, median(memory[-100:]) / median(memory[:100]) - 1.0
        ),
        "threads left behind": max(0, threads_of_process() - tasks),
        "Python threads left behind": threading.active_count() - python,
    }


@pytest.mark.slow
def test_two_hundred_renders(check, tmp_path):
    report = tmp_path / "left behind.json"
    command = [sys.executable, "-m", "tests.hard.test_again", tmp_path / "room.blend", report]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600, check=False)
    assert report.is_file(), done.stdout[-2000:] + done.stderr
    for what, left in json.loads(report.read_text()).items():
        bound = 0.02 if "memory" in what else 0.0
        check(f"200 renders: {what}", expected=0.0, got=left, bound=bound)


if __name__ == "__main__":
    room, report = map(Path, sys.argv[1:])
    report.write_text(json.dumps(two_hundred_rounds(room)))
    os._exit(0)  # bpy 4.5 may hang in its exit handlers
