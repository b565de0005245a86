"""The table of hard cases, as JSON for programs and as a page for readers."""

from __future__ import annotations

import json
from pathlib import Path

from tests.hard.record import Record, Row

_HEAD = """\
# Where the engine holds, and where it stops

Every row is a test: a scene whose answer is known beforehand, or a change that must not change the picture. `make hard`
runs them all and writes this page and [stability.json](stability.json). The deviation is relative to what is expected,
absolute where that is 0; a row passes when the deviation is at most the bound.
"""
_EDGES = """\
## What breaks first

The dial of a case is turned until its bound no longer holds, so that you know how far from the edge your scene is.
"""


def write(record: Record, folder: Path) -> None:
    """Writes stability.json and stability.md."""
    rows = {case: row.as_json() for cases in record.groups.values() for case, row in cases.items()}
    (folder / "stability.json").write_text(json.dumps(rows, indent=2, sort_keys=True) + "\n")
    (folder / "stability.md").write_text(_page(record))


def _page(record: Record) -> str:
    rows = [row for cases in record.groups.values() for row in cases.values()]
    parts = [_HEAD, f"{sum(row.passed for row in rows)} of {len(rows)} rows pass.\n"]
    for group, cases in sorted(record.groups.items()):
        lines = [
            f"## {group}\n",
            "| case | expected | got | deviation | bound |",
            "| --- | --: | --: | --: | --: |",
        ]
        lines += [_line(case, row) for case, row in cases.items()]
        parts.append("\n".join(lines) + "\n")
    edges = [(case, row.edge) for cases in record.groups.values() for case, row in cases.items() if row.edge]
    if edges:
        lines = [
            "| case | edge |",
            "| --- | --- |",
            *(f"| {case} | {edge} |" for case, edge in sorted(edges)),
        ]
        parts.append(_EDGES + "\n" + "\n".join(lines) + "\n")
    return "\n".join(parts)


def _line(case: str, row: Row) -> str:
    mark = "" if row.passed else " **fails**"
    return (
        f"| {case}{mark} | {row.expected:.6g} | {row.got:.6g} | {row.share(row.deviation)} | "
        f"{row.share(row.bound)} |"
    )
