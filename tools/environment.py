"""Virtual environments from the lock files, and the core's wheel in them. Stamps keep from doing a thing twice."""

from __future__ import annotations

import base64
import hashlib
import shutil
import zipfile
from pathlib import Path

from tools.machine import (
    PYTHON_OF_BPY,
    ROOT,
    available_bpys,
    check_compiler,
    check_libraries,
    check_space,
    check_venv,
    interpreter,
    require,
    say,
)

VENVS = ROOT / ".venv"
WHEELS = VENVS / "wheels"
CORE = ROOT / "core"

# Gigabytes; what a fresh clone was seen to take, rounded up.
SPACE_OF_ENVIRONMENT = 1.5
SPACE_OF_BUILD = 0.5
SPACE_OF_TESTS = 2.5


def python_of(name: str) -> Path:
    """The interpreter of the environment `name` ("tools" or "bpy-5.0.1")."""
    return VENVS / name / "bin/python"


def pip_install(name: str, *arguments: str | Path) -> None:
    """Runs `pip install` in the environment `name`."""
    require([python_of(name), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *arguments])


def make_environment(name: str, python_version: str) -> Path:
    """Makes `.venv/<name>` with exactly what `requirements/<name>.txt` pins; its interpreter."""
    lock = ROOT / "requirements" / f"{name}.txt"
    stamp = VENVS / name / "lock.sha256"
    digest = hashlib.sha256(lock.read_bytes()).hexdigest()
    if stamp.is_file() and stamp.read_text() == digest and python_of(name).exists():
        return python_of(name)

    python = interpreter(python_version)
    assert python is not None, "callers ask for a version that available_bpys found"
    check_venv(python, python_version)
    check_space(ROOT, SPACE_OF_ENVIRONMENT, f"making .venv/{name}")
    say(f"making .venv/{name} with Python {python_version}")
    require([python, "-m", "venv", "--clear", VENVS / name])
    pip_install(name, "--only-binary=:all:", "--require-hashes", "-r", lock)
    stamp.write_text(digest)
    return python_of(name)


def make_tools() -> Path:
    """The environment of maturin, ruff and mypy, on the newest Python there is; its interpreter."""
    return make_environment("tools", PYTHON_OF_BPY[available_bpys()[-1]])


def make_blender(bpy: str) -> Path:
    """The environment of one bpy with the core, ready to render; its interpreter."""
    name = f"bpy-{bpy}"
    wheel = build_core()
    python = make_environment(name, PYTHON_OF_BPY[bpy])
    checked = VENVS / name / "libraries.checked"
    if not checked.exists():
        binary = next((VENVS / name / "lib").glob("python*/site-packages/bpy/__init__*.so"))
        check_libraries(binary)
        require([python, "-c", "import os, bpy; os._exit(0)"])  # bpy 4.5 may hang in its exit handlers
        checked.touch()
    install_core(name, wheel)
    return python


def install_core(name: str, wheel: Path) -> None:
    """Installs the core's wheel into the environment `name` unless that very build is there already."""
    stamp = VENVS / name / "core.wheel"
    if stamp.is_file() and stamp.read_text() == wheel.name:
        return
    pip_install(name, "--no-deps", "--no-index", "--force-reinstall", wheel)
    stamp.write_text(wheel.name)


def core_fingerprint() -> str:
    """Eight hexadecimal digits that change when anything changes that the core is built from."""
    sources = [
        path
        for pattern in ("*/src/**/*.rs", "**/*.toml", "*.lock", "python/*.pyi")
        for path in CORE.glob(pattern)
    ]
    digest = hashlib.sha256()
    no_part = {"target", "fuzz"}
    for path in sorted(path for path in sources if not no_part & set(path.relative_to(CORE).parts)):
        digest.update(str(path.relative_to(CORE)).encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:8]


def build_core() -> Path:
    """Builds the core in release as an abi3 wheel, whose version ends in its fingerprint; the wheel."""
    fingerprint = core_fingerprint()
    built = list(WHEELS.glob(f"rgp_core-*+{fingerprint}-*.whl"))
    if built:
        return built[0]
    check_compiler()
    check_space(ROOT, SPACE_OF_BUILD, "building the core")
    tools = make_tools()
    say("building the core")
    shutil.rmtree(WHEELS, ignore_errors=True)
    fresh = WHEELS / "fresh"
    command: list[str | Path] = [
        tools,
        "-m",
        "maturin",
        "build",
        "--release",
        "--locked",
        "--interpreter",
        tools,
    ]
    require([*command, "--manifest-path", CORE / "python/Cargo.toml", "--out", fresh], directory=CORE)
    return add_local_version(next(fresh.glob("*.whl")), fingerprint, WHEELS)


def add_local_version(wheel: Path, local: str, folder: Path) -> Path:
    """Copies the wheel `x-1.2.3-….whl` to `x-1.2.3+local-….whl` in the folder; the copy.

    Blender and pip keep an installed wheel when one of the same version comes, however different its content is.
    """
    name, version, tags = wheel.name.split("-", 2)
    renamed = f"{version}+{local}"
    old_info, new_info = f"{name}-{version}.dist-info/", f"{name}-{renamed}.dist-info/"
    folder.mkdir(parents=True, exist_ok=True)
    copy = folder / f"{name}-{renamed}-{tags}"
    records = []
    with zipfile.ZipFile(wheel) as source, zipfile.ZipFile(copy, "w", zipfile.ZIP_DEFLATED) as target:
        for entry in source.infolist():
            content = source.read(entry)
            entry.filename = entry.filename.replace(old_info, new_info)
            if entry.filename == f"{new_info}RECORD":
                continue
            if entry.filename == f"{new_info}METADATA":
                content = content.replace(
                    f"\nVersion: {version}\n".encode(), f"\nVersion: {renamed}\n".encode(), 1
                )
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            records.append(f"{entry.filename},sha256={digest},{len(content)}\n")
            target.writestr(entry, content)
        target.writestr(f"{new_info}RECORD", "".join([*records, f"{new_info}RECORD,,\n"]))
    return copy


def embree_library(name: str) -> Path:
    """The Embree library that the embreex wheel of the environment carries."""
    return next((VENVS / name / "lib").glob("python*/site-packages/embreex.libs/libembree4*"))
