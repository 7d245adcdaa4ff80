"""Digests of source files that change with what they compute, not with how they are worded."""

import ast
import hashlib
import json
import tomllib
from collections.abc import Iterator
from pathlib import PurePosixPath
from typing import TypeGuard

LENGTH = 12  # hexadecimal digits
SAID = ("source", "equations")  # what a class says about itself


def digest(parts: Iterator[str] | list[str]) -> str:
    """Return the digest of some texts in this order."""
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:LENGTH]


def meaning(path: str, content: bytes) -> str:
    """What a file says to the machine: Python without wording, TOML without comments, anything else byte for byte."""
    suffix = PurePosixPath(path).suffix
    if suffix == ".py":
        return written(ast.parse(content))
    if suffix == ".toml":
        return json.dumps(tomllib.loads(content.decode()), sort_keys=True, default=str)
    return content.hex()


def written(node: object) -> str:
    """Return a tree of Python in a form that does not depend on Python's version.

    Left out: docstrings, annotations, the messages of errors, sources and equations for people, and units, texts and
    ranges of a `parameter`.
    """
    if isinstance(node, list):
        return "[" + ",".join(map(written, node)) + "]"
    if not isinstance(node, ast.AST):
        return repr(node)
    if isinstance(node, ast.Raise):
        raised = node.exc.func if isinstance(node.exc, ast.Call) else node.exc
        return f"Raise({written(raised)})"
    if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.target.id in SAID:
        return ""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Equations":
        return ""
    if _is_parameter(node):
        return f"parameter({written([key.value for key in node.keywords if key.arg == 'default'])})"
    fields = dict(ast.iter_fields(node))
    for name in ("annotation", "returns", "type_comment", "kind"):
        fields.pop(name, None)
    if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
        fields["body"] = node.body[1:] if ast.get_docstring(node, clean=False) is not None else node.body
    said = (f"{name}={written(value)}" for name, value in fields.items() if value is not None and value != [])
    return f"{type(node).__name__}({','.join(said)})"


def _is_parameter(node: object) -> TypeGuard[ast.Call]:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "parameter"


def defaults(content: bytes) -> str:
    """Return what functions take for arguments, and classes for fields, that are not given, unless that is None."""
    found = []
    for node in ast.walk(ast.parse(content)):
        if isinstance(node, ast.FunctionDef):
            places = [*node.args.posonlyargs, *node.args.args]
            given = list(zip(places[len(places) - len(node.args.defaults) :], node.args.defaults, strict=True))
            given += [
                (arg, value) for arg, value in zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True) if value
            ]
            found += [f"{node.name}.{arg.arg}={written(value)}" for arg, value in given]
        elif isinstance(node, ast.ClassDef):
            fields = [part for part in node.body if isinstance(part, ast.AnnAssign) and part.value is not None]
            found += [f"{node.name}.{ast.unparse(part.target)}={written(part.value)}" for part in fields]
    nothing = ("=Constant()", "=parameter([Constant()])", "=parameter([])")  # `written` leaves out what is None
    return "\n".join(sorted(line for line in found if not line.endswith(nothing)))


def imported(content: bytes, package: str) -> set[str]:
    """Names of modules of a package that a module imports, with those that may be names inside of them."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(content)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level:
            names |= {node.module or "", *(f"{node.module}.{alias.name}" for alias in node.names)}
    return {name for name in names if name.startswith(f"{package}.")}
