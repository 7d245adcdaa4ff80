"""Tables of elementary.h: powers of two and logarithms, from Python's decimal numbers."""

from decimal import Decimal, localcontext

_PARTS = 64  # of an octave, of the powers
_FIRST, _LAST = 90, 182  # of the centres of logarithms, in 1/128: from below sqrt(1/2) to above sqrt(2)
_KEPT = 36  # bits of the upper part of a logarithm: whole multiples of ln 2 and it add up exactly
_DIGITS = 60


def tables_h() -> str:
    """Return the text of tables.h."""
    with localcontext() as context:
        context.prec = _DIGITS
        two = Decimal(2).ln()
        upper = _cut(two, 32)
        lines = [
            "/* Tables of elementary.h, written by fmu_src.native.tables from decimal numbers. */",
            "",
            f"#define LN2_UPPER {upper.hex()} /* with zeros at its end */",
            f"#define LN2_LOWER {float(two - Decimal(upper)).hex()}",
            f"#define PARTS_PER_LN2 {float(_PARTS / two).hex()}",
            f"#define PART_UPPER {(upper / _PARTS).hex()} /* ln(2) / {_PARTS} */",
            f"#define PART_LOWER {float((two - Decimal(upper)) / _PARTS).hex()}",
            "",
            f"/* 2^(j/{_PARTS}), and what is missing in it */",
            f"static const double power_of_two[{_PARTS}][2] = {{",
            *(_row(*_apart((two * j / _PARTS).exp())) for j in range(_PARTS)),
            "};",
            "",
            "/* centre c = k / 128: 1 / c, ln(c) with zeros at its end, and what is missing in it */",
            f"#define FIRST_CENTRE {_FIRST}",
            f"static const double centre[{_LAST - _FIRST + 1}][3] = {{",
            *(_centre(k) for k in range(_FIRST, _LAST + 1)),
            "};",
            "",
        ]
    return "\n".join(lines)


def _centre(k: int) -> str:
    logarithm = (Decimal(k) / 128).ln()
    upper = _cut(logarithm, _KEPT)
    return _row(float(Decimal(128) / k), upper, float(logarithm - Decimal(upper)))


def _cut(value: Decimal, bits: int) -> float:
    """Return a number with that many bits after the point."""
    return float(int((value * 2**bits).to_integral_value())) / 2.0**bits


def _apart(value: Decimal) -> tuple[float, float]:
    near = float(value)
    return near, float(value - Decimal(near))


def _row(*values: float) -> str:
    return "    {" + ", ".join(value.hex() for value in values) + "},"
