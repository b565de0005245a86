"""Measures accuracy against time: renders a part of the picture with many settings and compares with a reference."""

from .run import Request, measure

__all__ = ["Request", "measure"]
