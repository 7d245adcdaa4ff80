"""The error of a step from its two halves, against integrals by hand."""

import pytest
from comparison import approx

from system_models.numerics.richardson import halves


@pytest.mark.parametrize("nodes", [[0.0], [0.0, 1.0], [0.0, -1.0], [0.0, -1.0, -2.0]])
def test_nodes_at_the_same_fractions_give_the_factor_of_the_order(nodes: list[float]) -> None:
    """Of an input held with p nodes: 1 / (2^p - 1) of the difference."""
    whole, half = ([part * node for node in nodes] for part in (0.3, 0.15))
    assert halves(0.3, whole, half, half).per_difference == approx(1.0 / (2.0 ** len(nodes) - 1.0))


def test_errors_of_the_halves_do_not_cancel() -> None:
    """Held from its start in the first half and from its end in the second: 1/8 and -1/8 of the whole's 1/2."""
    found = halves(1.0, [0.0], [0.0], [0.5])
    assert found.error == approx(0.125 + 0.125)
    assert found.per_difference == approx(0.25 / 0.5)


def test_a_half_with_more_nodes_than_the_other_has_no_error() -> None:
    assert halves(1.0, [0.0], [0.0], [0.0, 0.5]).error == approx(0.125)
