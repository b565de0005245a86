"""The command that makes the paper's tables, on a picture of 32 x 32 pixels."""

import json
import re
from dataclasses import replace

import bpy
import pytest

from benchmarks import capture
from benchmarks.tables.__main__ import make
from benchmarks.tables.plan import QUICK
from benchmarks.tables.runner import Runner
from benchmarks.tables.store import Store
from benchmarks.tables.subjects import SUBJECTS

CORNELL = SUBJECTS[0]
TINY = replace(
    QUICK,
    timed_divisor=16,
    divisor=32,
    rays=16,
    many_rays=32,
    photon_share=1 / 1000,
    truth_seconds=0.1,
    bins=("8x16",),
    finest=(128, 256),
)


@pytest.fixture
def _capturing():
    capture.register()
    yield
    capture.unregister()
    bpy.ops.wm.read_factory_settings(use_empty=True)


@pytest.fixture
def run(tmp_path, _capturing):
    """Makes the tables in one folder and returns what it has said."""

    def make_tables():
        said = []
        make(
            [CORNELL], TINY, Store(tmp_path / "renders", "core"), tmp_path / "results", "a test", said.append
        )
        return said

    return make_tables


def test_the_tables_are_made_and_a_second_run_does_only_what_is_missing(run, tmp_path, monkeypatch, capsys):
    run()
    results = tmp_path / "results"
    document = json.loads((results / "tables.json").read_text())
    row_names = {"rms_paper", "rms_truth", "seconds", "bytes", "speedup", "rms_systematic"}
    for table in ("table1", "table2", "table3"):
        rows = document[table]["cornell_box"]
        assert all(set(row) == row_names for row in rows.values())
        assert rows["photon_map"]["rms_paper"] is None
        assert all(row["rms_paper"] > 0.0 for name, row in rows.items() if not name.startswith("photon_map"))
        assert all(row["seconds"] > 0.0 for row in rows.values())
    assert document["table3"]["cornell_box"]["path"]["bytes"] == 0
    assert document["details"]["cornell_box"]["timed_size"] == [32, 32]
    assert len(document["verdicts"]) == capsys.readouterr().out.count("to reach") == 6

    page = (results / "README.md").read_text()
    links = re.findall(r"\]\(([^)]+)\)", page)
    assert len(links) == 5
    assert all((results / link).is_file() for link in links)

    page_again = results / "README.md"
    page_again.unlink()
    rendered = []
    whole = Runner._render
    monkeypatch.setattr(Runner, "_render", lambda self, job: rendered.append(job) or whole(self, job))
    run()
    assert rendered == []
    assert page_again.is_file()
    (lost,) = [path for path in (tmp_path / "renders").glob("*.json") if '"uniform_grid"' in path.read_text()]
    lost.unlink()
    run()
    assert [job.estimator for job in rendered] == ["uniform_grid"]


def test_an_interrupt_keeps_what_is_done(run, tmp_path, monkeypatch):
    whole = Runner._follow
    followed = []

    def interrupted(self, session):
        followed.append(session)
        if len(followed) == 4:
            raise KeyboardInterrupt
        whole(self, session)

    monkeypatch.setattr(Runner, "_follow", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run()
    assert len(list((tmp_path / "renders").glob("*.json"))) == 3
    assert not (tmp_path / "results").exists()
