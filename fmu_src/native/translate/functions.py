"""From Python functions and their calls to C functions: one for each way in which a function is used."""

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
from .grids import is_array
from .interpreter import Scope
from .passes import arranged
from .results import (
    distinct,
    fields_of,
    filled,
    forwarded,
    given_places,
    handed_on,
    has_alike,
    holes_in,
    parameter_of,
    part_names,
    wanted_fields,
    with_alike,
    with_given,
)
from .sources import about, closure_of, expression_of, is_compiled, is_straight, method_after, statements_of
from .units import Text, Unit, matched, template_of, unique
from .values import UNARY, Closure, Method, Num, Untranslatable, is_dynamic, leaves, replaced, signature

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_CORE, _LAWS, _OF_LAYERS = "contact_core.", "contact_core.laws.", "contact_core.laws.stress"
_PARTS = "system_models."
_UNREAD = "unread_"  # stands, with a number, for a member that nothing reads in the end


@dataclass
class CFunction:
    """A C function that stands for a Python one with some of its parameters known."""

    name: str
    used: list[bool]  # which of the numbers at run time it takes
    template: Any  # what it returns; numbers at run time have no text
    fields: list[str]  # members of the struct that it returns; one or none: no struct
    may_fail: bool
    forward: list[int | str] | None = None  # a function that only hands on: places of its numbers, or constants
    writes: frozenset[int] = frozenset()  # which of them are arrays that it sets

    @functools.cached_property
    def holes(self) -> list[Num]:
        """The numbers that it returns."""
        return holes_in(self.template)

    @functools.cached_property
    def given(self) -> list[tuple[str, int]]:
        """Names and places of the numbers that it hands on."""
        return given_places(self.template)

    @functools.cached_property
    def repeats(self) -> bool:
        """Whether it returns any number more than once."""
        return has_alike(self.template)


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
        return sum(1 for _, number in leaves(self.result) if "[" not in number.kind) if self.name else 0

    @property
    def arrays(self) -> list[Num]:
        """Arrays that it sets."""
        return [number for _, number in leaves(self.result) if "[" in number.kind] if self.name else []

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


class Translator:
    """Writes the C functions of a program."""

    def __init__(
        self, reads: Mapping[Any, set[str]] | None = None, instead: Mapping[Any, types.FunctionType] | None = None
    ) -> None:
        """Begin a program.

        reads: members that are read of the structs of functions, where that is known. instead: functions of scalars
        that stand for others, of arrays.
        """
        self._reads = reads or {}
        self._instead = instead or {}
        self.functions: list[tuple[str, str]] = []  # names and texts, each after those that it calls
        self._cache: dict[Any, CFunction] = {}
        self._names: set[str] = set()
        self._unread: list[tuple[Any, str]] = []  # what a function is made from, and a member that nothing reads
        self._keys: dict[str, Any] = {}  # what the functions are made from, by their names
        self._units: list[Unit] = []
        self._kept: list[Any] = []

    def program(self, function: types.FunctionType, operands: list[Any]) -> "Entry":
        """Write a function that C code calls, with all it needs; `operands` have numbers at run time by name."""
        closure = closure_of(function)
        bound = self._bound(closure, function, operands, {})
        found = self._function(closure, bound, hands_on=False)
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

    def wanted(self, texts: Sequence[str], entries: Sequence["Entry"]) -> dict[Any, set[str]]:
        """Return the members that anything reads of the structs of functions, by what these are; of entries all."""
        found: dict[Any, set[str]] = {}
        for text in texts:
            for name in re.findall(r"(?<=[;{}])\n +(\w+)\(", text):  # calls whose results nothing reads
                if name in self._keys:
                    found.setdefault(self._keys[name], set())
            for struct, name in re.findall(r"const struct (\w+)\s+(\w+)\s+=", text):
                if struct in self._keys:
                    found.setdefault(self._keys[struct], set()).update(re.findall(rf"\b{name}\.(\w+)", text))
        for entry in entries:
            found.pop(self._keys.get(entry.name), None)
        return found

    def missed(self, texts: Sequence[str]) -> list[tuple[Any, str]]:
        """Return what a function is made from and the member, of members marked as unread that texts read after all."""
        return [self._unread[int(place)] for text in texts for place in set(re.findall(rf"\b{_UNREAD}(\d+)", text))]

    def _wanted(self, name: str, template: Any, names: list[str]) -> Any:
        """Return the form of a result in which members that nobody reads are marked."""
        if self._keys[name] not in self._reads:
            return template
        fields, key = iter(fields_of(template, names)), self._keys[name]

        def marked(hole: Num) -> Num:
            field = next(fields)
            if hole.text or "[" in hole.kind or field in self._reads[key]:
                return hole
            self._unread.append((key, field))
            return Num(f"{_UNREAD}{len(self._unread) - 1}", hole.kind)

        return replaced(template, marked)

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
        found = self._function(closure, bound)
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
            self._checked(unit)
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

    def _checked(self, unit: Unit) -> None:
        """Leave the function if the one called has refused."""
        unit.may_fail = True
        unit.emit(code.If("why->text[0] != '\\0'", [code.Do(self._nothing(unit))]))

    def _nothing(self, unit: Unit) -> str:
        holes = [hole for hole in holes_in(unit.template) if "[" not in hole.kind]
        if not holes:
            return "return;"
        return "return 0;" if len(holes) == 1 else f"return (struct {unit.name}){{0}};"

    def gives(self, unit: Unit, value: Any) -> None:
        """Return a value from the function of a unit."""
        unit.returned.append(grids.settled(unit, value, "found") if unit.scratch else value)
        if unit.scratch:
            return
        wanted = [not number.text for _, number in leaves(unit.template)]
        numbers = [each for each, want in zip(matched(value, unit.template), wanted, strict=True) if want]
        fields = wanted_fields(unit.template, unit.part_names)
        members = [(field, number) for field, number in zip(fields, numbers, strict=True) if not is_array(number)]
        for out, number in zip(unit.outs, filter(is_array, numbers), strict=True):
            grids.give(unit, out, number)
        if not members:
            unit.emit(code.Do("return;"))
        elif len(members) == 1:
            unit.emit(code.Do(f"return {members[0][1].text};"))
        else:
            unit.emit(code.Give(unit.name, [(field, number.text) for field, number in members]))

    def refuses(self, unit: Unit, text: Text) -> None:
        """Leave the function of a unit with a message."""
        unit.may_fail = True
        operands = "".join(f", {number.text}" for number in text.operands)
        unit.emit(code.Do(f"refuse(why, {code.quoted(text.form)}{operands});"))
        unit.emit(code.Do(self._nothing(unit)))

    # C functions

    def _function(self, closure: Closure, bound: dict[str, Any], *, hands_on: bool = True) -> CFunction:
        """Return the C function for parameters like these; with `hands_on` it does not return what it is given."""
        key = (
            ast.dump(closure.node) if isinstance(closure.node, ast.Lambda) else id(closure.node),
            closure.path,
            signature(bound),
            signature(closure),
            _alike([number.text for _, number in leaves((bound, closure))]),
        )
        if key not in self._cache:
            self._kept.append((closure, bound))
            name = self._new_name(closure.name)
            self._keys[name] = key
            parameters: list[Num] = []
            first = self._written(name, closure, bound, None, parameters)
            if not first.returned:
                raise Untranslatable(f"{closure.path} always refuses")
            template = template_of(first.returned)
            marked = handed_on(template, first.returned, parameters if hands_on else [])
            if hands_on or len(holes_in(marked)) > 1:
                template = marked
            self._cache[key] = self._finished(name, closure, bound, template)
        return self._cache[key]

    def _new_name(self, name: str) -> str:
        taken = self._names.union(*(unit.names for unit in self._units))
        found = unique(name.lstrip("_"), taken)
        self._names.add(found)
        return found

    def _written(
        self, name: str, closure: Closure, bound: dict[str, Any], template: Any, parameters: list[Num] | None = None
    ) -> Unit:
        """Return a function of which the statements are written."""
        unit = Unit(name, template, part_names(closure.node), scratch=template is None)
        unit.names |= self._names
        unit.compiled = is_compiled(closure.node)
        self._units.append(unit)
        made: list[Num] = [] if parameters is None else parameters
        names = iter([leaf for leaf, _ in leaves((bound, closure))])
        known: dict[str, Num] = {}

        def parameter(number: Num) -> Num:
            name = next(names)
            if number.text not in known:  # what is given twice is one parameter
                known[number.text] = Num(unit.fresh(name), number.kind)
                made.append(known[number.text])
                if "[" in number.kind:
                    unit.arrays.add(made[-1].text)
            return known[number.text]

        own, seen = replaced((bound, closure), parameter)
        if template is not None:
            named = zip(wanted_fields(template, unit.part_names), holes_in(template), strict=True)
            unit.outs = [unit.fresh(name) for name, hole in named if "[" in hole.kind]
            unit.arrays |= {*unit.outs}
        scope = Scope(self, unit, dict(own), seen)
        if scope.run(closure.node.body):
            self.gives(unit, None)
        self._units.pop()
        return unit

    def _finished(self, name: str, closure: Closure, bound: dict[str, Any], template: Any) -> CFunction:
        parameters: list[Num] = []
        template = self._wanted(name, template, part_names(closure.node))
        holder = template if template is not None else ()
        unit = self._written(name, closure, bound, holder, parameters)
        every, all_fields = holes_in(holder), wanted_fields(holder, unit.part_names)
        arrays, holes = ([h for h in every if ("[" in h.kind) is array] for array in (True, False))
        fields = [field for field, hole in zip(all_fields, every, strict=True) if "[" not in hole.kind]
        sets = frozenset(i for i, parameter in enumerate(parameters) if parameter.text in unit.written)
        if not every and not unit.may_fail and not sets:
            return CFunction(name, [False] * len(parameters), template, [], False)
        if not unit.may_fail and not unit.outs and not sets and not unit.blocks[0][:-1]:
            forward = forwarded(unit, holder, parameters)
            if forward is not None:
                return CFunction(name, [False] * len(parameters), template, fields, False, forward)
        block = arranged(unit, unit.blocks[0], {*unit.outs, *(parameters[i].text for i in sets)})
        if not holes and block and isinstance(block[-1], code.Do) and block[-1].text == "return;":
            block.pop()
        names = code.used(block)
        used = [number.text in names for number in parameters]
        given = [parameter_of(p, p.text in unit.written) for p, each in zip(parameters, used, strict=True) if each]
        given += [parameter_of(Num(out, hole.kind), True) for out, hole in zip(unit.outs, arrays, strict=True)]
        if unit.may_fail:
            given.append("contact_message *why")
        if not holes:
            result = "void"
        elif len(holes) == 1:
            result = code.c_type(holes[0].kind)
        else:
            result = f"struct {name}"
            members = [f"    {code.c_type(h.kind)} {f};" for f, h in zip(fields, holes, strict=True)]
            self.functions.append((name, "\n".join([f"struct {name} {{", *members, "};"])))
        head = code.head(result, name, given)
        self.functions.append((name, "\n".join([*code.comment(about(closure)), *head, "{", *code.printed(block), "}"])))
        return CFunction(name, used, template, all_fields, unit.may_fail, None, sets)


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


def _alike(texts: list[str]) -> tuple[int, ...]:
    """Return which of some expressions are the same: of each, the place where it comes first."""
    first: dict[str, int] = {}
    return tuple(first.setdefault(text, place) for place, text in enumerate(texts))
