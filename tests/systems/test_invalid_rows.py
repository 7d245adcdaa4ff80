"""A contact that could not use its inputs is told, and shows in the exit code, whatever was asked to be recorded."""

from pathlib import Path

import pytest
from built import Built
from checking import edited, replaced

from benchmarks.models import build
from contact_core import Scene
from system_models.cli.main import main
from system_models.master import System, simulate
from system_models.store import results

COLD = """
[fmus]
source = "{source}"
contact = "{contact}"
[coupling]
connections = [["source.y", "contact.temperature"]]
[parameters]
source.u = {temperature}
[simulate]
stop_time = 1.0
step_size = 0.5
outputs = ["contact.h_c"]
"""


@pytest.fixture(scope="module")
def contact(scene: Scene, built: Built) -> Path:
    return built.fmu(scene.at_level("regression"), "embedded")


@pytest.mark.parametrize(("temperature", "code"), [(5.0, 1), (353.0, 0)])
def test_a_contact_that_cannot_use_its_inputs_is_told_whatever_is_recorded(
    temperature: float,
    code: int,
    contact: Path,
    built: Built,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    source = build("kelvin", built.models)
    Path("cold.toml").write_text(COLD.format(source=source, contact=contact, temperature=temperature))
    assert main(["cosim", "cold.toml"]) == code
    out = capsys.readouterr().out
    dataset = results.read(Path("results/cold/result.nc"))
    assert dataset["contact.valid"].values.tolist() == [not code] * 3
    assert dataset.attrs["invalid"] == 3 * code
    assert ("WARNING: 3 of 3 rows are INVALID: contact could not use the inputs" in out) == bool(code)
    assert ("contact says: " in out and "5 K" in out) == bool(code)


def test_an_output_of_another_fmu_that_is_called_valid_is_an_output_as_any_other(built: Built, tmp_path: Path) -> None:
    fmu = edited(build("echo", built.models), tmp_path / "echo.fmu", replaced('name="boolean_out"', 'name="valid"'))
    result = simulate(System({"a": fmu}), 0.2, 0.1)
    assert result["a.valid"].values.tolist() == [False] * 3
    assert result.attrs["invalid"] == 0
