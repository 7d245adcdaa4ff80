"""Films against measurements: central films by interferometry, and a dimple that crosses a contact."""

import numpy as np
import pytest

from benchmarks.film import measured
from benchmarks.film.measured import errors, films, rolling


@pytest.fixture
def every_fourth(monkeypatch):
    rows = measured.read("optical_films.csv")[::4]
    monkeypatch.setattr(measured, "read", lambda _: rows)


def test_central_films_follow_the_measured_ones_over_three_decades_of_speed(every_fourth):
    """On 65 nodes; by the plain flow the thinnest film would be a tenth of the measured one."""
    found = films(22e-9, 65)
    expected, slope = found.slopes()
    factor, scatter, least = found.factor()
    assert abs(slope - expected) < 0.04
    assert scatter < 0.08
    assert least > 0.5
    assert 0.7 < factor < 1.1  # the oil's pressure coefficient is not known


def test_a_dimple_leaves_the_film_beside_it_as_measured():
    off = errors(rolling(65))
    assert sorted(off) == [1, 2, 3, 4, 5]
    assert max(off.values()) < 0.09
    assert np.median(list(off.values())) < 0.05
