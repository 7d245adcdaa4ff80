"""Cavitation and supply of oil, from a scene or a call to the kernels."""

from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from wavy_contact import problem

from contact_core import OperatingPointError, Scene, SceneError, advance, initial_state, point_contact
from contact_core.deterministic.instant import instant_of
from contact_core.film.instant import Grid, Settings
from contact_core.film.scaled import Scaled
from contact_core.kernels.mixed.fixed_point import solve_mixed
from contact_core.kernels.mixed.newton import solve_newton
from contact_core.kernels.mixed.problem import Iterate
from contact_core.kernels.multigrid.cycle import is_applicable
from contact_core.laws.supply import Flooded, Meniscus, SupplyFilm
from contact_core.scene import Case

CONSERVING = {"lubricant.cavitation": "mass_conserving"}
FILM = {"lubricant.supply": "film", "lubricant.supply.thickness": "50 nm"}
INLET = {"lubricant.supply": "meniscus", "lubricant.supply.distance": "160 um"}
CALL = {
    "load": 50.0, "radius_x": 0.01, "reduced_modulus": 2.2e11, "speed_1": 1.0, "speed_2": 1.0, "viscosity": 0.05,
    "pressure_viscosity": 2e-8, "grid": 33,
}  # fmt: skip


def scaled_of(changes):
    scene = Scene.from_toml("mtm_zddp", changes)
    grid = Grid.centred(65, 65, 8e-6)
    now = instant_of(Case(scene, scene.operation.point), np.zeros(grid.shape), np.full(grid.shape, 1e12))
    return Scaled(now, grid, Settings(1e-9, 1e-3, 100, "scipy"))


def test_a_scene_is_flooded_and_its_cavities_are_full_unless_it_says_otherwise():
    lubricant = Scene.from_toml("mtm_zddp").lubricant
    assert lubricant.supply == Flooded()
    assert lubricant.cavitation == "reynolds"
    case = scaled_of({}).problem()
    assert not case.conserving
    assert case.supply is None
    assert case.first == 0


def test_supply_and_cavitation_of_a_scene_reach_the_kernels():
    film, inlet = scaled_of(CONSERVING | FILM), scaled_of(INLET)
    assert film.problem().conserving
    assert film.problem().supply * film.h_unit == approx(50e-9)
    assert film.smooth_film < scaled_of({}).smooth_film
    assert not inlet.problem().conserving
    assert inlet.grid.x[inlet.problem().first - 1] == approx(-160e-6, abs=0.51 * inlet.grid.spacing)
    assert inlet.smooth_film < scaled_of({}).smooth_film
    assert Scene.from_toml("mtm_zddp", INLET).lubricant.supply == Meniscus(160e-6)
    assert Scene.from_toml("mtm_zddp", CONSERVING | FILM).lubricant.supply == SupplyFilm(50e-9)


def test_a_scene_with_a_supply_survives_the_way_through_a_table():
    scene = Scene.from_toml("mtm_zddp", CONSERVING | FILM)
    assert Scene.from_dict(scene.to_dict()) == scene


def test_a_supply_film_without_mass_conservation_is_refused():
    with pytest.raises(SceneError, match=r"lubricant.supply.thickness = 5e-08 m needs lubricant.cavitation"):
        Scene.from_toml("mtm_zddp", FILM)
    with pytest.raises(OperatingPointError, match="supply = 5e-08 m needs cavitation"):
        point_contact(**CALL, supply=5e-8)
    with pytest.raises(OperatingPointError, match="cavitation = 'jfo' is not one of"):
        point_contact(**CALL, cavitation="jfo")


@pytest.mark.parametrize("speed", [1.0, -1.0])
def test_a_call_takes_supply_and_meniscus_on_the_side_where_oil_comes_in(speed):
    call = CALL | {"speed_1": speed, "speed_2": speed, "domain": (-5e-4, 5e-4, -5e-4, 5e-4)}
    flooded = point_contact(**call)
    starved = point_contact(**call, cavitation="mass_conserving", supply=0.3 * flooded.h_central)
    inlet = point_contact(**call, meniscus=2.2e-4)
    assert starved.h_central == approx(0.3 * flooded.h_central, rel=0.3)
    assert starved.h_central < inlet.h_central < flooded.h_central
    before = np.sign(speed) * inlet.x < -2.3e-4
    assert before.any()
    assert not inlet.pressure[:, before].any()
    assert flooded.pressure[:, before].any()


def test_a_starved_film_is_thinner_at_the_regression_level_too():
    films = []
    for changes in ({}, CONSERVING | FILM, INLET):
        scene = Scene.from_toml("mtm_zddp", changes).at_level("regression")
        films.append(advance(scene, scene.operation.point, initial_state(scene), 1.0)[1].lambda_ratio)
    assert films[1] <= films[0]
    assert films[2] < films[0]


def start(case, smooth, lift=0.15):
    pressure = smooth * (case.load / smooth.sum())
    return Iterate(pressure, pressure.copy(), np.zeros(smooth.shape, np.bool_), lift - 1.0)


def test_a_flooded_film_without_reformation_is_the_same_with_and_without_conservation():
    case, smooth, half_space = problem(33, 33, 0.0)
    plain = solve_newton(half_space, case, start(case, smooth), 1e-8, 200)
    kept = solve_newton(half_space, replace(case, conserving=True), start(case, smooth), 1e-8, 200)
    assert plain.converged
    assert kept.converged
    assert kept.iterate.pressure == approx(plain.iterate.pressure, abs=1e-5)
    cavity = (kept.iterate.pressure <= 0.0) & (np.arange(33) > 20)
    assert (kept.mass[cavity] < plain.mass[cavity]).mean() > 0.9


@pytest.mark.parametrize("changes", [{"conserving": True, "supply": 0.1}, {"first": 14}])
def test_hybrid_and_newton_find_the_same_starved_film(changes):
    case, smooth, half_space = problem(33, 33, 0.0)
    case = replace(case, **changes)
    one = solve_mixed(half_space, case, start(case, smooth), 1e-7, 2000)
    assert one.converged
    other = solve_newton(half_space, case, start(case, smooth), 1e-7, 300)
    assert other.converged
    assert one.iterate.pressure == approx(other.iterate.pressure, abs=1e-4)
    assert one.iterate.rigid == approx(other.iterate.rigid, abs=1e-4)


def test_multigrid_knows_neither_cavities_nor_a_meniscus():
    case, _, _ = problem(33, 33, 0.0)
    assert is_applicable(case)
    assert not is_applicable(replace(case, conserving=True))
    assert not is_applicable(replace(case, first=5))


def test_no_oil_presses_before_the_meniscus_but_solids_may_touch_there():
    case, smooth, half_space = problem(49, 49, 0.04, mobility=1e4)
    for conserving in (False, True):
        changed = replace(case, first=20, conserving=conserving)
        found = solve_mixed(half_space, changed, start(case, smooth), 1e-2, 300)
        assert found.load_error == approx(0.0, abs=1e-4)
        before = found.iterate.fluid[:, :20]
        assert not before.any()
        assert found.iterate.pressure[:, :20].any()
        assert not found.iterate.pressure[:, :20][~found.iterate.solid[:, :20]].any()
