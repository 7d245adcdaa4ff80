"""Runs from Python are those of the command: same result, same judgement, nothing printed."""

from pathlib import Path

import pytest
import xarray as xr

from contact_core import Scene
from contact_core.errors import ContactError
from system_models.cli.main import main
from system_models.runs import Listener, run_contact, run_machine

QUICK = {"film.model": "regression", "operation.duration": "5 min"}

MINE = """
film.model = "regression"
geometry.radius_x = "10 mm"
solids.set = "steel"
surface_1.finish = "polished"
surface_2.finish = "ground"
lubricant.viscosity = { viscosity_40 = "46 mm2/s", viscosity_100 = "6.8 mm2/s", density = "870 kg/m3" }
operation = { load = "50 N", speed_1 = "1.1 m/s", speed_2 = "0.9 m/s", temperature = "60 degC", duration = "1 min", \
file = "duty.csv" }
"""


class Kept(Listener):
    """Keeps what it hears."""

    def __init__(self) -> None:
        self.lines, self.notes = list[str](), list[str]()

    def say(self, *lines: str) -> None:
        self.lines += lines

    def note(self, sentence: str) -> None:
        self.notes.append(sentence)


def test_a_contact_runs_in_one_call_as_by_the_command_and_prints_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    heard = Kept()
    done = run_contact(Scene.from_toml("mtm_zddp", QUICK), tmp_path / "python", listener=heard)
    shown = capsys.readouterr()
    assert (shown.out, shown.err) == ("", "")
    assert done.exit_code == main(["run", "mtm_zddp", "--out", str(tmp_path / "command"), "--set",
                                   *(f"{key}={value}" for key, value in QUICK.items())])  # fmt: skip
    printed = capsys.readouterr().out
    assert all(line in printed for line in heard.lines if "Written" not in line and "microroughness" not in line)
    with xr.open_dataset(tmp_path / "command" / "result.nc") as result:
        xr.testing.assert_equal(done.dataset, result)
    assert done.reliable
    assert done.errors["friction_coefficient"].together > 0.0
    assert {path.name for path in done.written} >= {"result.nc", "overview.png"}
    again = run_contact(Scene.from_toml("mtm_zddp", QUICK), tmp_path / "python", resume=True, listener=heard)
    xr.testing.assert_equal(again.dataset, done.dataset)
    assert any("This run is finished" in note and "resume=True" in note for note in heard.notes)


def test_a_scene_by_its_file_is_read_as_by_the_command_with_what_it_assumes(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(MINE, encoding="utf-8")
    (tmp_path / "duty.csv").write_text("time [s],load [N]\n0,50\n30,400\n", encoding="utf-8")  # on a wider grid
    done = run_contact(file, tmp_path / "python")
    main(["run", str(file), "--out", str(tmp_path / "command")])
    with xr.open_dataset(tmp_path / "command" / "result.nc") as result:
        assert done.dataset.attrs["assumed_json"] == result.attrs["assumed_json"]
        xr.testing.assert_equal(done.dataset, result)


def test_the_result_of_another_scene_is_replaced_by_force_alone(tmp_path: Path) -> None:
    run_contact(Scene.from_toml("mtm_zddp", QUICK), tmp_path)
    other = Scene.from_toml("azam_case_a", QUICK)
    with pytest.raises(ContactError, match="is the result of 'mtm_zddp'"):
        run_contact(other, tmp_path)
    assert run_contact(other, tmp_path, force=True).dataset.attrs["scene"] == "azam_case_a"


def test_a_machine_runs_in_one_call_with_its_checks(tmp_path: Path) -> None:
    coarse = {f"contact.surface_{body}.correlation_length": "32 um" for body in (1, 2)} | {"contact.film.points": "17"}
    changes = coarse | {"simulate.stop_time": "2 s", "simulate.step_size": "0.5 s"}
    done = run_machine("mtm_rig", tmp_path, changes)
    assert set(done.checks) == {"resolved", "corrected"}
    assert all((tmp_path / f"{name}.nc").exists() for name in ("result", *done.checks))
    assert done.dataset.attrs["exit_code"] == done.exit_code
    with pytest.raises(ContactError, match="changes are those of a machine that is given by its name"):
        run_machine(None, tmp_path, changes)  # type: ignore[arg-type]
