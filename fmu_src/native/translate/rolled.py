"""Loops in place of copies: weighted sums over nodes, with what was written out for each node.

Where a sum over an array of constants follows, statements of all elements become loops over static tables; elementary
functions take whole arrays between them, two numbers at a time, other functions have loops of their own.
"""

import re
from collections.abc import Sequence

from . import code
from .units import Unit

LEAST = 4  # terms that are worth a loop
_NUMBER = r"(?:\d[\d.]*(?:e[-+]?\d+)?|INFINITY)"
_TERM = re.compile(rf"(-?{_NUMBER}) \* (\w+)")
_TOKEN = re.compile(rf"(?<![\w.]){_NUMBER}|[A-Za-z_][\w.]*|\s+|.")
_CALL = re.compile(r"own_\w+\([^()]*\)")  # without another one in it
# functions of elementary_arrays.h by those of one number, which nodes differ in, and names of what they give
_OF_ARRAYS = {
    "own_exp": ("own_exps", "exponential"),
    "own_pow": ("own_pows", "power"),
    "own_asinh": ("own_asinhs", "arsinh"),
}
_OF_NODES = re.compile(rf"\b({'|'.join(_OF_ARRAYS)})\(")


class _Unlike(Exception):  # noqa: N818  # what it is, not that it failed
    """Statements that differ in more than constants and nodes."""


def rolled(unit: Unit, block: code.Block) -> code.Block:
    """Return a block in which sums over at least LEAST nodes are loops."""
    for statement in block:
        if isinstance(statement, code.If):
            statement.then = rolled(unit, statement.then)
            statement.otherwise = rolled(unit, statement.otherwise)
        elif isinstance(statement, code.Loop):
            statement.body = rolled(unit, statement.body)
    sums = {i: terms for i, terms in enumerate(map(_terms, block)) if terms}
    for count in sorted({len(terms) for terms in sums.values()}):
        found = _Nodes(unit, block, {i: terms for i, terms in sums.items() if len(terms) == count}, count)
        try:
            return rolled(unit, found.loop())
        except _Unlike:
            continue
    return block


def _terms(statement: code.Statement) -> list[tuple[str, str]]:
    """Return weights and names of a weighted sum."""
    if not isinstance(statement, code.Let) or statement.value is None:
        return []
    found = [_TERM.fullmatch(part) for part in statement.value.split(" + ")]
    terms = [(each[1], each[2]) for each in found if each]
    return terms if len(terms) == len(found) >= LEAST else []


class _Nodes:
    """What a block computes for each node of sums."""

    def __init__(self, unit: Unit, block: code.Block, sums: dict[int, list[tuple[str, str]]], count: int) -> None:
        self.unit, self.block, self.sums, self.count = unit, block, sums, count
        self.made = {each.name: each for each in block if isinstance(each, code.Let) and each.value is not None}
        self.body: code.Block = []
        self.before: code.Block = []  # tables, and what no node changes
        self.names: dict[tuple[str, ...], str] = {}  # in the loop, by those of all nodes
        self.tables: dict[tuple[str, ...], str] = {}
        self.calls: dict[str, str] = {}
        self.calling: dict[str, bool] = {}  # whether a number in the loop is what a function gives
        self.takes: dict[str, code.Call] = {}  # functions of arrays, by what they find and leave in it
        self.node = "node"

    def loop(self) -> code.Block:
        """Return the block with a loop in the place of the last sum. Raises _Unlike if nodes differ."""
        unit, names = self.unit, set(self.unit.names)
        self.node = unit.fresh("node")
        try:
            totals = self._totals()
        except _Unlike:
            unit.names = names
            raise
        gone = {name for each in self.names for name in each}
        last, kept = max(self.sums), []
        for i, statement in enumerate(self.block):
            if i == last:
                kept += [*self.before, *totals, *self._loops()]
            elif i not in self.sums and not (isinstance(statement, code.Let) and statement.name in gone):
                kept.append(statement)
        return kept

    def _loops(self) -> code.Block:
        """Return the loops, between them functions of arrays, and before them arrays of what later ones need."""
        levels: dict[str, int] = {}
        staged: dict[int, code.Block] = {}
        body = [part for each in self.body for part in self._apart(each)]
        for each in body:
            needs = [n for n in code.names_in(each.value) if n in levels and n != each.name]
            level = max((levels[n] + self.calling[n] for n in needs), default=0)
            levels[each.name] = level
            self.calling[each.name] = each.name in self.takes or code.takes_long(each.value)
            staged.setdefault(level, []).append(each)
        late = {name for level, block in staged.items() for name in code.used(block) if levels.get(name, level) < level}
        late |= self.takes.keys()
        arrays = [f"{each.name}[{self.count}]" for each in body if isinstance(each, code.Let) and each.name in late]
        found: code.Block = [code.Do(f"double {', '.join(arrays)};")] if arrays else []
        head = f"for (int {self.node} = 0; {self.node} < {self.count}; ++{self.node})"
        for k in sorted(staged):
            found.append(code.Loop(head, [self._placed(each, late) for each in staged[k]]))
            found += [self.takes[name] for each in staged[k] if (name := each.name) in self.takes]  # type: ignore[union-attr]
        return found

    def _apart(self, statement: code.Statement) -> list[code.Let | code.Put]:
        """Return a statement as several, of which those before the last give operands to functions of arrays."""
        assert isinstance(statement, code.Let | code.Put)
        text = statement.value or ""
        found: list[code.Let | code.Put] = []
        while calls := [each for each in _OF_NODES.finditer(text) if self._takes_nodes(text, each.end())]:
            start, end = calls[-1].start(), code.closed(text, calls[-1].end())  # no other such call is in the last one
            first, *rest = code.operands(text[calls[-1].end() : end])
            whole = isinstance(statement, code.Let) and (start, end + 1) == (0, len(text))
            function, result = _OF_ARRAYS[calls[-1][1]]
            name = statement.name if whole else self.unit.fresh(result)
            given = ", ".join([str(self.count), name, *rest])
            self.takes[name] = code.Call(f"{function}({given});", frozenset({name}))
            found.append(code.Let("double", name, first))
            if whole:
                return found
            text = f"{text[:start]}{name}{text[end + 1 :]}"
        statement.value = text
        return [*found, statement]

    def _takes_nodes(self, text: str, start: int) -> bool:
        """Return True for a call of which nodes differ in the first operand alone."""
        _, *rest = code.operands(text[start : code.closed(text, start)])
        made = {each.name for each in self.body if isinstance(each, code.Let)}
        return not any(self.node in code.names_in(each) or code.names_in(each) & made for each in rest)

    def _placed(self, statement: code.Statement, late: set[str]) -> code.Statement:
        """Return a statement in which numbers that later loops need are in arrays."""
        assert isinstance(statement, code.Let | code.Put)
        value = statement.value or ""
        for name in late & code.names_in(value):
            value = re.sub(rf"(?<![\w.]){name}\b", f"{name}[{self.node}]", value)
        if statement.name in late:
            return code.Put(f"{statement.name}[{self.node}]", value)
        if isinstance(statement, code.Put):
            return code.Put(statement.name, value)
        return code.Let(statement.ctype, statement.name, value)

    def _totals(self) -> code.Block:
        found: code.Block = []
        for i, terms in self.sums.items():
            total = self.block[i]
            assert isinstance(total, code.Let)
            weights, names = zip(*terms, strict=True)
            one = self._of_nodes(names)
            weight = self._constant(weights, "weight")
            found += [code.Let(total.ctype, total.name, None), code.Put(total.name, "0.0")]
            self.body.append(code.Put(total.name, f"{total.name} + {weight} * {one}"))
        sums = {self.block[i].name for i in self.sums}  # type: ignore[union-attr]
        gone = {name for each in self.names for name in each}
        last = max(self.sums)
        if _assigned(self.block[:last]) & (
            code.used(self.body) | code.used(self.before)
        ):  # it may change before the loop
            raise _Unlike
        for i, statement in enumerate(self.block):
            own = (isinstance(statement, code.Let) and statement.name in gone) or i in self.sums
            if not own and code.used([statement]) & (gone | (sums if i < last else set())):
                raise _Unlike
        return found

    def _of_nodes(self, names: Sequence[str]) -> str:
        """Return the name in the loop of numbers that nodes have; writes how it is made."""
        given = tuple(names)
        if len(set(given)) == 1:
            return given[0]
        if given not in self.names:
            if len(set(given)) < self.count or any(name not in self.made for name in given):
                raise _Unlike
            lets = [self.made[name] for name in given]
            texts = [_TOKEN.findall(text) for text in self._shared([each.value or "" for each in lets])]
            if len(set(map(len, texts))) > 1 or any(each.may_refuse or "[" in (each.value or "") for each in lets):
                raise _Unlike
            name = self.unit.fresh(_common(given))
            parts = [self._part(column, name) for column in zip(*texts, strict=True)]
            self.body.append(code.Let(lets[0].ctype, name, "".join(parts)))
            self.names[given] = name
        return self.names[given]

    def _part(self, column: tuple[str, ...], name: str) -> str:
        if len(set(column)) == 1:
            return column[0]
        if all(re.fullmatch(_NUMBER, part) for part in column):
            return self._constant(column, name)
        return self._of_nodes(column)

    def _constant(self, column: tuple[str, ...], name: str) -> str:
        if len(set(column)) == 1:
            return column[0]
        if column not in self.tables:
            self.tables[column] = self.unit.fresh(f"{name}s" if name == "weight" else f"{name}_factors")
            rows = ", ".join(column)
            self.before.append(code.Do(f"static const double {self.tables[column]}[{self.count}] = {{{rows}}};"))
        return f"{self.tables[column]}[{self.node}]"

    def _shared(self, texts: list[str]) -> list[str]:
        """Return expressions of all nodes in which calls that they have alike have a name, from before the loop."""
        for call in _CALL.findall(texts[0]):
            if all(call in text for text in texts):
                if call not in self.calls:
                    self.calls[call] = self.unit.fresh(call[len("own_") : call.index("(")] + "_of_all")
                    self.before.append(code.Let("double", self.calls[call], call))
                texts = [text.replace(call, self.calls[call]) for text in texts]
        return texts


def _assigned(block: code.Block) -> set[str]:
    """Return the variables and arrays that a block sets anew."""
    found: set[str] = set()
    for statement in block:
        if isinstance(statement, code.Let | code.Call):
            found |= statement.writes
        elif isinstance(statement, code.Put):
            found.add(statement.name)
        elif isinstance(statement, code.If):
            found |= _assigned(statement.then) | _assigned(statement.otherwise)
        elif isinstance(statement, code.Loop):
            found |= _assigned(statement.body)
    return found


def _common(names: Sequence[str]) -> str:
    """Return what names have in common: the name of an array, without the number of the node."""
    first = names[0].split("_")
    alike = [part for i, part in enumerate(first) if all(name.split("_")[i : i + 1] == [part] for name in names)]
    kept = [part for part in alike if not part.isdigit()] or alike
    return "_".join(kept) or "value"
