"""Pages of machines, finished and interrupted: tables, errors by cause of contacts, flags in numbers."""

import math
from pathlib import Path
from typing import Any

import pytest
from comparison import approx
from parsed_page import COARSE, GEARS, Parsed, self_contained

from system_models.cli.main import main
from system_models.html_report.opened import open_run
from system_models.html_report.page import page
from system_models.store.checkpoint import Checkpoint


def test_a_machine_is_shown_with_its_report_its_parts_and_its_contact(tmp_path: Path) -> None:
    duty = tmp_path / "short.csv"
    duty.write_text("time [s],entrainment_speed [m/s],slide_roll_ratio [1]\n0,0.1,0.05\n2,0.1,0.05\n")
    settings = ["--set", "contact.film.model=regression"]
    out = tmp_path / "rig"
    assert main(["run", "mtm_rig", "--duty", str(duty), *settings, "--unchecked", "--out", str(out)]) == 0
    run = open_run(out)
    assert run.machine is not None
    assert run.contacts == ("contact",)
    found = Parsed(page(run))
    assert self_contained(found)
    assert all(
        line in found.text for line in run.machine.kind.lines(run.machine.assembly, run.dataset) if len(line) < 80
    )
    assert any(each.startswith("data:image/png") for each in found.loaded)
    friction = found.data["points-contact-0-0"]["lines"][0]
    assert friction["y"][-1] == approx(float(run.dataset["contact.friction_coefficient"].values[-1]), rel=1e-4)


def test_contacts_of_machines_have_errors_by_cause_flags_in_numbers_and_assumed_values(gears: Path) -> None:
    run = open_run(gears)
    assert run.machine is not None
    halves = run.causes["flank_02"]["h_c"]
    assert halves["curves"] == approx(float(run.dataset["flank_02.h_c_error"].values[-1]), rel=1e-9)
    found = Parsed(page(run))
    assert self_contained(found)
    assert "Contact flank_02" in found.text.split("Errors by cause")[1]
    assert found.text.count("Fitted curves: the regression level's distance from the deterministic level.") == 4
    assert "degC: fitted from 60 to 120 degC" in found.text.split("by how much")[1]  # the oil starts at 40 degC
    assert "Nothing: the scene gives every value itself." in found.text
    assert "theta_int" in found.text.split("Columns:")[1]


def test_contacts_of_machines_that_are_solved_have_all_causes(tmp_path: Path) -> None:
    solved = [*COARSE[:1], *COARSE[2:], "film.model=deterministic", "film.domain=0.5 mm"]
    settings = [f"contact.{each}" for each in solved]
    duty = tmp_path / "short.csv"
    duty.write_text("time [s],entrainment_speed [m/s],slide_roll_ratio [1]\n0,0.1,0.05\n2,0.1,0.05\n")
    out = tmp_path / "rig"
    assert main(["run", "mtm_rig", "--unchecked", "--duty", str(duty), "--set", *settings, "--out", str(out)]) == 0
    run = open_run(out)
    film = run.causes["contact"]["h_c"]
    assert film["grid"] > 0.0 and film["curves"] == 0.0
    assert math.hypot(*film.values()) == approx(float(run.dataset["contact.h_c_error"].values[-1]), rel=1e-6)


@pytest.mark.long
def test_an_interrupted_machine_has_its_tables(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    save = Checkpoint.save

    def saved_and_interrupted(self: Checkpoint, time: float, *rest: Any) -> None:
        save(self, time, *rest)
        if time >= 10.0:
            raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(Checkpoint, "save", saved_and_interrupted)
        patch.setattr(Checkpoint, "due", lambda self: True)
        assert main([*GEARS, "--out", str(tmp_path)]) == 130
    run = open_run(tmp_path)
    assert (run.finished, run.planned) == (False, 72.0)
    assert run.machine is not None and run.title.startswith("FZG type C gears")
    assert run.dataset["shafts.speed_1"].attrs["units"] == "rad/s"
    found = Parsed(page(run))
    assert self_contained(found)
    lines = run.machine.kind.lines(run.machine.assembly, run.dataset)
    assert all(line in found.text for line in lines if len(line) < 80)
    assert "UNFINISHED" in found.text and "Columns: n1, T1: speed and torque of the pinion" in found.text
    assert run.causes["flank_02"]["friction_coefficient"]["curves"] > 0.0
    assert any(each.startswith("data:image/png") for each in found.loaded)
