"""One render: what it is, what it is kept under, and the command that repeats it."""

import hashlib
import json
from dataclasses import dataclass
from typing import Any

THREADS = 2
"""Of every render; the times are stated for it."""

# Small enough that two threads share the smallest picture evenly. It changes nothing in the picture.
_TILE_SIZE = 32


@dataclass(frozen=True)
class Job:
    """A render of a scene. What is not here is at its default."""

    scene: str
    """Name of a scene."""
    size: tuple[int, int]
    """Width and height in pixels."""
    estimator: str
    """As in `gather.estimator`."""
    rays: int
    """Gather rays per pixel."""
    camera_samples: int = 16
    """Per pixel."""
    photons: int = 0
    """Emitted."""
    bins: str = "8x16"
    finest: int = 128
    """Cells along the longest side, on the finest level."""
    adaptive: int = 2
    """Levels of finer cells below that."""
    seed: int = 0

    @property
    def settings(self) -> dict[str, dict[str, Any]]:
        """For the core."""
        return {
            "photon_pass": {"photon_count": self.photons},
            "pyramid": {
                "finest_resolution": self.finest,
                "adaptive_levels": self.adaptive,
                "bins": self.bins,
            },
            "gather": {
                "estimator": self.estimator,
                "rays": self.rays,
                "camera_samples": self.camera_samples,
            },
            "film": {"tile_size": _TILE_SIZE},
            "render": {"threads": THREADS, "seed": self.seed},
        }

    @property
    def total_rays(self) -> int:
        """Gather rays of the whole picture, their continuations aside."""
        return self.size[0] * self.size[1] * self.rays

    def key(self, scene_digest: str, core_version: str) -> str:
        """What the render is kept under: the same for the same picture from the same core."""
        content = [scene_digest, core_version, self.size, self.settings]
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:16]

    def command(self, blend: str) -> str:
        """The same render of the file at the path `blend`, from the command line."""
        assignments = [
            f"--set {group}.{name}={value}"
            for group, values in self.settings.items()
            for name, value in values.items()
        ]
        width, height = self.size
        files = "-o combined.exr --indirect indirect.exr --stats stats.json"
        return f"python -m rgp_engine render {blend} {files} --resolution {width}x{height} {' '.join(assignments)}"

    def describe(self) -> str:
        """For the terminal."""
        cells = f" {self.finest} {self.bins}" if self.estimator.startswith("pyramid") else ""
        width, height = self.size
        return f"{self.scene}: {self.estimator}{cells}, {width}x{height}, {self.rays} rays, {self.photons:,} photons"
