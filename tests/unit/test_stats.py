"""The stats file's completion and its table."""

import pytest

from rgp_engine.report import Problem, ProblemLog
from rgp_engine.stats import clock, complete, effect_rows, outlook, rows

CORE = {
    "seconds": {"accel": 1.0, "total": 3.0},
    "rays": {"camera": 1234567},
    "photons": {"emitted": 1000},
    "pyramid": {"levels": 8, "cell_size": 0.123456, "bytes": 3 << 20},
    "memory_peak_bytes": 10 << 20,
    "effects": [
        {
            "name": "direct_light",
            "switch": "auto",
            "computed": True,
            "because": "lamp 'Lamp'",
            "seconds": 2.5,
            "bytes": 3 << 20,
        },
        {
            "name": "emissive_meshes",
            "switch": "on",
            "computed": True,
            "because": "nothing in the scene asks for it",
            "seconds": 0.0,
            "bytes": 0,
        },
        {
            "name": "caustics",
            "switch": "auto",
            "computed": False,
            "because": "nothing in the scene asks for it",
            "seconds": 0.0,
            "bytes": 0,
        },
        {
            "name": "mirrors_and_glass",
            "switch": "off",
            "computed": False,
            "because": "glass on 'Bottle'",
            "seconds": 0.0,
            "bytes": 0,
        },
    ],
}


def test_completion_adds_what_only_the_host_knows():
    problems = [Problem("Cube", "is bent", 2)]
    found = complete(CORE, 0.5, {"blender": "5.0.1"}, {"gather": {"rays": 4}}, problems)
    assert found["seconds"] == {"export": 0.5, "accel": 1.0, "total": 3.5}
    assert found["versions"] == {"blender": "5.0.1"}
    assert found["settings"] == {"gather": {"rays": 4}}
    assert found["problems"] == [{"subject": "Cube", "message": "is bent", "count": 2}]
    assert CORE["seconds"]["total"] == 3.0, "the core's figures stay as they are"


def test_table():
    assert rows(CORE) == [
        ("Accel time", "1.00 s"),
        ("Total time", "3.00 s"),
        ("Camera rays", "1,234,567"),
        ("Photons emitted", "1,000"),
        ("Pyramid levels", "8"),
        ("Pyramid cell size", "0.1235"),
        ("Pyramid memory", "3.0 MiB"),
        ("Peak memory", "10.0 MiB"),
    ]
    assert rows({"seconds": {"total": 2.0}}) == [("Total time", "2.00 s")]


def test_audit():
    audit = {"hits": 900, "bias": -0.123, "interval": 0.0812, "cells_tested": 1200, "cells_disagreeing": 0}
    assert rows({"seconds": {}, "audit": audit}) == [("Pyramid bias", "-0.12 % ± 0.081 %")]
    found = rows({"seconds": {}, "audit": audit | {"cells_disagreeing": 3}})
    assert found[1] == ("Cells that disagree", "3 of 1,200")
    assert rows({"seconds": {}, "audit": None}) == rows({"seconds": {}, "audit": audit | {"hits": 0}}) == []


def test_effects():
    assert effect_rows(CORE) == [
        ("Direct light", "on, lamp 'Lamp': 2.50 s, 3.0 MiB"),
        ("Emissive meshes", "on by choice, nothing in the scene asks for it: 0.00 s"),
        ("Caustics", "off, nothing in the scene asks for it"),
        ("Mirrors and glass", "off by choice, glass on 'Bottle'"),
    ]
    assert effect_rows({}) == []


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.2, "00:00"), (65.4, "01:05"), (3599.6, "1:00:00"), (7203.0, "2:00:03")]
)
def test_clock(seconds, text):
    assert clock(seconds) == text


def test_the_same_problem_is_kept_once_and_counted():
    log = ProblemLog()
    log.add("Cube", "is bent")
    log.add("Lamp", "is odd", 2)
    log.add("Cube", "is bent", 3)
    log.add_records([{"subject": "Lamp", "message": "is odd", "count": 5}])
    assert log.problems == [Problem("Cube", "is bent", 4), Problem("Lamp", "is odd", 7)]


@pytest.mark.parametrize(
    ("target", "seconds_to_target", "text"),
    [
        (0.0, None, "0.8 % after 12 s; about 0.3 % at the end"),
        (0.4, 48.2, "0.8 % after 12 s; 0.4 % in about 48 s"),
        (0.4, 3725.0, "0.8 % after 12 s; 0.4 % in about 1:02:05"),
        (0.1, None, "0.8 % after 12 s; 0.1 % not with these rays and photons"),
    ],
)
def test_outlook(target: float, seconds_to_target: float | None, text: str):
    progress = {
        "error": 0.8,
        "error_at_end": 0.3,
        "seconds_elapsed": 12.1,
        "seconds_to_target": seconds_to_target,
    }
    assert outlook(progress, target) == text
