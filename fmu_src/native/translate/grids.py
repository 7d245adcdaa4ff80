"""Arrays of numbers at run time: what they are in C, and their elements, views and loops.

`Stored` lies in a C array, row after row. `View` picks elements of one, `Derived` computes each where it is asked for.
Names, parameters and results are stored ones.
"""

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, ClassVar

import numpy as np

from . import code, values
from .library import chosen
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
        """Number of elements."""
        return math.prod(self.shape)

    @property
    def ndim(self) -> int:
        """Number of axes."""
        return len(self.shape)

    def at(self, places: Places) -> Any:
        """Return an element."""
        raise NotImplementedError

    def setflags(self, *, write: bool) -> None:
        """Mark as read-only: C arrays are constant where nothing sets them."""

    def __len__(self) -> int:
        return self.shape[0]

    def __iter__(self) -> Iterator[Any]:
        return (picked(self, k) for k in range(self.shape[0]))

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
        """Return an array of its shape in another C array."""
        return Stored(self.shape, members[0])

    def at(self, places: Places) -> Num:
        """Return an element."""
        base, place = self.place(places)
        return Num(f"{base}[{place}]", self.kind)

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
        """Return an element."""
        return self.base.at(self.to(places))

    def place(self, places: Places) -> tuple[str, str]:
        """Return the name of the array, and the place of an element in it."""
        return self.base.place(self.to(places))


class Derived(Grid):
    """What `element` gives for each place; `costs`: more than a few operations."""

    def __init__(self, shape: Shape, kind: str, element: Callable[[Places], Any], *, costs: bool) -> None:
        super().__init__(shape, kind)
        self.element, self.costs = element, costs

    def at(self, places: Places) -> Any:
        """Return an element."""
        return self.element(places)


class Masked(Derived):
    """Elements that a mask picks: their number is not known, but their sum is; the others are 0."""


class Writer:
    """What arrays ask of a C function under construction; `units.Unit` is one."""

    def emit(self, statement: code.Statement) -> None:
        """Add a statement."""

    def fresh(self, name: str) -> str:  # type: ignore[empty-body]
        """Return a new name."""

    def variable(self, name: str, kind: str) -> Num:  # type: ignore[empty-body]
        """Return a variable that is set later."""

    def branch(self, work: Callable[[], Any]) -> tuple[Any, code.Block]:  # type: ignore[empty-body]
        """Return what some work gives, and the statements that it makes."""

    def writes(self, name: str) -> None:
        """Take note that an array is written."""


def _flat(places: Places, shape: Shape) -> Any:
    found: Any = 0
    for place, size in zip(places, shape, strict=True):
        found = found * size + place if not isinstance(found, int) or found else place
    return found


def table(array: np.ndarray) -> Stored:
    """Return a known array as one in C."""
    whole = array.dtype.kind in "iub"
    key = (whole, array.size, np.ascontiguousarray(array, np.int64 if whole else np.float64).tobytes())
    number = _TABLES.setdefault(key, len(_TABLES))
    return Stored(array.shape, Num(f"{_TABLE}{number}", array_kind("i" if whole else "d", array.size)))


_TABLES: dict[tuple[bool, int, bytes], int] = {}  # of all programs, in order
_TABLE = "known_table_"
_NAME = "constants"


def with_tables(texts: Sequence[str]) -> list[str]:
    """Return C functions after the tables that they read."""
    import re

    numbers = list(dict.fromkeys(re.findall(rf"\b{_TABLE}(\d+)\b", "\n".join(texts))))
    if not numbers:
        return list(texts)
    keys = list(_TABLES)
    names = {number: f"{_NAME}_{place}" for place, number in enumerate(numbers, 1)}
    tables = [_written(names[number], *keys[int(number)]) for number in numbers]
    return [*tables, *(re.sub(rf"\b{_TABLE}(\d+)\b", lambda found: names[found[1]], text) for text in texts)]


def _written(name: str, whole: bool, size: int, content: bytes) -> str:
    values = np.frombuffer(content, np.int64 if whole else np.float64)
    kind = "i" if whole else "d"
    listed = values.tolist() if values.any() or np.signbit(values.astype(float)).any() else [values[0].item()]
    items = ", ".join(literal(value, kind).text for value in listed)
    return "\n".join(code.wrapped(f"static const {code.c_type(kind)} {name}[{size}] = {{ {items} }};", 0))


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
    return rebuilt(value, [settled(unit, item, f"{name}_{part}" if part else name, cheap=cheap) for part, item in found])


def _is_lazy(value: Any) -> bool:
    if isinstance(value, Num) or not values.is_dynamic(value):
        return False
    if isinstance(value, Grid):
        return not isinstance(value, Stored)
    return any(_is_lazy(item) for _, item in parts(value) or ())


def both_stored(one: Any, other: Any) -> tuple[Any, Any]:
    """Return known arrays as arrays in C where one of the two is that, or where they are large."""
    pair = one, other
    if any(isinstance(x, Stored) for x in pair) or all(isinstance(x, np.ndarray) and x.size > LARGE for x in pair):
        if all(isinstance(x, Stored) or (isinstance(x, np.ndarray) and x.dtype != object) for x in pair):
            made = tuple(table(x) if isinstance(x, np.ndarray) else x for x in pair)
            if made[0].shape == made[1].shape:
                return made[0], made[1]
    return pair


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
    _, kind = unit.branch(lambda: None), "d"
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
    """Return an array broadcast to a shape."""
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


# parts


def picked(grid: Grid, key: Any, unit: Writer | None = None) -> Any:
    """Return an element or a part of an array."""
    if _is_mask(key):
        return _masked(grid, key, unit)
    keys = _whole_key(key, grid.ndim)
    if len(keys) == grid.ndim and all(is_number(k) for k in keys):
        return grid.at(tuple(_inside(k, n) for k, n in zip(keys, grid.shape, strict=True)))
    numbers = list(itertools.takewhile(is_number, keys))
    if isinstance(grid, Stored) and all(isinstance(k, slice) and k == slice(None) for k in keys[len(numbers) :]):
        return _row(grid, [_inside(k, n) for k, n in zip(numbers, grid.shape, strict=False)])
    return _part(grid, keys, unit)




def _is_mask(key: Any) -> bool:
    if isinstance(key, np.ndarray) and key.dtype == object:
        return key.size > 0 and all(kind_of(x) == "b" for x in key.flat)
    return isinstance(key, Grid) and key.kind == "b"


def _masked(grid: Grid, mask: Any, unit: Writer | None) -> Masked:
    if unit is None:
        raise Untranslatable("a part of an array by a mask, in a loop over it")
    found = elementwise(unit, lambda test, x: chosen(test, x, 0.0), [mask, grid], costs=False)
    return Masked(found.shape, grid.kind, found.element, costs=found.costs)


def _row(grid: Stored, numbers: list[Any]) -> Stored:
    rest = grid.shape[len(numbers) :]
    offset = _flat((*numbers, *(0 for _ in rest)), grid.shape)
    if isinstance(offset, int) and offset == 0 and not isinstance(grid.data, Pointer):
        return Stored(rest, Num(grid.data.text, array_kind(grid.kind, math.prod(rest))))
    base, before = (grid.data.base, grid.data.offset) if isinstance(grid.data, Pointer) else (grid.data.text, 0)
    return Stored(rest, Pointer(base, before + offset, array_kind(grid.kind, math.prod(rest))))


def _whole_key(key: Any, ndim: int) -> list[Any]:
    keys = list(key) if isinstance(key, tuple) else [key]
    own = sum(1 for k in keys if k is not None and k is not Ellipsis)
    full = [slice(None)] * (ndim - own)
    at = next((i for i, k in enumerate(keys) if k is Ellipsis), None)
    return [*keys, *full] if at is None else [*keys[:at], *full, *keys[at + 1 :]]


def _inside(place: Any, size: int) -> Any:
    return place if isinstance(place, Num) or place >= 0 else place + size


def _part(grid: Grid, keys: list[Any], unit: Writer | None) -> Grid:
    """Return a part by numbers, slices, new axes and arrays of places (these side by side)."""
    arrays = [k for k in keys if isinstance(k, Grid | np.ndarray | list)]
    if (arrays or isinstance(grid, Derived)) and unit is None:
        raise Untranslatable("a part of an array by an array, in a loop over it")
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
            steps.append(lambda _, k=_inside(k, size): k)
        elif isinstance(k, slice):
            span = range(*k.indices(size))
            steps.append(lambda p, i=len(shape), s=span: s.start + p[i] * s.step if s.start else p[i] * s.step)
            shape.append(len(span))
        else:
            if at is None:
                at = len(shape)
                shape.extend(among)
            chosen = stored(unit, k, "places")  # type: ignore[arg-type]
            steps.append(lambda p, i=at, c=chosen: c.at(aligned(c.shape, p[i : i + len(among)])))

    def to(places: Places) -> Places:
        return tuple(step(places) for step in steps)

    base = stored(unit, grid) if isinstance(grid, Derived) else grid  # type: ignore[arg-type]
    if isinstance(base, View):
        own = base
        return View(tuple(shape), own.base, lambda places: own.to(to(places)))
    assert isinstance(base, Stored)
    return View(tuple(shape), base, to)


def put(unit: Writer, grid: Stored | View, key: Any, value: Any) -> None:
    """Set an element or a part of an array."""
    keys = _whole_key(key, grid.ndim)
    if len(keys) == grid.ndim and all(is_number(k) for k in keys):
        name, place = grid.place(tuple(_inside(k, n) for k, n in zip(keys, grid.shape, strict=True)))
        unit.writes(name)
        unit.emit(code.Put(name, literal(value, grid.kind).text, place))
        return
    part = picked(grid, key, unit)
    if not is_number(value):
        value = broadcast(unit, stored(unit, value), part.shape)
    fill(unit, part, value)


# sums and the like


def reduced(unit: Writer, name: str, grid: Grid, axis: Any, start: Num, more: Callable[[Num, Any], Any]) -> Any:
    """Return what elements come to along one axis, several, or all (None); `more` adds one to what there is."""
    axes = tuple(range(grid.ndim)) if axis is None else (axis,) if isinstance(axis, int) else tuple(axis)
    axes = tuple(a % grid.ndim for a in axes)
    if isinstance(grid, Derived):
        _, _ = grid.shape, grid.kind

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



def base_of(array: Num) -> str:
    """Return the name of the C array that an array lies in."""
    return array.base if isinstance(array, Pointer) else array.text
