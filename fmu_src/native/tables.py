"""Tables of elementary.h: powers of two and logarithms, from Python's decimal numbers."""

import struct
from decimal import Decimal, localcontext

_PARTS = 256  # of an octave, of the powers
_STRETCHES = 256  # of an octave, of the logarithms
_LEAST = 0.6875 + 2.0**-10  # where the octave begins: 1 is the centre of a stretch
_KEPT = 36  # bits of the upper part of a logarithm: whole multiples of ln 2 and it add up exactly
_DIGITS = 60


def tables_h() -> str:
    with localcontext() as context:
        context.prec = _DIGITS
        two = Decimal(2).ln()
        upper = _cut(two, 32)
        lines = [
            "/* Tables of elementary.h, written by fmu_src.native.tables from decimal numbers. */",
            "",
            f"#define LN2 {float(two).hex()}",
            f"#define LN2_UPPER {upper.hex()} /* with zeros at its end */",
            f"#define LN2_LOWER {float(two - Decimal(upper)).hex()}",
            f"#define PARTS_PER_LN2 {float(_PARTS / two).hex()}",
            f"#define PART_UPPER {(upper / _PARTS).hex()} /* ln(2) / {_PARTS} */",
            f"#define PART_LOWER {float((two - Decimal(upper)) / _PARTS).hex()}",
            "",
            f"/* 2^(j/{_PARTS}), and what is missing in it, as a share of it */",
            f"static const double power_of_two[{_PARTS}][2] = {{",
            *(_row(*_apart((two * j / _PARTS).exp())) for j in range(_PARTS)),
            "};",
            "",
            f"/* An octave from LEAST_MANTISSA, the bits of {_LEAST}, in {_STRETCHES} stretches of as many doubles.",
            "   Of each the centre c, 1 / c, ln(c) with zeros at its end, and what is missing in it. */",
            f"#define LEAST_MANTISSA {_bits(_LEAST):#018x}u",
            f"static const double centre[{_STRETCHES}][4] = {{",
            *(_centre(j) for j in range(_STRETCHES)),
            "};",
            "",
        ]
    return "\n".join(lines)


def _centre(j: int) -> str:
    first = _bits(_LEAST) + j * _STRETCH
    ends = [_double(first), _double(first + _STRETCH)]
    centre = 0.5 * sum(ends) if not ends[0] < 1.0 < ends[1] else 1.0
    logarithm = Decimal(centre).ln()
    upper = _cut(logarithm, _KEPT)
    return _row(centre, float(1 / Decimal(centre)), upper, float(logarithm - Decimal(upper)))


_STRETCH = 2**52 // _STRETCHES


def _bits(value: float) -> int:
    return int(struct.unpack("<Q", struct.pack("<d", value))[0])


def _double(bits: int) -> float:
    return float(struct.unpack("<d", struct.pack("<Q", bits))[0])


def _cut(value: Decimal, bits: int) -> float:
    """Return a number with that many bits after the point."""
    return float(int((value * 2**bits).to_integral_value())) / 2.0**bits


def _apart(value: Decimal) -> tuple[float, float]:
    near = float(value)
    return near, float((value - Decimal(near)) / value)


def _row(*values: float) -> str:
    return "    {" + ", ".join(value.hex() for value in values) + "},"
