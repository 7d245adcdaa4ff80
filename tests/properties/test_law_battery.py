"""What every law of a slot must obey, tried with random parameters. A new law joins by its entry in LAWS."""

from dataclasses import fields, is_dataclass
from typing import Any, get_type_hints

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from contact_core.laws import SLOTS
from contact_core.laws.tribofilm import thickness
from contact_core.quantities import out_of_range

LAWS = [pytest.param(law, id=f"{slot}-{law.name}") for slot, laws in SLOTS.items() for law in laws]
SHAPE = (3, 5)

# what a contact may meet
pressures = arrays(float, SHAPE, elements=st.floats(0.0, 6e9))
covers = arrays(float, SHAPE, elements=st.floats(0.0, 1.0))
temperatures = st.floats(230.0, 500.0)
speeds = st.floats(-50.0, 50.0)

# plausible values where the allowed range is far wider than any material
PLAUSIBLE = {
    "viscosity": (1e-3, 10.0),
    "reference_temperature": (273.0, 400.0),
    "fit_temperature": (273.0, 450.0),
    "pressure_coefficient": (5e-9, 30e-9),
    "temperature_coefficient": (0.005, 0.06),
    "full_thickness": (1e-9, 1e-6),
    "removal_thickness": (0.0, 1e-6),
    "rate_factor": (0.0, 1e-14),
    "conductivity_1": (0.1, 500.0),
    "conductivity_2": (0.1, 500.0),
    "diffusivity_1": (1e-7, 1e-4),
    "diffusivity_2": (1e-7, 1e-4),
    "eyring_stress": (1e5, 1e8),
    "hardness": (1e9, 2e10),
    "film_hardness": (1e8, 1e9),
    "slip_speed": (1e-9, 1.0),
}


def law_strategy(law: type) -> st.SearchStrategy[Any]:
    values = {}
    for f in fields(law):
        if f.metadata["choices"]:
            values[f.name] = st.sampled_from(f.metadata["choices"])
        else:
            assert get_type_hints(law)[f.name] is float
            values[f.name] = st.floats(
                *PLAUSIBLE.get(f.name, (0.0, f.metadata["most"])), exclude_min=f.name not in PLAUSIBLE
            )
    return st.builds(law, **values)


def laws_of(slot: str) -> st.SearchStrategy[Any]:
    return st.one_of([law_strategy(law) for law in SLOTS[slot]])


def is_field(values: np.ndarray) -> bool:
    return values.shape == SHAPE and bool(np.all(np.isfinite(values)))


@pytest.mark.parametrize("law", LAWS)
def test_a_law_is_a_frozen_record_with_a_name_and_a_source(law):
    assert is_dataclass(law)
    assert law.__dataclass_params__.frozen
    assert law.name
    assert law.name == "none" or law.source


@pytest.mark.parametrize("laws", SLOTS.values(), ids=SLOTS)
def test_names_are_unique_in_a_slot(laws):
    assert len({law.name for law in laws}) == len(laws)


@pytest.mark.parametrize("law", LAWS)
@given(st.data())
def test_plausible_parameters_of_a_law_are_in_its_range(law, data):
    assert list(out_of_range(data.draw(law_strategy(law)), "law")) == []


@given(laws_of("viscosity"), pressures, temperatures)
def test_a_viscosity_is_positive_finite_and_rises_with_pressure(law, pressure, temperature):
    found = law(pressure, temperature)
    assert is_field(found)
    assert np.all(found > 0.0)
    assert np.all(law(pressure + 1e7, temperature) >= found)


@given(laws_of("viscosity"), pressures, st.floats(230.0, 490.0))
def test_a_viscosity_falls_with_temperature(law, pressure, temperature):
    assert np.all(law(pressure, temperature + 5.0) <= law(pressure, temperature))


@given(laws_of("density"), pressures)
def test_a_density_starts_at_one_and_rises_with_pressure(law, pressure):
    found = law(pressure)
    assert is_field(found)
    assert np.all(law(np.zeros(SHAPE)) == 1.0)
    assert np.all(law(pressure + 1e7) >= found)
    assert np.all((found >= 1.0) & (found < 2.0))


@given(
    laws_of("rheology"), arrays(float, SHAPE, elements=st.floats(1e-3, 1e12)),
    arrays(float, SHAPE, elements=st.floats(-1e10, 1e10)), pressures,
)  # fmt: skip
def test_a_shear_stress_follows_the_shear_rate_and_dissipates(law, viscosity, rate, pressure):
    found = law(viscosity, rate, pressure)
    assert is_field(found)
    assert np.array_equal(law(viscosity, -rate, pressure), -found)
    assert np.all(found * np.sign(rate) >= 0.0)
    assert np.all(np.abs(found) <= viscosity * np.abs(rate) * (1.0 + 1e-12) + 1e-300)  # never above Newton's


@given(laws_of("plasticity"), covers)
def test_a_pressure_limit_lies_between_those_of_solid_and_film(law, cover):
    found = law.limit(cover)
    assert is_field(found)
    assert np.all((found >= law.film_hardness * (1.0 - 1e-12)) & (found <= law.hardness))


@given(laws_of("boundary_friction"), pressures, covers, speeds)
def test_boundary_friction_opposes_sliding_and_vanishes_without_contact(law, pressure, cover, speed):
    found = law(pressure, cover, speed)
    assert is_field(found)
    assert np.array_equal(law(pressure, cover, -speed), -found)
    assert np.all(found * speed >= 0.0)
    assert not law(np.zeros(SHAPE), cover, speed).any()


@given(laws_of("heat"), arrays(float, SHAPE, elements=st.floats(0.0, 1e-3)), pressures, speeds)
def test_friction_only_warms(law, radius, shear, speed):
    found = law.rise(radius, shear, speed)
    assert is_field(found)
    assert np.all(found >= 0.0)
    assert not law.rise(radius, shear, 0.0).any()


@given(laws_of("wear"), pressures, covers, speeds)
def test_wear_only_removes_and_needs_pressure_and_sliding(law, pressure, cover, speed):
    found = law.rate(pressure, cover, speed, 6e9)
    assert is_field(found)
    assert np.all(found >= 0.0)
    assert not law.rate(np.zeros(SHAPE), cover, speed, 6e9).any()
    assert not law.rate(pressure, cover, 0.0, 6e9).any()


times = arrays(float, SHAPE, elements=st.floats(0.0, 1e5))


@given(laws_of("tribofilm"), times, times, temperatures)
def test_a_tribofilm_after_two_times_is_that_after_their_sum(law, first, second, temperature):
    zero = np.zeros(SHAPE)
    step = law.evolve(*law.evolve(zero, zero, first, temperature), second, temperature)
    whole = law.evolve(zero, zero, first + second, temperature)
    for by_steps, at_once in zip(step, whole, strict=True):
        assert is_field(by_steps)
        assert np.allclose(by_steps, at_once, rtol=0.0, atol=1e-12 * 1e-6)
        assert np.all(by_steps >= 0.0)


@given(laws_of("tribofilm"), times, temperatures)
def test_a_tribofilm_stays_between_nothing_and_its_full_thickness(law, time, temperature):
    zero = np.zeros(SHAPE)
    film = thickness(*law.evolve(zero, zero, time, temperature))
    assert np.all((film >= 0.0) & (film <= law.full_thickness))
