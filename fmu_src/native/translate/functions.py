"""C functions: one for each way in which a Python function is used."""

import ast
import functools
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from types import FunctionType
from typing import Any

from . import code, grids
from .grids import is_array
from .interpreter import Scope
from .members import Members
from .passes import arranged
from .results import (
    forwarded,
    given_places,
    handed_on,
    has_alike,
    holes_in,
    parameter_of,
    part_names,
    wanted_fields,
)
from .sources import about, is_compiled
from .units import Text, Unit, matched, template_of, unique
from .values import Closure, Num, Untranslatable, leaves, numbers, replaced, signature


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


class Functions(ABC):
    """The C functions of a program, written as their calls are found."""

    def __init__(self, reads: Mapping[Any, set[str]]) -> None:
        self.members = Members(reads)
        self.functions: list[tuple[str, str]] = []  # names and texts, each after those that it calls
        self._cache: dict[Any, CFunction] = {}
        self._names: set[str] = set()
        self._units: list[Unit] = []
        self._kept: list[Any] = []

    @abstractmethod
    def attribute(self, unit: Unit, owner: Any, name: str) -> Any:
        """Return a member of a value."""

    @abstractmethod
    def call(self, unit: Unit, function: FunctionType | Closure, operands: list[Any], named: dict[str, Any]) -> Any:
        """Return what a call gives."""

    def function_for(self, closure: Closure, bound: dict[str, Any], *, hands_on: bool = True) -> CFunction:
        """Return the C function for parameters like these; with `hands_on` it does not return what it is given."""
        key = (
            ast.dump(closure.node) if isinstance(closure.node, ast.Lambda) else id(closure.node),
            closure.path,
            signature(bound),
            signature(closure),
            _alike([number.text for number in numbers((bound, closure))]),
        )
        if key not in self._cache:
            self._kept.append((closure, bound))
            name = self._new_name(closure.name)
            self.members.keys[name] = key
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
        template = self.members.marked(name, template, part_names(closure.node))
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

    def gives(self, unit: Unit, value: Any) -> None:
        """Return a value from the function of a unit."""
        unit.returned.append(grids.settled(unit, value, "found") if unit.scratch else value)
        if unit.scratch:
            return
        wanted = [not number.text for number in numbers(unit.template)]
        given = [each for each, want in zip(matched(value, unit.template), wanted, strict=True) if want]
        fields = wanted_fields(unit.template, unit.part_names)
        members = [(field, number) for field, number in zip(fields, given, strict=True) if not is_array(number)]
        for out, number in zip(unit.outs, filter(is_array, given), strict=True):
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

    def leave_if_refused(self, unit: Unit) -> None:
        """Leave the function if the one called has refused."""
        unit.may_fail = True
        unit.emit(code.If("why->text[0] != '\\0'", [code.Do(self._nothing(unit))]))

    def _nothing(self, unit: Unit) -> str:
        holes = [hole for hole in holes_in(unit.template) if "[" not in hole.kind]
        if not holes:
            return "return;"
        return "return 0;" if len(holes) == 1 else f"return (struct {unit.name}){{0}};"


def _alike(texts: list[str]) -> tuple[int, ...]:
    """Return which of some expressions are the same: of each, the place where it comes first."""
    first: dict[str, int] = {}
    return tuple(first.setdefault(text, place) for place, text in enumerate(texts))
