"""From values to places on an axis, and the values that are marked there."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

_STEPS = (1.0, 2.0, 5.0)
# A logarithmic axis over more decades than this is marked at powers of ten alone.
_DECADES_IN_STEPS = 2.5
_LEAST_TICKS = 3


@dataclass(frozen=True)
class Scale:
    """Values from `low` to `high` along an axis; on a logarithmic one both are positive."""

    low: float
    high: float
    is_log: bool

    def place(self, value: float) -> float:
        """0 at `low`, 1 at `high`."""
        low, high, at = self.low, self.high, value
        if self.is_log:
            low, high, at = math.log(low), math.log(high), math.log(at)
        return (at - low) / (high - low)

    def ticks(self) -> list[float]:
        """Round values within the axis, evenly spread."""
        return log_ticks(self.low, self.high) if self.is_log else linear_ticks(self.low, self.high)


def scale_of(values: Sequence[float], *, is_log: bool, margin: float = 0.06) -> Scale:
    """An axis that holds all values with some room; a linear one of positive values starts at 0."""
    low, high = min(values), max(values)
    if is_log:
        span = max(high / low, 2.0)
        room = span ** (0.5 + margin)
        middle = math.sqrt(low * high)
        return Scale(middle / room, middle * room, is_log=True)
    if low >= 0.0:
        return Scale(0.0, (high or 1.0) * (1.0 + margin), is_log=False)
    room = margin * ((high - low) or abs(low))
    return Scale(low - room, high + room, is_log=False)


def linear_ticks(low: float, high: float, count: int = 6) -> list[float]:
    """Multiples of 1, 2 or 5 times a power of ten: about `count`, within low and high."""
    wanted = (high - low) / count
    power = 10.0 ** math.floor(math.log10(wanted))
    step = next(power * s for s in (*_STEPS, 10.0) if power * s >= wanted * (1.0 - 1e-9))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [number * step for number in range(first, last + 1)]


def log_ticks(low: float, high: float) -> list[float]:
    """1, 2 and 5 times powers of ten; powers of ten alone where these would be many, others where they would be few."""
    steps = _STEPS if math.log10(high / low) <= _DECADES_IN_STEPS else (1.0,)
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    values = [step * 10.0**power for power in powers for step in steps]
    ticks = [value for value in values if low * (1.0 - 1e-9) <= value <= high * (1.0 + 1e-9)]
    return ticks if len(ticks) >= _LEAST_TICKS else linear_ticks(low, high)


def number_text(value: float) -> str:
    """Such as "0.05", "256", "20 k" or "4 M"."""
    for size, unit in ((1e9, " G"), (1e6, " M"), (1e4, " k")):
        if abs(value) >= size:
            return f"{value / (1e3 if size == 1e4 else size):.3g}{unit}"
    return f"{value:.4g}"
