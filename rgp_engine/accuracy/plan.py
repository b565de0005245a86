"""Which settings the sweep measures."""

from collections.abc import Iterable, Sequence

from .model import Model
from .quality import Quality

# First what every setting alone contributes: the others are kept so good that they hide nothing.
_RICH = {"rays": 4.0, "samples": 16.0}
_QUICK_RICH = {"rays": 2.0, "samples": 8.0}
_ALONE = {
    "rays": (1 / 16, 1 / 4),
    "samples": (1 / 64, 1 / 16, 1 / 4),
    "photons": (1 / 16, 1 / 4, 4.0),
    "finest": (1 / 4, 1 / 2, 2.0),
}
_QUICK_ALONE = {"rays": (1 / 16,), "samples": (1 / 16, 1 / 4), "photons": (1 / 16,), "finest": (1 / 2, 2.0)}
_BINS = (1 / 2, 2.0)

# Errors (%) for which the cheapest settings are looked for along the front.
_AIMS = (16.0, 8.0, 4.0, 2.83, 2.0, 1.41, 1.0, 0.71, 0.5, 0.35, 0.25)
_QUICK_AIMS = (8.0, 4.0, 2.0, 1.0, 0.5, 0.25)


def first_round(base: Quality, *, is_glossy: bool, is_quick: bool) -> list[Quality]:
    """The current settings, and each of them varied alone. Bins count where there are glossy cells."""
    rich = base
    for field, factor in (_QUICK_RICH if is_quick else _RICH).items():
        rich = rich.scaled(field, factor)
    varied = dict(_QUICK_ALONE if is_quick else _ALONE)
    if is_glossy:
        varied["bins"] = _BINS
    alone = [rich.scaled(field, factor) for field, factors in varied.items() for factor in factors]
    return list(dict.fromkeys([base, rich, *alone]))


def next_round(model: Model, base: Quality, measured: Iterable[Quality], *, is_quick: bool) -> list[Quality]:
    """For a row of errors the settings that should reach each of them soonest, cheapest first; none twice."""
    choices = model.choices(base)
    errors = model.errors(choices)
    by_time = sorted(zip((model.seconds(choice) for choice in choices), errors, choices), key=lambda c: c[0])
    found = []
    for aim in _QUICK_AIMS if is_quick else _AIMS:
        first = next((choice for _, error, choice in by_time if error <= aim), None)
        if first is not None:
            found.append(first)
    known = set(measured)
    return [quality for quality in dict.fromkeys(found) if quality not in known]


def within(model: Model, qualities: Sequence[Quality], seconds: float) -> list[Quality]:
    """The first of them that can be run in that time."""
    chosen = []
    for quality in qualities:
        seconds -= model.run_seconds(quality)
        if seconds < 0.0:
            break
        chosen.append(quality)
    return chosen
