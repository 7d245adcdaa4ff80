"""What a machine says of its contacts before a run, and of columns, flags and errors after it."""

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from comparison import approx

from contact_core import RangeFlag, Scene
from contact_core.reference import hertz_line
from system_models.cli.main import main
from system_models.html_report.opened import open_run
from system_models.machines import trust
from system_models.machines.assembly import Assembly
from system_models.machines.ball_bearing.report import _HEADS as BEARING
from system_models.machines.ball_on_disc.report import _COLUMNS as RIG
from system_models.machines.cam_follower.report import _HEADS as CAM
from system_models.machines.gear_pair.geometry import FZG_C
from system_models.machines.gear_pair.report import _HEADS as GEAR
from system_models.machines.gear_pair.report import _SAFETY_HEADS as SAFETY
from system_models.machines.reading import assemble, read
from system_models.machines.registry import KINDS

PLAIN = ("stage", "until", "contacts", "lift", "load", "oil", "tribofilm", "wear", "friction")  # say what they are


def told(name: str, **changes: str) -> str:
    """What is told before a run, in one line."""
    machine = read(name, {key.replace("__", "."): value for key, value in changes.items()})
    return " ".join(" ".join(trust.before(machine, assemble(machine))).split())


def number(text: str, pattern: str) -> float:
    """The number that a pattern finds in a text."""
    found = re.search(pattern, text)
    assert found is not None, f"no {pattern} in {text}"
    return float(found[1])


def test_gears_tell_the_flank_that_carries_most_at_the_largest_torque() -> None:
    text = told("gear_fzg_c")
    assert "flank, 21 contacts, most loaded flank_11" in text
    force = 265.0 / FZG_C.base_radius_1  # one pair of teeth carries all about C
    radius = FZG_C.pitch_point * (FZG_C.line_length - FZG_C.pitch_point) / FZG_C.line_length
    pressure = hertz_line(force, radius, FZG_C.face_width, FZG_C.reduced_modulus).pressure_max
    assert number(text, r"with (\d+) N") == approx(force, rel=1e-3)
    assert number(text, r"Hertz pressure ([\d.]+) GPa") == approx(1e-9 * pressure, rel=0.03)
    assert "oil at 90 degC" in text and "boundary lubrication" in text


def test_a_bearing_tells_both_races_by_its_loads() -> None:
    text = told("bearing_209", duty__speed="3000 rpm")
    inner, outer = text.split("outer, 3 contacts")
    assert "inner, 3 contacts, most loaded inner_3" in inner
    assert number(inner, r"with (\d+) N") == approx(5.0 * 2000.0 / 9.0, rel=0.05)  # Stribeck's number
    assert number(outer, r"with (\d+) N") > number(inner, r"with (\d+) N")  # balls are thrown outward
    assert "oil at 20 degC" in text  # as at the start: the duty does not hold it


def test_a_cam_tells_nose_and_base_circle() -> None:
    text = told("cam_follower")
    event, base = text.split("base_circle, at most with ")
    assert "angle, 21 contacts, most loaded angle_11" in event
    assert number(event, r"with (\d+) N") > 1000.0
    assert base.startswith("800 N")  # the preload


def test_a_rig_tells_the_speeds_of_its_duty() -> None:
    text = told("mtm_rig")
    assert "contact, at most with 53.7 N, oil at 80 degC. Contact: Hertz pressure 1.15 GPa" in text
    assert re.search(r"entrainment speed 0\.0\d+ to \d", text)
    assert "lambda of handbooks is 0.0" in text


def test_contacts_without_a_load_say_so() -> None:
    assert told("bearing_209", duty__load="0 N").startswith("inner, 3 contacts: no load.")


@pytest.fixture(scope="module")
def ran(gears: Path) -> tuple[Assembly, xr.Dataset]:
    run = open_run(gears)
    assert run.machine is not None
    return run.machine.assembly, run.dataset


@pytest.mark.parametrize("output", ["load", "speed_1", "speed_2"])
def test_what_is_foreseen_is_what_the_run_settles_to(ran: tuple[Assembly, xr.Dataset], output: str) -> None:
    assembly, dataset = ran
    speed, torque = (float(dataset[f"shafts.{name}"].values[-1]) for name in ("speed_1", "mesh_torque"))
    found = KINDS["gear_pair"].foreseen(assembly.parts, {"speed": speed, "torque": torque})
    for name in assembly.contacts:
        assert found[name][output] == approx(float(dataset[f"{name}.{output}"].values[-1]), rel=5e-4), name


def test_flags_name_contacts_rows_quantity_and_limit(ran: tuple[Assembly, xr.Dataset]) -> None:
    assembly, dataset = ran
    changed = dataset.copy(deep=True)
    for name in assembly.contacts:
        changed[f"{name}.range_flags"].values[:] = 0
    changed["flank_03.range_flags"].values[-2:] = int(RangeFlag.TRIBOFILM_TEMPERATURE)
    changed["flank_03.body_temperature_1"].values[-1] = 273.15 + 130.0
    (line,) = (each for each in trust.told(KINDS["gear_pair"], assembly, changed) if each.startswith("Range"))
    assert line.startswith(f"Range, flank_03, 2 of {changed.sizes['time']} rows: outside the temperatures")
    assert line.endswith("(flank_03: 130 degC: fitted from 60 to 120 degC).")


def test_every_flag_of_a_machine_is_told_whatever_its_numbers(ran: tuple[Assembly, xr.Dataset]) -> None:
    assembly, dataset = ran
    changed = dataset.copy(deep=True)
    for name in assembly.contacts:
        changed[f"{name}.range_flags"].values[:] = int(sum(RangeFlag))
    lines = [each for each in trust.told(KINDS["gear_pair"], assembly, changed) if each.startswith("Range")]
    assert len(lines) == len(RangeFlag)
    assert all(line.startswith("Range, all contacts, all rows: ") for line in lines)


def test_the_verdict_names_the_contact_that_knows_least(ran: tuple[Assembly, xr.Dataset]) -> None:
    assembly, dataset = ran
    changed = dataset.copy(deep=True)
    for name in assembly.contacts:
        values = {"friction_coefficient": (0.05, 0.005), "h_c": (1e-7, 1e-8), "contact_load_ratio": (0.1, 0.6)}
        for output, (value, half) in values.items():
            changed[f"{name}.{output}"].values[:], changed[f"{name}.{output}_error"].values[:] = value, half
    changed["flank_02.h_c_error"].values[:] = 5e-8
    changed["flank_03.contact_load_ratio"].values[:] = 0.5
    changed["flank_03.contact_load_ratio_error"].values[:] = 0.55  # less than elsewhere, and yet from 0 to 1
    verdict = trust.told(KINDS["gear_pair"], assembly, changed)[-1]
    assert "friction to 10 % (flank_01)" in verdict
    assert "film only to 50 % (flank_02)" in verdict
    assert "W_c not at all (1 of 4 contacts)" in verdict
    assert "valid" not in verdict.lower()
    changed["flank_02.valid"].values[3] = False
    assert trust.told(KINDS["gear_pair"], assembly, changed)[-1].startswith("Verdict: contacts have 1 INVALID rows")


@pytest.mark.parametrize(
    ("kind", "headings"),
    [
        ("ball_on_disc", [heading for heading, *_ in RIG]),
        ("ball_bearing", [heading for heading, _ in BEARING]),
        ("gear_pair", [heading for heading, _ in (*GEAR, *SAFETY)]),
        ("cam_follower", [heading for heading, _ in CAM]),
    ],
)
def test_every_column_of_a_machine_is_told_in_words(kind: str, headings: list[str]) -> None:
    legend = [part for key in KINDS[kind].legend for part in key.split(", ")]
    stems = [heading if heading in legend else re.sub(r" [12br]$", "", heading) for heading in headings]
    assert [each for each in stems if each not in legend and each not in PLAIN] == []


def test_classes_of_contacts_are_those_whose_names_differ_by_numbers() -> None:
    names = ["inner_1", "inner_2", "base_circle", "angle_01", "contact"]
    assert list(trust.classes(names)) == ["inner", "base_circle", "angle", "contact"]


def test_the_command_tells_contacts_first_and_the_verdict_after(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    duty = tmp_path / "short.csv"
    duty.write_text("time [s],entrainment_speed [m/s],slide_roll_ratio [1]\n0,0.1,0.05\n2,0.1,0.05\n")
    assert main(["run", "mtm_rig", "--duty", str(duty), "--unchecked", "--out", str(tmp_path / "rig")]) == 0
    out = " ".join(capsys.readouterr().out.split())
    order = ["contact, at most with 53.7 N", "time friction h_c lambda", "Columns: h_c: mean film", "Verdict: known"]
    places = [out.index(each) for each in order]
    assert places == sorted(places)
    assert np.isfinite(number(out, r"friction to ([\d.]+) %"))
    assert "Surer: --set contact.film.correction=blocks." in out


def test_a_scheduled_input_has_the_value_of_the_step_that_ends_at_a_row() -> None:
    """A change at 2 s acts from then on: the row at 2 s is the end of a step before it."""
    scene = Scene.from_toml("mtm_zddp")
    assembly = SimpleNamespace(
        contacts={"contact": SimpleNamespace(own_scene=scene)}, schedule={"contact.load": [(0.0, 10.0), (2.0, 30.0)]}
    )
    dataset = xr.Dataset({"contact.h_c": ("time", np.ones(4))}, {"time": [0.0, 1.0, 2.0, 3.0]})
    found = trust.of_contact(assembly, dataset, "contact")  # type: ignore[arg-type]
    assert found["load"].values.tolist() == [10.0, 10.0, 10.0, 30.0]
