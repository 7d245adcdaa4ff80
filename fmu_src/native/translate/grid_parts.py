"""Parts of arrays at run time: by numbers, slices, places and masks."""

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np

from . import code, grids
from .grids import Derived, Grid, Masked, Places, Stored, View, Writer, aligned, broadcast, elementwise, fill, stored
from .library import chosen
from .values import Num, is_number, kind_of, literal


def picked(unit: Writer, grid: Grid, key: Any) -> Any:
    """Return an element or a part of an array."""
    if _is_mask(key):
        return _masked(unit, grid, key)
    keys = _whole_key(key, grid.ndim)
    if len(keys) == grid.ndim and all(is_number(k) for k in keys):
        return grid.at(tuple(_inside(unit, k, n) for k, n in zip(keys, grid.shape, strict=True)))
    numbers = list(itertools.takewhile(is_number, keys))
    if isinstance(grid, Stored) and all(isinstance(k, slice) and k == slice(None) for k in keys[len(numbers) :]):
        return grids.row_of(grid, [_inside(unit, k, n) for k, n in zip(numbers, grid.shape, strict=False)])
    return _part(unit, grid, keys)


def _is_mask(key: Any) -> bool:
    if isinstance(key, np.ndarray) and key.dtype == object:
        return key.size > 0 and all(kind_of(x) == "b" for x in key.flat)
    return isinstance(key, Grid) and key.kind == "b"


def _masked(unit: Writer, grid: Grid, mask: Any) -> Masked:
    found = elementwise(unit, lambda test, x: chosen(test, x, 0.0), [mask, grid], costs=False)
    return Masked(found.shape, grid.kind, found.element, costs=found.costs)


def _whole_key(key: Any, ndim: int) -> list[Any]:
    keys = list(key) if isinstance(key, tuple) else [key]
    own = sum(1 for k in keys if k is not None and k is not Ellipsis)
    full = [slice(None)] * (ndim - own)
    at = next((i for i, k in enumerate(keys) if k is Ellipsis), None)
    return [*keys, *full] if at is None else [*keys[:at], *full, *keys[at + 1 :]]


def _inside(unit: Writer, place: Any, size: int) -> Any:
    """Return a place counted from the start; one that inputs decide is the nearest in the array, and none beside it."""
    if not isinstance(place, Num):
        return place if place >= 0 else place + size
    return place if unit.trusts(place.text) else Num(f"place_inside({place.text}, {size})", "i")


def _part(unit: Writer, grid: Grid, keys: list[Any]) -> Grid:
    """Return a part by numbers, slices, new axes and arrays of places (these side by side)."""
    arrays = [k for k in keys if isinstance(k, Grid | np.ndarray | list)]
    among = np.broadcast_shapes(*(k.shape if isinstance(k, Grid) else np.shape(k) for k in arrays)) if arrays else ()
    steps: list[Callable[[Places], Any]] = []  # from places in the part to one along each axis
    shape: list[int] = []
    at: int | None = None
    axis = 0
    for k in keys:
        if k is None:
            shape.append(1)
            continue
        size, axis = grid.shape[axis], axis + 1
        if is_number(k):
            steps.append(_always(_inside(unit, k, size)))
        elif isinstance(k, slice):
            span = range(*k.indices(size))
            steps.append(_along(len(shape), span))
            shape.append(len(span))
        else:
            if at is None:
                at = len(shape)
                shape.extend(among)
            steps.append(_by_places(unit, at, stored(unit, k, "places"), len(among), size))

    def to(places: Places) -> Places:
        return tuple(step(places) for step in steps)

    base = stored(unit, grid) if isinstance(grid, Derived) else grid
    if isinstance(base, View):
        own = base
        return View(tuple(shape), own.base, lambda places: own.to(to(places)))
    assert isinstance(base, Stored)
    return View(tuple(shape), base, to)


def _always(place: Any) -> Callable[[Places], Any]:
    return lambda _: place


def _along(axis: int, span: range) -> Callable[[Places], Any]:
    return lambda places: span.start + places[axis] * span.step if span.start else places[axis] * span.step


def _by_places(unit: Writer, axis: int, chosen: Stored, count: int, size: int) -> Callable[[Places], Any]:
    return lambda places: _inside(unit, chosen.at(aligned(chosen.shape, places[axis : axis + count])), size)


def put(unit: Writer, grid: Stored | View, key: Any, value: Any) -> None:
    """Set an element or a part of an array."""
    keys = _whole_key(key, grid.ndim)
    if len(keys) == grid.ndim and all(is_number(k) for k in keys):
        name, place = grid.place(tuple(_inside(unit, k, n) for k, n in zip(keys, grid.shape, strict=True)))
        unit.writes(name)
        unit.emit(code.Put(name, literal(value, grid.kind).text, place))
        return
    part = picked(unit, grid, key)
    if not is_number(value):
        value = broadcast(unit, stored(unit, value), part.shape)
    fill(unit, part, value)
