"""Arrays of numbers at run time: what they are in C, and their elements, views and loops.

`Stored` lies in a C array, row after row; `View` picks elements of one; `Derived` computes each where it is asked for.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, ClassVar, Protocol

import numpy as np

from . import code, constants, values
from .values import ADD, Num, Untranslatable, array_kind, is_number, kind_of, literal, parts, rebuilt

LARGE = 64  # elements, above which what is computed with an array is a loop

Shape = tuple[int, ...]
Places = tuple[Any, ...]  # whole numbers, known or not


class Grid(values.Grid):
    """An array of numbers at run time."""

    __array_ufunc__ = None  # numpy leaves them alone
    __hash__: ClassVar[None] = None  # type: ignore[assignment]

    def __init__(self, shape: Shape, kind: str) -> None:
        self.shape, self.kind = tuple(map(int, shape)), kind  # of an element

    @property
    def size(self) -> int:
        return math.prod(self.shape)

    @property
    def ndim(self) -> int:
        return len(self.shape)

    def at(self, places: Places) -> Any:
        raise NotImplementedError

    def row(self, k: int) -> "Grid":
        raise NotImplementedError

    def setflags(self, *, write: bool) -> None:
        """Mark as read-only: C arrays are constant where nothing sets them."""

    def __len__(self) -> int:
        return self.shape[0]

    def __iter__(self) -> Iterator[Any]:
        return (self.at((k,)) if self.ndim == 1 else self.row(k) for k in range(self.shape[0]))

    def __bool__(self) -> bool:
        raise Untranslatable("an array at run time decides here: write any or all")


class Pointer(Num):
    """Where a part of a C array begins."""

    __slots__ = ("base", "offset")

    def __init__(self, base: str, offset: Any, kind: str) -> None:
        place = literal(offset, "i").at_least(ADD + 1)
        super().__init__(f"{base} + {place}", kind, ADD)
        self.base, self.offset = base, offset


class Stored(Grid):
    """An array in C; `data` is its name, or where it begins."""

    def __init__(self, shape: Shape, data: Num) -> None:
        super().__init__(shape, data.kind[0])
        self.data = data

    def members(self) -> list[tuple[str, Any]]:
        """Return its C array."""
        return [("", self.data)]

    def with_members(self, members: list[Any]) -> "Stored":
        return Stored(self.shape, members[0])

    def at(self, places: Places) -> Num:
        base, place = self.place(places)
        return Num(f"{base}[{place}]", self.kind)

    def row(self, k: int) -> Grid:
        return row_of(self, [k])

    def place(self, places: Places) -> tuple[str, str]:
        """Return the name of the array, and the place of an element in it."""
        flat = _flat(places, self.shape)
        if isinstance(self.data, Pointer):
            return self.data.base, literal(self.data.offset + flat, "i").text
        return self.data.text, literal(flat, "i").text


class View(Grid):
    """Elements of a stored array: `to` says which from places in the view."""

    def __init__(self, shape: Shape, base: Stored, to: Callable[[Places], Places]) -> None:
        super().__init__(shape, base.kind)
        self.base, self.to = base, to

    def at(self, places: Places) -> Num:
        return self.base.at(self.to(places))

    def place(self, places: Places) -> tuple[str, str]:
        """Return the name of the array, and the place of an element in it."""
        return self.base.place(self.to(places))

    def row(self, k: int) -> Grid:
        return View(self.shape[1:], self.base, lambda places: self.to((k, *places)))


class Derived(Grid):
    """What `element` gives for each place; `costs`: more than a few operations."""

    def __init__(self, shape: Shape, kind: str, element: Callable[[Places], Any], *, costs: bool) -> None:
        super().__init__(shape, kind)
        self.element, self.costs = element, costs

    def at(self, places: Places) -> Any:
        return self.element(places)


class Masked(Derived):
    """Elements that a mask picks: their number is not known, but their sum is; the others are 0."""


class Writer(Protocol):
    """What arrays ask of a C function under construction; `units.Unit` is one."""

    def emit(self, statement: code.Statement) -> None:
        """Add a statement."""

    def fresh(self, name: str) -> str:
        """Return a new name."""

    def variable(self, name: str, kind: str) -> Num:
        """Return a variable that is set later."""

    def branch(self, work: Callable[[], Any]) -> tuple[Any, code.Block]:
        """Return what some work gives, and the statements that it makes."""

    def counts(self, index: str) -> None:
        """Take note that a name counts the rounds of a loop over an array."""

    def trusts(self, place: str) -> bool:
        """Return True for a place that is in every array it is used for."""
        ...

    def writes(self, name: str) -> None:
        """Take note that an array is written."""


def _flat(places: Places, shape: Shape) -> Any:
    found: Any = 0
    for place, size in zip(places, shape, strict=True):
        found = found * size + place if not isinstance(found, int) or found else place
    return found


def table(array: np.ndarray) -> Stored:
    """Return a known array as one in C."""
    return Stored(array.shape, constants.named(array))


def of(unit: Writer, value: Any, name: str = "values") -> Grid:
    """Return an array or a list of numbers as an array at run time."""
    if isinstance(value, Grid):
        return value
    array = value if isinstance(value, np.ndarray) else listed(value)
    if array.dtype != object:
        return table(array)
    found = new(unit, name, array.shape, "d" if any(kind_of(x) == "d" for x in array.flat) else "i")
    for place, item in np.ndenumerate(array):
        unit.emit(code.Put(found.data.text, literal(item, found.kind).text, found.place(place)[1]))
    return found


def listed(values: Any) -> np.ndarray:
    """Return nested lists of numbers as an array, of objects if it is not known."""
    if is_number(values):
        return np.array(values, object if isinstance(values, Num) else None)
    items = [listed(each) for each in values]
    if any(each.dtype == object for each in items):
        items = [each.astype(object) for each in items]
    return np.stack(items) if items else np.empty(0)


def new(unit: Writer, name: str, shape: Shape, kind: str) -> Stored:
    """Return an array whose elements are set later."""
    return Stored(shape, unit.variable(name, array_kind(kind, math.prod(shape))))


def stored(unit: Writer, value: Any, name: str = "values") -> Stored:
    """Return an array that lies in C."""
    grid = of(unit, value, name)
    if isinstance(grid, Stored):
        return grid
    found = new(unit, name, grid.shape, grid.kind)
    fill(unit, found, grid)
    return found


def is_array(number: Any) -> bool:
    """Return True for an array, or the number that stands for one in C."""
    return isinstance(number, Grid) or "[" in number.kind


def give(unit: Writer, out: str, array: Num | Grid) -> None:
    """Set an array that a function returns."""
    if isinstance(array, Grid):
        fill(unit, Stored(array.shape, Num(out, array_kind(array.kind, array.size))), array)
    else:
        unit.emit(code.set_to(out, array.kind, array.text))


def settled(unit: Writer, value: Any, name: str = "values", *, cheap: bool = True) -> Any:
    """Return a value whose arrays all lie in C; `cheap`: also those of a few operations."""
    if isinstance(value, Grid):
        return stored(unit, value, name) if cheap or getattr(value, "costs", False) else value
    if not _is_lazy(value):
        return value
    found = [(part, item) for part, item in parts(value) or ()]
    return rebuilt(
        value, [settled(unit, item, f"{name}_{part}" if part else name, cheap=cheap) for part, item in found]
    )


def _is_lazy(value: Any) -> bool:
    if isinstance(value, Num) or values.is_known(value):
        return False
    if isinstance(value, Grid):
        return not isinstance(value, Stored)
    return any(map(_is_lazy, values.members(value)))


def both_stored(one: Any, other: Any) -> tuple[Any, Any]:
    """Return known arrays as arrays in C where one of the two is that, or where they are large."""
    pair = one, other
    wanted = any(isinstance(x, Stored) for x in pair) or all(isinstance(x, np.ndarray) and x.size > LARGE for x in pair)
    possible = all(isinstance(x, Stored) or (isinstance(x, np.ndarray) and x.dtype != object) for x in pair)
    if not (wanted and possible and one.shape == other.shape):
        return pair
    return tuple(table(x) if isinstance(x, np.ndarray) else x for x in pair)  # type: ignore[return-value]


def copied(unit: Writer, value: Any, name: str) -> Stored:
    """Return an array of its own with the values of another."""
    grid = of(unit, value, name)
    found = new(unit, name, grid.shape, grid.kind)
    fill(unit, found, grid)
    return found


def fill(unit: Writer, target: Stored | View, source: Any) -> None:
    """Set all elements of an array to those of another of its shape, or to a number."""

    def one(places: Places) -> None:
        value = source.at(places) if isinstance(source, Grid) else source
        name, place = target.place(places)
        unit.writes(name)
        unit.emit(code.Put(name, literal(value, target.kind).text, place))

    each(unit, target.shape, one)


def each(unit: Writer, shape: Shape, work: Callable[[Places], None]) -> None:
    """Do some work for each place, in loops."""
    looped(unit, shape, range(len(shape)), (0,) * len(shape), work)


def looped(unit: Writer, shape: Shape, axes: Iterable[int], places: Places, work: Callable[[Places], None]) -> None:
    """Do some work for each place along some axes, in loops."""
    left = [axis for axis in axes if shape[axis] > 1]
    if not left:
        work(places)
        return
    axis, *rest = left
    index = unit.fresh("ijklmn"[axis] if axis < 6 else "i")
    unit.counts(index)
    inner = (*places[:axis], Num(index, "i"), *places[axis + 1 :])
    _, body = unit.branch(lambda: looped(unit, shape, rest, inner, work))
    unit.emit(code.Loop(f"for (int {index} = 0; {index} < {shape[axis]}; ++{index})", body))


def elementwise(unit: Writer, function: Callable[..., Any], operands: Sequence[Any], *, costs: bool) -> Derived:
    """Return what a function of numbers gives for each place of arrays, which are broadcast."""
    grids = [x if is_number(x) or x is None else of(unit, x) for x in operands]
    shape = np.broadcast_shapes(*(x.shape for x in grids if isinstance(x, Grid)))
    size = math.prod(shape)
    grids = [
        stored(unit, x) if isinstance(x, Derived) and x.costs and x.size < size else x for x in grids
    ]  # else computed again and again
    costs |= any(isinstance(x, Derived) and x.costs for x in grids)

    def element(places: Places) -> Any:
        return function(*(x.at(aligned(x.shape, places)) if isinstance(x, Grid) else x for x in grids))

    first = (Num("x", x.kind) if isinstance(x, Grid) else x for x in grids)
    if not costs:
        kind = kind_of(function(*first))
    else:
        found, _ = unit.branch(lambda: element((0,) * len(shape)))
        if not is_number(found):
            raise Untranslatable(f"a function of numbers gives {type(found).__name__} for elements of arrays")
        kind = kind_of(found)
    return Derived(shape, kind, element, costs=costs)


def aligned(shape: Shape, places: Places) -> Places:
    """Return the place in an array that was broadcast to more."""
    rest = places[len(places) - len(shape) :]
    return tuple(0 if size == 1 else place for size, place in zip(shape, rest, strict=True))


def broadcast(unit: Writer, grid: Grid, shape: Shape) -> Grid:
    base = stored(unit, grid) if isinstance(grid, Derived) and grid.costs else grid
    if isinstance(base, Stored):
        return View(shape, base, lambda places: aligned(base.shape, places))
    return Derived(shape, base.kind, lambda places: base.at(aligned(base.shape, places)), costs=False)


def reshaped(unit: Writer, grid: Grid, shape: Sequence[int]) -> Stored:
    """Return an array in another shape."""
    base = stored(unit, grid)
    rest = [n for n in shape if n != -1]
    whole = tuple(base.size // math.prod(rest) if n == -1 else int(n) for n in shape)
    assert math.prod(whole) == base.size
    return Stored(whole, base.data)


def transposed(grid: Grid) -> Grid:
    """Return an array with its axes in reverse order."""
    shape = grid.shape[::-1]
    if isinstance(grid, Stored):
        return View(shape, grid, lambda places: places[::-1])
    return Derived(shape, grid.kind, lambda places: grid.at(places[::-1]), costs=getattr(grid, "costs", False))


def base_of(array: Num) -> str:
    """Return the name of the C array that an array lies in."""
    return array.base if isinstance(array, Pointer) else array.text


def row_of(grid: Stored, numbers: list[Any]) -> Stored:
    """Return a part by the first places, which lies in one piece."""
    rest = grid.shape[len(numbers) :]
    offset = _flat((*numbers, *(0 for _ in rest)), grid.shape)
    if isinstance(offset, int) and offset == 0 and not isinstance(grid.data, Pointer):
        return Stored(rest, Num(grid.data.text, array_kind(grid.kind, math.prod(rest))))
    base, before = (grid.data.base, grid.data.offset) if isinstance(grid.data, Pointer) else (grid.data.text, 0)
    return Stored(rest, Pointer(base, before + offset, array_kind(grid.kind, math.prod(rest))))
