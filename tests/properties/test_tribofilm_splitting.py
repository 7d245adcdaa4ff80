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
        return law.evolve(*film, np.array([law.rate(temperature) * step]), np.zeros(1), temperature)

    found = thickness(*reduce(rub, steps, (np.zeros(1), np.zeros(1))))
    expected = ghanbarzadeh_thickness(
        sum(steps), temperature, law.full_thickness, law.rate_factor, law.removal_thickness, law.removal_rate
    )
    assert abs(found[0] - expected) < 1e-12 * law.full_thickness


SETS = {
    name: Scene.from_toml("mtm_zddp", {"tribofilm.set": name}).tribofilm
    for name in ("zhang_spikes_80c_ethylhexyl", "gosvami", "combined_80c")
}


@pytest.mark.parametrize("name", SETS)
@given(
    steps=st.lists(st.floats(0.0, 2000.0), min_size=1, max_size=40),
    growing=st.floats(0.0, 1e2), taking=st.floats(0.0, 1e2), start=st.floats(0.0, 1.0),
)  # fmt: skip
def test_growth_and_removal_in_proportion_follow_their_exponential_for_any_splitting(
    name, steps, growing, taking, start
):
    law = SETS[name]

    def rub(film, step):
        return law.evolve(*film, np.array([growing * step]), np.array([taking * step]), 353.15)

    found = thickness(*reduce(rub, steps, (np.array([start * law.full_thickness]), np.zeros(1))))
    both = growing + taking
    settled = growing / both if both > 0.0 else start
    expected = settled + (start - settled) * np.exp(-both * sum(steps))
    assert abs(found[0] / law.full_thickness - expected) < 1e-12
