"""Two powers in one call, where neither waits for the other: that takes little longer than one of them.

Only the order changes in which a function computes: a power moves to another if all that it needs is known there.
"""

import re
from dataclasses import dataclass

from . import code
from .units import Unit

_POWER = re.compile(r"\bown_pow\(")
_CHOICE = re.compile(r"\?|&&|\|\||\[")  # what follows is not always computed; elements of arrays
_RETURN = "return "


@dataclass
class _Power:
    """A power, by the name that stands for it in other texts."""

    name: str
    operands: list[str]


@dataclass
class _Pair:
    """Two powers in one call."""

    first: _Power
    second: _Power


def paired(unit: Unit, block: code.Block) -> code.Block:
    """Return a block in which powers that do not wait for each other have calls in pairs."""
    kept: code.Block = []
    run: list[code.Let | code.Do | code.Give] = []
    for statement in block:
        if isinstance(statement, code.If):
            statement.then, statement.otherwise = paired(unit, statement.then), paired(unit, statement.otherwise)
        elif isinstance(statement, code.Loop):
            statement.body = paired(unit, statement.body)
        if isinstance(statement, code.Let) and _is_plain(statement):
            run.append(statement)
            continue
        if isinstance(statement, code.Give) or (isinstance(statement, code.Do) and statement.text.startswith(_RETURN)):
            run.append(statement)
            kept, run = kept + _Run(unit, run).statements(), []
        else:
            kept, run = [*kept, *_Run(unit, run).statements(), statement], []
    return kept + _Run(unit, run).statements()


def _is_plain(let: code.Let) -> bool:
    """Return True for the name of an expression that nothing changes."""
    return let.value is not None and "[" not in let.ctype and not (let.may_refuse or let.changes or let.writes)


class _Run:
    """Statements that are computed one after the other, each always; the last one may end the function."""

    def __init__(self, unit: Unit, statements: list[code.Let | code.Do | code.Give]) -> None:
        self.unit = unit
        self.items: list[_Power | _Pair | code.Let | code.Do | code.Give] = []
        self.texts: dict[int, list[str]] = {}  # of statements, by their ids, with names in place of powers
        self.levels: dict[str, int] = {}  # by names, how many functions wait for each other before
        count = 0
        for statement in statements:
            texts = _texts(statement)
            for k, text in enumerate(texts):
                while not _CHOICE.search(text) and (call := _first_call(text)):
                    power = _Power(f"_power_{count}", code.operands(text[call[1] : call[2]]))
                    self.levels[power.name] = self._level(power.operands) + 1
                    self.items.append(power)
                    text, count = f"{text[: call[0]]}{power.name}{text[call[2] + 1 :]}", count + 1
                texts[k] = text
            self.texts[id(statement)] = texts
            self.items.append(statement)
            if isinstance(statement, code.Let):
                self.levels[statement.name] = self._level(texts) + code.takes_long(texts[0])

    def statements(self) -> code.Block:
        """Return them with pairs of powers."""
        for power in [each for each in self.items if isinstance(each, _Power)]:
            if power in self.items:
                self._pair(power)
        texts: dict[str, str] = {}  # of powers, by their names
        found: code.Block = []
        for item in self.items:
            if isinstance(item, _Power):
                texts[item.name] = f"own_pow({', '.join(_filled(each, texts) for each in item.operands)})"
            elif isinstance(item, _Pair):
                name = self.unit.fresh("powers")
                operands = [_filled(each, texts) for each in (*item.first.operands, *item.second.operands)]
                found.append(code.Let("struct two_powers", name, f"own_two_powers({', '.join(operands)})"))
                texts |= {item.first.name: f"{name}.first", item.second.name: f"{name}.second"}
            else:
                found.append(_with(item, [_filled(text, texts) for text in self.texts[id(item)]]))
        return found

    def _pair(self, power: _Power) -> None:
        """Pair a power with a later one that does not wait longer, if there is one."""
        place = self.items.index(power)
        use = next(k for k in range(place + 1, len(self.items)) if power.name in self._reads(k))
        known = {name for item in self.items[:use] for name in _sets(item)}
        every = {name for item in self.items for name in _sets(item)}
        level = self.levels[power.name]
        others = [
            each
            for each in self.items[place + 1 :]
            if isinstance(each, _Power)
            and self.levels[each.name] <= level + 1
            and (code.names_in(" ".join(each.operands)) & every) <= known - {power.name}
        ]
        if others:
            other = min(others, key=lambda each: self.levels[each.name])
            at = min(use, self.items.index(other))
            self.items.insert(at, _Pair(power, other))
            self.items.remove(power)
            self.items.remove(other)

    def _reads(self, k: int) -> set[str]:
        item = self.items[k]
        if isinstance(item, _Pair):
            return code.names_in(" ".join([*item.first.operands, *item.second.operands]))
        return code.names_in(" ".join(item.operands if isinstance(item, _Power) else self.texts[id(item)]))

    def _level(self, texts: list[str]) -> int:
        return max((self.levels.get(name, 0) for text in texts for name in code.names_in(text)), default=0)


def _first_call(text: str) -> tuple[int, int, int] | None:
    """Return where the first power begins that has no other one in it, its operands, and where these end."""
    for call in _POWER.finditer(text):
        end = code.closed(text, call.end())
        if not _POWER.search(text, call.end(), end):
            return call.start(), call.end(), end
    return None


def _sets(item: _Power | _Pair | code.Let | code.Do | code.Give) -> list[str]:
    """Return the names that are known after it."""
    if isinstance(item, _Pair):
        return [item.first.name, item.second.name]
    return [item.name] if isinstance(item, _Power | code.Let) else []


def _texts(statement: code.Let | code.Do | code.Give) -> list[str]:
    if isinstance(statement, code.Give):
        return [value for _, value in statement.members]
    return [statement.value or "" if isinstance(statement, code.Let) else statement.text]


def _with(statement: code.Let | code.Do | code.Give, texts: list[str]) -> code.Statement:
    """Return a statement with other expressions."""
    if isinstance(statement, code.Give):
        names = [name for name, _ in statement.members]
        return code.Give(statement.struct, list(zip(names, texts, strict=True)))
    return code.Let(statement.ctype, statement.name, texts[0]) if isinstance(statement, code.Let) else code.Do(texts[0])


def _filled(text: str, powers: dict[str, str]) -> str:
    """Return a text with powers in place of their names."""
    return re.sub(r"\b_power_\d+\b", lambda found: powers[found[0]], text)
