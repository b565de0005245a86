"""The results as a page, from nothing but the document that is written to `tables.json`."""

from collections.abc import Iterator, Sequence
from typing import Any

from benchmarks.tables import paper
from benchmarks.tables.plan import PHOTON_MAP, PYRAMID, PYRAMID_2006
from benchmarks.tables.subjects import SUBJECTS, Subject
from benchmarks.tables.wording import compared, measured_with, one_line, weaknesses

Document = dict[str, Any]

_OURS = (PYRAMID, PYRAMID_2006)
_TIMES_HEAD = (
    *("method", "photons", "build", "gather", "all"),
    *("speed-up", "memory", "RMS against photon map", "RMS against truth", "without noise"),
)


def page(document: Document, *, has_notes: bool) -> str:
    """The whole page. `has_notes`: a page `notes.md`, written by hand, lies beside it."""
    subjects = [subject for subject in SUBJECTS if subject.name in document["table1"]]
    parts = [
        "# The paper's tables, with this engine's figures",
        *_introduction(document),
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


def _introduction(document: Document) -> Iterator[str]:
    yield one_line(f"""
        Written by `{document["commands"]["all"]}`. Every figure is in [tables.json](tables.json), with the
        command of its render. The paper is Yue, Iwasaki, Nishita, *Radiance Grid Pyramid*; its figures stand
        beside ours wherever it gives any.
    """)
    if document["settings"]["photon_share"] != 1.0:
        yield "**A quick run:** small pictures, few rays and few photons. It shows that all works, and no more."


def _verdicts(document: Document) -> Iterator[str]:
    columns = ("claim", "scene", "paper", "to_reach", "reached", "verdict")
    yield _table(
        ("claim", "scene", "paper", "to reach", "here", ""),
        [[verdict[column] for column in columns] for verdict in document["verdicts"]],
    )


def _errors(document: Document, subjects: Sequence[Subject], name: str, column: str) -> Iterator[str]:
    """One table and one plot per scene."""
    columns = [f"`{ours}` against {what}" for ours in _OURS for what in ("photon map", "truth")]
    kinds = [(ours, kind) for ours in _OURS for kind in ("rms_paper", "rms_truth")]
    for subject in subjects:
        rows = document[name][subject.name]
        values = [
            setting.removeprefix(f"{PYRAMID} ") for setting in rows if setting.startswith(f"{PYRAMID} ")
        ]
        lines = [
            [
                value.replace("x", " × ") if column == "bins" else f"{value}³",
                _percent(_published(subject, name).get(value)),
                *(_percent(rows[f"{ours} {value}"][kind]) for ours, kind in kinds),
            ]
            for value in values
        ]
        yield f"### {subject.name}"
        yield _table((column, f"paper, {subject.published.name}", *columns), lines)
        yield f"The photon map itself is {rows[PHOTON_MAP]['rms_truth']:.3f} % from the truth."
        yield f"![{name} of {subject.name} as a plot]({name}_{subject.name}.svg)"


def _times(document: Document, subjects: Sequence[Subject]) -> Iterator[str]:
    yield one_line("""
        *Gather* is the final gather alone, *all* adds the photon pass and building what the gather asks.
        *Speed-up* is the photon map's *all* over this one's.
    """)
    for subject in subjects:
        rows, parts = document["table3"][subject.name], document["details"][subject.name]["seconds"]
        lines = [_times_line(setting, row, parts[setting]) for setting, row in rows.items()]
        yield f"### {subject.name}"
        yield _table(_TIMES_HEAD, [*_published_times(subject), *lines])
        yield compared(document, subject)
        yield f"![Time against error in {subject.name}](table3_{subject.name}.svg)"


def _published_times(subject: Subject) -> Iterator[Sequence[str]]:
    paper_has = subject.published
    of_photon_map = ("photon map", paper_has.photon_map_seconds, paper_has.photon_map_bytes, None)
    rms = paper_has.rms_by_bins[paper.BINS]
    of_pyramid = ("pyramid", paper_has.pyramid_seconds, paper_has.pyramid_bytes, rms)
    for method, seconds, size, error in (of_photon_map, of_pyramid):
        speedup = f"{paper_has.photon_map_seconds / seconds:.1f}"
        name = f"paper, {paper_has.name}: {method}"
        yield (name, "", "", "", f"{seconds:,.1f} s", speedup, _megabytes(size), _percent(error), "", "")


def _times_line(setting: str, row: dict[str, Any], parts: dict[str, Any]) -> Sequence[str]:
    return (
        f"`{setting}`" + (" \\*" if parts["is_scaled"] else ""),
        *(f"{parts[part]:.1f} s" for part in ("photon_pass", "build", "gather")),
        f"{row['seconds']:.1f} s",
        f"{row['speedup']:.1f}",
        _megabytes(row["bytes"]),
        _percent(row["rms_paper"]),
        _percent(row["rms_truth"]),
        _percent(row["rms_systematic"]),
    )


def _pictures(subjects: Sequence[Subject]) -> Iterator[str]:
    yield one_line("""
        The indirect light that `pyramid` and `photon_map` give in table 3, shrunk, and the difference of the two:
        red where the pyramid is brighter, blue where it is darker, in percent of the photon map's brightest
        pixel.
    """)
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
