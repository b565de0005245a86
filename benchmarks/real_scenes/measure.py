"""Renders one scene with both engines, each with two seeds, so that the noise of each is known."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rgp_engine.accuracy.error import CLIPPED_AT
from rgp_engine.cli import blender_scene, exr
from rgp_engine.cli.assign import assign
from rgp_engine.cli.exr import Picture
from rgp_engine.report import Problem, last_outcome

SEEDS = (1, 2)
BOUNCES = 64
"""Of every kind, in Cycles: as many as our engine follows."""

_BOUNCES = ("max_", "diffuse_", "glossy_", "transmission_", "transparent_max_")


@dataclass(frozen=True)
class Renders:
    """Two pictures of one engine that differ in their seed alone, (height, width, 3) each."""

    pictures: tuple[Picture, Picture]
    seconds: float
    """Of the processor, all threads together, for one picture; the export is part of it."""
    problems: Sequence[Problem] = ()
    """What the engine told the user."""

    @property
    def mean(self) -> Picture:
        """Of both pictures."""
        return np.asarray(np.mean(self.pictures, axis=0, dtype=np.float64))


@dataclass(frozen=True)
class Comparison:
    """Both engines' pictures of a scene.

    Errors are RMS, parts of the mean of Cycles' picture, both clipped at eight times that mean, so that no single
    pixel decides.
    """

    ours: Renders
    theirs: Renders

    @property
    def mean_ratio(self) -> list[float]:
        """Mean of our picture over mean of theirs, of red, green and blue."""
        ratio = self.ours.mean.mean(axis=(0, 1)) / self.theirs.mean.mean(axis=(0, 1))
        return [float(channel) for channel in ratio]

    def noise(self, renders: Renders) -> float:
        """Of one picture of one engine."""
        first, second = self._clipped(renders)
        return float(np.sqrt(((first - second) ** 2).mean() / 2.0) / self._scale)

    @property
    def beyond_noise(self) -> float:
        """How far the engines differ, without the noise of either.

        The product of two differences that share no picture has the squared difference as its expectation.
        """
        (a, b), (c, d) = self._clipped(self.ours), self._clipped(self.theirs)
        squared = (((a - c) * (b - d)).mean() + ((a - d) * (b - c)).mean()) / 2.0
        return float(np.sqrt(max(squared, 0.0)) / self._scale)

    @property
    def seconds_at_our_noise(self) -> float:
        """Processor seconds that Cycles would need for our noise, as noise falls with the root of time."""
        return self.theirs.seconds * (self.noise(self.theirs) / self.noise(self.ours)) ** 2

    @property
    def _scale(self) -> float:
        return float(self.theirs.mean.mean())

    def _clipped(self, renders: Renders) -> list[Picture]:
        highest = CLIPPED_AT * self._scale
        return [np.minimum(picture, highest).astype(np.float64) for picture in renders.pictures]


def measure(
    open_scene: Callable[[], Any], width: int, samples: int, assignments: Sequence[str]
) -> Comparison:
    """Renders a scene `width` pixels wide with both engines: ours as it would be rendered by anyone, with
    `assignments` to its settings, Cycles with `samples` per pixel and nothing left out or smoothed."""
    return Comparison(
        _render(open_scene(), width, "RGP", "render.seed", assignments),
        _render(open_scene(), width, "CYCLES", "cycles.seed", _cycles_settings(samples)),
    )


def _cycles_settings(samples: int) -> list[str]:
    return [f"cycles.samples={samples}", *(f"cycles.{kind}bounces={BOUNCES}" for kind in _BOUNCES)]


def _render(b_scene: Any, width: int, engine: str, seed: str, assignments: Sequence[str]) -> Renders:
    """Two pictures of a scene by one engine."""
    blender_scene.choose_engine(b_scene, engine)
    blender_scene.keep_one_layer(b_scene)
    height = round(width * b_scene.render.resolution_y / b_scene.render.resolution_x)
    b_scene.render.resolution_x, b_scene.render.resolution_y = width, height
    b_scene.render.resolution_percentage = 100
    pictures, seconds = [], []
    for assignment in assignments:
        assign(b_scene, assignment)
    for value in SEEDS:
        assign(b_scene, f"{seed}={value}")
        start = time.process_time()
        pictures.append(_picture(b_scene))
        seconds.append(time.process_time() - start)
    outcome = last_outcome() if engine == "RGP" else None
    return Renders((pictures[0], pictures[1]), min(seconds), outcome.problems if outcome else ())


def _picture(b_scene: Any) -> Picture:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "passes.exr"
        blender_scene.render_to(b_scene, path)
        return exr.read(path)
