"""How long renders will take, learned from those that are done."""

from collections import defaultdict
from collections.abc import Iterable

from benchmarks.tables.job import Job

# Of two threads, for a gather ray and for a photon with its place in the structure: a guess to begin with.
_MICROSECONDS_PER_RAY = {
    "pyramid": 0.6,
    "pyramid_2006": 0.7,
    "photon_map": 2.9,
    "precomputed_irradiance": 0.9,
    "uniform_grid": 0.5,
    "reverse_photon_map": 2.1,
    "path": 2.0,
}
_MICROSECONDS_PER_PHOTON = {
    "pyramid": 0.8,
    "pyramid_2006": 1.7,
    "photon_map": 0.9,
    "precomputed_irradiance": 1.7,
    "uniform_grid": 0.8,
    "reverse_photon_map": 1.1,
    "path": 0.0,
}
_OVERHEAD_SECONDS = 0.1

# Renders guessed to be shorter, such as some pilots, tell what it takes to begin one rather than what rays take.
_LEAST_SECONDS = 0.5


def guess(job: Job) -> float:
    """Seconds of a render, before anything is known about scene and machine."""
    rays = job.total_rays * _MICROSECONDS_PER_RAY[job.estimator]
    photons = job.photons * _MICROSECONDS_PER_PHOTON[job.estimator]
    return _OVERHEAD_SECONDS + (rays + photons) * 1e-6


class Forecast:
    """Corrects the guesses by what renders like them have taken."""

    def __init__(self) -> None:
        self._taken: dict[tuple[str, ...], float] = defaultdict(float)
        self._guessed: dict[tuple[str, ...], float] = defaultdict(float)

    def learn(self, job: Job, seconds: float) -> None:
        """A render has taken that long."""
        if guess(job) < _LEAST_SECONDS:
            return
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
    """Renders like this one, the most similar first; in other scenes rays may cost thrice as much."""
    return [(job.scene, job.estimator), (job.scene,)]
