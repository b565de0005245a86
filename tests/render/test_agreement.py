"""The comparison with Cycles: figures of pictures whose differences are known, and what is written of them."""

import json
from pathlib import Path

import numpy as np
import pytest

from tests.render.agreement.exclusions import EXCLUSIONS
from tests.render.agreement.features import features
from tests.render.agreement.measure import Agreement, Renders, measure
from tests.render.agreement.page import TITLES, write

NOISE = 0.06
COUNT = 4


def renders(mean: float, stripes: float = 0.0) -> Renders:
    """Pictures of this mean, every other column brighter by `stripes` and the rest darker, with noise."""
    random = np.random.default_rng(round(1000 * mean))
    truth = np.full((64, 64, 3), mean)
    truth[:, ::2] += stripes
    truth[:, 1::2] -= stripes
    return Renders([truth + random.normal(0.0, NOISE, truth.shape) for _ in range(COUNT)])


def test_noise_is_known_and_not_counted() -> None:
    agreement = Agreement(renders(1.001), renders(1.0))
    assert agreement.noise == pytest.approx(NOISE / np.sqrt(COUNT) * np.sqrt(2.0), rel=0.03)
    assert agreement.rms_mean == pytest.approx(agreement.noise, rel=0.03)
    assert agreement.beyond_noise < 0.01
    assert agreement.mean_ratio == pytest.approx(1.001, abs=3.0 * agreement.mean_error)
    assert agreement.passes


@pytest.mark.parametrize(("mean", "stripes"), [(1.02, 0.0), (1.005, 0.04)])
def test_differences_beyond_the_noise_are_found(mean: float, stripes: float) -> None:
    agreement = Agreement(renders(mean, stripes), renders(1.0))
    assert agreement.beyond_noise == pytest.approx(np.hypot(mean - 1.0, stripes), abs=0.005)
    assert not agreement.passes


def test_the_page_tells_what_differs_and_why(tmp_path: Path) -> None:
    same, other = Agreement(renders(1.001), renders(1.0)), Agreement(renders(1.5), renders(1.0))
    known = next(iter(EXCLUSIONS))
    write(tmp_path, {"lamp/same": same, "lamp/other": other, known: other}, "0.0.0")
    figures = json.loads((tmp_path / "agreement.json").read_text())
    assert figures["lamp/same"]["pass"]
    assert not figures["lamp/other"]["pass"]
    assert figures[known]["excluded"] == EXCLUSIONS[known]
    page = (tmp_path / "agreement.md").read_text()
    assert "1 of 3 features agree" in page
    assert "not explained" in page
    assert (tmp_path / "agreement/lamp.png").exists()


def test_reasons_are_given_for_what_is_compared() -> None:
    assert set(EXCLUSIONS) <= {feature.name for feature in features()}


def test_every_group_has_a_title() -> None:
    groups = {feature.name.split("/", 1)[0] for feature in features()}
    # Before Blender 5.2 there are no thin walls to compare.
    assert groups | {"thin_wall"} == set(TITLES)


def test_a_feature_is_compared() -> None:
    feature = next(feature for feature in features() if feature.name == "node/Gamma")
    assert measure(feature.build, box_filter=feature.box_filter).passes
