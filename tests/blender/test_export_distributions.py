"""Distributions of microfacets: whether they keep the light that bounces between them, and those rendered as others."""

import bpy
import pytest

from tests.blender import build


@pytest.fixture
def closure(scene, exported):
    """The only closure of a shader node whose distribution is another."""

    def convert(kind, distribution):
        b_material = build.surface(f"ShaderNodeBsdf{kind}", Roughness=0.5)
        (b_node,) = (node for node in b_material.node_tree.nodes if hasattr(node, "distribution"))
        b_node.distribution = distribution
        (part,) = exported(b_material)["closures"]
        return part["closure"]

    return convert


METALLIC = pytest.param(
    "Metallic", marks=pytest.mark.skipif(bpy.app.version < (4, 3), reason="Blender 4.2 has no Metallic BSDF")
)


@pytest.mark.parametrize("kind", ["Principled", "Anisotropic", "Glass", METALLIC])
@pytest.mark.parametrize("distribution", ["GGX", "MULTI_GGX"])
def test_light_between_microfacets_is_kept_or_lost(closure, problems, kind, distribution):
    assert closure(kind, distribution)["multiscatter"] == (distribution == "MULTI_GGX")
    assert not any("distribution" in text for text in problems())


@pytest.mark.parametrize("kind", ["Anisotropic", "Glass", "Refraction"])
def test_others_are_rendered_as_ggx_and_reported(closure, problems, kind):
    record = closure(kind, "BECKMANN")
    assert record["roughness"] == pytest.approx(0.5)
    assert not record.get("multiscatter", False)
    assert any("BECKMANN is not supported yet; GGX is used" in text for text in problems())
