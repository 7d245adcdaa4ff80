"""`tribofmu cosim` simulates the system of a TOML file, and goes on after a kill to the same result, bit for bit."""

import json
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from comparison import approx
from test_resume import KILLED, bits

from benchmarks.models import build
from contact_core import StateError
from system_models.charts import files
from system_models.cli.main import main
from system_models.master import CouplingError, System, saving, simulate
from system_models.master.settings import Settings
from system_models.master.stepping import Stepper
from system_models.run import cosim_report
from system_models.store import results
from system_models.store.checkpoint import Checkpoint

CAR = """
[fmus]
wheel = "{wheel}"
chassis = "{chassis}"

[coupling]
connections = [
    ["wheel.x", "chassis.x_wheel"],
    ["wheel.v", "chassis.v_wheel"],
    ["chassis.F", "wheel.F"],
]
bonds = [["chassis.F", "wheel.v"]]

[parameters]
chassis.kc = 14e3

[schedule]
wheel.road = [[0, 0.1], ["55 ms", 0.0]]

[simulate]
stop_time = "100 ms"
step_size = "2 ms"
"""
FMUS = {"wheel": "wheel_force", "chassis": "chassis_spring"}


@pytest.fixture(scope="module")
def fmus(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("fmus")
    return {name: build(model, folder) for name, model in FMUS.items()}


@pytest.fixture
def car(fmus: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """The file of a quarter car in the working folder."""
    monkeypatch.chdir(tmp_path)
    for name, path in fmus.items():
        shutil.copy(path, tmp_path / f"{name}.fmu")
    Path("car.toml").write_text(CAR.format(wheel="wheel.fmu", chassis="chassis.fmu"))
    return "car.toml"


@pytest.fixture
def no_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    """Spare the time of drawing."""
    monkeypatch.setattr(files, "save", lambda sheet, path, dpi=150: path)


def result(folder: str) -> xr.Dataset:
    return results.read(Path(folder) / "result.nc")


@pytest.mark.usefixtures("rendered")
def test_a_simulation_prints_tables_and_writes_three_files(car: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cosim", car]) == 0
    out, err = capsys.readouterr()
    assert "0.1/0.1 s" in err
    lines = [line.split() for line in out.splitlines()]
    assert lines[0] == ["output", "unit", "start", "smallest", "largest", "end"]
    assert [line[0] for line in lines[1:7]] == [
        "chassis.F",
        "chassis.x",
        "chassis.v",
        "wheel.x",
        "wheel.v",
        "bond.chassis.F*wheel.v",
    ]
    assert ["chassis", "51"] in [line[:2] for line in lines]
    assert "Steps: 51 to 0.1 s, of 0.001 s to 0.002 s; 0 rejected, 0 stopped early by an FMU." in out
    folder = Path("results/car")
    assert {path.name for path in folder.iterdir()} == {"result.nc", "result.csv", "overview.png"}
    assert all(str(path) in out for path in folder.iterdir())
    assert (folder / "overview.png").stat().st_size > 10_000
    assert (folder / "result.csv").read_text().startswith("time [s],chassis.F [N],chassis.x [m],")


def test_the_file_says_what_python_says(car: str, fmus: dict[str, Path], no_picture: None) -> None:
    assert main(["cosim", car, "--set", "simulate.order=1", "parameters.wheel.m=42", "--out", "out"]) == 0
    system = System(
        fmus,
        [("wheel.x", "chassis.x_wheel"), ("wheel.v", "chassis.v_wheel"), ("chassis.F", "wheel.F")],
        {"chassis.kc": 14e3, "wheel.m": 42.0},
        {"wheel.road": [(0.0, 0.1), (0.055, 0.0)]},
        bonds=[("chassis.F", "wheel.v")],
    )
    dataset = result("out")
    assert bits(dataset) == bits(simulate(system, 0.1, 0.002, order=1))
    assert dataset["wheel.x"].attrs["units"] == "m"
    run = json.loads(dataset.attrs["simulation_json"])
    assert run["parameters"] == {"chassis.kc": 14e3, "wheel.m": 42.0}
    assert run["settings"] == {"stop_time": 0.1, "step_size": 0.002, "order": 1}


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["none.toml"], "In 'none.toml': The file cannot be read"),
        (["car.toml", "--set", "simulate.order=3"], "simulate.order = 3 must be one of 0, 1, 2"),
        (["car.toml", "--set", "simulate.algorithm=seidel"], "must be one of 'jacobi', 'gauss_seidel'"),
        (["car.toml", "--set", "parameters.wheel.mass=3"], "In 'car.toml': The FMU 'wheel' has no variable 'mass'"),
        (["car.toml", "--set", "simulate.stop_time=none"], "'car.toml' does not say simulate.stop_time. Add it"),
        (["car.toml", "--out", "car.toml/x"], "The folder 'car.toml/x' cannot be made"),
    ],
)
def test_what_cannot_be_done_is_refused(
    car: str, arguments: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["cosim", *arguments]) == 2
    err = capsys.readouterr().err
    assert err.splitlines()[-1].startswith("tribofmu: ")
    assert says in err


NO_END = [
    (["stop_time=nan"], "stop_time = nan is not a finite number above 0, in s."),
    (
        ["stop_time=1e300"],
        "step_size = 0.002 s needs more than 1e+09 steps to stop_time = 1e+300 s. Give at least 1.01e",
    ),
    (["step_size=1e-320"], "needs more than 1e+09 steps to stop_time = 0.1 s. Give at least 1.01e-10 s, or an earlier"),
    (["step_size=1e-18", "tolerance=1e-3"], "is lost by rounding beside stop_time = 0.1 s. Give at least 5.61e-17 s"),
    (["min_step=1e-18"], "min_step = 1e-18 s is lost by rounding beside stop_time = 0.1 s. Give at least 5.61e-17 s"),
    (
        ["stop_time=1e300", "tolerance=1e-3", "max_step=0.1"],
        "max_step = 0.1 s needs more than 1e+09 steps to stop_time",
    ),
]


@pytest.mark.parametrize(("changes", "says"), NO_END)
def test_an_end_that_no_number_of_steps_reaches_is_refused_with_one_sentence(
    car: str, changes: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["cosim", car, "--set", *(f"simulate.{change}" for change in changes)]) == 2
    (sentence,) = capsys.readouterr().err.splitlines()
    assert says in sentence


def test_steps_and_events_are_not_sought_within_the_rounding_of_times() -> None:
    assert 1.0 + Settings(1.0, 1e-15, tolerance=1e-3).smallest_step > 1.0


def test_a_missed_tolerance_ends_with_1(car: str, capsys: pytest.CaptureFixture[str], no_picture: None) -> None:
    assert main(["cosim", car, "--set", "simulate.tolerance=1e-9", "simulate.min_step=1e-3"]) == 1
    out = capsys.readouterr().out
    assert "steps of min_step have a LARGER ERROR than the tolerance allows, the first to 0.00" in out
    assert main(["cosim", car, "--set", "simulate.tolerance=1e-2"]) == 0
    assert "WARNING" not in capsys.readouterr().out


def test_an_iteration_that_diverges_ends_with_1(car: str, capsys: pytest.CaptureFixture[str], no_picture: None) -> None:
    stiff = ["parameters.chassis.kc=1e9", "simulate.iterate=fixed_point", "simulate.stop_time=2 ms"]
    assert main(["cosim", car, "--set", *stiff]) == 1
    out = capsys.readouterr().out
    assert "Iterations: 50.0 in a step on average, 50 at most." in out
    assert "WARNING: in 1 steps the iteration did NOT CONVERGE, the first to 0.002 s." in out


def test_events_and_the_end_by_an_fmu_are_told(
    tmp_path: Path, fmus: dict[str, Path], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    tooth, terminator = build("tooth", tmp_path), build("terminator", tmp_path)
    Path("gear.toml").write_text(
        f'[fmus]\ntooth = "{tooth.name}"\nend = "{terminator.name}"\n[coupling]\nevents = ["tooth.tooth"]\n'
        "[simulate]\nstop_time = 1.0\nstep_size = 0.03\n"
    )
    assert main(["cosim", "gear.toml"]) == 0
    out = capsys.readouterr().out
    assert "Events: " in out
    assert "The FMU 'end' ended the simulation." in out
    assert result("results/gear")["time"].values[-1] == approx(0.5, abs=0.03)


def test_the_picture_has_a_panel_for_each_output_and_for_a_changing_step(fmus: dict[str, Path]) -> None:
    time = np.linspace(0.0, 1.0, 5)
    columns = {f"a.x{n}": ("time", time + n, {"units": "1"}) for n in range(18)}
    columns["a.on"] = ("time", time > 0.5, {"units": "1"})
    columns["a.text"] = ("time", np.array(list("abcde")), {"units": "1"})
    columns["master.step_size"] = ("time", np.array([0.0, 0.1, 0.2, 0.3, 0.4]), {"units": "s"})
    columns["master.error"] = ("time", time, {"units": "1"})
    dataset = xr.Dataset(columns, {"time": time}, {"title": "many"})
    titles = [chart.title for chart in cosim_report.overview(dataset).charts]
    assert titles == [*(f"a.x{n}" for n in range(18)), "a.on", "step_size [s]"]
    more = dataset.assign({f"b.y{n}": ("time", time, {"units": "m"}) for n in range(5)})
    sheet = cosim_report.overview(more)
    assert len(files.figure(sheet).axes) == 21
    assert sheet.title == "many, 4 more in the files"


SCHEMES: list[dict[str, Any]] = [
    {"order": 2},
    {"algorithm": "gauss_seidel", "order": 1, "iterate": "aitken"},
    {"order": 1, "iterate": "quasi_newton", "tolerance": 1e-3},
]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_simulation_goes_on_from_every_point_bit_for_bit(
    scheme: dict[str, Any], fmus: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    system = System(
        fmus | {"count": build("early", fmus["wheel"].parent)},
        [
            ("wheel.x", "chassis.x_wheel"),
            ("wheel.v", "chassis.v_wheel"),
            ("chassis.F", "wheel.F"),
            ("wheel.v", "count.u"),
        ],
        schedule={"wheel.road": [(0.0, 0.1), (0.011, 0.2)]},
    )
    folder, saved = tmp_path / "run", []
    save = Checkpoint.save

    def save_and_copy(self: Checkpoint, *arguments: Any) -> None:
        save(self, *arguments)
        saved.append(Path(shutil.copytree(folder, tmp_path / f"killed at {len(saved)}")))

    whole = simulate(system, 0.02, 0.002, **scheme)
    with monkeypatch.context() as patch:
        patch.setattr(Checkpoint, "save", save_and_copy)
        patch.setattr(Checkpoint, "due", lambda self: True)
        assert bits(simulate(system, 0.02, 0.002, **scheme, checkpoint=folder)) == bits(whole)
    assert len(saved) >= 5
    assert np.ptp(whole["wheel.x"].values) > 0.01
    statistics = {name: value for name, value in whole.attrs.items() if name != "cost"}
    for left in saved:
        told: list[float] = []
        again = simulate(system, 0.02, 0.002, **scheme, checkpoint=left, resume=True, progress=told.append)
        assert bits(again) == bits(whole)
        assert {name: value for name, value in again.attrs.items() if name != "cost"} == statistics
    assert told == [], "of a finished simulation nothing is computed again"


def test_any_other_system_is_another_simulation_to_a_checkpoint(fmus: dict[str, Path]) -> None:
    wires: list[tuple[Any, ...]] = [
        ("wheel.x", "chassis.x_wheel"),
        ("wheel.v", "chassis.v_wheel"),
        ("chassis.F", "wheel.F"),
    ]
    whole: dict[str, Any] = {
        "connections": wires,
        "parameters": {"wheel.m": 40.0},
        "schedule": {"wheel.road": [(0.0, 0.1), (1.0, 0.2)]},
    }
    others = [
        {"connections": wires[:2]},
        {"connections": [*wires[:2], ("chassis.F", "wheel.F", -1.0)]},
        {"parameters": {"wheel.m": 41.0}},
        {"schedule": {"wheel.road": [(0.0, 0.1), (1.0, 0.3)]}},
        {"schedule": {"wheel.road": [(0.0, 0.1), (1.1, 0.2)]}},
        {"events": ["wheel.x"]},
        {"bonds": [("chassis.F", "wheel.v")]},
    ]
    same, *found = (saving.identity(System(fmus, **(whole | other)), {"step_size": 0.1}) for other in ({}, *others))
    assert same == saving.identity(System(fmus, **whole), {"step_size": 0.1})
    assert all(other != same for other in found)
    assert saving.identity(System(fmus, **whole), {"step_size": 0.2}) != same


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_a_simulation_that_is_killed_again_and_again_gives_the_same_rows(
    car: str, capsys: pytest.CaptureFixture[str], no_picture: None
) -> None:
    command = ["cosim", car, "--resume", "--out"]
    assert main([*command, "whole"]) == 0
    assert "There is no checkpoint in 'whole'" in capsys.readouterr().err
    for where, last in (("before the checkpoint is replaced", 20), ("between two steps", 20)):
        child = subprocess.run(
            [sys.executable, "-c", KILLED, where, str(last), *command, "killed"], capture_output=True, text=True
        )
        assert child.returncode == -signal.SIGKILL, child.stderr
        assert Path("killed/checkpoint.tribofmu").exists()
    assert main([*command, "killed"]) == 0
    assert "Continuing from 'killed/checkpoint.tribofmu'" in capsys.readouterr().err
    assert bits(result("killed")) == bits(result("whole"))
    assert Path("killed/result.csv").read_bytes() == Path("whole/result.csv").read_bytes()
    assert sorted(path.name for path in Path("killed").iterdir()) == ["result.csv", "result.nc"]
    assert main([*command, "killed"]) == 0
    assert "This simulation is finished" in capsys.readouterr().err


def test_an_interrupted_simulation_says_how_to_go_on(
    car: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, no_picture: None
) -> None:
    step, calls = Stepper.step, []

    def interrupted(self: Stepper, limit: float) -> Any:
        calls.append(limit)
        if len(calls) == 5:
            raise KeyboardInterrupt
        return step(self, limit)

    with monkeypatch.context() as patch:
        patch.setattr(Stepper, "step", interrupted)
        assert main(["cosim", car]) == 130
    file = "results/car/checkpoint.tribofmu"
    assert f"Interrupted. What was computed is kept in '{file}': the same" in capsys.readouterr().err
    assert main(["cosim", car, "--resume", "--set", "parameters.chassis.kc=1"]) == 2
    assert "belongs to another run: parameters.chassis.kc = 14000.0 there, 1.0 here" in capsys.readouterr().err
    assert main(["cosim", car]) == 0
    assert f"'{file}' of an unfinished run will be replaced" in capsys.readouterr().err
    assert not Path(file).exists()


def test_another_fmu_of_the_same_name_is_another_simulation(fmus: dict[str, Path], tmp_path: Path) -> None:
    fmu = tmp_path / "wheel.fmu"
    shutil.copy(fmus["wheel"], fmu)
    simulate(System({"wheel": fmu}), 0.01, 0.005, checkpoint=tmp_path / "run")
    shutil.copy(build("wheel_force", tmp_path, start={"m": 50.0}), fmu)
    with pytest.raises(StateError, match=r"belongs to another run: sha256.wheel ="):
        simulate(System({"wheel": fmu}), 0.01, 0.005, checkpoint=tmp_path / "run", resume=True)


def test_fmus_that_cannot_be_stored_are_simulated_without_a_checkpoint(
    car: str, capsys: pytest.CaptureFixture[str], no_picture: None
) -> None:
    fixed = build("wheel_force", Path(), rollback=False)
    Path("car.toml").write_text(CAR.format(wheel=fixed.name, chassis="chassis.fmu"))
    assert main(["cosim", car]) == 0
    assert "There will be no checkpoint. The FMU 'wheel' cannot give its state as bytes" in capsys.readouterr().err
    assert main(["cosim", car, "--resume"]) == 2
    with pytest.raises(CouplingError, match="canSerializeFMUstate is false"):
        simulate(System({"wheel": fixed}), 0.01, 0.005, checkpoint="run")
    texts = System({"echo": build("echo", Path())})
    with pytest.raises(CouplingError, match=r"'echo.string_out' is text, which the rows of a checkpoint"):
        simulate(texts, 0.01, 0.005, checkpoint="run", outputs=["echo.string_out"])


def test_the_system_is_exported_instead(car: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cosim", car, "--ssp", "car.ssp"]) == 2
    assert "'wheel.road' changes by a schedule" in capsys.readouterr().err
    Path(car).write_text(Path(car).read_text().replace('[[0, 0.1], ["55 ms", 0.0]]', "[[0, 0.1]]"))
    assert main(["cosim", car, "--ssp", "car.ssp"]) == 0
    out, err = capsys.readouterr()
    assert out == "Written: car.ssp\n"
    assert "SSP has no place for bonds" in err
    assert Path("car.ssp").stat().st_size > 1000
    assert not Path("results").exists()
