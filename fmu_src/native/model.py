"""Writes model.c: what the C sources of a native FMU know of their scene's variables."""

import math
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from string import Template

from contact_core.state import RangeFlag

from ..runtime.guarded import LOG_CATEGORIES
from ..runtime.slave import OF_SOLVER
from ..variables import FIDELITY, Variable
from .names import c_name

_KINDS = {"Real": "REAL", "Integer": "INTEGER", "Boolean": "BOOLEAN", "String": "STRING"}
_CATEGORIES = {  # members of Category in model.h, in their order
    "OF_WARNINGS": "logStatusWarning",
    "OF_ERRORS": "logStatusError",
    "OF_VALIDITY": "logValidity",
    "OF_SOLVER": "logSolver",
}
_OF_RUNTIME = {"valid": "VALID", "fidelity_used": "FIDELITY_USED"}  # outputs that are not the contact's
_FRICTION, _FLAGS, _DERIVATIVE = "friction_force", "range_flags", "dfriction_d"
_LONGEST_TOKEN = 39  # characters
_LARGEST = sys.float_info.max
_NO_INPUT = '"none", "", "", PLACE_OF_INPUT(none), 0.0, 0.0, 1.0'  # C has no empty array

_FILE = Template(Path(__file__).with_name("model.c.in").read_text("ascii"))


def model_c(table: Sequence[Variable], token: str, states: str, *, ranges: bool = True) -> str:
    """Return the text of model.c for an FMU's variables, in order of value references, and its guid or token.

    `states`: token of stored states, which an FMU with the same one can restore.
    `ranges`: inputs outside theirs are refused; else all finite ones are taken.

    Raises ValueError for what the sources in C cannot hold: a long token, an input without a range, a text that is not
    empty at the start.
    """
    for text in (token, states):
        if len(text) > _LONGEST_TOKEN:
            raise ValueError(f"The token {text} is longer than {_LONGEST_TOKEN} characters. Give a UUID.")
    inputs = [v for v in table if v.causality == "input"]
    derivatives = [v.name for v in table if v.name.startswith(_DERIVATIVE)]
    fidelity = next((v.start for v in table if v.name == FIDELITY), 0.0)
    return _FILE.substitute(
        token=c_text(token),
        states=c_text(states),
        fidelity=_number(fidelity),
        follows=int(any(v.direct for v in table)),
        variables=_rows(_variable(v) for v in table),
        inputs=_rows(_input(v, ranges) for v in inputs) or f"    {{{_NO_INPUT}}}",
        derivatives=_rows(
            f"PLACE_OF_OUTPUT({name}), PLACE_OF_INPUT({name.removeprefix(_DERIVATIVE)})" for name in derivatives
        )
        or "    {0, 0}",
        derivatives_count=len(derivatives),
        friction=_place(_FRICTION, table),
        flag_output=_place(_FLAGS, table),
        flags=_rows(
            f"{int(flag)}u, {'OF_SOLVER' if flag in OF_SOLVER else 'OF_VALIDITY'}, {c_text(flag.text)}"
            for flag in RangeFlag
        ),
        categories=",\n".join(f"    [{place}] = {c_text(_known(name))}" for place, name in _CATEGORIES.items()),
    )


def _place(output: str, table: Sequence[Variable]) -> str:
    return (
        f"PLACE_OF_OUTPUT({output})" if any(v.name == output and v.causality == "output" for v in table) else "OUTPUTS"
    )


def c_text(text: str) -> str:
    """Return a text as a literal of C: ASCII, with other bytes of its UTF-8 as octal numbers."""
    plain = (chr(byte) if 32 <= byte < 127 and chr(byte) not in '"\\?' else f"\\{byte:03o}" for byte in text.encode())
    return f'"{"".join(plain)}"'


def _rows(rows: Iterable[str]) -> str:
    return ",\n".join(f"    {{{row}}}" for row in rows)


def _known(category: str) -> str:
    if category not in LOG_CATEGORIES:
        raise ValueError(f"{category} is no log category of the FMU: they are {', '.join(LOG_CATEGORIES)}.")
    return category


def _number(value: object) -> str:
    """Return a number as a literal of C that reads back to the same bits."""
    return repr(float(value))  # type: ignore[arg-type]


def _variable(v: Variable) -> str:
    role, place, start = _role(v), "0", "0.0"
    if role == "INPUT":
        place = f"PLACE_OF_INPUT({c_name(v.name)})"
    elif role in ("OUTPUT", "DERIVATIVE"):
        place = f"PLACE_OF_OUTPUT({c_name(v.name)})"
    if v.kind == "String" and v.start:
        raise ValueError(f"{v.name} starts as {v.start!r}: a text of a native FMU must start empty.")
    if v.has_start and v.kind != "String":
        start = _number(v.start)
    return f"{c_text(v.name)}, {_KINDS[v.kind]}, {role}, {place}, {start}"


def _role(v: Variable) -> str:
    if v.causality == "input":
        return "INPUT"
    if v.causality == "parameter":
        return "FIXED"
    if v.causality == "independent":
        return "TIME"
    return _OF_RUNTIME.get(v.name, "DERIVATIVE" if v.name.startswith(_DERIVATIVE) else "OUTPUT")


def _input(v: Variable, ranges: bool) -> str:
    least, most = (v.minimum, v.maximum) if ranges else (-_LARGEST, _LARGEST)
    if not (math.isfinite(least) and math.isfinite(most) and v.nominal and v.kind == "Real"):
        raise ValueError(f"The input {v.name} must be a Real with minimum, maximum and nominal value.")
    numbers = ", ".join(map(_number, (least, most, v.nominal)))
    return f"{c_text(v.name)}, {c_text(v.text)}, {c_text(v.unit)}, PLACE_OF_INPUT({c_name(v.name)}), {numbers}"
