"""Coverage-guided fuzzing: libFuzzer on the core (`core/fuzz`), atheris on the add-on (`tests/fuzz`).

Inputs that got somewhere new are kept in `out/fuzz/TARGET/corpus` and tried again the next time; one that ends a
target is written beside them as `found-...`, and becomes a test once it is understood.
"""

from __future__ import annotations

import os
import random
from pathlib import Path

from tools.environment import CORE, SPACE_OF_BUILD
from tools.machine import ROOT, Command, check_space, require, run, say, timed

CORPORA = ROOT / "out/fuzz"
LOCK = ROOT / "requirements/fuzz.txt"
CORE_TARGETS = ("programs", "render", "scene_builder", "settings", "textures")
ADDON_TARGETS = ("node_compiler", "settings")
SEEDS = 64
OPTIONS = ("-rss_limit_mb=3000", "-timeout=60", "-max_len=4096", "-len_control=0", "-detect_leaks=0")
"""Of libFuzzer: an input that takes more memory (MB) or time (s) is a finding; long ones are tried from the start."""
QUIET = ("-verbosity=0", "-print_funcs=0", "-print_final_stats=1")


def fuzz_by_coverage(python: Path, bpy: str, embree: Path, seconds: int) -> list[str]:
    """Runs every target whose tools are here for so many seconds; the names of those that found something."""
    targets = {**_core_targets(), **_addon_targets(python, bpy)}
    variables = {"RGP_EMBREE_LIBRARY": str(embree)}
    return [
        name
        for name, command in targets.items()
        if timed(f"fuzz {name}", [*command, *_arguments(name, seconds)], ROOT, **variables)
    ]


def _core_targets() -> dict[str, Command]:
    """The core's targets, built by the pinned compiler: without AddressSanitizer, which refuses the way Embree is
    loaded, and has nothing to watch in a renderer without unsafe code. The binding's memory is valgrind's to check."""
    if run(["sh", "-c", "cargo fuzz --version >/dev/null 2>&1"]) != 0:
        say("the core is not fuzzed by coverage: there is no cargo-fuzz here (cargo install cargo-fuzz)")
        return {}
    check_space(ROOT, SPACE_OF_BUILD, "building the fuzz targets")
    built = Path(os.environ.get("CARGO_TARGET_DIR", CORE / "target")) / "fuzz"
    options: list[str | Path] = ["--fuzz-dir", "fuzz", "--sanitizer", "none", "--target-dir", built]
    require(["cargo", "fuzz", "build", *options], CORE)
    return {f"core-{name}": [next(built.glob(f"*/release/{name}"))] for name in CORE_TARGETS}


def _addon_targets(python: Path, bpy: str) -> dict[str, Command]:
    """The add-on's targets, where atheris has a wheel."""
    arguments = ("--quiet", "--disable-pip-version-check", "--only-binary=:all:", "--require-hashes")
    if run([python, "-m", "pip", "install", *arguments, "-r", LOCK]) != 0:
        say(
            f"the add-on is not fuzzed by coverage: atheris cannot be installed beside bpy {bpy}; pip says why"
        )
        return {}
    return {f"addon-{name}": [python, "-m", f"tests.fuzz.{name}"] for name in ADDON_TARGETS}


def _arguments(name: str, seconds: int) -> list[str | Path]:
    """libFuzzer's, with a corpus that begins with bytes of every length, the same everywhere."""
    corpus = CORPORA / name / "corpus"
    corpus.mkdir(parents=True, exist_ok=True)
    if not any(corpus.iterdir()):
        dice = random.Random(0)
        for seed in range(SEEDS):
            (corpus / f"seed-{seed}").write_bytes(dice.randbytes(4 << dice.randrange(9)))
    found = f"-artifact_prefix={CORPORA / name}/found-"
    return [corpus, f"-max_total_time={seconds}", found, *OPTIONS, *QUIET]
