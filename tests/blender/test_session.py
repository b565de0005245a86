"""How a render runs: status, streaming, Esc, messages. The core is a stand-in that takes a known time."""

import time

import bpy
import numpy as np
import pytest

from rgp_engine import engine, native, report, session
from tests.blender import build


class Watched:
    """Blender's engine with some of its functions replaced; Blender looks up its own before a subclass's."""

    def __init__(self, b_engine, replaced):
        self._b_engine = b_engine
        self._replaced = replaced

    def __getattr__(self, name):
        original = getattr(self._b_engine, name)
        replacement = self._replaced.get(name)
        return (
            original
            if replacement is None
            else lambda *args, **kwargs: replacement(original, *args, **kwargs)
        )


@pytest.fixture
def replaced(monkeypatch):
    """Functions of Blender's engine by name; each gets the original and the arguments."""
    replacements = {}

    def watched(b_engine, b_depsgraph):
        return session.RenderSession(Watched(b_engine, replacements), b_depsgraph)

    monkeypatch.setattr(engine, "RenderSession", watched)
    return replacements


@pytest.fixture
def calls(replaced):
    """What the engine tells Blender, in order."""
    found = []

    def recorder(name):
        def record(original, *args, **kwargs):
            found.append((name, args, kwargs))
            return original(*args, **kwargs)

        return record

    for name in ("update_stats", "update_progress", "update_memory_stats", "update_result", "report"):
        replaced[name] = recorder(name)
    return found


def of(calls, name):
    return [(args, kwargs) for called, args, kwargs in calls if called == name]


def stop_after(replaced, count):
    """Esc at the given number of questions."""
    asked = []

    def is_pressed(_original):
        asked.append(time.monotonic())
        return len(asked) >= count

    replaced["test_break"] = is_pressed
    return asked


def pixels_of(path, channels=4):
    b_image = bpy.data.images.load(str(path))
    try:
        return list(b_image.pixels)[:channels]
    finally:
        bpy.data.images.remove(b_image)


def render_to(scene, path):
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(path)
    return bpy.ops.render.render(write_still=True)


def test_picture_arrives(scene, recorded, tmp_path, outcome):
    build.lit_room()
    assert render_to(scene, tmp_path / "picture.exr") == {"FINISHED"}
    assert pixels_of(tmp_path / "picture.exr", 3) == [0.25] * 3
    assert outcome().error == ""
    assert outcome().cancelled is False
    stats = outcome().stats
    assert stats["rays"] == {"camera": 7}
    assert stats["seconds"]["total"] == pytest.approx(1.5 + stats["seconds"]["export"])
    assert stats["versions"]["blender"] == bpy.app.version_string
    assert stats["settings"]["photon_pass"]["photon_count"] == 1000


def test_picture_streams_in_at_most_four_times_a_second(scene, recorded, calls, monkeypatch):
    monkeypatch.setattr(recorded, "seconds", 2.0)
    build.lit_room()
    bpy.ops.render.render()
    assert 2 <= len(of(calls, "update_result")) <= 8


def test_status_progress_and_memory(scene, recorded, calls, monkeypatch):
    monkeypatch.setattr(recorded, "seconds", 1.2)
    build.lit_room()
    bpy.ops.render.render()
    texts = [args[1] for args, _ in of(calls, "update_stats")]
    assert texts[0].startswith("Exporting ")
    stated = "Error 0.8 % after 0 s; about 0.4 % at the end"
    assert any(text.startswith(f"Gathering | Remaining 00:01 | {stated} | Mem 3 MiB") for text in texts)
    fractions = [args[0] for args, _ in of(calls, "update_progress")]
    assert fractions == sorted(fractions)
    assert 0.0 <= fractions[0] < 0.2
    assert fractions[-1] > 0.6
    assert of(calls, "update_memory_stats")[-1][1] == {"memory_used": 3.0, "memory_peak": 3.0}


def test_esc_keeps_the_picture_and_returns_at_once(scene, recorded, replaced, monkeypatch, tmp_path, outcome):
    monkeypatch.setattr(recorded, "seconds", 30.0)
    asked = stop_after(replaced, 4)
    build.lit_room()
    render_to(scene, tmp_path / "picture.exr")
    assert time.monotonic() - asked[-1] < 0.5
    assert outcome().cancelled is True
    assert outcome().error == ""
    assert pixels_of(tmp_path / "picture.exr", 3) == [0.25] * 3


def test_esc_during_the_export(scene, recorded, replaced, outcome, tmp_path):
    stop_after(replaced, 1)
    build.lit_room()
    render_to(scene, tmp_path / "picture.exr")
    assert outcome().cancelled is True
    assert outcome().error == ""
    assert pixels_of(tmp_path / "picture.exr", 3) == [0.0] * 3


def test_one_problem_is_told_in_full_and_several_are_counted():
    log = report.ProblemLog()
    assert log.summary() == ""
    log.add("Lamp", "is odd")
    assert log.summary() == "Lamp: is odd"
    log.add("Cube", "is bent")
    assert log.summary() == "2 problems, all in Render Properties > Problems. The first: Lamp: is odd"


def test_problems_end_in_one_warning(scene, recorded, calls):
    b_camera = build.add_camera().data
    b_camera.type, b_camera.panorama_type, b_camera.longitude_min = "PANO", "EQUIRECTANGULAR", 4.0
    bpy.ops.render.render()
    ((args, _),) = of(calls, "report")
    assert args[0] == {"WARNING"}
    assert args[1].startswith("2 problems")


@pytest.mark.parametrize("more", [{}, {"Indirect": 0.125}, {"Shadow Catcher": 0.5}])
def test_passes_on_request(scene, recorded, monkeypatch, more):
    """Each with the picture that the recording core has for it."""
    seen = {}
    original = session._write_passes

    def write_passes(core_session, b_result):
        original(core_session, b_result)
        for b_pass in b_result.layers[0].passes:
            values = np.empty(len(b_pass.rect) * b_pass.channels, np.float32)
            b_pass.rect.foreach_get(values)
            seen[b_pass.name] = set(values.tolist())

    monkeypatch.setattr(session, "_write_passes", write_passes)
    for name in more:
        setattr(scene.view_layers[0].rgp, f"use_pass_{name.lower().replace(' ', '_')}", True)
    build.lit_room()
    bpy.ops.render.render()
    assert seen == {name: {value} for name, value in {"Combined": 0.25, **more}.items()}


def failing(monkeypatch, error):
    def core():
        raise error

    monkeypatch.setattr(native, "core", core)


def test_missing_core_is_one_readable_error(scene, monkeypatch, outcome, capfd):
    failing(monkeypatch, native.NativeError("Install the extension again."))
    build.lit_room()
    with pytest.raises(RuntimeError, match=r"^Error: Install the extension again\.\s*$"):
        bpy.ops.render.render()
    assert outcome().error == "Install the extension again."
    assert "Traceback" not in capfd.readouterr().err


def test_a_bug_is_one_readable_error_with_a_traceback_on_the_console(scene, monkeypatch, capfd):
    failing(monkeypatch, ZeroDivisionError("by zero"))
    build.lit_room()
    with pytest.raises(
        RuntimeError, match=r"Internal error, details in the console\. ZeroDivisionError: by zero"
    ):
        bpy.ops.render.render()
    assert "Traceback" in capfd.readouterr().err


def test_no_camera(scene, recorded):
    with pytest.raises(RuntimeError, match=r"Cannot render, no camera|There is no camera\. Add one"):
        bpy.ops.render.render()
