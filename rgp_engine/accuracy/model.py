"""Error and time of settings that have not been measured, from those that have.

The square of the error is a sum: the cells' size and their direction bins give a share each that no sampling removes,
and photons, gather rays and camera samples give one each that falls with a power of their number. So does time add up.
Shares and powers are fitted to what was measured.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
import numpy.typing as npt

from .front import Row
from .quality import Quality

_Floats = npt.NDArray[np.float64]

# Independent samples give 1; stratified ones more, up to 2 where what is sampled is an edge. Cells that hold few
# photons are read from their parents, which lowers the power of photons.
_POWERS = {"photons": (0.5, 0.75, 1.0), "rays": (0.75, 1.0, 1.25, 1.5), "samples": (1.0, 1.5, 2.0)}

# Doublings up and down from the current settings that may be proposed.
_DOUBLINGS = 7
_SWEEPS = 300


@dataclass(frozen=True)
class Costs:
    """Seconds that one run took, by what they depend on."""

    photon_pass: float
    gather: float
    """For the window."""
    rest: float
    """Export, tree and pyramid."""


class Model:
    """What was learned from runs over a window of the picture that is `1 / ratio` of its pixels."""

    def __init__(self, rows: Sequence[Row], costs: Sequence[Costs], ratio: float) -> None:
        qualities = [row.quality for row in rows]
        self._ratio = ratio
        self._finest = sorted({quality.finest for quality in qualities})
        self._bins = sorted({quality.bins for quality in qualities})
        self._fit_error(qualities, np.array([row.error**2 for row in rows], np.float64))
        self._fit_time(qualities, costs)

    def errors(self, qualities: Sequence[Quality]) -> _Floats:
        """Percent. Finest levels and bins must have been measured."""
        squares: _Floats = self._error_terms(qualities, self._powers) @ self._shares
        return np.sqrt(squares)

    def seconds(self, quality: Quality) -> float:
        """For the whole picture."""
        photon_pass, gather, rest = self._times(quality)
        return photon_pass + gather * self._ratio + rest

    def run_seconds(self, quality: Quality) -> float:
        """For the window."""
        return sum(self._times(quality))

    def _fit_error(self, qualities: Sequence[Quality], squares: _Floats) -> None:
        best = np.inf
        for powers in product(*_POWERS.values()):
            named = dict(zip(_POWERS, powers, strict=True))
            # Every row counts by its relative error: the best ones are as interesting as the worst.
            terms = self._error_terms(qualities, named) / squares[:, None]
            shares = nonnegative_fit(terms, np.ones(len(squares)))
            misfit = float(np.sum((terms @ shares - 1.0) ** 2))
            if misfit < best:
                best, self._powers, self._shares = misfit, named, shares

    def _error_terms(self, qualities: Sequence[Quality], powers: dict[str, float]) -> _Floats:
        columns: list[Callable[[Quality], float]] = [
            *(lambda q, finest=finest: float(q.finest == finest) for finest in self._finest),
            *(lambda q, bins=bins: float(q.bins == bins) for bins in self._bins[1:]),
            *(
                lambda q, name=name, power=power: float(getattr(q, name)) ** -power
                for name, power in powers.items()
            ),
        ]
        return np.array([[column(quality) for column in columns] for quality in qualities])

    def _fit_time(self, qualities: Sequence[Quality], costs: Sequence[Costs]) -> None:
        photons = np.array([[float(quality.photons)] for quality in qualities])
        gather = np.array([[quality.rays, quality.samples] for quality in qualities], np.float64)
        self._per_photon = nonnegative_fit(photons, np.array([cost.photon_pass for cost in costs]))
        self._per_sample = nonnegative_fit(gather, np.array([cost.gather for cost in costs]))
        rest = {(quality.finest, cost.rest) for quality, cost in zip(qualities, costs, strict=True)}
        self._rest = {f: float(np.median([r for g, r in rest if g == f])) for f in self._finest}

    def _times(self, quality: Quality) -> tuple[float, float, float]:
        photon_pass = quality.photons * self._per_photon[0]
        gather = np.array([quality.rays, quality.samples]) @ self._per_sample
        rest = self._rest.get(quality.finest, max(self._rest.values()))
        return float(photon_pass), float(gather), rest

    def choices(self, base: Quality) -> list[Quality]:
        """Settings that can be predicted: what was measured of finest level and bins, and doublings of the rest."""
        ranges = [
            sorted(
                {getattr(base.scaled(name, 2.0**step), name) for step in range(-_DOUBLINGS, _DOUBLINGS + 1)}
            )
            for name in _POWERS
        ]
        return [
            Quality(finest, bins, photons, rays, samples)
            for finest, bins, photons, rays, samples in product(self._finest, self._bins, *ranges)
        ]


def nonnegative_fit(matrix: _Floats, target: _Floats) -> _Floats:
    """Least squares with no negative unknown, one unknown after the other until nothing moves."""
    gram, right = matrix.T @ matrix, matrix.T @ target
    found = np.zeros(len(right))
    for _ in range(_SWEEPS):
        for i in np.flatnonzero(gram.diagonal() > 0.0):
            found[i] = max(found[i] + (right[i] - gram[i] @ found) / gram[i, i], 0.0)
    return found
