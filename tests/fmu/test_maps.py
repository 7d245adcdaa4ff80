"""The docstring of every package of fmu_src lists exactly its modules and packages."""

import importlib
import pkgutil
import re

import pytest

import fmu_src

PACKAGES = ["fmu_src", *(m.name for m in pkgutil.walk_packages(fmu_src.__path__, "fmu_src.") if m.ispkg)]


@pytest.mark.parametrize("name", PACKAGES)
def test_the_map_of_a_package_names_its_modules(name):
    package = importlib.import_module(name)
    listed = re.findall(r"^    (\w+) {2,}", package.__doc__, flags=re.MULTILINE)
    assert sorted(listed) == sorted(module.name for module in pkgutil.iter_modules(package.__path__))
