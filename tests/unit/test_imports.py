"""What is loaded, and when: a worker process must be there at once."""

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest

import contact_core.kernels

_HEAVY = (
    "numba",
    "llvmlite",
    "pyfftw",
    "xarray",
    *(f"scipy.{part}" for part in ("fft", "linalg", "special", "sparse", "ndimage")),
)

_FAST_LEVEL = """
scene = Scene.from_toml("mtm_zddp").at_level("regression")
state, _ = advance(scene, scene.operation.point, initial_state(scene), 0.0)
advance(scene, scene.operation.point, state, 1.0)
"""


def _loaded(code: str) -> set[str]:
    """Those of the heavy packages that a fresh process has loaded after the code."""
    report = f"\nimport json, sys\nprint(json.dumps([name for name in {_HEAVY!r} if name in sys.modules]))"
    run = subprocess.run([sys.executable, "-c", code + report], capture_output=True, text=True, check=True)
    return set(json.loads(run.stdout))


@pytest.mark.parametrize("package", ["contact_core", "fmu_src.runtime.slave"])
def test_an_import_loads_no_compiler_and_no_heavy_package(package):
    assert _loaded(f"import {package}") == set()


def test_the_regression_level_needs_no_compiler():
    loaded = _loaded("from contact_core import Scene, advance, initial_state" + _FAST_LEVEL)
    assert not loaded & {"numba", "llvmlite", "pyfftw", "xarray"}


def test_kernels_import_four_packages_and_no_other():
    """A white list, which import-linter has for this project's own modules only."""
    found = set()
    for file in Path(contact_core.kernels.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Import):
                found |= {name.name.partition(".")[0] for name in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                found.add(str(node.module).partition(".")[0])
    assert found - sys.stdlib_module_names == {"numpy", "numba", "scipy", "pyfftw"}


def test_the_deterministic_level_loads_its_compiler_at_its_first_solution():
    """The probe sees what it is to see."""
    assert "numba" in _loaded("import contact_core.film.routes")
