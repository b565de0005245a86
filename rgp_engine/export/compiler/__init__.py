"""From node trees to programs that run at every hit: `Compiler` is a `Folder` that computes what is not constant.

`compiler.py` walks the tree; `sources.py`, `patterns.py`, `mapping.py` and `nodes.py` say what each kind of node
becomes; `images.py` brings the pixels.
"""

from .compiler import MOST_INSTRUCTIONS, Compiler, Register
from .displacement import displace
from .emission import summed

__all__ = ["MOST_INSTRUCTIONS", "Compiler", "Register", "displace", "summed"]
