"""The measures of the code's structure: files, imports, arguments that belong together, classes asked for."""

import ast
import gc
import re
from collections.abc import Collection, Iterator
from functools import cache
from pathlib import Path

import pytest

import contact_core
import fmu_src
import system_models
from contact_core import shapes
from contact_core.film import FILMS
from contact_core.laws import SLOTS

PACKAGES = [Path(package.__file__).parent for package in (contact_core, fmu_src, system_models)]
FILES = sorted(file for package in PACKAGES for file in package.rglob("*.py"))
CORE = PACKAGES[0]


@cache
def tree_of(file: Path) -> ast.Module:
    """Return the syntax tree of a file."""
    return ast.parse(file.read_text("utf-8"))


@pytest.fixture(scope="module", autouse=True)
def _no_search_for_garbage() -> Iterator[None]:
    """It would take most of the time: every tree is kept to the end."""
    gc.disable()
    yield
    tree_of.cache_clear()
    gc.enable()


def imported(file: Path) -> set[str]:
    """Return the rooms of contact_core that a file of it imports, by their names."""
    found = set()
    here = file.relative_to(CORE.parent).with_suffix("").parts
    for node in ast.walk(tree_of(file)):
        if isinstance(node, ast.ImportFrom):
            base = list(here[: len(here) - node.level]) if node.level else []
            path = [*base, *(node.module.split(".") if node.module else [])]
            rooms = [path[1]] if len(path) > 1 else [alias.name for alias in node.names]
            found |= {room for room in rooms if path[0] == CORE.name}
    return found


def statements(node: ast.AST) -> int:
    """Return the number of statements in a node: unlike lines, neither docstrings nor line breaks change it."""
    inside = [each for each in ast.walk(node) if isinstance(each, ast.stmt)]
    return len(inside) - sum(
        isinstance(each, (ast.FunctionDef, ast.ClassDef)) and ast.get_docstring(each) is not None for each in inside
    )


def long_parts(tree: ast.AST, *, kernels: bool = False) -> list[str]:
    """Return the names of classes and functions of a file that are too long or take too many arguments.

    Compiled kernels are loops over nodes: they may be longer, and in `contact_core/kernels` they take their arrays one
    by one. What must be named may be left out by name, so that more arguments are bearable.
    """
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            lines = node.end_lineno - node.lineno + 1  # type: ignore[operator]
            if lines > 250:
                found.append(f"class {node.name}: {lines} lines")
        if isinstance(node, ast.FunctionDef):
            compiled = any("jit" in ast.unparse(each) for each in node.decorator_list)
            given = node.args
            own = [each for each in (*given.posonlyargs, *given.args) if each.arg not in ("self", "cls")]
            if statements(node) > (100 if compiled else 60):
                found.append(f"{node.name}: {statements(node)} statements")
            if len(own) > 10 and not compiled:
                found.append(f"{node.name}: {len(own)} arguments by position")
            if len(own) + len(given.kwonlyargs) > 12 and not kernels:
                found.append(f"{node.name}: {len(own) + len(given.kwonlyargs)} arguments")
    return found


def test_classes_and_functions_are_small_and_take_few_arguments() -> None:
    found = {file.name: long_parts(tree_of(file), kernels=CORE / "kernels" in file.parents) for file in FILES}
    assert {name: parts for name, parts in found.items() if parts} == {}


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("class A:\n" + "    x = 1\n" * 250, ["class A: 251 lines"]),
        ("class A:\n" + "    x = 1\n" * 249, []),
        ("def f():\n" + "    x = 1\n" * 60, ["f: 61 statements"]),
        ("@jit\ndef f(a, b, c, d, e, f, g, h, i, j, k):\n" + "    x = 1\n" * 60, []),
        ("@jit\ndef f(a, b, c, d, e, f, g, h, i, j, k, l, m):\n    pass", ["f: 13 arguments"]),
        ("def f(a, b, c, d, e, f, g, h, i, j, k):\n    pass", ["f: 11 arguments by position"]),
        ("def f(*, a, b, c, d, e, f, g, h, i, j, k, l, m):\n    pass", ["f: 13 arguments"]),
        ("class A:\n    def f(self, *, a, b, c, d, e, f, g, h, i, j, k):\n" + '        """' + "\n" * 99 + '"""', []),
    ],
)
def test_long_parts_are_found(text: str, parts: list[str]) -> None:
    assert long_parts(ast.parse(text)) == parts
    in_kernels = [part for part in parts if not part.endswith("13 arguments")]
    assert long_parts(ast.parse(text), kernels=True) == in_kernels


def test_few_rooms_of_the_core_import_each_other() -> None:
    arrows = set()
    for file in CORE.rglob("*.py"):
        room = file.relative_to(CORE).parts[0].removesuffix(".py")
        arrows |= {(room, other) for other in imported(file)} if room != "__init__" else set()
    arrows = {(room, other) for room, other in arrows if room != other}
    assert 40 < len(arrows) <= 80, sorted(arrows)


def functions() -> list[tuple[str, ast.FunctionDef]]:
    """Return all functions and methods with the place of each."""
    trees = [(file, tree_of(file)) for file in FILES]
    return [
        (f"{file.name}:{node.name}", node)
        for file, tree in trees
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
    ]


def has_argument(function: ast.FunctionDef, name: str, *types: str) -> bool:
    """Return True if the function has an argument of this name, or one whose annotation is one of `types`."""
    given = function.args
    arguments = [*given.posonlyargs, *given.args, *given.kwonlyargs]
    annotations = {argument.annotation for argument in arguments if argument.annotation}
    said = {word for annotation in annotations for word in re.findall(r"\w+", ast.unparse(annotation))}
    return name in {argument.arg for argument in arguments} or bool(said & set(types))


def test_scene_and_operating_point_travel_in_a_case() -> None:
    """Functions that take both apart, by whatever names, are those that bind, check or offer them to users."""
    both = [
        where
        for where, function in functions()
        if has_argument(function, "scene", "Scene", "SceneFields") and has_argument(function, "op", "OperatingPoint")
    ]
    assert 0 < len(both) <= 16, both


def asked(file: Path, classes: Collection[str], slots: Collection[str]) -> list[str]:
    """Return where a file asks whether something is one of `classes`, or what the name of a slot's record is."""
    found = []
    for node in ast.walk(tree_of(file)):
        if isinstance(node, ast.Call) and ast.unparse(node.func) in ("isinstance", "issubclass"):
            named = {word for word in re.findall(r"\w+", ast.unparse(node.args[1])) if word in classes}
        elif isinstance(node, ast.MatchClass):
            named = {ast.unparse(node.cls).rpartition(".")[2]} & set(classes)
        elif isinstance(node, ast.Compare):
            parts = [node.left, *node.comparators]
            looked_up = any(isinstance(sign, (ast.In, ast.NotIn)) for sign in node.ops)
            listed = any(isinstance(part, (ast.Tuple, ast.List, ast.Set)) for part in parts)
            sides = [ast.unparse(part) for part in parts if listed or not looked_up]
            named = {side for side in sides if is_name_of(side, slots)}
        elif isinstance(node, ast.Match):
            named = {side for side in [ast.unparse(node.subject)] if is_name_of(side, slots)}
        else:
            continue
        found += [f"{file.name}:{node.lineno}: {each}" for each in sorted(named)]
    return found


def is_name_of(expression: str, slots: Collection[str]) -> bool:
    """Return True for `scene.film.name`, `film.name` and so on."""
    return re.search(rf"\b({'|'.join(slots)})\.name$", expression) is not None


def test_nothing_asks_for_the_class_or_the_name_of_a_geometry_a_film_or_a_law() -> None:
    """A new one would have to be added there. Each room knows its own; a level knows the record that it reads."""
    rooms = {
        "shapes": "shapes",
        "film": "film",
        "laws": "laws",
        "deterministic": "film",
        "regression": "film",
    }
    classes = {
        "shapes": {name for name, each in vars(shapes).items() if isinstance(each, type)},
        "film": {record.__name__ for record in FILMS},
        "laws": {law.__name__ for laws in SLOTS.values() for law in laws},
    }
    assert {"LineGeometry", "Line", "Deterministic", "AstmD341"} <= set().union(*classes.values())
    slots = {"film", "geometry", "level", "shape", *SLOTS}
    found = []
    for file in FILES:
        room = file.relative_to(CORE).parts[0] if CORE in file.parents else ""
        foreign = set().union(*(names for kind, names in classes.items() if rooms.get(room) != kind))
        if room == "calls":  # users hand over laws, which are checked
            foreign -= classes["laws"]
        found += asked(file, foreign, slots)
    assert found == []


@pytest.mark.parametrize(
    "line",
    [
        'scene.film.name == "regression"',
        '"line" != case.scene.geometry.name',
        "film.name == Regression.name",
        'geometry.name in ("line", "roller")',
        'scene.lubricant.supply.name == "flooded"',
        "isinstance(scene.geometry, LineGeometry)",
        "isinstance(shape, (shapes.Line, Point))",
    ],
)
def test_such_a_question_is_found(tmp_path: Path, line: str) -> None:
    file = tmp_path / "code.py"
    file.write_text(f"if {line}:\n    pass\n", "utf-8")
    assert asked(file, {"Line", "LineGeometry", "Point"}, {"film", "geometry", "supply"})
