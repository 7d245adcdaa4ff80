"""What is made of the statements of a C function before they are printed."""

import dataclasses

from . import code
from .paired import paired
from .rolled import rolled
from .units import Unit


def arranged(unit: Unit, block: code.Block, live: set[str]) -> code.Block:
    """Return a block without what is never used, with loops over nodes, powers in pairs and late declarations.

    `live` are the names used after it.
    """
    return declared(paired(unit, rolled(unit, code.pruned(block, live))))


def declared(block: code.Block) -> code.Block:
    """Return a block in which a variable begins with its first value, where that stands in the same block."""
    kept: code.Block = []
    open_lets: dict[str, code.Let] = {}  # variables without a value so far
    for statement in block:
        if isinstance(statement, code.Let) and statement.value is None:
            open_lets[statement.name] = statement
            kept.append(statement)
            continue
        mentioned = code.used([statement]) | _set(statement)
        if isinstance(statement, code.Put) and statement.place is None and statement.name in open_lets:
            let = open_lets.pop(statement.name)
            kept = [each for each in kept if each is not let]
            kept.append(code.Let(let.ctype, let.name, statement.value, changes=True))
            mentioned.discard(statement.name)
        else:
            kept.append(_inside(statement))
        for name in mentioned & open_lets.keys():
            del open_lets[name]
    return kept


def _inside(statement: code.Statement) -> code.Statement:
    """Return a statement with such blocks in it."""
    if isinstance(statement, code.If):
        return dataclasses.replace(statement, then=declared(statement.then), otherwise=declared(statement.otherwise))
    if isinstance(statement, code.Loop):
        return dataclasses.replace(statement, body=declared(statement.body))
    return statement


def _set(statement: code.Statement) -> set[str]:
    if isinstance(statement, code.Put):
        return {statement.name.partition("[")[0]}
    if isinstance(statement, code.If):
        return {name for block in (statement.then, statement.otherwise) for each in block for name in _set(each)}
    if isinstance(statement, code.Loop):
        return {name for each in statement.body for name in _set(each)}
    return set()
