"""What the functions and methods of numpy are for arrays at run time."""

import builtins
import math
import operator
from collections.abc import Callable
from typing import Any

import numpy as np

from . import grid_parts, grid_sums, grids
from .grids import Derived, Grid, Stored, Writer, elementwise
from .library import HANDLERS, Span, chosen, maximum, minimum
from .values import Num, Untranslatable, both, call, compare, either, is_dynamic, is_number

_SIGNS = {operator.add, operator.sub, operator.mul, operator.truediv, operator.neg, operator.pos, operator.and_}
_SIGNS |= {operator.or_, operator.floordiv, operator.mod}


def takes(operands: Any, function: Any = None) -> bool:
    """Return True if any operand is an array at run time, or what is computed of them is better one."""
    if any(isinstance(x, Grid) for x in operands):
        return True
    arrays = [x for x in operands if isinstance(x, np.ndarray)]
    if (
        function is operator.matmul
        or not arrays
        or not all(is_number(x) or isinstance(x, np.ndarray) for x in operands)
    ):
        return False
    shape = np.broadcast_shapes(*(x.shape for x in arrays))
    return math.prod(shape) > grids.LARGE and is_dynamic(list(operands))


def operated(unit: Writer, function: Callable[..., Any], *operands: Any) -> Any:
    """Return what an operator gives for arrays."""
    if function is operator.matmul:
        return _product(unit, *(grids.of(unit, x) for x in operands))
    return elementwise(unit, function, operands, costs=function not in _SIGNS)


def compared(unit: Writer, sign: str, one: Any, other: Any) -> Derived:
    """Return comparisons of elements."""
    return elementwise(unit, lambda x, y: compare(sign, x, y), [one, other], costs=False)


def inverted(unit: Writer, grid: Grid) -> Derived:
    return elementwise(unit, lambda x: ~x if isinstance(x, Num) else not x, [grid], costs=False)


def attribute(unit: Writer, grid: Grid, name: str) -> Any:
    """Return a property of an array."""
    if name == "T":
        return grids.transposed(grid)
    if name in ("shape", "size", "ndim"):
        return getattr(grid, name)
    if name == "flat":
        return grids.reshaped(unit, grid, (-1,))
    raise Untranslatable(f"'{name}' of an array at run time: it has no counterpart in C so far")


def method(unit: Writer, grid: Grid, name: str, operands: list[Any], named: dict[str, Any]) -> Any:
    """Return what a method of an array gives."""
    found = _METHODS.get(name)
    if found is None or (isinstance(grid, grids.Masked) and name != "sum"):
        raise Untranslatable(f"{name} of an array at run time: it has no counterpart in C so far")
    return found(unit, grid, *operands, **named)


def called(unit: Writer, function: Any, operands: list[Any], named: dict[str, Any]) -> Any:
    """Return what a function of numpy gives for arrays at run time; NotImplemented if it is not known."""
    if function is builtins.range and is_dynamic(operands):
        return Span(*operands) if len(operands) > 1 else Span(0, operands[0])
    if function in (np.full, np.append) and is_dynamic(operands):
        return _FUNCTIONS[function](unit, *operands, **named)
    given = [*operands, *named.values()]
    flat = [y for x in given for y in (x if isinstance(x, list | tuple) else [x])]
    many = isinstance(function, np.ufunc) and takes(operands)
    if not function.__hash__ or not (many or any(isinstance(x, Grid) for x in flat)):
        return NotImplemented
    if function in _FUNCTIONS:
        return _FUNCTIONS[function](unit, *operands, **named)
    if function in _BY_ELEMENT or isinstance(function, np.ufunc):
        each = _BY_ELEMENT.get(function) or _one(function)
        return elementwise(unit, each, given, costs=function not in _CHEAP)
    return NotImplemented


def _one(function: Any) -> Callable[..., Any]:
    if function not in HANDLERS:
        raise Untranslatable(f"{function!r} of an array at run time: it has no counterpart in C so far")
    return HANDLERS[function]


def _product(unit: Writer, one: Grid, other: Grid) -> Any:
    """Return the product of matrices and vectors."""
    if other.ndim == 1:
        found = elementwise(unit, operator.mul, [one, other], costs=False)
    elif one.ndim == 1:
        found = elementwise(unit, operator.mul, [one, grids.transposed(other)], costs=False)
    else:
        rows = grid_parts.picked(unit, one, (Ellipsis, slice(None), None, slice(None)))
        found = elementwise(unit, operator.mul, [rows, grids.transposed(other)], costs=False)
    return _sum(unit, found, -1)


def _sum(unit: Writer, grid: Grid, axis: Any = None, dtype: Any = None) -> Any:
    start = Num("0.0") if grid.kind == "d" else Num("0", "i")
    return grid_sums.reduced(unit, "total", grid, axis, start, lambda total, x: total + x)


def _mean(unit: Writer, grid: Grid, axis: Any = None) -> Any:
    axes = range(grid.ndim) if axis is None else [axis] if isinstance(axis, int) else axis
    count = float(math.prod(grid.shape[a] for a in axes))
    total = _sum(unit, grid, axis)
    return total / count if isinstance(total, Num) else operated(unit, operator.truediv, total, count)


def _extreme(pair: Callable[..., Any], beyond: float) -> Callable[..., Any]:
    def found(unit: Writer, grid: Grid, axis: Any = None, where: Any = None, initial: float | None = None) -> Any:
        if where is not None:
            grid = elementwise(unit, chosen, [where, grid, initial], costs=False)
        start = Num("-INFINITY" if beyond < 0.0 else "INFINITY") if initial is None else Num(repr(initial))
        if grid.kind != "d":
            start = Num(str(int(math.copysign(2**31 - 1, beyond))), "i")
        return grid_sums.reduced(unit, "extreme", grid, axis, start, pair)

    return found


def _any(unit: Writer, grid: Grid, axis: Any = None) -> Any:
    return grid_sums.reduced(unit, "some", grid, axis, Num("0", "b"), either)


def _all(unit: Writer, grid: Grid, axis: Any = None) -> Any:
    return grid_sums.reduced(unit, "every", grid, axis, Num("1", "b"), both)


def _tolist(unit: Writer, grid: Grid) -> Any:
    base = grids.stored(unit, grid)
    if base.ndim == 1:
        return list(base)
    return [_tolist(unit, row) for row in base]


def _stacked(unit: Writer, items: Any, *_: Any, axis: int = 0) -> Grid:
    """Return arrays as one, along a new first axis."""
    if isinstance(items, Grid):
        return grids.copied(unit, items, "values")
    rows = [grids.of(unit, item) for item in items]
    if axis != 0:
        raise Untranslatable(f"axis = {axis}: only the first one is needed so far")
    kind = "d" if any(row.kind == "d" for row in rows) else "i"
    found = grids.new(unit, "stacked", (len(rows), *rows[0].shape), kind)
    for k, row in enumerate(rows):
        grid_parts.put(unit, found, k, row)
    return found


def _joined(unit: Writer, *items: Any) -> Stored:
    """Return vectors one after the other."""
    parts = [grids.of(unit, np.atleast_1d(grids.listed(x)) if is_number(x) else x) for x in items]
    kind = "d" if any(part.kind == "d" for part in parts) else "i"
    found, at = grids.new(unit, "joined", (sum(part.size for part in parts),), kind), 0
    for part in parts:
        grid_parts.put(unit, found, slice(at, at + part.size), part)
        at += part.size
    return found


def _reshape(unit: Writer, grid: Grid, *shape: Any, order: str = "C") -> Stored:
    return grids.reshaped(unit, grid, shape[0] if isinstance(shape[0], tuple) else shape)


def _flat(unit: Writer, grid: Grid, *_: Any) -> Stored:
    return grids.reshaped(unit, grid, (-1,))


def _astype(unit: Writer, grid: Grid, kind: Any, *_: Any) -> Grid:
    whole = np.dtype(kind).kind in "iu"
    if whole and grid.kind == "d":
        return elementwise(unit, HANDLERS[builtins.int], [grid], costs=False)
    if not whole and grid.kind != "d":
        return elementwise(unit, lambda x: HANDLERS[builtins.float](x), [grid], costs=False)
    return grid


def _same(unit: Writer, grid: Grid, *_: Any) -> Grid:
    return grid


def _own(unit: Writer, grid: Any, *_: Any, order: str = "C") -> Grid:
    return _stacked(unit, grid)


def _as_array(unit: Writer, value: Any, *kind: Any) -> Grid:
    found = value if isinstance(value, Grid) else _stacked(unit, value)
    return _astype(unit, found, *kind) if kind else found


def _full(unit: Writer, shape: Any, value: Any) -> Grid:
    return elementwise(unit, lambda _, x: x, [np.zeros(shape), value], costs=False)


def _divide(unit: Writer, one: Any, other: Any, out: Any = None, where: Any = None) -> Grid:
    if where is None:
        return elementwise(unit, operator.truediv, [one, other], costs=False)
    return elementwise(unit, lambda test, x, y, rest: chosen(test, x / y, rest), [where, one, other, out], costs=False)


def _along_axis(unit: Writer, grid: Grid, places: Grid, axis: int) -> Grid:
    own = grids.stored(unit, grid)
    at = grids.broadcast(unit, grids.stored(unit, places, "places"), _but(own.shape, axis, places.shape[axis]))
    return Derived(at.shape, own.kind, lambda p: own.at((*p[:axis], at.at(p), *p[axis + 1 :])), costs=False)


def _but(shape: tuple[int, ...], axis: int, size: int) -> tuple[int, ...]:
    return (*shape[:axis], size, *shape[axis + 1 :])


def _outer(unit: Writer, one: Any, other: Any) -> Grid:
    rows = grid_parts.picked(unit, grids.of(unit, one), (slice(None), None))
    return elementwise(unit, operator.mul, [rows, other], costs=False)


def _tile(unit: Writer, grid: Grid, count: int) -> Grid:
    base = grids.stored(unit, grid)
    return Derived((count * base.size,), base.kind, lambda p: base.at((p[0] % base.size,)), costs=False)


def _norm(unit: Writer, grid: Grid) -> Any:
    return call("sqrt", _sum(unit, elementwise(unit, lambda x: x * x, [grids.stored(unit, grid)], costs=False)))


def _sign(x: Any) -> Any:
    return compare(">", x, 0.0) - compare("<", x, 0.0)


def _is_finite(x: Any) -> Any:
    return HANDLERS[math.isfinite](x)


def _known_like(value: float) -> Callable[..., Any]:
    def found(unit: Writer, grid: Grid, *_: Any) -> Any:
        return np.full(grid.shape, value)

    return found


_largest, _smallest = _extreme(maximum, -1.0), _extreme(minimum, 1.0)

OF_GRIDS = ("mean", "argmax", "argmin")  # methods that small arrays have not

_METHODS: dict[str, Callable[..., Any]] = {
    "sum": _sum,
    "mean": _mean,
    "max": _largest,
    "min": _smallest,
    "any": _any,
    "all": _all,
    "argmax": lambda unit, grid, axis=None: grid_sums.extreme_place(unit, grid, axis, ">"),
    "argmin": lambda unit, grid, axis=None: grid_sums.extreme_place(unit, grid, axis, "<"),
    "tolist": _tolist,
    "reshape": _reshape,
    "ravel": _flat,
    "astype": _astype,
    "copy": lambda unit, grid: grids.copied(unit, grid, "values"),
    "item": lambda unit, grid: grids.reshaped(unit, grid, (1,)).at((0,)),
}

_FUNCTIONS: dict[Any, Callable[..., Any]] = {
    np.sum: _sum,
    np.max: _largest,
    np.min: _smallest,
    np.any: _any,
    np.all: _all,
    np.argmax: _METHODS["argmax"],
    np.argmin: _METHODS["argmin"],
    np.array: _own,
    np.stack: _stacked,
    np.asarray: _as_array,
    np.ascontiguousarray: _as_array,
    np.full: _full,
    np.outer: _outer,
    np.tile: _tile,
    np.linalg.norm: _norm,
    np.append: _joined,
    np.concatenate: lambda unit, items: _joined(unit, *items),
    np.reshape: _reshape,
    np.ravel: _flat,
    np.divide: _divide,
    np.broadcast_to: grids.broadcast,
    np.take_along_axis: _along_axis,
    np.zeros_like: _known_like(0.0),
    np.empty_like: _known_like(0.0),
    np.ones_like: _known_like(1.0),
}

_CHEAP = {np.where, np.minimum, np.maximum, np.isfinite, np.sign, np.abs}
_BY_ELEMENT: dict[Any, Callable[..., Any]] = {
    np.where: chosen,
    np.isfinite: _is_finite,
    np.sign: _sign,
    np.minimum: minimum,
    np.maximum: maximum,
    **{
        function: each
        for function, each in HANDLERS.items()
        if getattr(function, "__module__", "").endswith("elementary")
    },
}
