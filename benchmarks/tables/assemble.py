"""The figures of one scene, from its renders."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from benchmarks.tables import error, paper
from benchmarks.tables.job import Job
from benchmarks.tables.plan import PHOTON_MAP, PYRAMID, ScenePlan
from benchmarks.tables.store import Render
from rgp_engine.cli.compare import compare_pictures

Renders = Mapping[Job, Render]


@dataclass(frozen=True)
class Row:
    """One setting of a table; None where a figure does not apply."""

    rms_paper: float | None
    """Against the photon map with as many rays (%)."""
    rms_truth: float
    """Against the converged picture (%)."""
    seconds: float
    bytes: int
    speedup: float
    """Seconds of the photon map over those of this."""
    rms_systematic: float | None = None
    """Against the converged picture without the noise of photons and gather rays (%), where there are two pictures."""


class SceneFigures:
    """Rows of the tables, and what they were measured with."""

    def __init__(self, plan: ScenePlan, renders: Renders) -> None:
        self._plan = plan
        self._renders = renders
        self._table3 = plan.tables["table3"]
        self._truth = error.Truth(*(renders[job].indirect for job in plan.truth))
        self._timed, self._small = plan.timed[PYRAMID], self._table3[PYRAMID]
        self._pixels = (self._timed.size[0] * self._timed.size[1]) / (
            self._small.size[0] * self._small.size[1]
        )

    def tables(self) -> dict[str, dict[str, Row]]:
        """By table and setting. Tables 1 and 2 are of the small pictures, table 3 of those of the paper's size."""
        tables = {
            name: {setting: self._row(job) for setting, job in self._plan.tables[name].items()}
            for name in ("table1", "table2")
        }
        return {**tables, "table3": {setting: self._whole_row(setting) for setting in self._table3}}

    def details(self) -> dict[str, Any]:
        """Sizes, photons, the truth, and what the seconds of table 3 consist of."""
        unit = self._unit(self._small)
        photons = self._renders[self._plan.timed[PHOTON_MAP]].stats["photons"]
        return {
            "timed_size": list(self._timed.size),
            "size": list(self._small.size),
            "emitted": photons["emitted"],
            "deposited": photons["deposited"],
            "truth": {
                "rays": sum(job.rays for job in self._plan.truth),
                "seconds": sum(self._renders[job].seconds for job in self._plan.truth),
                "noise": self._truth.noise(unit),
                "resolves": self._truth.resolves(unit),
            },
            "doubts": self._doubts(),
            "pyramid_build_bytes": self._renders[self._timed].stats["pyramid"]["build_bytes"],
            "seconds": {setting: self._parts(setting) for setting in self._table3},
            "scaled_over_timed": {
                setting: self._scaled(self._table3[setting]) / self._renders[job].seconds
                for setting, job in self._plan.timed.items()
            },
        }

    def _row(self, job: Job) -> Row:
        reference = self._plan.reference(job)
        render, of_reference = self._renders[job], self._renders[reference]
        speedup = of_reference.seconds / render.seconds
        return Row(
            _rms_paper(render, of_reference), self._rms_truth(job), render.seconds, render.bytes, speedup
        )

    def _whole_row(self, setting: str) -> Row:
        job = self._table3[setting]
        reference = self._plan.reference(job)
        render, of_reference = self._renders[job], self._renders[reference]
        if setting in self._plan.timed:
            render, of_reference = (self._renders[self._plan.timed[name]] for name in (setting, PHOTON_MAP))
        name_of_reference = next(name for name, other in self._table3.items() if other == reference)
        seconds = self._seconds(setting)
        speedup = self._seconds(name_of_reference) / seconds
        rms_paper, rms_truth = _rms_paper(render, of_reference), self._rms_truth(job)
        return Row(rms_paper, rms_truth, seconds, render.bytes, speedup, self._rms_systematic(job))

    def _rms_truth(self, job: Job) -> float:
        return self._truth.rms(self._renders[job].indirect, self._unit(job))

    def _rms_systematic(self, job: Job) -> float | None:
        twin = self._plan.twins.get(job)
        if twin is None:
            return None
        return self._truth.systematic(*self._indirect(job, twin), self._unit(job))

    def _doubts(self) -> dict[str, float]:
        """How far squared errors have to differ to be told apart, see `error.Truth.doubt`."""
        one, other = (self._indirect(job, twin) for job, twin in self._plan.twins.items())
        grids = [self._plan.tables["table2"][f"{PYRAMID} {finest}"] for finest in (paper.FINEST, paper.FINER)]
        usual, finer = (self._indirect(job, job) for job in grids)
        unit = self._unit(self._small)
        return {
            "without_noise": self._truth.doubt(one, other, unit),
            "finer_grid": self._truth.doubt(usual, finer, unit),
        }

    def _indirect(self, one: Job, other: Job) -> error.Pair:
        return self._renders[one].indirect, self._renders[other].indirect

    def _unit(self, job: Job) -> float:
        return error.peak(self._renders[self._plan.reference(job)].indirect)

    def _seconds(self, setting: str) -> float:
        """Of a picture as large as the paper's."""
        timed = self._plan.timed.get(setting)
        return self._renders[timed].seconds if timed else self._scaled(self._table3[setting])

    def _scaled(self, job: Job) -> float:
        """The same from a smaller picture: the gather takes as much longer as there are more pixels."""
        render = self._renders[job]
        return render.preparing_seconds + render.gather_seconds * self._pixels

    def _parts(self, setting: str) -> dict[str, Any]:
        """Seconds of the passes of a picture as large as the paper's."""
        timed = self._plan.timed.get(setting)
        render = self._renders[timed or self._table3[setting]]
        return {
            "photon_pass": render.stats["seconds"]["photon_pass"],
            "build": render.stats["estimator"]["seconds"],
            "gather": render.gather_seconds * (1.0 if timed else self._pixels),
            "is_scaled": timed is None,
        }


def _rms_paper(render: Render, reference: Render) -> float | None:
    """None for the reference itself."""
    return None if render is reference else compare_pictures(render.indirect, reference.indirect).rms_peak
