"""What each kind of node becomes, by Blender's `node.type`."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from ..nodes import Output
from . import nodes, patterns, sources

if TYPE_CHECKING:
    from .compiler import Compiler, Operand

SOURCES: "dict[str, Callable[[Compiler, Output], bool]]" = {**sources.SOURCES, **patterns.SOURCES}
"""Nodes whose result differs from point to point by itself, and whether it does."""

NODES: "dict[str, Callable[[Compiler, Output], Operand | None]]" = {
    **sources.NODES,
    **patterns.NODES,
    **nodes.NODES,
}
"""Instructions for a node's output; None where this use of the node is not known."""
