"""Names of FMUs and of their variables are any text: no store, table or picture loses a result by one."""

import csv
import re
import tempfile
import warnings
import zipfile
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
import pytest
import xarray as xr
from comparison import approx
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.models import build
from system_models.charts import files
from system_models.cli.main import main
from system_models.master import CouplingError, System
from system_models.run import cosim_report
from system_models.store import results

NASTY = [
    "Sub/Gain out[1,2]",
    "$x^{$\\frac_1",
    " a\tb\nc ",
    "\u009b2J",
    "e\u0301 \u212b",
    "x" * 300,
    "der(v)",
    "%d",
    "'q'",
    "~",
]
TEXT = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), min_size=1, max_size=20)
NAMES = st.lists(st.builds("{}.{}".format, TEXT, TEXT | st.sampled_from(NASTY)), min_size=1, max_size=4, unique=True)


def table(columns: list[str]) -> xr.Dataset:
    values = {name: np.arange(3.0) + n for n, name in enumerate(columns)}
    return results.to_dataset([0.0, 1.0, 2.0], values, dict.fromkeys(columns, "m"), {name: name for name in columns})


@given(NAMES)
def test_a_result_is_read_as_it_was_written_whatever_its_names(columns: list[str]) -> None:
    dataset = table(columns)
    with tempfile.TemporaryDirectory() as folder:
        netcdf, text = results.write(dataset, Path(folder))
        assert results.read(netcdf).identical(dataset)
        with text.open(encoding="utf-8", newline="") as file:
            assert next(csv.reader(file)) == ["time [s]", *(f"{name} [m]" for name in columns)]


@pytest.mark.parametrize("owner", ["a", "my rig", "a/b"])
def test_half_widths_are_kept_with_the_outputs_that_they_belong_to(owner: str, tmp_path: Path) -> None:
    dataset = table([f"{owner}.h_c", f"{owner}.error_film"])
    found = results.read(results.write(dataset, tmp_path)[0])
    assert found.identical(dataset)
    assert list(found.coords) == ["time", f"{owner}.h_c_error"]
    assert found[f"{owner}.h_c"].attrs["ancillary_variables"] == f"{owner}.h_c_error"


def test_an_output_named_as_a_half_width_is_kept() -> None:
    dataset = table(["a.h_c", "a.error_film", "a.h_c_error"])
    assert dataset["a.h_c_error"].values == approx([2.0, 3.0, 4.0])
    assert "a.h_c_error" in dataset.data_vars


def test_outputs_named_as_ours_may_be_of_any_type() -> None:
    columns = {
        "a.h_c": ["thin", "thick"],
        "a.error_film": [0.1, 0.2],
        "b.h_c": [1.0, 2.0],
        "b.error_film": [True, False],
    }
    dataset = results.to_dataset([0.0, 1.0], columns, dict.fromkeys(columns, "1"), {name: name for name in columns})
    assert list(dataset.coords) == ["time"]


@pytest.fixture(scope="module")
def nasty(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An FMU with an output of each nasty name."""
    path = build("gain", tmp_path_factory.mktemp("fmus"), a=3.0)
    result = path.with_name("nasty.fmu")
    with zipfile.ZipFile(path) as source, zipfile.ZipFile(result, "w") as archive:
        for name in source.namelist():
            content = source.read(name)
            if name == "modelDescription.xml":
                text = content.decode()
                (output,) = re.findall(r'<ScalarVariable name="y".*?</ScalarVariable>', text, re.DOTALL)
                escapes = {"\n": "&#10;", "\t": "&#9;"}
                own = [output.replace('"y"', quoteattr(each, escapes)) for each in NASTY]
                content = text.replace(output, "".join(own)).encode()
            archive.writestr(name, content)
    return result


def test_a_simulation_of_an_fmu_with_nasty_names_keeps_its_results(
    nasty: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("$a_{$.toml").write_text(
        f'[fmus]\n"a/b $c^{{$" = "{nasty}"\n[parameters]\n"a/b $c^{{$.u" = 2.0\n'
        "[simulate]\nstop_time = 1.0\nstep_size = 0.5\n"
    )
    assert main(["cosim", "$a_{$.toml", "--out", "out"]) == 0
    dataset = results.read(Path("out/result.nc"))
    names = [f"a/b $c^{{$.{name}" for name in NASTY]
    assert cosim_report.recorded(dataset) == names
    assert all(dataset[name].values == approx([6.0] * 3) for name in names)
    out = capsys.readouterr().out
    assert "\u009b" not in out
    assert r"a/b $c^{$.\x9b2J" in out


@pytest.mark.parametrize("name", ["a.$x^{$\\frac_1", "a. b\tc\n"])
def test_names_in_pictures_are_no_formulas(name: str) -> None:
    dataset = table([name]).assign(table(["master.step_size"])).assign_attrs(title="$x^{$")
    figure = files.figure(cosim_report.overview(dataset))
    figure.draw_without_rendering()
    assert figure.axes[0].get_title("left") == f"{cosim_report.printable(name)} [m]"


def test_pictures_have_room_for_their_panels_beside_names_of_any_length() -> None:
    names = [f"a.{letter * 400}_{n}" for n, letter in enumerate("Wx")]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        dataset = table(names).assign(table(["master.step_size"])).assign_attrs(title="W" * 250)
        figure = files.figure(cosim_report.overview(dataset))
        figure.draw_without_rendering()
    assert {axis.get_title("left")[-7:] for axis in figure.axes[:2]} == {f"{name[-3:]} [m]" for name in names}


@pytest.mark.parametrize("name", ["master", "bond"])
def test_an_fmu_is_not_called_as_columns_of_the_result_are(nasty: Path, name: str) -> None:
    with pytest.raises(CouplingError, match=f"'{name}': the results have columns"):
        System({name: nasty})


@pytest.mark.parametrize("name", ["a\nb", "a\0", "\u009b"])
def test_the_name_of_an_fmu_has_no_control_characters(nasty: Path, name: str) -> None:
    with pytest.raises(CouplingError, match="it has control characters"):
        System({name: nasty})
