"""A host that gives NULL in place of values gets an error and a message from every flavour in C."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import native_fmu
import pytest
from fmu_host import unpacked

from contact_core import Scene
from fmu_src.package.build import build

pytestmark = [pytest.mark.fmu, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]

ERROR = 3
SCRIPT = Path(__file__).with_name("null_calls.py")


@pytest.fixture(params=[("native", 2), ("native", 3), ("isolated", 2), ("isolated", 3)], ids=lambda given: str(given))
def folder(request: pytest.FixtureRequest, quick: Scene, tmp_path: Path) -> Path:
    flavour, fmi = request.param
    if flavour == "native":
        return native_fmu.unpacked(tmp_path, fmi)
    return unpacked(build(quick, tmp_path / "quick.fmu", fmi=fmi), tmp_path / "quick")


def test_null_in_place_of_values_is_an_error_that_is_told(folder: Path) -> None:
    done = subprocess.run([sys.executable, str(SCRIPT), str(folder)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr  # a crash is a negative number
    answers = json.loads(done.stdout)
    assert len(answers) > 40
    assert [answer for answer in answers if answer[1] != ERROR or not answer[2]] == []
