"""What went wrong, in words for the artist: the problem log, and the outcome of the last render for the panels."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any


class UserError(Exception):
    """A render that cannot be made; the message is for the artist."""


@dataclass(frozen=True)
class Problem:
    """Something wrong with the file that does not stop the render."""

    subject: str
    """Name of the object, material, lamp ..."""
    message: str
    """What is wrong and what was done about it."""
    count: int
    """How often."""


class ProblemLog:
    """Problems of one render. The same message about the same subject is kept once and counted."""

    def __init__(self) -> None:
        self._counts: dict[tuple[str, str], int] = {}

    def add(self, subject: str, message: str, count: int = 1) -> None:
        key = (subject, message)
        self._counts[key] = self._counts.get(key, 0) + count

    def add_records(self, records: Iterable[Mapping[str, Any]]) -> None:
        """Adds the problems the core found: [{"subject", "message", "count"}]."""
        for record in records:
            self.add(record["subject"], record["message"], record["count"])

    @property
    def problems(self) -> list[Problem]:
        """In the order they were first met."""
        return [Problem(*key, count) for key, count in self._counts.items()]

    def summary(self) -> str:
        """One line for Blender's status bar; empty without problems."""
        problems = self.problems
        if not problems:
            return ""
        first = f"{problems[0].subject}: {problems[0].message}"
        if len(problems) == 1:
            return first
        return f"{len(problems)} problems, all in Render Properties > Problems. The first: {first}"


@dataclass(frozen=True)
class Outcome:
    """How a render ended."""

    problems: list[Problem] = field(default_factory=list)
    stats: dict[str, Any] = field(default_factory=dict)
    """The stats file's content; empty when the render failed before it had any."""
    error: str = ""
    """Why there is no picture; empty when there is one."""
    cancelled: bool = False


_last: Outcome | None = None


def publish(outcome: Outcome) -> None:
    """Makes `outcome` the one the panels show."""
    global _last
    _last = outcome


def last_outcome() -> Outcome | None:
    """Outcome of the last render in this process; None before the first."""
    return _last
