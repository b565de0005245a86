"""The paper's tables: what is kept, what is rendered, and what is made of figures known beforehand."""

import json
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.tables.assemble import SceneFigures
from benchmarks.tables.error import Truth
from benchmarks.tables.forecast import Forecast, guess
from benchmarks.tables.job import Job
from benchmarks.tables.markdown import page
from benchmarks.tables.plan import FULL, QUICK, Pilot, scene_plan
from benchmarks.tables.store import Render, Store
from benchmarks.tables.subjects import SUBJECTS
from benchmarks.tables.verdicts import verdicts

CORNELL = SUBJECTS[0]
JOB = Job("cornell_box", (8, 6), "pyramid", 256, photons=1000)


def picture(value, height=6, width=8):
    return np.full((height, width, 3), value, np.float32)


def render(value, *, photon_pass=1.0, build=0.5, gather=2.0, size=1000, **photons):
    stats = {
        "seconds": {"photon_pass": photon_pass, "gather": gather, "total": photon_pass + build + gather},
        "estimator": {"name": "any", "bytes": size, "seconds": build},
        "photons": {"emitted": 100_000, "deposited": 200_000, **photons},
        "pyramid": {"build_bytes": 7_000_000},
    }
    return Render(stats, picture(value) if np.isscalar(value) else value)


@pytest.fixture
def plan():
    # Half a second for 16 rays: 90 s are 1440 rays for each half.
    return scene_plan(CORNELL, FULL, render(0.0), render(0.0, gather=0.5))


@pytest.fixture
def renders(plan):
    """The photon map is 1 everywhere, the pyramid 1.02, all else 1.1; the truth is 0.98."""
    found = {}
    for job in plan.jobs():
        value = {"photon_map": 1.0, "pyramid": 1.02}.get(job.estimator, 1.1)
        gather = {"photon_map": 40.0, "pyramid": 1.5}.get(job.estimator, 4.0)
        is_small = job.size == (128, 128)
        found[job] = render(value, gather=gather if is_small else 15.0 * gather, size=len(job.bins))
    for job, twin in plan.twins.items():
        found[twin] = found[job]
    for job in plan.truth:
        found[job] = render(0.98, photon_pass=0.0, build=0.0, gather=45.0)
    return found


@pytest.fixture
def document(plan, renders):
    figures = SceneFigures(plan, renders)
    tables = {
        name: {setting: vars(row) for setting, row in rows.items()} for name, rows in figures.tables().items()
    }
    details = figures.details()
    found = verdicts(CORNELL, tables, FULL.many_rays, details["doubts"])
    return {
        **{name: {CORNELL.name: rows} for name, rows in tables.items()},
        "details": {CORNELL.name: details},
        "verdicts": [{**vars(verdict), "verdict": verdict.word} for verdict in found],
        "settings": {
            "rays": 256,
            "many_rays": 1024,
            "photon_share": 1.0,
            "photons_per_estimate": 50,
            "sampling": "cosine",
            "threads": 2,
        },
        "commands": {"all": "make tables"},
        "machine": {"processor": "A Processor", "cores": 2, "system": "Linux", "load": 0.5},
        "versions": {"commit": "abc", "rgp_core": "1", "embree": "4", "blender": "5", "python": "3.11"},
    }


def test_a_render_is_found_again_and_nothing_else_is(tmp_path):
    store = Store(tmp_path / "renders", "0.1.0+a")
    assert store.find(JOB, "scene") is None
    kept = render(0.25)
    store.keep(JOB, "scene", kept)
    found = store.find(JOB, "scene")
    assert found is not None
    assert found.stats == kept.stats
    assert found.indirect.dtype == np.float32
    assert (found.indirect == 0.25).all()
    assert store.find(JOB, "another scene") is None
    assert Store(tmp_path / "renders", "0.1.0+b").find(JOB, "scene") is None
    changes = {
        "size": (8, 7),
        "estimator": "path",
        "rays": 255,
        "camera_samples": 8,
        "photons": 1001,
        "bins": "2x4",
        "finest": 64,
        "seed": 1,
    }
    for name, value in changes.items():
        assert store.find(replace(JOB, **{name: value}), "scene") is None, name


def test_a_render_without_its_statistics_is_not_there_and_clearing_forgets_all(tmp_path):
    store = Store(tmp_path, "core")
    store.keep(JOB, "scene", render(1.0))
    (statistics,) = tmp_path.glob("*.json")
    content = statistics.read_text()
    statistics.unlink()
    assert store.find(JOB, "scene") is None
    statistics.write_text(content)
    assert store.find(JOB, "scene") is not None
    store.clear()
    assert list(tmp_path.iterdir()) == []


def test_the_command_of_a_render_names_its_file_size_and_every_setting():
    command = JOB.command("scenes/cornell_box.blend")
    assert command.startswith("python -m rgp_engine render scenes/cornell_box.blend ")
    assert "--resolution 8x6 " in command
    for setting in ("gather.estimator=pyramid", "photon_pass.photon_count=1000", "pyramid.bins=8x16"):
        assert f"--set {setting}" in command


def test_photons_give_the_papers_memory_and_the_truth_its_time(plan):
    # 257.1 MB at 28 bytes are 9,182,143 photons; each that is emitted lands twice.
    assert {job.photons for table in plan.tables.values() for job in table.values()} == {4_591_071, 0}
    assert [(job.rays, job.camera_samples) for job in plan.truth] == [(1440, 360)] * 2
    assert plan.truth[0].seed != plan.truth[1].seed
    assert all(job.seed not in {truth.seed for truth in plan.truth} for job in plan.timed.values())


def test_quick_runs_render_little():
    def rays(scale):
        pilot = Pilot.of(CORNELL, scale)
        plan = scene_plan(CORNELL, scale, render(0.0), render(0.0, gather=0.5))
        jobs = [pilot.photons, pilot.path, *plan.jobs()]
        return sum(job.total_rays for job in jobs if job not in plan.truth)

    assert rays(QUICK) < rays(FULL) / 20


def test_the_tables_have_the_papers_settings_for_both_pyramids(plan):
    def settings(name):
        return set(plan.tables[name])

    bins, grids = ("2x4", "4x8", "8x16", "16x32"), (16, 32, 64, 128, 256, 512)
    both = ("pyramid", "pyramid_2006")
    assert settings("table1") == {"photon_map", *(f"{name} {value}" for name in both for value in bins)}
    assert settings("table2") == {"photon_map", *(f"{name} {value}" for name in both for value in grids)}
    others = ("photon_map", "precomputed_irradiance", "uniform_grid", "reverse_photon_map", "path")
    assert settings("table3") == {*both, *others, "photon_map, 1024 rays", "pyramid, 1024 rays"}
    assert {job.size for job in plan.timed.values()} == {(512, 512)}
    assert len(set(plan.jobs())) == len(list(plan.jobs()))


def test_rows_of_the_small_pictures(plan, renders):
    rows = SceneFigures(plan, renders).tables()["table1"]
    # 1 + 0.5 + 40 seconds of the photon map over 1 + 0.5 + 1.5 of the pyramid.
    row = dict(vars(rows["pyramid 2x4"]))
    assert row.pop("rms_systematic") is None
    assert row == pytest.approx(
        {"rms_paper": 2.0, "rms_truth": 4.0, "seconds": 3.0, "bytes": 3, "speedup": 41.5 / 3.0}, rel=1e-4
    )
    assert rows["photon_map"].rms_truth == pytest.approx(2.0, rel=1e-4)
    assert rows["photon_map"].rms_paper is None
    assert rows["photon_map"].speedup == 1.0
    assert rows["pyramid_2006 16x32"].rms_paper == pytest.approx(10.0, rel=1e-5)


def test_table_3_is_of_the_papers_size(plan, renders):
    figures = SceneFigures(plan, renders)
    rows = figures.tables()["table3"]
    # Timed: 1.5 + 15 x 40 against 1.5 + 15 x 1.5. Scaled to 16 times the pixels: 1.5 + 16 x 4.
    assert rows["photon_map"].seconds == 601.5
    assert rows["pyramid"].seconds == 24.0
    assert rows["pyramid"].speedup == pytest.approx(601.5 / 24.0)
    assert rows["uniform_grid"].seconds == 65.5
    assert rows["uniform_grid"].speedup == pytest.approx(601.5 / 65.5)
    # With many rays both are scaled.
    assert rows["pyramid, 1024 rays"].seconds == 25.5
    assert rows["pyramid, 1024 rays"].speedup == pytest.approx(641.5 / 25.5)
    details = figures.details()
    assert details["scaled_over_timed"]["pyramid"] == pytest.approx(25.5 / 24.0)
    assert details["seconds"]["pyramid"] == {
        "photon_pass": 1.0,
        "build": 0.5,
        "gather": 22.5,
        "is_scaled": False,
    }
    assert details["seconds"]["path"]["gather"] == 64.0
    assert details["truth"]["seconds"] == 90.0


def test_the_truths_noise_drops_out():
    random = np.random.default_rng(1)
    noise = random.normal(0.0, 0.3, (2, 64, 64, 3)).astype(np.float32)
    truth = Truth(1.0 + noise[0], 1.0 + noise[1])
    # 0.2 off, of a unit of 2.
    assert truth.rms(picture(1.2, 64, 64), 2.0) == pytest.approx(10.0, abs=0.5)
    assert truth.noise(2.0) == pytest.approx(100.0 * 0.3 / 2.0 / np.sqrt(2.0), rel=0.02)
    # The square of the error spreads by 0.09 / sqrt(64 blocks), here over a unit of 4.
    assert truth.resolves(2.0) == pytest.approx(100.0 * np.sqrt(0.09 / 8.0 / 4.0), rel=0.02)
    assert truth.rms(picture(1.0, 64, 64), 2.0) < truth.resolves(2.0)


def test_what_two_pictures_have_wrong_alike_is_no_noise():
    random = np.random.default_rng(1)
    truth, pictures = random.normal(0.0, 0.3, (2, 2, 256, 256, 3)).astype(np.float32)
    for error in (0.2, 0.0):
        one, other = (1.0 + error + noise for noise in pictures)
        # The square spreads by less than 0.0005, a third of 0.04².
        systematic = Truth(1.0 + truth[0], 1.0 + truth[1]).systematic(one, other, 1.0)
        assert systematic == pytest.approx(100.0 * error, abs=4.0 if error == 0.0 else 0.4)


def test_errors_that_noise_may_have_made_different_cannot_be_told(document):
    tables = {name: document[name][CORNELL.name] for name in ("table1", "table2", "table3")}
    tables["table3"]["pyramid, 1024 rays"]["rms_systematic"] = 0.5
    tables["table3"]["photon_map, 1024 rays"]["rms_systematic"] = 0.4
    tables["table2"]["pyramid 256"]["rms_truth"] = 1.3
    tables["table2"]["pyramid 128"]["rms_truth"] = 1.2

    def words(without_noise, finer_grid):
        doubts = {"without_noise": without_noise, "finer_grid": finer_grid}
        found = {verdict.claim: verdict.word for verdict in verdicts(CORNELL, tables, 1024, doubts)}
        return (
            found["RMS against the truth, 1024 rays, noise removed"],
            found["RMS against the truth, 256³ and 128³"],
        )

    # 0.5² - 0.4² = 0.3²; 1.3² - 1.2² = 0.5².
    assert words(0.29, 0.49) == ("falls short", "falls short")
    assert words(0.31, 0.51) == ("cannot be told", "cannot be told")


def test_the_doubt_is_that_of_noise():
    random = np.random.default_rng(1)
    truth = Truth(picture(1.0, 64, 64), picture(1.0, 64, 64))
    one, other = (tuple(picture(1.2, 64, 64) for _ in range(2)) for _ in range(2))
    assert truth.doubt(one, other, 2.0) == 0.0
    # Noise of 0.01 in each block of 8 x 8 pixels alike: the square of the error spreads by 2 x 0.2 times it.
    noise = np.kron(random.normal(0.0, 0.01, (8, 8)), np.ones((8, 8)))[..., None].astype(np.float32)
    noisy = picture(1.2, 64, 64) + noise
    expected = 100.0 * np.sqrt(2.0 * 2.0 * 0.2 * 0.01 / np.sqrt(64.0)) / 2.0
    assert truth.doubt((noisy, noisy), other, 2.0) == pytest.approx(expected, rel=0.1)


def test_forecasts_learn_from_what_is_most_alike():
    forecast = Forecast()
    job = replace(JOB, size=(160, 120))
    path, elsewhere = replace(job, estimator="path"), replace(job, scene="nave")
    assert forecast.seconds([job, path]) == pytest.approx(guess(job) + guess(path))
    forecast.learn(job, 3.0 * guess(job))
    assert forecast.seconds([job]) == pytest.approx(3.0 * guess(job))
    assert forecast.seconds([path]) == pytest.approx(3.0 * guess(path))
    forecast.learn(path, 5.0 * guess(path))
    assert forecast.seconds([job]) == pytest.approx(3.0 * guess(job))
    assert forecast.seconds([elsewhere]) == pytest.approx(guess(elsewhere))


def test_forecasts_do_not_learn_from_what_is_over_at_once():
    forecast = Forecast()
    forecast.learn(JOB, 100.0 * guess(JOB))
    assert forecast.seconds([JOB]) == pytest.approx(guess(JOB))


def test_verdicts(document):
    found = {verdict["claim"]: verdict for verdict in document["verdicts"]}
    speedup = found["speed-up over the photon map"]
    assert (speedup["paper"], speedup["to_reach"], speedup["reached"]) == ("63.5", "≥ 100", "25.1")
    assert speedup["verdict"] == "falls short"
    assert found["memory"]["verdict"] == "pass"
    against = found["RMS against the photon map"]
    assert (against["reached"], against["verdict"]) == ("2.000 %", "falls short")
    same = found["RMS against the photon map, 256³ and 128³"]
    assert (same["reached"], same["verdict"]) == ("2.000 % and 2.000 %", "pass")


def test_verdicts_of_a_pyramid_that_reaches_everything(document):
    tables = {name: document[name][CORNELL.name] for name in ("table1", "table2", "table3")}
    tables["table3"]["pyramid"] |= {"speedup": 100.0, "rms_paper": 0.5, "bytes": 40_000_000}
    tables["table3"]["pyramid, 1024 rays"]["rms_systematic"] = 0.3
    tables["table3"]["photon_map, 1024 rays"]["rms_systematic"] = 0.31
    known = {"without_noise": 0.0, "finer_grid": 0.0}
    assert {verdict.word for verdict in verdicts(CORNELL, tables, 1024, known)} == {"pass"}
    tables["table3"]["photon_map, 1024 rays"]["rms_systematic"] = 0.3
    tables["table2"]["pyramid 256"]["rms_paper"] = 2.1
    missed = [verdict.claim for verdict in verdicts(CORNELL, tables, 1024, known) if not verdict.is_reached]
    assert missed == [
        "RMS against the truth, 1024 rays, noise removed",
        "RMS against the photon map, 256³ and 128³",
    ]


def test_the_page_has_our_figures_beside_the_papers(document):
    text = page(document, has_notes=False)
    assert "| 2 × 4 | 1.210 % | 2.000 % |" in text
    assert "| 512³ | – | 2.000 % |" in text
    assert "| paper, Cornell box: pyramid |  |  |  | 74.5 s | 63.5 | 62.0 MB | 0.971 % |  |  |" in text
    assert "| `pyramid` | 1.0 s | 0.5 s | 22.5 s | 24.0 s | 25.1 | 0.0 MB | 2.000 % |" in text
    assert "| `uniform_grid` \\* | 1.0 s | 0.5 s | 64.0 s | 65.5 s | 9.2 |" in text
    assert "26.7 times as fast" in text
    assert "notes.md" not in text
    assert "notes.md" in page(document, has_notes=True)
    assert "quick run" not in text
    for block in text.split("\n\n"):
        if block.startswith("|"):
            assert len({line.count("|") for line in block.split("\n")}) == 1


def test_the_page_says_what_is_better_than_the_pyramid(document):
    rows = document["table3"][CORNELL.name]
    rows["uniform_grid"] |= {"seconds": 20.0, "bytes": 1, "rms_truth": 3.9}
    rows["pyramid"]["bytes"] = 5_000_000
    section = page(document, has_notes=False).partition("## Where the pyramid is worse")[2]
    assert "faster than the pyramid (24 s): `uniform_grid` (20 s)" in section
    assert "nearer the truth than the pyramid (4 %): `photon_map` (2 %), `uniform_grid` (3.9 %)" in section
    assert "smaller than the pyramid (5 MB): `photon_map`" in section


def test_the_document_can_be_written(document):
    assert json.loads(json.dumps(document))["table3"][CORNELL.name]["photon_map"]["rms_paper"] is None
