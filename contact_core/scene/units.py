"""Units at the border: text such as "1.26 GPa" or "90 degC" becomes a float in SI, once.

A dimension is the tuple of exponents of (m, kg, s, K, rad). Where rad/s are asked for, 1/s will do.
"""

import math
import re
from functools import lru_cache

from ..errors import SceneError
from ..quantities import CELSIUS

Dimension = tuple[int, int, int, int, int]

# factor to SI and exponents of (m, kg, s, K, rad)
_BASE: dict[str, tuple[float, Dimension]] = {
    "m": (1.0, (1, 0, 0, 0, 0)),
    "g": (1e-3, (0, 1, 0, 0, 0)),
    "s": (1.0, (0, 0, 1, 0, 0)),
    "K": (1.0, (0, 0, 0, 1, 0)),
    "N": (1.0, (1, 1, -2, 0, 0)),
    "Pa": (1.0, (-1, 1, -2, 0, 0)),
    "J": (1.0, (2, 1, -2, 0, 0)),
    "W": (1.0, (2, 1, -3, 0, 0)),
    "rad": (1.0, (0, 0, 0, 0, 1)),
    "min": (60.0, (0, 0, 1, 0, 0)),
    "h": (3600.0, (0, 0, 1, 0, 0)),
    "rpm": (2.0 * math.pi / 60.0, (0, 0, -1, 0, 1)),
    "P": (0.1, (-1, 1, -1, 0, 0)),
    "eV": (1.602176634e-19, (2, 1, -2, 0, 0)),
    "mol": (6.02214076e23, (0, 0, 0, 0, 0)),  # a number: kJ/mol are energies per molecule
    "St": (1e-4, (2, 0, -1, 0, 0)),
    "l": (1e-3, (3, 0, 0, 0, 0)),  # as data sheets have densities: kg/l, g/ml
    "L": (1e-3, (3, 0, 0, 0, 0)),
    "%": (1e-2, (0, 0, 0, 0, 0)),
    "1": (1.0, (0, 0, 0, 0, 0)),
}
_PREFIX = {"n": 1e-9, "u": 1e-6, "\u00b5": 1e-6, "\u03bc": 1e-6, "m": 1e-3, "c": 1e-2, "k": 1e3, "M": 1e6, "G": 1e9}
_PREFIXABLE = {"m", "g", "s", "K", "N", "Pa", "J", "W", "P", "St", "l", "L"}
_MEANT = {  # what people write for a unit
    "C": "degC", "c": "degC", "°": "degC", "deg": "degC", "celsius": "degC", "Celsius": "degC", "sec": "s",
    "secs": "s", "second": "s", "seconds": "s", "minute": "min", "minutes": "min", "hr": "h", "hrs": "h", "hour": "h",
    "hours": "h", "RPM": "rpm", "micron": "um", "microns": "um", "cst": "cSt", "CSt": "cSt", "cp": "cP", "mps": "m/s",
    "GPA": "GPa", "MPA": "MPa", "newton": "N", "n": "N", "KN": "kN", "Kg": "kg", "percent": "%",
}  # fmt: skip
_COMMA = re.compile(r"\s*[+-]?\d*,\d")
_THOUSANDS = re.compile(r"\s*[+-]?[1-9]\d{0,2}(,\d{3})+(?!\d)")
_TOKEN = re.compile(r"([A-Za-z\u00b5\u03bc%]+|1)(?:\^?(-?\d+))?$")
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+-]?inf|nan)\s*(.*)$")


@lru_cache(maxsize=256)
def unit(text: str) -> tuple[float, Dimension]:
    """Factor to SI and dimension of a unit such as "mm", "GPa^-1", "Pa.s", "m3/s", "W/(m K)"."""
    if text in ("", "1"):
        return 1.0, (0, 0, 0, 0, 0)
    head, _, tail = text.replace("(", "").replace(")", "").partition("/")
    factor, exponents = 1.0, [0, 0, 0, 0, 0]
    for part, sign in ((head, 1), (tail, -1)):
        for token in re.split(r"[\s.*]+", part.strip()):
            if not token:
                continue
            match = _TOKEN.match(token)
            known = match and _lookup(match[1])
            if not match or not known:
                said = f" Did you mean '{_MEANT[token]}'?" if token in _MEANT else ""
                where = f"'{token}' in '{text}'" if token != text else f"'{token}'"
                raise SceneError(f"{where} is not a unit known here.{said} Use SI units and prefixes.")
            power = sign * int(match[2] or 1)
            factor *= known[0] ** power
            for axis in range(5):
                exponents[axis] += power * known[1][axis]
    return factor, (exponents[0], exponents[1], exponents[2], exponents[3], exponents[4])


def _lookup(symbol: str) -> tuple[float, Dimension] | None:
    if symbol in _BASE:
        return _BASE[symbol]
    prefix, base = symbol[:1], symbol[1:]
    if prefix in _PREFIX and base in _PREFIXABLE:
        return _PREFIX[prefix] * _BASE[base][0], _BASE[base][1]
    return None


def parse(value: object, si_unit: str, name: str) -> float:
    """Return `value` in `si_unit`.

    `value` is text with a unit, or a plain number where the quantity has no dimension.
    Raises SceneError with the field's `name`, the value and what would be right.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise SceneError(f"{name} = {value!r} is not a number. Write for example {_example(si_unit)}.")
    if isinstance(value, str):
        _refuse_marks(value, name)
        match = _NUMBER.match(value)
        if not match:
            raise SceneError(f"{name} = {value!r} does not start with a number. Write {_example(si_unit)}.")
        number, given = float(match[1]), match[2].strip()
    else:
        number, given = float(value) if abs(value) < 1e308 else math.inf, ""
    if not math.isfinite(number):
        raise SceneError(f"{name} = {value!r} is not finite. Write for example {_example(si_unit)}.")
    if given in ("degC", "°C"):
        if si_unit != "K":
            raise SceneError(f"{name} = {value!r} is a temperature, but {name} is in {si_unit or 'no unit'}.")
        return number + CELSIUS
    wanted = _without_angle(si_unit)
    if not given and any(wanted):
        raise SceneError(f"{name} = {value!r} has no unit. Write for example {_example(si_unit)}.")
    try:
        factor, _ = unit(given)
    except SceneError as error:
        raise SceneError(f"{name} = {value!r}: {error}") from None
    if _without_angle(given) != wanted:
        raise SceneError(
            f"{name} = {value!r} has the wrong unit: it must be convertible to {si_unit or 'a plain number'}."
        )
    # divide by the inverse of small factors: 8 um gives exactly 8e-6
    return number / round(1.0 / factor) if factor < 1 and _is_whole(1.0 / factor) else number * factor


def _refuse_marks(text: str, name: str) -> None:
    """Raise SceneError for a decimal comma and for semicolons."""
    if ";" in text:
        raise SceneError(f"{name} = {text!r} has a ';'. Give one number with its unit, and nothing after it.")
    if _COMMA.match(text):
        point = re.sub(r"^(\s*[+-]?),", r"\g<1>0,", text).replace(",", ".", 1)
        thousands = f" If it separates thousands, write '{text.replace(',', '')}'." if _THOUSANDS.match(text) else ""
        raise SceneError(f"{name} = {text!r} has a comma, and decimals have a point: write '{point}'.{thousands}")


def _without_angle(text: str) -> tuple[int, ...]:
    return unit(text)[1][:4]


def _is_whole(x: float) -> bool:
    return abs(x - round(x)) < 1e-6 * x


def _example(si_unit: str) -> str:
    usual = {"K": "'80 degC'", "m": "'20 nm' or '10 mm'", "Pa": "'1.2 GPa'"}
    return usual.get(si_unit, f"'1.0 {si_unit}'") if si_unit else "0.5"
