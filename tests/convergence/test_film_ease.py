"""Oil that flows more easily than its viscosity says, node by node: every route feels it as it feels a thinner oil."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from comparison import approx
from scipy.ndimage import gaussian_filter

from contact_core.film.fitted import fitted_grid
from contact_core.film.instant import Instant, Settings, Step
from contact_core.film.routes import _Solver, coarser, solve_film
from contact_core.film.scaled import Scaled
from contact_core.kernels.multigrid.cycle import is_applicable, is_symmetric
from contact_core.laws.density import DowsonHigginson
from contact_core.laws.viscosity import Roelands
from contact_core.reference import SmoothContact, nijenbanning_venner_moes
from contact_core.shapes import Point

RADIUS, MODULUS, ALPHA, HARDNESS = 10e-3, 230.47e9, 15e-9, 6e9
SETTINGS = Settings(1e-9, 1e-4, 400, "pyfftw")
EASIER = 2.0  # a power of two: exact in every product


@dataclass(frozen=True)
class Thinner:
    """A law of viscosity divided by a constant."""

    law: Roelands
    by: float

    def __call__(self, pressure, temperature):
        return self.law(pressure, temperature) / self.by


def contact(rq=0.0, load=20.0, nodes=65, viscosity=0.02, speed=1.0):
    film = nijenbanning_venner_moes(SmoothContact(load, speed, viscosity, ALPHA, RADIUS, RADIUS, MODULUS))
    grid = fitted_grid(Point(RADIUS, RADIUS), load, MODULUS, film, nodes, nodes)
    z = gaussian_filter(np.random.Generator(np.random.Philox(1)).standard_normal(grid.shape), 1.5)
    z *= rq / z.std()
    law, limit = Roelands(viscosity, 300.0, ALPHA, 0.0), np.full(grid.shape, HARDNESS)
    now = Instant(load, speed, 300.0, Point(RADIUS, RADIUS), MODULUS, law, DowsonHigginson(), z, limit, HARDNESS)
    return now, grid


def two_ways(now, factor=EASIER):
    """The instant of an oil that flows `factor` times more easily, and that of an oil so many times less viscous."""
    eased = replace(now, ease=np.full(now.heights.shape, factor))
    return eased, replace(now, viscosity=Thinner(now.viscosity, factor))


ROUTES = [
    ("multigrid", "none", 0.0, 20.0),
    ("hybrid", "shared", 0.0, 20.0),
    ("newton", "film", 0.0, 20.0),
    ("multigrid", "none", 0.0, 0.05),  # a light load, with what lies beyond the grid
    ("newton", "film", 30e-9, 0.05),
    ("hybrid", "shared", 200e-9, 20.0),
    ("newton", "film", 100e-9, 20.0),
]


@pytest.mark.parametrize(("method", "start", "rq", "load"), ROUTES)
def test_an_easier_flow_is_that_of_a_thinner_oil_to_the_last_bit(method, start, rq, load):
    # thick enough for 33 nodes, of which multigrid makes nothing
    now, grid = contact(rq, load, nodes=65 if method == "multigrid" else 33, speed=4.0)
    instants = (*two_ways(now), now)
    eased, thinner, plain = (_Solver(Scaled(each, grid, SETTINGS), None, None).run(method, start) for each in instants)
    assert eased.converged
    for field in ("pressure", "fluid", "solid"):
        assert (getattr(eased.iterate, field) == getattr(thinner.iterate, field)).all()
    assert (eased.gap == thinner.gap).all()
    assert (eased.mass == thinner.mass).all()
    assert eased.gap.min() != plain.gap.min()


@pytest.mark.parametrize("method", ["hybrid", "newton"])
@pytest.mark.parametrize("rq", [0.0, 100e-9])
def test_a_time_step_feels_it_the_same_way(method, rq):
    now, grid = contact(rq, nodes=33)
    start = solve_film(now, grid, SETTINGS).state
    instants, step = (*two_ways(now), now), Step(2e-6, 1)
    eased, thinner, plain = (
        _Solver(Scaled(each, grid, SETTINGS, start, step), start, step).run(method, "before") for each in instants
    )
    assert np.isfinite(eased.pressure_change)
    assert (eased.iterate.pressure == thinner.iterate.pressure).all()
    assert (eased.mass == thinner.mass).all()
    assert (eased.iterate.pressure != plain.iterate.pressure).any()


def test_films_against_x_and_of_the_lumped_criterion_feel_it_the_same_way():
    now, grid = contact(100e-9)
    for settings in (SETTINGS, replace(SETTINGS, lumped=True, floor=0.47e-9, tolerance=1e-3)):
        back = replace(now, entrainment_speed=-now.entrainment_speed)
        eased, thinner = (solve_film(each, grid, settings) for each in two_ways(back))
        assert eased.route == "mixed"
        assert (eased.gap == thinner.gap).all()
        assert (eased.state.ease == EASIER).all()


def test_factors_that_are_no_power_of_two_agree_to_round_off():
    now, grid = contact()
    eased, thinner = (solve_film(each, grid, SETTINGS) for each in two_ways(now, 1.7))
    assert eased.converged
    assert eased.gap == approx(thinner.gap, rel=1e-9)


class Slipping(Thinner):
    """A law whose fluidity [1/(Pa s)] is higher by a constant."""

    def __call__(self, pressure, temperature):
        return 1.0 / (1.0 / self.law(pressure, temperature) + self.by)


@pytest.mark.parametrize(("method", "start", "rq", "load"), [ROUTES[k] for k in (0, 1, 2, 4, 5)])
def test_what_shear_adds_to_the_fluidity_is_felt_as_that_of_another_oil(method, start, rq, load):
    now, grid = contact(rq, load, speed=2.0)
    more = 0.5 / now.viscosity.viscosity
    thinned = replace(now, thinned=np.full(grid.shape, more))
    instants = (thinned, replace(now, viscosity=Slipping(now.viscosity, more)), now)
    mine, other, plain = (_Solver(Scaled(each, grid, SETTINGS), None, None).run(method, start) for each in instants)
    films = [
        found.gap * Scaled(each, grid, SETTINGS).h_unit
        for found, each in zip((mine, other, plain), instants, strict=True)
    ]
    assert mine.converged
    assert other.converged
    centre = np.s_[24:40, 32:44]
    assert films[0][centre].mean() == approx(films[1][centre].mean(), rel=1e-3)
    assert abs(films[0][centre].mean() / films[2][centre].mean() - 1.0) > 0.02


def easier_before_the_contact(grid, tilt=0.0):
    """An ease that rises threefold toward the inlet, and along y by `tilt`."""
    across = 1.0 + tilt * grid.y[:, None] / grid.y[-1]
    return across * (2.0 - np.tanh(grid.x / (0.2 * grid.x[-1])))[None, :]


def test_all_algorithms_find_the_same_film_of_an_uneven_ease():
    now, grid = contact(speed=4.0)
    now = replace(now, ease=easier_before_the_contact(grid))
    solver = _Solver(Scaled(now, grid, SETTINGS), None, None)
    solver.best = solver.run("multigrid", "none")
    others = (("hybrid", "last"), ("newton", "film"))
    found = [solver.best, *(solver.run(*way) for way in others)]
    assert all(solution.converged for solution in found)
    for solution in found[1:]:
        assert solution.gap[32, 32] == approx(found[0].gap[32, 32], rel=1e-3)
        difference = np.abs(solution.iterate.pressure - found[0].iterate.pressure).sum()
        assert difference < 5e-3 * found[0].iterate.pressure.sum()


def test_an_ease_that_differs_on_both_sides_is_solved_on_the_whole_grid():
    now, grid = contact(speed=4.0)
    even, uneven = (replace(now, ease=easier_before_the_contact(grid, tilt)) for tilt in (0.0, 0.3))
    problems = [Scaled(each, grid, SETTINGS).problem() for each in (even, uneven)]
    assert [is_symmetric(problem) for problem in problems] == [True, False]
    assert is_applicable(problems[1])
    solver = _Solver(Scaled(uneven, grid, SETTINGS), None, None)
    found, newton = solver.run("multigrid", "none"), solver.run("newton", "film")
    assert found.converged
    assert newton.converged
    assert np.abs(found.gap - found.gap[::-1]).max() > 0.02 * found.gap.min()
    assert found.gap[32, 32] == approx(newton.gap[32, 32], rel=1e-3)


def test_the_mirror_and_the_coarser_grid_take_the_ease_along():
    now, grid = contact()
    now = replace(now, ease=easier_before_the_contact(grid, 0.3))
    now = replace(now, thinned=now.ease**2)
    assert (now.mirrored().ease == now.ease[:, ::-1]).all()
    assert (now.mirrored().thinned == now.thinned[:, ::-1]).all()
    assert (coarser(now, grid)[0].ease == now.ease[::2, ::2]).all()
    assert (coarser(now, grid)[0].thinned == now.thinned[::2, ::2]).all()
    state = solve_film(now, grid, SETTINGS).state
    assert (state.mirrored().ease == now.ease[:, ::-1]).all()
    assert (state.mirrored().thinned == now.thinned[:, ::-1]).all()
