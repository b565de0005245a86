"""Enabling and disabling the add-on."""

import subprocess
import sys
from pathlib import Path

import bpy

import rgp_engine

ROOT = Path(__file__).resolve().parents[2]


def ours():
    """Everything in Blender that bears our name."""
    classes = {
        cls.__name__
        for base in (bpy.types.Panel, bpy.types.RenderEngine, bpy.types.PropertyGroup, bpy.types.Operator)
        for cls in base.__subclasses__()
        if cls.__name__.startswith("RGP") and cls.is_registered
    }
    panels = {
        cls.__name__
        for cls in bpy.types.Panel.__subclasses__()
        if "RGP" in getattr(cls, "COMPAT_ENGINES", ()) and not cls.__name__.startswith("RGP")
    }
    properties = {
        f"{owner.__name__}.rgp" for owner in (bpy.types.Scene, bpy.types.ViewLayer) if hasattr(owner, "rgp")
    }
    return classes, panels, properties


def test_registering_twice_leaves_nothing_behind():
    before = ours()
    assert all(before)
    rgp_engine.unregister()
    assert ours() == (set(), set(), set())
    rgp_engine.register()
    rgp_engine.unregister()
    assert ours() == (set(), set(), set())
    rgp_engine.register()
    assert ours() == before


def test_blenders_panels_that_make_sense_are_shown():
    _, panels, _ = ours()
    assert {
        "DATA_PT_lens",
        "DATA_PT_camera",
        "DATA_PT_camera_dof",
        "DATA_PT_camera_dof_aperture",
        "RENDER_PT_format",
        "RENDER_PT_output",
        "WORLD_PT_context_world",
    } <= panels
    assert not {"DATA_PT_light", "OBJECT_PT_visibility"} & panels


def test_the_package_does_not_need_blender_to_be_imported():
    code = "import sys; from rgp_engine import report, native, settings; sys.exit('bpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=False).returncode == 0


def test_registers_without_the_cycles_add_on():
    code = """
import os, sys, bpy, addon_utils
addon_utils.disable("cycles")
assert not hasattr(bpy.types.Scene, "cycles")
import rgp_engine
from tests.blender import build
rgp_engine.register()
bpy.ops.wm.read_factory_settings(use_empty=True)
addon_utils.disable("cycles")
scene = bpy.context.scene
scene.render.engine = "RGP"
scene.render.resolution_x = scene.render.resolution_y = 8
scene.rgp.photon_pass.photon_count = 100
build.lit_room()
bpy.ops.render.render()
rgp_engine.unregister()
sys.stdout.flush()
os._exit(0)
"""
    result = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, check=False, capture_output=True, text=True
    )
    assert result.returncode == 0, result.stdout + result.stderr
