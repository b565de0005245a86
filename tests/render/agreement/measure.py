"""Renders a scene with both engines, each with several seeds, so that the noise is known and not counted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np

from tests.render import pictures
from tests.render.pictures import Picture

LARGEST_MEAN_DIFFERENCE = 0.01
LARGEST_RMS = 0.03
SAMPLES = (32, 128, 512)
"""Per pixel and seed: the first that make the noise small enough, else the last."""
SEEDS = range(1, 7)
"""Several: neighboring pixels share where in the pixel and on the lamp their samples lie, so their noise is alike."""
SMALL_NOISE = 0.03
"""RMS of the noise of all seeds together, of the mean."""
SMALL_ERROR = 0.002
"""Standard error of the mean of all pixels, as a part of it."""
PHOTONS = 200_000
BOUNCES = 64
"""As many as Cycles has here: in bumped glass light goes back and forth."""


@dataclass(frozen=True)
class Renders:
    """Pictures of one engine that differ in their noise alone."""

    pictures: list[Picture]

    @property
    def mean(self) -> Picture:
        """Of all."""
        return np.asarray(np.mean(self.pictures, axis=0))

    @property
    def noise(self) -> float:
        """RMS noise of `mean`, as a part of its mean."""
        variance = np.var(self.pictures, axis=0, ddof=1).mean() / len(self.pictures)
        return float(np.sqrt(variance) / self.mean.mean())

    @property
    def error(self) -> float:
        """Standard error of the mean of all pixels, as a part of it."""
        means = [picture.mean() for picture in self.pictures]
        return float(np.std(means, ddof=1) / np.sqrt(len(means)) / self.mean.mean())


@dataclass(frozen=True)
class Agreement:
    """Pictures of both engines, and how they differ. All figures are parts of the mean of Cycles' picture."""

    ours: Renders
    theirs: Renders

    @property
    def mean_ratio(self) -> float:
        """Mean of our picture over mean of theirs."""
        return float(self.ours.mean.mean() / self.theirs.mean.mean())

    @property
    def mean_error(self) -> float:
        """Standard error of `mean_ratio`."""
        return float(np.hypot(self.ours.error, self.theirs.error))

    @property
    def rms_mean(self) -> float:
        """RMS difference of the pixels, noise included."""
        return float(np.sqrt(((self.ours.mean - self.theirs.mean) ** 2).mean()) / self.theirs.mean.mean())

    @property
    def noise(self) -> float:
        """What noise alone makes of `rms_mean`."""
        return float(np.hypot(self.ours.noise * self.mean_ratio, self.theirs.noise))

    @property
    def beyond_noise(self) -> float:
        """What is left of `rms_mean` without the noise."""
        return float(np.sqrt(max(self.rms_mean**2 - self.noise**2, 0.0)))

    @property
    def passes(self) -> bool:
        """Within both bounds."""
        is_as_bright = abs(self.mean_ratio - 1.0) <= LARGEST_MEAN_DIFFERENCE
        return is_as_bright and self.beyond_noise <= LARGEST_RMS


def measure(build: Callable[[], bpy.types.Scene], *, box_filter: bool = False) -> Agreement:
    """Renders the scene that `build` makes with both engines."""
    scene = build()
    ours = _quiet(scene, _render_ours, box_filter)
    theirs = _quiet(scene, _render_theirs, box_filter)
    return Agreement(ours, theirs)


def _quiet(
    scene: bpy.types.Scene, render: Callable[[bpy.types.Scene, int, int, bool], Picture], box_filter: bool
) -> Renders:
    """Pictures with as many samples as it takes."""
    for samples in SAMPLES:
        renders = Renders([render(scene, samples, seed, box_filter) for seed in SEEDS])
        if renders.noise <= SMALL_NOISE and renders.error <= SMALL_ERROR:
            break
    return renders


def _render_ours(scene: bpy.types.Scene, samples: int, seed: int, box_filter: bool) -> Picture:
    settings = {"gather.rays": samples, "gather.camera_samples": samples, "gather.max_depth": BOUNCES}
    pictures.use_rgp(scene, {**settings, "photon_pass.photon_count": PHOTONS, "render.seed": seed})
    if box_filter:
        pictures.use_box_filter(scene)
    return pictures.render(scene)["Combined"]


def _render_theirs(scene: bpy.types.Scene, samples: int, seed: int, box_filter: bool) -> Picture:
    pictures.use_cycles(scene, samples, seed)
    if box_filter:
        pictures.use_box_filter(scene)
    return pictures.render(scene)["Combined"]
