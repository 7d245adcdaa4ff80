"""Arrays of FMI 3 are set, connected, recorded and resumed by their elements; what cannot be done is said."""

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from checking import edited, replaced
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.models import build
from system_models.cli.main import main
from system_models.fmu.errors import CouplingError
from system_models.fmu.model import Model
from system_models.master import export_ssp, simulate
from system_models.master.system import System
from system_models.store.checkpoint import Checkpoint
from system_models.store.results import read

GAINS = np.array([[1.0, 2.0], [3.0, 4.0]])
WIRES = [
    ("a.y[2]", "b.u[3]"),
    ("a.z[2,1]", "b.u[1]", -2.0),
    ("a.counted[3]", "b.counts[1]"),
    ("a.flagged[1,2]", "b.flags[2,2]"),
    ("b.y[1]", "g.u"),
]
STARTS = {"a.u[1]": 2.0, "a.u[3]": 2.5, "a.gains[2,1]": 5.0, "a.flags[1,2]": True, "a.counts[3]": -7, "b.u[2]": 7.0}
STEPS = {"a.u[2]": [(0.0, 1.0)], "b.counts[2]": [(0.0, 3), (0.5, 4)], "b.flags[1,1]": [(0.5, False)]}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("arrays")


def coupled(folder: Path, *, events: bool = False) -> System:
    array = build("arrays", folder, 3, events=events)
    return System({"a": array, "b": array, "g": build("gain", folder, 3)}, WIRES, STARTS, STEPS)


def values(result: Any, name: str, *shape: int) -> np.ndarray:
    """An array at all times [*shape, time]."""
    rows = [result[f"{name}[{','.join(str(i + 1) for i in index)}]"].values for index in np.ndindex(*shape)]
    return np.reshape(rows, (*shape, -1))


@pytest.mark.parametrize("events", [False, True])
@pytest.mark.parametrize("options", [{"order": 1}, {"order": 1, "iterate": "aitken"}, {"order": 2, "tolerance": 1e-6}])
def test_elements_are_coupled_as_other_variables_are(folder: Path, events: bool, options: dict[str, Any]) -> None:
    found = simulate(coupled(folder, events=events), 1.0, 0.1, **options)
    t = found["time"].values
    always, late = np.ones(t.size), t > 0.5 + 1e-9  # the row of a change has the values before it
    np.testing.assert_allclose(values(found, "a.y", 3), [2.0 * t, t, 2.5 * t], atol=1e-12)
    np.testing.assert_allclose(values(found, "a.z", 2, 2), np.multiply.outer([[2.0, 2.0], [10.0, 4.0]], always))
    np.testing.assert_allclose(values(found, "b.y", 3), [-20.0 * t, 7.0 * t, 0.5 * t * t], atol=1e-6)
    np.testing.assert_allclose(values(found, "b.z", 2, 2), np.multiply.outer(GAINS * [-20.0, 7.0], always))
    np.testing.assert_allclose(found["g.y"].values, -20.0 * t, atol=1e-6)
    assert (values(found, "a.counted", 3) == np.multiply.outer([11, 21, -6], always)).all()
    assert (values(found, "b.counted", 3) == [-5 * always, 4 + late, 31 * always]).all()
    assert (values(found, "a.flagged", 2, 2) == np.multiply.outer([[0, 0], [1, 0]], always)).all()
    assert (values(found, "b.flagged", 2, 2) == [[late, always], [always, always]]).all()


def test_elements_of_single_precision_are_read_and_set(folder: Path) -> None:
    of_32 = [replaced(f'<Float64 (name="{name}"[^/]*/>\\s*)</Float64>', r"<Float32 \1</Float32>") for name in "uy"]
    path = edited(build("arrays", folder, 3), folder / "single.fmu", lambda text: of_32[0](of_32[1](text)))
    system = System({"a": path, "b": path}, [("a.y[3]", "b.u[2]")], {"a.u[3]": 2.0})
    found = simulate(system, 1.0, 0.1, order=1)
    t = found["time"].values
    np.testing.assert_allclose(values(found, "b.y", 3), [0.5 * t, t * t, 1.5 * t], atol=1e-6)


def test_a_simulation_with_arrays_goes_on_from_every_point(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    system, options, saved = coupled(folder, events=True), {"iterate": "aitken", "order": 1}, list[Path]()
    whole, save = simulate(system, 1.0, 0.2, **options), Checkpoint.save

    def save_and_copy(self: Checkpoint, *arguments: Any) -> None:
        save(self, *arguments)
        saved.append(Path(shutil.copytree(tmp_path / "run", tmp_path / f"killed at {len(saved)}")))

    with monkeypatch.context() as patch:
        patch.setattr(Checkpoint, "save", save_and_copy)
        patch.setattr(Checkpoint, "due", lambda self: True)
        simulate(system, 1.0, 0.2, **options, checkpoint=tmp_path / "run")
    for left in saved:
        assert simulate(system, 1.0, 0.2, **options, checkpoint=left, resume=True).equals(whole)
    assert len(saved) > 5


def test_elements_are_set_on_the_command_line_and_stand_in_the_results(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = f"""fmus.a = '{build("arrays", folder, 3)}'
parameters."a.gains[1,2]" = -1.0
simulate = {{ stop_time = "1 s", step_size = "0.5 s", outputs = ["a.y", "a.z[1,2]"] }}"""
    Path("arrays.toml").write_text(text)
    assert main(["cosim", "arrays.toml", "--set", "parameters.a.u[2]=3", "--out", "out"]) == 0
    found = read(Path("out/result.nc"))
    np.testing.assert_allclose(values(found, "a.y", 3)[:, -1], [0.5, 3.0, 1.5])
    assert found["a.z[1,2]"].values.tolist() == [-3.0] * 3
    assert "a.z[1,1]" not in found
    assert Path("out/result.csv").read_text().startswith('time [s],a.y[1] [1],a.y[2] [1],a.y[3] [1],"a.z[1,2] [1]",')


@given(st.lists(st.integers(0, 4), min_size=1, max_size=3))
def test_the_elements_of_an_array_of_any_shape_have_names(folder: Path, shape: list[int]) -> None:
    found = Model("a", with_array(folder, "".join(f'<Dimension start="{length}"/>' for length in shape)))
    names = [f"y[{','.join(str(i + 1) for i in index)}]" for index in np.ndindex(*shape)]
    assert [name for name in found.variables if name.startswith("y")] == found.arrays["y"] == names
    assert [found.elements[name].place for name in names] == list(range(int(np.prod(shape))))
    assert all(found.dependencies[name] == {"u"} for name in names)


def test_an_element_depends_on_every_element_of_the_arrays_that_are_declared(folder: Path) -> None:
    found = Model("a", build("arrays", folder, 3)).dependencies
    assert found["z[1,1]"] == found["z[2,2]"] == {"u[1]", "u[2]", "u[3]"}
    assert found["y[1]"] == set()


def with_array(folder: Path, dimensions: str, more: str = "") -> Path:
    """A description in which the output of a gain is an array."""
    array = replaced(r'(<Float64 name="y"[^/]*)/>', rf"\1>{dimensions}</Float64>{more}")
    return edited(build("gain", folder, 3), folder / "array.fmu", array)


LONG = '<Dimension start="1000"/><Dimension start="1000"/>'
SIZE = '<UInt64 name="n" valueReference="90" causality="structuralParameter" start="2"/>'
SIZED = '<Dimension valueReference="90"/>'
TWIN = '<Float64 name="y[2]" valueReference="90" causality="local"/>'


@pytest.mark.parametrize(
    ("dimensions", "more", "wires", "parameters", "says"),
    [
        (SIZED, SIZE, [("a.y", "a.u")], {}, r"'a\.y' is an array, .* Name them: 'a\.y\[1\]' to 'a\.y\[2\]'"),
        (SIZED, SIZE, [("a.y[3]", "a.u")], {}, r"'a' has no variable 'y\[3\]'\. Did you mean 'y\[2\]'"),
        (SIZED, SIZE, [], {"a.n": 3}, "'a.n' is a structural parameter, the size of arrays, and keeps its value"),
        (LONG, "", [("a.y", "a.u")], {}, r"'a\.y' is an array of 1000000 elements; up to 65536 can be exchanged"),
        ('<Dimension start="3"/>', TWIN, [], {}, r"array 'y' and another variable 'y\[2\]', the name of one of its"),
    ],
)
def test_what_arrays_cannot_do_is_refused(
    folder: Path, dimensions: str, more: str, wires: list[Any], parameters: dict[str, Any], says: str
) -> None:
    path = with_array(folder, dimensions, more)
    with pytest.raises(CouplingError, match=says):
        System({"a": path}, wires, parameters)


def test_an_array_too_long_to_be_recorded_is_named(folder: Path) -> None:
    system = System({"a": with_array(folder, LONG)})
    assert (system.outputs(None), system.left_out()) == ([], ["a.y"])


@pytest.mark.parametrize("start", ["", "1.0 2.0"])
def test_elements_whose_neighbours_have_no_start_value_are_not_set(folder: Path, start: str) -> None:
    path = edited(build("arrays", folder, 3), folder / "no start.fmu", replaced("0.5 1.0 1.5", start))
    with pytest.raises(CouplingError, match=f"the start values of the other 2 are not known: start = '{start}'"):
        simulate(System({"a": path}, parameters={"a.u[1]": 1.0}), 1.0, 0.5)


def test_one_start_value_is_that_of_every_element(folder: Path) -> None:
    path = edited(build("arrays", folder, 3), folder / "one start.fmu", replaced("0.5 1.0 1.5", "4.0"))
    found = simulate(System({"a": path}, parameters={"a.u[1]": 1.0}), 1.0, 0.5)
    assert values(found, "a.y", 3)[:, -1].tolist() == [1.0, 4.0, 4.0]


def test_elements_are_refused_where_ssp_has_no_place_for_them(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(CouplingError, match=r"'a\.counted\[3\]' is an element of an array, which SSP 1\.0 cannot name"):
        export_ssp(coupled(folder), tmp_path / "arrays.ssp")
