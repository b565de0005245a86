"""Which of the measured settings are worth their time."""

from collections.abc import Sequence
from dataclasses import dataclass

from .quality import Quality

TARGETS = (2.0, 1.0, 0.5, 0.25)
"""Errors (%) for which the cheapest settings are named."""


@dataclass(frozen=True)
class Row:
    """Settings and what they give."""

    quality: Quality
    seconds: float
    """Predicted for the whole picture."""
    error: float
    """%; see `Error.percent`."""
    is_limit: bool
    """The reference cannot tell the error from a smaller one."""
    bytes: int
    """Memory of the pyramid."""


def pareto_front(rows: Sequence[Row]) -> list[Row]:
    """Rows that no other beats in time and error at once, fastest first. Of equals the first counts."""
    front: list[Row] = []
    for row in sorted(rows, key=lambda row: (row.seconds, row.error)):
        if not front or row.error < front[-1].error:
            front.append(row)
    return front


def cheapest(rows: Sequence[Row], target: float) -> Row | None:
    """The fastest row with that error (%) or less; None where no row has."""
    return min((row for row in rows if row.error <= target), key=lambda row: row.seconds, default=None)
