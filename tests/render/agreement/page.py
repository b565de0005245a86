"""Writes what was measured: `agreement.json`, and `agreement.md` with its contact sheets."""

from __future__ import annotations

import json
from collections.abc import Mapping
from itertools import groupby
from pathlib import Path
from typing import Any

from rgp_engine.plot.png import write_png

from .exclusions import EXCLUSIONS, NOT_RENDERED
from .measure import LARGEST_MEAN_DIFFERENCE, LARGEST_RMS, SEEDS, Agreement
from .sheet import contact_sheet

TITLES = {
    "lamp": "Lamps and the world",
    "lamp_node": "Lamps with nodes",
    "world": "Worlds that differ from direction to direction",
    "material": "Shaders, under an even world and under a square lamp",
    "path": "Ways of light",
    "thin_wall": "Thin walls",
    "motion": "Motion blur",
    "node": "Nodes",
    "linking": "Light linking and shadow linking",
    "catcher": "Shadow catchers",
    "panorama": "Cameras that see all around",
}
"""By group."""


def write(folder: Path, found: Mapping[str, Agreement], blender: str) -> None:
    """Writes the page, the figures and the pictures into a folder."""
    pictures = folder / "agreement"
    pictures.mkdir(parents=True, exist_ok=True)
    figures = {name: _figures(name, agreement) for name, agreement in found.items()}
    figures.update({name: {"pass": False, "excluded": reason} for name, reason in NOT_RENDERED.items()})
    (folder / "agreement.json").write_text(json.dumps(figures, indent=1) + "\n")
    parts = [_introduction(figures, blender)]
    numbered = list(enumerate(found.items(), 1))
    for group, entries in groupby(numbered, lambda entry: entry[1][0].split("/", 1)[0]):
        rows = list(entries)
        pairs = [(str(i), agreement.ours.mean, agreement.theirs.mean) for i, (_, agreement) in rows]
        write_png(pictures / f"{group}.png", contact_sheet(pairs))
        parts += [f"## {TITLES[group]}", f"![ours, Cycles](agreement/{group}.png)"]
        parts.append(_table([(i, name, figures[name]) for i, (name, _) in rows]))
    parts += ["## Not rendered", _list(NOT_RENDERED)]
    (folder / "agreement.md").write_text("\n\n".join(parts) + "\n")


def _figures(name: str, agreement: Agreement) -> dict[str, Any]:
    figures: dict[str, Any] = {
        "mean_ratio": round(agreement.mean_ratio, 5),
        "mean_error": round(agreement.mean_error, 5),
        "rms_mean": round(agreement.rms_mean, 5),
        "noise": round(agreement.noise, 5),
        "beyond_noise": round(agreement.beyond_noise, 5),
        "pass": agreement.passes,
    }
    if not agreement.passes and name in EXCLUSIONS:
        figures["excluded"] = EXCLUSIONS[name]
    return figures


def _introduction(figures: Mapping[str, Mapping[str, Any]], blender: str) -> str:
    rendered = [entry for entry in figures.values() if "mean_ratio" in entry]
    passed = sum(entry["pass"] for entry in rendered)
    return f"""# Agreement with Cycles

Written by `make agreement`, with Cycles of Blender {blender}. Every feature is alone in a scene of a few objects, built
by `cases.py` and its neighbors `*_cases.py` in `tests/render`, and rendered by both engines in one process.
The figures are also in [agreement.json](agreement.json).

{passed} of {len(rendered)} features agree: their means differ by at most {LARGEST_MEAN_DIFFERENCE:.0%}, and their
pixels by at most {LARGEST_RMS:.0%} (RMS, of the mean) beyond the noise. The noise is known from {len(SEEDS)} pictures
of each engine that differ in their seed. In the pictures ours is on the left, Cycles' on the right; nodes show
a half and a quarter of their value."""


def _table(rows: list[tuple[int, str, dict[str, Any]]]) -> str:
    lines = [
        "| | feature | mean ratio | RMS | noise | beyond noise | |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for i, name, entry in rows:
        ratio = f"{entry['mean_ratio']:.4f} ± {entry['mean_error']:.4f}"
        parts = [f"{entry[key]:.2%}" for key in ("rms_mean", "noise", "beyond_noise")]
        verdict = "agrees" if entry["pass"] else f"**differs**: {entry.get('excluded', 'not explained')}"
        lines.append(f"| {i} | {name.split('/', 1)[1]} | {ratio} | {' | '.join(parts)} | {verdict} |")
    return "\n".join(lines)


def _list(reasons: Mapping[str, str]) -> str:
    return "\n".join(f"- {name}: {reason}" for name, reason in reasons.items())
