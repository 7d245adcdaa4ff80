"""From Python functions and their calls to C functions: one for each way in which a function is used."""

import ast
import functools
import inspect
import re
import textwrap
import types
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import code
from .interpreter import Scope, Text
from .units import Poison, Unit, matched, template_of, unified, unique
from .values import UNARY, Closure, Method, Num, Untranslatable, is_dynamic, leaves, replaced, signature

_MOST_ROUNDS = 1000  # of a loop whose end is known at run time only: the time of a step is bounded
_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_ELEMENTWISE = "contact_core.laws"  # laws say of each element of an array what they say of a number
_UNREAD = "unread"  # stands for a number that nothing reads in the end
_TOO_LONG = f"The step changes the surfaces so much that it needs more than {_MOST_ROUNDS} parts. Take shorter steps."


@dataclass
class CFunction:
    """A C function that stands for a Python one with some of its parameters known."""

    name: str
    used: list[bool]  # which of the numbers at run time it takes
    template: Any  # what it returns; numbers at run time have no text
    fields: list[str]  # members of the struct that it returns; one or none: no struct
    may_fail: bool
    forward: list[int | str] | None = None  # a function that only hands on: places of its numbers, or constants


@dataclass
class Entry:
    """A C function to be called from outside."""

    name: str  # empty: there is nothing to compute
    takes: list[Num]
    result: Any  # its numbers at run time are members of the struct that it returns; without a name, what it takes
    may_fail: bool

    @property
    def returns(self) -> int:
        """How many numbers it returns; one is no struct."""
        return len(list(leaves(self.result))) if self.name else 0

    def called(self, inputs: Sequence[str], constants: Collection[str] = ()) -> str:
        """Return the call, with inputs and state from structs `in` and `state`."""
        given = [self.place(number, inputs, constants) for number in self.takes]
        return f"{self.name}({', '.join([*given, *(['why'] if self.may_fail else [])])})"


    @staticmethod
    def place(number: Num, inputs: Sequence[str], constants: Collection[str] = ()) -> str:
        """Return a number that it takes."""
        if number.text == "dt" or number.text in constants:
            return number.text
        return f"{'in' if number.text in inputs else 'state'}->{number.text}"


class _Whole:
    """A value that stands as one in an array of objects."""

    def __init__(self, value: Any) -> None:
        self.value = value


@functools.cache
def _tree(function: types.FunctionType) -> Any:
    """Return the syntax tree of a function."""
    source = textwrap.dedent(inspect.getsource(function))
    found = next(
        node
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.FunctionDef | ast.Lambda) and getattr(node, "name", "<lambda>") == function.__name__
    )
    return found


def _closure_of(function: types.FunctionType) -> Closure:
    cells = function.__closure__ or ()
    names = dict(zip(function.__code__.co_freevars, (cell.cell_contents for cell in cells), strict=True))
    path = f"{function.__module__}.{function.__qualname__}"
    return Closure(_tree(function), _name_of(function), names, function.__globals__, path)


def _name_of(function: types.FunctionType) -> str:
    """Return the name of the C function: that of its class before that of a method."""
    owner, _, name = function.__qualname__.rpartition(".")
    owner = owner.rpartition(".")[2].lstrip("_")
    if not owner or owner == "<locals>":
        return name.strip("_")
    snake = "".join(f"_{c.lower()}" if c.isupper() and i else c.lower() for i, c in enumerate(owner))
    return snake if name == "__call__" else f"{snake}_{name.strip('_')}"


class Translator:
    """Writes the C functions of a program."""

    def __init__(
        self, reads: Mapping[str, set[str]] | None = None, instead: Mapping[Any, types.FunctionType] | None = None
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
        self._units: list[Unit] = []
        self._kept: list[Any] = []

    def program(self, name: str, function: types.FunctionType, operands: list[Any]) -> "Entry":
        """Write a function that C code calls, with all it needs; `operands` have numbers at run time by name."""
        closure = _closure_of(function)
        bound = self._bound(closure, function, operands, {})
        found = self._function(closure, bound)
        given = _distinct((bound, closure))
        takes = [number for number, used in zip(given, found.used, strict=True) if used]
        if found.forward is not None:
            members = [literal_or(given, each) for each in found.forward]
            return Entry("", [], _filled(found.template, members), False)
        members = [Num(field, hole.kind) for field, hole in zip(found.fields, _holes(found.template), strict=True)]
        return Entry(found.name, takes, _filled(found.template, members), found.may_fail)

    def texts(self, entries: Sequence["Entry"]) -> list[str]:
        """Return the C functions and structs that entries need, each after those that it uses."""
        needed, kept = {entry.name for entry in entries}, []
        for name, text in reversed(self.functions):
            if name in needed:
                needed |= code.names_in(_COMMENT.sub("", text))
                kept.append(text)
        return kept[::-1]

    def wanted(self, texts: Sequence[str], entries: Sequence["Entry"]) -> dict[str, set[str]]:
        """Return the members that anything reads of the structs of functions; of entries all."""
        found: dict[str, set[str]] = {}
        for text in texts:
            for struct, name in re.findall(r"const struct (\w+) (\w+) =", text):
                found.setdefault(struct, set()).update(re.findall(rf"\b{name}\.(\w+)", text))
        for entry in entries:
            found.pop(entry.name, None)
        return found

    def _wanted(self, name: str, template: Any) -> Any:
        """Return the form of a result in which members that nobody reads are marked."""
        if name not in self._reads:
            return template
        fields = iter(_fields(template))
        return replaced(template, lambda hole: Num("" if next(fields) in self._reads[name] else _UNREAD, hole.kind))

    # what a scope asks for

    def attribute(self, unit: Unit, owner: Any, name: str) -> Any:
        """Return a member of a value; properties are computed."""
        if isinstance(owner, Num):
            raise Untranslatable(f"'{owner.text}'.{name}: a number has no members here")
        if not is_dynamic(owner) or isinstance(owner, dict | list | np.ndarray):
            return getattr(owner, name)
        found = inspect.getattr_static(type(owner), name, None)
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
            function = self._instead.get(function, function)
            if not is_dynamic(operands) and not is_dynamic(named):
                return function(*operands, **named)
            closure = _closure_of(function)
            arrays = [x for x in (*operands, *named.values()) if isinstance(x, np.ndarray) and is_dynamic(x)]
            if arrays and function.__module__.startswith(_ELEMENTWISE) and not any(map(_has_arrays, operands)):
                return self._on_arrays(unit, function, operands, named)
        bound = self._bound(closure, function, operands, named)
        expression = _expression(closure.node)
        if expression is not None:
            names = {name: unit.named(name, value) for name, value in bound.items()}
            return Scope(self, unit, names, closure).value(expression)
        found = self._function(closure, bound)
        return self._called(unit, found, _distinct((bound, closure)))

    def _on_arrays(self, unit: Unit, function: Any, operands: list[Any], named: dict[str, Any]) -> Any:
        """Return what a law gives for each element of arrays."""
        own, names = len(operands), list(named)

        closure = _closure_of(function)
        straight = _is_straight(closure.node)

        def one(*each: Any) -> Any:
            operands, named = list(each[:own]), dict(zip(names, each[own:], strict=True))
            if not straight:
                return self.call(unit, function, operands, named)
            scope = Scope(self, unit, self._bound(closure, function, operands, named), closure)
            *before, last = _statements(closure.node)
            scope.run(before)
            assert isinstance(last, ast.Return) and last.value is not None
            return scope.value(last.value)

        whole = [x if isinstance(x, np.ndarray | Num | float | int) else _Whole(x) for x in (*operands, *named.values())]
        arrays = np.broadcast_arrays(*[np.asarray(x, object) for x in whole])
        found = np.empty(arrays[0].shape, object)
        for place in np.ndindex(found.shape):
            each = [x[place].value if isinstance(x[place], _Whole) else x[place] for x in arrays]
            found[place] = unit.named("element", one(*each))
        return found

    def _bound(self, closure: Closure, function: Any, operands: list[Any], named: dict[str, Any]) -> dict[str, Any]:
        """Return the parameters by name."""
        if not isinstance(function, Closure):
            given = inspect.signature(function).bind(*operands, **named)
            given.apply_defaults()
            return dict(given.arguments)
        names = [each.arg for each in closure.node.args.args + closure.node.args.kwonlyargs]
        return dict(zip(names, operands, strict=False)) | named

    def _called(self, unit: Unit, found: CFunction, given: list[Num]) -> Any:
        if found.forward is not None:
            return _filled(found.template, [literal_or(given, each) for each in found.forward])
        texts = [number.text for number, used in zip(given, found.used, strict=True) if used]
        if found.may_fail:
            texts.append("why")
        call = f"{found.name}({', '.join(texts)})"
        holes = _holes(found.template)
        if not holes:
            if found.may_fail:
                unit.emit(code.Do(f"{call};"))
                self._checked(unit)
            return found.template
        if len(holes) == 1:
            result = Num(call, holes[0].kind)
            if found.may_fail:
                name = unit.fresh(found.name)
                unit.emit(code.Let(code.c_type(result.kind), name, call))
                result = Num(name, result.kind)
                self._checked(unit)
            return _filled(found.template, [result])
        name = unit.known(call)
        if name is None:
            name = unit.fresh(f"of_{found.name}")
            unit.keep(call, name)
            unit.emit(code.Let(f"struct {found.name}", name, call))
            if found.may_fail:
                self._checked(unit)
        members = [Num(f"{name}.{field}", hole.kind) for field, hole in zip(found.fields, holes, strict=True)]
        return _filled(found.template, members)

    def _checked(self, unit: Unit) -> None:
        """Leave the function if the one called has refused."""
        unit.may_fail = True
        unit.emit(code.If("why->text[0] != '\\0'", [code.Do(self._nothing(unit))]))

    def _nothing(self, unit: Unit) -> str:
        holes = _holes(unit.template)
        if not holes:
            return "return;"
        return "return 0;" if len(holes) == 1 else f"return (struct {unit.name}){{0}};"

    def gives(self, unit: Unit, value: Any) -> None:
        """Return a value from the function of a unit."""
        unit.returned.append(value)
        if unit.scratch:
            return
        wanted = [not number.text for _, number in leaves(unit.template)]
        numbers = [each for each, want in zip(matched(value, unit.template), wanted, strict=True) if want]
        if not numbers:
            unit.emit(code.Do("return;"))
        elif len(numbers) == 1:
            unit.emit(code.Do(f"return {numbers[0].text};"))
        else:
            fields = _wanted_fields(unit.template)
            given = ", ".join(f".{field} = {number.text}" for field, number in zip(fields, numbers, strict=True))
            unit.emit(code.Do(f"return (struct {unit.name}){{{given}}};"))

    def refuses(self, unit: Unit, text: Text) -> None:
        """Leave the function of a unit with a message."""
        unit.may_fail = True
        operands = "".join(f", {number.text}" for number in text.operands)
        quoted = text.form.replace("\\", "\\\\").replace('"', '\\"')
        unit.emit(code.Do(f'refuse(why, "{quoted}"{operands});'))
        unit.emit(code.Do(self._nothing(unit)))

    def counted(self, scope: Scope, node: ast.For, items: range) -> None:
        """Write a loop over a range."""
        assert isinstance(node.target, ast.Name)
        name = scope.unit.fresh(node.target.id)
        before = "<" if items.step > 0 else ">"
        head = f"for (int {name} = {items.start}; {name} {before} {items.stop}; {name} += {items.step})"
        scope.names[node.target.id] = Num(name, "i")
        self._loop(scope, head, node.body, None)  # what follows is reached
        scope.names.pop(node.target.id, None)

    def repeated(self, scope: Scope, node: ast.While) -> bool:
        """Write a loop whose end is known at run time only; return True if what follows it is reached."""
        if isinstance(node.test, ast.Constant) and node.test.value:
            return self._loop(scope, "for (;;)", node.body, None)
        name = scope.unit.fresh("rounds")
        return self._loop(scope, f"for (int {name} = 0;; ++{name})", node.body, node.test, name)

    def _loop(self, scope: Scope, head: str, body: list[ast.stmt], test: ast.expr | None, rounds: str = "") -> bool:
        """Write a loop: names that change in it become variables."""
        unit, before = scope.unit, dict(scope.names)
        changing = [name for name in _assigned(body) if name in before and not isinstance(before[name], Poison)]
        start = {name: before[name] for name in changing}
        forms = {name: replaced(value, lambda number: Num("", number.kind)) for name, value in start.items()}
        while True:
            mark, names = len(unit.blocks[-1]), set(unit.names)
            carried = {name: _variables(unit, name, forms[name]) for name in changing}
            ends: list[dict[str, Any]] = []
            scope.names = before | carried
            left, inside = unit.branch(lambda: self._round(scope, body, test, rounds, carried, ends))  # noqa: B023
            wider = {name: self._wider(name, forms[name], start[name], ends) for name in changing}
            if all(signature(wider[name]) == signature(forms[name]) for name in changing):
                break
            forms = wider
            del unit.blocks[-1][mark:]
            unit.names = names
        for name in changing:
            for variable, value in zip(leaves(carried[name]), matched(start[name], forms[name]), strict=True):
                unit.emit(code.Put(variable[1].text, value.text))
        unit.emit(code.Loop(head, inside))
        scope.names = {name: value for name, value in (before | carried).items()}
        return bool(left)

    def _round(
        self,
        scope: Scope,
        body: list[ast.stmt],
        test: ast.expr | None,
        rounds: str,
        carried: dict[str, Any],
        ends: list[dict[str, Any]],
    ) -> bool:
        """Write one round of a loop; return True if the loop has an end."""
        unit, has_end = scope.unit, test is not None
        if test is not None:
            goes_on = scope.truth(scope.value(test))
            unit.emit(code.If((~goes_on).text, [code.Do("break;")]))
            self._ended(unit, rounds)

        def put_back(inner: Scope, leaves_loop: bool) -> None:
            nonlocal has_end
            has_end |= leaves_loop
            ends.append({name: inner.names[name] for name in carried})
            _put_back(unit, carried, ends[-1])

        unit.loops.append(put_back)
        if scope.run(body):
            put_back(scope, False)
        unit.loops.pop()
        return has_end

    def _ended(self, unit: Unit, rounds: str) -> None:
        """Refuse to go on after so many rounds."""
        _, block = unit.branch(lambda: self.refuses(unit, Text(_TOO_LONG, [])))
        unit.emit(code.If(f"{rounds} >= {_MOST_ROUNDS}", block))

    @staticmethod
    def _wider(name: str, form: Any, start: Any, ends: list[dict[str, Any]]) -> Any:
        """Return the form of a variable at the start and after every round."""
        found = form
        for value in (start, *(end[name] for end in ends)):
            bare = replaced(value, lambda number: Num("", number.kind))
            found = unified(found, bare, lambda _, one, other: Num("", "d" if "d" in (_k(one), _k(other)) else "i"), name)
        return found

    # C functions

    def _function(self, closure: Closure, bound: dict[str, Any]) -> CFunction:
        """Return the C function for parameters like these."""
        key = (ast.dump(closure.node) if isinstance(closure.node, ast.Lambda) else id(closure.node), closure.path)
        key = (*key, signature(bound), signature(closure), _alike([number.text for _, number in leaves((bound, closure))]))
        if key not in self._cache:
            self._kept.append((closure, bound))
            name = self._new_name(closure.name)
            first = self._written(name, closure, bound, None)
            if not first.returned:
                raise Untranslatable(f"{closure.path} always refuses")
            self._cache[key] = self._finished(name, closure, bound, template_of(first.returned))
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
        unit = Unit(name, template, scratch=template is None)
        unit.names |= self._names
        self._units.append(unit)
        made: list[Num] = [] if parameters is None else parameters
        names = iter([leaf for leaf, _ in leaves((bound, closure))])
        known: dict[str, Num] = {}

        def parameter(number: Num) -> Num:
            name = next(names)
            if number.text not in known:  # what is given twice is one parameter
                known[number.text] = Num(unit.fresh(name), number.kind)
                made.append(known[number.text])
            return known[number.text]

        own, seen = replaced((bound, closure), parameter)
        scope = Scope(self, unit, dict(own), seen)
        if scope.run(closure.node.body):
            self.gives(unit, None)
        self._units.pop()
        return unit

    def _finished(self, name: str, closure: Closure, bound: dict[str, Any], template: Any) -> CFunction:
        parameters: list[Num] = []
        template = self._wanted(name, template)
        holder = template if template is not None else ()
        unit = self._written(name, closure, bound, holder, parameters)
        holes, fields = _holes(holder), _wanted_fields(holder)
        if not holes and not unit.may_fail:
            return CFunction(name, [False] * len(parameters), template, [], False)
        if not unit.may_fail and not unit.blocks[0][:-1]:
            forward = _forwarded(unit, holder, parameters)
            if forward is not None:
                return CFunction(name, [False] * len(parameters), template, fields, False, forward)
        block = code.pruned(unit.blocks[0], set())
        if not holes and block and isinstance(block[-1], code.Do) and block[-1].text == "return;":
            block.pop()
        names = code.used(block)
        used = [number.text in names for number in parameters]
        given = [f"{code.c_type(p.kind)} {p.text}" for p, each in zip(parameters, used, strict=True) if each]
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
        head = code._wrapped(f"static {result} {name}({', '.join(given) or 'void'})", 0)
        lines = [f"/* {_about(closure)} */", *head, "{", *code.printed(block), "}"]
        self.functions.append((name, "\n".join(lines)))
        return CFunction(name, used, template, fields, unit.may_fail)


def _forwarded(unit: Unit, template: Any, parameters: list[Num]) -> list[int | str] | None:
    """Return where the numbers that a function returns come from if it computes none of them, else None."""
    places = {parameter.text: place for place, parameter in enumerate(parameters)}
    found: list[int | str] = []
    wanted = [not number.text for _, number in leaves(template)]
    for number, want in zip(matched(unit.returned[-1], template), wanted, strict=True):
        if not want:
            continue
        if number.text in places:
            found.append(places[number.text])
        elif number.binds >= UNARY and not code.names_in(number.text):
            found.append(number.text)
        else:
            return None
    return found


def literal_or(given: list[Num], each: int | str) -> Num:
    """Return a parameter by its place, or a constant."""
    return given[each] if isinstance(each, int) else Num(each, binds=UNARY)


def _k(value: Any) -> str:
    from .values import kind_of

    return kind_of(value)


def _about(closure: Closure) -> str:
    """Return a comment: the first line of a function's text, and where it stands."""
    text = ast.get_docstring(closure.node) if isinstance(closure.node, ast.FunctionDef) else None
    first = f"{text.splitlines()[0]} " if text else ""
    return f"{first}[{closure.path}]".replace("*/", "* /")


def _statements(node: Any) -> list[ast.stmt]:
    """Return the statements of a function but its text."""
    return [each for each in node.body if not (isinstance(each, ast.Expr) and isinstance(each.value, ast.Constant))]


def _is_straight(node: Any) -> bool:
    """Return True for a function without choices and loops: each element of an array has a copy of it."""
    *before, last = _statements(node)
    return isinstance(last, ast.Return) and all(isinstance(each, ast.Assign) for each in before)


def _has_arrays(value: Any) -> bool:
    """Return True for a tuple of arrays: a law takes it as it is."""
    return isinstance(value, tuple) and any(isinstance(item, np.ndarray) for item in value)


def _expression(node: Any) -> ast.expr | None:
    """Return the expression of a function that is nothing else."""
    if isinstance(node, ast.Lambda):
        return node.body
    body = _statements(node)
    return body[0].value if len(body) == 1 and isinstance(body[0], ast.Return) else None


def _fields(template: Any) -> list[str]:
    """Return names for the numbers at run time of what a function returns."""
    found: list[str] = []
    for name, _ in leaves(template):
        own = name if name and not name[0].isdigit() else f"part_{name}"
        found.append(unique(re.sub(r"\W+", "_", own).strip("_"), set(found)))
    return found


def _alike(texts: list[str]) -> tuple[int, ...]:
    """Return which of some expressions are the same."""
    return tuple(map(texts.index, texts))


def _distinct(value: Any) -> list[Num]:
    """Return the numbers at run time of a value, each once."""
    return list({number.text: number for _, number in leaves(value)}.values())


def _holes(template: Any) -> list[Num]:
    """Return the numbers that a function returns."""
    return [] if template is None else [number for _, number in leaves(template) if not number.text]


def _wanted_fields(template: Any) -> list[str]:
    """Return their names."""
    return [field for field, (_, each) in zip(_fields(template), leaves(template), strict=True) if not each.text]


def _filled(template: Any, numbers: list[Num]) -> Any:
    """Return a result with these numbers in it."""
    given = iter(numbers)
    return replaced(template, lambda hole: hole if hole.text else next(given))


def _assigned(body: list[ast.stmt]) -> list[str]:
    """Return the names that statements bind, in order."""
    found: dict[str, None] = {}
    for statement in body:
        for node in ast.walk(statement):
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and node.id != "_":
                found[node.id] = None
    return list(found)


def _variables(unit: Unit, name: str, form: Any) -> Any:
    """Return a value of some form whose numbers at run time are variables."""
    names = iter([leaf for leaf, _ in leaves(form, name)])
    made: Callable[[Num], Num] = lambda number: unit.variable(_of(name, next(names)), number.kind)  # noqa: E731
    return replaced(form, made)


def _of(name: str, leaf: str) -> str:
    return leaf if leaf.startswith(name) else f"{name}_{leaf}"


def _put_back(unit: Unit, carried: dict[str, Any], now: dict[str, Any]) -> None:
    """Set the variables of a loop to their values after a round, all at once."""
    pairs: list[tuple[str, Num]] = []
    for name, variable in carried.items():
        form = replaced(variable, lambda number: Num("", number.kind))
        for (_, target), value in zip(leaves(variable), matched(now[name], form), strict=True):
            if value.text != target.text:
                pairs.append((target.text, value))
    targets = {target for target, _ in pairs}
    for target, value in [*pairs]:
        if code.names_in(value.text) & targets:  # would have changed by then
            held = unit.fresh(f"next_{target}")
            unit.emit(code.Let(code.c_type(value.kind), held, value.text))
            pairs[pairs.index((target, value))] = target, Num(held, value.kind)
    for target, value in pairs:
        unit.emit(code.Put(target, value.text))
