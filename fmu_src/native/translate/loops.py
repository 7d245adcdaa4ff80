"""Loops that stay loops in C: names that change in them become variables."""

import ast
from collections.abc import Callable, Iterable
from typing import Any

from contact_core.state.parts import MOST_PARTS

from . import code, grids
from .library import Span
from .units import Names, Poison, Unit, common_kind, matched, unified
from .values import Num, leaves, literal, replaced, signature

MOST_ROUNDS = MOST_PARTS + 1  # of a loop whose end is known at run time only; steps of contacts are refused before
_TOO_LONG = f"The step needs more than {MOST_ROUNDS} parts: the surfaces change too much in it. Take shorter steps."


def counted(scope: Names, node: ast.For, items: range | Span) -> None:
    """Write a loop over a range."""
    assert isinstance(node.target, ast.Name)
    name = scope.unit.fresh(node.target.id)
    before = "<" if items.step > 0 else ">"
    start, stop = (literal(each, "i").text for each in (items.start, items.stop))
    head = f"for (int {name} = {start}; {name} {before} {stop}; {name} += {items.step})"
    scope.names[node.target.id] = Num(name, "i")
    _loop(scope, head, node.body, lambda: False)
    scope.names.pop(node.target.id, None)


def repeated(scope: Names, node: ast.While) -> bool:
    """Write a loop whose end is known at run time only; return True if what follows it is reached.

    It refuses the step after MOST_ROUNDS.
    """
    unit, rounds = scope.unit, scope.unit.fresh("rounds")
    endless = isinstance(node.test, ast.Constant) and bool(node.test.value)

    def begun() -> bool:
        if not endless:
            test = scope.test(node.test)
            unit.emit(code.If((~test if isinstance(test, Num) else literal(not test, "b")).text, [code.Do("break;")]))
        _, refused = unit.branch(lambda: scope.refuse(_TOO_LONG))
        unit.emit(code.If(f"{rounds} >= {MOST_ROUNDS}", refused))
        return not endless

    return _loop(scope, f"for (int {rounds} = 0;; ++{rounds})", node.body, begun)


def _loop(scope: Names, head: str, body: list[ast.stmt], begun: Callable[[], bool]) -> bool:
    """Write a loop; return True if it has an end. `begun` writes how every round begins, and says if that may end it.

    What changes from number to number, or from a constant to a number, is known once a round has been written.
    """
    unit, before = scope.unit, dict(scope.names)
    bound = _bound(body)
    again = _bound(body, in_place=False)  # arrays that are changed in place stay what they are
    changing = [
        name
        for name in bound
        if name in before
        and not isinstance(before[name], Poison)
        and (name in again or not isinstance(before[name], grids.Grid))
    ]
    start = {name: grids.settled(unit, before[name], name) for name in changing}
    forms = {name: replaced(value, lambda number: Num("", number.kind)) for name, value in start.items()}
    while True:
        mark, names = len(unit.blocks[-1]), set(unit.names)
        carried = {name: _variables(unit, name, forms[name]) for name in changing}
        ends: list[dict[str, Any]] = []
        scope.names = before | carried
        has_end, inside = unit.branch(lambda: _round(scope, body, begun, carried, ends))  # noqa: B023
        wider = {name: _wider(name, forms[name], [start[name], *(end[name] for end in ends)]) for name in changing}
        if all(signature(wider[name]) == signature(forms[name]) for name in changing):
            break
        forms = wider
        del unit.blocks[-1][mark:]
        unit.names = names
    for name in changing:
        for (_, variable), value in zip(leaves(carried[name]), matched(start[name], forms[name]), strict=True):
            unit.emit(code.set_to(variable.text, variable.kind, value.text))
    unit.emit(code.Loop(head, inside))
    inner = {name: Poison("it is bound in a loop alone: bind it before the loop, too") for name in bound}
    scope.names = inner | before | carried
    return bool(has_end)


def _round(
    scope: Names,
    body: list[ast.stmt],
    begun: Callable[[], bool],
    carried: dict[str, Any],
    ends: list[dict[str, Any]],
) -> bool:
    """Write one round of a loop; return True if the loop has an end."""
    unit, has_end = scope.unit, begun()

    def put_back(inner: Names, leaves_loop: bool) -> None:
        nonlocal has_end
        has_end |= leaves_loop
        ends.append({name: grids.settled(unit, inner.names[name], name) for name in carried})
        _put_back(unit, carried, ends[-1])

    unit.loops.append(put_back)
    if scope.run(body):
        put_back(scope, False)
    unit.loops.pop()
    return has_end


def _wider(name: str, form: Any, values: Iterable[Any]) -> Any:
    """Return the form of a variable at the start and after every round."""
    found = form
    for value in values:
        bare = replaced(value, lambda number: Num("", number.kind))
        found = unified(found, bare, lambda _, one, other: Num("", common_kind(one, other)), name)
    return found


def _bound(body: list[ast.stmt], *, in_place: bool = True) -> list[str]:
    """Return the names that statements bind, in order; `in_place`: also those that they add to and the like."""
    nodes = [node for statement in body for node in ast.walk(statement)]
    added = {id(x.target) for x in nodes if isinstance(x, ast.AugAssign)}
    names = (
        x.id
        for x in nodes
        if isinstance(x, ast.Name) and isinstance(x.ctx, ast.Store) and (in_place or id(x) not in added)
    )
    return list(dict.fromkeys(name for name in names if name != "_"))  # which nobody reads


def _variables(unit: Unit, name: str, form: Any) -> Any:
    """Return a value of some form whose numbers at run time are variables."""
    names = iter([leaf if leaf.startswith(name) else f"{name}_{leaf}" for leaf, _ in leaves(form, name)])
    return replaced(form, lambda number: unit.variable(next(names), number.kind))


def _put_back(unit: Unit, carried: dict[str, Any], now: dict[str, Any]) -> None:
    """Set the variables of a loop to their values after a round, all at once."""
    pairs: list[tuple[str, Num]] = []
    for name, variable in carried.items():
        form = replaced(variable, lambda number: Num("", number.kind))
        for (_, target), value in zip(leaves(variable), matched(now[name], form), strict=True):
            if value.text != target.text:
                pairs.append((target.text, value))
    targets = {target for target, _ in pairs}
    puts: list[code.Put | code.Call] = []
    for name, value in pairs:
        text = value.text
        if code.names_in(text) & targets:  # would have changed by then
            if "[" in value.kind:
                text = unit.variable(f"next_{name}", value.kind).text
                unit.emit(code.set_to(text, value.kind, value.text))
            else:
                text = unit.fresh(f"next_{name}")
                unit.emit(code.Let(code.c_type(value.kind), text, value.text))
        puts.append(code.set_to(name, value.kind, text))
    for put in puts:
        unit.emit(put)
