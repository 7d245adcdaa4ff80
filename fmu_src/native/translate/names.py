"""The names of a scope of Python: what they stand for, and how they are bound."""

import ast
import builtins
from typing import Any

import numpy as np

from . import grid_parts, grids
from .conditions import Conditions
from .grids import Derived, Stored, View
from .sources import is_compiled, names_set, takers
from .units import Poison, Unit, Writer
from .values import Closure, Num, Untranslatable, is_dynamic


class NamesOfScope(Conditions):
    """A scope of Python with its names."""

    def __init__(self, translator: Writer, unit: Unit, names: dict[str, Any], closure: Closure) -> None:
        self.translator, self.unit, self.names, self.closure = translator, unit, names, closure

    def bind(self, target: ast.expr, value: Any) -> None:
        """Bind names to a value."""
        if isinstance(target, ast.Name):
            if isinstance(value, np.ndarray) and self._sets(target.id, value):
                value = grids.copied(self.unit, value, target.id)
            self.names[target.id] = self.unit.named(target.id, value)
        elif isinstance(target, ast.Tuple):
            items = [self.kept(item) for item in self.listed(value)]
            starred = [i for i, each in enumerate(target.elts) if isinstance(each, ast.Starred)]
            if starred:
                at, rest = starred[0], len(target.elts) - starred[0] - 1
                items = [*items[:at], items[at : len(items) - rest], *items[len(items) - rest :]]
            for each, item in zip(target.elts, items, strict=True):
                self.bind(each.value if isinstance(each, ast.Starred) else each, item)
        elif isinstance(target, ast.Subscript) and isinstance(target.value, ast.Name) and self._is_entry(target):
            owner, key = target.value.id, self.value(target.slice)
            self.names[owner] = {**self.lookup(owner), key: self.unit.named(str(key), value)}
        elif isinstance(target, ast.Subscript) and isinstance(owner := self.value(target.value), Stored | View):
            grid_parts.put(self.unit, owner, self.value(target.slice), value)
        else:
            raise Untranslatable(f"an assignment to {ast.unparse(target)}: bind a name instead")

    def listed(self, value: Any) -> list[Any]:
        """Return the items of a value, of an array its elements or rows."""
        return list(grids.stored(self.unit, value) if isinstance(value, Derived) else value)

    def kept(self, value: Any) -> Any:
        """Return a number that the next assignment or call does not change."""
        if isinstance(value, Num) and self.unit.may_change(value.text):
            return self.unit.let("value", value)
        return value

    def _sets(self, name: str, array: np.ndarray) -> bool:
        """Return True if a function may set elements of an array by this name."""
        if array.ndim == 0:
            return False
        return is_compiled(self.closure.node) or name in names_set(self.closure.node) or self._is_handed_over(name)

    def _is_handed_over(self, name: str) -> bool:
        """Return True if a compiled function gets an array by this name: it may set elements."""
        seen = self.closure.names | self.closure.module
        return any(hasattr(seen.get(function), "py_func") for function in takers(self.closure.node, name))

    def _is_entry(self, target: ast.Subscript) -> bool:
        return isinstance(self.value(target.value), dict) and not is_dynamic(self.value(target.slice))

    def lookup(self, name: str) -> Any:
        """Return what a name stands for."""
        for names in (self.names, self.closure.names, self.closure.module):
            if name in names:
                if isinstance(names[name], Poison):
                    raise Untranslatable(f"'{name}': {names[name].reason}")
                return names[name]
        if not hasattr(builtins, name):
            raise Untranslatable(f"'{name}' is not bound here")
        return getattr(builtins, name)

    def _of_Name(self, node: ast.Name) -> Any:
        return self.lookup(node.id)

    def _of_NamedExpr(self, node: ast.NamedExpr) -> Any:
        self.bind(node.target, self.value(node.value))
        return self.lookup(node.target.id)
