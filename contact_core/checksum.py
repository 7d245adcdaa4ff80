"""CRC-32 of bytes joined from parts whose CRC-32 is known, without reading them again.

A CRC is a polynomial over GF(2) modulo that of CRC-32 (reflected: the coefficient of x^0 is the highest bit). Bytes
appended to others multiply the checksum of those by x to the power of their bits.
"""

from functools import lru_cache

_POLYNOMIAL = 0xEDB88320
_ONE = 1 << 31


def joined(first: int, second: int, size: int) -> int:
    """`zlib.crc32` of two parts together: of the first, of the second, and the second's number of bytes."""
    return _product(_power(8 * size), first) ^ second


def _product(a: int, b: int) -> int:
    found = 0
    while a:
        if a & _ONE:
            found ^= b
        a = (a << 1) & 0xFFFFFFFF
        b = (b >> 1) ^ (_POLYNOMIAL if b & 1 else 0)
    return found


@lru_cache(maxsize=64)
def _power(exponent: int) -> int:
    """That power of x."""
    found, square = _ONE, _ONE >> 1
    while exponent:
        if exponent & 1:
            found = _product(square, found)
        square, exponent = _product(square, square), exponent >> 1
    return found
