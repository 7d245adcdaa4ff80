"""Values at which the checker tries a variable: within its declared range, both ways from its start."""

from fmpy.model_description import ModelVariable, SimpleType

from system_models.check.variables import clipped, elsewhere, extremes, is_free, magnitude


def real(**given: str) -> ModelVariable:
    variable = ModelVariable("x", 1)
    variable.type = "Real"
    for name, text in given.items():
        setattr(variable, name, text)
    return variable


def test_a_value_is_moved_into_the_range_from_either_side() -> None:
    ranged = real(min="-2", max="3")
    assert [clipped(ranged, value) for value in (-5.0, 1.0, 7.0)] == [-2.0, 1.0, 3.0]
    assert clipped(real(min="-2"), 7.0) == 7.0
    assert clipped(real(max="3"), -5.0) == -5.0


def test_the_range_of_the_declared_type_counts_where_there_is_none_of_its_own() -> None:
    variable = real()
    variable.declaredType = SimpleType()
    variable.declaredType.min, variable.declaredType.max = "0", "1"
    assert [clipped(variable, value) for value in (-1.0, 2.0)] == [0.0, 1.0]


def test_a_start_is_moved_by_its_magnitude_both_ways_and_not_beyond_the_range() -> None:
    assert elsewhere(real(start="10", nominal="4")) == [6.0, 14.0]
    assert elsewhere(real(start="10", nominal="4", min="10", max="12")) == [12.0]
    assert magnitude(real(start="-3")) == 3.0
    assert magnitude(real(start="0")) == 1.0


def test_the_ends_of_the_range_are_tried_and_none_a_million_magnitudes_away() -> None:
    assert extremes(real(min="-1", max="5", nominal="1")) == [-1.0, 0.0, 5.0]
    assert extremes(real(min="2", max="1e300", nominal="0.5")) == [2.0, 5e5]


def test_a_range_of_one_value_leaves_nothing_to_try() -> None:
    assert not is_free(real(min="2", max="2"))
    assert is_free(real(min="2", max="3")) and is_free(real(min="2"))
