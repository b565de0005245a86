"""What this machine offers: Python interpreters, a linker, Rust, the system libraries bpy needs.

Standard library only, and plain enough to start under any Python 3.9: its first task is to say which one is needed.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn, Union

ROOT = Path(__file__).resolve().parent.parent

Command = Sequence[Union[str, Path]]  # noqa: UP007  (Python 3.9 reads this line)

# Each bpy wheel runs on exactly one Python; oldest Blender first.
PYTHON_OF_BPY = {"4.2.23": "3.11", "4.5.15": "3.11", "5.0.1": "3.11", "5.2.3": "3.13"}

# Debian's package of every shared library that some bpy wheel links to and does not carry itself.
PACKAGE_OF_LIBRARY = {
    "libGL.so.1": "libgl1",
    "libICE.so.6": "libice6",
    "libSM.so.6": "libsm6",
    "libX11.so.6": "libx11-6",
    "libXext.so.6": "libxext6",
    "libXfixes.so.3": "libxfixes3",
    "libXi.so.6": "libxi6",
    "libXrender.so.1": "libxrender1",
    "libXt.so.6": "libxt6",
    "libXxf86vm.so.1": "libxxf86vm1",
    "libgcc_s.so.1": "libgcc-s1",
    "libgomp.so.1": "libgomp1",
    "libstdc++.so.6": "libstdc++6",
    "libxkbcommon.so.0": "libxkbcommon0",
    "libz.so.1": "zlib1g",
}


def say(line: str) -> None:
    """Prints one step of the work."""
    print(f"==> {line}", flush=True)


def fail(message: str) -> NoReturn:
    """Ends the command with a message for the person at the terminal."""
    sys.exit(f"error: {message}")


def run(command: Command, directory: Path = ROOT, **variables: str) -> int:
    """Runs a command in the open, with extra environment variables; its exit code."""
    environment = {
        **os.environ,
        **variables,
        "PATH": f"{os.environ['PATH']}{os.pathsep}{Path.home() / '.cargo/bin'}",
    }
    return subprocess.run(command, cwd=directory, env=environment, check=False).returncode


def timed(name: str, command: Command, directory: Path, **variables: str) -> int:
    """Runs a test command and prints its time; its exit code."""
    say(name)
    start = time.monotonic()
    code = run(command, directory, **variables)
    say(
        f"{name}: {'passed' if code == 0 else f'failed with code {code}'} in {time.monotonic() - start:.0f} s"
    )
    return code


def require(command: Command, directory: Path = ROOT, **variables: str) -> None:
    """Runs a command and ends ours, with its exit code, when it fails."""
    code = run(command, directory, **variables)
    if code != 0:
        print(f"error: failed with code {code}: {' '.join(map(str, command))}", file=sys.stderr)
        sys.exit(code)


def check_space(folder: Path, gigabytes: float, purpose: str) -> None:
    """Ends the command while that is cheap when the disk is too full; a full one fails late and in odd places."""
    free = shutil.disk_usage(folder).free / 1e9
    if free < gigabytes:
        fail(f"{purpose} takes about {gigabytes:.1f} GB, and {free:.1f} GB are free on the disk of {folder}")


def interpreter(version: str) -> Path | None:
    """A Python of that version (such as "3.11") that really runs, or None. A pyenv shim may be there and not run."""
    candidates = [sys.executable]
    candidates += [path for name in (f"python{version}", "python3") if (path := shutil.which(name))]
    candidates += map(str, sorted((Path.home() / ".pyenv/versions").glob(f"{version}*/bin/python{version}")))
    question = "import sys; print('%d.%d' % sys.version_info[:2])"
    for candidate in candidates:
        answer = subprocess.run([candidate, "-c", question], capture_output=True, text=True, check=False)
        if answer.returncode == 0 and answer.stdout.strip() == version:
            return Path(candidate)
    return None


def available_bpys(wanted: str | None = None) -> list[str]:
    """The bpy versions this machine's interpreters allow, newest last; only `wanted` when it is given."""
    if wanted is not None and wanted not in PYTHON_OF_BPY:
        fail(f"bpy {wanted} is not one of {', '.join(PYTHON_OF_BPY)}")
    pythons = {version for version in set(PYTHON_OF_BPY.values()) if interpreter(version)}
    bpys = [bpy for bpy, python in PYTHON_OF_BPY.items() if python in pythons and wanted in (None, bpy)]
    if not bpys:
        here = "{}.{}".format(*sys.version_info[:2])
        need = PYTHON_OF_BPY[wanted] if wanted else "3.11 (for bpy 5.0, 4.5 and 4.2) or 3.13 (for bpy 5.2)"
        fail(f"Python {need} is needed, and none runs here (python3 is {here}). Install it and try again")
    return bpys


def install_packages(packages: list[str], reason: str) -> None:
    """Installs Debian packages when root on Debian or a relative; otherwise says what to install, and ends."""
    line = f"apt-get install -y --no-install-recommends {' '.join(packages)}"
    if not shutil.which("apt-get"):
        fail(
            f"{reason}. On Debian they come with: {line}\n       Install this system's packages of the same content"
        )
    if os.geteuid() != 0:
        fail(f"{reason}. Install what is missing and try again:\n       sudo {line}")
    say(f"{reason}; installing {' '.join(packages)}")
    require(["apt-get", "update", "-q"])
    require(line.split(), DEBIAN_FRONTEND="noninteractive")


def check_venv(python: Path, version: str) -> None:
    """Debian keeps the part of Python that makes virtual environments in a package of its own."""
    if (
        subprocess.run([python, "-c", "import ensurepip, venv"], capture_output=True, check=False).returncode
        != 0
    ):
        install_packages([f"python{version}-venv"], f"Python {version} cannot make virtual environments")


def check_compiler() -> None:
    """Rust is needed to build the core, and a C linker to link it."""
    if not shutil.which("cc"):
        install_packages(["gcc", "libc6-dev"], "the core needs a C linker")
    if run(["sh", "-c", "command -v cargo >/dev/null"]) != 0:
        fail(
            "the core needs Rust. Install rustup (https://rustup.rs); it fetches the pinned toolchain by itself"
        )


def check_libraries(binary: Path) -> None:
    """Every shared library that the binary needs is found, or is installed."""
    listing = subprocess.run(["ldd", binary], capture_output=True, text=True, check=False).stdout
    missing = sorted(line.split()[0] for line in listing.splitlines() if "not found" in line)
    if not missing:
        return
    unknown = [library for library in missing if library not in PACKAGE_OF_LIBRARY]
    if unknown:
        fail(f"Blender needs shared libraries that this system lacks: {', '.join(unknown)}")
    install_packages(
        [PACKAGE_OF_LIBRARY[library] for library in missing], "Blender needs shared system libraries"
    )
