"""Measured figures, what is asked of them, and how both are told."""

import os
import platform
import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Figure:
    """Repetitions of one measurement."""

    values: Sequence[float]

    @property
    def median(self) -> float:
        return statistics.median(self.values)


@dataclass(frozen=True)
class Target:
    """What the median of a figure may be at most."""

    at_most: float
    unit: str = ""


@dataclass(frozen=True)
class Row:
    """One figure of one subject (a scene, a kind of mesh)."""

    name: str
    subject: str
    figure: Figure
    target: Target | None

    @property
    def is_met(self) -> bool | None:
        """None where nothing is asked."""
        return None if self.target is None else self.figure.median <= self.target.at_most


def table(rows: Sequence[Row]) -> str:
    """The rows for the terminal."""
    lines = [("figure", "subject", "median", "min", "max", "target", "")]
    for row in rows:
        values = row.figure.values
        verdict = {None: "", True: "met", False: "MISSED"}[row.is_met]
        at_most = f"≤ {_number(row.target.at_most)} {row.target.unit}".rstrip() if row.target else ""
        numbers = (_number(row.figure.median), _number(min(values)), _number(max(values)))
        lines.append((row.name, row.subject, *numbers, at_most, verdict))
    widths = [max(len(line[column]) for line in lines) for column in range(len(lines[0]))]
    left_aligned = (0, 1, 6)
    return "\n".join(
        "  ".join(
            cell.ljust(width) if column in left_aligned else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(line, widths))
        ).rstrip()
        for line in lines
    )


def details(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """The rows with every repetition, for the file."""
    return [
        {
            "name": row.name,
            "subject": row.subject,
            "median": row.figure.median,
            "min": min(row.figure.values),
            "max": max(row.figure.values),
            "values": list(row.figure.values),
            "target_at_most": row.target.at_most if row.target else None,
            "met": row.is_met,
        }
        for row in rows
    ]


def machine() -> dict[str, Any]:
    """What the figures were measured on; the load tells whether it had other work."""
    cpu = Path("/proc/cpuinfo")
    models = [
        line.partition(":")[2].strip()
        for line in (cpu.read_text().splitlines() if cpu.is_file() else ())
        if line.startswith("model name")
    ]
    return {
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "processor": models[0] if models else platform.processor(),
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
    }


def _number(value: float) -> str:
    return f"{value:,.0f}" if value >= 1000 else f"{value:.3g}"
