"""The apparent viscosity between charged surfaces: against quadrature, at its limits, in films and in friction."""

from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import cheap
from comparison import HARD, approx

from contact_core import Scene, SceneError, Transient, advance, initial_state, solve
from contact_core.laws.double_layer import Electroviscous
from contact_core.reference.constants import BOLTZMANN, ELEMENTARY_CHARGE, VACUUM_PERMITTIVITY

WATER = Electroviscous(
    zeta_energy=0.05 * ELEMENTARY_CHARGE, debye_length=5e-9, relative_permittivity=80.0, ion_radius=0.2e-9
)
OIL = Electroviscous(
    zeta_energy=0.025 * ELEMENTARY_CHARGE, debye_length=5e-9, relative_permittivity=2.2, ion_radius=2e-9
)
CHARGED = {
    "lubricant.double_layer.model": "electroviscous",
    "lubricant.double_layer.zeta_energy": "0.05 eV",
    "lubricant.double_layer.debye_length": "20 nm",
    "lubricant.double_layer.relative_permittivity": "80",
    "lubricant.double_layer.ion_radius": "0.5 nm",
}
SMOOTH = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "tribofilm.model": "none"} | HARD


def by_quadrature(law, gap, temperature, viscosity=1e-3):
    """Apparent over true viscosity: flow of an oil with charges in a slit, at the field that lets no current pass."""
    y = np.linspace(-0.5 * gap, 0.5 * gap, 20001)
    kappa, zeta = 1.0 / law.debye_length, law.zeta_energy / ELEMENTARY_CHARGE
    permittivity = law.relative_permittivity * VACUUM_PERMITTIVITY
    psi = zeta * np.cosh(kappa * y) / np.cosh(0.5 * kappa * gap)
    charge = -permittivity * kappa**2 * psi
    conductivity = permittivity * kappa**2 * BOLTZMANN * temperature / (6.0 * np.pi * viscosity * law.ion_radius)

    def flow(force):  # viscosity u'' = force, u = 0 on both sides
        first = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(y))])
        second = np.concatenate([[0.0], np.cumsum(0.5 * (first[1:] + first[:-1]) * np.diff(y))])
        return (second - second[-1] * (y - y[0]) / gap) / viscosity

    pushed, pulled = flow(np.ones_like(y)), flow(-charge)  # by a pressure gradient of 1 Pa/m, by a field of 1 V/m
    field = -np.trapezoid(charge * pushed, y) / (np.trapezoid(charge * pulled, y) + conductivity * gap)
    return float(-(gap**3) / (12.0 * viscosity) / np.trapezoid(pushed + field * pulled, y))


@pytest.mark.parametrize("law", [WATER, OIL], ids=["water", "oil"])
@pytest.mark.parametrize("gap", [1e-9, 5e-9, 15e-9, 50e-9, 300e-9])
def test_the_closed_form_is_the_flow_without_a_current(law, gap):
    assert float(law(np.array(gap), 353.0)) == approx(by_quadrature(law, gap, 353.0), rel=1e-5)


def test_the_effect_is_largest_where_double_layers_meet_and_gone_in_thick_and_in_far_thinner_films():
    gaps = np.geomspace(1e-12, 1e-4, 400)
    found = WATER(gaps, 353.0)
    assert found.min() >= 1.0
    assert found[0] == approx(1.0, abs=1e-6) and found[-1] == approx(1.0, abs=1e-6)
    assert 1.0 < gaps[found.argmax()] / WATER.debye_length < 6.0
    assert 1.2 < found.max() < 2.0
    assert OIL(gaps, 353.0).max() < 1.05  # an oil has few charges and little permittivity
    assert (replace(WATER, zeta_energy=0.0)(gaps, 353.0) == 1.0).all()


def test_series_and_closed_form_meet():
    below, above = (float(WATER(np.array(2.0 * 5e-9 * k), 353.0)) - 1.0 for k in (0.03 * (1 - 1e-9), 0.03 * (1 + 1e-9)))
    assert below == approx(above, rel=1e-6)


@pytest.mark.parametrize("flow", ["newtonian", "local"])
def test_charged_surfaces_have_a_thicker_film_and_more_friction_by_the_apparent_viscosity(flow):
    scene, state, op = cheap(SMOOTH | {"lubricant.flow": flow, "film.points": "65"}, operation__load="20 N")
    charged, _, _ = cheap(SMOOTH | CHARGED | {"lubricant.flow": flow, "film.points": "65"}, operation__load="20 N")
    op = replace(op, load=20.0)
    plain, thick = solve(scene, op, state), solve(charged, op, state)
    assert thick.converged
    nodes = plain.gap.shape[0] // 2, plain.gap.shape[1] // 2
    assert 1.02 < thick.gap[nodes] / plain.gap[nodes] < 1.5
    law, oil = charged.lubricant.double_layer, charged.lubricant
    viscosity = oil.viscosity(thick.fluid_pressure, op.temperature) * law(thick.gap, op.temperature)
    stress = oil.rheology(viscosity * abs(op.sliding_speed) / thick.gap, thick.fluid_pressure)
    assert thick.oil_shear == approx(stress, rel=1e-12)
    assert solve(charged, op, state, dry=True).gap == approx(solve(scene, op, state, dry=True).gap, rel=1e-12)


def test_a_march_carries_the_apparent_viscosity_along():
    scene, state, op = cheap(SMOOTH | CHARGED)
    steady = solve(scene, op, state)
    state = replace(state, film=steady.film)
    dt = scene.film.spacing / op.entrainment_speed
    for _ in range(5):
        fields = solve(scene, op, state, Transient(dt, 0, 200))
        state = replace(state, film=fields.film)
    assert state.film.ease.min() < 0.9
    middle = steady.gap.shape[0] // 2
    assert fields.gap[middle, middle] == approx(steady.gap[middle, middle], rel=0.03)


@pytest.mark.long
def test_blocks_of_rough_charged_surfaces_run():
    scene, state, op = cheap(control__mixed_instants=2, **{key.replace(".", "__"): v for key, v in CHARGED.items()})
    _, outputs = advance(scene, op, state, 30.0)
    plain, fresh, _ = cheap(control__mixed_instants=2)
    _, without = advance(plain, op, fresh, 30.0)
    assert outputs.contact_load_ratio < without.contact_load_ratio
    assert outputs.unconverged <= 0.5


def test_the_regression_level_says_that_it_leaves_them_out():
    scene = Scene.from_toml("azam_case_a", CHARGED).at_level("regression")
    plain = Scene.from_toml("azam_case_a").at_level("regression")
    assert any("double_layer" in sentence for sentence in scene.warnings())
    op = scene.operation.point
    assert advance(scene, op, initial_state(scene), 60.0)[1] == advance(plain, op, initial_state(plain), 60.0)[1]


def test_potentials_beyond_the_theory_are_refused():
    with pytest.raises(SceneError, match="zeta_energy"):
        Scene.from_toml("azam_case_a", CHARGED | {"lubricant.double_layer.zeta_energy": "0.1 eV"})
