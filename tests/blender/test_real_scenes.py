"""The program that compares scenes others made with Cycles, on pictures whose figures are known."""

import json

import numpy as np
import pytest

from benchmarks.real_scenes.measure import Comparison, Renders
from benchmarks.real_scenes.notes import NOTES
from benchmarks.real_scenes.page import figures, write
from benchmarks.real_scenes.sheet import relative_difference, sheet, write_pictures
from benchmarks.real_scenes.subjects import SUBJECTS
from rgp_engine.report import Problem

_SHAPE = (64, 96, 3)


def _renders(scale, noise, seed, seconds=1.0, problems=()):
    """Two gray pictures of that brightness and RMS noise."""
    random = np.random.default_rng(seed)
    pictures = [(scale + noise * random.standard_normal(_SHAPE)).astype(np.float32) for _ in range(2)]
    return Renders((pictures[0], pictures[1]), seconds, problems)


def test_noise_is_told_from_difference():
    comparison = Comparison(_renders(1.2, 0.3, 1, 10.0), _renders(1.0, 0.6, 2, 5.0))
    assert comparison.mean_ratio == pytest.approx([1.2] * 3, rel=0.03)
    assert comparison.noise(comparison.ours) == pytest.approx(0.3, rel=0.03)
    assert comparison.noise(comparison.theirs) == pytest.approx(0.6, rel=0.03)
    assert comparison.beyond_noise == pytest.approx(0.2, rel=0.08)
    assert comparison.seconds_at_our_noise == pytest.approx(20.0, rel=0.08)


def test_one_bright_pixel_does_not_decide():
    even = _renders(1.0, 0.1, 1)
    spark = _renders(1.0, 0.1, 2)
    spark.pictures[0][5, 5] = 1e4
    assert Comparison(spark, even).noise(spark) < 0.3


def test_difference_is_relative():
    theirs = np.ones(_SHAPE)
    ours = theirs.copy()
    theirs[0, 0], ours[0, 0] = 4.0, 5.0
    theirs[0, 1], ours[0, 1] = 0.0, 0.05
    difference = relative_difference(ours, theirs)
    assert difference[0, 0] == pytest.approx(0.25)
    assert difference[0, 1] == pytest.approx(0.5, rel=0.01), "black is told as a part of a tenth of the mean"
    assert not difference[1:].any()


def test_page_and_pictures(tmp_path):
    subject = next(subject for subject in SUBJECTS if subject.may_be_shown)
    hidden = next(subject for subject in SUBJECTS if not subject.may_be_shown)
    problem = Problem("Lamp", "has a node that is left out", 3)
    comparison = Comparison(_renders(1.0, 0.1, 1, problems=(problem,)), _renders(1.0, 0.1, 2))
    pixels = sheet(comparison)
    assert pixels.shape[0] == _SHAPE[0]
    assert pixels.shape[1] > 3 * _SHAPE[1]
    write_pictures(tmp_path / "a.png", tmp_path / "a.jpg", pixels)
    assert (tmp_path / "a.jpg").read_bytes()[:2] == b"\xff\xd8"
    found = {scene.name: figures(comparison) for scene in (subject, hidden)}
    write(
        tmp_path,
        "pictures",
        found,
        {"width": 96, "samples": 4, "settings": ["gather.rays=4"], "blender": "5.0"},
    )
    page = (tmp_path / "real-scenes.md").read_text(encoding="utf-8")
    assert "Lamp: has a node that is left out (3 times)" in page
    assert f"pictures/{subject.name}.jpg" in page
    assert f"pictures/{hidden.name}.jpg" not in page
    assert json.loads((tmp_path / "real-scenes.json").read_text())["scenes"][subject.name]["noise"] > 0.0


def test_every_scene_has_notes():
    assert {subject.name for subject in SUBJECTS} == set(NOTES)
