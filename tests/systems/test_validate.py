"""`tribofmu validate`: comparisons hold, notice faults, and say what they do not judge."""

import re
from functools import cache, partial

import numpy as np
import pytest
from comparison import approx

from contact_core import Scene, SceneError, point_contact, subsurface_stress
from system_models.cli.main import main
from system_models.validation import dimple, film_formulas, flash, registry, stresses
from system_models.validation.model import Cause, Comparison, Kind, Outcome, Row, Verdict, rounding
from system_models.validation.registry import COMPARISONS, outcome

MINUTES = {"optical_films", "dimple", "asperity_load"}  # of solving: test_measured_films, test_asperity_load have parts


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.long if name == "starvation" else ())
        for name in COMPARISONS
        if name not in MINUTES
    ],
)
def test_nothing_disagrees_without_a_known_cause(name):
    found = outcome(name)
    assert not found.failure
    assert [row.quantity for row in found.rows if row.verdict is Verdict.DISAGREES] == []
    assert all(row.reason for row in found.rows)


class Faulty:
    """Scenes with one value changed."""

    def __init__(self, change):
        self.change = change

    def from_toml(self, name, changes=None):
        return Scene.from_toml(name, (changes or {}) | self.change)


def test_a_pressure_coefficient_20_percent_off_is_a_measured_film_missed(monkeypatch):
    monkeypatch.setattr(dimple, "GRIDS", (65, 65))
    monkeypatch.setattr(dimple, "rolling", cache(dimple.rolling))
    assert {row.verdict for row in dimple.run().rows} == {Verdict.AGREES}
    monkeypatch.setattr(dimple, "rolling", cache(dimple.rolling.__wrapped__))
    monkeypatch.setattr(dimple, "Scene", Faulty({"lubricant.viscosity.pressure_coefficient": "26.4 GPa^-1"}))
    found = [row.verdict for row in dimple.run().rows]
    assert found.count(Verdict.DISAGREES) >= 4


def test_a_pressure_coefficient_20_percent_off_is_seen_beside_the_published_formulas(monkeypatch):
    def stiffer(**given):
        return point_contact(**given | {"pressure_viscosity": 1.2 * given["pressure_viscosity"]})

    monkeypatch.setattr(film_formulas, "point_contact", stiffer)
    assert film_formulas._point(100.0, 5.0).verdict is Verdict.DISAGREES


def test_heat_that_is_5_percent_off_is_seen_beside_jaegers_integral(monkeypatch):
    class Hotter(flash.MovingSurface):
        def rise(self, flux):
            return 1.05 * super().rise(flux)

    monkeypatch.setattr(flash, "MovingSurface", Hotter)
    assert {row.verdict for row in flash.run().rows} == {Verdict.DISAGREES}


def test_stress_that_is_5_percent_off_is_seen_beside_the_textbooks_figures(monkeypatch):
    def stronger(pressure, *others, **given):
        return subsurface_stress(1.05 * pressure, *others, **given)

    monkeypatch.setattr(stresses, "subsurface_stress", stronger)
    found = [row.verdict for row in stresses.run().rows if row.quantity.startswith("largest shear")]
    assert found == [Verdict.DISAGREES] * 2


def row(computed, **changes):
    given = {"reference": (1.0, 1.0), "uncertainty": 0.1, "reason": "asked", "stated_error": 0.1}
    return Row(**{"quantity": "film", "unit": "nm", "computed": computed} | given | changes)


@pytest.mark.parametrize(
    ("computed", "verdict"),
    [
        (1.09, Verdict.AGREES),
        (0.82, Verdict.WITHIN_ERROR),
        (0.7, Verdict.DISAGREES),
        (1.5, Verdict.EXPLAINED),
        (1.7, Verdict.DISAGREES),
        (np.nan, Verdict.DISAGREES),
    ],
)
def test_a_cause_excuses_only_the_answers_that_it_explains(computed, verdict):
    found = row(computed, cause=Cause("known", 1.4, 1.6))
    assert found.verdict is verdict
    assert Outcome((row(1.0), found)).unexplained == (verdict is Verdict.DISAGREES)


def test_the_distance_from_a_range_is_that_from_its_nearer_end():
    assert [row(value, reference=(1.0, 3.0)).deviation for value in (0.5, 2.0, 3.5)] == [-0.5, 0.0, 0.5]


def test_printed_numbers_are_right_to_half_of_their_last_digit():
    assert rounding((0.09, 0.01, 0.67), (22.0, 1.0, 0.53)) == approx(np.hypot(0.67 * 0.005 / 0.09, 0.53 * 0.5 / 22.0))


def test_a_comparison_writes_a_page_of_one_file_and_its_picture(tmp_path, capsys, drawn):
    assert main(["validate", "dry_contact", "flash", "--out", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "dry_contact (closed form)" in said
    assert re.search(r"largest pressure +1\.121 GPa +1\.121 ± \S+ GPa", said)
    page = (tmp_path / "validation.html").read_text("utf-8")
    assert page.count("<tr>") == 2 + 2 + 8
    assert set(re.findall(r'src="([^,]*),', page)) == {"data:image/png;base64"}
    assert '<a href="https://doi.org/10.1115/1.2927035">' in page
    assert (tmp_path / "validation.png").stat().st_size > (10_000 if drawn else 0)


def disagreeing():
    return Outcome((row(2.0),))


def refused():
    raise SceneError("load = -1 N is below 0.")


@pytest.mark.parametrize(
    ("run", "code", "said"),
    [
        (disagreeing, 1, "no known cause"),
        (refused, 1, "cannot be computed: load = -1 N is below 0."),
        (partial(Outcome, (row(2.0, not_judged="the oil is not known"),)), 0, "not judged: the oil is not known"),
    ],
)
def test_the_exit_code_says_whether_something_disagrees(tmp_path, capsys, monkeypatch, run, code, said):
    asked = Comparison("A film", Kind.MEASURED, "About it.", "Nobody 1900", run)
    monkeypatch.setattr(registry, "COMPARISONS", {"film": asked})
    assert main(["validate", "--out", str(tmp_path)]) == code
    assert said in capsys.readouterr().out
    assert said in (tmp_path / "validation.html").read_text("utf-8")


def test_the_list_names_every_comparison_and_what_it_compares_with(capsys):
    assert main(["validate", "--list"]) == 0
    said = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in said] == list(COMPARISONS)
    assert all(compared.kind in line for compared, line in zip(COMPARISONS.values(), said, strict=True))


def test_a_misspelt_name_is_answered_with_the_nearest_one(capsys):
    assert main(["validate", "optical_film"]) == 2
    assert "Did you mean optical_films?" in capsys.readouterr().err
