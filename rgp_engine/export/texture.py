"""What stands for a texture where one value is asked for: its average."""

from collections.abc import Callable
from typing import Any

from .arithmetic import Color, product, scale
from .ies import UNREADABLE, IesError, web_of
from .image import average

MISSING: Color = (1.0, 0.0, 1.0)
"""The color of a missing image, as everywhere in Blender."""

# Their noise and patterns lie between 0 and 1.
_PATTERNS = (
    "TEX_NOISE",
    "TEX_VORONOI",
    "TEX_WAVE",
    "TEX_MAGIC",
    "TEX_GRADIENT",
    "TEX_WHITE_NOISE",
    "TEX_GABOR",
)
# Images whose average is not looked for.
_SEVERAL = ("SEQUENCE", "TILED", "MOVIE")
_MIXES = {"TEX_CHECKER": (0.5, 0.5, 0.0), "TEX_BRICK": (0.45, 0.45, 0.1)}
_MIX_INPUTS = ("Color1", "Color2", "Mortar")
# Seen from outside, head on, by a camera: the case that most pictures show.
_LIGHT_PATH = {"Is Camera Ray": 1.0}
_FRESNEL_OF_GLASS = 0.04

Value = float | Color


def texture_average(b_node: Any, b_output: Any, fold: Callable[[str], Value]) -> tuple[Value, str] | None:
    """Value that stands for a texture node's output and why; None for nodes that are no texture."""
    kind = b_node.type
    if kind in ("TEX_IMAGE", "TEX_ENVIRONMENT"):
        return _image(b_node, b_output)
    if kind == "TEX_IES":
        return _luminaire(b_node, fold)
    if kind in _PATTERNS:
        return _shaped(0.5, b_output), "only a typical value is used here"
    if kind in _MIXES:
        return _mix(b_node, b_output, fold), "only a typical value is used here"
    if kind == "LIGHT_PATH":
        return _LIGHT_PATH.get(b_output.identifier, 0.0), "ray kinds are not told apart here"
    if kind in ("FRESNEL", "LAYER_WEIGHT"):
        value = 0.5 if b_output.identifier == "Facing" else _FRESNEL_OF_GLASS
        return value, "values that depend on the view are not supported here"
    return None


def _image(b_node: Any, b_output: Any) -> tuple[Value, str]:
    b_image = b_node.image
    if b_image is None:
        return _channel(MISSING, 1.0, b_output), "it has no image"
    if b_image.source in _SEVERAL:
        return _shaped(0.5, b_output), "only a typical value is used here"
    mean = average(b_image, is_sphere=b_node.type == "TEX_ENVIRONMENT")
    if mean is None:
        return _channel(MISSING, 1.0, b_output), f'the image "{b_image.name}" cannot be read'
    return _channel(*mean, b_output), "only its average is used here"


def _luminaire(b_node: Any, fold: Callable[[str], Value]) -> tuple[Value, str]:
    strength = fold("Strength")
    try:
        return product(strength, web_of(b_node).mean), "only its average is used here"
    except IesError as error:
        return product(strength, UNREADABLE), str(error)


def _channel(color: Color, alpha: float, b_output: Any) -> Value:
    return alpha if b_output.identifier == "Alpha" else color


def _mix(b_node: Any, b_output: Any, fold: Callable[[str], Value]) -> Value:
    if b_output.identifier != "Color":
        return 0.5
    total = (0.0, 0.0, 0.0)
    for name, share in zip(_MIX_INPUTS, _MIXES[b_node.type]):
        if share:
            value = fold(name)
            part = scale((value, value, value) if isinstance(value, float) else value, share)
            total = (total[0] + part[0], total[1] + part[1], total[2] + part[2])
    return total


def _shaped(value: float, b_output: Any) -> Value:
    """The value in the form of the output's type."""
    return value if b_output.type == "VALUE" else (value, value, value)
