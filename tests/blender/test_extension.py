"""The zip of `make extension`, installed into a Blender that has never seen the engine."""

import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from tools.environment import WHEELS
from tools.extension import build

INSTALL = """
from bl_pkg import bl_extension_cli
bl_extension_cli.cli_extension_handler(["install-file", "-r", "user_default", "-e", ZIP])
"""

RENDER = """
import addon_utils, os, sys
addon_utils.enable("bl_ext.user_default.rgp_engine")
scene = bpy.context.scene
scene.render.engine = "RGP"
scene.render.resolution_x, scene.render.resolution_y = 16, 16
scene.rgp.photon_pass.photon_count = 1000
scene.rgp.gather.rays = 1
scene.rgp.gather.camera_samples = 1
scene.render.filepath = PICTURE
bpy.ops.render.render(write_still=True)
print("core", sys.modules["rgp_core"].__file__, flush=True)
"""


@pytest.fixture(scope="module")
def stranger(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of Python packages like ours, but without the native core and Embree."""
    folder = tmp_path_factory.mktemp("packages")
    for path in Path(sysconfig.get_path("platlib")).iterdir():
        if not path.name.startswith(("rgp_core", "embreex")):
            (folder / path.name).symlink_to(path)
    return folder


def blender(script: str, packages: Path, resources: Path) -> str:
    """Runs a script in a Blender whose user files lie in `resources`; what it printed. bpy 4.5 may hang at its exit."""
    code = f"import bpy\n{script}\nimport os, sys; sys.stdout.flush(); os._exit(0)"
    environment = {**os.environ, "PYTHONPATH": str(packages), "BLENDER_USER_RESOURCES": str(resources)}
    command = [sys.executable, "-S", "-c", code]
    done = subprocess.run(
        command, env=environment, cwd=resources, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_zip_installs_and_renders_with_its_own_wheels(stranger: Path, tmp_path: Path) -> None:
    wheel = next(WHEELS.glob("rgp_core-*.whl"))
    archive = build(wheel, "{}.{}".format(*sys.version_info), tmp_path / "dist")
    resources = tmp_path / "resources"
    resources.mkdir()
    assert "Installed" in blender(INSTALL.replace("ZIP", repr(str(archive))), stranger, resources)

    picture = tmp_path / "picture.png"
    printed = blender(RENDER.replace("PICTURE", repr(str(picture))), stranger, resources)
    core = next(line.split(" ", 1)[1] for line in printed.splitlines() if line.startswith("core "))
    assert Path(core).is_relative_to(resources)
    assert picture.stat().st_size > 0
