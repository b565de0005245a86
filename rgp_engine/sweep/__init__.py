"""Measures accuracy against time: renders a part of the picture with many settings and compares with a reference."""

from .run import Request, measure
from .shot import request_stop

__all__ = ["Request", "measure", "request_stop"]
