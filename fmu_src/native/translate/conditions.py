"""Conditions and choices of Python: what is known is decided, what is not becomes C."""

import ast
import functools
import operator
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

import numpy as np

from . import code, grid_library, grids
from .library import chosen, elementwise
from .units import Unit
from .values import Num, both, compare, either, is_dynamic, is_number

_SIGNS: dict[type[ast.cmpop], tuple[str, Callable[[Any, Any], Any]]] = {
    ast.Lt: ("<", operator.lt),
    ast.LtE: ("<=", operator.le),
    ast.Gt: (">", operator.gt),
    ast.GtE: (">=", operator.ge),
    ast.Eq: ("==", operator.eq),
    ast.NotEq: ("!=", operator.ne),
}


def _is_test(value: Any) -> bool:
    return isinstance(value, Num) and value.kind == "b"


class Conditions(ABC):
    """Comparisons, what `and`, `or` and `not` make of them, and choices between two values."""

    unit: Unit

    @abstractmethod
    def value(self, node: ast.expr) -> Any:
        """Return the value of an expression."""

    def truth(self, value: Any) -> Any:
        """Return True or False, or a number at run time that is one of them."""
        if isinstance(value, Num):
            return value if value.kind == "b" else compare("!=", value, 0)
        return bool(value)

    def test(self, node: ast.expr) -> Any:
        """Return the truth of an expression, in which `and`, `or` and `not` are logical."""
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            found = self.test(node.operand)
            return ~found if isinstance(found, Num) else not found
        if isinstance(node, ast.BoolOp):
            return self._tested(isinstance(node.op, ast.And), node.values)
        return self.truth(self.value(node))

    def _tested(self, every: bool, nodes: list[ast.expr]) -> Any:
        first = self.test(nodes[0])
        if len(nodes) == 1:
            return first
        if not isinstance(first, Num):
            return self._tested(every, nodes[1:]) if first == every else first
        rest, block = self.unit.branch(lambda: self._tested(every, nodes[1:]))
        if not block:
            return both(first, rest) if every else either(first, rest)
        then: code.Block = block if every else []
        otherwise: code.Block = [] if every else block
        one, other = (rest, False) if every else (True, rest)
        found = self.unit.joined("holds", one, other, then, otherwise)
        self.unit.emit(code.If(first.text, then, otherwise))
        return found

    def _of_Compare(self, node: ast.Compare) -> Any:
        left, found = self.value(node.left), []
        for op, right_node in zip(node.ops, node.comparators, strict=True):
            right = self.value(right_node)
            found.append(self._compared(op, left, right))
            left = right
        result = found[0]
        for each in found[1:]:
            result = self._both(result, each)
        return result

    def _both(self, one: Any, other: Any) -> Any:
        if not isinstance(one, Num):
            return other if one else False
        if not isinstance(other, Num):
            return one if other else False
        return both(one, other)

    def _compared(self, op: ast.cmpop, one: Any, other: Any) -> Any:
        if isinstance(op, ast.Is | ast.IsNot):
            return (one is other) == isinstance(op, ast.Is)
        if isinstance(op, ast.In | ast.NotIn):
            inside: Any = False
            for item in other:
                same = self._compared(ast.Eq(), one, item)
                if isinstance(same, Num):
                    inside = same if inside is False else either(inside, same)
                elif same:
                    inside = True
                    break
            return inside if isinstance(op, ast.In) else (~inside if isinstance(inside, Num) else not inside)
        sign, known = _SIGNS[type(op)]
        if isinstance(one, tuple) and isinstance(other, tuple) and (is_dynamic(one) or is_dynamic(other)):
            pairs = [self._compared(ast.Eq(), *pair) for pair in zip(one, other, strict=True)]
            alike = functools.reduce(self._both, pairs)
            return alike if isinstance(op, ast.Eq) else (~alike if isinstance(alike, Num) else not alike)
        if not (is_dynamic(one) or is_dynamic(other)):
            return known(one, other)
        if grid_library.takes([one, other]):
            return grid_library.compared(self.unit, sign, one, other)
        if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
            return elementwise(lambda x, y: compare(sign, x, y))(one, other)
        if not (is_number(one) and is_number(other)):
            return isinstance(op, ast.NotEq)
        return compare(sign, one, other)

    def _of_BoolOp(self, node: ast.BoolOp) -> Any:
        return self._joined_by(isinstance(node.op, ast.And), node.values)

    def _joined_by(self, every: bool, nodes: list[ast.expr]) -> Any:
        """Return `one and other and ...`, or with or: later ones are looked at where earlier ones ask for it."""
        first = self.value(nodes[0])
        test = self.truth(first)
        if len(nodes) == 1:
            return first
        if not isinstance(test, Num):
            return self._joined_by(every, nodes[1:]) if bool(test) == every else first
        rest, block = self.unit.branch(lambda: self._joined_by(every, nodes[1:]))
        logical = isinstance(first, Num) and first.kind == "b" and (isinstance(rest, bool) or _is_test(rest))
        if logical and not block:
            return both(first, rest) if every else either(first, rest)
        then: code.Block = block if every else []
        otherwise: code.Block = [] if every else block
        pair = (rest, first) if every else (first, rest)
        if not block and is_number(first) and is_number(rest):
            return chosen(test, *pair)
        found = self.unit.joined("chosen", *pair, then, otherwise)
        self.unit.emit(code.If(test.text, then, otherwise))
        return found

    def _of_IfExp(self, node: ast.IfExp) -> Any:
        test = self.test(node.test)
        if not isinstance(test, Num):
            return self.value(node.body if test else node.orelse)
        one, then = self.unit.branch(lambda: grids.settled(self.unit, self.value(node.body)))
        other, otherwise = self.unit.branch(lambda: grids.settled(self.unit, self.value(node.orelse)))
        if not then and not otherwise and is_number(one) and is_number(other):
            return chosen(test, one, other)
        found = self.unit.joined("chosen", one, other, then, otherwise)
        self.unit.emit(code.If(test.text, then, otherwise))
        return found
