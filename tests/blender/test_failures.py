"""Whatever fails, at whatever stage: Blender lives, and the failure is one readable line.

Each case runs in a process of its own, since a missing render result makes Blender crash when it writes the picture.
"""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

SCRIPT = """
import os, sys
import bpy
import rgp_engine
from rgp_engine import engine, native, session, stats
from rgp_engine.export import camera, instance, light, material, mesh, world
from tests.blender import build
from tests.blender.recording_core import Core

rgp_engine.register()
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.engine = "RGP"
scene.render.resolution_x = scene.render.resolution_y = 16
scene.render.filepath = sys.argv[1]
build.lit_room()
native.core = lambda: Core
Core.seconds = 0.6

def broken(*args, **kwargs):
    raise ValueError("injected")

class Watched:
    broken = set()

    def __init__(self, b_engine):
        self.b_engine = b_engine

    def __getattr__(self, name):
        return broken if name in self.broken else getattr(self.b_engine, name)

engine.RenderSession = lambda b_engine, b_depsgraph: session.RenderSession(Watched(b_engine), b_depsgraph)

{inject}
try:
    bpy.ops.render.render(write_still=True)
    print("RESULT finished")
except RuntimeError as error:
    print("RESULT", str(error).strip())
sys.stdout.flush()
os._exit(0)
"""

PLACES = [
    "session.export_scene = broken",
    "session.core_settings = broken",
    "session.native.embree_library = broken",
    "session._write_pass = broken",
    "session._write_passes = broken",
    "stats.complete = broken",
    "Core.SceneBuilder = broken",
    "Core.Session = broken",
    "Core.SceneBuilder.finish = broken",
    "Core.SceneBuilder.add_mesh = broken",
    "Core.SceneBuilder.add_lamp = broken",
    "Core.SceneBuilder.add_material = broken",
    "Core.SceneBuilder.set_world = broken",
    "Core.SceneBuilder.set_camera = broken",
    "Core.Session.start = broken",
    "Core.Session.wait = broken",
    "Core.Session.progress = broken",
    "Core.Session.picture = broken",
    "Core.Session.finish = broken",
    "Core.Session.stats = broken",
    "Watched.broken = {'begin_result'}",
    "Watched.broken = {'test_break'}",
    "Watched.broken = {'update_stats'}",
    "Watched.broken = {'update_progress'}",
    "Watched.broken = {'update_memory_stats'}",
    "Watched.broken = {'update_result'}",
]


@pytest.mark.parametrize("inject", PLACES)
def test_blender_survives(tmp_path, inject):
    picture = tmp_path / "picture.png"
    script = tmp_path / "script.py"
    script.write_text(SCRIPT.replace("{inject}", inject))
    command = [
        sys.executable,
        "-c",
        f"import sys; sys.path.insert(0, '.'); exec(open({str(script)!r}).read())",
    ]
    result = subprocess.run([*command, str(picture)], cwd=ROOT, check=False, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout[-500:] + result.stderr[-2000:]
    (line,) = [line for line in result.stdout.splitlines() if line.startswith("RESULT")]
    assert "Internal error, details in the console. ValueError: injected" in line
    assert "Traceback" in result.stderr
    assert not picture.exists()
