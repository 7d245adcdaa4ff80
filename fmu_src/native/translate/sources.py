"""Functions of Python: their syntax trees, names and texts."""

import ast
import functools
import inspect
import textwrap
import types
from typing import Any

from .values import Closure


@functools.cache
def _tree(function: types.FunctionType) -> Any:
    source = textwrap.dedent(inspect.getsource(function))
    found = next(
        node
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.FunctionDef | ast.Lambda) and getattr(node, "name", "<lambda>") == function.__name__
    )
    ast.increment_lineno(found, function.__code__.co_firstlineno - 1)  # lines of its file
    return found


def closure_of(function: types.FunctionType) -> Closure:
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


def about(closure: Closure) -> list[str]:
    """Return the lines of a comment: the first line of a function's text, and where it stands."""
    text = ast.get_docstring(closure.node) if isinstance(closure.node, ast.FunctionDef) else None
    found = [*text.splitlines()[:1], closure.path] if text else [closure.path]
    return [line.replace("*/", "* /") for line in found]


def statements_of(node: Any) -> list[ast.stmt]:
    """Return the statements of a function but its text."""
    return [each for each in node.body if not (isinstance(each, ast.Expr) and isinstance(each.value, ast.Constant))]


def is_straight(node: Any) -> bool:
    """Return True for a function without loops, and with choices by its law alone: each element has a copy of it."""
    *before, last = statements_of(node)
    return isinstance(last, ast.Return) and all(map(_goes_on, before))


def _goes_on(node: ast.stmt) -> bool:
    """Return True for an assignment, or a choice between some that the parameters of a law decide."""
    if isinstance(node, ast.If):
        decides = {each.id for each in ast.walk(node.test) if isinstance(each, ast.Name)}
        return decides <= {"self"} and all(map(_goes_on, [*node.body, *node.orelse]))
    return isinstance(node, ast.Assign)


@functools.cache
def is_compiled(node: Any) -> bool:
    """Return True for a function that numba compiles: its loops stay loops, and it may set arrays."""
    marks = [ast.unparse(each) for each in getattr(node, "decorator_list", [])]
    return any(mark.endswith("jit") for mark in marks)


@functools.cache
def names_set(node: Any) -> frozenset[str]:
    """Return the names of arrays of which a function sets elements."""
    targets = (each.value for each in ast.walk(node) if isinstance(each, ast.Subscript) and _is_stored(each))
    return frozenset(each.id for each in targets if isinstance(each, ast.Name))


@functools.cache
def takers(node: Any, name: str) -> frozenset[str]:
    """Return the names of functions that are called with a name."""
    calls = (each for each in ast.walk(node) if isinstance(each, ast.Call) and isinstance(each.func, ast.Name))
    return frozenset(
        each.func.id  # type: ignore[attr-defined]
        for each in calls
        if any(isinstance(operand, ast.Name) and operand.id == name for operand in each.args)
    )


@functools.cache
def calls(node: ast.expr) -> bool:
    """Return True for an expression with a call."""
    return any(isinstance(each, ast.Call) for each in ast.walk(node))


def _is_stored(node: ast.Subscript) -> bool:
    return isinstance(node.ctx, ast.Store)


def expression_of(node: Any) -> ast.expr | None:
    """Return the expression of a function that is nothing else."""
    if isinstance(node, ast.Lambda):
        return node.body
    body = statements_of(node)
    return body[0].value if len(body) == 1 and isinstance(body[0], ast.Return) else None


def method_after(cls: type, kind: type, name: str) -> Any:
    """Return a method of the first class after `cls` among the ancestors of a class."""
    ancestors = kind.__mro__
    return next(vars(each)[name] for each in ancestors[ancestors.index(cls) + 1 :] if name in vars(each))
