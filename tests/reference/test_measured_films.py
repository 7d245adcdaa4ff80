"""Films against measurements: central films by interferometry, and a dimple that crosses a contact."""

import numpy as np

from system_models.validation.dimple import errors, rolling
from system_models.validation.optical_films import films
from system_models.validation.tables import read


def test_central_films_follow_the_measured_ones_over_three_decades_of_speed():
    """On 65 nodes; by the plain flow the thinnest film would be a tenth of the measured one."""
    found = films(22e-9, 65, read("optical_films.csv")[::4])
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
