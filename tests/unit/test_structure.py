"""The measures of the code's structure: size of files, imports between rooms, arguments that belong together."""

import ast
from pathlib import Path
from statistics import median

import contact_core
import fmu_src
import system_models

PACKAGES = [Path(package.__file__).parent for package in (contact_core, fmu_src, system_models)]
FILES = sorted(file for package in PACKAGES for file in package.rglob("*.py"))
CORE = PACKAGES[0]


def imported(file: Path) -> set[str]:
    """Return the rooms of contact_core that a file of it imports, by their names."""
    found = set()
    here = file.relative_to(CORE.parent).with_suffix("").parts
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom):
            base = list(here[: len(here) - node.level]) if node.level else []
            path = [*base, *(node.module.split(".") if node.module else [])]
            rooms = [path[1]] if len(path) > 1 else [alias.name for alias in node.names]
            found |= {room for room in rooms if path[0] == CORE.name}
    return found


def test_files_are_small() -> None:
    lines = {file: len(file.read_text("utf-8").splitlines()) for file in FILES}
    assert [str(file) for file, count in lines.items() if count > 450] == []
    assert median(lines.values()) < 120


def test_few_rooms_of_the_core_import_each_other() -> None:
    arrows = set()
    for file in CORE.rglob("*.py"):
        room = file.relative_to(CORE).parts[0].removesuffix(".py")
        arrows |= {(room, other) for other in imported(file)} if room != "__init__" else set()
    arrows = {(room, other) for room, other in arrows if room != other}
    assert 40 < len(arrows) <= 90, sorted(arrows)


def test_scene_and_operating_point_travel_in_a_case() -> None:
    """Functions that take both apart are those that bind, check or offer them to users."""
    both = [
        f"{file.name}:{node.name}"
        for file in FILES
        for node in ast.walk(ast.parse(file.read_text("utf-8")))
        if isinstance(node, ast.FunctionDef) and {"scene", "op"} <= {argument.arg for argument in node.args.args}
    ]
    assert 0 < len(both) <= 15, both
