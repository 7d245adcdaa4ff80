"""A result on disk: all rows, the exit code of its run, and no replacement by that of another scene without force."""

import csv
from pathlib import Path

import pytest
import xarray as xr

from contact_core.errors import ContactError
from system_models.cli.listener import CONSOLE
from system_models.runs.job import EXIT_CODE, of_before
from system_models.runs.listener import QUIET
from system_models.runs.replacing import ask_before
from system_models.store.results import write, write_csv


def result(scene: str) -> xr.Dataset:
    time = ("time", [0.0, 1.0, 2.5], {"units": "s"})
    return xr.Dataset({"h_c": ("time", [1e-7, 2e-7, 0.1 + 0.2], {"units": "m"})}, {"time": time}, {"scene": scene})


def test_a_table_has_a_row_for_each_point_and_every_digit(tmp_path: Path) -> None:
    with write_csv(result("mine"), tmp_path / "result.csv").open(newline="") as file:
        header, *rows = csv.reader(file)
    assert header == ["time [s]", "h_c [m]"]
    assert [[float(cell) for cell in row] for row in rows] == [[0.0, 1e-7], [1.0, 2e-7], [2.5, 0.1 + 0.2]]


def test_the_result_of_another_scene_is_replaced_by_force_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(result("mine"), tmp_path)
    with pytest.raises(ContactError, match="is the result of 'mine', and this is 'other'"):
        ask_before(tmp_path, {"scene": "other"}, force=False, listener=CONSOLE)
    ask_before(tmp_path, {"scene": "other"}, force=True, listener=CONSOLE)
    assert "a result of 'mine', will be replaced" in capsys.readouterr().err
    ask_before(tmp_path, {"scene": "mine"}, force=False, listener=CONSOLE)
    assert not capsys.readouterr().err


@pytest.mark.parametrize("code", [0, 1])
def test_a_finished_run_ends_again_as_it_ended(code: int, tmp_path: Path) -> None:
    """`--resume` of a run whose steps have not converged does not call it right."""
    write(result("mine").assign_attrs({EXIT_CODE: code}), tmp_path)
    before = of_before({"scene": "mine"}, tmp_path, QUIET)
    assert before is not None
    assert before.exit_code == code
    assert of_before({"scene": "other"}, tmp_path, QUIET) is None
