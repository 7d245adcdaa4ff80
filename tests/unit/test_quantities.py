from collections import Counter
from dataclasses import dataclass, fields

import pytest

from contact_core import OperatingPoint, Outputs, Scene
from contact_core.film import FILMS
from contact_core.film.regression import CORRECTIONS
from contact_core.quantities import INPUTS, LEVELS, OF_CALLER, OUTPUTS, TABLE, out_of_range, parameter
from contact_core.scene import tunables, units

QUANTITIES = (*INPUTS, *OUTPUTS)


def test_every_name_is_used_once():
    assert Counter(q.name for q in QUANTITIES).most_common(1)[0][1] == 1
    assert len(TABLE) == len(QUANTITIES)


def test_the_core_fills_exactly_the_outputs_of_the_table():
    assert {f.name for f in fields(Outputs)} == {q.name for q in OUTPUTS} - OF_CALLER


def test_the_outputs_have_the_kinds_of_the_table():
    kinds = {f.name: {float: "Real", int: "Integer"}[type(f.default)] for f in fields(Outputs)}
    assert kinds == {q.name: q.kind for q in OUTPUTS if q.name not in OF_CALLER}


def test_every_quantity_is_told_by_a_level_there_is():
    levels = {"deterministic", *CORRECTIONS.values()}
    assert set(LEVELS) == levels
    assert {film.name for film in FILMS} <= levels
    assert all(q.levels and set(q.levels) <= levels for q in QUANTITIES)
    assert all("deterministic" in q.levels for q in QUANTITIES)


def test_an_operating_point_has_exactly_the_inputs_of_the_table():
    have = [(f.name, f.metadata["unit"]) for f in fields(OperatingPoint)]
    assert have == [(q.name, q.unit) for q in INPUTS]


@pytest.mark.parametrize("quantity", QUANTITIES, ids=lambda q: q.name)
def test_a_quantity_is_described_and_its_units_agree(quantity):
    assert quantity.text
    assert quantity.nominal > 0.0
    assert quantity.minimum < quantity.maximum
    factor, dimension = units.unit(quantity.unit)
    assert factor == 1.0  # SI
    if quantity.display == "degC":
        assert quantity.unit == "K"
    else:
        assert units.unit(quantity.display or quantity.unit)[1] == dimension


@pytest.mark.parametrize("name", ["azam_case_a", "mtm_zddp"])
def test_every_parameter_of_a_scene_says_its_si_unit_and_its_meaning(name):
    for path, (_, field) in tunables(Scene.from_toml(name)).items():
        assert units.unit(field.metadata["unit"])[0] == 1.0, path
        assert field.metadata["text"], path


@dataclass(frozen=True)
class _Record:
    length: float = parameter("m", "a length", above=0.0, most=2.0, default=1.0)
    share: float = parameter("", "a share", least=0.0, default=0.5)
    way: str = parameter("", "a way", choices=("this", "that"), default="this")


def test_values_in_range_give_no_sentence():
    assert list(out_of_range(_Record(length=2.0, share=0.0), "")) == []


@pytest.mark.parametrize(
    ("record", "sentence"),
    [
        (_Record(length=0.0), "part.length = 0 m (a length) must be above 0 and at most 2 m."),
        (_Record(length=2.1), "part.length = 2.1 m (a length) must be above 0 and at most 2 m."),
        (
            _Record(length=float("nan")),
            "part.length = nan m (a length) must be finite and above 0 and at most 2 m.",
        ),
        (_Record(share=-0.1), "part.share = -0.1 (a share) must be at least 0."),
        (_Record(share=float("inf")), "part.share = inf (a share) must be finite and at least 0."),
        (_Record(way="other"), "part.way = 'other' is not one of this, that."),
    ],
)
def test_a_value_out_of_range_gives_one_sentence_with_name_value_and_range(record, sentence):
    assert list(out_of_range(record, "part")) == [sentence]
