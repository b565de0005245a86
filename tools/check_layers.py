"""Fails on an import that goes up: `python -m tools.check_layers`. The order is drawn in ARCHITECTURE.md."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

from tools.rust_paths import crate_modules

# A module imports only modules of lower rank; modules of one rank never import each other.
RUST_RANKS = {
    **dict.fromkeys(("math", "color", "sampling", "settings", "progress", "stats", "error"), 0),
    **dict.fromkeys(("shader", "pyramid", "film", "neighbors"), 1),
    "scene": 2,
    **dict.fromkeys(("bsdf", "light"), 3),
    **dict.fromkeys(("accel", "effects_plan"), 4),
    "lit_scene": 5,
    "estimator": 6,
    "caustic_map": 7,
    **dict.fromkeys(("photon_pass", "gather", "baseline"), 8),
    "render": 9,
}
# The lowest rank is the one exception: plain tools that may use each other.
FREE_RANK = 0

PYTHON_RANKS = {
    **dict.fromkeys(("report", "plot", "files"), 0),
    **dict.fromkeys(
        ("native", "stats", "settings", "accuracy", "properties", "preferences", "checkpoint"), 1
    ),
    **dict.fromkeys(("operators", "ui"), 2),
    "export": 3,
    **dict.fromkeys(("session", "sweep"), 4),
    "engine": 5,
    "__init__": 6,
    "cli": 7,
    "__main__": 8,
}
# Lower in rank, and still none of the importer's business.
NEVER = {("ui", "native"), ("properties", "native"), ("preferences", "native"), ("operators", "native")}
# These run and are tested without Blender.
WITHOUT_BPY = {"report", "native", "settings", "plot", "accuracy", "files", "checkpoint"}
# These serve a final render, whose scene is the depsgraph's and never the window's.
WITHOUT_CONTEXT = {"engine", "session", "sweep", "export", "native", "settings", "stats", "report"}

MAXIMUM_LINES = 500


def check_rust(root: Path) -> Iterator[str]:
    """Problems of `core/`: upward imports in the renderer, Python or unsafe code where it does not belong."""
    source = root / "core/renderer/src"
    for path in sorted(source.rglob("*.rs")):
        parts = path.relative_to(source).with_suffix("").parts
        if parts == ("lib",):
            continue
        module = parts[0]
        depth = len(parts) - (parts[-1] == "mod")
        where = path.relative_to(root)
        if module not in RUST_RANKS:
            yield f"{where}: {module} has no rank in {Path(__file__).name}"
            continue
        for line, name in crate_modules(path.read_text(), depth):
            if name in RUST_RANKS and name != module and not _allowed(RUST_RANKS, module, name):
                yield f"{where}:{line}: {_upward(RUST_RANKS, module, name)}"

    for crate in ("renderer", "python", "fuzz"):
        if "#![forbid(unsafe_code)]" not in (root / f"core/{crate}/src/lib.rs").read_text():
            yield f"core/{crate}/src/lib.rs: must say #![forbid(unsafe_code)]; only the crate embree has unsafe code"
    for crate in ("renderer", "embree", "fuzz"):
        if "pyo3" in (root / f"core/{crate}/Cargo.toml").read_text():
            yield f"core/{crate}/Cargo.toml: depends on pyo3; only the crate python knows Python"


def check_python(root: Path) -> Iterator[str]:
    """Problems of `rgp_engine/`: upward imports, and rgp_core, bpy or bpy.context where they do not belong."""
    package = root / "rgp_engine"
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package).with_suffix("").parts
        module = parts[0]
        where = path.relative_to(root)
        if module not in PYTHON_RANKS:
            yield f"{where}: {module} has no rank in {Path(__file__).name}"
            continue
        tree = ast.parse(path.read_text(), str(path))
        for_types = {
            id(inner) for node in ast.walk(tree) if _is_type_checking(node) for inner in ast.walk(node)
        }
        for node in ast.walk(tree):
            for problem in _python_problems(node, module, parts, for_types=id(node) in for_types):
                yield f"{where}:{getattr(node, 'lineno', 0)}: {problem}"


def _is_type_checking(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def _python_problems(node: ast.AST, module: str, parts: tuple[str, ...], *, for_types: bool) -> Iterator[str]:
    for name in _imported(node, parts):
        head, _, rest = name.partition(".")
        if head == "rgp_core" and module != "native" and not for_types:
            yield f"{module} imports rgp_core; only native does"
        if head == "bpy" and module in WITHOUT_BPY and not for_types:
            yield f"{module} imports bpy, but must run without Blender"
        target = rest.partition(".")[0]
        if head != "rgp_engine" or target not in PYTHON_RANKS or target == module:
            continue
        if (module, target) in NEVER:
            yield f"{module} must not import {target}"
        elif not _allowed(PYTHON_RANKS, module, target):
            yield _upward(PYTHON_RANKS, module, target)
    if module in WITHOUT_CONTEXT and isinstance(node, ast.Attribute) and ast.unparse(node) == "bpy.context":
        yield f"{module} reads bpy.context, which is the window's and not the render's"


def _imported(node: ast.AST, parts: tuple[str, ...]) -> Iterator[str]:
    """Full dotted names a statement imports; relative ones are resolved inside `rgp_engine`."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        base = node.module or ""
        if node.level:
            here = ("rgp_engine", *parts)
            base = ".".join([*here[: len(here) - node.level], *filter(None, [base])])
        yield from (f"{base}.{alias.name}" for alias in node.names)


def _allowed(ranks: dict[str, int], importer: str, imported: str) -> bool:
    if ranks is RUST_RANKS and ranks[importer] == ranks[imported] == FREE_RANK:
        return True
    return ranks[imported] < ranks[importer]


def _upward(ranks: dict[str, int], importer: str, imported: str) -> str:
    return f"{importer} (rank {ranks[importer]}) imports {imported} (rank {ranks[imported]}), which is not below it"


def check_sizes(root: Path) -> Iterator[str]:
    """Source files past the limit: a second concept is hiding in them."""
    for folder in ("core", "rgp_engine", "tools", "tests", "scenes", "benchmarks"):
        for path in sorted((root / folder).rglob("*.*")):
            if path.suffix in (".rs", ".py") and "target" not in path.relative_to(root).parts:
                lines = len(path.read_text().splitlines())
                if lines > MAXIMUM_LINES:
                    yield f"{path.relative_to(root)}: {lines} lines; split it at {MAXIMUM_LINES}"


def problems(root: Path) -> list[str]:
    """Everything that is wrong with the tree."""
    return [*check_rust(root), *check_python(root), *check_sizes(root)]


def main() -> None:
    """Prints what is wrong; exit code 1 when anything is."""
    found = problems(Path(__file__).resolve().parent.parent)
    print("\n".join(found) or "layers: every import goes down")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
