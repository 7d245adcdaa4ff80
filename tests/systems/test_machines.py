"""`tribofmu run` of machines: what it writes, that it goes on after a kill, what it refuses, and its SSP."""

import io
import signal
import subprocess
import sys
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import xarray as xr
from comparison import approx
from fmpy.ssp.ssd import get_connections, read_ssd
from test_cosim_command import result
from test_resume import KILLED, bits
from test_ssp import SPACES, imported, structure

from fmu_src.flavours import WITH_PYTHON
from system_models.cli.main import main
from system_models.cli.scenes import tell_unreached
from system_models.machines import reading, resolve
from system_models.machines.assembly import Assembly
from system_models.machines.export import with_timetable
from system_models.machines.files import shipped
from system_models.master import System, export_ssp, simulate
from system_models.parts.load_arm import LoadArm
from system_models.runs import Finished
from system_models.store import results
from system_models.store.checkpoint import Checkpoint

SHORT = """time [s],entrainment_speed [m/s],slide_roll_ratio [1]
0,1,0.5
1,0.3,0.5
2,0.1,0.5
3,0.03,0.5
4,0.1,0.05
9,0.1,0.05
"""
LOADS = "time [s],load [N],entrainment_speed [m/s],slide_roll_ratio [1]\n0,20,1,0\n60,30,1,0\n"
SMALL = {
    "contact.film.points": "17",
    "contact.surface_1.correlation_length": "32 um",
    "contact.surface_2.correlation_length": "32 um",
}
COARSE = ["--set", *(f"{key}={value}" for key, value in SMALL.items())]
FEW = {  # contacts
    "bearing_209": {"bearing.levels": "1"},
    "gear_fzg_c": {"mesh.stations": "4"},
    "cam_follower": {"cam.stations": "3"},
    "mtm_rig": {},
}
SHIPPED = [*FEW, *(pytest.param(name, marks=pytest.mark.long) for name in shipped() if name not in FEW)]


DONE = Finished(xr.Dataset(), Path(), reliable=True)  # of a run in which nothing is simulated


@pytest.fixture
def rig(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The command that runs the MTM rig through a short duty, from a working folder of its own."""
    monkeypatch.chdir(tmp_path)
    Path("short.csv").write_text(SHORT)
    return ["run", "mtm_rig", "--duty", "short.csv", *COARSE]


def test_a_table_of_the_command_line_leaves_what_is_set_beside_it(tmp_path: Path) -> None:
    table = tmp_path / "short.csv"
    table.write_text(LOADS)
    repeated = reading.duty_of(reading.read("mtm_rig", {"duty.repeat": "3"}, table))
    assert (repeated.end, repeated.course("load")) == (180.0, [(0.0, 20.0)])
    longer = reading.duty_of(reading.read("mtm_rig", {"duty.duration": "2 min"}, table))
    assert (longer.end, longer.course("load")) == (120.0, [(0.0, 20.0), (60.0, 30.0)])
    cut = reading.duty_of(reading.read("mtm_rig", {"simulate.stop_time": "90 s"}, table))
    assert (cut.end, cut.course("load")) == (60.0, [(0.0, 20.0), (60.0, 30.0)])
    assert reading.duty_of(reading.read("mtm_rig", {"duty.ambient": "20 degC"}, table)).rows[0][1]["ambient"] == 293.15


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["mtm_rig", "--duty", "short.csv", "--set", "duty.load=9 N"], "duty.load is set, but has no effect: the duty"),
        (["mtm_rig", "--duty", "short.csv", "--set", "duty.steps=[]"], "[duty] has steps and file. Keep one"),
        (["mtm_zddp", "--duty", "short.csv", "--set", "operation.load=9 N"], "operation.load is set, but has no"),
    ],
)
def test_what_is_given_twice_is_refused_and_not_dropped(
    given: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("short.csv").write_text("time [s],load [N]\n0,20\n60,30\n")
    assert main(["run", *given]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(
    ("option", "key", "value"),
    [
        ("hours", "simulate.stop_time", "9"),
        ("grid", "contact.film.points", "17"),
        ("duty", "duty.file", "a.csv"),
        ("hours", "operation.duration", "9 s"),
        ("accuracy", "control.accuracy", "0.1"),
        ("grid", "film.points", "17"),
        ("duty", "operation.file", "a.csv"),
    ],
)
def test_what_an_option_replaces_is_told(
    option: str, key: str, value: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("system_models.runs.run_machine", lambda *_, **__: DONE)
    monkeypatch.setattr("system_models.runs.run_contact", lambda *_, **__: DONE)
    name = "mtm_rig" if key.startswith(("simulate", "duty", "contact")) else "mtm_zddp"
    Path("short.csv").write_text(LOADS if name == "mtm_rig" else "time [s],load [N]\n0,20\n60,30\n")
    given = {"hours": "1", "grid": "128", "accuracy": "5 %", "duty": "short.csv"}[option]
    assert main(["run", name, "--force", f"--{option}", given, "--set", f"{key}={value}"]) == 0
    assert f"--{option} stands for {key}: '{value}', which --set gives, is not used" in capsys.readouterr().err


@pytest.mark.parametrize(("strict", "code"), [([], 0), (["--strict"], 1)])
def test_errors_that_fall_short_end_a_finished_run_with_0_or_when_strict_with_1(
    strict: list[str], code: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    short = replace(DONE, shortfalls=("h_c of contact at 1 s deviates",))
    monkeypatch.setattr("system_models.runs.run_machine", lambda *_, **__: short)
    monkeypatch.chdir(tmp_path)
    assert main(["run", "mtm_rig", *strict]) == code


def test_rows_after_the_end_of_a_run_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    tell_unreached([0.0, 60.0, 3600.0], 3600.0)  # the row at the end is its mark
    assert not capsys.readouterr().err
    tell_unreached([0.0, 60.0, 3600.0], 30.0)
    assert "The run ends at 30 s, the duty's last change is at 3600 s: 2 of its 3 rows" in capsys.readouterr().err
    monkeypatch.setattr("system_models.runs.run_machine", lambda *_, **__: DONE)
    monkeypatch.chdir(tmp_path)
    Path("short.csv").write_text(SHORT)
    assert main(["run", "mtm_rig", "--duty", "short.csv", "--hours", "0.001"]) == 0
    assert "The run ends at 3.6 s, the duty's last change is at 4 s: 1 of its 5 rows" in capsys.readouterr().err
    monkeypatch.setattr("system_models.runs.run_contact", lambda *_, **__: DONE)
    Path("long.csv").write_text("time [h],load [N]\n0,20\n60,30\n70,20")
    assert main(["run", "mtm_zddp", "--duty", "long.csv"]) == 0
    assert "2 of its 3 rows are not reached" in capsys.readouterr().err


def test_a_machine_runs_from_one_command(rig: list[str], capsys: pytest.CaptureFixture[str], drawn: bool) -> None:
    code = main(rig)
    out, err = capsys.readouterr()
    folder = Path("results/mtm_rig")
    for name in ("result.nc", "result.csv", "resolved.nc", "corrected.nc", "overview.png"):
        assert str(folder / name) in out
        assert (folder / name).stat().st_size > (0 if name == "overview.png" and not drawn else 1000)
    assert not list(folder.glob("checkpoint*"))
    dataset = result(str(folder))
    assert dataset["time"].values[-1] == 9.0
    resolved = results.read(folder / "resolved.nc")
    judged, covered = (resolved[f"resolved.{name}"].values.astype(bool) for name in ("solved", "valid"))
    assert (~dataset["contact.valid"].values.astype(bool)).sum() == (~covered).sum()  # false there, and only there
    short = dataset.attrs["shortfalls"].splitlines()
    assert code == 0
    assert (judged & ~covered).sum() <= len(short) <= 2 * (judged & ~covered).sum()
    assert all(f"warning: {text}" in err for text in short)
    again = reading.assemble(reading.from_attribute(dataset.attrs[reading.ATTRIBUTE]))
    assert list(again.contacts) == ["contact"]
    assert again.settings["stop_time"] == 9.0
    assert 0.0 < dataset["contact.friction_force"].attrs["error_coupling"] < 0.1
    assert "Error of the coupling, from steps of double size" in out
    assert dataset["ball.surface_speed"].values[-1] == approx(0.1025, rel=1e-3)
    assert dataset["contact.tribofilm_1"].values[-1] > 0.0
    assert "Friction in the sweeps" in out
    assert "0.03 m/s" in out
    assert "Each state corrected by the others:" in out
    assert "Contact solutions, with those of steps tried or repeated" in out


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_a_killed_run_goes_on_to_the_same_rows(rig: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    rig = [*rig, "--unchecked"]
    assert main([*rig, "--resume", "--out", "whole"]) == 0
    child = subprocess.run(
        [sys.executable, "-c", KILLED, "between two steps", "20", *rig, "--resume", "--out", "killed"],
        capture_output=True,
        text=True,
    )
    assert child.returncode == -signal.SIGKILL, child.stderr
    assert Path("killed/checkpoint.tribofmu").exists()
    capsys.readouterr()
    assert main([*rig, "--resume", "--out", "killed"]) == 0
    assert "Continuing from 'killed/checkpoint.tribofmu'" in capsys.readouterr().err
    whole = result("whole")
    assert whole.sizes["time"] > 25
    assert bits(result("killed")) == bits(whole)
    assert Path("killed/result.csv").read_bytes() == Path("whole/result.csv").read_bytes()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows knows no signals of this kind")
@pytest.mark.long
def test_an_interrupt_within_a_component_ends_the_run_after_the_step_and_it_goes_on(
    rig: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, calls = LoadArm.advance, []

    def pressed(self: LoadArm, *arguments: Any) -> Any:
        calls.append(arguments)
        if len(calls) == 40:
            signal.raise_signal(signal.SIGINT)
        return whole(self, *arguments)

    monkeypatch.setattr(LoadArm, "advance", pressed)
    assert main([*rig, "--unchecked", "--resume"]) == 130
    assert "Interrupted. What was computed is kept in" in capsys.readouterr().err
    assert 0 < len(calls) - 40 < 10
    assert main([*rig, "--unchecked", "--resume"]) == 0
    assert result("results/mtm_rig")["time"].values[-1] == 9.0
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    capsys.readouterr()
    steps = len(calls)
    assert main([*rig, "--unchecked", "--resume"]) == 0
    assert "This simulation is finished" in capsys.readouterr().err
    assert len(calls) == steps


def test_checks_go_on_from_where_they_were_interrupted(
    rig: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """First within the double steps, then within the states that are solved again; nothing is computed twice."""
    rig = [*rig, "simulate.stop_time=0.1 s", "--resume", "--out"]
    calls: list[str] = []
    stops: dict[str, int] = {}

    def counted(name: str, whole: Any) -> Any:
        def call(*given: Any) -> Any:
            calls.append(name)
            if calls.count(name) == stops.get(name):
                signal.raise_signal(signal.SIGINT)
            return whole(*given)

        return call

    monkeypatch.setattr(Checkpoint, "due", lambda self: True)
    monkeypatch.setattr(LoadArm, "advance", counted("step", LoadArm.advance))
    monkeypatch.setattr(resolve, "solved_again", counted("state", resolve.solved_again))
    code = main([*rig, "whole"])
    steps, states = calls.count("step"), calls.count("state")
    spent: list[list[str]] = []
    for stop in ({"step": steps - 2}, {"state": 3}, {}):
        stops = stop
        calls.clear()
        capsys.readouterr()
        assert main([*rig, "stopped"]) == (130 if stop else code)
        assert ("the same command with --resume continues from there" in capsys.readouterr().err) == bool(stop)
        spent.append([*calls])
    assert [each.count("state") for each in spent] == [0, 3, states - 2]
    assert sum(each.count("step") for each in spent) == steps
    whole, found = result("whole"), result("stopped")
    assert bits(found) == bits(whole)
    assert {name: found[name].attrs for name in found} == {name: whole[name].attrs for name in whole}
    assert found.attrs["checks"] == whole.attrs["checks"]
    for name in ("resolved.nc", "corrected.nc"):
        assert Path("stopped", name).read_bytes() == Path("whole", name).read_bytes()
    assert not [path for path in Path("stopped").iterdir() if path.is_dir()]


def test_any_contact_can_be_deterministic(rig: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*rig, 'deterministic=["contact"]', "simulate.stop_time=0.5 s", "--unchecked"]) == 0
    assert " deterministic." in capsys.readouterr().out
    dataset = result("results/mtm_rig")
    assert set(dataset["contact.fidelity_used"].values.tolist()) == {2}
    assert dataset["contact.wear_volume_1"].values[-1] > 0.0


@pytest.mark.parametrize(
    ("machine", "changes", "says"),
    [
        ("mtm_rig", ["motor.power=3"], "A ball_on_disc has no 'motor'. Known are"),
        ("mtm_rig", ["ball.mass=3"], "mass"),
        ("mtm_rig", ["contact=3"], "contact = 3 must be a table"),
        ("mtm_rig", ["deterministic=contact"], "deterministic = 'contact' must be a list of contacts"),
        ("mtm_rig", ["simulate={}"], "simulate.step_size is missing"),
        ("mtm_rig", ["duty.speed=3 m/s"], "[duty] has no 'speed'."),
        (
            "mtm_rig",
            ['deterministic=["contacts"]'],
            "deterministic names no contact: 'contacts'. Did you mean 'contact'?",
        ),
        ("mtm_rig", ["simulate.tolerance=-1"], "tolerance"),
        ("mtm_rig", ["ball.radius=-1 mm"], "radius"),
        ("mtm_rig", ["kind=rig"], "is not one of ball_on_disc, ball_bearing, gear_pair"),
        ("gear_fzg_c", ["mesh.pair=fzg_b"], "mesh.pair = 'fzg_b' is not known. Did you mean"),
        ("gear_fzg_c", ["rating.micropitting_stage=12"], "must be at least 5 and at most 11"),
        ("gear_fzg_c", ["rating.scuffing_stage=9.5"], "rating.scuffing_stage = 9.5 must be a whole number"),
        ("gear_fzg_c", ["rating.pitting_stage=9"], "[rating] has no key 'pitting_stage'. Did you mean"),
        ("gear_fzg_c", ["rating=high"], "rating = 'high' must be a table"),
        ("mtm_rig", ["rating={}"], "has no 'rating'"),
        ("bearing_209", ["duty.torque=3 N m"], "[duty] has no 'torque'."),
    ],
)
def test_what_makes_no_sense_is_refused_with_a_sentence(
    machine: str, changes: list[str], says: str, capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["run", machine, "--set", *changes]) == 2
    last = capsys.readouterr().err.splitlines()[-1]
    assert last.startswith("tribofmu: ")
    assert says in last
    assert not list(Path().rglob("result.nc"))


@pytest.mark.long
def test_isolated_fmus_run_the_rig_to_the_same_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TRIBOFMU_PYTHON", sys.executable)
    assembly = reading.assemble(reading.read("mtm_rig"))
    settings = {**assembly.settings, "stop_time": 5.0, "outputs": assembly.outputs()}
    runs = [simulate(assembly.system(tmp_path / flavour, flavour), **settings) for flavour in WITH_PYTHON]
    first, second = (bits(run[assembly.outputs()]) for run in runs)
    assert first == second
    assert runs[0].sizes["time"] > 5


class Compared(NamedTuple):
    """A machine's file and its end values by our master."""

    file: Path
    values: dict[str, float]


def exported(machine: str, changes: dict[str, str]) -> Assembly:
    return with_timetable(reading.assemble(reading.read(machine, changes)))


def marched(system: System, names: list[str], step: float, count: int) -> xr.Dataset:
    """In fixed steps with inputs held, as importers of SSP do it."""
    return simulate(system, count * step, step, algorithm="jacobi", order=0, outputs=names)


COMPARED = {
    "bearing_209": ["bearing.friction_torque", "bearing.load_max", "housing.temperature_oil", "shaft.speed"],
    "mtm_rig": ["contact.friction_force", "arm.load", "bath.temperature_oil", "disc.torque"],
}


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(("bearing_209", "isolated"), id="bearing_209-isolated", marks=pytest.mark.long),
        pytest.param(("mtm_rig", "isolated"), id="mtm_rig-isolated"),
        pytest.param(("mtm_rig", "native"), id="mtm_rig-native", marks=pytest.mark.long),
    ],
)
def compared(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Compared:
    """A machine's file, and what the master says of it after steps that bring it up to speed."""
    machine, flavour = request.param
    folder, names = tmp_path_factory.mktemp(machine), COMPARED[machine]
    assembly = exported(machine, FEW[machine])
    file = export_ssp(assembly.system(folder / flavour, flavour), folder / "machine.ssp")
    ours = marched(assembly.system(folder / "embedded"), names, 0.125, 64)  # the same bits, in less time
    return Compared(file, {name: float(ours[name].values[-1]) for name in names})


@pytest.mark.importers
@pytest.mark.parametrize("importer", ["libcosimpy", "ecospy", "fmpy"])
def test_importers_say_what_the_master_says(importer: str, compared: Compared, monkeypatch: pytest.MonkeyPatch) -> None:
    """They may differ by what inputs change in a step, as some reach them a step later, and in fmpy start at zero."""
    monkeypatch.setenv("TRIBOFMU_PYTHON", sys.executable)
    rows = imported(importer, compared.file, [*compared.values], 0.125, 64)
    theirs = dict(zip(compared.values, rows[-1].tolist(), strict=True))
    assert theirs == approx(compared.values, rel=0.01)


@pytest.mark.parametrize(
    ("machine", "changes"),
    [
        ("bearing_209", FEW["bearing_209"]),
        pytest.param("mtm_rig", {"deterministic": '["contact"]', **SMALL}, marks=pytest.mark.long),
    ],
)
def test_exported_fmus_start_with_the_parameters_of_the_machine(
    machine: str, changes: dict[str, str], tmp_path: Path
) -> None:
    """Not every importer tells them."""
    assembly = exported(machine, changes)
    assert any(contact.parameters for contact in assembly.contacts.values())
    untold = replace(
        assembly,
        parameters={},
        contacts={name: replace(contact, parameters={}) for name, contact in assembly.contacts.items()},
    )
    names = assembly.outputs()
    first, second = (
        marched(each.system(tmp_path / str(i)), names, 0.25, 6) for i, each in enumerate((assembly, untold))
    )
    assert bits(first) == bits(second)


@pytest.mark.parametrize("machine", SHIPPED)
def test_each_machine_exports_as_ssp_that_others_read(machine: str, tmp_path: Path) -> None:
    file, changes = tmp_path / f"{machine}.ssp", FEW.get(machine, {})
    settings = [part for key, value in changes.items() for part in ("--set", f"{key}={value}")]
    assert main(["run", machine, *settings, "--ssp", str(file)]) == 0
    assembly = exported(machine, changes)
    ssd = read_ssd(str(file))  # validates it
    found = {(f"{a.parent.name}.{a.name}", f"{b.parent.name}.{b.name}") for a, b in get_connections(ssd.system)}
    assert found == {tuple(connection[:2]) for connection in assembly.connections}
    root = structure(file)
    components = root.findall(".//ssd:Component", SPACES)
    assert {c.get("name") for c in components} == {*assembly.parts, *assembly.contacts}
    values = {
        (component.get("name"), parameter.get("name")): parameter[0].get("value")
        for component in components
        for parameter in component.findall(".//ssv:Parameter", SPACES)
    }
    with zipfile.ZipFile(file) as archive:
        fmus = [zipfile.ZipFile(io.BytesIO(archive.read(n))) for n in archive.namelist() if n.endswith(".fmu")]
    assert len(fmus) > len(assembly.parts)
    assert all("resources/start.py" in fmu.namelist() for fmu in fmus)  # isolated: for any host
    assert not root.findall(".//ssd:Connection[ssc:LinearTransformation]", SPACES)  # which not every importer applies
    assert not [key for name, key in values if key.startswith(f"{name}.")]  # from which OMSimulator takes the name away
    assert root.find(".//oms:FixedStepMaster", SPACES) is not None
    (angular,) = root.findall("ssd:Units/ssc:Unit[@name='rad/s']/ssc:BaseUnit", SPACES) or [None]
    assert angular is None or angular.attrib == {"s": "-1", "rad": "1"}
    for name, contact in assembly.contacts.items():
        for key, value in contact.parameters.items():
            assert float(values[name, key]) == value
    for target, value in assembly.parameters.items():
        assert float(values[tuple(target.split(".", 1))]) == value


def test_a_flavour_is_for_a_machine(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "mtm_zddp", "--flavour", "native"]) == 2
    assert "of the FMUs of a machine" in capsys.readouterr().err
