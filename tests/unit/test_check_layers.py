"""The layer checker, on small trees that break one rule each."""

from pathlib import Path

import pytest

from tools.check_layers import problems
from tools.rust_paths import crate_modules

CLEAN = {
    "core/renderer/Cargo.toml": "",
    "core/embree/Cargo.toml": "",
    "core/fuzz/Cargo.toml": "",
    "core/fuzz/src/lib.rs": "#![forbid(unsafe_code)]\n",
    "core/renderer/src/lib.rs": "#![forbid(unsafe_code)]\npub mod render;\n",
    "core/python/src/lib.rs": "#![forbid(unsafe_code)]\n",
    "core/renderer/src/math/mod.rs": "use crate::error::RenderError;\n",
    "core/renderer/src/gather/mod.rs": "use crate::{pyramid::Pyramid, scene::{Scene, camera}};\nmod rays;\n",
    "core/renderer/src/gather/rays.rs": "use super::Gather;\nuse crate::gather::Gather;\n",
    "core/renderer/src/render.rs": "use crate::{gather, photon_pass};\n",
    "rgp_engine/__init__.py": "from . import engine\n",
    "rgp_engine/native.py": "import rgp_core\nfrom .report import UserError\n",
    "rgp_engine/report.py": "",
    "rgp_engine/session.py": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import rgp_core\n",
    "rgp_engine/export/mesh.py": "import bpy\nfrom ..report import ProblemLog\nfrom . import light\n",
    "rgp_engine/ui/pyramid.py": "from bpy import context\nfrom ..properties import GROUPS\n",
}


def check(root: Path, changes: dict[str, str]) -> list[str]:
    for name, text in {**CLEAN, **changes}.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return problems(root)


def test_a_clean_tree_has_no_problems(tmp_path: Path) -> None:
    assert check(tmp_path, {}) == []


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        (
            "core/renderer/src/pyramid/cell.rs",
            "fn f() {}\nuse crate::scene::Scene;\n",
            "cell.rs:2: pyramid (rank 1) imports",
        ),
        (
            "core/renderer/src/gather/rays.rs",
            "use crate::photon_pass;\n",
            "rays.rs:1: gather (rank 8) imports photon_pass",
        ),
        (
            "core/renderer/src/light/mod.rs",
            "use crate::{math, render};\n",
            "mod.rs:1: light (rank 3) imports render",
        ),
        (
            "core/renderer/src/light/mod.rs",
            "fn f() -> crate::gather::Ray {}\n",
            "light (rank 3) imports gather",
        ),
        (
            "core/renderer/src/film/tile.rs",
            "use super::super::scene::Scene;\n",
            "film (rank 1) imports scene",
        ),
        ("core/renderer/src/film/mod.rs", "use super::scene::Scene;\n", "film (rank 1) imports scene"),
        ("core/renderer/src/voxel.rs", "", "voxel has no rank"),
        ("core/renderer/src/lib.rs", "", "must say #![forbid(unsafe_code)]"),
        ("core/renderer/Cargo.toml", "[dependencies]\npyo3.workspace = true\n", "depends on pyo3"),
        (
            "rgp_engine/report.py",
            "from .session import Session\n",
            "report.py:1: report (rank 0) imports session (rank 4)",
        ),
        ("rgp_engine/report.py", "from rgp_engine.export.mesh import x\n", "report (rank 0) imports export"),
        (
            "rgp_engine/properties/gather.py",
            "def f():\n    from ..ui import x\n",
            "gather.py:2: properties (rank 1) imports ui",
        ),
        (
            "rgp_engine/properties/__init__.py",
            "from .. import engine\n",
            "properties (rank 1) imports engine (rank 5)",
        ),
        ("rgp_engine/ui/pyramid.py", "from .. import native\n", "ui must not import native"),
        ("rgp_engine/export/mesh.py", "import rgp_core\n", "export imports rgp_core"),
        ("rgp_engine/native.py", "import bpy.types\n", "native imports bpy"),
        (
            "rgp_engine/export/mesh.py",
            "import bpy\nscene = bpy.context.scene\n",
            "mesh.py:2: export reads bpy.context",
        ),
        ("rgp_engine/helpers.py", "", "helpers has no rank"),
        ("tests/unit/test_long.py", "\n" * 501, "501 lines"),
    ],
)
def test_a_broken_rule_is_named(tmp_path: Path, path: str, text: str, expected: str) -> None:
    found = check(tmp_path, {path: text})
    assert len(found) == 1
    assert expected in found[0]


@pytest.mark.parametrize(
    "source",
    [
        "// use crate::render;\n",
        "/* crate::render /* nested */ crate::render */",
        'const HELP: &str = "use crate::render";',
        'const HELP: &str = r#"say "crate::render" "#;',
        "use super::render;\n",
        "fn f<'a>(x: &'a str) -> char { '\"' } // crate::render\n",
        "use other_crate::render; macro_rules! m { () => { my_crate::render } }",
    ],
)
def test_what_only_looks_like_an_import_is_none(source: str) -> None:
    assert list(crate_modules(source, depth=2)) == []


def test_a_use_tree_gives_the_first_name_of_each_path() -> None:
    source = "\n'x'; use crate::{\n    scene::{Scene, render::y},\n    math,\n    r#film as f,\n};\n"
    assert list(crate_modules(source, depth=1)) == [(2, "scene"), (2, "math"), (2, "film")]
