"""Whatever fails, at whatever stage: Blender lives, and the failure is one readable line.

The renders run in a process of their own, since a missing render result makes Blender crash when it writes the picture.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

SCRIPT = """
import json, os, sys
from pathlib import Path
import bpy
import rgp_engine
from rgp_engine import engine, native, session, stats
from tests.blender import build
from tests.blender.recording_core import Core

class Watched:
    broken = ""

    def __init__(self, b_engine):
        self.b_engine = b_engine

    def __getattr__(self, name):
        return broken if name == self.broken else getattr(self.b_engine, name)

def broken(*args, **kwargs):
    raise ValueError("injected")

def render(picture):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "RGP"
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.render.filepath = str(picture)
    build.lit_room()
    try:
        bpy.ops.render.render(write_still=True)
        return "finished"
    except RuntimeError as error:
        return str(error).strip()

rgp_engine.register()
engine.RenderSession = lambda b_engine, b_depsgraph: session.RenderSession(Watched(b_engine), b_depsgraph)
native.core = lambda: Core
Core.seconds = 0.6
names = {"Core": Core, "Watched": Watched, "session": session, "stats": stats}
for place in sys.argv[2:]:
    print("BEGIN", place, flush=True)
    *path, name = place.split(".")
    if path == ["engine"]:
        owner, name, value = Watched, "broken", name
    else:
        owner, value = names[path[0]], broken
        for part in path[1:]:
            owner = getattr(owner, part)
    original = getattr(owner, name)
    setattr(owner, name, value)
    picture = Path(sys.argv[1]) / "picture.png"
    result = render(picture)
    setattr(owner, name, original)
    print("RESULT", json.dumps([place, result, picture.exists()]), flush=True)
os._exit(0 if render(picture) == "finished" and picture.exists() else 1)
"""

PLACES = [
    "session.export_scene",
    "session.core_settings",
    "session.native.embree_library",
    "session._write_pass",
    "session._write_passes",
    "stats.complete",
    "Core.SceneBuilder",
    "Core.Session",
    "Core.SceneBuilder.finish",
    "Core.SceneBuilder.add_mesh",
    "Core.SceneBuilder.add_lamp",
    "Core.SceneBuilder.add_material",
    "Core.SceneBuilder.set_world",
    "Core.SceneBuilder.set_camera",
    "Core.Session.start",
    "Core.Session.wait",
    "Core.Session.progress",
    "Core.Session.picture",
    "Core.Session.finish",
    "Core.Session.stats",
    "engine.begin_result",
    "engine.test_break",
    "engine.update_stats",
    "engine.update_progress",
    "engine.update_memory_stats",
    "engine.update_result",
]


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """What came of a render with each place broken: message, and whether a picture was written."""
    folder = tmp_path_factory.mktemp("failures")
    command = [sys.executable, "-c", SCRIPT, str(folder), *PLACES]
    process = subprocess.run(command, cwd=ROOT, check=False, capture_output=True, text=True, timeout=300)
    assert process.returncode == 0, process.stdout[-500:] + process.stderr[-2000:]
    assert process.stderr.count("Traceback") == len(PLACES), "each failure is told in full on the console"
    lines = [
        line.removeprefix("RESULT ") for line in process.stdout.splitlines() if line.startswith("RESULT")
    ]
    return {place: (message, is_written) for place, message, is_written in map(json.loads, lines)}


@pytest.mark.parametrize("place", PLACES)
def test_blender_survives_and_says_why(results, place):
    message, is_written = results[place]
    assert message == "Error: Internal error, details in the console. ValueError: injected"
    assert not is_written
