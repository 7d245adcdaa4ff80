"""C functions under construction, and how values that come from several branches become one."""

import ast
import dataclasses
import functools
import re
from collections.abc import Callable, Collection
from types import FunctionType
from typing import Any, Protocol

import numpy as np

from . import code, grids
from .values import (
    Closure,
    Num,
    Untranslatable,
    is_dynamic,
    is_number,
    kind_of,
    literal,
    parts,
    rebuilt,
    replaced,
    signature,
)

Leaf = Callable[[str, Any, Any], Any]

_WHOLE = re.compile(r"[A-Za-z_]\w*(\.\w+)?|-?[\d.]+(e[-+]?\d+)?|-?INFINITY|NAN")
KEYWORDS = frozenset(
    re.findall(
        r"\w+",
        "double int long short float const if else for while return struct auto register signed static switch volatile "
        "goto default case char do enum extern sizeof typedef union unsigned void inline restrict break continue",
    )
)
_TAKEN = KEYWORDS.union(  # and what headers of C and elementary.h have
    re.findall(
        r"\w+",
        "why exp log pow sqrt fabs floor ceil round gamma time index j0 j1 y0 y1 jn yn tanh sinh remainder signal "
        "squared cubed fourth_power eighth_power fourth_root power_0_75 power_1_5 smaller larger centre from_bits "
        "bits_of upper_half exp_parts exp_at_ends exp_of log_parts log_of log_at_ends power_at_ends power_of "
        "power_of_two exp_sum log_sum refuse whole_number place_inside memcpy memset ratio_of",
    )
)


class Text:
    """A message with numbers that are known at run time: a format of C and its operands."""

    def __init__(self, form: str, operands: list[Num]) -> None:
        self.form, self.operands = form, operands


class Poison:
    """What a name means after branches that left different things in it."""

    def __init__(self, reason: str) -> None:
        self.reason = reason


class Unit:
    """One C function under construction."""

    def __init__(self, name: str, template: Any, names: list[str], *, scratch: bool) -> None:
        self.name, self.template, self.scratch = name, template, scratch
        self.part_names = names  # of what it returns
        self.blocks: list[code.Block] = [[]]
        self.names: set[str] = set()
        self.returned: list[Any] = []
        self.may_fail = False
        self.cached: list[tuple[Any, str]] = []  # properties kept in the present block
        self.loops: list[Any] = []
        self._known: list[dict[str, str]] = [{}]  # expressions that have a name, for each block
        self.arrays: set[str] = set()  # their names: what is read of them may change
        self.written: set[str] = set()  # arrays that are set
        self.compiled = False  # its Python is compiled: what it reads of arrays is in them
        self._indices: set[str] = set()  # names that count rounds of loops
        self.outs: list[str] = []  # names of the parameters that take arrays it returns

    def emit(self, statement: code.Statement) -> None:
        """Add a statement to the present block."""
        self.blocks[-1].append(statement)

    def fresh(self, name: str) -> str:
        """Return a new name for a local variable, made from a Python name."""
        found = unique(_name(name), self.names, _TAKEN)
        self.names.add(found)
        return found

    def let(self, name: str, value: Num) -> Num:
        """Return a name for a value; names and constants stay as they are."""
        if _WHOLE.fullmatch(value.text) or "[" in value.kind:
            return value
        found = self.known(value.text)
        if found is None:
            found = self.fresh(name)
            self.keep(value.text, found)
            self.emit(code.Let(code.c_type(value.kind), found, value.text))
        return Num(found, value.kind)

    def known(self, text: str) -> str | None:
        """Return the name that an expression has already."""
        if self.may_change(text):
            return None
        return next((names[text] for names in self._known if text in names), None)

    def keep(self, text: str, name: str) -> None:
        """Keep the name of an expression to the end of the present block."""
        self._known[-1][text] = name

    def may_change(self, text: str) -> bool:
        """Return True if an expression reads an array."""
        return "[" in text or bool(self.arrays and code.names_in(text) & self.arrays)

    def counts(self, index: str) -> None:
        """Take note that a name counts the rounds of a loop."""
        self._indices.add(index)

    def trusts(self, place: str) -> bool:
        """Return True for a place that is in every array it is used for."""
        return self.compiled or place in self._indices

    def writes(self, name: str) -> None:
        """Take note that an array is written."""
        self.written.add(name)

    def variable(self, name: str, kind: str) -> Num:
        """Return a variable that is set later."""
        found = self.fresh(name)
        if "[" in kind:
            self.arrays.add(found)
        self.emit(code.Let(code.c_type(kind), found, None))
        return Num(found, kind)

    def named(self, name: str, value: Any) -> Any:
        """Return a value whose members all have names."""
        if isinstance(value, Num):
            return self.let(name, value)
        if not is_dynamic(value) or isinstance(value, grids.View):
            return value
        if isinstance(value, grids.Grid):
            return grids.stored(self, value, name)
        members = [(_path(name, part), item) for part, item in parts(value) or ()]
        return rebuilt(value, [grids.settled(self, self.named(path, item), path) for path, item in members])

    def branch(self, work: Callable[[], Any]) -> tuple[Any, code.Block]:
        """Return what some work gives, and the statements that it makes; properties it computes are forgotten."""
        kept, self.cached = self.cached, []
        self.blocks.append([])
        self._known.append({})
        try:
            found = work()
        finally:
            block = self.blocks.pop()
            self._known.pop()
            for owner, name in self.cached:
                vars(owner).pop(name, None)
            self.cached = kept
        return found, block

    def joined(self, name: str, one: Any, other: Any, then: code.Block, otherwise: code.Block) -> Any:
        """Return a value that is one or the other after two blocks."""

        def leaf(path: str, first: Any, second: Any) -> Num:
            kind = common_kind(first, second)
            made = self.variable(path, kind)
            then.append(code.set_to(made.text, kind, literal(first, kind).text))
            otherwise.append(code.set_to(made.text, kind, literal(second, kind).text))
            return made

        return unified(one, other, leaf, name)


class Writer(Protocol):
    """What a scope asks of the translator."""

    def attribute(self, unit: Unit, owner: Any, name: str) -> Any:
        """Return a member of a value."""

    def call(self, unit: Unit, function: FunctionType | Closure, operands: list[Any], named: dict[str, Any]) -> Any:
        """Return what a call gives."""

    def gives(self, unit: Unit, value: Any) -> None:
        """Return a value from the function of a unit."""

    def refuses(self, unit: Unit, text: Text) -> None:
        """Leave the function of a unit with a message."""


class Names(Protocol):
    """What a loop asks of a scope."""

    names: dict[str, Any]

    @property
    def unit(self) -> Unit:
        """The function under construction."""

    def run(self, statements: list[ast.stmt]) -> bool:
        """Run statements; return True if what follows them is reached."""

    def test(self, node: ast.expr) -> Any:
        """Return the truth of an expression."""

    def refuse(self, message: str | Text) -> None:
        """Leave the function with a message."""


@functools.cache
def _name(name: str) -> str:
    """Return a name of C for a Python one, or for a way to a member."""
    found = re.sub(r"\W", "_", name).strip("_") or "value"
    return f"part_{found}" if found[0].isdigit() else found


def unique(name: str, *taken: Collection[str]) -> str:
    """Return a name that is not taken, with a number if need be."""
    found, count = name, 1
    while any(found in names for names in taken):
        count += 1
        found = f"{name}_{count}"
    return found


def _path(name: str, part: str) -> str:
    return f"{name}_{part}" if part else name


def common_kind(one: Any, other: Any) -> str:
    """Return the kind of a variable for both numbers."""
    kinds = {kind_of(one), kind_of(other)}
    if "[" in kind_of(one):
        if len({kind.replace("b", "i") for kind in kinds}) > 1:
            raise Untranslatable(f"one array of {' or '.join(sorted(kinds))}: it must have one form")
        return kind_of(one)
    return "d" if "d" in kinds else "i" if "i" in kinds else "b"


def unified(one: Any, other: Any, leaf: Leaf, name: str = "") -> Any:
    """Return what stands for both values; where their numbers differ, what `leaf` gives for a name and both."""
    if one is other:
        return one
    if is_number(one) and is_number(other):
        if isinstance(one, Num) or isinstance(other, Num):
            same = isinstance(one, Num) and isinstance(other, Num) and (one.text, one.kind) == (other.text, other.kind)
        else:
            same = repr(one) == repr(other)
        return one if same and (not isinstance(one, Num) or one.text) else leaf(name, one, other)
    if not is_dynamic(one) and not is_dynamic(other) and signature(one) == signature(other):
        return one
    one, other = _alike(*grids.both_stored(one, other))
    mine, theirs = parts(one), parts(other)
    if type(one) is not type(other) or mine is None or theirs is None:
        raise Untranslatable(f"'{name}' is {_what(one)} or {_what(other)}: it must have one form")
    if [part for part, _ in mine] != [part for part, _ in theirs]:
        if not dataclasses.is_dataclass(one):
            raise Untranslatable(f"'{name}' has members of its own in each branch: it must have one form")
        one, other = _bare(one), _bare(other)
        mine, theirs = parts(one) or [], parts(other) or []
    return rebuilt(
        one,
        [unified(a, b, leaf, _path(name, part)) for (part, a), (_, b) in zip(mine, theirs, strict=True)],
    )


def _alike(one: Any, other: Any) -> tuple[Any, Any]:
    """Return arrays as arrays of objects, and dictionaries in one order."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        return one, {key: other[key] for key in one}
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray) and one.shape == other.shape:
        return one.astype(object), other.astype(object)
    return one, other


def _bare(record: Any) -> Any:
    """Return a record without its cached properties."""
    copy = object.__new__(type(record))
    copy.__dict__.update({f.name: vars(record)[f.name] for f in dataclasses.fields(record)})
    return copy


def _what(value: Any) -> str:
    return "a number" if is_number(value) else "None" if value is None else f"a {type(value).__name__}"


def template_of(values: list[Any]) -> Any:
    """Return the form of what a function returns: numbers that it does not always give alike are known at run time."""
    found = replaced(values[0], lambda number: Num("", number.kind))
    for value in values[1:]:
        found = unified(found, value, lambda _, one, other: Num("", common_kind(one, other)), "its result")
    return found


def matched(value: Any, template: Any) -> list[Num]:
    """Return the members of a value that the numbers at run time of a template stand for, in the order of `leaves`."""
    if isinstance(template, Num):
        return [literal(value, template.kind)]
    if not is_dynamic(template):
        return []
    if isinstance(template, grids.Stored):
        if isinstance(value, np.ndarray):
            return [grids.table(value).data]
        return [value.data if isinstance(value, grids.Stored) else value]
    if isinstance(value, np.ndarray):
        value = value.astype(object)
    given = dict(parts(value) or ())
    return [found for part, item in parts(template) or () for found in matched(given[part], item)]
