"""A sweep in another process: followed, stopped, ended. A small script stands in for it."""

import sys
import time

import pytest

from rgp_engine.accuracy import background
from rgp_engine.accuracy.background import BackgroundSweep
from tests.unit.test_accuracy import row, sweep

WAIT = "import sys; sys.stdin.read(); print('stopped')"


def start(folder, script):
    return BackgroundSweep([sys.executable, "-c", script], folder, folder)


def wait(running):
    deadline = time.monotonic() + 20.0
    while running.is_running:
        assert time.monotonic() < deadline
        time.sleep(0.02)


def test_progress_is_read_as_it_is_written(tmp_path):
    running = start(tmp_path, WAIT)
    running.refresh()
    assert running.sweep is None
    sweep([row(1.0, 3.0)]).write(tmp_path)
    running.refresh()
    assert running.sweep.rows[0].error == 3.0
    assert running.is_running
    running.end()


def test_stopping_closes_its_standard_input(tmp_path):
    running = start(tmp_path, WAIT)
    assert running.is_running
    running.stop()
    wait(running)
    assert (tmp_path / "log.txt").read_text().split() == ["stopped"]
    assert running.error == ""


def test_ending_leaves_no_process(tmp_path):
    running = start(tmp_path, "import time; time.sleep(600)")
    running.end()
    assert not running.is_running
    running.end()
    running.stop()


@pytest.mark.parametrize(
    ("script", "message"),
    [
        ("print('noise'); print('error: There is no camera'); raise SystemExit(1)", "There is no camera"),
        ("raise SystemExit('it broke')", "it broke"),
        ("raise SystemExit(3)", "The measurement ended without a word"),
        ("print('error: harmless')", ""),
    ],
)
def test_errors(tmp_path, script, message):
    running = start(tmp_path, script)
    wait(running)
    assert running.error == message


def test_the_last_is_kept(tmp_path, monkeypatch):
    monkeypatch.setattr(background, "_last", None)
    assert (background.last(), background.front()) == (None, [])
    running = start(tmp_path, "pass")
    wait(running)
    background.publish(running)
    assert (background.last(), background.front()) == (running, [])
    sweep([row(1.0, 3.0), row(2.0, 4.0)]).write(tmp_path)
    running.refresh()
    assert [r.seconds for r in background.front()] == [1.0]
