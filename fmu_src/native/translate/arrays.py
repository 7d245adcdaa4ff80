"""Arrays of numbers at run time: what a function of numbers gives for each element."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np

from . import grids
from .units import Unit
from .values import Untranslatable, is_number, kind_of, rebuilt


def on_arrays(unit: Unit, name: str, function: Callable[..., Any], operands: list[Any]) -> Any:
    """Return what a function gives for each element of arrays, numbers and tuples of them, as arrays in its form."""
    found_in = list(arrays_in(operands))
    shape = np.broadcast_shapes(*(array.shape for array in found_in))
    if any(isinstance(array, grids.Grid) for array in found_in):
        return _derived(unit, function, operands, shape)
    found = [function(*_at(operands, place, shape)) for place in np.ndindex(shape)]
    if found and isinstance(found[0], tuple):  # several numbers become several arrays
        return tuple(_shaped(unit, name, list(each), shape) for each in zip(*found, strict=True))
    return _shaped(unit, name, found, shape)


def _derived(unit: Unit, function: Callable[..., Any], operands: list[Any], shape: tuple[int, ...]) -> grids.Derived:
    """Return an array at run time; its elements are computed where it is filled."""

    def element(places: grids.Places) -> Any:
        return function(*[_of_place(unit, value, places) for value in operands])

    found, _ = unit.branch(lambda: element((0,) * len(shape)))
    if not is_number(found):
        raise Untranslatable(f"a law gives {type(found).__name__} for elements of arrays")
    return grids.Derived(shape, kind_of(found), element, costs=True)


def _of_place(unit: Unit, value: Any, places: grids.Places) -> Any:
    if isinstance(value, np.ndarray):
        value = grids.of(unit, value)
    if isinstance(value, grids.Grid):
        return value.at(grids.aligned(value.shape, places))
    if isinstance(value, tuple) and any(True for _ in arrays_in(value)):
        return rebuilt(value, [_of_place(unit, item, places) for item in value])
    return value


def arrays_in(values: Iterable[Any]) -> Iterator[Any]:
    """Yield the arrays among values and in tuples of them."""
    for value in values:
        if isinstance(value, np.ndarray | grids.Grid):
            yield value
        elif isinstance(value, tuple):
            yield from arrays_in(value)


def _at(values: Iterable[Any], place: tuple[int, ...], shape: tuple[int, ...]) -> list[Any]:
    """Return values with an element in the place of each array; arrays are broadcast to a shape."""
    return [
        np.broadcast_to(value, shape)[place]
        if isinstance(value, np.ndarray)
        else rebuilt(value, _at(value, place, shape))
        if isinstance(value, tuple) and any(True for _ in arrays_in(value))
        else value
        for value in values
    ]


def _shaped(unit: Unit, name: str, elements: list[Any], shape: tuple[int, ...]) -> Any:
    """Return an array of numbers, each with a name."""
    found = np.empty(shape, object)
    for place, element in zip(np.ndindex(shape), elements, strict=True):
        found[place] = unit.named("_".join(map(str, (name, *place))), element)
    return found
