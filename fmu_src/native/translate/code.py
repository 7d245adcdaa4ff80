"""C statements: what is never used is left out, and the rest printed."""

import re
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

_NAMES = re.compile(r'"(?:[^"\\]|\\.)*"|(?<![\w.])([A-Za-z_]\w*)')  # outside quotation marks, and no members
_USES = re.compile(r"\b(?<=struct )\w+|(?<![\w.])\w+(?=\()")  # of functions and structs
_DECLARES = re.compile(
    r"(?<=double )(\w+\[\d+\](?:,\s+\w+\[\d+\])*)|(?:\bdouble|\bint|\bstruct \w+)\s+\*?(\w+)\b(?!\()"
)
_CTYPES = {"d": "double", "i": "int", "b": "int"}
_WIDTH = 116
_QUICK = frozenset({"fabs", "smaller", "larger", "sqrt", "squared", "cubed"})  # functions


def c_type(kind: str) -> str:
    """Return the C type of a kind of number; of an array with its size."""
    return f"{_CTYPES[kind[0]]}{kind[1:]}"


def declared(ctype: str, name: str) -> str:
    """Return a declaration without its end."""
    base, bracket, size = ctype.partition("[")
    return f"{base} {name}{bracket}{size}"


def set_to(name: str, kind: str, value: str) -> "Put | Call":
    """Return the statement that gives a variable the value of another, also an array."""
    if "[" not in kind:
        return Put(name, value)
    size = kind[2:-1]
    return Call(f"memcpy({name}, {value}, {size} * sizeof {name}[0]);", frozenset({name}))


@dataclass
class Let:
    """A name for a value, or without one a variable that is set later; of type double[12] an array."""

    ctype: str
    name: str
    value: str | None
    may_refuse: bool = False  # a call that has to be made even if nothing reads its result
    changes: bool = False  # a variable that is set anew later
    writes: frozenset[str] = frozenset()  # arrays that it sets


@dataclass
class Put:
    """A new value of a variable, or of an element of an array."""

    name: str
    value: str
    place: str | None = None


@dataclass
class If:
    """A choice."""

    test: str
    then: "Block" = field(default_factory=list)
    otherwise: "Block" = field(default_factory=list)


@dataclass
class Loop:
    """Statements that are repeated."""

    head: str
    body: "Block" = field(default_factory=list)


@dataclass
class Do:
    """A statement that is always kept."""

    text: str


@dataclass
class Call:
    """A call that sets arrays and does nothing else."""

    text: str
    writes: frozenset[str]


@dataclass
class Give:
    """The end of a function that returns a struct."""

    struct: str
    members: list[tuple[str, str]]

    @property
    def text(self) -> str:
        """The statement in one line."""
        return f"return (struct {self.struct}){{{', '.join(f'.{name} = {value}' for name, value in self.members)}}};"


Statement: TypeAlias = Let | Put | If | Loop | Do | Call | Give
Block: TypeAlias = list[Statement]


def names_in(text: str | None) -> set[str]:
    """Return the names in a piece of C, of r.gap r alone."""
    return set(_NAMES.findall(text)) - {""} if text else set()


def takes_long(text: str | None) -> bool:
    """Return True for an expression that calls a function of more than a few instructions."""
    return bool(set(re.findall(r"\b(\w+)\(", text or "")) - _QUICK)


def closed(text: str, start: int) -> int:
    """Return where the parenthesis ends that begins before `start`."""
    depth = 1
    for place in range(start, len(text)):
        depth += {"(": 1, ")": -1}.get(text[place], 0)
        if depth == 0:
            return place
    raise AssertionError(f"'{text}' has an open parenthesis")


def operands(text: str) -> list[str]:
    found, depth = [""], 0
    for sign in text:
        depth += {"(": 1, ")": -1}.get(sign, 0)
        if sign == "," and depth == 0:
            found.append("")
        else:
            found[-1] += sign
    return [each.strip() for each in found]


def used(block: Block) -> set[str]:
    found: set[str] = set()
    for statement in block:
        if isinstance(statement, If):
            found |= names_in(statement.test) | used(statement.then) | used(statement.otherwise)
        elif isinstance(statement, Loop):
            found |= names_in(statement.head) | used(statement.body)
        elif isinstance(statement, Do | Call | Give):
            found |= names_in(statement.text)
        elif isinstance(statement, Put) and statement.place is not None:
            found |= names_in(statement.value) | names_in(statement.place) | {statement.name}
        else:
            found |= names_in(statement.value)
    return found


def pruned(block: Block, live: set[str]) -> Block:
    """Return a block without what is never used; `live` are the names used after it, and grows by those used in it."""
    kept: Block = []
    for statement in reversed(block):
        if isinstance(statement, Let | Put):
            if statement.name not in live:
                if isinstance(statement, Let) and (statement.may_refuse or statement.writes & live):
                    live |= names_in(statement.value)
                    kept.append(Do(f"{statement.value};"))
                continue
            live |= names_in(statement.value)
            if isinstance(statement, Put):
                live |= names_in(statement.place)
            kept.append(statement)
        elif isinstance(statement, If):
            before, after = set(live), set(live)
            then, otherwise = pruned(statement.then, before), pruned(statement.otherwise, after)
            if then or otherwise:
                live |= before | after | names_in(statement.test)
                kept.append(If(statement.test, then, otherwise))
        elif isinstance(statement, Loop):
            live |= _needed(statement.body, live)
            body = pruned(statement.body, live)
            if body:
                live |= names_in(statement.head)
                kept.append(Loop(statement.head, body))
        elif isinstance(statement, Call):
            if statement.writes & live:
                live |= names_in(statement.text)
                kept.append(statement)
        else:
            live |= names_in(statement.text)
            kept.append(statement)
    return kept[::-1]


def _needed(body: Block, live: set[str]) -> set[str]:
    """Return the names that a repeated body needs from one time to the next."""
    needed = set(live)
    while True:
        more = set(needed)
        pruned(body, more)
        if more == needed:
            return needed
        needed = more


def printed(block: Block, depth: int = 1) -> list[str]:
    lines: list[str] = []
    for statement in block:
        if isinstance(statement, Let):
            value = "" if statement.value is None else f" = {statement.value}"
            const = "" if statement.value is None or statement.changes else "const "
            lines += wrapped(f"{const}{declared(statement.ctype, statement.name)}{value};", depth)
        elif isinstance(statement, Put):
            place = "" if statement.place is None else f"[{statement.place}]"
            lines += wrapped(f"{statement.name}{place} = {statement.value};", depth)
        elif isinstance(statement, If):
            lines += _choice(statement, depth)
        elif isinstance(statement, Loop):
            lines += [
                *wrapped(f"{statement.head} {{", depth),
                *printed(statement.body, depth + 1),
                "    " * depth + "}",
            ]
        elif isinstance(statement, Give):
            lines += _given(statement, depth)
        else:
            lines += wrapped(statement.text, depth)
    return lines


def quoted(text: str) -> str:
    """Return a text as C, in pieces that fit in a line."""
    pieces = textwrap.wrap(text, _WIDTH - 30, drop_whitespace=False, break_on_hyphens=False) or [""]
    return " ".join('"' + piece.replace("\\", "\\\\").replace('"', '\\"') + '"' for piece in pieces)


def comment(lines: Sequence[str]) -> list[str]:
    cut = [part for line in lines for part in textwrap.wrap(line, _WIDTH - 6, break_on_hyphens=False)]
    return [f"{'   ' if i else '/* '}{line}{' */' if i == len(cut) - 1 else ''}" for i, line in enumerate(cut)]


def head(result: str, name: str, parameters: Sequence[str]) -> list[str]:
    """Return the first lines of a function."""
    lines = [f"static {result} {name}("]
    for i, parameter in enumerate(parameters or ["void"]):
        text = parameter + (")" if i >= len(parameters) - 1 else ",")
        if len(lines[-1]) + len(text) + 1 > _WIDTH:
            lines.append("    " + text)
        else:
            lines[-1] += text if lines[-1].endswith("(") else f" {text}"
    return lines


def _given(statement: Give, depth: int) -> list[str]:
    indent = "    " * depth
    if len(indent + statement.text) <= _WIDTH:
        return [indent + statement.text]
    lines = [f"{indent}return (struct {statement.struct}){{"]
    for name, value in statement.members:
        lines += wrapped(f".{name} = {value},", depth + 1)
    return [*lines, indent + "};"]


def _choice(choice: If, depth: int) -> list[str]:
    indent = "    " * depth
    if not choice.then:
        choice = If(f"!({choice.test})", choice.otherwise, [])
    lines = [*wrapped(f"if ({choice.test}) {{", depth), *printed(choice.then, depth + 1)]
    if choice.otherwise:
        lines += [indent + "} else {", *printed(choice.otherwise, depth + 1)]
    return [*lines, indent + "}"]


def wrapped(text: str, depth: int) -> list[str]:
    """Return a statement in lines of limited width, cut at spaces outside quotation marks."""
    indent, lines = "    " * depth, []
    line = indent
    for word in re.findall(r'(?:"(?:[^"\\]|\\.)*"|\S)+', text):
        longer = line + word if line.strip() == "" else f"{line} {word}"
        if len(longer) > _WIDTH and line.strip():
            lines.append(line)
            longer = indent + "    " + word
        line = longer
    return [*lines, line]


def merged(functions: Sequence[tuple[str, str]]) -> list[str]:
    """Return functions and their structs without those that others equal but for names; both are given by name."""
    whole: dict[str, str] = {}
    for name, text in functions:
        whole[name] = f"{whole[name]}\n\n{text}" if name in whole else text
    first: dict[str, str] = {}  # names by texts
    names: dict[str, str] = {}  # of functions that are left out, those of their equals
    for name, text in whole.items():
        own = _renamed(text, names)
        names[name] = first.setdefault(_anonymous(_renamed(own, {name: "it"})), name)
        whole[name] = own
    return [text for name, text in whole.items() if names[name] == name]


def _renamed(text: str, names: dict[str, str]) -> str:
    """Return a text with functions and structs by other names."""
    return _USES.sub(lambda found: names.get(found[0], found[0]), text)


def _anonymous(text: str) -> str:
    """Return a function with numbers in place of the names that it gives to parameters and variables."""
    members, function = re.fullmatch(r"(struct \w+ \{.*?\};)?(.*)", text, re.DOTALL).groups()  # type: ignore[union-attr]
    found = [
        part for several, one in _DECLARES.findall(function) for part in re.findall(r"\w+(?=\[)", several) or [one]
    ]
    numbers = {name: f"_{i}" for i, name in enumerate(dict.fromkeys(found))}
    renamed = _NAMES.sub(lambda name: numbers.get(name[1], name[0]), function)
    return (members or "") + " ".join(renamed.split())  # lines end elsewhere
