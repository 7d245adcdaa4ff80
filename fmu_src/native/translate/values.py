"""Numbers that are known only at run time, as C expressions, and how they sit in Python values."""

import dataclasses
import enum
import functools
import math
import operator
from collections.abc import Callable, Iterable
from types import FunctionType, MethodType
from typing import Any, ClassVar, TypeAlias

import numpy as np

# how tightly C binds: an operand that binds less is put in parentheses
ATOM, UNARY, MULTIPLY, ADD, COMPARE, BIT, AND, OR, CHOICE = range(9, 0, -1)


class Untranslatable(Exception):  # noqa: N818  # what it is, not that it failed
    """Python that has no counterpart here; names the place and what to write instead."""


class Num:
    """A number at run time: a C expression of kind "d" (double), "i" (int) or "b" (0 or 1).

    Of kind "d[12]" it is a C array of that many.
    """

    __slots__ = ("binds", "kind", "text")

    def __init__(self, text: str, kind: str = "d", binds: int = ATOM) -> None:
        self.text, self.kind, self.binds = text, kind, binds

    def __repr__(self) -> str:
        return f"Num({self.text})"

    def at_least(self, binds: int) -> str:
        """Return the expression, in parentheses if it binds less tightly."""
        return self.text if self.binds >= binds else f"({self.text})"

    def __bool__(self) -> bool:
        raise Untranslatable(f"'{self.text}' is known at run time only, and decides here: write it as an if or where")

    def __float__(self) -> float:
        raise Untranslatable(f"'{self.text}' is known at run time only: no float of it")

    __hash__: ClassVar[None] = None  # type: ignore[assignment]

    def __add__(self, other: Any) -> Any:
        return _sum(self, other)

    def __radd__(self, other: Any) -> Any:
        return _sum(other, self)

    def __sub__(self, other: Any) -> Any:
        if _is(other, 0.0):
            return self
        return 0.0 if _same(self, other) else binary("-", self, other, ADD, ADD + 1)

    def __rsub__(self, other: Any) -> Any:
        return -self if _is(other, 0.0) else binary("-", other, self, ADD, ADD + 1)

    def __mul__(self, other: Any) -> Any:
        return _product(self, other)

    def __rmul__(self, other: Any) -> Any:
        return _product(other, self)

    def __truediv__(self, other: Any) -> Any:
        if _is(other, 1.0):
            return self
        return 1.0 if _same(self, other) else binary("/", as_double(self), other, MULTIPLY, MULTIPLY + 1)

    def __rtruediv__(self, other: Any) -> Any:
        return 0.0 if _is(other, 0.0) else binary("/", other, as_double(self), MULTIPLY, MULTIPLY + 1)

    def __mod__(self, other: Any) -> Any:
        return binary("%", self, other, MULTIPLY, MULTIPLY + 1)

    def __pow__(self, other: Any) -> Any:
        return power(self, other)

    def __rpow__(self, other: Any) -> Any:
        return power(other, self)

    def __neg__(self) -> "Num":
        return Num(f"-{self.at_least(UNARY)}", "d" if self.kind == "d" else "i", UNARY)

    def __pos__(self) -> "Num":
        return self

    def __abs__(self) -> "Num":
        return Num(f"fabs({self.text})")

    def __invert__(self) -> "Num":
        if self.kind == "b":
            return Num(f"!{self.at_least(UNARY)}", "b", UNARY)
        return Num(f"~{self.at_least(UNARY)}", "i", UNARY)

    def __or__(self, other: Any) -> Any:
        return _bits("|", self, other)

    def __ror__(self, other: Any) -> Any:
        return _bits("|", other, self)

    def __and__(self, other: Any) -> Any:
        return _bits("&", self, other)

    def __rand__(self, other: Any) -> Any:
        return _bits("&", other, self)

    def __lt__(self, other: Any) -> Any:
        return compare("<", self, other)

    def __le__(self, other: Any) -> Any:
        return compare("<=", self, other)

    def __gt__(self, other: Any) -> Any:
        return compare(">", self, other)

    def __ge__(self, other: Any) -> Any:
        return compare(">=", self, other)

    def __eq__(self, other: object) -> Any:
        return compare("==", self, other)

    def __ne__(self, other: object) -> Any:
        return compare("!=", self, other)


class Grid:
    """An array at run time, see `grids`."""

    shape: tuple[int, ...]

    def members(self) -> list[tuple[str, Any]]:
        """Return the C arrays that it consists of; see `parts`."""
        return []

    def with_members(self, members: list[Any]) -> "Grid":
        """Return an array like it that lies in other C arrays."""
        return self


def array_kind(kind: str, size: int) -> str:
    """Return the kind of a C array of numbers of a kind."""
    return f"{kind}[{size}]"


def literal(value: Any, kind: str = "d") -> Num:
    """Return a constant as C."""
    if isinstance(value, Num):
        return value
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, enum.IntFlag | enum.IntEnum):
        value = int(value)
    if not isinstance(value, bool | int | float):
        raise Untranslatable(f"{value!r} is no number")
    if kind != "d":
        return Num(str(int(value)), kind, ATOM if value >= 0 else UNARY)
    number = float(value)
    if math.isnan(number):
        return Num("NAN")
    text = "INFINITY" if math.isinf(number) else repr(abs(number))
    if "." not in text and "e" not in text and "I" not in text:
        text += ".0"
    return Num(f"-{text}", binds=UNARY) if math.copysign(1.0, number) < 0.0 else Num(text)


_NUMBERS = (Num, bool, int, float, np.number, np.bool_)


def is_number(value: Any) -> bool:
    """Return True for a number, known or not."""
    return isinstance(value, _NUMBERS)


def kind_of(value: Any) -> str:
    if isinstance(value, Num):
        return value.kind
    if isinstance(value, bool | np.bool_):
        return "b"
    return "i" if isinstance(value, int | np.integer) else "d"


def as_double(value: Any) -> Num:
    if isinstance(value, Num) and value.kind != "d":
        return Num(f"(double){value.at_least(UNARY)}", "d", UNARY)
    return literal(value)


_KNOWN_NUMBERS = (int, float, np.number)


def _is(value: Any, number: float) -> bool:
    return isinstance(value, _KNOWN_NUMBERS) and float(value) == number


def _sum(one: Any, other: Any) -> Any:
    if _is(one, 0.0):
        return other
    return one if _is(other, 0.0) else binary("+", one, other, ADD, ADD + 1)


def _same(one: Any, other: Any) -> bool:
    return isinstance(other, Num) and one.text == other.text


def _product(one: Any, other: Any) -> Any:
    if is_number(one) and is_number(other) and (_is(one, 0.0) or _is(other, 0.0)):
        return 0.0  # all numbers of an equation that is in use are finite
    if _is(one, 1.0):
        return other
    return one if _is(other, 1.0) else binary("*", one, other, MULTIPLY, MULTIPLY + 1)


def _bits(sign: str, one: Any, other: Any) -> Any:
    if kind_of(one) == "b" and kind_of(other) == "b":
        known = one if isinstance(one, bool) else other if isinstance(other, bool) else None
        if known is not None:
            unknown = other if isinstance(one, bool) else one
            return (True if known else unknown) if sign == "|" else (unknown if known else False)
        return both(one, other) if sign == "&" else either(one, other)
    if sign == "|" and (_is(one, 0) or _is(other, 0)):
        return other if _is(one, 0) else one
    first, second = (literal(each, "i").at_least(COMPARE + 1) for each in (one, other))  # as compilers ask for
    return Num(f"{first} {sign} {second}", "i", BIT)


def both(one: Any, other: Any) -> Num:
    """Return `one && other`."""
    if isinstance(other, bool):
        return one if other else False  # type: ignore[return-value]
    return Num(f"{literal(one, 'b').at_least(AND)} && {literal(other, 'b').at_least(AND)}", "b", AND)


def either(one: Any, other: Any) -> Num:
    """Return `one || other`; && in it is put in parentheses, as compilers ask for."""
    if isinstance(other, bool):
        return True if other else one  # type: ignore[return-value]
    return Num(f"{_clear(one)} || {_clear(other)}", "b", OR)


def _clear(value: Any) -> str:
    number = literal(value, "b")
    return f"({number.text})" if number.binds == AND else number.at_least(OR)


def binary(sign: str, one: Any, other: Any, left: int, right: int) -> Any:
    """Return an arithmetic expression; operands that bind less than `left` and `right` get parentheses."""
    if not (is_number(one) and is_number(other)):
        return NotImplemented
    whole = {"i", "b"}
    kind = "i" if {kind_of(one), kind_of(other)} <= whole and sign != "/" else "d"
    first, second = (literal(value, kind) for value in (one, other))
    return Num(f"{first.at_least(left)} {sign} {second.at_least(right)}", kind, left)


def compare(sign: str, one: Any, other: Any) -> Any:
    if not (is_number(one) and is_number(other)):
        return NotImplemented
    kind = "d" if "d" in (kind_of(one), kind_of(other)) else "i"
    first, second = (literal(value, kind) for value in (one, other))
    return Num(f"{first.at_least(COMPARE + 1)} {sign} {second.at_least(COMPARE + 1)}", "b", COMPARE)


def call(name: str, *operands: Any) -> Num:
    """Return the call of a C function of doubles."""
    return Num(f"{name}({', '.join(literal(x).text for x in operands)})")


# names in elementary.h: powers that are right to a few units in the last place by multiplications and roots alone
_POWERS = {0.25: "fourth_root", 0.5: "sqrt", 0.75: "power_0_75", 1.5: "power_1_5", 2.0: "squared", 3.0: "cubed"}
_POWERS |= {4.0: "fourth_power", 8.0: "eighth_power"}


def power(base: Any, exponent: Any) -> Any:
    """Return a power: of small whole or quarter exponents without a logarithm."""
    if not (is_number(base) and is_number(exponent)):
        return NotImplemented
    if isinstance(base, Num) and not isinstance(exponent, Num):
        size = abs(float(exponent))
        if size in (0.0, 1.0):
            found: Any = base if size else 1.0
            return found if exponent >= 0.0 else 1.0 / found
        if size in _POWERS:
            found = call(_POWERS[size], base)
            return found if exponent > 0.0 else 1.0 / found
    return call("own_pow", base, exponent)


class Closure:
    """A function of interpreted Python: its tree, and the names that it sees."""

    def __init__(self, node: Any, name: str, names: dict[str, Any], module: dict[str, Any], path: str) -> None:
        self.node, self.name, self.names, self.module, self.path = node, name, names, module, path


class Method:
    """A function bound to a value that is known at run time only."""

    def __init__(self, function: FunctionType, owner: Any) -> None:
        self.function, self.owner = function, owner


_static: dict[int, Any] = {}  # objects without a number at run time, kept alive so that their ids stay theirs
_signatures: dict[int, int] = {}  # of these objects
_WHOLE = frozenset({float, int, bool, str, type(None), np.float64, FunctionType, type, np.ufunc})  # have no members

Names: TypeAlias = Callable[[Any], Iterable[str]]
Items: TypeAlias = Callable[[Any], Iterable[Any]]


def parts(value: Any) -> list[tuple[str, Any]] | None:
    """Return names and members of a value that has some; None of one that is whole."""
    if isinstance(value, Grid):
        return value.members()
    found = _access(type(value))  # type: ignore[arg-type]  # types can be hashed
    if found is None or (isinstance(value, np.ndarray) and value.dtype != object):
        return None
    names, items = found
    return list(zip(names(value), items(value), strict=True))


def members(value: Any) -> Iterable[Any]:
    """Return the members of a value; none of one that is whole."""
    if isinstance(value, Grid):
        return [item for _, item in value.members()]
    found = _access(type(value))  # type: ignore[arg-type]  # types can be hashed
    if found is None or (isinstance(value, np.ndarray) and value.dtype != object):
        return ()
    return found[1](value)


@functools.cache
def _access(kind: type) -> tuple[Names, Items] | None:
    """Return what gives names and members of the values of a type; None for a type whose values are whole."""
    if issubclass(kind, tuple) and hasattr(kind, "_fields"):
        return (lambda value: value._fields), iter
    if issubclass(kind, tuple | list):
        return (lambda value: map(str, range(len(value)))), iter
    if issubclass(kind, dict):
        return (lambda value: map(str, value)), dict.values
    if issubclass(kind, np.ndarray):
        return (lambda value: ("_".join(map(str, place)) for place in np.ndindex(value.shape))), (
            lambda value: value.flat
        )
    if issubclass(kind, Closure):
        return (lambda value: value.names), (lambda value: value.names.values())
    if issubclass(kind, Method):
        return (lambda value: ("",)), (lambda value: (value.owner,))
    if dataclasses.is_dataclass(kind):
        return vars, (lambda value: vars(value).values())
    return None


def rebuilt(value: Any, members: list[Any]) -> Any:
    """Return a value like another, with other members (in the order of `parts`)."""
    if isinstance(value, Grid):
        return value.with_members(members)
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return type(value)(*members)
    if isinstance(value, tuple | list):
        return type(value)(members)
    if isinstance(value, dict):
        return dict(zip(value, members, strict=True))
    if isinstance(value, np.ndarray):
        array = np.empty(value.shape, object)
        for (place, _), item in zip(np.ndenumerate(value), members, strict=True):
            array[place] = item
        return array
    if isinstance(value, Closure):
        names = dict(zip(value.names, members, strict=True))
        return Closure(value.node, value.name, names, value.module, value.path)
    if isinstance(value, Method):
        return Method(value.function, members[0])
    copy = object.__new__(type(value))
    copy.__dict__.update(zip(vars(value), members, strict=True))
    return copy


_AT_RUN_TIME = (Num, Grid)


def is_known(value: Any) -> bool:
    """Return True if a value is seen at once to have no number that is known at run time only."""
    return type(value) in _WHOLE or id(value) in _static


def is_dynamic(value: Any) -> bool:
    """Return True if any number in a value is known at run time only."""
    if is_known(value):
        return False
    if isinstance(value, _AT_RUN_TIME):
        return True
    if any(map(is_dynamic, members(value))):
        return True
    _remember(value)
    return False


def leaves(value: Any, name: str = "") -> list[tuple[str, Num]]:
    """Return names and numbers at run time of a value, in a fixed order."""
    found: list[tuple[str, Num]] = []
    _collect(value, name, found)
    return found


def _collect(value: Any, name: str, found: list[tuple[str, Num]]) -> None:
    if isinstance(value, Num):
        found.append((name, value))
    elif not is_known(value):
        before = len(found)
        for part, item in parts(value) or ():
            own = part if not part[:1].isdigit() or not name else f"{name}_{part}"
            _collect(item, name if isinstance(value, Grid) else own, found)
        if len(found) == before:
            _remember(value)


def numbers(value: Any) -> list[Num]:
    """Return the numbers at run time of a value, in the order of `leaves`."""
    found: list[Num] = []
    _gather(value, found)
    return found


def _gather(value: Any, found: list[Num]) -> None:
    if isinstance(value, Num):
        found.append(value)
    elif not is_known(value):
        before = len(found)
        for item in members(value):
            _gather(item, found)
        if len(found) == before:
            _remember(value)


def replaced(value: Any, by: Callable[[Num], Any]) -> Any:
    """Return a value with every number at run time replaced, in the order of `leaves`."""
    if isinstance(value, Num):
        return by(value)
    if is_known(value):
        return value
    own = list(members(value))
    others = [replaced(item, by) for item in own]
    if any(map(operator.is_not, own, others)):
        return rebuilt(value, others)
    return value


def _remember(value: Any) -> None:
    """Keep in mind that a record has no number at run time."""
    if dataclasses.is_dataclass(value):
        _static[id(value)] = value


def signature(value: Any) -> Any:
    """Return what two values have in common that the same C function serves: all but numbers at run time."""
    if isinstance(value, Num):
        return "#" + value.kind
    if is_dynamic(value):
        own = (
            (id(value.node),) if isinstance(value, Closure) else (value.function,) if isinstance(value, Method) else ()
        )
        shape = value.shape if isinstance(value, np.ndarray | Grid) else ()
        return type(value), own, shape, tuple((name, signature(item)) for name, item in parts(value) or ())
    if isinstance(value, Closure):
        return id(value.node), tuple((name, signature(item)) for name, item in value.names.items())
    if isinstance(value, FunctionType):
        return id(value.__code__), tuple(signature(cell.cell_contents) for cell in value.__closure__ or ())
    if isinstance(value, MethodType):
        return signature(value.__func__), signature(value.__self__)
    if value is None or isinstance(value, bool | int | float | str):
        return type(value), repr(value)
    if isinstance(value, np.ndarray):
        return value.shape, str(value.dtype), value.tobytes() if value.dtype != object else tuple(map(repr, value.flat))
    if isinstance(value, tuple | list):
        return type(value), tuple(map(signature, value))
    if isinstance(value, dict):
        return tuple((key, signature(item)) for key, item in value.items())
    if id(value) not in _signatures:
        _static[id(value)] = value
        fields = dataclasses.fields(value) if dataclasses.is_dataclass(value) and not isinstance(value, type) else None
        members = [id(value)] if fields is None else [signature(getattr(value, field.name)) for field in fields]
        _signatures[id(value)] = hash((type(value), *members))
    return _signatures[id(value)]
