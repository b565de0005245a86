"""What is measured and what is made of it, with answers known beforehand."""

import json

import numpy as np
import pytest

from rgp_engine.accuracy.error import Means, Reference, measured_error
from rgp_engine.accuracy.figure import PNG, SVG, write_figure
from rgp_engine.accuracy.front import Row, cheapest, pareto_front
from rgp_engine.accuracy.model import Costs, Model, nonnegative_fit
from rgp_engine.accuracy.plan import first_round, next_round, within
from rgp_engine.accuracy.quality import Quality
from rgp_engine.accuracy.result import FILE, Sweep
from rgp_engine.accuracy.text import table
from rgp_engine.accuracy.window import Window, representative_window
from rgp_engine.cli.compare import compare_pictures

BASE = Quality(finest=128, bins="8x16", photons=1_000_000, rays=256, samples=16)


def row(seconds, error, *, is_limit=False, **changed):
    quality = Quality(**{**vars(BASE), **changed})
    return Row(quality, seconds, error, is_limit, bytes=3 << 20)


def test_front():
    rows = [row(3.0, 1.0), row(1.0, 4.0), row(2.0, 5.0), row(2.0, 2.0), row(4.0, 1.0), row(5.0, 0.5)]
    assert [(r.seconds, r.error) for r in pareto_front(rows)] == [
        (1.0, 4.0),
        (2.0, 2.0),
        (3.0, 1.0),
        (5.0, 0.5),
    ]
    assert pareto_front([]) == []


def test_cheapest():
    rows = [row(3.0, 1.0), row(1.0, 4.0), row(2.0, 2.0), row(2.5, 1.9)]
    assert cheapest(rows, 2.0) == rows[2]
    assert cheapest(rows, 1.0) == rows[0]
    assert cheapest(rows, 0.5) is None


def noisy(truth, sigma, seed):
    return (truth + np.random.default_rng(seed).normal(0.0, sigma, truth.shape)).astype(np.float32)


def test_error_without_noise_is_that_of_compare():
    random = np.random.default_rng(5)
    truth, picture = (random.random((40, 50, 3)).astype(np.float32) for _ in range(2))
    truth[3, 4] = 20.0
    reference = Reference(truth, truth, Means.of(truth))
    found = measured_error(picture, reference)
    expected = compare_pictures(picture, truth)
    assert found.percent == pytest.approx(expected.rms_clipped, rel=1e-6)
    assert found.percent < 0.9 * expected.rms_mean
    assert not found.is_limit
    assert reference.noise == 0.0


def test_noise_of_the_reference_is_no_error():
    """An error of 10 % against halves with 20 % noise each, whose mean has 14.1 %: the raw difference is 17.3 %."""
    truth = np.full((200, 200, 3), 2.0)
    reference = Reference(noisy(truth, 0.4, 1), noisy(truth, 0.4, 2), Means(2.0, 2.0))
    assert reference.noise == pytest.approx(20.0 / np.sqrt(2.0), rel=0.01)
    picture = noisy(truth, 0.2, 3)
    raw = compare_pictures(picture, (reference.first + reference.second) / 2.0).rms_mean
    assert raw == pytest.approx(17.32, rel=0.01)
    found = measured_error(picture, reference)
    assert found.percent == pytest.approx(10.0, rel=0.03)
    assert not found.is_limit


def test_no_error_is_told_below_what_the_reference_resolves():
    truth = np.full((64, 64, 3), 1.0)
    reference = Reference(noisy(truth, 0.2, 1), noisy(truth, 0.2, 2), Means(1.0, 1.0))
    # 256 blocks of 20 % noise: its square spreads by 0.04 / 16, twice that is the square of 7.1 %.
    assert reference.resolves == pytest.approx(7.07, rel=0.05)
    found = measured_error(truth.astype(np.float32), reference)
    assert found.percent == reference.resolves
    assert found.is_limit


def test_pictures_that_are_no_multiple_of_blocks():
    truth = np.full((13, 9, 3), 1.0, np.float32)
    reference = Reference(truth, truth, Means(1.0, 1.0))
    assert measured_error(truth + np.float32(0.1), reference).percent == pytest.approx(10.0, rel=1e-5)


def test_window_has_the_error_of_the_whole():
    """Noise on the right half alone: a window of half the width must show as much of both."""
    first, second = np.ones((32, 64, 3)), np.ones((32, 64, 3))
    first[:, 32:] += 1.0
    found = representative_window(first, second, (32, 32))
    assert found == Window(16, 0, 32, 32)
    assert representative_window(first, second, (100, 100)) == Window(0, 0, 64, 32)


def synthetic(qualities):
    """Rows and costs of a renderer that follows the model exactly."""
    rows, costs = [], []
    for q in qualities:
        square = (0.02 if q.finest == 128 else 1.8) + 1e6 / q.photons + 32.0 / q.rays + 256.0 / q.samples**2
        cost = Costs(q.photons * 1e-6, q.rays * 1e-3 + q.samples * 2e-3, 0.25)
        costs.append(cost)
        whole = cost.photon_pass + 16 * cost.gather + cost.rest
        rows.append(Row(q, whole, square**0.5, is_limit=False, bytes=0))
    return rows, costs


def test_model_finds_what_it_was_made_from():
    rows, costs = synthetic(first_round(BASE, is_glossy=False, is_quick=False))
    model = Model(rows, costs, ratio=16.0)
    others = [
        BASE.scaled("photons", 8).scaled("rays", 2),
        BASE.scaled("samples", 2),
        BASE.scaled("finest", 0.5),
    ]
    expected, expected_costs = synthetic(others)
    assert model.errors(others) == pytest.approx([r.error for r in expected], rel=0.02)
    assert [model.seconds(q) for q in others] == pytest.approx([r.seconds for r in expected], rel=1e-3)
    run = expected_costs[0]
    assert model.run_seconds(others[0]) == pytest.approx(run.photon_pass + run.gather + run.rest, rel=1e-3)


def test_next_round_is_the_front_of_the_model():
    rows, costs = synthetic(first_round(BASE, is_glossy=False, is_quick=False))
    model = Model(rows, costs, ratio=16.0)
    found = next_round(model, BASE, [r.quality for r in rows], is_quick=False)
    assert len(found) == len(set(found)) > 3
    assert not set(found) & {r.quality for r in rows}
    predicted = list(zip((model.seconds(q) for q in found), model.errors(found), strict=True))
    assert predicted == sorted(predicted, key=lambda p: (p[0], -p[1]))
    # No choice of the model is faster for an error of 1 %.
    aim = min(
        model.seconds(q) for q, e in zip(model.choices(BASE), model.errors(model.choices(BASE))) if e <= 1.0
    )
    assert min(seconds for seconds, error in predicted if error <= 1.0) == pytest.approx(aim)
    assert 0.2 < predicted[-1][1] <= 0.25, "the smallest error that is aimed at"
    assert within(model, found, 1e9) == found
    assert within(model, found, model.run_seconds(found[0]) * 1.01) == found[:1]


def test_first_round_varies_one_thing_at_a_time():
    found = first_round(BASE, is_glossy=True, is_quick=False)
    rich = found[1]
    assert found[0] == BASE
    assert rich.rays > BASE.rays
    for quality in found[2:]:
        assert sum(vars(quality)[name] != vars(rich)[name] for name in vars(rich)) == 1
    assert {q.bins for q in found} == {"8x16", "4x8", "16x32"}
    assert {q.bins for q in first_round(BASE, is_glossy=False, is_quick=False)} == {"8x16"}
    assert len(first_round(BASE, is_glossy=False, is_quick=True)) < len(found) - 2


def test_no_setting_leaves_its_range():
    extreme = Quality(finest=1024, bins="32x64", photons=1_000_000_000, rays=4096, samples=1024)
    for quality in (*first_round(extreme, is_glossy=True, is_quick=False), BASE.scaled("rays", 1e-9)):
        assert 1 <= quality.rays <= 4096
        assert 1 <= quality.samples <= 1024
        assert 8 <= quality.finest <= 1024
        assert quality.photons <= 1_000_000_000
        elevation, azimuth = map(int, quality.bins.split("x"))
        assert elevation <= 32
        assert azimuth <= 64


def test_nonnegative_fit():
    matrix = np.array([[1.0, 0.0], [1.0, 1.0], [1.0, 2.0]])
    assert nonnegative_fit(matrix, np.array([1.0, 3.0, 5.0])) == pytest.approx([1.0, 2.0], abs=1e-6)
    # A falling line has no rising share: the best that is left is its mean.
    assert nonnegative_fit(matrix, np.array([5.0, 3.0, 1.0])) == pytest.approx([3.0, 0.0], abs=1e-6)


def sweep(rows):
    return Sweep(
        scene="box",
        resolution=(512, 512),
        window=(10, 20, 128, 128),
        current=BASE,
        is_glossy=False,
        threads=2,
        versions={"blender": "5.0.1"},
        reference={"noise": 0.2, "resolves": 0.1, "seconds": 60.0},
        rows=rows,
        state="done",
        runs_total=len(rows),
    )


def test_file_keeps_everything(tmp_path):
    written = sweep([row(1.0, 3.0), row(2.0, 0.9, rays=512), row(5.0, 0.95, rays=1024)])
    written.write(tmp_path)
    assert vars(Sweep.read(tmp_path)) == vars(written)
    content = json.loads((tmp_path / FILE).read_text())
    assert [r["seconds"] for r in content["front"]] == [1.0, 2.0]
    assert content["cheapest"]["1"]["settings"]["gather.rays"] == 512
    assert content["cheapest"]["0.5"] == "not reached: the best of 3 settings has 0.9 %"
    assert content["rows"][0]["bytes"] == 3 << 20


def test_why_an_error_is_not_reached():
    assert sweep([]).not_reached() == "not reached: nothing was measured"
    limited = sweep([row(1.0, 0.7, is_limit=True)])
    assert limited.not_reached() == "not reached: the reference tells no error below 0.7 %"


def test_table_and_plot(tmp_path):
    found = sweep([row(1.0, 3.0), row(2.0, 0.9, rays=512), row(4.0, 0.2, photons=4_000_000, is_limit=True)])
    lines = table(found)
    assert lines[0].split() == ["error", "time", "rays", "samples", "photons", "finest", "bins", "pyramid"]
    assert lines[3].split() == ["<0.2", "%", "4", "s", "256", "16", "4", "M", "128", "-", "3.0", "MiB"]
    assert "2 s --set" in lines[4]
    assert "--set gather.rays=512" in lines[4]
    write_figure(found, tmp_path)
    assert (tmp_path / PNG).read_bytes().startswith(b"\x89PNG")
    assert "512 rays, 1 M photons" in (tmp_path / SVG).read_text()
