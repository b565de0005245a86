"""Finding the native core and its Embree, and what is said when they are not there."""

import importlib.machinery
import importlib.util
import re
import sys
import types
from pathlib import Path

import pytest

from rgp_engine import native

ROOT = Path(__file__).resolve().parents[2]


def stand_in(version):
    module = types.ModuleType("rgp_core")
    module.__version__ = version
    module.RenderError = type("RenderError", (Exception,), {})
    return module


def test_missing_core(monkeypatch):
    monkeypatch.setitem(sys.modules, "rgp_core", None)
    with pytest.raises(native.NativeError, match=r"\(the wheel rgp_core\) cannot be loaded"):
        native.core()


def test_core_of_another_version(monkeypatch):
    monkeypatch.setitem(sys.modules, "rgp_core", stand_in("0.0.1"))
    with pytest.raises(
        native.NativeError, match=rf"needs rgp_core {native.CORE_VERSION} but 0\.0\.1 is installed"
    ):
        native.core()


@pytest.mark.parametrize("suffix", ["", "+g1234abc"])
def test_core_of_this_version(monkeypatch, suffix):
    module = stand_in(native.CORE_VERSION + suffix)
    monkeypatch.setitem(sys.modules, "rgp_core", module)
    assert native.core() is module


def test_core_errors_are_told_from_bugs(monkeypatch):
    module = stand_in(native.CORE_VERSION)
    monkeypatch.setitem(sys.modules, "rgp_core", module)
    assert native.is_render_error(module.RenderError("too dark"))
    assert not native.is_render_error(ValueError("a bug"))
    monkeypatch.setitem(sys.modules, "rgp_core", None)
    assert not native.is_render_error(ValueError("a bug"))


def test_one_version_everywhere():
    """Blender does not unpack a wheel again that has the version of the one before."""
    cargo = re.search(r'^version = "(.+)"', (ROOT / "core/Cargo.toml").read_text(), re.MULTILINE)
    manifest = re.search(r'^version = "(.+)"', (ROOT / "blender_manifest.toml").read_text(), re.MULTILINE)
    assert cargo is not None
    assert manifest is not None
    assert {cargo[1], manifest[1]} == {native.CORE_VERSION}


@pytest.mark.parametrize(
    "library",
    [
        "embreex.libs/libembree4-4aef3270.so.4",
        "embreex.libs/embree4-1234abcd.dll",
        "embreex/.dylibs/libembree4.4.dylib",
    ],
)
def test_embree_of_every_platforms_wheel(monkeypatch, tmp_path, library):
    package = tmp_path / "embreex"
    package.mkdir()
    path = tmp_path / library
    path.parent.mkdir(exist_ok=True)
    path.touch()
    spec = importlib.machinery.ModuleSpec("embreex", None, is_package=True)
    spec.submodule_search_locations = [str(package)]
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: spec)
    assert native.embree_library() == path.resolve()


def test_no_embree(monkeypatch, tmp_path):
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    with pytest.raises(native.NativeError, match="Embree is missing"):
        native.embree_library()


def test_finding_embree_does_not_load_the_package(monkeypatch):
    monkeypatch.delitem(sys.modules, "embreex", raising=False)
    assert native.embree_library().is_file()
    assert "embreex" not in sys.modules
