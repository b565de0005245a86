"""Numbers and choices from the fuzzer's bytes, and the start of a fuzz program."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import TypeVar

import atheris

T = TypeVar("T")
SPECIAL = [0.0, 1.0, 0.5, -1.0, 2.0, -0.0, float("nan"), float("inf"), -float("inf"), 3e38, 1e-45, 1e-20, 1e6]


class Draw:
    """What is left of an input; past its end every choice is the first and every list empty."""

    def __init__(self, data: bytes) -> None:
        self._data = atheris.FuzzedDataProvider(data)

    def below(self, count: int) -> int:
        return int(self._data.ConsumeIntInRange(0, count - 1))

    def flag(self) -> bool:
        return self.below(2) == 1

    def choice(self, choices: Sequence[T]) -> T:
        return choices[self.below(len(choices))]

    def number(self) -> float:
        """Special, small, or any bits."""
        kind = self.below(4)
        if kind == 0:
            return self.choice(SPECIAL)
        return (self.below(4001) - 2000) / 100.0 if kind < 3 else float(self._data.ConsumeFloat())

    def whole(self) -> int:
        """Of one byte or of eight."""
        return int(self._data.ConsumeInt(self.choice([1, 8])))

    def text(self, most: int) -> str:
        return str(self._data.ConsumeUnicode(self.below(most + 1)))


def fuzz(try_one: Callable[[Draw], None]) -> None:
    """Gives inputs to `try_one` as libFuzzer's options on the command line say; what it raises is a finding."""
    atheris.Setup(sys.argv, lambda data: try_one(Draw(data)))
    atheris.Fuzz()
