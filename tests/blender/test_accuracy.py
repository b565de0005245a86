"""Accuracy against time: the command in a process of its own, and the panel's buttons."""

import json
import os
import subprocess
import sys
import time
import xml.etree.ElementTree as ET
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

import rgp_engine
from rgp_engine.accuracy import background
from rgp_engine.accuracy.error import Means, Reference
from rgp_engine.accuracy.quality import Quality
from rgp_engine.accuracy.result import Sweep
from rgp_engine.operators import accuracy
from rgp_engine.settings import core_settings
from rgp_engine.sweep import Request
from rgp_engine.sweep import run as run_module
from rgp_engine.sweep.shot import Shot
from rgp_engine.sweep.taken_scene import TakenScene
from rgp_engine.ui import accuracy as panel
from tests.blender import build
from tests.blender.test_ui import draw

ROOT = Path(__file__).resolve().parents[2]
TINY = ["--quick", "--reference-seconds", "0.4"]


def wait(running, seconds=120.0):
    """Until the process has ended, following it as Blender's timer does."""
    deadline = time.monotonic() + seconds
    while accuracy._watch() is not None:
        assert time.monotonic() < deadline, (running.folder / "log.txt").read_text()
        time.sleep(0.05)


@pytest.fixture
def room(scene):
    """A room that takes no time."""
    build.lit_room()
    scene.rgp.gather.rays = 16
    scene.rgp.gather.camera_samples = 4
    return scene


@pytest.fixture
def blend(room, tmp_path):
    path = tmp_path / "room.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


@pytest.fixture
def measured(room, monkeypatch):
    """Starts a measurement that takes seconds, in another process."""
    whole = accuracy.command_line
    monkeypatch.setattr(background, "_last", None)
    monkeypatch.setattr(accuracy, "command_line", lambda arguments: whole([*arguments, *TINY]))

    def start():
        assert bpy.ops.rgp.measure_accuracy(is_quick=True) == {"FINISHED"}
        return background.last()

    yield start
    if background.last() is not None:
        background.last().end()


def run(*arguments):
    command = [sys.executable, "-m", "rgp_engine", "accuracy", *map(str, arguments)]
    return subprocess.run(command, cwd=ROOT, check=False, capture_output=True, text=True, timeout=120)


def test_command(blend, tmp_path):
    folder = tmp_path / "new" / "folder"
    result = run(blend, "-o", folder, *TINY, "--threads", 1, "--set", "pyramid.finest_resolution=32")
    assert result.returncode == 0, result.stderr
    content = json.loads((folder / "accuracy.json").read_text())
    assert content["progress"]["state"] == "done"
    assert content["threads"] == 1
    assert content["current"]["pyramid.finest_resolution"] == 32
    assert content["rows"][0]["settings"] == content["current"]
    assert content["window"] == [0, 0, 32, 24], "a picture smaller than the window is taken whole"
    assert content["reference"]["noise"] > 0.0
    assert set(content["cheapest"]) == {"2", "1", "0.5", "0.25"}
    front = [(record["seconds"], record["error"]) for record in content["front"]]
    assert front == sorted(front)
    assert [error for _, error in front] == sorted((error for _, error in front), reverse=True)
    assert all(record["error"] >= content["reference"]["resolves"] * 0.999 for record in content["rows"])
    ET.parse(folder / "accuracy.svg")
    assert (folder / "accuracy.png").read_bytes().startswith(b"\x89PNG")
    for word in ("run 1 of ", "reference: ", "photons", "   2 %: ", "0.25 %: "):
        assert word in result.stdout


def test_more_samples_are_slower_and_better(blend, tmp_path):
    assert run(blend, "-o", tmp_path, *TINY, "--resolution", "64x48").returncode == 0
    found = Sweep.read(tmp_path)
    coarse = min(found.rows, key=lambda row: (row.quality.samples, row.quality.rays))
    fine = next(row for row in found.rows[1:] if row.quality.samples == 8 * found.current.samples)
    assert coarse.quality.samples < fine.quality.samples
    assert coarse.error > fine.error


def test_crop(blend, tmp_path):
    assert run(blend, "-o", tmp_path, *TINY, "--crop", "16x12").returncode == 0
    content = json.loads((tmp_path / "accuracy.json").read_text())
    assert (content["resolution"], content["window"][2:]) == ([32, 24], [16, 12])


def test_time_is_predicted_for_the_whole_picture(monkeypatch, room, tmp_path):
    """A window of a quarter of the pixels: the gather takes four times as long, all else as long."""
    truth = np.full((12, 16, 3), 0.5, np.float32)
    seconds = {"accel": 0.5, "photon_pass": 1.0, "pyramid": 0.25, "gather": 2.0, "total": 3.75}
    stats = {"seconds": seconds, "pyramid": {"glossy_cells": 0, "bytes": 7}}
    asked = []

    def render(_taken, settings, _seed):
        asked.append(settings)
        return Shot(truth * np.float32(1.1), stats)

    monkeypatch.setattr(run_module, "render", render)
    room.rgp.gather.time_limit = 5.0
    settings = core_settings(room)
    quality = Quality.of(settings)
    sweep = Sweep("room", (32, 24), (3, 4, 16, 12), quality, is_glossy=False, threads=2, versions={})
    request = Request(1.0, is_quick=True, crop=None)
    run = run_module._Run(sweep, TakenScene(None, settings, 0.1), 0.1, request, tmp_path, lambda _sweep: None)
    run._measure([quality.scaled("rays", 2)], Reference(truth, truth, Means(0.5, 0.5)), 0.0, 0.0)
    assert sweep.rows[0].seconds == pytest.approx(0.1 + 0.5 + 1.0 + 0.25 + 4 * 2.0)
    assert (sweep.rows[0].error, sweep.rows[0].bytes) == (pytest.approx(10.0, rel=1e-4), 7)
    assert asked[0]["gather"]["rays"] == 2 * quality.rays
    assert asked[0]["gather"]["time_limit"] == 0.0, "what stops a render early would spoil the measurement"


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        (["--crop", "1.5"], 2, "nor a share from 0 to 1"),
        (["--reference-seconds", "-1"], 2, "is no time in seconds"),
        (["--set", "gather.rayz=3"], 2, "there is no setting gather.rayz"),
    ],
)
def test_what_cannot_be_asked(blend, tmp_path, options, code, message):
    result = run(blend, "-o", tmp_path / "out", *TINY, *options)
    assert (result.returncode, message in result.stderr) == (code, True)


def test_scenes_that_cannot_be_measured(room, tmp_path):
    bpy.data.objects["Lamp"].hide_render = True
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "dark.blend"))
    result = run(tmp_path / "dark.blend", "-o", tmp_path, *TINY)
    assert (result.returncode, "The picture is black" in result.stderr) == (1, True)
    room.camera = None
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "blind.blend"))
    result = run(tmp_path / "blind.blend", "-o", tmp_path, *TINY)
    assert (result.returncode, "camera" in result.stderr) == (1, True)
    assert "Traceback" not in result.stderr


def test_interrupted_with_what_there_is(blend, tmp_path):
    command = [sys.executable, "-m", "rgp_engine", "accuracy", blend, "-o", tmp_path, "--until-stdin-ends"]
    command += [*TINY, "--resolution", "128x96", "--set", "gather.rays=4096"]
    with subprocess.Popen(
        list(map(str, command)), cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        for line in process.stdout:
            if "run 2 of" in line:
                break
        process.stdin.close()
        assert process.wait(timeout=60) == 0
    content = json.loads((tmp_path / "accuracy.json").read_text())
    assert content["progress"]["state"] == "stopped"
    assert content["rows"]
    assert (tmp_path / "accuracy.png").is_file()


def test_measure_show_and_apply(measured, room):
    running = measured()
    assert not bpy.ops.rgp.measure_accuracy.poll()
    assert "Starting" in draw(panel.RGP_PT_accuracy, **context(room))
    wait(running)
    assert running.error == ""
    assert running.sweep.state == "done"
    b_image = bpy.data.images[accuracy.IMAGE_NAME]
    assert tuple(b_image.size) == (1600, 1000)
    assert b_image.packed_file is not None

    b_list = bpy.context.window_manager.rgp_accuracy
    front = running.sweep.front
    assert len(b_list.rows) == len(front) > 1
    for index, row in enumerate(front):
        b_list.chosen = index
        assert bpy.ops.rgp.apply_accuracy() == {"FINISHED"}
        settings = room.rgp
        assert settings.gather.rays == row.quality.rays
        assert settings.gather.camera_samples == row.quality.samples
        assert settings.photon_pass.photon_count == row.quality.photons
        assert settings.pyramid.finest_resolution == row.quality.finest
        assert "x".join(map(str, settings.pyramid.bins)) == row.quality.bins
    assert "UNDO" in bpy.types.RGP_OT_apply_accuracy.bl_options
    shown = draw(panel.RGP_PT_accuracy, **context(room))
    assert {"Gather rays", str(front[-1].quality.rays)} <= set(shown)
    b_list.chosen = len(front)
    assert not bpy.ops.rgp.apply_accuracy.poll()

    bpy.data.images.remove(b_image)
    assert bpy.ops.rgp.show_accuracy() == {"FINISHED"}
    assert accuracy.IMAGE_NAME in bpy.data.images


def context(b_scene):
    return {"scene": b_scene, "window_manager": bpy.context.window_manager}


def test_the_file_stays_as_it_is(measured, room, blend):
    before = blend.stat().st_mtime_ns
    measured().end()
    assert bpy.data.filepath == str(blend)
    assert blend.stat().st_mtime_ns == before


def test_stop(measured):
    running = measured()
    assert bpy.ops.rgp.stop_accuracy() == {"FINISHED"}
    wait(running, 30.0)
    assert running.error == ""
    assert bpy.ops.rgp.measure_accuracy.poll()
    assert not bpy.ops.rgp.stop_accuracy.poll()


def is_gone(process):
    return process.returncode is not None


def test_no_process_outlives_the_add_on_or_the_file(measured):
    process = measured()._process
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert is_gone(process), "another file"
    bpy.context.scene.render.engine = "RGP"
    process = measured()._process
    rgp_engine.unregister()
    rgp_engine.register()
    assert is_gone(process), "the add-on is off"


def test_no_process_outlives_blender(blend, tmp_path):
    """The Blender that measures is killed; the one it has started ends by itself."""
    script = f"""
import bpy, rgp_engine, time
rgp_engine.register()
bpy.ops.wm.open_mainfile(filepath={str(blend)!r})
bpy.context.scene.render.engine = "RGP"
bpy.ops.rgp.measure_accuracy()
from rgp_engine.accuracy import background
print("child", background.last()._process.pid, flush=True)
time.sleep(60)
"""
    with subprocess.Popen(
        [sys.executable, "-c", script], cwd=ROOT, stdout=subprocess.PIPE, text=True
    ) as parent:
        child = next(int(line.split()[1]) for line in parent.stdout if line.startswith("child "))
        parent.kill()
    deadline = time.monotonic() + 30.0
    while is_alive(child):
        assert time.monotonic() < deadline
        time.sleep(0.1)


def is_alive(process_id):
    try:
        os.kill(process_id, 0)
    except ProcessLookupError:
        return False
    return Path(f"/proc/{process_id}/stat").read_text().rpartition(") ")[2][0] != "Z"


def test_errors_are_shown(measured, room):
    room.camera = None
    running = measured()
    wait(running)
    assert "camera" in running.error
    assert running.error in draw(panel.RGP_PT_accuracy, **context(room))


def test_no_room_for_the_copy(room, monkeypatch, tmp_path):
    """A full disk, or a folder that is gone, is one line in Blender's words."""
    monkeypatch.setattr(background, "_last", None)
    monkeypatch.setattr(accuracy.tempfile, "mkdtemp", lambda **_: str(tmp_path / "gone"))
    with pytest.raises(RuntimeError, match=r"Error: The file cannot be copied to .+: .+") as error:
        bpy.ops.rgp.measure_accuracy()
    assert "Traceback" not in str(error.value)
    assert background.last() is None


def test_command_lines(monkeypatch):
    assert accuracy.command_line(["a"]) == [sys.executable, "-m", "rgp_engine", "a"]
    app = SimpleNamespace(binary_path="/opt/blender", autoexec_fail=True)
    monkeypatch.setattr(accuracy, "bpy", SimpleNamespace(app=app))
    monkeypatch.setattr(accuracy, "_PACKAGE", "bl_ext.user_default.rgp_engine.rgp_engine")
    script = "from bl_ext.user_default.rgp_engine.rgp_engine.__main__ import leave, main; leave(main(['a']))"
    assert accuracy.command_line(["a"]) == [
        "/opt/blender",
        "--background",
        "--addons",
        "bl_ext.user_default.rgp_engine",
        "--python-expr",
        script,
    ]
