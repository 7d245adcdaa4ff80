"""What every law of a slot must obey, tried with random parameters. A new law joins by its entry in LAWS."""

from dataclasses import fields, is_dataclass
from typing import Any, get_type_hints

import numpy as np
import pytest
from comparison import approx
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from contact_core.kernels.load_cycle import Cycle
from contact_core.laws import SLOTS
from contact_core.laws.temperatures import Rubbing
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
    "vogel_viscosity": (1e-5, 2e-4),
    "vogel_slope": (500.0, 2000.0),
    "vogel_offset": (-210.0, -100.0),
    "modulus": (-4e7, -2e7),
    "modulus_slope": (2e5, 4e5),
    "bend": (-0.07, 0.01),
    "bend_slope": (-2e-5, 3e-4),
    "viscosity_40": (2e-5, 1e-3),
    "viscosity_100": (2e-6, 1.5e-5),
    "density": (800.0, 1100.0),
    "temperature": (300.0, 700.0),
    "full_thickness": (1e-9, 1e-6),
    "removal_thickness": (0.0, 1e-6),
    "rate_factor": (0.0, 1e-14),
    "fitted_from": (273.0, 450.0),
    "fitted_to": (273.0, 450.0),
    "growth_rate": (1e-6, 1e-1),
    "removal_energy": (0.0, 2e-19),
    "growth_per_energy": (0.0, 1e-9),
    "contact_share": (1e-5, 1.0),
    "supply_rate": (1e-12, 1e-6),
    "least_power": (0.0, 1e9),
    "prefactor": (0.0, 1e6),
    "activation_energy": (0.5e-19, 2e-19),
    "activation_volume": (0.0, 0.5e-27),
    "least_shear": (1e5, 1e9),
    "removal_coefficient": (0.0, 1e-6),
    "edge_weight": (0.0, 10.0),
    "contact_weight": (0.0, 2.0),
    "stress_weight": (0.0, 2.0),
    "scale": (5e-11, 1e-9),
    "thin": (1e-9, 1e-7),
    "closed": (1e-9, 1e-8),
    "volume_ratio": (1.0, 3.0),
    "conductivity_1": (0.1, 500.0),
    "conductivity_2": (0.1, 500.0),
    "diffusivity_1": (1e-7, 1e-4),
    "diffusivity_2": (1e-7, 1e-4),
    "eyring_stress": (1e5, 1e8),
    "critical_stress": (1e3, 1e9),
    "hardness": (1e9, 2e10),
    "film_hardness": (1e8, 1e9),
    "slip_speed": (1e-9, 1.0),
    "heat_capacity_1": (1e-3, 1e6),
    "heat_capacity_2": (1e-3, 1e6),
    "conductance_1": (1e-6, 1e3),
    "conductance_2": (1e-6, 1e3),
    "debye_length": (1e-10, 1e-6),
    "relative_permittivity": (1.0, 100.0),
    "ion_radius": (1e-10, 1e-8),
    "reference_stress": (1e8, 5e9),
    "reference_cycles": (1.0, 1e9),
    "life_exponent": (1.0, 50.0),
    "endurance_limit": (0.0, 1e9),
    "single_strength": (1e8, 5e9),
    "strength_drop": (1e6, 1e8),
    "torsion_endurance": (0.0, 1e9),
    "torsion_limit": (1e8, 1e9),
    "bending_limit": (1e8, 1e9),
    "residual": (-1e9, 1e9),
    "cyclic_strength": (5e8, 1e10),
    "cyclic_hardening": (0.02, 0.5),
    "failure_work": (1e6, 1e11),
    "work_exponent": (0.5, 3.0),
    "film_exponent": (0.1, 20.0),
}


def law_strategy(law: type) -> st.SearchStrategy[Any]:
    values = {}
    for f in fields(law):
        if not f.metadata:  # a slot in a law
            values[f.name] = laws_of(f.name)
        elif f.metadata["choices"]:
            values[f.name] = st.sampled_from(f.metadata["choices"])
        elif get_type_hints(law)[f.name] is int:
            values[f.name] = st.integers(f.metadata["least"], f.metadata["most"])
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


@given(laws_of("viscosity"), arrays(float, SHAPE, elements=st.floats(0.0, 2e10)), st.floats(230.0, 900.0))
def test_a_viscosity_is_positive_finite_and_rises_with_pressure(law, pressure, temperature):
    found = law(pressure, temperature)
    assert is_field(found)
    assert np.all(found > 0.0)
    assert np.all(law(pressure + 1e7, temperature) >= found)


@given(laws_of("viscosity"), pressures, arrays(float, SHAPE, elements=st.floats(230.0, 900.0)))
def test_a_viscosity_takes_a_field_of_temperatures(law, pressure, temperature):
    found = law(pressure, temperature)
    assert is_field(found)
    one_by_one = [law(np.array([p]), float(t))[0] for p, t in zip(pressure.flat, temperature.flat, strict=True)]
    assert found.ravel() == approx(one_by_one, rel=1e-11, abs=0.0)


@given(laws_of("viscosity"), pressures, st.floats(230.0, 490.0))
def test_a_viscosity_falls_with_temperature(law, pressure, temperature):
    assume(not getattr(law, "error", ""))
    assert np.all(law(pressure, temperature + 5.0) <= law(pressure, temperature))


@given(laws_of("double_layer"), arrays(float, SHAPE, elements=st.floats(1e-11, 1e-4)), temperatures)
def test_double_layers_only_thicken_an_oil_and_not_in_thick_films(law, gap, temperature):
    found = law(gap, temperature)
    assert is_field(found)
    assert np.all(found >= 1.0)
    assert np.all(law(gap + 1.0, temperature) == approx(1.0, abs=1e-6))


@given(laws_of("density"), pressures)
def test_a_density_starts_at_one_and_rises_with_pressure(law, pressure):
    found = law(pressure)
    assert is_field(found)
    assert np.all(law(np.zeros(SHAPE)) == 1.0)
    assert np.all(law(pressure + 1e7) >= found)
    assert np.all((found >= 1.0) & (found < 2.0))


newtonian_stresses = arrays(float, SHAPE, elements=st.floats(-1e22, 1e22))


@given(laws_of("rheology"), newtonian_stresses, pressures)
def test_a_shear_stress_follows_the_shear_rate_and_dissipates(law, newtonian, pressure):
    found = law(newtonian, pressure)
    assert is_field(found)
    assert np.array_equal(law(-newtonian, pressure), -found)
    assert np.all(found * np.sign(newtonian) >= 0.0)
    assert np.all(np.abs(found) <= np.abs(newtonian) * (1.0 + 1e-12) + 1e-300)  # never above Newton's
    if law.limiting_coefficient > 0.0:
        assert np.all(np.abs(found) <= law.limiting_coefficient * pressure)


@given(laws_of("rheology"), newtonian_stresses, pressures)
def test_a_shear_stress_never_falls_with_shear_or_pressure(law, newtonian, pressure):
    by_newtonian, by_pressure = law.slopes(newtonian, pressure)
    assert is_field(by_newtonian)
    assert is_field(by_pressure)
    assert np.all((by_newtonian >= 0.0) & (by_newtonian <= 1.0 + 1e-12))
    assert np.all(by_pressure * np.sign(newtonian) >= 0.0)
    more = 1.5 * newtonian
    assert np.all(np.abs(law(more, pressure)) >= np.abs(law(newtonian, pressure)) * (1.0 - 1e-12))


@given(laws_of("rheology"), arrays(float, SHAPE, elements=st.floats(0.0, 1e10)))
def test_an_oil_shears_at_least_as_easily_as_a_newtonian_one(law, stress):
    found = law.ease(stress)
    assert is_field(found)
    assert np.all(found >= 1.0 - 1e-12)
    assert np.array_equal(law.ease(-stress), found)
    if not law.thins:
        assert np.all(found == 1.0)


FULL = 100e-9
films = arrays(float, SHAPE, elements=st.floats(0.0, FULL))
depths = arrays(float, SHAPE, elements=st.floats(0.0, 3.0 * FULL))


@given(laws_of("plasticity"), films, films, depths)
def test_a_pressure_limit_lies_between_those_of_solid_and_film(law, film_1, film_2, depth):
    found = law.limit(film_1, film_2, depth, FULL)
    assert is_field(found)
    assert np.all((found >= law.film_hardness * (1.0 - 1e-12)) & (found <= law.hardness))
    assert np.array_equal(law.limit(film_2, film_1, depth, FULL), found)
    assert np.all(law.limit(film_1, film_2, film_1 + film_2, FULL) >= law.hardness * (1.0 - 1e-12))
    assert np.all(law.limit(film_1 * 0.0, film_2 * 0.0, depth, FULL) == law.hardness)


@given(laws_of("plasticity"), films, films, depths)
def test_a_pressure_limit_is_that_of_one_of_three_layers(law, film_1, film_2, depth):
    slope = (law.hardness - law.film_hardness) / FULL
    expected = np.select(
        [depth < np.abs(film_1 - film_2), depth <= film_1 + film_2],
        [
            law.hardness - slope * (np.maximum(film_1, film_2) - depth),
            law.hardness - slope / 2.0 * (film_1 + film_2 - depth),
        ],
        law.hardness,
    )
    assert law.limit(film_1, film_2, depth, FULL) == approx(expected, rel=1e-12)


@given(laws_of("plasticity"), films, films, st.floats(-1e-6, 1e-6))
def test_a_pressure_limit_has_no_step_where_the_depth_reaches_another_layer(law, film_1, film_2, share):
    steepest = (law.hardness - law.film_hardness) / FULL
    for joint in (np.abs(film_1 - film_2), film_1 + film_2):
        depth = np.maximum(joint + share * FULL, 0.0)
        step = law.limit(film_1, film_2, depth, FULL) - law.limit(film_1, film_2, joint, FULL)
        assert np.all(np.abs(step) <= steepest * np.abs(depth - joint) + 1e-12 * law.hardness)


@given(laws_of("plasticity"), films, films, depths, depths)
def test_a_pressure_limit_rises_with_depth_and_falls_with_film(law, film_1, film_2, depth, deeper):
    found = law.limit(film_1, film_2, depth, FULL)
    rounding = 1e-12 * law.hardness
    assert np.all(law.limit(film_1, film_2, depth + deeper, FULL) >= found - rounding)
    assert np.all(law.limit(film_1 + deeper, film_2, depth, FULL) <= found + rounding)
    assert np.all(law.limit(film_1, film_2 + deeper, depth, FULL) <= found + rounding)


@given(laws_of("plasticity"), films, films, depths, arrays(float, SHAPE, elements=st.floats(0.0, 1.0)))
def test_a_film_that_hardens_bears_at_its_depth_what_presses_it_in(law, film_1, film_2, depth, share):
    first, second, slope = law.hardening(film_1, film_2, depth, FULL)
    assert np.array_equal(first, law.limit(film_1, film_2, depth, FULL))
    assert np.all((first <= second) & (second <= law.hardness))
    pressure = first + share * (law.hardness - first)
    pressed = slope * (np.maximum(pressure - first, 0.0) + np.maximum(pressure - second, 0.0))
    assert law.limit(film_1, film_2, depth + pressed, FULL) == approx(pressure, rel=1e-9)


@given(laws_of("plasticity"), films, films, depths, depths)
def test_both_bodies_take_an_overlap_whatever_their_order(law, film_1, film_2, depth, overlap):
    first, second = law.shares(film_1, film_2, depth, overlap)
    assert np.all((first >= 0.0) & (second >= 0.0))
    assert first + second == approx(overlap, rel=1e-12, abs=1e-300)
    swapped = law.shares(film_2, film_1, depth, overlap)
    assert np.stack(swapped) == approx(np.stack((second, first)), rel=1e-9, abs=1e-20)


@given(laws_of("boundary_friction"), pressures, covers, speeds)
def test_boundary_friction_opposes_sliding_and_vanishes_without_contact(law, pressure, cover, speed):
    found = law(pressure, cover, speed)
    assert is_field(found)
    assert np.array_equal(law(pressure, cover, -speed), -found)
    assert np.all(found * speed >= 0.0)
    assert not law(np.zeros(SHAPE), cover, speed).any()


masks = arrays(bool, SHAPE)
dissipations = arrays(float, SHAPE, elements=st.just(0.0) | st.floats(1.0, 1e12))
gaps = arrays(float, SHAPE, elements=st.floats(1e-9, 1e-6))


@given(laws_of("heat"), dissipations, gaps, masks, masks, speeds, speeds, temperatures, temperatures)
def test_all_heat_goes_into_the_bodies(law, heat, gap, solid, pressed, speed_1, speed_2, first, second):
    speed, inside = (speed_1, speed_2), solid | pressed
    found = law.temperatures(Rubbing(heat, gap, solid, inside, 4e-6, speed, (first, second), 0.14))
    assert found.solved
    total = heat.sum() * 4e-6**2
    assert found.into_1 + found.into_2 == approx(total, rel=1e-12, abs=1e-12 * abs(found.into_1))
    for surface in (found.surface_1, found.surface_2, found.film):
        assert np.shape(surface) in ((), SHAPE)
        assert np.all(np.isfinite(surface))


@given(laws_of("heat"), dissipations, gaps, masks, masks, speeds, speeds, temperatures)
def test_friction_only_warms(law, heat, gap, solid, pressed, speed_1, speed_2, bulk):
    sides = gap, solid, solid | pressed, 4e-6, (speed_1, speed_2), (bulk, bulk), 0.14
    found, nothing = law.temperatures(Rubbing(heat, *sides)), law.temperatures(Rubbing(np.zeros(SHAPE), *sides))
    quadrature = 1e-4 * np.ptp(found.film) + 1e-12 * bulk  # of a source that moves fast
    for surface in (found.surface_1, found.surface_2, found.film):
        assert np.all(surface >= bulk - quadrature)
    assert found.flash_rise >= 0.0
    assert (nothing.surface_1, nothing.surface_2, nothing.film) == (bulk, bulk, bulk)
    assert (nothing.into_1, nothing.into_2, nothing.flash_rise) == (0.0, 0.0, 0.0)


heats = st.tuples(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3))
pairs = st.tuples(temperatures, temperatures)
steps = st.floats(1e-3, 1e5)


@given(laws_of("heat"), st.floats(1e-7, 1e-3), st.floats(0.0, 1e9), speeds, speeds)
def test_bodies_conduct_heat_away_the_better_the_faster_they_move(law, size, shear, speed_1, speed_2):
    assert law.spot_rise(size, shear, speed_1) >= 0.0
    radius, pair = np.full(3, size), (np.full(3, speed_1), np.full(3, speed_2))
    for conductances in (law.conductances, lambda a, u: law.strip_conductances(a, 100.0 * size, u)):
        slow, fast = conductances(radius, pair), conductances(radius, tuple(2.0 * speed for speed in pair))
        assert all(np.all((one > 0.0) & (one <= two)) for one, two in zip(slow, fast, strict=True))


@given(laws_of("rheology"), st.floats(1e-9, 1e-5), st.floats(0.0, 10.0), st.floats(1e-4, 10.0), st.floats(-2.0, 2.0))
def test_an_oil_that_thins_has_a_thinner_film(law, film, speed, viscosity, slide_roll_ratio):
    factor = law.film_factor(film, speed, viscosity, slide_roll_ratio)
    assert 0.0 <= factor <= 1.0
    assert factor == 1.0 or law.thins


@given(laws_of("supply"), st.floats(1e-9, 1e-5))
def test_only_a_supply_that_starves_makes_a_film_thinner(law, flooded):
    film = law.film(flooded, 1e-4, 1e-2, 3.0)
    assert 0.0 < film <= flooded * (1.0 + 1e-12)
    assert film == flooded or law.starves


@given(laws_of("bulk"), pairs, heats, temperatures, steps, steps)
def test_bulk_temperatures_after_two_steps_are_those_after_their_sum(law, bodies, heat, oil, first, second):
    stored = law.bodies(oil, bodies, bodies)
    by_steps = law.after(law.after(stored, heat, oil, first), heat, oil, second)
    at_once = law.after(stored, heat, oil, first + second)
    assert np.all(np.isfinite(at_once))
    assert by_steps == approx(at_once, rel=1e-12)


@given(laws_of("bulk"), temperatures)
def test_bodies_without_heat_stay_as_warm_as_the_oil(law, oil):
    assert law.bodies(oil, (None, None), None) == (oil, oil)
    assert law.after((oil, oil), (0.0, 0.0), oil, 1e3) == (oil, oil)


@given(laws_of("wear"), pressures, covers, speeds, speeds, st.sampled_from((0, 1)))
def test_wear_only_removes_and_needs_pressure_and_sliding(law, pressure, cover, speed_1, speed_2, body):
    found = law.rate(pressure, cover, (speed_1, speed_2), body, 6e9, FULL)
    assert is_field(found)
    assert np.all(found >= 0.0)
    assert not law.rate(np.zeros(SHAPE), cover, (speed_1, speed_2), body, 6e9, FULL).any()
    assert not law.rate(pressure, cover, (0.0, 0.0), body, 6e9, FULL).any()
    if getattr(law, "sliding", "difference") == "difference":
        assert not law.rate(pressure, cover, (speed_1, speed_1), body, 6e9, FULL).any()


@given(laws_of("wear"), pressures, covers, speeds, speeds, st.sampled_from((0, 1)))
def test_a_wear_rate_is_that_of_its_coefficient_and_its_sliding(law, pressure, cover, speed_1, speed_2, body):
    found = law.rate(pressure, cover, (speed_1, speed_2), body, 6e9, FULL)
    coefficient, slide = law.coefficient(cover, FULL), law.slide((speed_1, speed_2), body)
    assert is_field(coefficient)
    assert np.all((coefficient >= 0.0) & (coefficient <= 1.0))
    assert slide >= 0.0
    assert found == approx(coefficient * pressure * slide / 6e9, rel=1e-12, abs=0.0)


shears = arrays(float, SHAPE, elements=st.floats(0.0, 1e9))


@given(laws_of("tribofilm"), pressures, shears, speeds, temperatures)
def test_a_tribofilm_is_exposed_by_sliding_alone_and_more_so_by_more_stress_or_heat(law, pressure, shear, speed, warm):
    found = law.exposure(pressure, shear, speed, warm)
    assert is_field(found)
    assert np.all(found >= 0.0)
    assert np.array_equal(law.exposure(pressure, shear, -speed, warm), found)
    assert not law.exposure(pressure, shear, 0.0, warm).any()
    assert not law.exposure(np.zeros(SHAPE), np.zeros(SHAPE), speed, warm).any()
    assert np.all(law.exposure(pressure, 2.0 * shear, speed, warm) >= found)
    assert np.all(law.exposure(2.0 * pressure, shear, speed, warm) >= found)
    assert np.all(law.exposure(pressure, shear, speed, warm + 5.0) >= found)
    assert law.dose in ("clock", "contact_length", "residence")


@given(laws_of("tribofilm"), pressures, shears, speeds, arrays(float, SHAPE, elements=temperatures))
def test_a_field_of_temperatures_exposes_each_node_by_its_own(law, pressure, shear, speed, warm):
    found = law.exposure(pressure, shear, speed, warm)
    node = (1, 2)
    alone = law.exposure(pressure, shear, speed, float(warm[node]))
    assert found[node] == approx(alone[node], rel=1e-12, abs=0.0)


positions = arrays(float, (SHAPE[0], 1), elements=st.floats(0.0, 2.0))


@given(laws_of("tribofilm"), pressures, speeds, positions)
def test_rubbing_removes_a_tribofilm_in_proportion_to_pressure_and_not_less_at_the_edges(
    law, pressure, speed, position
):
    found, even = law.abrasion(pressure, speed, position), law.abrasion(pressure, speed, None)
    assert is_field(found)
    assert np.all(found >= even)
    assert np.all(even >= 0.0)
    assert np.array_equal(law.abrasion(pressure, speed, np.zeros_like(position)), even)
    assert law.abrasion(2.0 * pressure, -speed, position) == approx(2.0 * found, rel=1e-12, abs=1e-300)
    assert not law.abrasion(pressure, 0.0, position).any()
    assert law.abrades or not found.any()


@given(laws_of("tribofilm"), temperatures)
def test_a_tribofilm_law_refuses_what_its_constants_do_not_cover_unless_told_to_extrapolate(law, temperature):
    refused = law.refusal(temperature)
    assert not (refused and law.covers(temperature))
    if hasattr(law, "beyond_fit"):
        assert bool(refused) == (not law.covers(temperature) and law.beyond_fit == "refuse")


times = arrays(float, SHAPE, elements=st.floats(0.0, 1e5))
rates = arrays(float, SHAPE, elements=st.floats(0.0, 1.0))


@given(laws_of("tribofilm"), rates, rates, times, times, temperatures)
def test_a_tribofilm_after_two_times_is_that_after_their_sum(law, exposing, abrading, first, second, temperature):
    def rub(film, time):
        return law.evolve(*film, exposing * time, abrading * time, temperature)

    bare = np.zeros(SHAPE), np.zeros(SHAPE)
    step, whole = rub(rub(bare, first), second), rub(bare, first + second)
    used_up = bool(np.any(abrading)) and not grows_faster_than_it_loses(law, temperature)  # nothing is left to rub
    for by_steps, at_once in zip(step, whole, strict=True):
        assert is_field(by_steps)
        assert used_up or np.allclose(by_steps, at_once, rtol=0.0, atol=1e-12 * 1e-6)
        assert np.all(by_steps >= 0.0)


@given(laws_of("tribofilm"), times, times, temperatures)
def test_a_tribofilm_stays_between_nothing_and_its_full_thickness(law, exposed, abraded, temperature):
    zero = np.zeros(SHAPE)
    film = thickness(*law.evolve(zero, zero, exposed, abraded, temperature))
    assert np.all((film >= 0.0) & (film <= law.full_thickness))


@given(laws_of("tribofilm"), times, times, temperatures)
def test_what_is_rubbed_off_leaves_a_thinner_tribofilm(law, exposed, abraded, temperature):
    zero = np.zeros(SHAPE)
    kept = thickness(*law.evolve(zero, zero, exposed, zero, temperature))
    left = thickness(*law.evolve(zero, zero, exposed, abraded, temperature))
    if grows_faster_than_it_loses(law, temperature):
        assert np.all(left <= kept * (1.0 + 1e-12))
    assert law.takes_abrasion or np.array_equal(left, kept)


def grows_faster_than_it_loses(law: Any, temperature: float) -> bool:
    """With a removal of its own: such a film is never used up by that, neither at first nor in the end."""
    bare = np.zeros(1)
    found = [law.evolve(bare, bare, np.full(1, exposed), bare, temperature) for exposed in (1e-9, 1e9)]
    return all(growth[0] >= removal[0] for growth, removal in found)


@given(laws_of("tribofilm"), rates, rates, times, times, temperatures)
def test_the_ledger_of_a_tribofilm_closes_and_is_the_same_for_any_splitting(
    law, exposing, abrading, first, second, temperature
):
    def rub(film, time):
        dose = exposing * time, abrading * time, temperature
        after = law.evolve(*film, *dose)
        return after, law.formed(*film, after[0], *dose)

    bare = np.zeros(SHAPE), np.zeros(SHAPE)
    half, grown = rub(bare, first)
    end, more = rub(half, second)
    _, at_once = rub(bare, first + second)
    assert is_field(grown)
    if not grows_faster_than_it_loses(law, temperature):
        return
    least, removed = -1e-12 * 1e-6, grown + more - thickness(*end)
    assert np.all(grown >= least)
    assert np.all(more >= least)
    assert np.all(grown - thickness(*half) >= least)
    assert np.all(removed - (grown - thickness(*half)) >= least - 1e-12 * np.abs(at_once))
    assert np.allclose(grown + more, at_once, rtol=1e-11, atol=1e-12 * 1e-6)


oxides = arrays(float, SHAPE, elements=st.just(0.0) | st.floats(1e-12, 1e-8))
losses = arrays(float, SHAPE, elements=st.just(0.0) | st.floats(1e-16, 1e-8))  # m/s
lapses = st.floats(0.0, 1e3)


@given(laws_of("oxide"), oxides, losses, losses, lapses, lapses)
def test_an_oxide_after_two_times_is_that_after_their_sum_and_what_is_rubbed_off_has_been_there(
    law, oxide, growing, rubbing, first, second
):
    def rub(oxide, time):
        return law.evolve(oxide, growing * time, rubbing * time)

    half, lost = rub(oxide, first)
    end, more = rub(half, second)
    at_once, altogether = rub(oxide, first + second)
    for field in (half, lost, end, more):
        assert is_field(field)
        assert np.all(field >= 0.0)
    size = np.max(oxide) + 1e-9
    assert np.allclose(end, at_once, rtol=1e-10, atol=1e-11 * size)
    assert np.allclose(lost + more, altogether, rtol=1e-9, atol=1e-11 * size)
    assert np.all(altogether <= rubbing * (first + second) * (1.0 + 1e-9) + 1e-11 * size)
    assert np.all(altogether <= oxide + growing * (first + second) + 1e-11 * size)  # what was there and what can grow


@given(laws_of("oxide"), films, oxides, pressures, speeds, st.floats(273.0, 450.0), covers, st.floats(0.0, 0.5))
def test_an_oxide_grows_where_tribofilms_are_thin_is_worn_by_sliding_and_bears_at_most_all(
    law, film, oxide, pressure, speed, warm, cover, bare
):
    left_open, borne = law.left_open(film), law.cover(oxide)
    assert np.all((left_open >= 0.0) & (left_open <= 1.0))
    assert np.all(law.left_open(2.0 * film) <= left_open)
    assert np.all((borne >= 0.0) & (borne <= 1.0))
    assert law.growth(warm + 5.0) >= law.growth(warm) >= 0.0
    assert not np.any(law.removal(pressure, 0.0))
    assert np.all(law.removal(pressure, speed) >= 0.0)
    assert law.volume_ratio > 0.0
    assert not np.any(law.added_friction(bare, np.zeros(SHAPE), cover))
    assert not np.any(law.added_friction(bare, borne, np.ones(SHAPE)))
    assert law.grows or not np.any(law.evolve(0.0 * oxide, oxide, oxide)[0])


@given(laws_of("wear"), pressures, covers, speeds, speeds, st.sampled_from((0, 1)))
def test_wear_of_the_solid_never_rises_with_the_film_and_that_of_the_film_is_in_proportion_to_pressure(
    law, pressure, cover, speed_1, speed_2, body
):
    taken = law.film_removal(pressure, (speed_1, speed_2), body, 2e9, FULL)
    assert np.all(np.asarray(taken) >= 0.0)
    assert np.any(taken) <= law.wears_film
    doubled = law.film_removal(2.0 * pressure, (-speed_1, -speed_2), body, 2e9, FULL)
    assert np.asarray(doubled) == approx(2.0 * np.asarray(taken), rel=1e-12, abs=1e-300)
    if law.wears_film:
        assert np.all(law.coefficient(cover, FULL) <= law.coefficient(0.5 * cover, FULL))


amplitudes = arrays(float, SHAPE, elements=st.just(0.0) | st.floats(1e-300, 1e12))
hydrostatics = arrays(float, SHAPE, elements=st.floats(-1e12, 1e12))


@given(laws_of("fatigue"), amplitudes, hydrostatics, hydrostatics, st.floats(1.0, 10.0))
def test_a_cycle_takes_a_share_of_a_life_that_no_greater_stress_makes_smaller(law, shear, mean, dang_van, more):
    found = law.per_cycle(Cycle(shear, mean, dang_van))
    assert is_field(found)
    assert np.all((found >= 0.0) & (found <= 1.0))
    assert law.damages or not np.any(found)
    assert np.all(law.per_cycle(Cycle(more * shear, mean, np.maximum(dang_van, more * dang_van))) >= found)


@given(laws_of("fatigue"), hydrostatics)
def test_a_cycle_without_shear_or_under_pressure_alone_damages_nothing(law, mean):
    assert not np.any(law.per_cycle(Cycle(np.zeros(SHAPE), mean, -np.abs(mean))))


@given(laws_of("scuffing"), st.floats(230.0, 900.0), st.floats(0.0, 100.0), temperatures)
def test_the_risk_of_scuffing_is_finite_grows_with_the_contact_and_passes_one_where_it_is_hotter_than_critical(
    law, contact, hotter, oil
):
    risk, more = law.ratio(contact, oil), law.ratio(contact + hotter, oil)
    assert 0.0 <= risk <= more < np.inf
    if not law.judges:
        assert more == 0.0
        return
    assert law.ratio(law.temperature, oil) == 1.0
    assert (risk > 1.0) == (contact > law.temperature)
