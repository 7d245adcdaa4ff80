"""Evaluates equations as they are printed in `Equations.lines`, for tests to hold laws against."""

import math
import re
from collections.abc import Mapping
from typing import Any

from scipy.special import erf

from contact_core.laws.equations import Equations
from contact_core.laws.symbols import BESIDE

FUNCTIONS = {
    "exp": math.exp,
    "ln": math.log,
    "log_{10}": math.log10,
    "tanh": math.tanh,
    "arsinh": math.asinh,
    "erf": erf,
    "max": max,
    "min": min,
    "√": math.sqrt,
}
TOKEN = re.compile(
    r"(?P<number>\d+(?:\.\d+)?)|(?P<function>√|(?:exp|ln|log_\{10\}|tanh|arsinh|erf|max|min)(?![\w′]))"
    r"|(?P<name>[^\W\d_]+′?(?:_(?:\{[^{}]*\}|[\w∞]))?)|(?P<open>[\[({])|(?P<close>[\])}])|(?P<sign>[-−+/·^,])"
)


def value_of(
    equations: Equations, symbol: str, law: Any, given: Mapping[str, float], *without: str, **swaps: str
) -> float:
    """Return the value of a symbol by the equations, from values of others and the fields of the law.

    `swaps` name what stands in the text, such as a ratio, by a symbol: rate="∂w/∂t"; `without` is left out of it.
    """
    names = {said: getattr(law, field) for said, field in equations.symbols.items() if hasattr(law, field)}
    names |= {"π": math.pi} | dict(given)
    text = BESIDE.join(equations.lines)
    for name, printed in [*swaps.items(), *(("", part) for part in without)]:
        text = text.replace(printed, name)
    phrases = [phrase.strip() for phrase in text.split(BESIDE)]
    sides = {left: right for left, sign, right in (phrase.partition(" = ") for phrase in phrases) if sign}

    def look_up(name: str) -> float:
        if name not in names:
            names[name] = evaluate(sides[name], look_up)
        return names[name]

    return evaluate(sides[symbol], look_up)


def evaluate(text: str, look_up: Any) -> float:
    """Return the value of the right side of an equation."""
    tokens, at = [], 0
    text = text.replace("|v|", "v").replace("|S|", "S")
    while at < len(text):
        found = TOKEN.match(text, at)
        if found:
            tokens.append((found.lastgroup or "", found[0]))
            at = found.end()
        elif text[at] == " ":
            at += 1
        else:
            raise ValueError(f"'{text[at]}' in {text}")
    value, rest = _sum(tokens, look_up)
    assert rest == [], rest
    return value


def _sum(tokens: list, look_up: Any) -> tuple[float, list]:
    value, tokens = _product(tokens, look_up)
    while tokens and tokens[0][1] in "+-−":
        sign = 1.0 if tokens[0][1] == "+" else -1.0
        term, tokens = _product(tokens[1:], look_up)
        value += sign * term
    return value, tokens


def _product(tokens: list, look_up: Any) -> tuple[float, list]:
    if tokens[0][1] in "-−":
        value, tokens = _product(tokens[1:], look_up)
        return -value, tokens
    value, tokens = _power(tokens, look_up)
    while tokens and (tokens[0][1] in "/·" or tokens[0][0] in ("number", "function", "name", "open")):
        divide = tokens[0][1] == "/"
        factor, tokens = _power(tokens[1:] if tokens[0][1] in "/·" else tokens, look_up)
        value = value / factor if divide else value * factor
    return value, tokens


def _power(tokens: list, look_up: Any) -> tuple[float, list]:
    base, tokens = _atom(tokens, look_up)
    if tokens and tokens[0][1] == "^":
        exponent, tokens = _atom(tokens[1:], look_up)
        return base**exponent, tokens
    return base, tokens


def _atom(tokens: list, look_up: Any) -> tuple[float, list]:
    (kind, text), *rest = tokens
    if kind == "number":
        return float(text), rest
    if kind == "name":
        return look_up(text), rest
    if kind == "open":
        value, rest = _sum(rest, look_up)
        assert rest[0][0] == "close", rest
        return value, rest[1:]
    if kind == "function":
        return _call(text, rest, look_up)
    raise ValueError(tokens)


def _call(name: str, tokens: list, look_up: Any) -> tuple[float, list]:
    if tokens[0][0] != "open":
        value, tokens = _atom(tokens, look_up)
        return FUNCTIONS[name](value), tokens
    arguments = []
    while tokens[0][0] == "open" or tokens[0][1] == ",":
        value, tokens = _sum(tokens[1:], look_up)
        arguments.append(value)
    assert tokens[0][0] == "close", tokens
    return FUNCTIONS[name](*arguments), tokens[1:]
