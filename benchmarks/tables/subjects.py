"""The scenes of the tables."""

import hashlib
from dataclasses import dataclass
from pathlib import Path

from benchmarks.tables.paper import CORNELL_BOX, SIBENIK, TABLE, Goal, Published

_ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Subject:
    """A scene, and the one of the paper that it stands beside."""

    name: str
    blend: str
    """Path of the file, seen from the repository."""
    published: Published
    goal: Goal
    is_stand_in: bool = False
    """The paper rendered another building."""

    @property
    def path(self) -> Path:
        """Of the file."""
        return _ROOT / self.blend

    def digest(self) -> str:
        """Of the file's content."""
        return hashlib.sha256(self.path.read_bytes()).hexdigest()


_CHURCH_GOAL = Goal(speedup=40.0, rms_paper=0.3, bytes=40e6)
SUBJECTS = (
    Subject("cornell_box", "scenes/cornell_box.blend", CORNELL_BOX, Goal(100.0, 0.5, 40e6)),
    Subject("table", "scenes/table.blend", TABLE, Goal(60.0, 0.3, 50e6), is_stand_in=True),
    Subject("nave", "scenes/nave.blend", SIBENIK, _CHURCH_GOAL, is_stand_in=True),
    Subject("sibenik", "../shared/scenes/sibenik.blend", SIBENIK, _CHURCH_GOAL),
)
"""All that there may be; the last is not in the repository."""


def subjects() -> list[Subject]:
    """Those whose file is there."""
    return [subject for subject in SUBJECTS if subject.path.is_file()]
