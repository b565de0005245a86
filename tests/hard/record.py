"""What the hard cases found, kept for the page that shows it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any


@dataclass
class Row:
    """One case and one property of it."""

    expected: float
    got: float
    bound: float
    """Largest deviation allowed, relative to what is expected, absolute where that is 0."""
    edge: str = ""
    """What breaks first when the case is pushed further, where it has a dial."""

    @property
    def deviation(self) -> float:
        difference = abs(self.got - self.expected)
        return difference / abs(self.expected) if self.expected else difference

    @property
    def passed(self) -> bool:
        return math.isfinite(self.got) and self.deviation <= self.bound

    def share(self, deviation: float) -> str:
        """A relative deviation in percent, an absolute one as it is."""
        return f"{100.0 * deviation:.3g} %" if self.expected else f"{deviation:.3g}"

    def as_json(self) -> dict[str, Any]:
        return {**asdict(self), "deviation": self.deviation, "pass": self.passed}


@dataclass
class Record:
    """Rows by group and case. With `thorough`, edges are looked for too."""

    thorough: bool = False
    groups: dict[str, dict[str, Row]] = field(default_factory=dict)

    def check(self, group: str, case: str, *, expected: float, got: float, bound: float) -> None:
        """Keeps the row and fails where the deviation is over the bound."""
        row = self.groups.setdefault(group, {})[case] = Row(float(expected), float(got), bound)
        assert row.passed, (
            f"{case}: {row.got:.9g} for {row.expected:.9g}, off by {row.deviation:.3g} > {bound:g}"
        )

    def edge(
        self,
        group: str,
        case: str,
        dial: Sequence[float],
        deviation: Callable[[float], float],
        *,
        unit: str,
        holds: float | None = None,
    ) -> None:
        """Turns a dial until the case's deviation is over its bound (or over `holds`), and says where that was."""
        if not self.thorough:
            return
        row = self.groups[group][case]
        bound = row.bound if holds is None else holds
        good = ""
        for value in dial:
            try:
                found = deviation(value)
                fault = "" if found <= bound else f"off by {row.share(found)}"
            except Exception as error:  # noqa: BLE001 (a refusal is an edge too)
                fault = f"refused: {error}"
            if fault:
                row.edge = f"holds to {good or 'none of the dial'}; at {value:g}{unit} {fault}"
                return
            good = f"{value:g}{unit}"
        row.edge = f"holds to {good}, the end of the dial"
