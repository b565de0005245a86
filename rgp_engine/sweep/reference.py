"""The reference: two independent halves, as free of noise as the time allows."""

import time
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..accuracy.error import Means, Picture, Reference
from .shot import render
from .taken_scene import TakenScene

_Settings = dict[str, dict[str, Any]]

# Each half is the mean of parts with seeds of their own: few, as strata are the finer the larger a part is.
_PARTS = 2
_LEAST_RAYS, _MOST_RAYS = 32, 4096
# Edges and shadows want camera samples, indirect light wants rays: about here a second is spent best.
_RAYS_PER_SAMPLE = 4


def reference_settings(settings: _Settings, rays: int) -> _Settings:
    """Settings whose picture has no error but noise: light is followed along paths, and nothing is read from cells."""
    gather = {
        **settings["gather"],
        "estimator": "path",
        "rays": rays,
        "camera_samples": rays // _RAYS_PER_SAMPLE,
    }
    return {**settings, "gather": gather}


class ReferenceMaker:
    """Renders parts of both halves in turn, until the time is up."""

    def __init__(self, taken: TakenScene, settings: _Settings, first_seed: int) -> None:
        self._taken = taken
        self._settings = settings
        self._seed = first_seed
        self._rays = _LEAST_RAYS
        self._sums: list[Picture | float] = [0.0, 0.0]
        self.parts = 0
        """Rendered for each half."""
        self.seconds = 0.0

    def parts_within(self, seconds: float) -> Iterator[int]:
        """Renders at least one part of each half, and as many as that time allows; yields their number so far."""
        began = time.monotonic()
        self._render()
        factor = seconds / (2 * _PARTS + 1) / max(time.monotonic() - began, 1e-3)
        self._rays = min(max(int(_LEAST_RAYS * factor), _LEAST_RAYS), _MOST_RAYS)
        while True:
            for half in (0, 1):
                self._sums[half] = self._sums[half] + self._render()
            self.parts += 1
            self.seconds = time.monotonic() - began
            yield self.parts
            if self.seconds + self.seconds / self.parts > seconds:
                return

    def _render(self) -> Picture:
        self._seed += 1
        return render(self._taken, reference_settings(self._settings, self._rays), self._seed).picture

    def reference(self, means: Means) -> Reference:
        """What there is, for a picture of those means."""
        first, second = (np.asarray(part, np.float32) / np.float32(self.parts) for part in self._sums)
        return Reference(first, second, means)

    def description(self, reference: Reference) -> dict[str, Any]:
        """How it was made and how noisy it is (%)."""
        gather = reference_settings(self._settings, self._rays)["gather"]
        return {
            "estimator": gather["estimator"],
            "rays": 2 * self.parts * gather["rays"],
            "camera_samples": 2 * self.parts * gather["camera_samples"],
            "seconds": self.seconds,
            "noise": reference.noise,
            "resolves": reference.resolves,
        }
