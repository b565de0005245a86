"""Every lamp and simple material alone against Cycles: means of the whole picture and of the ball."""

import json

import numpy as np
import pytest

from tests.render import cases, pictures
from tests.render.make_references import REFERENCES

TOLERANCE = 0.01
"""Of the mean over the channels."""
SETTINGS = {"gather.rays": 64, "gather.camera_samples": 64, "photon_pass.photon_count": 200_000}
CAUSTIC_SETTINGS = {**SETTINGS, "gather.rays": 512, "gather.camera_samples": 256}
"""For the lamp behind a ball of glass, which few rays find."""
GLASS = ("glass", "refraction", "transmission")
STANDARD_ERRORS = 3.0
"""Of the reference, granted beside the tolerance."""


@pytest.fixture(scope="module")
def references() -> dict[str, dict[str, dict[str, list[float]]]]:
    return json.loads((REFERENCES / "cases.json").read_text())["cases"]


@pytest.mark.parametrize("case", cases.CASES)
def test_case_has_the_mean_of_cycles(
    case: str, references: dict[str, dict[str, dict[str, list[float]]]]
) -> None:
    scene = cases.build(case)
    is_caustic = case.endswith("/lamp") and any(word in case for word in GLASS)
    pictures.use_rgp(scene, CAUSTIC_SETTINGS if is_caustic else SETTINGS)
    picture = pictures.render(scene)["Combined"]
    for region, box in cases.REGIONS.items():
        reference = references[case][region]
        found, expected = pictures.mean(pictures.part(picture, box)), np.array(reference["mean"])
        allowed = TOLERANCE * expected.mean() + STANDARD_ERRORS * np.array(reference["standard_error"])
        assert (np.abs(found - expected) < allowed).all(), f"{region}: {found / expected} of {expected}"
