"""Smooth lines that get too little oil: rigid rollers in closed form, and oil that comes in, goes through and out."""

import numpy as np
import pytest
from comparison import approx
from sliders import ParabolicSlider

from contact_core import line_contact
from contact_core.kernels.half_space import PeriodicHalfSpace
from contact_core.kernels.mixed.newton import solve_newton
from contact_core.kernels.mixed.problem import Iterate, Problem

GAP = 0.1  # of the rigid roller of unit radius; oil such that the pressure flow is h^3 dp/dx
GRIDS = (129, 257, 513, 1025)
LINE = {
    "load": 2e5, "radius": 0.01, "reduced_modulus": 2.3e11, "speed_1": 0.2, "speed_2": 0.2, "viscosity": 0.03,
    "pressure_viscosity": 1.8e-8,
}  # fmt: skip


def slider(part):
    """The rigid roller behind a supply, in parts of the gap, or flooded from -2.5 on."""
    if part is None:
        return ParabolicSlider(GAP, 1.0, 1.0 / 12.0, 1.0, -2.5)
    return ParabolicSlider.supplied(part * GAP, GAP, 1.0, 1.0 / 12.0, 1.0)


def rigid(exact, n, supply, shift):
    """One row of n nodes under the load of the closed solution, begun with a gap that is too large by `shift`."""
    x = np.linspace(-2.5, 1.5, n)
    shape, dx = (3, n), x[1] - x[0]
    ones, none, weight = np.ones(shape), np.zeros(shape), np.zeros(shape)
    weight[1] = 1.0
    problem = Problem(
        undeformed=np.tile(0.5 * x**2, (3, 1)),
        cap=1e9 * ones,
        floor=1e-4,
        spacing=dx,
        load=exact.load / dx,
        mobility=ones,
        thinned=none,
        per_dt=0.0,
        wedge=1.0,
        mass_old=none,
        fluidity=np.ones(2),
        density=np.ones(2),
        step=1e9,
        compliance=1e-12,
        edge=none,
        weight=weight,
        wrapped=True,
        conserving=True,
        supply=supply,
    )
    start = np.tile(np.maximum(0.25 - x**2, 0.0), (3, 1))
    start *= problem.load / start[1].sum()
    begin = Iterate(start, start.copy(), np.zeros(shape, np.bool_), GAP + shift)
    return x, solve_newton(PeriodicHalfSpace(1, n, 1e-14, "scipy"), problem, begin, 1e-10, 200)


@pytest.mark.parametrize("part", [None, 1.2, 1.1, 1.02])
def test_gap_pressure_and_oil_of_a_rigid_roller_converge_to_the_closed_solution(part):
    """`part`: supply over gap; flooded at 1.226."""
    exact, errors = slider(part), []
    for n in GRIDS:
        x, found = rigid(exact, n, None if part is None else part * GAP, 0.02)
        assert found.converged, found.shortfall
        p, pressure, oil = found.iterate.pressure[1], exact.pressure(x), found.mass[1]
        errors.append((np.abs(p - pressure).mean() / pressure.max(), abs(found.iterate.rigid / GAP - 1.0)))
        assert oil[-3] == approx(exact.film, rel=1e-10 if part else 0.01)
        if part is not None:
            full = x[p > 0.0]
            assert abs(full[0] - exact.inlet) < 0.03
            assert abs(full[-1] - exact.outlet) < 0.05
            assert oil[3] == approx(exact.film, rel=1e-10)
    coarse, fine = np.array(errors[0]), np.array(errors[-1])
    assert (np.log(coarse / fine) / np.log((GRIDS[-1] - 1) / (GRIDS[0] - 1))).min() > 1.8
    assert fine.max() < 2e-4


def test_the_film_does_not_depend_on_the_start():
    exact = slider(1.1)
    one, two = (rigid(exact, 257, 1.1 * GAP, shift)[1] for shift in (0.0, 0.1))
    assert one.iterate.pressure == approx(two.iterate.pressure, abs=1e-7 * one.iterate.pressure.max())
    assert one.mass == approx(two.mass, rel=1e-7)


@pytest.fixture(scope="module")
def flooded():
    return line_contact(**LINE)


@pytest.mark.parametrize("part", [0.05, 0.2, 0.5, 0.8, 1.0, 1.1, 1.2, 1.5, 2.0, 3.0])
def test_what_comes_in_goes_through_up_to_the_flooded_film(flooded, part):
    """`part`: supply over the flooded film, through which more flows than that, as it is denser."""
    supply, middle = part * flooded.h_central, np.abs(flooded.x).argmin()
    density = float(flooded.oil[0, middle] / flooded.film[0, middle])
    found = line_contact(**LINE, cavitation="mass_conserving", supply=supply)
    assert found.converged, found.shortfall
    assert found.h_central == approx(min(supply / density, flooded.h_central), rel=3e-3)
    through = min(supply, density * flooded.h_central)
    assert found.oil[0, -5:-1] == approx(through, rel=1e-3 if through == supply else 3e-3)


def test_a_near_meniscus_starves_a_line_and_a_far_one_does_not(flooded):
    half_width = np.sqrt(8.0 * 2e5 * 0.01 / np.pi / 2.3e11)
    films = [line_contact(**LINE, meniscus=part * half_width) for part in (1.02, 1.05, 1.1, 1.2, 1.5, 3.0)]
    assert all(found.converged for found in films)
    central = [found.h_central / flooded.h_central for found in films]
    assert (np.diff(central) > 0.0)[:-1].all()
    assert central[0] < 0.5
    assert central[-1] == approx(1.0, abs=2e-3)
