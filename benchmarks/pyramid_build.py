"""What the pyramid's build costs beside the photon pass."""

from pathlib import Path

from benchmarks.capture import capture
from benchmarks.figures import Figure, Progress
from benchmarks.render_speed import SETTINGS, render
from rgp_engine.cli.blender_scene import open_scene

_PERCENTAGE = 8
"""Of the picture's size: nothing that is measured here depends on how many pixels there are."""


def measure(blend: Path, threads: int, repetitions: int, progress: Progress) -> Figure:
    """Seconds of layout, pilot photons and build over seconds of the photon pass, one value per repetition."""
    b_scene = open_scene(blend)
    b_scene.render.resolution_percentage = _PERCENTAGE
    scene = capture(b_scene).scene
    gather = {**SETTINGS["gather"], "camera_samples": 1}
    settings = {**SETTINGS, "gather": gather, "render": {"threads": threads}}
    ratios = []
    for repetition in range(repetitions):
        seconds = render(scene, settings)["seconds"]
        ratios.append(seconds["pyramid"] / seconds["photon_pass"])
        progress(
            f"{blend.stem}, {repetition + 1} of {repetitions}: "
            f"pyramid {seconds['pyramid']:.2f} s, photon pass {seconds['photon_pass']:.2f} s"
        )
    return Figure(ratios)
