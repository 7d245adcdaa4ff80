"""Expressions of Python: what is known is computed, what is not becomes C."""

import ast
import dataclasses
import inspect
import operator
import types
from collections.abc import Callable
from typing import Any

import numpy as np

from . import grid_library, grid_parts, grids
from .grids import Grid
from .library import ALWAYS, ARRAY_METHODS, HANDLERS, elementwise
from .names import NamesOfScope
from .sources import calls
from .units import Text
from .values import Closure, Method, Num, Untranslatable, is_dynamic, is_number, literal

_OPERATORS: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
    ast.BitOr: operator.or_,
    ast.BitAnd: operator.and_,
    ast.LShift: operator.lshift,
    ast.RShift: operator.rshift,
    ast.MatMult: operator.matmul,
}


class Super:
    """What `super()` gives: a record, seen as one of the classes after `cls`."""

    def __init__(self, cls: type, owner: Any) -> None:
        self.cls, self.owner = cls, owner


class Expressions(NamesOfScope):
    """The values of expressions of Python in a scope."""

    def value(self, node: ast.expr) -> Any:
        """Return the value of an expression."""
        found = getattr(self, f"_of_{type(node).__name__}", None)
        if found is None:
            raise Untranslatable(f"no {type(node).__name__} here: {ast.unparse(node)}")
        return found(node)

    def _of_Constant(self, node: ast.Constant) -> Any:
        return node.value

    def _of_Tuple(self, node: ast.Tuple) -> Any:
        return tuple(self._items(node.elts))

    def _of_List(self, node: ast.List) -> Any:
        return self._items(node.elts)

    def _items(self, nodes: list[ast.expr]) -> list[Any]:
        found: list[Any] = []
        for i, each in enumerate(nodes):
            if isinstance(each, ast.Starred):
                found.extend(self.value(each.value))
            else:
                value = self.value(each)
                found.append(self.kept(value) if any(map(calls, nodes[i + 1 :])) else value)
        return found

    def _of_Dict(self, node: ast.Dict) -> Any:
        found: dict[Any, Any] = {}
        for key, value in zip(node.keys, node.values, strict=True):
            found |= self.value(value) if key is None else {self.value(key): self.value(value)}
        return found

    def _of_Attribute(self, node: ast.Attribute) -> Any:
        return self.translator.attribute(self.unit, self.value(node.value), node.attr)

    def _of_Subscript(self, node: ast.Subscript) -> Any:
        return self.picked(self.value(node.value), self.value(node.slice))

    def picked(self, owner: Any, key: Any) -> Any:
        """Return a part of an array or a sequence, or an entry."""
        if isinstance(owner, Grid):
            return grid_parts.picked(self.unit, owner, key)
        if not is_dynamic(key):
            return owner[key]
        if isinstance(owner, np.ndarray) or (isinstance(owner, tuple | list) and all(map(is_number, owner))):
            return grid_parts.picked(self.unit, grids.of(self.unit, owner), key)
        raise Untranslatable(f"a place of a {type(owner).__name__} that is known at run time only")

    def _of_Slice(self, node: ast.Slice) -> Any:
        return slice(*(None if part is None else self.value(part) for part in (node.lower, node.upper, node.step)))

    def _of_UnaryOp(self, node: ast.UnaryOp) -> Any:
        if isinstance(node.op, ast.Not):
            return self.test(node)
        value = self.value(node.operand)
        if isinstance(value, Grid):
            if isinstance(node.op, ast.Invert):
                return grid_library.inverted(self.unit, value)
            return grid_library.operated(self.unit, operator.neg, value) if isinstance(node.op, ast.USub) else value
        if isinstance(node.op, ast.Invert) and isinstance(value, np.ndarray) and is_dynamic(value):
            return elementwise(operator.invert)(value)
        if isinstance(node.op, ast.Invert):
            return ~value
        return -value if isinstance(node.op, ast.USub) else +value

    def _of_BinOp(self, node: ast.BinOp) -> Any:
        left = self.value(node.left)
        return self.operated(node.op, self.kept(left) if calls(node.right) else left, self.value(node.right))

    def operated(self, op: ast.operator, one: Any, other: Any) -> Any:
        """Return one value, an operator and another."""
        function = _OPERATORS.get(type(op))
        if function is None:
            raise Untranslatable(f"no operator {type(op).__name__} here")
        if grid_library.takes([one, other], function):
            return grid_library.operated(self.unit, function, one, other)
        if not is_dynamic([one, other]):
            return function(one, other)
        if isinstance(op, ast.BitOr | ast.BitAnd | ast.Pow) and isinstance(one, np.ndarray | Num):
            function = elementwise(function)
        return function(one, other)

    def _of_JoinedStr(self, node: ast.JoinedStr) -> Any:
        form, operands = "", []
        for part in node.values:
            if isinstance(part, ast.Constant):
                form += str(part.value).replace("%", "%%")
                continue
            assert isinstance(part, ast.FormattedValue)
            value = self.value(part.value)
            spec = str(self.value(part.format_spec)) if part.format_spec is not None else ""
            if isinstance(value, Num):
                form += f"%{spec or 'g'}"
                operands.append(literal(value))
            else:
                form += format(value, spec).replace("%", "%%")
        return Text(form, operands) if operands else form.replace("%%", "%")

    def _of_Lambda(self, node: ast.Lambda) -> Any:
        return self.closed(node, "step")

    def closed(self, node: ast.Lambda | ast.FunctionDef, name: str) -> Closure:
        """Return a function that keeps the names it uses."""
        seen = self.closure.names | self.names
        uses = {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}
        kept = {each: seen[each] for each in sorted(uses) if each in seen}
        given, named = node.args, zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True)
        usual = [*zip(given.args[len(given.args) - len(given.defaults) :], given.defaults, strict=True), *named]
        kept |= {each.arg: self.value(value) for each, value in usual if value is not None}
        return Closure(node, name, kept, self.closure.module, f"{self.closure.path}.{name}")

    def _comprehended(self, node: Any, give: Callable[[], Any]) -> list[Any]:
        found: list[Any] = []

        def level(depth: int) -> None:
            if depth == len(node.generators):
                found.append(give())
                return
            part = node.generators[depth]
            for item in self.listed(self.value(part.iter)):
                self.bind(part.target, item)
                if all(self.test(test) for test in part.ifs):
                    level(depth + 1)

        outer, self.names = self.names, dict(self.names)
        level(0)
        self.names = outer
        return found

    def _of_ListComp(self, node: ast.ListComp | ast.GeneratorExp) -> Any:
        return self._comprehended(node, lambda: self.value(node.elt))

    def _of_GeneratorExp(self, node: ast.GeneratorExp) -> Any:
        return self._of_ListComp(node)

    def _of_DictComp(self, node: ast.DictComp) -> Any:
        return dict(self._comprehended(node, lambda: (self.value(node.key), self.value(node.value))))

    def _of_Call(self, node: ast.Call) -> Any:
        if isinstance(node.func, ast.Name) and node.func.id == "super":
            return Super(self.lookup("__class__"), self.lookup(self.closure.node.args.args[0].arg))
        operands = self._items(node.args)
        named: dict[str, Any] = {}
        for keyword in node.keywords:
            value = self.value(keyword.value)
            named |= value if keyword.arg is None else {keyword.arg: value}
        if isinstance(node.func, ast.Attribute):
            owner = self.value(node.func.value)
            method = ARRAY_METHODS.get(node.func.attr)
            if isinstance(owner, np.ndarray) and is_dynamic(owner) and node.func.attr in grid_library.OF_GRIDS:
                owner = grids.of(self.unit, owner)
            if isinstance(owner, Grid):
                return grid_library.method(self.unit, owner, node.func.attr, operands, named)
            if method and (isinstance(owner, np.ndarray) and is_dynamic(owner)):
                return method(owner, *operands, **named)
            function = self.translator.attribute(self.unit, owner, node.func.attr)
        else:
            function = self.value(node.func)
        return self._call(function, operands, named)

    def _call(self, function: Any, operands: list[Any], named: dict[str, Any]) -> Any:
        found = grid_library.called(self.unit, function, operands, named)
        if found is not NotImplemented:
            return found
        handler = HANDLERS.get(function) if function.__hash__ else None
        if handler is not None and (is_dynamic(operands) or is_dynamic(named) or function in ALWAYS):
            return handler(*operands, **named)
        if isinstance(function, Method):
            return self.translator.call(self.unit, function.function, [function.owner, *operands], named)
        if isinstance(function, Closure):
            return self.translator.call(self.unit, function, operands, named)
        if not is_dynamic(operands) and not is_dynamic(named):
            return function(*operands, **named)
        if isinstance(function, types.MethodType) and not is_dynamic(function.__self__):
            if function.__name__ == "_replace":
                return function(*operands, **named)
            if function.__func__ in HANDLERS:
                return HANDLERS[function.__func__](function.__self__, *operands, **named)
            return self.translator.call(self.unit, function.__func__, [function.__self__, *operands], named)  # type: ignore[arg-type]
        if hasattr(function, "__wrapped__"):
            function = inspect.unwrap(function)
        if isinstance(function, types.FunctionType):
            return self.translator.call(self.unit, function, operands, named)
        if isinstance(function, type) and (dataclasses.is_dataclass(function) or hasattr(function, "_fields")):
            return function(*operands, **named)
        if isinstance(function, types.MethodType | types.BuiltinMethodType | type) or function is range:
            return function(*operands, **named)
        own = inspect.getattr_static(type(function), "__call__", None)
        if isinstance(own, types.FunctionType):
            return self.translator.call(self.unit, own, [function, *operands], named)
        raise Untranslatable(f"a call of {function!r}: it has no counterpart in C so far")
