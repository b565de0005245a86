"""Finished renders on disk, so that a run that was ended goes on where it was."""

import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from benchmarks.tables.job import Job

Picture = npt.NDArray[np.float32]


@dataclass(frozen=True)
class Render:
    """A finished render."""

    stats: dict[str, Any]
    """As the core reports them."""
    indirect: Picture
    """Its indirect light (height, width, 3), rows from the top."""

    @property
    def gather_seconds(self) -> float:
        """Of the gather."""
        return float(self.stats["seconds"]["gather"])

    @property
    def preparing_seconds(self) -> float:
        """Of the photon pass and of building what the gather asks."""
        return float(self.stats["seconds"]["photon_pass"] + self.stats["estimator"]["seconds"])

    @property
    def seconds(self) -> float:
        """Photon pass, building and gather."""
        return self.preparing_seconds + self.gather_seconds

    @property
    def bytes(self) -> int:
        """Memory of what the gather asks."""
        return int(self.stats["estimator"]["bytes"])


class Store:
    """A folder of renders, each under the hash of what it is made from."""

    def __init__(self, folder: Path, core_version: str) -> None:
        self._folder = folder
        self._core_version = core_version
        folder.mkdir(parents=True, exist_ok=True)

    def find(self, job: Job, scene_digest: str) -> Render | None:
        """The render of a job, or None."""
        stats, picture = self._paths(job, scene_digest)
        if not stats.is_file():
            return None
        return Render(json.loads(stats.read_text())["stats"], np.load(picture))

    def keep(self, job: Job, scene_digest: str, render: Render) -> None:
        """Writes a render. The statistics come last and at once: where they are, everything is."""
        stats, picture = self._paths(job, scene_digest)
        np.save(picture, render.indirect)
        unfinished = stats.with_suffix(".unfinished")
        unfinished.write_text(json.dumps({"job": asdict(job), "stats": render.stats}, indent=2) + "\n")
        os.replace(unfinished, stats)  # noqa: PTH105 (says that it overwrites)

    def clear(self) -> None:
        """Forgets every render."""
        for path in self._folder.iterdir():
            if path.suffix in (".json", ".npy", ".unfinished"):
                path.unlink()

    def _paths(self, job: Job, scene_digest: str) -> tuple[Path, Path]:
        key = job.key(scene_digest, self._core_version)
        return self._folder / f"{key}.json", self._folder / f"{key}.npy"
