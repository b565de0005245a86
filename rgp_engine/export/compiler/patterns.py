"""Procedural textures."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import bpy

from ..nodes import Output
from .mapping import texture_vector

if TYPE_CHECKING:
    from .compiler import Compiler, Operand, Register

_DIMENSIONS = {"1D": 1, "2D": 2, "3D": 3, "4D": 4}
_VORONOI_OUTPUTS = {
    "Distance": "distance",
    "Radius": "distance",
    "Color": "color",
    "Position": "position",
    "W": "w",
}
# What cells' random numbers are made of, since that Blender and before.
_WORDS_SINCE = (4, 3)


def _pattern(c: "Compiler", options: dict[str, Any], inputs: "list[Register]") -> "Register":
    return c.emit("pattern", pattern=options, inputs=[register.index for register in inputs])


def _optional(c: "Compiler", source: Output, identifier: str) -> "Register":
    """An input that not every version of Blender has; 0 without."""
    return c.register(0.0) if source.find(identifier) is None else c.input(source, identifier)


def _noise(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    is_color = source.b_socket.identifier == "Color"
    options = {
        "kind": "noise",
        "dimensions": _DIMENSIONS[b_node.noise_dimensions],
        "fractal": getattr(b_node, "noise_type", "FBM"),
        "normalize": bool(getattr(b_node, "normalize", True)),
        "color": is_color,
    }
    names = ("W", "Scale", "Detail", "Roughness", "Lacunarity", "Offset", "Gain", "Distortion")
    return _pattern(c, options, [texture_vector(c, source), *(_optional(c, source, name) for name in names)])


def _white_noise(c: "Compiler", source: Output) -> "Operand | None":
    is_color = source.b_socket.identifier == "Color"
    dimensions = _DIMENSIONS[source.b_node.noise_dimensions]
    options = {"kind": "white_noise", "dimensions": dimensions, "color": is_color}
    vector = c.input(source, "Vector") if c.linked(source, "Vector") else c.register((0.0, 0.0, 0.0))
    return _pattern(c, options, [vector, c.input(source, "W")])


def _voronoi(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    options = {
        "kind": "voronoi",
        "dimensions": _DIMENSIONS[b_node.voronoi_dimensions],
        "feature": b_node.feature,
        "metric": b_node.distance,
        "hash": "words" if bpy.app.version >= _WORDS_SINCE else "floats",
        "normalize": bool(b_node.normalize),
        "output": _VORONOI_OUTPUTS[source.b_socket.identifier],
    }
    names = ("W", "Scale", "Detail", "Roughness", "Lacunarity", "Smoothness", "Exponent", "Randomness")
    return _pattern(c, options, [texture_vector(c, source), *(c.input(source, name) for name in names)])


def _wave(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    rings = b_node.wave_type == "RINGS"
    options = {
        "kind": "wave",
        "rings": rings,
        "direction": b_node.rings_direction if rings else b_node.bands_direction,
        "profile": b_node.wave_profile,
    }
    names = ("Scale", "Distortion", "Detail", "Detail Scale", "Detail Roughness", "Phase Offset")
    return _pattern(c, options, [texture_vector(c, source), *(c.input(source, name) for name in names)])


def _magic(c: "Compiler", source: Output) -> "Operand | None":
    options = {"kind": "magic", "depth": int(source.b_node.turbulence_depth)}
    inputs = [texture_vector(c, source), c.input(source, "Scale"), c.input(source, "Distortion")]
    magic = _pattern(c, options, inputs)
    return magic if source.b_socket.identifier == "Color" else c.emit("alpha", of=magic)


def _brick(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    options = {
        "kind": "brick",
        "offset": float(b_node.offset),
        "offset_frequency": int(b_node.offset_frequency),
        "squash": float(b_node.squash),
        "squash_frequency": int(b_node.squash_frequency),
    }
    colors = ("Color1", "Color2", "Mortar")
    sizes = ("Scale", "Mortar Size", "Mortar Smooth", "Bias", "Brick Width", "Row Height")
    inputs = [texture_vector(c, source), *(c.input(source, name) for name in colors + sizes)]
    brick = _pattern(c, options, inputs)
    return brick if source.b_socket.identifier == "Color" else c.emit("alpha", of=brick)


def _checker(c: "Compiler", source: Output) -> "Operand | None":
    inputs = {name: c.input(source, name.capitalize()) for name in ("color1", "color2", "scale")}
    checker = c.emit("checker", vector=texture_vector(c, source), **inputs)
    return checker if source.b_socket.identifier == "Color" else c.emit("alpha", of=checker)


def _gradient(c: "Compiler", source: Output) -> "Operand | None":
    return c.emit("gradient", vector=texture_vector(c, source), shape=source.b_node.gradient_type)


NODES: "dict[str, Callable[[Compiler, Output], Operand | None]]" = {
    "TEX_NOISE": _noise,
    "TEX_WHITE_NOISE": _white_noise,
    "TEX_VORONOI": _voronoi,
    "TEX_WAVE": _wave,
    "TEX_MAGIC": _magic,
    "TEX_BRICK": _brick,
    "TEX_CHECKER": _checker,
    "TEX_GRADIENT": _gradient,
}
"""Instructions of the procedural textures."""

SOURCES: "dict[str, Callable[[Compiler, Output], bool]]" = dict.fromkeys(NODES, lambda _c, _source: True)
"""Whether such a node can be computed."""
