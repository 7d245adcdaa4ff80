"""What the functions of Python, math and numpy are in C."""

import builtins
import contextlib
import dataclasses
import math
from collections.abc import Callable
from statistics import NormalDist
from typing import Any

import numpy as np

from contact_core.laws import elementary
from contact_core.state import state as states

from .values import Num, Untranslatable, as_double, both, call, compare, either, is_dynamic, kind_of, literal

Handler = Callable[..., Any]


@dataclasses.dataclass(frozen=True)
class Span:
    """A range with an end that is known at run time only."""

    start: Any
    stop: Any
    step: int = 1


def elementwise(function: Handler) -> Handler:
    """Return a function that takes arrays, too."""

    def on_arrays(*operands: Any) -> Any:
        if any(isinstance(x, np.ndarray) for x in operands):
            return np.frompyfunc(function, len(operands), 1)(*operands)
        return function(*operands)

    return on_arrays


def _called(name: str, known: Handler) -> Handler:
    def one(*operands: Any) -> Any:
        return call(name, *operands) if any(isinstance(x, Num) for x in operands) else known(*operands)

    return elementwise(one)


def chosen(test: Any, one: Any, other: Any) -> Any:
    if not isinstance(test, Num):
        return one if test else other
    kind = "d" if "d" in (kind_of(one), kind_of(other)) else "i"
    first, second = literal(one, kind), literal(other, kind)
    if first.text == second.text:
        return one
    return Num(f"{test.at_least(3)} ? {first.at_least(3)} : {second.at_least(2)}", kind, 1)


def _pair(name: str, first: bool) -> Handler:
    """Return min or max of two numbers, as Python's: of equal ones the first."""

    def one(x: Any, y: Any) -> Any:
        if not (isinstance(x, Num) or isinstance(y, Num)):
            return min(x, y) if first else max(x, y)
        if kind_of(x) != "d" and kind_of(y) != "d":
            return chosen(compare("<" if first else ">", y, x), y, x)
        if isinstance(x, Num) and isinstance(y, Num) and x.text == y.text:
            return x
        return call(name, x, y)

    return elementwise(one)


minimum, maximum = _pair("smaller", True), _pair("larger", False)


def _of_many(pair: Handler) -> Handler:
    def reduced(*operands: Any, default: Any = None) -> Any:
        items = list(operands[0]) if len(operands) == 1 else list(operands)
        if not items:
            return default
        found = items[0]
        for item in items[1:]:
            found = pair(found, item)
        return found

    return reduced


def _any(items: Any) -> Any:
    found: Any = False
    for item in _flat(items):
        if not isinstance(item, Num):
            if item:
                return True
        else:
            found = item if found is False else either(found, item)
    return found


def _all(items: Any) -> Any:
    found: Any = True
    for item in _flat(items):
        if not isinstance(item, Num):
            if not item:
                return False
        else:
            found = item if found is True else both(found, item)
    return found


def _flat(items: Any) -> list[Any]:
    return list(items.flat) if isinstance(items, np.ndarray) else list(items)


def _float(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        value = value.item()
    return as_double(value) if isinstance(value, Num) else float(value)


def _int(value: Any) -> Any:
    if isinstance(value, Num) and value.kind == "d":
        return Num(f"whole_number({value.text})", "i")
    return value if isinstance(value, Num) else int(value)


def _isinstance(value: Any, kind: Any) -> bool:
    if not isinstance(value, Num):
        return isinstance(value, kind)
    kinds = kind if isinstance(kind, tuple) else (kind,)
    return any(issubclass({"d": float, "i": int, "b": bool}[value.kind], each) for each in kinds)


def _where(test: Any, one: Any, other: Any) -> Any:
    return elementwise(chosen)(test, one, other)


def _divide(one: Any, other: Any, out: Any = None, where: Any = None) -> Any:
    if where is None:
        return one / other
    return _where(where, one / other, out)


def _like(number: float) -> Handler:
    def made(array: Any, *rest: Any) -> Any:
        value = rest[0] if rest else number
        if isinstance(array, np.ndarray):
            found = np.empty(array.shape, object if isinstance(value, Num) else np.float64)
            found[...] = value
            return found
        return value

    return made


def _array(items: Any, *rest: Any) -> Any:
    if is_dynamic(items):
        return items if isinstance(items, np.ndarray) else np.array(items, object)
    return np.asarray(items, *rest)


def _asarray(value: Any, *rest: Any) -> Any:
    """Return an array, but leave a number one."""
    return value if isinstance(value, Num) else _array(value, *rest)


def _changed(record: Any, /, **values: Any) -> Any:
    """Return a record with other fields and without its cached properties."""
    copy = object.__new__(type(record))
    copy.__dict__.update({f.name: vars(record)[f.name] for f in dataclasses.fields(record)})
    copy.__dict__.update(values)
    return copy


def _sum(items: Any, start: Any = 0) -> Any:
    found = start
    for item in items:
        found = found + item
    return found


def _logaddexp(one: Any, other: Any) -> Any:
    larger, smaller = maximum(one, other), minimum(one, other)
    return larger + call("own_log1p", call("own_exp", smaller - larger))


def _copysign(size: Any, sign: Any) -> Any:
    """Return a size, known to be positive or zero, with a sign."""
    return chosen(compare("<", sign, 0.0), -size, size)


_NAMED: dict[str, tuple[Handler, ...]] = {
    "own_exp": (math.exp, np.exp, elementary.exp),
    "own_expm1": (math.expm1, np.expm1, elementary.expm1),
    "own_log": (math.log, np.log, elementary.log),
    "own_log1p": (math.log1p, np.log1p, elementary.log1p),
    "own_log10": (math.log10, np.log10, elementary.log10),
    "sqrt": (math.sqrt, np.sqrt, elementary.sqrt),
    "own_tanh": (math.tanh, np.tanh, elementary.tanh),
    "own_asinh": (math.asinh, np.arcsinh),
    "own_hypot": (math.hypot, np.hypot),
    "cos": (math.cos, np.cos),
    "sin": (math.sin, np.sin),
    "atan2": (math.atan2, np.arctan2),
    "cbrt": (np.cbrt,),
    "fabs": (abs, np.abs, np.fabs),
}

HANDLERS: dict[Any, Handler] = {
    **{function: _called(name, functions[0]) for name, functions in _NAMED.items() for function in functions},
    builtins.min: _of_many(minimum),
    builtins.max: _of_many(maximum),
    np.minimum: minimum,
    np.maximum: maximum,
    elementary.minimum: minimum,
    elementary.maximum: maximum,
    builtins.any: _any,
    builtins.all: _all,
    builtins.sum: _sum,
    builtins.float: _float,
    builtins.int: _int,
    builtins.bool: lambda value: compare("!=", value, 0) if isinstance(value, Num) and value.kind != "b" else value,
    builtins.isinstance: _isinstance,
    builtins.len: len,
    builtins.zip: lambda *items, strict=False: list(zip(*items, strict=strict)),
    builtins.enumerate: lambda *items: list(enumerate(*items)),
    builtins.tuple: lambda items=(): tuple(items),
    builtins.list: lambda items=(): list(items),
    builtins.dict: lambda *items, **rest: dict(*items, **rest),
    np.where: _where,
    np.divide: _divide,
    np.empty: lambda shape, *_: np.zeros(shape),
    np.empty_like: _like(0.0),
    np.zeros_like: _like(0.0),
    np.ones_like: _like(1.0),
    np.full_like: _like(0.0),
    np.array: _array,
    np.asarray: _asarray,
    np.ravel: lambda array: array.ravel(),
    np.broadcast_arrays: lambda *arrays: list(arrays),
    np.vdot: lambda one, other: _sum(a * b for a, b in zip(one.flat, other.flat, strict=True)),
    np.logaddexp: elementwise(_logaddexp),
    np.sign: elementwise(lambda x: compare(">", x, 0.0) - compare("<", x, 0.0)),
    np.copysign: elementwise(_copysign),
    math.copysign: _copysign,
    math.isfinite: lambda value: compare("<", call("fabs", value), math.inf),
    NormalDist.inv_cdf: lambda normal, share: normal.mean + normal.stdev * call("own_normal_score", share),
    states.changed: _changed,
    dataclasses.replace: _changed,
    np.errstate: lambda **_: contextlib.nullcontext(),
}

# of numbers that are known, too: lists in place of iterators that end, numbers in place of arrays without a shape
ALWAYS = {np.empty, np.empty_like, builtins.zip, builtins.enumerate, np.zeros_like, np.ones_like, np.full_like}


def _along(function: Handler) -> Handler:
    """Return a function of the items of an array: of all, or with axis = -1 of those along the last axis."""

    def reduced(array: Any, axis: int | None = None, where: Any = True, initial: Any = None) -> Any:
        if initial is not None:
            array = _where(where, array, initial)
            return function([initial, *array.flat])
        if axis is None:
            return function(list(array.flat))
        if axis != -1:
            raise Untranslatable(f"axis = {axis}: only the last one is needed so far")
        found = np.empty(array.shape[:-1], object)
        for place in np.ndindex(found.shape):
            found[place] = function(list(array[place]))
        return found

    return reduced


ARRAY_METHODS: dict[str, Handler] = {
    "max": _along(_of_many(maximum)),
    "min": _along(_of_many(minimum)),
    "sum": _along(_sum),
    "any": _any,
    "all": _all,
    "tolist": lambda array: array.tolist(),
    "ravel": lambda array: array.ravel(),
    "astype": lambda array, kind: elementwise(_int if np.dtype(kind).kind in "iu" else _float)(array),
}
