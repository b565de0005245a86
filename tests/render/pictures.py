"""Rendering the open scene to arrays, and the figures that are compared. Arrays are (height, width, 3), rows from the
top, scene-linear."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import numpy.typing as npt
import OpenEXR

from scenes import common

Picture = npt.NDArray[np.float64]


def render(scene: bpy.types.Scene, passes: Iterable[str] = ("Combined",)) -> dict[str, Picture]:
    """Renders the scene with its own engine and settings; pictures by the name of the pass."""
    channels = render_channels(scene)
    layer = scene.view_layers[0].name
    return {name: rgb(channels, f"{layer}.{name}") for name in passes}


def render_channels(scene: bpy.types.Scene) -> dict[str, npt.NDArray[Any]]:
    """Renders the scene with its own engine and settings; every channel of the file by name, (height, width)."""
    output = scene.render.image_settings
    if hasattr(output, "media_type"):  # Blender 5.0 and later
        output.media_type = "MULTI_LAYER_IMAGE"
    output.file_format = "OPEN_EXR_MULTILAYER"
    output.color_depth = "32"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.exr"
        scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True)
        return read_channels(path)


def use_rgp(scene: bpy.types.Scene, settings: Mapping[str, Any]) -> None:
    """Makes RGP Engine the scene's engine, with settings by the names of the command line, such as `gather.rays`."""
    scene.render.engine = "RGP"
    for name, value in settings.items():
        group, setting = name.split(".")
        setattr(getattr(scene.rgp, group), setting, value)


def use_cycles(scene: bpy.types.Scene, samples: int, seed: int) -> None:
    """Makes a clean Cycles the scene's engine, with samples that are independent from pixel to pixel and from seed to
    seed."""
    common.set_clean_settings(scene, samples)
    scene.cycles.seed = seed
    scene.cycles.sampling_pattern = "TABULATED_SOBOL"
    scene.cycles.min_light_bounces = 3


def use_box_filter(scene: bpy.types.Scene) -> None:
    """Makes each pixel its own square, for both engines; `use_cycles` undoes it."""
    scene.rgp.film.filter, scene.rgp.film.filter_width = "box", 1.0
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 1.0


def read_channels(path: Path) -> dict[str, npt.NDArray[Any]]:
    """Every channel of an EXR file by name, (height, width)."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return {name: channel.pixels for name, channel in file.channels().items()}


def rgb(channels: dict[str, npt.NDArray[Any]], name: str) -> Picture:
    """The channels `name.R`, `name.G` and `name.B` as one picture."""
    return np.stack([channels[f"{name}.{channel}"] for channel in "RGB"], axis=-1).astype(np.float64)


def part(picture: Picture, box: Iterable[float]) -> Picture:
    """A part of the frame, its edges given in parts of the frame: left, bottom, right, top."""
    height, width = picture.shape[:2]
    left, bottom, right, top = box
    rows = slice(round((1.0 - top) * height), round((1.0 - bottom) * height))
    return picture[rows, round(left * width) : round(right * width)]


def mean(picture: Picture) -> Picture:
    """Mean of the pixels, per channel."""
    return picture.mean(axis=(0, 1))


def standard_error_of_mean(first: Picture, second: Picture) -> Picture:
    """Of the mean over both of two renders that differ in their seed alone, per channel; pixels are independent."""
    pixels = first.shape[0] * first.shape[1]
    return np.sqrt(((first - second) ** 2).sum(axis=(0, 1))) / (2.0 * pixels)


def rms_peak(picture: Picture, first: Picture, second: Picture) -> float:
    """RMS difference between a picture and the truth, brightest pixel = 1, where the truth is known from two
    independent noisy halves: the product of both differences has the squared error as its expectation, since the noise
    of the halves does not correlate. So the reference's noise is neither counted nor has to be estimated."""
    squared_error = ((picture - first) * (picture - second)).mean()
    peak = ((first + second) / 2.0).max()
    return float(np.sqrt(max(squared_error, 0.0)) / peak)


def noise_peak(first: Picture, second: Picture) -> float:
    """RMS noise of the mean of two independent halves, brightest pixel = 1."""
    return float(np.sqrt(((first - second) ** 2).mean()) / 2.0 / ((first + second) / 2.0).max())
