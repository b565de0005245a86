"""The commands behind the Makefile: `python3 -m tools COMMAND`.

COMMAND is render, test, hard, fuzz, lint, bench, tables, agreement, scenes, extension or clean.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
from pathlib import Path

from tools.environment import (
    CORE,
    SPACE_OF_TESTS,
    VENVS,
    build_core,
    embree_library,
    install_core,
    make_blender,
    make_tools,
    python_of,
)
from tools.fuzz import fuzz_by_coverage
from tools.machine import (
    PYTHON_OF_BPY,
    ROOT,
    Command,
    available_bpys,
    check_compiler,
    check_space,
    require,
    run,
    say,
    timed,
)
from tools.memcheck import check_memory

OUT = ROOT / "out"
ALLOWLIST = ROOT / "tools/stubtest_allowlist.txt"
PATIENT = ("-o", "faulthandler_timeout=7200")
"""Tests that make a hundred million photons, or three thousand renders, do not hang."""


def render(options: argparse.Namespace) -> None:
    """Renders one scene with the newest Blender the machine allows."""
    python = make_blender(available_bpys(options.bpy)[-1])
    scene = Path(options.scene)
    OUT.mkdir(exist_ok=True)
    target = str(OUT / scene.stem)
    files = ["-o", f"{target}.exr", "--png", f"{target}.png", "--stats", f"{target}.json"]
    require([python, "-m", "rgp_engine", "render", scene, *files, *options.more])


def test(options: argparse.Namespace) -> None:
    """Rust tests, then Python tests: all of them on the newest Blender, the quicker ones on every other."""
    bpys = available_bpys(options.bpy)
    for bpy in bpys:
        make_blender(bpy)
    check_space(ROOT, SPACE_OF_TESTS, "building the tests")
    failed = []
    embree = str(embree_library(f"bpy-{bpys[-1]}"))
    cargo = ["cargo", "test", "--workspace", "--locked", "--no-fail-fast"]
    if timed("cargo test", cargo, CORE, RGP_EMBREE_LIBRARY=embree):
        failed.append("cargo test")
    for bpy in reversed(bpys):
        selection = ["tests"] if bpy == bpys[-1] else ["tests/blender", "tests/render", "-m", "not slow"]
        pytest = [python_of(f"bpy-{bpy}"), "-m", "pytest", *selection, *options.more]
        if timed(f"pytest with bpy {bpy}", pytest, ROOT, RGP_EXPECTED_BPY=bpy):
            failed.append(f"pytest with bpy {bpy}")
    if failed:
        sys.exit(f"error: failed: {', '.join(failed)}")
    say(f"every test passed: cargo test, and pytest with bpy {', '.join(bpys)}")


def hard(options: argparse.Namespace) -> None:
    """Every hard case with the edge it breaks at, into docs/stability.md and docs/stability.json."""
    python = make_blender(available_bpys(options.bpy)[-1])
    pytest = [python, "-m", "pytest", "tests/hard", *PATIENT, *options.more]
    if timed("hard cases", pytest, ROOT, RGP_STABILITY=str(ROOT / "docs")):
        sys.exit("error: a hard case failed; docs/stability.md says which")


def fuzz(options: argparse.Namespace) -> None:
    """Input that nobody meant through every door: by coverage, at random, and the Embree binding under valgrind."""
    bpy = available_bpys(options.bpy)[-1]
    python = make_blender(bpy)
    embree = embree_library(f"bpy-{bpy}")
    is_sound = check_memory(embree)
    found = fuzz_by_coverage(python, bpy, embree, options.seconds) if options.seconds else []
    pytest = [python, "-m", "pytest", "tests/hard/test_hostile.py", *PATIENT, *options.more]
    if timed("hostile input", pytest, ROOT, RGP_EXAMPLES="3000"):
        found.append("tests/hard/test_hostile.py")
    if found:
        sys.exit(f"error: some input was not met with a message: {', '.join(found)}")
    if not is_sound:
        sys.exit("error: the Embree crate's tests touch memory that is not theirs, or fail under valgrind")


def lint(_options: argparse.Namespace) -> None:
    """Everything that reads the code without running it, and the stub against the binary."""
    tools = make_tools()
    check_compiler()
    install_core("tools", build_core())
    checks: list[tuple[Command, Path]] = [
        (["cargo", "fmt", "--all", "--check"], CORE),
        (["cargo", "fmt", "--check"], CORE / "fuzz"),
        (["cargo", "clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"], CORE),
        ([tools, "-m", "ruff", "check", "."], ROOT),
        ([tools, "-m", "ruff", "format", "--check", "."], ROOT),
        ([tools, "-m", "mypy"], ROOT),
        ([tools, "-m", "mypy.stubtest", "rgp_core", "--allowlist", ALLOWLIST], VENVS),
        ([tools, "-m", "tools.check_layers"], ROOT),
    ]
    failed = [
        " ".join(map(str, command[:4])) for command, directory in checks if run(command, directory) != 0
    ]
    if failed:
        sys.exit("error: failed:\n  " + "\n  ".join(failed))
    say(f"lint: {len(checks)} checks passed")


def bench(options: argparse.Namespace) -> None:
    """Measures speed, prints it and writes `out/bench.json`."""
    python = make_blender(available_bpys(options.bpy)[-1])
    OUT.mkdir(exist_ok=True)
    require([python, "-m", "benchmarks", "-o", OUT / "bench.json", *options.more])


def tables(options: argparse.Namespace) -> None:
    """Makes the paper's tables with this engine's figures."""
    python = make_blender(available_bpys(options.bpy)[-1])
    require([python, "-m", "benchmarks.tables", *options.more])


def agreement(options: argparse.Namespace) -> None:
    """Compares every feature with Cycles and writes `docs/agreement.md`."""
    python = make_blender(available_bpys(options.bpy)[-1])
    require([python, "-m", "tests.render.agreement", *options.more])


def scenes(options: argparse.Namespace) -> None:
    """Compares scenes that others made with Cycles and writes `docs/real-scenes.md`."""
    python = make_blender(available_bpys(options.bpy)[-1])
    require([python, "-m", "benchmarks.real_scenes", *options.more])


def extension(options: argparse.Namespace) -> None:
    """Builds the Blender extension with the wheels for one Python inside."""
    bpy = available_bpys(options.bpy)[-1]
    python = make_blender(bpy)
    require([python, "-m", "tools.extension", build_core(), options.python or PYTHON_OF_BPY[bpy]])


def clean(_options: argparse.Namespace) -> None:
    """Removes everything that the other commands made."""
    for folder in (VENVS, OUT, ROOT / "dist", Path(os.environ.get("CARGO_TARGET_DIR", CORE / "target"))):
        shutil.rmtree(folder, ignore_errors=True)


def main() -> None:
    """Reads the command line and runs one command."""
    parser = argparse.ArgumentParser(prog="python3 -m tools", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    for command in (render, test, hard, fuzz, lint, bench, tables, agreement, scenes, extension, clean):
        subparser = commands.add_parser(command.__name__, help=command.__doc__)
        subparser.set_defaults(run=command)
        subparser.add_argument(
            "--bpy", type=lambda text: text or None, help="a version such as 5.0.1; default: the newest here"
        )
        if command is render:
            subparser.add_argument("--scene", default="scenes/cornell_box.blend")
        if command is fuzz:
            subparser.add_argument(
                "--seconds",
                type=int,
                default=600,
                help="for each target that is guided by coverage; 0 for none",
            )
        if command is extension:
            subparser.add_argument("--python", help="the Python of the Blender it is for, such as 3.13")
    options, more = parser.parse_known_args()
    options.more = more
    options.run(options)


if __name__ == "__main__":
    main()
