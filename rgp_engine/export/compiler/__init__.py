"""From node trees to programs that run at every hit: `Compiler` is a `Folder` that computes what is not constant.

`compiler.py` walks the tree, `nodes.py` and `sources.py` say what each kind of node becomes, `images.py` brings the
pixels.
"""

from .compiler import MOST_INSTRUCTIONS, Compiler

__all__ = ["MOST_INSTRUCTIONS", "Compiler"]
