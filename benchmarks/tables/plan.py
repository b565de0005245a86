"""Which renders the tables are made from."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from benchmarks.tables import paper
from benchmarks.tables.job import Job
from benchmarks.tables.store import Render
from benchmarks.tables.subjects import Subject

PHOTON_MAP, PYRAMID, PYRAMID_2006, PATH = "photon_map", "pyramid", "pyramid_2006", "path"
OTHERS = ("precomputed_irradiance", "uniform_grid", "reverse_photon_map")

# Any seeds but that of all other renders.
_TRUTH_SEEDS = (1001, 1002)
_TWIN_SEED = 1003
_LEAST_TRUTH_RAYS, _MOST_TRUTH_RAYS = 32, 4096
# Camera samples of the truth have so many gather rays each.
_RAYS_PER_TRUTH_SAMPLE = 4
_PILOT_PHOTONS, _PILOT_RAYS = 100_000, 16


@dataclass(frozen=True)
class Scale:
    """How thorough a run is."""

    timed_divisor: int
    """By which width and height of the paper's pictures are divided where time is measured."""
    divisor: int
    """The same where errors are measured."""
    rays: int
    """Gather rays per pixel, where the paper has 256."""
    many_rays: int
    """Gather rays per pixel where their noise is to be out of the way."""
    photon_share: float
    """Of the photons that give the paper's memory."""
    truth_seconds: float
    """For both halves of the truth of one scene together."""
    bins: tuple[str, ...]
    finest: tuple[int, ...]


FULL = Scale(
    timed_divisor=1,
    divisor=4,
    rays=paper.RAYS,
    many_rays=1024,
    photon_share=1.0,
    truth_seconds=90.0,
    bins=("2x4", "4x8", "8x16", "16x32"),
    finest=(16, 32, 64, 128, 256, 512),
)
"""Under an hour on two cores."""

QUICK = Scale(
    timed_divisor=4,
    divisor=8,
    rays=64,
    many_rays=256,
    photon_share=1 / 16,
    truth_seconds=5.0,
    bins=("2x4", "8x16"),
    finest=(32, 128, 256),
)
"""Under five minutes."""


@dataclass(frozen=True)
class Pilot:
    """Small renders that say how large the others have to be."""

    photons: Job
    """How many landings a photon makes."""
    path: Job
    """How long a path takes."""

    @classmethod
    def of(cls, subject: Subject, scale: Scale) -> "Pilot":
        """The pilot of a scene."""
        size = _size(subject, scale.divisor)
        one = Job(
            subject.name,
            size,
            PHOTON_MAP,
            rays=1,
            camera_samples=1,
            photons=_PILOT_PHOTONS,
            seed=_TRUTH_SEEDS[0],
        )
        samples = _PILOT_RAYS // _RAYS_PER_TRUTH_SAMPLE
        return cls(one, Job(subject.name, size, PATH, _PILOT_RAYS, samples, seed=_TRUTH_SEEDS[0]))


@dataclass(frozen=True)
class ScenePlan:
    """The renders of one scene."""

    subject: Subject
    tables: dict[str, dict[str, Job]]
    """By table and setting: pictures whose errors are measured."""
    references: dict[str, Job]
    """By number of rays as text: the photon map that pictures with as many rays are compared with."""
    timed: dict[str, Job]
    """By estimator: pictures as large as the paper's, whose time is measured."""
    truth: tuple[Job, Job]
    """Two independent halves."""
    twins: dict[Job, Job]
    """By picture of many rays: the same with other photons and rays, to tell errors from noise."""

    def jobs(self) -> Iterator[Job]:
        """Each render once; those of one size follow each other."""
        jobs = [job for table in self.tables.values() for job in table.values()]
        yield from dict.fromkeys([*self.truth, *jobs, *self.twins.values(), *self.timed.values()])

    def reference(self, job: Job) -> Job:
        """What a picture of the tables is compared with."""
        return self.references[str(job.rays)]


def scene_plan(subject: Subject, scale: Scale, photons: Render, path: Render) -> ScenePlan:
    """The renders of a scene, from what its pilot has found."""
    default = Job(
        subject.name,
        _size(subject, scale.divisor),
        PYRAMID,
        scale.rays,
        photons=_emitted(subject, scale, photons),
    )
    # What knows no finer cells is the same render in every table.
    equal = replace(default, adaptive=0)
    bases = {PYRAMID: default, PYRAMID_2006: replace(equal, estimator=PYRAMID_2006)}
    reference = replace(equal, estimator=PHOTON_MAP)
    table1 = {PHOTON_MAP: reference}
    table2 = {PHOTON_MAP: reference}
    for estimator, base in bases.items():
        for bins in scale.bins:
            table1[f"{estimator} {bins}"] = replace(base, bins=bins)
        for finest in scale.finest:
            table2[f"{estimator} {finest}"] = replace(base, finest=finest, adaptive=0)
    table3 = {PHOTON_MAP: reference, **bases, **{name: replace(equal, estimator=name) for name in OTHERS}}
    table3[PATH] = replace(equal, estimator=PATH, photons=0)
    many = {name: replace(table3[name], rays=scale.many_rays) for name in (PHOTON_MAP, PYRAMID)}
    table3 |= {many_rays_setting(name, scale.many_rays): job for name, job in many.items()}
    return ScenePlan(
        subject,
        {"table1": table1, "table2": table2, "table3": table3},
        {str(scale.rays): reference, str(scale.many_rays): many[PHOTON_MAP]},
        {
            name: replace(table3[name], size=_size(subject, scale.timed_divisor))
            for name in (PHOTON_MAP, PYRAMID)
        },
        _truth(subject, scale, path),
        {job: replace(job, seed=_TWIN_SEED) for job in many.values()},
    )


def many_rays_setting(estimator: str, rays: int) -> str:
    """Name in table 3 of a picture with so many gather rays per pixel."""
    return f"{estimator}, {rays} rays"


def _emitted(subject: Subject, scale: Scale, pilot: Render) -> int:
    """Photons whose landings take the paper's memory, at its bytes for each."""
    landings = subject.published.photon_map_bytes / paper.BYTES_PER_PHOTON
    counts = pilot.stats["photons"]
    per_photon = float(counts["deposited"] / counts["emitted"])
    return round(scale.photon_share * landings / per_photon)


def _truth(subject: Subject, scale: Scale, pilot: Render) -> tuple[Job, Job]:
    """As many rays as the time allows."""
    wanted = _PILOT_RAYS * scale.truth_seconds / len(_TRUTH_SEEDS) / pilot.gather_seconds
    rays = min(max(int(wanted), _LEAST_TRUTH_RAYS), _MOST_TRUTH_RAYS)
    samples = rays // _RAYS_PER_TRUTH_SAMPLE
    first, second = (
        Job(
            subject.name,
            _size(subject, scale.divisor),
            PATH,
            samples * _RAYS_PER_TRUTH_SAMPLE,
            samples,
            seed=seed,
        )
        for seed in _TRUTH_SEEDS
    )
    return first, second


def _size(subject: Subject, divisor: int) -> tuple[int, int]:
    width, height = subject.published.size
    return width // divisor, height // divisor
