"""The command `tribofmu fit`: data, refusals, the fit of three temperatures at once, and the set that a scene uses."""

import csv
import json
import re
import shlex
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from comparison import approx

from contact_core import Scene, SceneError, advance, initial_state
from contact_core.errors import ContactError
from system_models.cli.main import main
from system_models.run import fit_data, fit_model
from system_models.run.fit import fit
from system_models.run.fit_model import Constant, Model, Points, constants_of

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "fit.md"
CHEAP = {"film.points": "65", "tribofilm.set": "gosvami", "control.change": "20 nm"}
OTHER = {  # constants that made the measured numbers
    "tribofilm.full_thickness": "150 nm",
    "tribofilm.activation_energy": "0.72 eV",
    "tribofilm.prefactor": "800 m/s",
}
VARIED = (
    "tribofilm.full_thickness",
    "tribofilm.activation_energy=0.6 eV:1.0 eV",
    "tribofilm.prefactor=10 m/s:1e5 m/s",
)
MINUTES = (2.0, 5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 90.0)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return Scene.from_toml("mtm_zddp", CHEAP).at_level("regression")


def measured_file(path: Path, seed: int, noise: float = 4.0) -> Path:
    """24 films of the ball, 8 times at 60, 80 and 100 degC, by other constants, with noise [nm]."""
    made, random = Scene.from_toml("mtm_zddp", CHEAP | OTHER).at_level("regression"), np.random.default_rng(seed)
    lines = ["time [min],temperature [degC],tribofilm_1 [nm]"]
    for celsius in (60.0, 80.0, 100.0):
        point, state, now = replace(made.operation.point, temperature=celsius + 273.15), initial_state(made), 0.0
        for minutes in MINUTES:
            state, out = advance(made, point, state, 60.0 * (minutes - now))
            now = minutes
            lines.append(f"{minutes},{celsius},{1e9 * out.tribofilm_1 + noise * random.standard_normal():.3f}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


@pytest.mark.long
def test_three_temperatures_fitted_at_once_predict_the_eight_of_24_held_back(scene: Scene, tmp_path: Path) -> None:
    inside, tenth = [], []
    for seed in (1, 2):
        measured = fit_data.read(measured_file(tmp_path / f"{seed}.csv", seed), scene, "regression")
        held = measured.held_back(1 / 3)
        assert (len(measured), int(held.sum()), len(measured.tests)) == (24, 8, 3)
        found = fit(scene, measured, constants_of(scene, VARIED, measured.quantities), held)
        off = np.abs(measured.value - found.estimate.curve)
        inside.append(int(found.inside[held].sum()))
        tenth.append(int((off <= 0.1 * found.estimate.half)[held].sum()))
        for test in range(3):  # each temperature within the scatter
            assert np.sqrt((off[measured.test == test] ** 2).mean()) < 1.5 * 4e-9
        assert found.estimate.scatter[0] == approx(4e-9, rel=0.5)
        assert found.values["tribofilm.full_thickness"] == approx(150e-9, rel=0.1)
    assert np.mean(inside) >= 7.0, inside
    assert np.mean(tenth) < 3.0, tenth


@pytest.mark.usefixtures("drawn")
@pytest.mark.parametrize("constants", [1, pytest.param(3, marks=pytest.mark.long)])
def test_the_example_of_the_page_runs_and_its_set_is_what_the_next_run_uses(
    constants: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """With all that it varies, or the first of it."""
    monkeypatch.chdir(tmp_path)
    text = PAGE.read_text("utf-8")
    (data,) = re.findall(r"```csv\n(.*?)```", text, re.DOTALL)
    (tmp_path / "films.csv").write_text(data, encoding="utf-8")
    first, second = (shlex.split(line)[1:] for line in re.findall(r"```sh\n(.*?)\n```", text, re.DOTALL))
    vary = first.index("--vary") + 1
    assert main([*first[: vary + constants], *first[first.index("--hold-back") :]]) == 0
    out = capsys.readouterr().out
    assert "Held back: 5 points" in out
    folder = tmp_path / "fitted"
    assert {path.name for path in folder.iterdir()} == {"fit.png", "fit.csv", "fit.json", "films.toml"}
    found = json.loads((folder / "fit.json").read_text("utf-8"))
    values = {row["key"]: row["value"] for row in found["constants"]}
    assert all(row["interval"][0] < row["value"] < row["interval"][1] for row in found["constants"])
    scene = Scene.from_toml("mtm_zddp", {"tribofilm.set": "fitted/films.toml:films"})
    assert len(values) == constants
    assert {key: getattr(scene.tribofilm, key.partition(".")[2]) for key in values} == values
    written = tomllib.loads((folder / "films.toml").read_text("utf-8"))["films"]
    assert (written["fit"]["level"], written["fit"]["points"], written["fit"]["held_back"]) == ("regression", 10, 5)
    assert set(written["fit"]["intervals"]) == set(values)
    assert {key for interval in scene.intervals for key in interval.keys} >= set(values)
    first = found["constants"][0]
    ends = [end[first["key"]] for each in scene.intervals if each.keys[0] == first["key"] for end in each.ends(scene)]
    assert ends == approx(first["interval"], rel=1e-3)
    assert len(written["intervals"]) == constants
    with (folder / "fit.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 15
    assert sum(int(row["held_back"]) for row in rows) == 5
    assert main(second) == 0


def write(path: Path, *lines: str) -> Path:
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_rows_are_put_into_tests_by_their_inputs_and_empty_cells_are_no_measurements(
    scene: Scene, tmp_path: Path
) -> None:
    file = write(
        tmp_path / "d.csv",
        "time [min],temperature [degC],tribofilm_1 [nm],tribofilm_1_sd [nm],friction_coefficient [1]",
        "10,100,50,4,",
        "5,80,20,,0.12",
        "1,100,-0.3,3,0.11",
    )
    found = fit_data.read(file, scene, "regression")
    assert found.quantities == ("tribofilm_1", "friction_coefficient")
    assert found.time == approx([300.0, 60.0, 600.0, 300.0, 60.0])
    assert found.value == approx([20e-9, -0.3e-9, 50e-9, 0.12, 0.11])
    assert found.sd == approx([0.0, 3e-9, 4e-9, 0.0, 0.0])
    assert found.test.tolist() == [0, 1, 1, 0, 1]
    assert [test.temperature for test in found.tests] == approx([353.15, 373.15])
    assert all(test.load == scene.operation.load for test in found.tests)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (("time [min],tribofilm_1 [s]", "1,2"), "wrong unit: it must be convertible to m"),
        (("time [min],tribofilm [nm]", "1,2"), "there is no column 'tribofilm'. Did you mean 'tribofilm_2'?"),
        (("time [min],h_min [nm]", "1,2"), "level 'regression', at which every fit begins, has no 'h_min'"),
        (("time [h],tribofilm_1 [nm]", "3,2"), "time = 10800 s is not between 0 and operation.duration = 7200 s"),
        (("time [min],tribofilm_1 [nm],tribofilm_1_sd [nm]", "1,2,0"), "tribofilm_1_sd = 0 m must be above 0"),
        (("time [min],tribofilm_1 [nm],tribofilm_1_sd [nm]", "1,,2"), "'tribofilm_1' is not. Give both or neither."),
        (("time [min],load [N]", "1,50"), "no row has a measured number"),
        (("time [min],load [N],tribofilm_1 [nm]", "1,,50"), "not a finite number"),
        (("time [min],temperature [degC],tribofilm_1 [nm]", "1,500,50"), "temperature = 773.15 K"),
    ],
)
def test_what_is_wrong_with_data_is_said(scene: Scene, tmp_path: Path, lines: tuple[str, ...], said: str) -> None:
    with pytest.raises(SceneError) as refused:
        fit_data.read(write(tmp_path / "d.csv", *lines), scene, "regression")
    assert said in str(refused.value)


@pytest.mark.parametrize(
    ("vary", "said"),
    [
        ("tribofilm.thickness", "Did you mean 'tribofilm.full_thickness'?"),
        ("tribofilm.full_thickness=10 nm", "has no range. Write tribofilm.full_thickness=low:high"),
        ("tribofilm.full_thickness=1 s:2 s", "has the wrong unit"),
        ("tribofilm.full_thickness=300 nm:20 nm", "must rise"),
        ("tribofilm.full_thickness=10 nm:20 nm", "full_thickness = 2e-07 m of the scene is outside of its range"),
        ("tribofilm.full_thickness=10 nm:20 um", "leaves what is allowed"),
        ("tribofilm.full_thickness=0 nm:300 nm", "leaves what is allowed"),
        ("tribofilm.edge_weight", "tribofilm.edge_weight = 0  gives no range"),
        ("surface_1.seed", "is a whole number"),
    ],
)
def test_what_is_wrong_with_a_constant_is_said(scene: Scene, vary: str, said: str) -> None:
    with pytest.raises(SceneError) as refused:
        constants_of(scene, [vary], ["tribofilm_1"])
    assert said in str(refused.value)


def test_without_names_the_constants_of_what_is_measured_vary(scene: Scene) -> None:
    keys = [constant.key for constant in constants_of(scene, [], ["coverage_1", "wear_depth_1"])]
    assert keys == [
        *(f"tribofilm.{name}" for name in ("full_thickness", "prefactor", "activation_energy", "activation_volume")),
        "tribofilm.removal_coefficient",
        "wear.bare",
        "wear.film",
    ]
    with pytest.raises(SceneError, match="Name some with --vary"):
        constants_of(scene, [], ["h_c"])


def test_ranges_over_decades_are_searched_by_their_logarithm() -> None:
    wide, narrow = Constant("a", 2.0, 1.0, 100.0, ""), Constant("b", 2.0, 1.0, 3.0, "")
    assert (wide.at(0.5), narrow.at(0.5)) == (approx(10.0), approx(2.0))
    assert all(one.share(one.at(0.3)) == approx(0.3) for one in (wide, narrow))
    assert (wide.at(0.0), wide.at(1.0)) == (1.0, 100.0)


def test_too_few_points_and_constants_without_effect_are_refused(scene: Scene, tmp_path: Path) -> None:
    file = write(tmp_path / "d.csv", "time [min],tribofilm_1 [nm]", "0,0", "1,10", "2,15", "3,20")
    measured = fit_data.read(file, scene, "regression")
    nobody = np.zeros(4, bool)
    with pytest.raises(ContactError, match="4 points are too few for 5 constants"):
        fit(scene, measured, constants_of(scene, [], measured.quantities), nobody)
    with pytest.raises(ContactError, match=r"None of lubricant\.conductivity changes tribofilm_1 of this scene"):
        fit(scene, measured, constants_of(scene, ["lubricant.conductivity"], measured.quantities), nobody)
    three = constants_of(scene, VARIED, measured.quantities)
    with pytest.raises(ContactError, match=r"3 points are too few for 3 constants .* such as films at time 0"):
        fit(scene, measured, three, nobody)


def test_a_law_that_refuses_a_temperature_says_so_before_any_search(tmp_path: Path) -> None:
    scene = Scene.from_toml("mtm_zddp", {"film.points": "65"})
    file = write(tmp_path / "d.csv", "time [min],temperature [degC],tribofilm_1 [nm]", "1,60,9", "2,60,15", "3,60,20")
    measured = fit_data.read(file, scene, "regression")
    with pytest.raises(ContactError, match="Use a set fitted at that temperature"):
        fit(scene, measured, constants_of(scene, ["tribofilm.full_thickness"], ["tribofilm_1"]), np.zeros(3, bool))


def test_a_curve_at_time_0_and_repeated_times_are_points_of_one_run(scene: Scene) -> None:
    constants = constants_of(scene, ["tribofilm.full_thickness"], ["tribofilm_1"])
    model = Model(scene, (scene.operation.point,), constants, ("tribofilm_1", "friction_coefficient"))
    names = np.array(["tribofilm_1", "tribofilm_1", "tribofilm_1", "friction_coefficient"])
    points = Points(model, np.zeros(4, int), np.array([60.0, 0.0, 60.0, 0.0]), names)
    now, start, again, friction = points(np.array([0.5]))
    assert model.runs == 1
    assert (start, now) == (0.0, again)
    assert now > 0.0
    assert 0.05 < friction < 0.2


@pytest.mark.long
def test_the_deterministic_level_corrects_the_fit_until_both_agree(
    scene: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from system_models.run import fit as module

    slow_runs: list[object] = []

    class Other(Model):
        """In place of the deterministic level: the regression level with films a third thicker, 2 nm at the start."""

        def curves(self, shares: np.ndarray, times: list[np.ndarray]) -> list[np.ndarray]:
            slow = self.scene.film.name == "deterministic"
            slow_runs.extend(self.tests if slow else ())
            plain = Model(self.scene.at_level("regression"), self.tests, self.constants, self.quantities)
            self.runs += len(self.tests)
            return [1.33 * rows + 2e-9 if slow else rows for rows in plain.curves(shares, times)]

        def stated(self, shares: np.ndarray, times: list[np.ndarray]) -> dict[str, float]:
            return {}

    monkeypatch.setattr(module, "Model", Other)
    measured = fit_data.read(measured_file(tmp_path / "d.csv", 5), scene, "deterministic")
    constants = constants_of(scene, ["tribofilm.full_thickness"], measured.quantities)
    nobody = np.zeros(24, bool)
    found = [fit(scene, measured, constants, nobody, level) for level in ("regression", "deterministic")]
    fast, slow = (one.values["tribofilm.full_thickness"] for one in found)
    assert all(one.agreed for one in found)
    assert slow < 0.9 * fast  # thicker films from the level, thinner ones from the constant
    assert len(slow_runs) <= 12  # at most four of three tests, in place of hundreds
    assert found[1].level == found[1].scene.film.name == "deterministic"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--hold-back", "1"], "--hold-back = 1 must be at least 0 and below 1"),
        (["--hold-back", "a third"], "--hold-back = 'a third' does not start with a number"),
        (["--name", "a b"], "--name = 'a b' must be of letters, digits"),
        (["--set", "operation.file=loads.csv"], "cannot be read"),
    ],
)
def test_options_that_cannot_be_used_are_refused(
    options: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "d.csv", "time [min],tribofilm_1 [nm]", "1,10", "2,15", "3,20")
    assert main(["fit", "d.csv", "mtm_zddp", "--grid", "65", *options]) == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "results").exists()


def test_a_duty_that_changes_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "d.csv", "time [min],tribofilm_1 [nm]", "1,10", "2,15", "3,20")
    write(tmp_path / "loads.csv", "time [min],load [N]", "0,50", "1,30")
    assert main(["fit", "d.csv", "mtm_zddp", "--grid", "65", "--set", "operation.file=loads.csv"]) == 2
    assert "a test of a fit holds its inputs" in capsys.readouterr().err


def test_an_interrupt_ends_a_fit_with_nothing_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "d.csv", "time [min],tribofilm_1 [nm]", "1,10", "2,15", "3,20")
    calls = []

    def interrupted(*arguments: object) -> object:
        calls.append(arguments)
        if len(calls) > 5:
            raise KeyboardInterrupt
        return advance(*arguments)

    monkeypatch.setattr(fit_model, "advance", interrupted)
    options = ["--vary", "tribofilm.full_thickness", "--out", "out"]
    assert main(["fit", "d.csv", "mtm_zddp", "--grid", "65", *options]) == 130
    assert "Nothing was written" in capsys.readouterr().err
    assert list((tmp_path / "out").iterdir()) == []
