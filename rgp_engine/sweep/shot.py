"""One render of a taken scene."""

import threading
from dataclasses import dataclass
from typing import Any

from .. import native
from ..accuracy.error import Picture
from .taken_scene import TakenScene

_POLL_SECONDS = 0.1

_stop = threading.Event()


def request_stop() -> None:
    """Makes the render under way, and every later one, end as an interrupt does. For other threads."""
    _stop.set()


@dataclass(frozen=True)
class Shot:
    """A picture and what the core says about it."""

    picture: Picture
    """(height, width, 3), rows from the bottom."""
    stats: dict[str, Any]


def render(taken: TakenScene, settings: dict[str, dict[str, Any]], seed: int) -> Shot:
    """Renders it, with a seed of its own. Raises what the core raises; an interrupt stops it first."""
    seeded = {**settings, "render": {**settings["render"], "seed": seed}}
    session = native.core().Session(taken.scene, seeded, str(native.embree_library()))
    session.start()
    try:
        while not session.wait(_POLL_SECONDS):
            if _stop.is_set():
                raise KeyboardInterrupt
    except BaseException:
        session.cancel()
        raise
    finally:
        session.finish()
    return Shot(session.picture("combined")[..., :3], session.stats())
