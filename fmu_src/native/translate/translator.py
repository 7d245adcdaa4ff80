"""From Python functions and their calls to C functions and theirs."""

import ast
import functools
import inspect
import re
import types
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import code, constants, grid_library, grids
from .arrays import arrays_in, on_arrays
from .expressions import Super
from .functions import CFunction, Functions
from .interpreter import Scope
from .results import distinct, filled, with_alike, with_given
from .sources import closure_of, expression_of, is_compiled, is_straight, method_after, statements_of
from .units import Unit
from .values import UNARY, Closure, Method, Num, Untranslatable, is_dynamic, numbers

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_CORE, _LAWS, _OF_LAYERS = "contact_core.", "contact_core.laws.", "contact_core.laws.stress"
_PARTS = "system_models."


@dataclass
class Entry:
    """A C function to be called from outside."""

    name: str  # empty: there is nothing to compute
    takes: list[Num]
    result: Any  # its numbers at run time are members of the struct that it returns; without a name, what it takes
    may_fail: bool

    @property
    def returns(self) -> int:
        """How many numbers it returns beside arrays; one is no struct."""
        return sum(1 for number in numbers(self.result) if "[" not in number.kind) if self.name else 0

    @property
    def arrays(self) -> list[Num]:
        """Arrays that it sets."""
        return [number for number in numbers(self.result) if "[" in number.kind] if self.name else []

    @staticmethod
    def place(number: Num, inputs: Sequence[str], constants: Collection[str] = ()) -> str:
        """Return a number that it takes."""
        if number.text == "dt" or number.text in constants:
            return number.text
        return f"{'in' if number.text in inputs else 'state'}->{number.text}"

    def called(self, inputs: Sequence[str], constants: Collection[str] = ()) -> str:
        """Return the call, with inputs and state from structs `in` and `state`."""
        given = [self.place(number, inputs, constants) for number in self.takes]
        own = [number.text for number in self.arrays]
        return f"{self.name}({', '.join([*given, *own, *(['why'] if self.may_fail else [])])})"


class Translator(Functions):
    """Writes the C functions of a program."""

    def __init__(
        self, reads: Mapping[Any, set[str]] | None = None, instead: Mapping[Any, types.FunctionType] | None = None
    ) -> None:
        """Begin a program.

        reads: members that are read of the structs of functions, where that is known. instead: functions of scalars
        that stand for others, of arrays.
        """
        super().__init__(reads or {})
        self._instead = instead or {}

    def program(self, function: types.FunctionType, operands: list[Any]) -> "Entry":
        """Write a function that C code calls, with all it needs; `operands` have numbers at run time by name."""
        closure = closure_of(function)
        bound = self._bound(closure, function, operands, {})
        found = self.function_for(closure, bound, hands_on=False)
        given = distinct((bound, closure))
        takes = [number for number, used in zip(given, found.used, strict=True) if used]
        if found.forward is not None:
            return Entry("", [], filled(found.template, _handed_on(found.forward, given)), False)
        members = [Num(field, hole.kind) for field, hole in zip(found.fields, found.holes, strict=True)]
        return Entry(found.name, takes, with_alike(filled(found.template, members)), found.may_fail)

    def texts(self, entries: Sequence["Entry"]) -> list[str]:
        """Return the C functions and structs that entries need, each after those that it uses."""
        needed, kept = {entry.name for entry in entries}, []
        for name, text in reversed(self.functions):
            if name in needed:
                needed |= code.names_in(_COMMENT.sub("", text))
                kept.append((name, text))
        return constants.with_tables(code.merged(kept[::-1]))

    # what a scope asks for

    def attribute(self, unit: Unit, owner: Any, name: str) -> Any:
        """Return a member of a value; properties are computed."""
        if isinstance(owner, Num):
            raise Untranslatable(f"'{owner.text}'.{name}: a number has no members here")
        if isinstance(owner, grids.Grid):
            return grid_library.attribute(unit, owner, name)
        if isinstance(owner, Super):
            return types.MethodType(method_after(owner.cls, type(owner.owner), name), owner.owner)
        if not is_dynamic(owner) or isinstance(owner, dict | list | np.ndarray):
            return getattr(owner, name)
        found = _member(type(owner), name)  # type: ignore[arg-type]
        if isinstance(found, property):
            assert isinstance(found.fget, types.FunctionType)
            return self.call(unit, found.fget, [owner], {})
        if isinstance(found, functools.cached_property):
            if name not in vars(owner):
                value = unit.named(name, self.call(unit, found.func, [owner], {}))  # type: ignore[arg-type]
                vars(owner)[name] = value
                unit.cached.append((owner, name))
            return vars(owner)[name]
        if isinstance(found, types.FunctionType):
            return Method(found, owner)
        return getattr(owner, name)

    def call(
        self, unit: Unit, function: types.FunctionType | Closure, operands: list[Any], named: dict[str, Any]
    ) -> Any:
        """Return what a call gives; writes the C function if it is new."""
        if isinstance(function, Closure):
            closure = function
        else:
            function = _bare(self._instead.get(function, function))
            if not is_dynamic(operands) and not is_dynamic(named):
                return function(*operands, **named)
            closure = closure_of(function)
            of_arrays = any(map(is_dynamic, arrays_in([*operands, *named.values()])))
            if of_arrays and _is_elementwise(function) and not is_compiled(closure.node):
                return self._on_arrays(unit, function, operands, named)
        bound = self._bound(closure, function, operands, named)
        expression = None if is_compiled(closure.node) else expression_of(closure.node)
        if expression is not None:
            names = {name: unit.named(name, value) for name, value in bound.items()}
            return Scope(self, unit, names, closure).value(expression)
        bound = {name: grids.settled(unit, value, name) for name, value in bound.items()}
        found = self.function_for(closure, bound)
        return self._called(unit, found, distinct((bound, closure)))

    def _on_arrays(self, unit: Unit, function: types.FunctionType, operands: list[Any], named: dict[str, Any]) -> Any:
        """Return what a law gives for each element of arrays."""
        own, names, closure = len(operands), list(named), closure_of(function)
        straight = is_straight(closure.node)
        operands = [grids.settled(unit, each, closure.name, cheap=False) for each in operands]

        def one(*each: Any) -> Any:
            operands, named = list(each[:own]), dict(zip(names, each[own:], strict=True))
            if not straight:
                return self.call(unit, function, operands, named)
            scope = Scope(self, unit, self._bound(closure, function, operands, named), closure)
            *before, last = statements_of(closure.node)
            scope.run(before)
            assert isinstance(last, ast.Return) and last.value is not None
            return scope.value(last.value)

        return on_arrays(unit, closure.name, one, [*operands, *named.values()])

    def _bound(self, closure: Closure, function: Any, operands: list[Any], named: dict[str, Any]) -> dict[str, Any]:
        """Return the parameters by name."""
        if not isinstance(function, Closure):
            given = _signature(function).bind(*operands, **named)
            given.apply_defaults()
            return dict(given.arguments)
        names = [each.arg for each in closure.node.args.args + closure.node.args.kwonlyargs]
        return dict(zip(names, operands, strict=False)) | named

    def _called(self, unit: Unit, found: CFunction, given: list[Num]) -> Any:
        given = list(given)
        for name, place in found.given:  # used again after the call
            given[place] = unit.let(name or "given", given[place])
        made = self._made(unit, found, given)
        return with_alike(made) if found.repeats else made

    def _made(self, unit: Unit, found: CFunction, given: list[Num]) -> Any:
        template = with_given(found.template, given) if found.given else found.template
        if found.forward is not None:
            return filled(template, _handed_on(found.forward, given))
        texts = [number.text for number, used in zip(given, found.used, strict=True) if used]
        arrays = {
            field: unit.variable(field, hole.kind)
            for field, hole in zip(found.fields, found.holes, strict=True)
            if "[" in hole.kind
        }
        writes = {grids.base_of(given[place]) for place in found.writes} | {array.text for array in arrays.values()}
        for name in writes:
            unit.writes(name)
        texts += [array.text for array in arrays.values()]
        if found.may_fail:
            texts.append("why")
        result = self._result(unit, found, f"{found.name}({', '.join(texts)})", frozenset(writes))
        if found.may_fail:
            self.leave_if_refused(unit)
        return filled(template, [arrays[field] if field in arrays else result(field) for field in found.fields])

    def _result(self, unit: Unit, found: CFunction, call: str, writes: frozenset[str]) -> Callable[[str], Num]:
        """Write a call; return the numbers that it gives, by the names of members."""
        holes = zip(found.fields, found.holes, strict=True)
        kinds = {field: hole.kind for field, hole in holes if "[" not in hole.kind}
        if not kinds:
            if found.may_fail:
                unit.emit(code.Do(f"{call};"))
            elif writes:
                unit.emit(code.Call(f"{call};", writes))
            return lambda _: Num("")
        if len(kinds) == 1:
            (kind,) = kinds.values()
            if not (found.may_fail or writes):
                return lambda _: Num(call, kind)
            name = unit.fresh(found.name)
            unit.emit(code.Let(code.c_type(kind), name, call, found.may_fail, writes=writes))
            return lambda _: Num(name, kind)
        struct = None if writes else unit.known(call)
        if struct is None:
            struct = unit.fresh(f"of_{found.name}")
            unit.keep(call, struct)
            unit.emit(code.Let(f"struct {found.name}", struct, call, found.may_fail, writes=writes))
        return lambda field: Num(f"{struct}.{field}", kinds[field])


_signature = functools.cache(inspect.signature)


@functools.cache
def _member(kind: type, name: str) -> Any:
    """Return what a class has by a name."""
    return inspect.getattr_static(kind, name, None)


def _bare(function: Any) -> types.FunctionType:
    """Return a function without its wrappers, such as that of the compiler."""
    return inspect.unwrap(function)


def _is_elementwise(function: types.FunctionType) -> bool:
    """Return True for functions of laws, also a user's own: what they say of a number they say of each of an array."""
    module = function.__module__
    return (module.startswith(_LAWS) and module != _OF_LAYERS) or not module.startswith((_CORE, _PARTS))


def _handed_on(forward: Sequence[int | str], given: Sequence[Num]) -> list[Num]:
    """Return the numbers of a function that only hands on."""
    return [given[each] if isinstance(each, int) else Num(each, binds=UNARY) for each in forward]
