from functools import reduce

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contact_core import Scene
from contact_core.laws.tribofilm import thickness
from contact_core.reference import ghanbarzadeh_thickness

CASES = {name: Scene.from_toml(name) for name in ("azam_case_a", "mtm_zddp")}


@pytest.mark.parametrize("name", CASES)
@given(steps=st.lists(st.floats(0.0, 2000.0), min_size=1, max_size=40))
def test_a_point_always_rubbed_follows_the_closed_form_for_any_splitting_of_time(name, steps):
    law, temperature = CASES[name].tribofilm, CASES[name].operation.temperature

    def rub(film, step):
        return law.evolve(*film, np.array([step]), temperature)

    found = thickness(*reduce(rub, steps, (np.zeros(1), np.zeros(1))))
    expected = ghanbarzadeh_thickness(
        sum(steps), temperature, law.full_thickness, law.rate_factor, law.removal_thickness, law.removal_rate
    )
    assert abs(found[0] - expected) < 1e-12 * law.full_thickness
