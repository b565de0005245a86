"""Blender's hash of names, which its random numbers of objects come from."""

_ALL = 0xFFFFFFFF


def name_hash(name: str) -> int:
    """32 bits from an object's name: its bytes as digits to the base 37, then Bob Jenkins' lookup3 of that and 0."""
    digits = 0
    for byte in name.encode():
        digits = (digits * 37 + byte) & _ALL
    start = (0xDEADBEEF + (2 << 2) + 13) & _ALL
    a, b, c = (start + digits) & _ALL, start, start
    c = _mixed(c, b, 14)
    a = _mixed(a, c, 11)
    b = _mixed(b, a, 25)
    c = _mixed(c, b, 16)
    a = _mixed(a, c, 4)
    b = _mixed(b, a, 14)
    return _mixed(c, b, 24)


def _mixed(x: int, y: int, bits: int) -> int:
    rotated = ((y << bits) | (y >> (32 - bits))) & _ALL
    return ((x ^ y) - rotated) & _ALL
