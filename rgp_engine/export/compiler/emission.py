"""What worlds and lamps emit."""

from collections.abc import Sequence

from ..arithmetic import Color
from ..fold import Value, Varying, as_color
from .compiler import MOST_INSTRUCTIONS, Compiler, Register


def summed(c: Compiler, parts: Sequence[Value | Varying]) -> tuple[Color, Register | None]:
    """The sum of some emissions; where it varies a typical value, and what computes it."""
    colors = [as_color(part.typical if isinstance(part, Varying) else part) for part in parts]
    red, green, blue = (sum(color[channel] for color in colors) for channel in range(3))
    if not any(isinstance(part, Varying) for part in parts):
        return (red, green, blue), None
    total = c.register(0.0)
    for part in parts:
        total = c.vector_math("ADD", total, Register(part.register) if isinstance(part, Varying) else part)
    if len(c.instructions) > MOST_INSTRUCTIONS:
        c.report("its nodes are too many; what varies is replaced by a typical value")
        return (red, green, blue), None
    return (red, green, blue), total
