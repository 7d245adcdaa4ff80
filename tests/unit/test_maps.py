"""The docstring of each package lists its modules and packages, and nothing else."""

import re
from pathlib import Path

import pytest

import contact_core
import fmu_src
import system_models
from system_models.machines.registry import KINDS

ROOTS = [Path(package.__file__).parent for package in (contact_core, fmu_src, system_models)]
PACKAGES = sorted(path.parent for root in ROOTS for path in root.rglob("__init__.py"))


def name_of(package: Path) -> str:
    """Return the dotted name of a package's folder."""
    root = next(root for root in ROOTS if root in (package, *package.parents))
    return ".".join(package.relative_to(root.parent).parts)


@pytest.mark.parametrize("package", PACKAGES, ids=name_of)
def test_a_map_names_exactly_the_modules_of_its_package(package: Path) -> None:
    text = (package / "__init__.py").read_text("utf-8").split('"""')[1]
    rows = re.findall(r"^    (\w[\w/]*(?:, \w[\w/]*)*)(?: {2,}| (?=\w))", text, re.MULTILINE)
    listed = {name.rstrip("/") for row in rows for name in row.split(", ")} | set(re.findall(r"; (\w+)/?:", text))
    modules = {path.stem for path in package.glob("*.py")} - {"__init__"}
    inside = {path.name for path in package.iterdir() if path.is_dir() and any(path.glob("*.[pt]*"))}
    folders = inside - {"__pycache__"} - set(KINDS)  # the registry lists kinds of machines
    assert listed == modules | folders


def test_the_registry_lists_every_folder_of_a_kind_of_machine() -> None:
    assert sorted(KINDS) == sorted(path.parent.name for path in ROOTS[-1].glob("machines/*/machine.py"))
