"""The passes of whole renders, and the gather against the bare tracing of its own rays."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchmarks.capture import capture
from benchmarks.figures import Figure, Progress
from rgp_engine import native
from rgp_engine.cli.blender_scene import open_scene

if TYPE_CHECKING:
    import rgp_core

SETTINGS: dict[str, dict[str, Any]] = {
    "photon_pass": {"photon_count": 1_000_000},
    "pyramid": {"finest_resolution": 128},
    "gather": {"rays": 256},
}
"""What the targets are stated for; everything else is at its default."""

# A picture of more pixels than our own scenes' is scaled down, to what a benchmark has time for.
_MOST_PIXELS = 512 * 512
_SCALED_PIXELS = 256 * 256


@dataclass(frozen=True)
class RenderSpeed:
    """Figures of one scene, one value per repetition."""

    gather_over_trace: Figure
    """Seconds of the gather over seconds of tracing the same gather rays one by one on the same threads."""
    photons_per_second: Figure
    pyramid_build_seconds: Figure
    pyramid_bytes: Figure
    is_diffuse: bool
    """True where no cell holds light by direction."""


def measure(
    stem: str, scene: "rgp_core.Scene", threads: int, repetitions: int, progress: Progress
) -> RenderSpeed:
    """Renders a scene several times, each time followed by the tracing that its gather is compared with."""
    settings = {**SETTINGS, "render": {"threads": threads}}
    renders, ratios = [], []
    for repetition in range(repetitions):
        stats = render(scene, settings)
        floor = native.core().trace_floor(scene, settings, str(native.embree_library()))
        gather = stats["seconds"]["gather"]
        ratios.append(gather / floor["seconds"])
        renders.append(stats)
        progress(
            f"{stem}, {repetition + 1} of {repetitions}: gather {gather:.2f} s, "
            f"the same {floor['rays'] / 1e6:.1f} million rays one by one {floor['seconds']:.2f} s"
        )
    return RenderSpeed(
        Figure(ratios),
        Figure([stats["photons"]["emitted"] / stats["seconds"]["photon_pass"] for stats in renders]),
        Figure([stats["seconds"]["pyramid"] for stats in renders]),
        Figure([stats["pyramid"]["bytes"] for stats in renders]),
        is_diffuse=renders[0]["pyramid"]["glossy_cells"] == 0,
    )


def core_scene(blend: Path) -> "rgp_core.Scene":
    """The file's scene, at its own resolution where that is no larger than our own scenes'."""
    b_scene = open_scene(blend)
    b_render = b_scene.render
    pixels = b_render.resolution_x * b_render.resolution_y * (b_render.resolution_percentage / 100) ** 2
    if pixels > _MOST_PIXELS:
        b_render.resolution_percentage = int(
            b_render.resolution_percentage * math.sqrt(_SCALED_PIXELS / pixels)
        )
    return capture(b_scene).scene


def render(scene: "rgp_core.Scene", settings: dict[str, dict[str, Any]]) -> dict[str, Any]:
    """Stats of one render."""
    session = native.core().Session(scene, settings, str(native.embree_library()))
    session.start()
    session.finish()
    stats: dict[str, Any] = session.stats()
    return stats
