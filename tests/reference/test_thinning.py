"""Films of oils that thin under shear: one node by quadrature, the inlet in one dimension, and Bair's formula."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import quad, solve_ivp
from scipy.ndimage import gaussian_filter
from scipy.optimize import brentq

from contact_core.film.fitted import fitted_grid
from contact_core.film.instant import Instant, Settings, Step
from contact_core.film.routes import solve_film
from contact_core.film.thinning import Agreement, eased, recalled, remembering, thinned_fluidity
from contact_core.laws.density import Incompressible
from contact_core.laws.rheology import Carreau, Eyring, Newtonian
from contact_core.laws.viscosity import Barus
from contact_core.reference import SmoothContact, hertz_point, nijenbanning_venner_moes
from contact_core.shapes import Point

RADIUS, MODULUS, ALPHA, VISCOSITY = 10e-3, 230.47e9, 20e-9, 0.1
LOAD, SPEED, NODES = 100.0, 0.5, 129
TOLERANCE = 1e-3
STRESS = 1e6  # Pa, of an Eyring oil that thins in the inlet


def contact(nodes=NODES, rq=0.0, load=LOAD, speed=SPEED, viscosity=VISCOSITY):
    film = nijenbanning_venner_moes(SmoothContact(load, speed, viscosity, ALPHA, RADIUS, RADIUS, MODULUS))
    grid = fitted_grid(Point(RADIUS, RADIUS), load, MODULUS, film, nodes, nodes)
    z = gaussian_filter(np.random.Generator(np.random.Philox(1)).standard_normal(grid.shape), 1.5, mode="wrap")
    law, limit = Barus(viscosity, 300.0, ALPHA, 0.0), np.full(grid.shape, 6e9)
    z *= rq / z.std()
    return Instant(load, speed, 300.0, Point(RADIUS, RADIUS), MODULUS, law, Incompressible(), z, limit, 6e9), grid


def agreed(now, solve, ease, tolerance=TOLERANCE):
    """The steady film that agrees with its oil."""
    agreement, start = Agreement(tolerance), None
    while agreement.asks_for_more(found := solve(now, start)):
        if (then := ease(now, found)) is now:
            break
        now, start = agreement.towards(now, then), found.state
    return agreement.film(found)


@lru_cache(maxsize=16)
def films(rheology, slide_to_roll):
    """Central films of all solutions until the film stands still, and the last solution."""
    now, grid = contact()
    solved = []

    def solve(instant, start):
        solved.append(solve_film(instant, grid, Settings(1e-9, 1e-4, 400, "pyfftw"), start))
        return solved[-1]

    sliding = slide_to_roll * SPEED
    found = agreed(now, solve, lambda i, film: eased(i, film, rheology, sliding, grid.spacing))
    assert found.converged
    middle = NODES // 2, int(np.abs(grid.x).argmin())
    return [film.gap[middle] for film in solved], found


def one_node(rheology, eta, sliding, gap, slope, flowing):
    """`thinned_fluidity` in a uniform film under a uniform gradient of pressure."""
    one, spacing = np.ones((3, 3)), 1e-6
    pressure = slope * spacing * np.arange(3.0)[None, :] * one
    return thinned_fluidity(rheology, sliding, gap * one, pressure, spacing, eta * one, flowing * one)[1, 1]


@pytest.mark.parametrize("rheology", [Eyring(5e6), Carreau(1e5, 0.5), Carreau(2e6, 0.8)], ids=["eyring", "0.5", "0.8"])
@pytest.mark.parametrize("mean", [0.0, 0.5, 3.0])
@pytest.mark.parametrize("half", [0.02, 0.3, 4.0])
def test_a_sheared_and_pressed_film_flows_as_quadrature_across_it_says(rheology, mean, half):
    """Stresses mean + s half, -1 < s < 1, in units of the stress at which the oil begins to thin."""
    unit = getattr(rheology, "eyring_stress", None) or rheology.critical_stress
    mean, half, eta, gap = mean * unit, half * unit, 0.3, 2e-7

    def rate(s):
        stress = mean + s * half
        return float(rheology.ease(np.array([abs(stress)]))[0]) * stress / eta

    near = {"points": [-mean / half] if mean < half else None, "epsabs": 1e-8 * rate(1.0)}
    sliding = 0.5 * gap * quad(rate, -1.0, 1.0, **near)[0]
    flow = 0.25 * gap**2 * quad(lambda s: s * rate(s), -1.0, 1.0, **near)[0]
    slope = 2.0 * half / gap
    flowing = 12.0 * flow / (gap**3 * slope)
    for wrong in (1.0, 30.0):  # it is the flow that counts, not the gradient at hand
        thinned = one_node(rheology, eta, sliding, gap, wrong * slope, flowing / wrong)
        assert thinned + 1.0 / eta == approx(flowing, rel=2e-3)
    assert flowing > 1.0 / eta


def test_a_hardly_pressed_eyring_film_yields_by_the_tangent_of_its_flow_curve():
    oil, eta, gap = Eyring(5e6), 50.0, 1e-7
    for sliding in (1e-4, 1e-2, 1.0):
        shear = eta * sliding / gap / oil.eyring_stress
        expected = (np.hypot(1.0, shear) - 1.0) / eta
        assert one_node(oil, eta, sliding, gap, 1.0, 1.0 / eta) == approx(expected, rel=1e-6, abs=1e-9 / eta)


def test_an_even_gradient_thins_the_oil_alike_up_to_the_edges_and_in_a_single_row():
    x, y, spacing = 1e-6 * np.arange(9), 1e-6 * np.arange(7), 1e-6
    for along, across in ((3e13, 4e13), (5e13, 0.0)):
        pressure = 1e8 + along * x[None, :] + across * y[:, None]
        gap, viscosity = np.full(pressure.shape, 1e-7), np.full(pressure.shape, 0.1)
        found = thinned_fluidity(Eyring(STRESS, 0.05), 0.2, gap, pressure, spacing, viscosity)
        assert found == approx(np.full(gap.shape, found[3, 4]), rel=1e-9)
        assert found[3, 4] > 0.0
    row = [field[:1] for field in (gap, pressure, viscosity)]  # of the last one, which is the same along y
    alone = thinned_fluidity(Eyring(STRESS, 0.05), 0.2, row[0], row[1], spacing, row[2])
    assert alone == approx(found[:1], rel=1e-12)


def test_the_flow_is_finite_where_the_oil_is_stiff_and_pressures_jump():
    rng = np.random.Generator(np.random.Philox(2))
    shape = (40, 40)
    pressure, gap = rng.uniform(0.0, 6e9, shape), np.exp(rng.uniform(np.log(1e-10), np.log(1e-4), shape))
    viscosity = 0.1 * np.exp(np.minimum(30e-9 * pressure, 500.0)) * np.exp(rng.uniform(-5.0, 300.0, shape))
    for oil in (Eyring(1e5), Carreau(1e4, 0.3), Eyring(5e6, 0.05)):
        for sliding in (0.0, 1e-9, 100.0):
            thinned = thinned_fluidity(oil, sliding, gap, pressure, 1e-7, viscosity)
            assert np.isfinite(thinned).all()
            assert thinned.min() >= 0.0


def test_a_newtonian_oil_at_one_temperature_leaves_the_instant_as_it_is():
    now, grid = contact(33)
    found = solve_film(now, grid, Settings(1e-9, 1e-3, 400, "pyfftw"))
    solved = []

    def solve(instant, start):
        solved.append(instant)
        return found

    assert eased(now, found, Newtonian(), 1.0, grid.spacing) is now
    assert agreed(now, solve, lambda i, film: eased(i, film, Newtonian(), 1.0, 1e-6)).gap is found.gap
    assert len(solved) == 1
    assert (thinned_fluidity(Newtonian(0.05), 1.0, found.gap, found.gap, 1e-6, found.gap) == 0.0).all()


def test_a_state_keeps_the_oil_for_the_next_instant():
    now, grid = contact(33)
    found = solve_film(now, grid, Settings(1e-9, 1e-3, 400, "pyfftw"))
    assert recalled(now, found.state).thinned is None
    then = replace(now, ease=1.0 + found.gap, thinned=found.gap)
    kept = recalled(now, remembering(found, then).state.mirrored().mirrored())
    assert (kept.ease == then.ease).all()
    assert (kept.thinned == then.thinned).all()
    dry = replace(found, route="dry")
    assert eased(then, dry, Eyring(5e6), 1.0, grid.spacing) is then


def test_a_warmer_film_is_that_of_a_thinner_oil():
    now, grid = contact(65, speed=2.0)
    settings = Settings(1e-9, 1e-4, 400, "pyfftw")

    def warmer(instant, film):
        return eased(instant, film, Newtonian(), 1.0, grid.spacing, instant.viscosity(film.state.fluid, 300.0) / 1.5)

    found = agreed(now, lambda instant, start: solve_film(instant, grid, settings, start), warmer)
    thinner = replace(now.viscosity, viscosity=VISCOSITY / 1.5)
    expected = solve_film(replace(now, viscosity=thinner), grid, settings)
    assert found.converged
    assert found.gap == approx(expected.gap, rel=1e-6)


def bair(slide_to_roll, film, stress, power):
    """h_N / h of a Carreau oil: Bair, Proc. IMechE J 219 (2005) 69."""
    shear = (1.0 + slide_to_roll) * SPEED * VISCOSITY / (film * stress)
    return (1.0 + 0.79 * shear ** (1.0 / (1.0 + 0.2 * slide_to_roll))) ** (3.6 * (1.0 - power) ** 1.7)


@pytest.mark.parametrize(
    ("stress", "power", "slide_to_roll"),
    [
        (3e5, 0.5, 0.0),
        *(pytest.param(*each, marks=pytest.mark.long) for each in ((1e5, 0.5, 0.0), (3e4, 0.7, 0.0))),
        (3e4, 0.7, 1.0),
    ],
)
def test_films_of_carreau_oils_are_those_of_bairs_formula_within_a_tenth(stress, power, slide_to_roll):
    heights, _ = films(Carreau(stress, power), slide_to_roll)
    assert heights[0] / heights[-1] == approx(bair(slide_to_roll, heights[0], stress, power), rel=0.1)
    assert heights[0] / heights[-1] > 1.3


def inlet_film(stress, slide_to_roll):
    """Film [m] of an Eyring oil by Grubin's inlet on the middle row of a point contact: along x only."""
    hertz = hertz_point(LOAD, RADIUS, RADIUS, MODULUS)

    def opening(x):  # Johnson, Contact Mechanics, section 3.4
        r = max(-x / hertz.a, 1.0)
        return hertz.a**2 / (np.pi * RADIUS) * (np.sqrt(r * r - 1.0) + (r * r - 2.0) * np.arccos(1.0 / r))

    def slope(x, p, film):
        gap, eta = film + opening(x), VISCOSITY * np.exp(ALPHA * p[0])
        newtonian = 6.0 * eta * SPEED * (gap - film) / gap**2 / stress
        shear = eta * slide_to_roll * SPEED / gap / stress

        def excess(y):
            lever = np.hypot(1.0, shear * y / np.sinh(y))
            return 3.0 * lever * (y * np.cosh(y) - np.sinh(y)) / y**2 - newtonian

        half = newtonian if newtonian < 1e-3 else brentq(excess, 1e-4, min(newtonian + 1e-3, 50.0), xtol=1e-7)
        if newtonian < 1e-3:
            half /= np.hypot(1.0, shear)
        return [2.0 * half * stress / gap]

    def arrived(x, p, film):
        return p[0] - 0.6 * hertz.pressure_max

    arrived.terminal = True
    low, high = 2e-8, 1e-6
    while high / low > 1.002:
        film = np.sqrt(low * high)
        reach = (-4.0 * hertz.a, -hertz.a)
        end = solve_ivp(slope, reach, [0.0], args=(film,), method="LSODA", events=arrived, rtol=1e-4, atol=1e3)
        low, high = (film, high) if end.status == 1 else (low, film)
    return film


@pytest.mark.long
@pytest.mark.parametrize("slide_to_roll", [0.0, 1.0])
def test_films_of_an_eyring_oil_thin_about_as_the_inlet_on_the_middle_row_does(slide_to_roll):
    """Within what Grubin's inlet leaves out: sides, and pressures that end at the edge of Hertz's contact."""
    heights, _ = films(Eyring(STRESS), slide_to_roll)
    expected = inlet_film(1e12, 0.0) / inlet_film(STRESS, slide_to_roll)
    print(f"slide-to-roll {slide_to_roll}: thinner by {heights[0] / heights[-1]:.3f}, the inlet says {expected:.3f}")
    assert heights[0] / heights[-1] == approx(expected, rel=0.15)
    assert expected > 1.1


def test_steady_films_stand_still_after_a_few_solutions():
    for oil, sliding, most in ((Eyring(5e6), 0.1, 3), (Eyring(5e6), 1.0, 5), (Carreau(3e4, 0.7), 1.0, 8)):
        heights, found = films(oil, sliding)
        print(f"{oil} at slide-to-roll {sliding}: {len(heights)} solutions")
        assert len(heights) <= most
        assert heights[-1] == approx(heights[-2], rel=5.0 * TOLERANCE)
        assert found.state.thinned.shape == found.gap.shape


def test_rough_sliding_films_march_in_time_as_newtonian_ones_do():
    """The oil of an instant is that of the one before; Eyring stress 5 MPa, slide-to-roll 1."""
    now, grid = contact(65, 200e-9, 50.0, 0.5, 0.02)
    settings, step = Settings(1e-9, 1e-3, 40, "pyfftw"), grid.spacing / 0.75
    shares = {}
    for oil in (Newtonian(), Eyring(5e6)):
        found = solve_film(now, grid, settings)
        found = remembering(found, eased(now, found, oil, 0.5, grid.spacing))
        solids, converged = [], 0
        for k in range(1, 25):
            instant = replace(recalled(now, found.state), heights=np.roll(now.heights, k, axis=1))
            found = solve_film(instant, grid, settings, found.state, Step(step, 1))
            found = remembering(found, eased(instant, found, oil, 0.5, grid.spacing))
            converged += found.converged
            solids.append(1.0 - found.state.fluid.sum() / found.state.pressure.sum())
        assert converged >= 22
        shares[oil.name] = float(np.mean(solids[12:]))
    assert 0.0 < shares["newtonian"] < shares["eyring"] < 2.0 * shares["newtonian"]
