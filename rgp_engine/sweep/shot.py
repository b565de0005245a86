"""One render of a taken scene."""

from dataclasses import dataclass
from typing import Any

from .. import native
from ..accuracy.error import Picture
from .taken_scene import TakenScene

_POLL_SECONDS = 0.1


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
            pass
    except BaseException:
        session.cancel()
        raise
    finally:
        session.finish()
    return Shot(session.picture("combined")[..., :3], session.stats())
