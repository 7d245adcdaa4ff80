"""Linear systems in the form of the C source: matrices whose entries are numbers or expressions in parameters."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from .description import Model, Variable

Entry = float | str
Rows = Sequence[Sequence[Entry]]


def linear(
    variables: Sequence[Variable],
    A: Rows,
    B: Rows,
    C: Rows,
    D: Rows,
    starts: Sequence[Entry],
    b: Sequence[Entry] = (),
    c: Sequence[Entry] = (),
    text: str = "",
) -> Model:
    """x' = A x + B u + b, y = C x + D u + c, x(0) = `starts`.

    Rows and columns stand in the order in which inputs and outputs are listed in `variables`. An expression is written
    as in C, with names of parameters.
    """
    B = [[*row, shift] for row, shift in zip(B, b or [0.0] * len(A), strict=True)]
    D = [[*row, shift] for row, shift in zip(D, c or [0.0] * len(C), strict=True)]
    inputs = [v.name for v in variables if v.causality == "input"]
    parameters = [v.name for v in variables if v.causality == "parameter"]
    outputs = [v.name for v in variables if v.causality == "output"]
    lines = [f"#define N_X {len(A)}", f"#define N_U {len(inputs) + 1}", f"#define N_Y {len(C)}"]
    lines.append("static inline void matrices(const double *p, double A[N_X][N_X], double B[N_X][N_U],")
    lines.append("                            double C[N_Y][N_X], double D[N_Y][N_U])\n{\n    (void)p;")
    for matrix, rows in zip("ABCD", (A, B, C, D), strict=True):
        for i, row in enumerate(rows):
            lines += [f"    {matrix}[{i}][{j}] = {_c(entry, parameters)};" for j, entry in enumerate(row)]
    lines.append("}\nstatic inline void starts(const double *p, double *x)\n{\n    (void)p;")
    lines += [f"    x[{i}] = {_c(entry, parameters)};" for i, entry in enumerate(starts)]
    lines.append("}")

    needs = {}
    for name, states, direct in zip(outputs, C, D, strict=True):
        expressions = [*states, *direct, *(x0 for x0, weight in zip(starts, states, strict=True) if _counts(weight))]
        named = {word for e in expressions for word in _names(e)}
        fed = {u for u, weight in zip(inputs, direct, strict=False) if _counts(weight)}
        needs[name] = tuple(sorted(named | fed))
    complete = tuple(replace(v, needs=needs[v.name]) if v.name in needs else v for v in variables)
    return Model("linear", complete, len(A), "\n".join(lines), slopes=True, partials=True, text=text)


def _counts(weight: Entry) -> bool:
    return isinstance(weight, str) or weight != 0.0


def _names(entry: Entry) -> list[str]:
    return re.findall(r"[A-Za-z_]\w*", entry) if isinstance(entry, str) else []


def _c(entry: Entry, parameters: list[str]) -> str:
    """An entry in C; names become places in the values `p`."""
    if not isinstance(entry, str):
        return repr(float(entry))
    unknown = set(_names(entry)) - set(parameters)
    if unknown:
        raise ValueError(f"the expression {entry!r} names {sorted(unknown)}, which are no parameters")
    return re.sub(r"[A-Za-z_]\w*", lambda name: f"p[V_{name[0]}]", entry)
