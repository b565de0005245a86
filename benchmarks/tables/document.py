"""Everything that is measured, as it is written to `tables.json`."""

import platform
import subprocess
from collections.abc import Sequence
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any

import bpy

from benchmarks.tables.assemble import Renders, SceneFigures
from benchmarks.tables.job import THREADS
from benchmarks.tables.plan import Scale, ScenePlan
from benchmarks.tables.verdicts import verdicts
from rgp_engine import native

TABLES = ("table1", "table2", "table3")
_ROOT = Path(__file__).resolve().parents[2]


def document(
    plans: Sequence[ScenePlan], renders: Renders, scale: Scale, command: str, machine: dict[str, Any]
) -> dict[str, Any]:
    """`table1` to `table3` as {scene: {setting: row}}, what they were measured on and with, and the verdicts."""
    figures = {plan.subject.name: SceneFigures(plan, renders) for plan in plans}
    tables = {scene: _plain(figure) for scene, figure in figures.items()}
    details = {scene: figure.details() for scene, figure in figures.items()}
    return {
        **{name: {scene: tables[scene][name] for scene in tables} for name in TABLES},
        "details": details,
        "verdicts": [
            {**asdict(verdict), "verdict": verdict.word}
            for plan in plans
            for verdict in verdicts(
                plan.subject,
                tables[plan.subject.name],
                scale.many_rays,
                details[plan.subject.name]["doubts"],
            )
        ],
        "settings": {**asdict(scale), **_defaults(), "threads": THREADS},
        "commands": {"all": command, "renders": {plan.subject.name: _commands(plan) for plan in plans}},
        "machine": machine,
        "versions": versions(),
    }


def core_version() -> str:
    """Of the installed core, with the fingerprint of its sources where `make` has built it."""
    return version("rgp_core")


def versions() -> dict[str, str]:
    """Of everything that the figures depend on."""
    return {
        **native.versions(),
        "rgp_core": core_version(),
        "blender": bpy.app.version_string,
        "python": platform.python_version(),
        "commit": _commit(),
    }


def _plain(figures: SceneFigures) -> dict[str, dict[str, dict[str, Any]]]:
    return {
        name: {setting: asdict(row) for setting, row in rows.items()}
        for name, rows in figures.tables().items()
    }


def _defaults() -> dict[str, Any]:
    """Settings that the tables depend on and leave at their default."""
    names = ("photons_per_estimate", "sampling", "retrace_distance", "photons_per_cell", "normal_classes")
    return {
        knob["name"]: knob["default"] for knob in native.core().settings_schema() if knob["name"] in names
    }


def _commands(plan: ScenePlan) -> dict[str, dict[str, str]]:
    """By table and setting: the command of each render alone."""
    blend = plan.subject.blend
    groups = {**plan.tables, "timed": plan.timed, "truth": dict(zip(("first", "second"), plan.truth))}
    return {
        name: {setting: job.command(blend) for setting, job in jobs.items()} for name, jobs in groups.items()
    }


def _commit() -> str:
    """The commit that is checked out, and whether files differ from it."""
    command = ["git", "describe", "--always", "--dirty", "--abbrev=10", "--exclude=*"]
    try:
        done = subprocess.run(command, cwd=_ROOT, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return done.stdout.strip()
