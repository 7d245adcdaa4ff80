"""What the elements of an array at run time come to: sums, extremes and their places, in loops."""

from collections.abc import Callable
from typing import Any

from . import code
from .grids import Grid, Places, Stored, Writer, looped, new, stored
from .values import Num, literal


def reduced(unit: Writer, name: str, grid: Grid, axis: Any, start: Num, more: Callable[[Num, Any], Any]) -> Any:
    """Return what elements come to along one axis, several, or all (None); `more` adds one to what there is."""
    axes = tuple(range(grid.ndim)) if axis is None else (axis,) if isinstance(axis, int) else tuple(axis)
    axes = tuple(a % grid.ndim for a in axes)

    def along(places: Places) -> Num:
        found = unit.variable(name, start.kind)
        unit.emit(code.Put(found.text, start.text))

        def add(inner: Places) -> None:
            unit.emit(code.Put(found.text, literal(more(found, grid.at(inner)), start.kind).text))

        looped(unit, grid.shape, axes, places, add)
        return found

    kept = [a for a in range(grid.ndim) if a not in axes]
    if not kept:
        return along((0,) * grid.ndim)
    found = new(unit, name, tuple(grid.shape[a] for a in kept), start.kind)

    def each_of(places: Places) -> None:
        total = along(places)
        own, place = found.place(tuple(places[a] for a in kept))
        unit.writes(own)
        unit.emit(code.Put(own, total.text, place))

    looped(unit, grid.shape, kept, (0,) * grid.ndim, each_of)
    return found


def extreme_place(unit: Writer, grid: Grid, axis: int | None, sign: str) -> Any:
    """Return the first place of the largest (sign >) or smallest (<) element."""
    base = stored(unit, grid)
    if axis is None:
        base = Stored((base.size,), base.data)
    axis = 0 if axis is None else axis % base.ndim

    def along(places: Places) -> Num:
        found = unit.variable("place", "i")
        unit.emit(code.Put(found.text, "0"))

        def look(inner: Places) -> None:
            best = base.at((*inner[:axis], found, *inner[axis + 1 :]))
            test = f"{base.at(inner).text} {sign} {best.text}"
            place = inner[axis]
            unit.emit(code.If(test, [code.Put(found.text, literal(place, "i").text)], []))

        looped(unit, base.shape, [axis], places, look)
        return found

    kept = [a for a in range(base.ndim) if a != axis]
    if not kept:
        return along((0,))
    found = new(unit, "places", tuple(base.shape[a] for a in kept), "i")

    def each_of(places: Places) -> None:
        best = along(places)
        own, place = found.place(tuple(places[a] for a in kept))
        unit.writes(own)
        unit.emit(code.Put(own, best.text, place))

    looped(unit, base.shape, kept, (0,) * base.ndim, each_of)
    return found
