"""Renders jobs that are not in the store yet."""

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from benchmarks.capture import capture
from benchmarks.tables.forecast import Forecast
from benchmarks.tables.job import Job
from benchmarks.tables.store import Render, Store
from benchmarks.tables.subjects import Subject
from rgp_engine import native
from rgp_engine.cli.blender_scene import open_scene

if TYPE_CHECKING:
    import rgp_core

Say = Callable[[str], None]

_POLL_SECONDS = 0.5
_SECONDS_BETWEEN_LINES = 30.0


class Runner:
    """Renders, or finds what was rendered before; tells how far it is."""

    def __init__(self, store: Store, subjects: Sequence[Subject], say: Say) -> None:
        self._store = store
        self._subjects = {subject.name: subject for subject in subjects}
        self._digests = {subject.name: subject.digest() for subject in subjects}
        self._say = say
        self._forecast = Forecast()
        self._captured: tuple[str, tuple[int, int], rgp_core.Scene] | None = None

    def run(self, jobs: Sequence[Job]) -> dict[Job, Render]:
        """The renders of all jobs. What an interrupt leaves undone is done by the next run."""
        renders = {job: render for job in jobs if (render := self._find(job))}
        for job, render in renders.items():
            self._forecast.learn(job, render.stats["seconds"]["total"])
        missing = [job for job in jobs if job not in renders]
        if renders:
            self._say(f"{len(renders)} of {len(jobs)} renders are there already")
        for number, job in enumerate(missing):
            left = _duration(self._forecast.seconds(missing[number:]))
            self._say(f"[{number + 1}/{len(missing)}] {job.describe()} (about {left} left)")
            renders[job] = self._render(job)
            self._forecast.learn(job, renders[job].stats["seconds"]["total"])
        return renders

    def _find(self, job: Job) -> Render | None:
        return self._store.find(job, self._digests[job.scene])

    def _render(self, job: Job) -> Render:
        session = native.core().Session(self._scene(job), job.settings, str(native.embree_library()))
        session.start()
        try:
            self._follow(session)
        except BaseException:
            session.cancel()
            raise
        finally:
            session.finish()
        render = Render(session.stats(), session.picture("indirect")[::-1])
        self._store.keep(job, self._digests[job.scene], render)
        return render

    def _follow(self, session: "rgp_core.Session") -> None:
        """Waits for the end; long renders say where they are."""
        said = time.monotonic()
        while not session.wait(_POLL_SECONDS):
            if time.monotonic() - said > _SECONDS_BETWEEN_LINES:
                said = time.monotonic()
                progress = session.progress()
                self._say(f"    {progress['stage']}: {progress['fraction']:.0%}")

    def _scene(self, job: Job) -> "rgp_core.Scene":
        """The core's scene; the last one is kept, as jobs of one scene and size follow each other."""
        if self._captured is None or self._captured[:2] != (job.scene, job.size):
            self._captured = None
            b_scene: Any = open_scene(self._subjects[job.scene].path)
            b_scene.render.resolution_x, b_scene.render.resolution_y = job.size
            b_scene.render.resolution_percentage = 100
            self._captured = (job.scene, job.size, capture(b_scene).scene)
        return self._captured[2]


def _duration(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 100.0 else f"{seconds / 60.0:.0f} min"
