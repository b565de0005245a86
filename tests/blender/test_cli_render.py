"""`python -m rgp_engine render` in processes of its own."""

import json
import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np
import OpenEXR
import pytest

from tests.blender import build

ROOT = Path(__file__).resolve().parents[2]
QUICK = [
    "--set",
    "photon_pass.photon_count=1000",
    "--set",
    "gather.rays=4",
    "--set",
    "gather.camera_samples=1",
]


@pytest.fixture(scope="module")
def blend(tmp_path_factory):
    """A saved file: a lit room, 32 x 24 pixels, with a second frame of nothing."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    build.lit_room()
    b_scene = bpy.context.scene
    b_scene.render.resolution_x, b_scene.render.resolution_y = 32, 24
    b_floor = bpy.data.objects["Floor"]
    for frame in (1, 2):
        b_floor.hide_render = frame == 2
        b_floor.keyframe_insert("hide_render", frame=frame)
    b_scene.frame_set(1)
    path = tmp_path_factory.mktemp("blend") / "room.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def run(*arguments):
    command = [sys.executable, "-m", "rgp_engine", *map(str, arguments)]
    # Blender 4.5 may hang when its process ends, after the work is done.
    return subprocess.run(command, cwd=ROOT, check=False, capture_output=True, text=True, timeout=120)


def pixels(path):
    with OpenEXR.File(str(path)) as file:
        channels = file.channels()
        name = "RGBA" if "RGBA" in channels else "RGB"
        picture = np.array(channels[name].pixels)
    assert picture.dtype == np.float32
    return picture


def test_picture_indirect_png_and_stats(blend, tmp_path):
    files = [tmp_path / name for name in ("a.exr", "indirect.exr", "a.json", "a.png")]
    options = ["-o", files[0], "--indirect", files[1], "--stats", files[2], "--png", files[3]]
    result = run("render", blend, *options, *QUICK, "--resolution", "40x20", "--threads", 1, "--seed", 5)
    assert result.returncode == 0, result.stderr
    assert pixels(files[0]).shape == (20, 40, 4)
    assert pixels(files[0])[..., :3].max() > 0.0
    assert pixels(files[1]).shape == (20, 40, 3)
    assert files[3].read_bytes().startswith(b"\x89PNG")
    stats = json.loads(files[2].read_text())
    assert stats["settings"]["render"] == {"threads": 1, "seed": 5, "memory_limit": 0}
    assert stats["settings"]["gather"]["rays"] == 4
    for word in (
        "Export time",
        "Gather rays",
        "Photons emitted",
        "Pyramid cells",
        "Peak memory",
        "Direct light",
    ):
        assert word in result.stdout


def test_audit(tmp_path):
    """One bounce of light instead of all is found, and drawn in the blue of what is missing."""
    image, stats = tmp_path / "audit.png", tmp_path / "out.json"
    settings = (
        "photon_pass.max_depth=1",
        "photon_pass.photon_count=50000",
        "gather.rays=64",
        "gather.audit=16",
    )
    sets = [word for setting in settings for word in ("--set", setting)]
    files = ["-o", tmp_path / "out.exr", "--audit-image", image, "--stats", stats]
    result = run("render", ROOT / "scenes/cornell_box.blend", *files, *sets, "--resolution", "64x64")
    assert result.returncode == 0, result.stderr
    assert "Pyramid bias" in result.stdout
    audit = json.loads(stats.read_text())["audit"]
    assert audit["bias"] < -audit["interval"] < 0.0
    assert audit["cells_disagreeing"] >= len(audit["cells"]) > 0
    b_image = bpy.data.images.load(str(image))
    red, _, blue, _ = np.array(b_image.pixels).reshape(-1, 4).T
    assert (blue - red).max() > 0.2
    assert (red - blue).max() < 0.05


def test_frame(blend, tmp_path):
    assert run("render", blend, "-o", tmp_path / "a.exr", *QUICK, "--frame", 2).returncode == 0
    assert (pixels(tmp_path / "a.exr")[..., :3] == 0.0).all()


def test_bins_and_enums(blend, tmp_path):
    options = [
        "--stats",
        tmp_path / "a.json",
        "--set",
        "pyramid.bins=4x8",
        "--set",
        "gather.sampling=uniform",
    ]
    assert run("render", blend, "-o", tmp_path / "a.exr", *QUICK, *options).returncode == 0
    settings = json.loads((tmp_path / "a.json").read_text())["settings"]
    assert settings["pyramid"]["bins"] == "4x8"
    assert settings["gather"]["sampling"] == "uniform"


def test_cycles_runs_the_same_way(blend, tmp_path):
    options = ["--engine", "CYCLES", "--set", "cycles.samples=4", "--indirect", tmp_path / "i.exr"]
    result = run("render", blend, "-o", tmp_path / "a.exr", *options)
    assert result.returncode == 0, result.stderr
    assert pixels(tmp_path / "a.exr")[..., :3].max() > 0.0
    assert pixels(tmp_path / "i.exr").shape == (24, 32, 3)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            ["--set", "gather.rayz=3"],
            "there is no setting gather.rayz; there are gather.audit, gather.camera_samples, ",
        ),
        (
            ["--set", "gatherer.rays=3"],
            "there is no group of settings gatherer; there are photon_pass, pyramid, ",
        ),
        (["--set", "gather.rays=0"], "gather.rays is 0; allowed is a whole number from 1 to 4096"),
        (["--set", "gather.rays=many"], "gather.rays is many; allowed is a whole number from 1 to 4096"),
        (["--set", "gather.rays"], "is not of the form GROUP.NAME=VALUE"),
        (["--set", "gather.sampling=random"], "allowed is one of cosine, uniform"),
        (["--set", "gather.retrace_distance=9"], "allowed is a number from 0 to 8"),
        (["--set", "pyramid.bins=33x16"], "such as 8x16 (nearest: 32x16)"),
        (["--set", "pyramid.bins=8"], "such as 8x16"),
        (["--seed", "-1"], "render.seed is -1"),
        (["--threads", "2000"], "render.threads is 2000"),
        (["--resolution", "12"], "is not of the form WxH"),
        (["--engine", "CYCLES", "--set", "cycles.sample=4"], "cycles.samples"),
    ],
)
def test_what_does_not_exist_is_answered_with_what_does(blend, tmp_path, options, message):
    result = run("render", blend, "-o", tmp_path / "a.exr", *options)
    assert result.returncode == 2
    assert message in result.stderr
    assert not (tmp_path / "a.exr").exists()


def test_missing_and_broken_files(blend, tmp_path):
    result = run("render", tmp_path / "none.blend", "-o", tmp_path / "a.exr")
    assert (result.returncode, "none.blend does not exist" in result.stderr) == (1, True)
    broken = tmp_path / "broken.blend"
    broken.write_text("no blend file")
    result = run("render", broken, "-o", tmp_path / "a.exr")
    assert (result.returncode, "cannot be opened" in result.stderr) == (1, True)
    result = run("render", blend, "-o", tmp_path / "no folder" / "a.exr")
    assert (result.returncode, "cannot be written" in result.stderr) == (1, True)


def test_a_failed_render_is_an_error(tmp_path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    build.add_object("Floor", build.quad())
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "blind.blend"))
    result = run("render", tmp_path / "blind.blend", "-o", tmp_path / "a.exr")
    assert result.returncode == 1
    assert "camera" in result.stderr
    assert "Traceback" not in result.stderr
