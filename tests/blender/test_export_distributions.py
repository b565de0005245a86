"""Distributions of microfacets that are rendered as others."""

import pytest

from tests.blender import build


@pytest.fixture
def closures(exported):
    """Closures of a material, on the one object of the scene."""
    return lambda b_material: exported(b_material)["closures"]


@pytest.mark.parametrize(("distribution", "is_reported"), [("BECKMANN", True), ("GGX", False)])
def test_other_distributions_are_reported(scene, closures, problems, distribution, is_reported):
    b_material = build.surface("ShaderNodeBsdfRefraction", Roughness=0.1)
    (b_node,) = (node for node in b_material.node_tree.nodes if node.type == "BSDF_REFRACTION")
    b_node.distribution = distribution
    assert closures(b_material)[0]["closure"]["roughness"] == pytest.approx(0.1)
    assert any("BECKMANN" in text for text in problems()) == is_reported


@pytest.mark.parametrize(
    ("kind", "roughness", "is_reported"),
    [
        ("Principled", 0.5, True),
        ("Anisotropic", 0.5, True),
        ("Glass", 0.5, True),
        ("Refraction", 0.5, False),
        ("Principled", 0.0, False),
    ],
)
def test_a_distribution_that_loses_light_is_reported(scene, closures, problems, kind, roughness, is_reported):
    """Refraction has no other."""
    b_material = build.surface(f"ShaderNodeBsdf{kind}", Roughness=roughness)
    (b_node,) = (node for node in b_material.node_tree.nodes if hasattr(node, "distribution"))
    b_node.distribution = "GGX"
    closures(b_material)
    assert any("Multiscatter GGX is used" in text for text in problems()) == is_reported
