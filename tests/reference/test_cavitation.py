"""Mass-conserving cavitation against the solution of Jakobsson, Floberg and Olsson in one dimension.

Rigid bearings of an incompressible, isoviscous oil over 0 < x < 1, in units in which the flow is h - h^3 dp/dx:

    full film: h - h^3 p' = Q;   rupture: p = 0, p' = 0, so that Q = h;   cavity: theta h = Q;   reformation: p = 0.

The pressure between two points is a combination of J_k = integral dx / h^k, in closed form; the front is the root of
one equation. The kernels find the gap that carries the exact load, so that the gap, too, has to come out right.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad
from scipy.optimize import brentq

from contact_core.kernels.half_space import HalfSpace
from contact_core.kernels.mixed.newton import solve_newton
from contact_core.kernels.mixed.problem import Iterate, Problem


@dataclass(frozen=True)
class Wedge:
    """h = front - slope x on a part of the bearing."""

    front: float
    slope: float

    def gap(self, x):
        return self.front - self.slope * x

    def integral(self, k, start, end):
        first, last = self.gap(start), self.gap(end)
        return (last ** (1 - k) - first ** (1 - k)) / ((k - 1) * self.slope)


@dataclass(frozen=True)
class Parabola:
    """h = 1 + ((x - centre) / width)^2."""

    centre: float
    width: float

    def gap(self, x):
        return 1.0 + ((x - self.centre) / self.width) ** 2

    def integral(self, k, start, end):
        """With x - centre = width tan(g), dx / h^k = width cos(g)^(2 k - 2) dg."""
        g = np.arctan((np.array([start, end]) - self.centre) / self.width)
        primitive = {
            2: g / 2.0 + np.sin(2.0 * g) / 4.0,
            3: 3.0 * g / 8.0 + np.sin(2.0 * g) / 4.0 + np.sin(4.0 * g) / 32.0,
        }[k]
        return self.width * float(primitive[1] - primitive[0])


def rise(part, flow, start, end):
    """Pressure at the end over that at the start of a full part."""
    return part.integral(2, start, end) - flow * part.integral(3, start, end)


@dataclass(frozen=True)
class Bearing:
    """A closed solution: gap(x), pressure(x), the flow, its fronts, and what enters (None: flooded)."""

    gap: object
    pressure: object
    flow: float
    fronts: tuple
    supply: float | None = None

    @property
    def load(self):
        points = sorted({0.0, 0.25, 0.75, 1.0, *self.fronts})
        return sum(quad(self.pressure, a, b, epsabs=1e-13)[0] for a, b in pairwise(points))


def flooded_parabola():
    shape = Parabola(0.5, 0.35)
    rupture = brentq(lambda x: rise(shape, shape.gap(x), 0.0, x), 0.51, 0.99)
    flow = shape.gap(rupture)
    return Bearing(shape.gap, lambda x: rise(shape, flow, 0.0, x) if x < rupture else 0.0, flow, (rupture,))


def starved_parabola():
    """The flow is the supply: it is the gap at the rupture, and the film forms where the pressure then is zero."""
    shape, flow = Parabola(0.5, 0.35), 1.06
    rupture = 0.5 + 0.35 * np.sqrt(flow - 1.0)
    forms = brentq(lambda x: rise(shape, flow, x, rupture), 0.01, 1.0 - rupture)

    def pressure(x):
        return rise(shape, flow, forms, x) if forms < x < rupture else 0.0

    return Bearing(shape.gap, pressure, flow, (forms, rupture), supply=flow)


def pocket():
    """A wedge with a recess: the film ruptures at its front step and forms anew before its back step."""
    land, recess = Wedge(1.1, 0.1), Wedge(1.6, 0.1)
    flow = land.integral(2, 0.0, 0.25) / land.integral(3, 0.0, 0.25)
    forms = brentq(lambda x: rise(recess, flow, x, 0.75) + rise(land, flow, 0.75, 1.0), 0.26, 0.74)

    def pressure(x):
        if x <= 0.25:
            return rise(land, flow, 0.0, x)
        if x <= forms:
            return 0.0
        if x <= 0.75:
            return rise(recess, flow, forms, x)
        return rise(recess, flow, forms, 0.75) + rise(land, flow, 0.75, x)

    def gap(x):
        return np.where((x > 0.25) & (x < 0.75), recess.gap(x), land.gap(x))

    return Bearing(gap, pressure, flow, (0.25, forms))


def solved(bearing, n, shift=0.3):
    """Pressure, mass and gap [n] on n nodes, begun with a gap that is too large by `shift`, and the rigid gap."""
    x = np.linspace(0.0, 1.0, n)
    shape, dx = (3, n), 1.0 / (n - 1)
    ones, edge, weight = np.ones(shape), np.zeros(shape), np.zeros(shape)
    edge[[0, 2]], weight[1] = 1.0, 1.0  # one row; its neighbours follow it, so that nothing flows across
    problem = Problem(
        undeformed=np.tile(bearing.gap(x), (3, 1)),
        cap=1e9 * ones,
        floor=1e-4,
        spacing=dx,
        load=bearing.load / dx,
        mobility=ones,
        thinned=0.0 * ones,
        per_dt=0.0,
        wedge=1.0,
        mass_old=0.0 * ones,
        fluidity=np.ones(2),
        density=np.ones(2),
        step=1e9,
        compliance=1e-12,
        edge=edge,
        weight=weight,
        conserving=True,
        supply=bearing.supply,
    )
    start = np.tile(6.0 * bearing.load * x * (1.0 - x), (3, 1))
    begin = Iterate(start, start.copy(), np.zeros(shape, np.bool_), shift)
    found = solve_newton(HalfSpace(*shape, 1e-14, "scipy"), problem, begin, 1e-12, 400)
    assert found.converged, found.shortfall
    return x, found.iterate.pressure[1], found.mass[1], found.gap[1], found.iterate.rigid


BEARINGS = {"parabola": flooded_parabola, "starved parabola": starved_parabola, "pocket": pocket}
GRIDS = (67, 131, 259, 515)


@pytest.mark.parametrize(
    ("name", "ends", "least", "most"),
    [
        ("parabola", 1, 1.9, 1e-5),
        ("starved parabola", 0, 1.9, 1e-5),
        ("pocket", 2, 1.0, 2e-3),
    ],  # the pocket's gap jumps
)
def test_pressure_gap_and_fronts_converge_to_the_closed_solution(name, ends, least, most):
    """`ends`: of the bearing that the film reaches."""
    bearing, errors = BEARINGS[name](), []
    for n in GRIDS:
        x, p, _, _, rigid = solved(bearing, n)
        exact = np.array([bearing.pressure(v) for v in x])
        errors.append((np.abs(p - exact).mean() / exact.max(), abs(rigid)))
        changes = np.flatnonzero(np.diff(p > 0.0)) + 0.5  # where a film forms or ruptures, in nodes
        assert len(changes) == len(bearing.fronts) + ends
        for front in bearing.fronts:
            assert np.abs(changes - front * (n - 1)).min() <= 1.0
    coarse, fine = np.array(errors[0]), np.array(errors[-1])
    assert fine[0] < most
    assert (np.log(coarse / fine) / np.log((GRIDS[-1] - 1) / (GRIDS[0] - 1))).min() > least


def flows(x, p, mass, gap):
    """Flow through the faces behind nodes: upwind in the mass, central in the pressure; nan near fronts."""
    dx = x[1] - x[0]
    full, found = p > 0.0, np.full(x.size - 1, np.nan)
    for i in range(1, x.size - 1):
        if not full[i - 1 : i + 2].any() and mass[i - 1] < 0.75 * gap[i - 1]:  # first order in a cavity
            found[i] = mass[i]
        elif full[i - 1 : i + 2].all():
            cube = 0.5 * (gap[i] ** 3 + gap[i + 1] ** 3)
            found[i] = 1.5 * gap[i] - 0.5 * gap[i - 1] - cube * (p[i + 1] - p[i]) / dx
    return found


@pytest.mark.parametrize("name", BEARINGS)
def test_what_flows_in_flows_through_every_section_and_out(name):
    bearing = BEARINGS[name]()
    x, p, mass, gap, _ = solved(bearing, 131)
    found = flows(x, p, mass, gap)
    told = found[np.isfinite(found)]
    assert told.size > 60
    assert np.ptp(told) < 1e-10 * told.mean()
    if bearing.supply is not None:
        assert mass[-2] == approx(bearing.supply, rel=1e-10)


def test_the_solution_does_not_depend_on_its_start():
    bearing = pocket()
    first, second = solved(bearing, 131, 0.0), solved(bearing, 131, 0.6)
    assert first[1] == approx(second[1], abs=1e-8 * first[1].max())
    assert first[2] == approx(second[2], rel=1e-6)


def test_theta_is_between_nothing_and_one_and_no_pressure_is_in_a_cavity():
    for make in BEARINGS.values():
        _, p, mass, gap, _ = solved(make(), 131)
        theta = mass[1:-1] / gap[1:-1]
        assert theta.min() > 0.0
        assert theta.max() <= 1.0 + 1e-14
        assert theta.min() < 0.95
        assert not p[1:-1][theta < 1.0].any()
