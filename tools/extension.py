"""Builds the Blender extension: `python -m tools.extension CORE_WHEEL PYTHON_VERSION`, in an environment with bpy.

Blender installs the wheels that the manifest lists, so the zip carries the core and the Embree it opens. Blender's own
packager makes and validates the zip.
"""

from __future__ import annotations

import importlib.util
import platform
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

from tools.environment import VENVS
from tools.machine import ROOT, fail, require, say

PLATFORMS = {
    ("Linux", "x86_64"): "linux-x64",
    ("Darwin", "arm64"): "macos-arm64",
    ("Windows", "AMD64"): "windows-x64",
}
CONTENT = ("__init__.py", "rgp_engine", "LICENSE", "README.md")


def embreex_requirement(lock: str) -> str:
    """The entry of embreex in a lock file: its version and its hashes."""
    lines = lock.splitlines()
    first = next(number for number, line in enumerate(lines) if line.startswith("embreex=="))
    last = next(number for number in range(first, len(lines)) if not lines[number].endswith("\\"))
    return "\n".join(lines[first : last + 1]) + "\n"


def download_embreex(python_version: str) -> Path:
    """The pinned embreex wheel for that Python, downloaded unless an earlier build did."""
    entry = embreex_requirement((ROOT / "requirements/bpy-5.2.3.txt").read_text())
    folder = VENVS / f"embreex-python{python_version}"
    lock = folder / "embreex.txt"
    if not (lock.is_file() and lock.read_text() == entry):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        wanted = folder / "wanted.txt"
        wanted.write_text(entry)
        pip = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
        pip += ["--only-binary=:all:", "--require-hashes", "--python-version", python_version]
        if subprocess.run([*pip, "--dest", folder, "-r", wanted], check=False).returncode != 0:
            fail(f"the embreex wheel for Python {python_version} cannot be had")
        wanted.rename(lock)
    return next(folder.glob("embreex-*.whl"))


def manifest_for(manifest: str, platform_name: str, wheels: list[str]) -> str:
    """The manifest with its platform and wheels, which must come before the first table."""
    head, bracket, tables = manifest.partition("\n[")
    listed = "".join(f'  "./wheels/{wheel}",\n' for wheel in wheels)
    return f'{head}\nplatforms = ["{platform_name}"]\nwheels = [\n{listed}]\n{bracket}{tables}'


def blender_packager() -> Path:
    """Blender's command-line tool for extensions, which comes with bpy and runs without it."""
    spec = importlib.util.find_spec("bpy")
    assert spec is not None
    assert spec.origin is not None
    return next(Path(spec.origin).parent.glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))


def build(core_wheel: Path, python_version: str, destination: Path) -> Path:
    """Builds and validates the zip for this machine's platform and that Python in the folder `destination`; the zip."""
    machine = (platform.system(), platform.machine())
    if machine not in PLATFORMS:
        fail(f"no extension can be built on {' '.join(machine)}")
    destination.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        stage = Path(folder)
        wheels = stage / "wheels"
        wheels.mkdir()
        shutil.copy(core_wheel, wheels)
        shutil.copy(download_embreex(python_version), wheels)
        for name in CONTENT:
            source = ROOT / name
            if source.is_dir():
                shutil.copytree(source, stage / name, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(source, stage / name)
        names = sorted(wheel.name for wheel in wheels.iterdir())
        manifest = manifest_for((ROOT / "blender_manifest.toml").read_text(), PLATFORMS[machine], names)
        (stage / "blender_manifest.toml").write_text(manifest)

        version = tomllib.loads(manifest)["version"]
        target = destination / f"rgp_engine-{version}-{PLATFORMS[machine]}-python{python_version}.zip"
        packager: list[str | Path] = [sys.executable, blender_packager()]
        require([*packager, "build", "--source-dir", stage, "--output-filepath", target])
        require([*packager, "validate", target])
    return target


if __name__ == "__main__":
    say(f"built {build(Path(sys.argv[1]), sys.argv[2], ROOT / 'dist').relative_to(ROOT)}")
