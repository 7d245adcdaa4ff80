"""A native FMU of a contact by a map: its equations are those of Python, and its description says what it can."""

import shutil
from pathlib import Path

import fmpy
import pytest
from built import Built
from mapped_scene import mapped_scene

from benchmarks.fmu.native_contact import NativeContact, differences, tolerance
from contact_core import Scene
from system_models.check.deep import findings
from system_models.check.package import opened
from system_models.check.start import asked, cheapest
from system_models.check.verdict import Verdict
from system_models.fmu.errors import FmuError

pytestmark = [pytest.mark.fmu, pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")]


@pytest.fixture(scope="module")
def mapped(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    return mapped_scene(tmp_path_factory.mktemp("mapped"))


def test_c_does_what_python_does_by_a_map(mapped: Scene, tmp_path: Path) -> None:
    found = differences(mapped, NativeContact(mapped, tmp_path), 2, 8)
    assert {name: wrong for name, wrong in found.items() if not wrong <= tolerance(name)} == {}


def test_a_contact_with_a_map_is_checked_at_the_one_level_that_it_has(
    mapped: Scene, built: Built, monkeypatch: pytest.MonkeyPatch
) -> None:
    fmu = built.fmu(mapped, "native", here=True)
    description = fmpy.read_model_description(str(fmu))
    assert cheapest(description) == {}
    with pytest.raises(FmuError, match=r"fidelity = 1: this FMU has no other value than 4\. Leave it out of --set\."):
        asked(description, [("fidelity", "1")])
    monkeypatch.setattr("system_models.check.deep.RULES", {"run": ("run",), "input range": ("sweep",)})
    with opened(fmu) as package:
        found = list(findings(package, 60.0, 600.0))
    assert [(f.rule, f.verdict) for f in found] == [("run", Verdict.PASS), ("input range", Verdict.PASS)]
