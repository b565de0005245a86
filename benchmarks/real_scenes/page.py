"""Writes what was measured: `real-scenes.json` and `real-scenes.md` from it, with the notes and the pictures."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .measure import BOUNCES, Comparison
from .notes import NOTES
from .sheet import RANGE
from .subjects import SUBJECTS, Subject

Figures = dict[str, Any]


def figures(comparison: Comparison) -> Figures:
    """What is told of one scene."""
    ours, theirs = comparison.ours, comparison.theirs
    return {
        "mean_ratio": [round(channel, 4) for channel in comparison.mean_ratio],
        "beyond_noise": round(comparison.beyond_noise, 4),
        "noise": round(comparison.noise(ours), 4),
        "cycles_noise": round(comparison.noise(theirs), 4),
        "seconds": round(ours.seconds, 1),
        "cycles_seconds": round(theirs.seconds, 1),
        "cycles_seconds_at_our_noise": round(comparison.seconds_at_our_noise, 1),
        "told": [
            f"{problem.subject}: {problem.message}"
            + (f" ({problem.count} times)" if problem.count > 1 else "")
            for problem in ours.problems
        ],
    }


def write(folder: Path, pictures: str, found: Mapping[str, Figures], setup: Figures) -> None:
    """Writes the figures and the page into a folder whose part `pictures` has a JPEG of every scene that may be
    shown. `setup` has the width, Cycles' samples per pixel, our settings and Blender's
    version."""
    document = {"setup": setup, "scenes": found}
    (folder / "real-scenes.json").write_text(json.dumps(document, indent=1) + "\n")
    subjects = [subject for subject in SUBJECTS if subject.name in found]
    parts = [_introduction(setup), _table(subjects, found)]
    for subject in subjects:
        parts += [f"## {subject.name}", *_scene(subject, pictures, found[subject.name])]
    (folder / "real-scenes.md").write_text("\n\n".join(parts) + "\n")


def _introduction(setup: Figures) -> str:
    settings = f", but `{' '.join(setup['settings'])}`" if setup["settings"] else ""
    return f"""# Scenes that others made

Written by `make scenes` with Cycles of Blender {setup["blender"]}, from files that are no part of the project. Each is
rendered {setup["width"]} pixels wide by both engines: ours with the settings it has when it is chosen{settings},
Cycles with {setup["samples"]} samples per pixel, {BOUNCES} bounces, all caustics, and no clamping, no denoising and no
Filter Glossy. The figures are also in [real-scenes.json](real-scenes.json).

In the pictures ours is on the left, Cycles' in the middle, both with one exposure. On the right is the difference: red
to yellow where ours is brighter, blue to white where it is darker, the strongest color from {RANGE:.0%} on.

- *Mean ratio*: our mean over Cycles', red, green and blue.
- *Beyond noise*: RMS of the difference without the noise of either, known from a second seed.
- *Noise*: RMS of one picture. All RMS are of the mean, the pixels clipped at eight times that.
- *Seconds*: of the processor, all threads together. *Cycles at our noise*: what Cycles would need for our noise, as
  noise falls with the root of time."""


def _table(subjects: Sequence[Subject], found: Mapping[str, Figures]) -> str:
    lines = [
        "| scene | mean ratio | beyond noise | our noise | Cycles' noise | our seconds | Cycles' | at our noise |",
        "| --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for subject in subjects:
        entry = found[subject.name]
        ratio = " ".join(f"{channel:.3f}" for channel in entry["mean_ratio"])
        errors = [f"{entry[key]:.1%}" for key in ("beyond_noise", "noise", "cycles_noise")]
        seconds = [
            f"{entry[key]:.0f}" for key in ("seconds", "cycles_seconds", "cycles_seconds_at_our_noise")
        ]
        lines.append(f"| {subject.name} | {ratio} | {' | '.join(errors)} | {' | '.join(seconds)} |")
    return "\n".join(lines)


def _scene(subject: Subject, pictures: str, entry: Figures) -> list[str]:
    """The part of the page on one scene."""
    told = [f"- {line}" for line in entry["told"]]
    return [
        f"{subject.credit}.",
        f"![ours, Cycles, difference]({pictures}/{subject.name}.jpg)"
        if subject.may_be_shown
        else "Its pictures are not shown here.",
        NOTES[subject.name],
        "\n".join(["The user is told:", "", *told]) if told else "The user is told nothing.",
    ]
