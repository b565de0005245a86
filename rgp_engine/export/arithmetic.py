"""The arithmetic of Blender's value and color nodes, on single constants."""

import colorsys
import math
from collections.abc import Callable

Color = tuple[float, float, float]

BLACK: Color = (0.0, 0.0, 0.0)
WHITE: Color = (1.0, 1.0, 1.0)

# Weights of Rec. 709 primaries in luminance (ITU-R BT.709).
_LUMINANCE = (0.2126, 0.7152, 0.0722)


def luminance(color: Color) -> float:
    """Relative luminance of a linear Rec. 709 color."""
    return sum(weight * channel for weight, channel in zip(_LUMINANCE, color))


def scale(color: Color, factor: float) -> Color:
    """Every channel times a number."""
    return (color[0] * factor, color[1] * factor, color[2] * factor)


def multiply(a: Color, b: Color) -> Color:
    """Channel by channel."""
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])


def product(a: float | Color, b: float | Color) -> float | Color:
    """Channel by channel; a number multiplies every channel."""
    if isinstance(a, float):
        return a * b if isinstance(b, float) else scale(b, a)
    return scale(a, b) if isinstance(b, float) else multiply(a, b)


def lerp(a: float, b: float, factor: float) -> float:
    """From a at 0 to b at 1."""
    return a + (b - a) * factor


def clamp(value: float, low: float = 0.0, high: float = 1.0) -> float:
    """The value, or the end of the range it lies beyond."""
    return min(max(value, low), high)


def _divide(a: float, b: float) -> float:
    return a / b if b else 0.0


def _power(a: float, b: float) -> float:
    try:
        result = math.pow(a, b)
    except (ValueError, OverflowError):
        return 0.0
    return result


def _wrap(value: float, high: float, low: float) -> float:
    span = high - low
    return value - span * math.floor((value - low) / span) if span else low


MATH: dict[str, Callable[[float, float, float], float]] = {
    "ADD": lambda a, b, c: a + b,
    "SUBTRACT": lambda a, b, c: a - b,
    "MULTIPLY": lambda a, b, c: a * b,
    "DIVIDE": lambda a, b, c: _divide(a, b),
    "MULTIPLY_ADD": lambda a, b, c: a * b + c,
    "POWER": lambda a, b, c: _power(a, b),
    "LOGARITHM": lambda a, b, c: math.log(a, b) if a > 0 and b > 0 and b != 1 else 0.0,
    "SQRT": lambda a, b, c: math.sqrt(max(a, 0.0)),
    "INVERSE_SQRT": lambda a, b, c: 1.0 / math.sqrt(a) if a > 0 else 0.0,
    "ABSOLUTE": lambda a, b, c: abs(a),
    "EXPONENT": lambda a, b, c: math.exp(min(a, 700.0)),
    "MINIMUM": lambda a, b, c: min(a, b),
    "MAXIMUM": lambda a, b, c: max(a, b),
    "LESS_THAN": lambda a, b, c: float(a < b),
    "GREATER_THAN": lambda a, b, c: float(a > b),
    "SIGN": lambda a, b, c: float((a > 0) - (a < 0)),
    "COMPARE": lambda a, b, c: float(abs(a - b) <= max(c, 1.2e-7)),
    "ROUND": lambda a, b, c: math.floor(a + 0.5),
    "FLOOR": lambda a, b, c: math.floor(a),
    "CEIL": lambda a, b, c: math.ceil(a),
    "TRUNC": lambda a, b, c: math.trunc(a),
    "FRACT": lambda a, b, c: a - math.floor(a),
    "MODULO": lambda a, b, c: math.fmod(a, b) if b else 0.0,
    "FLOORED_MODULO": lambda a, b, c: a - b * math.floor(a / b) if b else 0.0,
    "WRAP": lambda a, b, c: _wrap(a, b, c),
    "SNAP": lambda a, b, c: math.floor(_divide(a, b)) * b,
    "PINGPONG": lambda a, b, c: abs(_wrap(a - b, 2.0 * b, 0.0) - b) if b else 0.0,
    "SINE": lambda a, b, c: math.sin(a),
    "COSINE": lambda a, b, c: math.cos(a),
    "TANGENT": lambda a, b, c: math.tan(a),
    "ARCSINE": lambda a, b, c: math.asin(a) if abs(a) <= 1 else 0.0,
    "ARCCOSINE": lambda a, b, c: math.acos(a) if abs(a) <= 1 else 0.0,
    "ARCTANGENT": lambda a, b, c: math.atan(a),
    "ARCTAN2": lambda a, b, c: math.atan2(a, b),
    "RADIANS": lambda a, b, c: math.radians(a),
    "DEGREES": lambda a, b, c: math.degrees(a),
}
"""Operations of the Math node."""


def _soft_light(a: float, b: float) -> float:
    return (1.0 - a) * b * a + a * (1.0 - (1.0 - a) * (1.0 - b))


BLEND: dict[str, Callable[[float, float], float]] = {
    "MIX": lambda a, b: b,
    "ADD": lambda a, b: a + b,
    "SUBTRACT": lambda a, b: a - b,
    "MULTIPLY": lambda a, b: a * b,
    "DIVIDE": _divide,
    "DIFFERENCE": lambda a, b: abs(a - b),
    "EXCLUSION": lambda a, b: max(a + b - 2.0 * a * b, 0.0),
    "DARKEN": min,
    "LIGHTEN": max,
    "SCREEN": lambda a, b: 1.0 - (1.0 - a) * (1.0 - b),
    "OVERLAY": lambda a, b: 2.0 * a * b if a < 0.5 else 1.0 - 2.0 * (1.0 - a) * (1.0 - b),
    "SOFT_LIGHT": _soft_light,
    "LINEAR_LIGHT": lambda a, b: a + 2.0 * b - 1.0,
}
"""Blend types of the Mix node that work on one channel at a time, at factor 1."""


def blend(kind: str, a: Color, b: Color, factor: float) -> Color | None:
    """Result of the Mix node; None for the blend types that mix hue and saturation."""
    operation = BLEND.get(kind)
    if operation is None:
        return None
    mixed = [lerp(p, operation(p, q), factor) for p, q in zip(a, b)]
    return (mixed[0], mixed[1], mixed[2])


def hue_saturation(color: Color, hue: float, saturation: float, value: float) -> Color:
    """The Hue/Saturation/Value node at factor 1; hue 0.5 changes nothing."""
    h, s, v = colorsys.rgb_to_hsv(*color)
    shifted = colorsys.hsv_to_rgb((h + hue + 0.5) % 1.0, clamp(s * saturation), v * value)
    return (max(shifted[0], 0.0), max(shifted[1], 0.0), max(shifted[2], 0.0))


def bright_contrast(color: Color, bright: float, contrast: float) -> Color:
    """The Brightness/Contrast node."""
    gain, offset = 1.0 + contrast, bright - contrast * 0.5
    changed = [max(gain * channel + offset, 0.0) for channel in color]
    return (changed[0], changed[1], changed[2])
