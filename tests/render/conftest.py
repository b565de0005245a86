"""What the render tests share: the engine known to Blender, once."""

import bpy
import pytest

import rgp_engine


@pytest.fixture(scope="session", autouse=True)
def _engine() -> None:
    if not hasattr(bpy.types.Scene, "rgp"):
        rgp_engine.register()
