"""Makes the references of the render tests with Cycles: `python -m tests.render.make_references [WHAT ...]`.

WHAT is `cornell_box`, `cases`, or a part of a case's name such as `lamp/` or `glass`; all when nothing is given.
It takes one thread and about half an hour. Written to `tests/render/references/`:

- `cornell_box.exr`, 128 x 128, half floats: the picture (`Combined`) and twice the light that bounced at least twice
  (`Indirect1`, `Indirect2`), from two halves with different seeds;
- `cornell_box.json`: samples, means, their standard errors and the noise of both halves together;
- `cases.json`: for every case its mean and standard error, whole picture and ball.

Pixel filter: Blackman-Harris, 1.5 pixels wide, the default of Cycles and of RGP Engine.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

import bpy
import numpy as np
import numpy.typing as npt
import OpenEXR

from scenes import common
from tests.render import cases, pictures

REFERENCES = Path(__file__).resolve().parent / "references"
BLENDER = (5, 0)
"""The references are this version's Cycles."""
CORNELL_RESOLUTION = 128
CORNELL_SAMPLES = 4096
"""Per half."""
CORNELL_SLICE = 512
"""Samples per render, so that a long run can be stopped."""
SECOND_HALF = 1000
"""Added to the seeds of the first half."""
CASE_SAMPLES = (128, 512, 2048, 8192)
"""Per half: the first that makes every standard error small enough, else the last."""
CASE_ERROR = 1e-3
"""Standard error that is small enough, as a part of the mean over the channels."""


def use_cycles(scene: bpy.types.Scene, samples: int, seed: int) -> None:
    """Clean Cycles on one thread."""
    pictures.use_cycles(scene, samples, seed)
    scene.render.threads_mode = "FIXED"
    scene.render.threads = 1


def render_cornell_box(seed: int) -> npt.NDArray[np.float64]:
    """Picture and indirect light of one slice, (2, height, width, 3)."""
    bpy.ops.wm.open_mainfile(filepath=str(common.SCENES / "cornell_box.blend"))
    scene = bpy.context.scene
    use_cycles(scene, CORNELL_SLICE, seed)
    scene.render.resolution_x = scene.render.resolution_y = CORNELL_RESOLUTION
    layer = scene.view_layers[0]
    layer.use_pass_diffuse_indirect = layer.use_pass_diffuse_color = True
    passes = pictures.render(scene, ("Combined", "Diffuse Indirect", "Diffuse Color"))
    return np.stack([passes["Combined"], passes["Diffuse Indirect"] * passes["Diffuse Color"]])


def make_cornell_box(samples_per_half: int) -> None:
    """Two halves, slice after slice; what there is so far is written after each pair of slices."""
    sums = np.zeros((2, 2, CORNELL_RESOLUTION, CORNELL_RESOLUTION, 3))
    for i in range(1, samples_per_half // CORNELL_SLICE + 1):
        start = time.monotonic()
        sums += np.stack([render_cornell_box(i), render_cornell_box(SECOND_HALF + i)])
        write_cornell_box(i * CORNELL_SLICE, sums / i)
        print(
            f"cornell_box: {i * CORNELL_SLICE} samples per half, {time.monotonic() - start:.0f} s", flush=True
        )


def write_cornell_box(samples_per_half: int, halves: npt.NDArray[np.float64]) -> None:
    """Pictures, means and noise; `halves` is (half, combined or indirect, height, width, 3)."""
    (combined_1, indirect_1), (combined_2, indirect_2) = halves
    layers = {"Combined": (combined_1 + combined_2) / 2.0, "Indirect1": indirect_1, "Indirect2": indirect_2}
    channels = {
        f"{name}.{channel}": np.ascontiguousarray(layer[..., i].astype(np.float16))
        for name, layer in layers.items()
        for i, channel in enumerate("RGB")
    }
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    REFERENCES.mkdir(exist_ok=True)
    OpenEXR.File(header, channels).write(str(REFERENCES / "cornell_box.exr"))
    figures = {
        "made_with": f"Cycles {bpy.app.version_string}",
        "samples_per_half": samples_per_half,
        "pixel_filter": "Blackman-Harris, 1.5 pixels",
        "mean_combined": pictures.mean(layers["Combined"]).tolist(),
        "standard_error_combined": pictures.standard_error_of_mean(combined_1, combined_2).tolist(),
        "mean_indirect": pictures.mean((indirect_1 + indirect_2) / 2.0).tolist(),
        "standard_error_indirect": pictures.standard_error_of_mean(indirect_1, indirect_2).tolist(),
        "noise_peak_indirect": pictures.noise_peak(indirect_1, indirect_2),
    }
    write_json("cornell_box", figures)


def make_case(case: str) -> dict[str, object]:
    """Samples per half, then mean and standard error of one case, whole picture and ball."""
    for samples in CASE_SAMPLES:
        figures, error = render_case(case, samples)
        if error < CASE_ERROR:
            break
    return {"samples_per_half": samples, **figures}


def render_case(case: str, samples: int) -> tuple[dict[str, object], float]:
    """The figures of one case at so many samples, and the largest relative standard error in them."""
    halves = []
    for seed in (1, 2):
        scene = cases.build(case)
        use_cycles(scene, samples, seed)
        halves.append(pictures.render(scene)["Combined"])
    figures: dict[str, object] = {}
    relative_errors = []
    for region, box in cases.REGIONS.items():
        first, second = (pictures.part(half, box) for half in halves)
        mean = pictures.mean((first + second) / 2.0)
        error = pictures.standard_error_of_mean(first, second)
        figures[region] = {"mean": mean.round(7).tolist(), "standard_error": error.round(8).tolist()}
        relative_errors.append(float(error.max() / mean.mean()))
    return figures, max(relative_errors)


def make_cases(names: list[str]) -> None:
    """The named cases; the others keep what the file holds."""
    path = REFERENCES / "cases.json"
    kept = json.loads(path.read_text())["cases"] if path.exists() else {}
    for case in names:
        start = time.monotonic()
        kept[case] = make_case(case)
        write_cases(kept)
        print(f"{case}: {time.monotonic() - start:.1f} s {kept[case]['whole']}", flush=True)


def write_cases(kept: dict[str, object]) -> None:
    """`references/cases.json`, in the order of the table; cases that are no longer in it are dropped."""
    figures = {
        "made_with": f"Cycles {bpy.app.version_string}",
        "pixel_filter": "Blackman-Harris, 1.5 pixels",
        "cases": {case: kept[case] for case in cases.CASES if case in kept},
    }
    write_json("cases", figures)


def write_json(name: str, figures: dict[str, object]) -> None:
    """`references/<name>.json`."""
    REFERENCES.mkdir(exist_ok=True)
    (REFERENCES / f"{name}.json").write_text(json.dumps(figures, indent=1) + "\n")


def main() -> None:
    """Makes what the command line names."""
    parser = argparse.ArgumentParser(description="Make the references of the render tests with Cycles.")
    parser.add_argument(
        "what", nargs="*", metavar="WHAT", help="cornell_box, cases, or a part of a case's name"
    )
    what = parser.parse_args().what or ["cornell_box", "cases"]
    if bpy.app.version[:2] != BLENDER:
        sys.exit(
            f"the references are made with Blender {BLENDER[0]}.{BLENDER[1]}, not {bpy.app.version_string}"
        )
    if "cornell_box" in what:
        make_cornell_box(CORNELL_SAMPLES)
    names = [case for case in cases.CASES if "cases" in what or any(word in case for word in what)]
    if names:
        make_cases(names)


if __name__ == "__main__":
    main()
