"""Blender's hashes, which its random numbers of objects and of parts of a mesh come from: Bob Jenkins' lookup3."""

from typing import Any

import numpy as np
import numpy.typing as npt

_ALL = 0xFFFFFFFF
_START = 0xDEADBEEF + 13

Words = npt.NDArray[Any]
"""Of 64 bits without sign, below 2³²."""


def name_hash(name: str) -> int:
    """32 bits from an object's name: its bytes as digits to the base 37, hashed together with 0."""
    digits = 0
    for byte in name.encode():
        digits = (digits * 37 + byte) & _ALL
    start = (_START + (2 << 2)) & _ALL
    return int(_finished((start + digits) & _ALL, start))


def unit_hash(numbers: npt.NDArray[np.integer]) -> npt.NDArray[np.float32]:
    """For each of some numbers of 32 bits another one from 0 to 1."""
    start = (_START + (1 << 2)) & _ALL
    hashed = _finished((numbers.astype(np.uint64) + start) & _ALL, start)
    return (np.asarray(hashed).astype(np.float32) / np.float32(_ALL)).astype(np.float32)


def _finished(a: int | Words, start: int) -> int | Words:
    """The end of lookup3, whose other two words are still those it starts with."""
    b: int | Words = start
    c: int | Words = start
    c = _mixed(c, b, 14)
    a = _mixed(a, c, 11)
    b = _mixed(b, a, 25)
    c = _mixed(c, b, 16)
    a = _mixed(a, c, 4)
    b = _mixed(b, a, 14)
    return _mixed(c, b, 24)


def _mixed(x: int | Words, y: int | Words, bits: int) -> int | Words:
    rotated = ((y << bits) | (y >> (32 - bits))) & _ALL
    # Above zero, so that words without a sign hold it.
    return ((x ^ y) + (_ALL + 1) - rotated) & _ALL
