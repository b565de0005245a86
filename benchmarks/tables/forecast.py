"""How long renders will take, learned from those that are done."""

from collections import defaultdict
from collections.abc import Iterable

from benchmarks.tables.job import Job

# Of two threads: a guess to begin with, of which the ratios matter.
_PHOTONS_PER_SECOND = 1e6
_MICROSECONDS_PER_RAY = {
    "pyramid": 0.4,
    "pyramid_2006": 0.8,
    "photon_map": 3.0,
    "precomputed_irradiance": 1.0,
    "uniform_grid": 0.6,
    "reverse_photon_map": 2.0,
    "path": 1.5,
}
_OVERHEAD_SECONDS = 0.1


def guess(job: Job) -> float:
    """Seconds of a render, before anything is known about scene and machine."""
    gather = job.total_rays * _MICROSECONDS_PER_RAY[job.estimator] * 1e-6
    return _OVERHEAD_SECONDS + job.photons / _PHOTONS_PER_SECOND + gather


class Forecast:
    """Corrects the guesses by what renders like them have taken."""

    def __init__(self) -> None:
        self._taken: dict[tuple[str, ...], float] = defaultdict(float)
        self._guessed: dict[tuple[str, ...], float] = defaultdict(float)

    def learn(self, job: Job, seconds: float) -> None:
        """A render has taken that long."""
        for kind in _kinds(job):
            self._taken[kind] += seconds
            self._guessed[kind] += guess(job)

    def seconds(self, jobs: Iterable[Job]) -> float:
        """What these will take."""
        return sum(guess(job) * self._correction(job) for job in jobs)

    def _correction(self, job: Job) -> float:
        known = [kind for kind in _kinds(job) if self._guessed[kind] > 0.0]
        return self._taken[known[0]] / self._guessed[known[0]] if known else 1.0


def _kinds(job: Job) -> list[tuple[str, ...]]:
    """Renders like this one, the most similar first."""
    return [(job.scene, job.estimator), (job.scene,), ()]
