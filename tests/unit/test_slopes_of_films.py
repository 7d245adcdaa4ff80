"""Exponents of speed of measured films and their standard errors, by hand."""

import math

import numpy as np
from comparison import approx

from system_models.validation.optical_films import Films

SPEED = np.exp([-1.0, 0.0, 1.0])


def test_the_standard_error_of_a_slope_is_that_of_a_straight_line() -> None:
    """Of three logarithms with one deviation: s / sqrt(sum of squared distances from the middle), 0.1 / sqrt(2)."""
    film = SPEED**0.7
    found = Films(SPEED, film, 0.1 * film, 2.0 * SPEED**0.6)
    assert found.slopes() == approx((0.7, 0.6))
    assert found.slope_error() == approx(0.1 / math.sqrt(2.0))
    ends = Films(SPEED, film, np.array([0.1, 0.0, 0.1]) * film, film)
    assert ends.slope_error() == approx(0.1 / math.sqrt(2.0))  # what lies in the middle does not turn the line


def test_one_factor_between_films_has_no_scatter() -> None:
    film = SPEED**0.7
    assert Films(SPEED, film, film, 1.2 * film).factor() == approx((1.2, 0.0, 1.2), abs=1e-12)
    mean, scatter, least = Films(SPEED[:2], film[:2], film[:2], np.array([0.5, 2.0]) * film[:2]).factor()
    assert (mean, scatter, least) == approx((1.0, math.log(2.0), 0.5))
