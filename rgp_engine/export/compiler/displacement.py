"""Displacement as a bump: the surface stays where it is, its shading normal follows the height."""

from typing import TYPE_CHECKING

from ..nodes import Input, Output, origin
from .sources import FILTER_WIDTH, heights

if TYPE_CHECKING:
    from .compiler import Compiler


def displace(c: "Compiler", entry: Input) -> bool:
    """Makes the displacement that feeds a material's output its shading normal; False for those along other directions
    than the normal. Shaders with a normal of their own keep it."""
    source = origin(entry)
    if isinstance(source, Input) or source.b_node.type != "DISPLACEMENT":
        return False
    height = source.find("Height")
    behind = None if height is None else origin(height)
    if not isinstance(behind, Output) or not c.varies(behind):
        return True
    bump = c.emit(
        "bump",
        strength=c.register(1.0),
        distance=c.input(source, "Scale"),
        normal=c.quantity("normal"),
        invert=False,
        **heights(c, source, FILTER_WIDTH),
    )
    c.normal = bump
    return True
