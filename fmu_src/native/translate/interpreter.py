"""Statements of Python, in one scope: an interpreter that computes what is known and writes C for what is not."""

import ast
import importlib
from typing import Any

import numpy as np

from . import code, grids
from .expressions import Expressions
from .grids import Stored, View
from .library import Span
from .loops import counted, repeated
from .sources import is_compiled
from .units import Poison, Text
from .values import Num, Untranslatable

_LONG = 16  # rounds from which on a loop over a range stays a loop


class Unrolled:
    """A loop over a sequence: its body is written once for each item."""

    def __init__(self, depth: int) -> None:
        self.depth, self.left = depth, ""  # blocks around it; how the present round was left


class Scope(Expressions):
    """One scope of Python: its names, and the C function that its statements go to."""

    # statements: each returns True if the next one is reached

    def run(self, statements: list[ast.stmt]) -> bool:
        """Run statements; return True if what follows them is reached."""
        for statement in statements:
            work = getattr(self, f"_do_{type(statement).__name__}", None)
            try:
                if work is None or (getattr(statement, "orelse", None) and not isinstance(statement, ast.If)):
                    raise Untranslatable(f"no {'else' if work else type(statement).__name__} here")
                if not work(statement):
                    return False
            except Untranslatable as error:
                raise self._placed(error, statement) from error
            except (TypeError, ValueError, AttributeError, LookupError) as error:  # of Python with numbers it knows not
                said = Untranslatable(f"{type(error).__name__}: {error}")
                raise self._placed(said, statement) from error
        return True

    def refuse(self, message: str | Text) -> None:
        """Leave the function with a message."""
        text = message if isinstance(message, Text) else Text(message.replace("%", "%%"), [])
        self.translator.refuses(self.unit, text)

    def _placed(self, error: Untranslatable, node: ast.stmt) -> Untranslatable:
        """Return an error that says where: in the innermost function and statement."""
        if "\n" in str(error):
            return error
        line = ast.unparse(node).splitlines()[0]
        return Untranslatable(f"{error}\n  in {self.closure.path}, line {node.lineno}: {line}")

    def _do_Expr(self, node: ast.Expr) -> bool:
        if not isinstance(node.value, ast.Constant):
            self.value(node.value)
        return True

    def _do_Pass(self, node: ast.Pass) -> bool:
        return True

    def _do_Assert(self, node: ast.Assert) -> bool:
        return True

    def _do_Assign(self, node: ast.Assign) -> bool:
        value = self.value(node.value)
        for target in node.targets:
            self.bind(target, value)
        return True

    def _do_AnnAssign(self, node: ast.AnnAssign) -> bool:
        if node.value is not None:
            self.bind(node.target, self.value(node.value))
        return True

    def _do_AugAssign(self, node: ast.AugAssign) -> bool:
        now = self.value(_loaded(node.target))
        after = self.operated(node.op, now, self.value(node.value))
        if isinstance(now, np.ndarray) and is_compiled(self.closure.node):
            raise Untranslatable("it changes an array of a caller that has no place in C: give that a name there")
        if isinstance(now, Stored | View):  # in place
            grids.fill(self.unit, now, after)
        else:
            self.bind(node.target, after)
        return True

    def _do_Return(self, node: ast.Return) -> bool:
        value = None if node.value is None else self.value(node.value)
        self.translator.gives(self.unit, value)
        return False

    def _do_Raise(self, node: ast.Raise) -> bool:
        assert isinstance(node.exc, ast.Call)
        self.refuse(self.value(node.exc.args[0]))
        return False

    def _do_FunctionDef(self, node: ast.FunctionDef) -> bool:
        self.names[node.name] = self.closed(node, node.name)
        return True

    def _do_ImportFrom(self, node: ast.ImportFrom) -> bool:
        module = importlib.import_module("." * node.level + (node.module or ""), self.closure.module["__package__"])
        self.names |= {each.asname or each.name: getattr(module, each.name) for each in node.names}
        return True

    def _do_With(self, node: ast.With) -> bool:
        return self.run(node.body)

    def _do_If(self, node: ast.If) -> bool:
        test = self.test(node.test)
        if not isinstance(test, Num):
            return self.run(node.body if test else node.orelse)
        before = dict(self.names)
        goes_on, then = self.unit.branch(lambda: self.run(node.body))
        after, self.names = self.names, dict(before)
        goes_on_else, otherwise = self.unit.branch(lambda: self.run(node.orelse))
        if goes_on and goes_on_else:
            missing = Poison("it is bound in one branch alone: bind it before, too")
            self.names = {
                name: self._joined(name, after.get(name, missing), self.names.get(name, missing), then, otherwise)
                for name in after | self.names
            }
        elif goes_on:
            self.names = after
        self.unit.emit(code.If(test.text, then, otherwise))
        return goes_on or goes_on_else

    def _joined(self, name: str, one: Any, other: Any, then: code.Block, otherwise: code.Block) -> Any:
        if isinstance(one, Poison) or isinstance(other, Poison):
            return one if isinstance(one, Poison) else other
        if one is not other:
            one, other = self._stored_in(then, name, one), self._stored_in(otherwise, name, other)
        try:
            return self.unit.joined(name, one, other, then, otherwise)
        except Untranslatable as error:
            return Poison(str(error))

    def _stored_in(self, block: code.Block, name: str, value: Any) -> Any:
        """Return a value of a branch; a part of an array becomes an array of its own at the end of that."""
        if not isinstance(value, View):
            return value
        found, statements = self.unit.branch(lambda: grids.stored(self.unit, value, name))
        block.extend(statements)
        return found

    def _do_Break(self, node: ast.Break) -> bool:
        return self._leave("break")

    def _do_Continue(self, node: ast.Continue) -> bool:
        return self._leave("continue")

    def _leave(self, how: str) -> bool:
        loop = self.unit.loops[-1]
        if not isinstance(loop, Unrolled):
            loop(self, how == "break")
            self.unit.emit(code.Do(f"{how};"))
        elif loop.depth == len(self.unit.blocks):
            loop.left = how
        else:
            raise Untranslatable(f"a {how} that numbers at run time decide on, in a loop over a sequence: write an if")
        return False

    def _do_For(self, node: ast.For) -> bool:
        items = self.value(node.iter)
        stays = isinstance(items, range) and (len(items) > _LONG or is_compiled(self.closure.node))
        if stays or isinstance(items, Span):
            counted(self, node, items)
            return True
        loop = Unrolled(len(self.unit.blocks))
        self.unit.loops.append(loop)
        for item in self.listed(items):
            self.bind(node.target, item)
            loop.left = ""
            if not self.run(node.body) and not loop.left:
                return False
            if loop.left == "break":
                break
        self.unit.loops.pop()
        return True

    def _do_While(self, node: ast.While) -> bool:
        return repeated(self, node)


def _loaded(target: ast.expr) -> ast.expr:
    """Return the target of an assignment as an expression."""
    return ast.parse(ast.unparse(target), mode="eval").body
