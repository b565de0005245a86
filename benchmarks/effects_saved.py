"""What the effects plan saves: the same picture with every effect by itself, and with every effect forced on.

Where nothing calls for an effect, On changes no pixel; all that differs is the work.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.figures import Figure, Progress
from rgp_engine import native

if TYPE_CHECKING:
    import rgp_core

SETTINGS: dict[str, dict[str, Any]] = {
    "photon_pass": {"photon_count": 1_000_000},
    "pyramid": {"finest_resolution": 128},
    "gather": {"rays": 64},
}
"""What the pairs are rendered with; everything else is at its default."""


@dataclass(frozen=True)
class EffectsSaved:
    """Figures of one scene, one value per repetition."""

    not_called_for: tuple[str, ...]
    """Effects the scene does not ask for."""
    seconds_ratio: Figure
    """Seconds with every effect on over seconds with each by itself."""
    bytes_more: Figure
    """Memory that the effects take more where every one is on."""
    rays_more: Figure
    """Rays and photon segments that are traced more there."""


def measure(
    stem: str, scene: "rgp_core.Scene", threads: int, repetitions: int, progress: Progress
) -> EffectsSaved:
    """Renders a scene by turns as planned and with everything on. Raises AssertionError where the pictures differ."""
    effects = [row["name"] for row in native.core().settings_schema() if row["group"] == "effects"]
    planned_settings = {**SETTINGS, "render": {"threads": threads}}
    forced_settings = {**planned_settings, "effects": dict.fromkeys(effects, "on")}
    ratios, more_bytes, more_rays, idle = [], [], [], ()
    for repetition in range(repetitions):
        planned, picture = _render(scene, planned_settings)
        forced, same_picture = _render(scene, forced_settings)
        assert np.array_equal(picture, same_picture), f"{stem}: forcing effects on changed the picture"
        idle = tuple(effect["name"] for effect in planned["effects"] if not effect["called_for"])
        ratios.append(forced["seconds"]["total"] / planned["seconds"]["total"])
        more_bytes.append(_sum(forced, "bytes") - _sum(planned, "bytes"))
        more_rays.append(_sum(forced, "rays") - _sum(planned, "rays"))
        progress(
            f"{stem}, {repetition + 1} of {repetitions}: {planned['seconds']['total']:.2f} s as planned, "
            f"{forced['seconds']['total']:.2f} s with everything on; "
            f"not called for: {', '.join(idle).replace('_', ' ') or 'nothing'}"
        )
    return EffectsSaved(idle, Figure(ratios), Figure(more_bytes), Figure(more_rays))


def _sum(stats: Mapping[str, Any], cost: str) -> int:
    """A cost of all effects together."""
    return sum(effect[cost] for effect in stats["effects"])


def _render(
    scene: "rgp_core.Scene", settings: dict[str, dict[str, Any]]
) -> tuple[dict[str, Any], np.ndarray[Any, Any]]:
    """Stats and picture of one render."""
    session = native.core().Session(scene, settings, str(native.embree_library()))
    session.start()
    session.finish()
    return session.stats(), session.picture("combined")
