"""The map in the docstring of each package of system_models names its modules, and no others."""

import re
from pathlib import Path

import pytest

import system_models
from system_models.machines.registry import KINDS

ROOT = Path(system_models.__file__).parent
PACKAGES = sorted(path.parent for path in ROOT.rglob("__init__.py"))


@pytest.mark.parametrize("package", PACKAGES, ids=lambda path: str(path.relative_to(ROOT.parent)))
def test_a_map_names_exactly_the_modules_of_its_package(package: Path) -> None:
    text = (package / "__init__.py").read_text("utf-8").split('"""')[1]
    rows = re.findall(r"^    (\w[\w/]*(?:, \w[\w/]*)*)(?: {2,}| (?=\w))", text, re.MULTILINE)
    listed = {name for row in rows for name in row.split(", ")}
    listed |= set(re.findall(r"; (\w+/?):", text))
    modules = {path.stem for path in package.glob("*.py")} - {"__init__"}
    inside = [path for path in package.iterdir() if any(path.glob("*.[pt]*")) and path.name != "__pycache__"]
    folders = {f"{path.name}/" for path in inside if path.name not in KINDS}  # the registry lists those
    assert listed == modules | folders


def test_the_registry_lists_every_folder_of_a_kind_of_machine() -> None:
    assert sorted(KINDS) == sorted(path.parent.name for path in ROOT.glob("machines/*/machine.py"))
