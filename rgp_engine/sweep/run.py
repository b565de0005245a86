"""The order of a sweep: where to look, the reference, round after round of settings."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import isqrt, sqrt
from pathlib import Path
from typing import Any

import bpy

from .. import native
from ..accuracy.error import Means, Reference, measured_error
from ..accuracy.figure import write_figure
from ..accuracy.front import Row
from ..accuracy.model import Costs, Model
from ..accuracy.plan import first_round, next_round, within
from ..accuracy.quality import Quality
from ..accuracy.result import Sweep
from ..accuracy.text import describe
from ..accuracy.window import Window, representative_window
from ..report import UserError
from .reference import ReferenceMaker
from .shot import render
from .taken_scene import Border, TakenScene, border_of, take_scene

Report = Callable[[Sweep], None]
"""Is told about every step."""

# Pixels of the window: so many to the square.
_WINDOW, _QUICK_WINDOW = 128, 96
# Rounds after the first. Seconds of each at most, and of the first as a guess, as a part of the reference's.
_ROUNDS, _QUICK_ROUNDS = 2, 1
_ROUND_SHARE = 0.4
_FIRST_ROUND_SHARE = 0.6
# Tiles for each thread, so that none is idle for long.
_TILES_PER_THREAD = 4
_SMALLEST_TILE = 8
# Enough samples to see where errors are; fewer where pixels are many.
_PILOT_PHOTONS = 100_000
_PILOT_SAMPLES = 4
_PILOT_RAYS_PER_SAMPLE = 4
_PILOT_PIXELS = 1_000_000
# Seeds of the pilot and of the reference, from that of the scene.
_PILOT_SEED, _REFERENCE_SEED, _SEEDS = 7_001, 9_001, 2**31


@dataclass(frozen=True)
class Request:
    """What the user asks of a sweep."""

    reference_seconds: float
    is_quick: bool
    crop: tuple[int, int] | float | None
    """Size of the window in pixels, or as a share of each side of the picture; None for the usual."""


def measure(b_scene: Any, request: Request, folder: Path, report: Report) -> Sweep:
    """Sweeps around the settings of the scene and writes into the folder whatever is known, run by run.

    An interrupt ends it with what there is. Raises UserError, OSError, and what the core raises.
    """
    border = border_of(b_scene)
    whole = take_scene(b_scene, border)
    resolution, window, means = _look(whole, request)
    is_whole = (window.width, window.height) == resolution
    taken = whole if is_whole else take_scene(b_scene, _border_part(border, window, resolution))
    sweep = Sweep(
        scene=Path(bpy.data.filepath).stem,
        resolution=resolution,
        window=(window.x, window.y, window.width, window.height),
        current=Quality.of(whole.settings),
        is_glossy=False,
        threads=_threads(whole),
        versions={**native.versions(), "blender": bpy.app.version_string},
    )
    run = _Run(sweep, taken, whole.seconds, request, folder, report)
    try:
        run.go(means)
        sweep.state = "done"
    except KeyboardInterrupt:
        sweep.state = "stopped"
    run.save()
    return sweep


def _look(whole: TakenScene, request: Request) -> tuple[tuple[int, int], Window, Means]:
    """Size of the picture, the window, and the means of the picture."""
    settings, seed = whole.settings, whole.settings["render"]["seed"] + _PILOT_SEED
    rays = Quality.of(settings)
    pilot = replace(rays, photons=_PILOT_PHOTONS, rays=_PILOT_RAYS_PER_SAMPLE, samples=1)
    first = render(whole, pilot.put_into(settings), seed % _SEEDS).picture
    height, width = first.shape[:2]
    if width * height <= _PILOT_PIXELS:
        pilot = replace(pilot, rays=_PILOT_RAYS_PER_SAMPLE * _PILOT_SAMPLES, samples=_PILOT_SAMPLES)
        first = render(whole, pilot.put_into(settings), seed % _SEEDS).picture
    second = render(whole, pilot.put_into(settings), (seed + 1) % _SEEDS).picture
    means = Means.of((first + second) / 2.0)
    if means.mean <= 0.0:
        raise UserError("The picture is black: errors relative to it mean nothing")
    size = _window_size((width, height), request)
    window = representative_window(means.clip(first), means.clip(second), size)
    return (width, height), window, means


def _window_size(resolution: tuple[int, int], request: Request) -> tuple[int, int]:
    width, height = resolution
    if isinstance(request.crop, tuple):
        return request.crop
    if request.crop is not None:
        return max(round(width * request.crop), 1), max(round(height * request.crop), 1)
    pixels = _QUICK_WINDOW if request.is_quick else _WINDOW
    return round(pixels * sqrt(width / height)), round(pixels * sqrt(height / width))


def _border_part(border: Border, window: Window, resolution: tuple[int, int]) -> Border:
    """The border around a window of what the border shows. A hair inside the pixels, which Blender rounds down."""
    left, right, bottom, top = border
    width, height = resolution
    x = [left + (right - left) * (edge + 0.01) / width for edge in (window.x, window.x + window.width)]
    y = [bottom + (top - bottom) * (edge + 0.01) / height for edge in (window.y, window.y + window.height)]
    return (x[0], min(x[1], 1.0), y[0], min(y[1], 1.0))


def _threads(taken: TakenScene) -> int:
    return int(taken.settings["render"]["threads"]) or os.cpu_count() or 1


class _Run:
    """A sweep under way."""

    def __init__(
        self,
        sweep: Sweep,
        taken: TakenScene,
        export_seconds: float,
        request: Request,
        folder: Path,
        report: Report,
    ) -> None:
        self._sweep = sweep
        self._taken = taken
        self._export_seconds = export_seconds
        self._request = request
        self._folder = folder
        self._report = report
        self._costs: list[Costs] = []
        self._began = time.monotonic()
        pixels = sweep.window[2] * sweep.window[3]
        self._ratio = sweep.resolution[0] * sweep.resolution[1] / pixels
        tile = max(isqrt(pixels // (_TILES_PER_THREAD * sweep.threads)), _SMALLEST_TILE)
        film = taken.settings["film"]
        # Every run does all that its settings ask for.
        gather = {**taken.settings["gather"], "time_limit": 0.0, "error_target": 0.0}
        film = {**film, "tile_size": min(tile, film["tile_size"])}
        self._settings = {**taken.settings, "gather": gather, "film": film}
        self._seed = int(taken.settings["render"]["seed"])

    def go(self, means: Means) -> None:
        """The reference, then the rounds."""
        rounds = _QUICK_ROUNDS if self._request.is_quick else _ROUNDS
        seconds = self._request.reference_seconds
        reference = self._make_reference(means, (_FIRST_ROUND_SHARE + rounds * _ROUND_SHARE) * seconds)
        self._sweep.state = "sweep"
        is_quick, base = self._request.is_quick, self._sweep.current
        later = rounds * _ROUND_SHARE * seconds
        self._measure([base], reference, 0.0, later + _FIRST_ROUND_SHARE * seconds)
        first = first_round(base, is_glossy=self._sweep.is_glossy, is_quick=is_quick)[1:]
        self._measure(first, reference, sum(map(self._model().run_seconds, first)), later)
        for number in range(rounds):
            model = self._model()
            measured = [row.quality for row in self._sweep.rows]
            wanted = next_round(model, base, measured, is_quick=is_quick)
            chosen = within(model, wanted, _ROUND_SHARE * seconds)
            later = (rounds - number - 1) * _ROUND_SHARE * seconds
            self._measure(chosen, reference, sum(map(model.run_seconds, chosen)), later)

    def save(self) -> None:
        """Writes what there is."""
        self._sweep.write(self._folder)
        if self._sweep.rows:
            write_figure(self._sweep, self._folder)

    def _make_reference(self, means: Means, later: float) -> Reference:
        seconds = self._request.reference_seconds
        maker = ReferenceMaker(self._taken, self._settings, self._seed + _REFERENCE_SEED)
        self._tell("making the reference", seconds + later)
        for _ in maker.parts_within(seconds):
            reference = maker.reference(means)
            self._sweep.reference = maker.description(reference)
            self._tell(f"reference: {reference.noise:.2g} % noise", max(seconds - maker.seconds, 0.0) + later)
        return reference

    def _measure(self, qualities: list[Quality], reference: Reference, expected: float, later: float) -> None:
        """One row each. They should take `expected` seconds, and what follows them `later`."""
        done = len(self._sweep.rows)
        self._sweep.runs_total = done + len(qualities)
        began = time.monotonic()
        for number, quality in enumerate(qualities):
            # The expectation counts as one run, beside those that are measured.
            left = len(qualities) - number
            per_run = (expected / len(qualities) + time.monotonic() - began) / (number + 1)
            run = f"run {done + number + 1} of {self._sweep.runs_total}"
            self._tell(f"{run}: {describe(quality, is_glossy=self._sweep.is_glossy)}", per_run * left + later)
            self._row(quality, reference)

    def _row(self, quality: Quality, reference: Reference) -> None:
        shot = render(self._taken, quality.put_into(self._settings), self._seed)
        error = measured_error(shot.picture, reference)
        seconds = shot.stats["seconds"]
        rest = self._export_seconds + seconds["total"] - seconds["photon_pass"] - seconds["gather"]
        costs = Costs(seconds["photon_pass"], seconds["gather"], rest)
        self._costs.append(costs)
        self._sweep.is_glossy |= shot.stats["pyramid"]["glossy_cells"] > 0
        row = Row(
            quality,
            seconds=costs.photon_pass + costs.gather * self._ratio + costs.rest,
            error=error.percent,
            is_limit=error.is_limit,
            bytes=shot.stats["pyramid"]["bytes"],
        )
        self._sweep.rows.append(row)
        self._sweep.write(self._folder)

    def _model(self) -> Model:
        return Model(self._sweep.rows, self._costs, self._ratio)

    def _tell(self, message: str, seconds_left: float) -> None:
        self._sweep.message = message
        self._sweep.seconds_spent = time.monotonic() - self._began
        self._sweep.seconds_left = seconds_left
        self._sweep.write(self._folder)
        self._report(self._sweep)
