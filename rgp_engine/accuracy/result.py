"""What a sweep found: in memory, as a file, as text."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..files import whole_file
from .front import TARGETS, Row, cheapest, pareto_front
from .quality import Quality

FILE = "accuracy.json"


@dataclass
class Sweep:
    """A sweep, done or under way."""

    scene: str
    resolution: tuple[int, int]
    """Of the whole picture."""
    window: tuple[int, int, int, int]
    """Rendered part: x and y of the lower left corner, width, height."""
    current: Quality
    """The settings of the file."""
    is_glossy: bool
    """There are glossy cells: bins count."""
    threads: int
    versions: Mapping[str, str]
    reference: dict[str, Any] = field(default_factory=dict)
    """How it was made, its `seconds` and its `noise` in percent; empty until it is."""
    rows: list[Row] = field(default_factory=list)
    state: str = "reference"
    """What is under way: "reference", "sweep"; or how it ended: "done", "stopped"."""
    message: str = ""
    """What is done, in a few words."""
    runs_total: int = 0
    """Runs done and planned so far."""
    seconds_spent: float = 0.0
    seconds_left: float = 0.0
    """About."""

    @property
    def fraction(self) -> float:
        """Done of all, from 0 to 1."""
        return self.seconds_spent / max(self.seconds_spent + self.seconds_left, 1e-6)

    @property
    def front(self) -> list[Row]:
        """The rows worth their time, fastest first."""
        return pareto_front(self.rows)

    def write(self, folder: Path) -> None:
        """Writes the file, whole at every moment. Raises OSError."""
        with whole_file(folder / FILE) as part:
            part.write_text(json.dumps(self._content(), indent=2) + "\n")

    @classmethod
    def read(cls, folder: Path) -> "Sweep":
        """Reads the file. Raises OSError, ValueError."""
        content = json.loads((folder / FILE).read_text())
        progress = content["progress"]
        return cls(
            scene=content["scene"],
            resolution=tuple(content["resolution"]),
            window=tuple(content["window"]),
            current=Quality.from_settings(content["current"]),
            is_glossy=content["is_glossy"],
            threads=content["threads"],
            versions=content["versions"],
            reference=content["reference"],
            rows=[_row(row) for row in content["rows"]],
            state=progress["state"],
            message=progress["message"],
            runs_total=progress["runs_total"],
            seconds_spent=progress["seconds_spent"],
            seconds_left=progress["seconds_left"],
        )

    def _content(self) -> dict[str, Any]:
        return {
            "scene": self.scene,
            "resolution": self.resolution,
            "window": self.window,
            "threads": self.threads,
            "versions": self.versions,
            "is_glossy": self.is_glossy,
            "current": self.current.settings(),
            "progress": {
                "state": self.state,
                "runs_done": len(self.rows),
                "runs_total": self.runs_total,
                "message": self.message,
                "seconds_spent": round(self.seconds_spent, 1),
                "seconds_left": round(self.seconds_left, 1),
            },
            "reference": self.reference,
            "rows": [_record(row) for row in self.rows],
            "front": [_record(row) for row in self.front],
            "cheapest": {f"{target:g}": self._cheapest(target) for target in TARGETS},
        }

    def _cheapest(self, target: float) -> dict[str, Any] | str:
        row = cheapest(self.rows, target)
        return _record(row) if row else self.not_reached()

    def not_reached(self) -> str:
        """Why no row has an error as small as was asked for."""
        best = min(self.rows, key=lambda row: row.error, default=None)
        if best is None:
            return "not reached: nothing was measured"
        if best.is_limit:
            return f"not reached: the reference tells no error below {best.error:.2g} %"
        return f"not reached: the best of {len(self.rows)} settings has {best.error:.2g} %"


def _record(row: Row) -> dict[str, Any]:
    return {
        "settings": row.quality.settings(),
        "seconds": row.seconds,
        "error": row.error,
        "is_limit": row.is_limit,
        "bytes": row.bytes,
    }


def _row(record: Mapping[str, Any]) -> Row:
    quality = Quality.from_settings(record["settings"])
    return Row(quality, **{name: value for name, value in record.items() if name != "settings"})
