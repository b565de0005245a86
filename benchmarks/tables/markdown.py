"""The results as a page, from nothing but the document that is written to `tables.json`."""

from collections.abc import Iterator, Sequence
from typing import Any

from benchmarks.tables import paper
from benchmarks.tables.plan import PHOTON_MAP, PYRAMID, PYRAMID_2006
from benchmarks.tables.subjects import SUBJECTS, Subject
from benchmarks.tables.wording import compared, measured_with, weaknesses

Document = dict[str, Any]

_OURS = (PYRAMID, PYRAMID_2006)


def page(document: Document, *, has_notes: bool) -> str:
    """The whole page. `has_notes`: a page `notes.md`, written by hand, lies beside it."""
    subjects = [subject for subject in SUBJECTS if subject.name in document["table1"]]
    parts = [
        "# The paper's tables, with this engine's figures",
        f"Written by `{document['commands']['all']}`, which renders everything anew; all figures are in "
        "[tables.json](tables.json), each with the command of its render. The paper is Yue, Iwasaki, Nishita, "
        "*Radiance Grid Pyramid*; its figures stand beside ours wherever it gives any.",
        "## What was to be reached",
        *_verdicts(document),
        *(["[notes.md](notes.md) says why what falls short does, and what was tried."] if has_notes else []),
        "## How it is measured",
        *measured_with(document, subjects),
        "## Table 1: direction bins against error",
        *_errors(document, subjects, "table1", "bins"),
        "## Table 2: finest grid against error",
        *_errors(document, subjects, "table2", "grid"),
        "## Table 3: time and memory",
        *_times(document, subjects),
        "## Table 4: pictures",
        *_pictures(subjects),
        "## Where the pyramid is worse",
        *weaknesses(document, subjects),
    ]
    return "\n\n".join(parts) + "\n"


def _verdicts(document: Document) -> Iterator[str]:
    yield _table(
        ("claim", "scene", "paper", "to reach", "here", ""),
        [
            (v["claim"], v["scene"], v["paper"], v["to_reach"], v["reached"], v["verdict"])
            for v in document["verdicts"]
        ],
    )


def _errors(document: Document, subjects: Sequence[Subject], name: str, column: str) -> Iterator[str]:
    """One table and one plot per scene."""
    for subject in subjects:
        rows = document[name][subject.name]
        values = [
            setting.removeprefix(f"{PYRAMID} ") for setting in rows if setting.startswith(f"{PYRAMID} ")
        ]
        columns = [f"`{ours}` against {what}" for ours in _OURS for what in ("photon map", "truth")]
        head = (column, f"paper, {subject.published.name}", *columns)
        lines = [
            (
                value.replace("x", " × ") if column == "bins" else f"{value}³",
                _percent(_published(subject, name).get(value)),
                *(
                    _percent(rows[f"{ours} {value}"][kind])
                    for ours in _OURS
                    for kind in ("rms_paper", "rms_truth")
                ),
            )
            for value in values
        ]
        yield f"### {subject.name}"
        yield _table(head, lines)
        yield f"The photon map itself is {rows[PHOTON_MAP]['rms_truth']:.3f} % from the truth."
        yield f"![{name} of {subject.name} as a plot]({name}_{subject.name}.svg)"


def _times(document: Document, subjects: Sequence[Subject]) -> Iterator[str]:
    yield (
        "Seconds of a picture of the paper's size; *gather* is the final gather alone, *all* adds the photon "
        "pass and "
        "building what the gather asks. *Speed-up* is the photon map's *all* over this one's."
    )
    head = (
        "method",
        "photons",
        "build",
        "gather",
        "all",
        "speed-up",
        "memory",
        "against photon map",
        "truth",
    )
    for subject in subjects:
        published, rows = subject.published, document["table3"][subject.name]
        lines: list[Sequence[str]] = [
            (
                f"paper, {published.name}: {name}",
                "",
                "",
                "",
                f"{seconds:,.1f} s",
                f"{published.photon_map_seconds / seconds:.1f}",
                _megabytes(size),
                _percent(error),
                "",
            )
            for name, seconds, size, error in (
                ("photon map", published.photon_map_seconds, published.photon_map_bytes, None),
                (
                    "pyramid",
                    published.pyramid_seconds,
                    published.pyramid_bytes,
                    published.rms_by_bins[paper.BINS],
                ),
            )
        ]
        for setting, row in rows.items():
            parts = document["details"][subject.name]["seconds"][setting]
            lines.append(
                (
                    f"`{setting}`" + (" \\*" if parts["is_scaled"] else ""),
                    *(f"{parts[part]:.1f} s" for part in ("photon_pass", "build", "gather")),
                    f"{row['seconds']:.1f} s",
                    f"{row['speedup']:.1f}",
                    _megabytes(row["bytes"]),
                    _percent(row["rms_paper"]),
                    _percent(row["rms_truth"]),
                )
            )
        yield f"### {subject.name}"
        yield _table(head, lines)
        yield compared(document, subject)
        yield f"![Time against error in {subject.name}](table3_{subject.name}.svg)"


def _pictures(subjects: Sequence[Subject]) -> Iterator[str]:
    yield (
        "The indirect light of the renders that table 3 times, at half their size, and the difference of the "
        "two: red where "
        "the pyramid is brighter, blue where it is darker, in percent of the photon map's brightest pixel."
    )
    for subject in subjects:
        yield f"![{subject.name}: pyramid, photon map, difference](table4_{subject.name}.png)"


def _published(subject: Subject, table: str) -> dict[str, float]:
    """The paper's errors by bins or grid as text."""
    if table == "table1":
        return subject.published.rms_by_bins
    return {str(finest): rms for finest, rms in subject.published.rms_by_finest.items()}


def _percent(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f} %"


def _megabytes(size: float) -> str:
    return f"{size / 1e6:.1f} MB" if size else "–"


def _table(head: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    rows = [head, ["---"] * len(head), *lines]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)
