"""The iterations for v = G(v), by the number of evaluations of G that they need."""

import math

import numpy as np
import pytest
from comparison import approx
from hypothesis import given, settings
from hypothesis import strategies as st

from system_models.numerics.control import scale, wrms
from system_models.numerics.iteration import METHODS, Aitken, FixedPoint
from system_models.numerics.quasi_newton import QuasiNewton, multi_secant
from system_models.numerics.secant import Secant

MOST = 200


def solve(method, image, v, tolerance=1e-9, nominal=1.0):
    """Solution and evaluations of G; MOST where it has not come."""
    v = np.array(v, dtype=float)
    nominal = np.broadcast_to(nominal, v.shape)
    method.start(scale(tolerance, nominal, v))
    count = 0
    while count < MOST:
        count += 1
        g = np.asarray(image(v), dtype=float)
        if wrms(g - v, scale(tolerance, nominal, v)) <= 1.0:
            method.accept(v, g)
            break
        v = method.next(v, g)
        assert np.isfinite(v).all()
    return v, count


def contact(steepest, approach=1e-6, compliance=1e-8):
    """Force of a one-sided contact on a body that yields by `compliance` [m/N]; slope of G at no force: -steepest."""
    stiffness = steepest / (1.5 * compliance * math.sqrt(approach))
    return lambda v: stiffness * np.maximum(approach - compliance * v, 0.0) ** 1.5


def coupled_contact(steepest, approach=1e-6, compliance=1e-8):
    """The same as two equations, for force and approach."""
    stiffness = steepest / (1.5 * compliance * math.sqrt(approach))
    return lambda v: np.array([stiffness * max(v[1], 0.0) ** 1.5, approach - compliance * v[0]])


def residual(image, v):
    return image(v) - v


def linear(size, radius, rng):
    """G of a random matrix with a spectral radius, and its solution by elimination."""
    matrix = rng.standard_normal((size, size))
    matrix *= radius / np.abs(np.linalg.eigvals(matrix)).max()
    shift = rng.standard_normal(size)
    return lambda v: matrix @ v + shift, np.linalg.solve(np.eye(size) - matrix, shift)


def test_fixed_point_gains_the_slope_per_evaluation():
    v, count = solve(FixedPoint(), lambda v: 0.1 * v + 0.9, [0.0], tolerance=1e-9)
    assert v == approx([1.0], abs=1e-8)
    assert count == approx(1 + math.log(0.9 / 2e-9) / math.log(10.0), abs=1.0)


@pytest.mark.parametrize("slope", [0.5, -3.0, -1e3])
def test_aitken_is_exact_after_two_residuals_of_a_line(slope):
    v, count = solve(Aitken(), lambda v: slope * v + 1.0, [4.0])
    assert v == approx([1.0 / (1.0 - slope)])
    assert count == 3


def test_aitken_solves_equal_slopes_in_all_entries_at_once_and_keeps_its_factor():
    aitken, shift = Aitken(), np.arange(5.0)
    v, count = solve(aitken, lambda v: shift - 4.0 * v, np.zeros(5))
    assert (v, count) == (approx(shift / 5.0), 3)
    assert solve(aitken, lambda v: 2.0 * shift - 4.0 * v, np.zeros(5))[1] == 2
    aitken.clear()
    assert solve(aitken, lambda v: shift - 4.0 * v, np.zeros(5))[1] == 3


@pytest.mark.parametrize("slope", [0.99, 0.5, -0.5, 3.0, -3.0, 1e4, -1e4, -1e5])
def test_a_line_needs_a_probe_and_a_secant(slope):
    v, count = solve(QuasiNewton(), lambda v: slope * v + 3.0, [1.0])
    assert v == approx([3.0 / (1.0 - slope)], rel=1e-6)
    assert count <= 4


@pytest.mark.parametrize(("steepest", "most"), [(1e3, 15), (1e4, 17), (1e5, 19)])
@pytest.mark.parametrize("start", [0.0, 50.0, 150.0, 1e4, 1e7, -50.0])
def test_a_one_sided_contact_is_solved_from_both_sides(steepest, most, start):
    image = contact(steepest)
    v, count = solve(QuasiNewton(), image, [start])
    assert 50.0 < v[0] < 100.0
    assert residual(image, v * (1.0 - 1e-9))[0] > 0.0 > residual(image, v * (1.0 + 1e-9))[0]
    assert count <= most


def test_contacts_of_all_kinds_are_solved():
    rng = np.random.Generator(np.random.Philox(1))
    counts = []
    for _ in range(200):
        steepest, approach, compliance = 10.0 ** rng.uniform([-1.0, -9.0, -11.0], [5.0, -4.0, -4.0])
        start = rng.choice([-1.0, 0.0, 1.0]) * 10.0 ** rng.uniform(-3.0, 3.0) * approach / compliance
        image = contact(steepest, approach, compliance)
        v, count = solve(QuasiNewton(), image, [start])
        assert abs(residual(image, v)[0]) <= 2e-9 * (1.0 + v[0])
        counts.append(count)
    assert max(counts) < 30
    assert np.median(counts) < 15


@pytest.mark.parametrize("slope", [10.0, 1e2, 1e4])
@pytest.mark.parametrize("start", [0.0, 1.0, 100.0, -1e3])
def test_a_steep_step_of_friction_costs_little_more_than_bisection(slope, start):
    def image(v):
        return -100.0 * np.tanh(slope / 100.0 * (v + 5.0))

    v, count = solve(QuasiNewton(), image, [start])
    assert residual(image, v - 1e-8)[0] > 0.0 > residual(image, v + 1e-8)[0]
    assert count <= 14 + math.log2(slope)


@pytest.mark.parametrize("size", [2, 3, 5, 10])
@pytest.mark.parametrize("radius", [0.1, 0.9, 3.0, 30.0, 1e3])
def test_linear_systems_take_one_evaluation_per_unknown_a_probe_and_two(size, radius):
    rng = np.random.Generator(np.random.Philox(7))
    for _ in range(20):
        image, exact = linear(size, radius, rng)
        v, count = solve(QuasiNewton(), image, np.zeros(size), tolerance=1e-6)
        assert v == approx(exact, rel=1e-3, abs=1e-3)
        assert count <= size + 3


@pytest.mark.parametrize("nominal", [(100.0, 1e-6), (1.0, 1.0)])
@pytest.mark.parametrize("steepest", [10.0, 1e3, 1e5])
@pytest.mark.parametrize("start", [(0.0, 0.0), (0.0, 1e-6), (50.0, 1e-6), (1e3, 0.0), (0.0, -1e-6), (1e4, 1e-4)])
def test_a_contact_of_force_and_approach_is_solved(steepest, start, nominal):
    force, _ = solve(QuasiNewton(), contact(steepest), [0.0])
    v, count = solve(QuasiNewton(), coupled_contact(steepest), start, 1e-12 if nominal[1] == 1.0 else 1e-9, nominal)
    assert v[0] == approx(force[0], rel=1e-6)
    assert count < 50


def test_a_system_with_two_roots_ends_at_one_of_them():
    def image(v):  # OMSimulator's issue 808: a + b + c = 0, 2a - 3b + 2c = 9, a2 + b2 + c2 = 5
        return v + np.array([v.sum(), 2.0 * v[0] - 3.0 * v[1] + 2.0 * v[2] - 9.0, v @ v - 5.0])

    root = math.sqrt(0.07)
    for start in ((1.0, -1.0, 1.1), (0.0, 0.0, 1.0), (-1.0, -2.0, 3.0)):
        v, count = solve(QuasiNewton(), image, start)
        assert v[1] == approx(-1.8)
        assert sorted(v[[0, 2]]) == approx([0.9 - root, 0.9 + root])
        assert count < 30
        assert np.array_equal(v, solve(QuasiNewton(), image, start)[0])


def resting_mass(step, steps, pair):
    """Implicit Euler's steps of a damped mass pressed on a contact; its place, and evaluations per step."""
    mass, damping, load, stiffness = 1e-3, 50.0, 300.0, 300.0 / 1e-6**1.5
    x, velocity, force, counts, method = 0.0, 0.01, 0.0, [], QuasiNewton()

    def moved(f):
        new = (velocity + step * (load - f) / mass) / (1.0 + step * damping / mass)
        return x + step * new, new

    def law(place):
        return stiffness * max(place, 0.0) ** 1.5

    for _ in range(steps):
        image = (lambda v: [law(v[1]), moved(v[0])[0]]) if pair else (lambda v: [law(moved(v[0])[0])])
        v, count = solve(method, image, [force, x][: 1 + pair], 1e-6, [1.0, 1e-7][: 1 + pair])
        force = law(moved(v[0])[0])
        x, velocity = moved(v[0])
        counts.append(count)
    return x, counts


@pytest.mark.parametrize("pair", [False, True])
@pytest.mark.parametrize("step", [1e-4, 1e-5])
def test_a_mass_comes_to_rest_on_a_stiff_contact(step, pair):
    x, counts = resting_mass(step, round(2e-3 / step), pair)
    assert x == approx(1e-6, rel=1e-3)
    assert max(counts) < 50
    assert np.mean(counts) < 5.5
    assert counts[-1] <= 2


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("size", [1, 3])
def test_a_step_taken_back_leaves_no_trace(name, size):
    def step(method, shift):
        return solve(method, lambda v: 0.3 * np.cos(v[::-1] + shift) - 0.2 * v, np.zeros(size))

    straight, returned = METHODS[name](), METHODS[name]()
    step(straight, 0.0)
    step(returned, 0.0)
    memory = returned.copy()
    step(returned, 2.0)
    step(returned, -1.0)
    returned.restore(memory)
    (v, count), (w, again) = step(straight, 0.1), step(returned, 0.1)
    assert np.array_equal(v, w)
    assert count == again
    returned.clear()
    assert step(returned, 0.1)[1] >= count


@pytest.mark.parametrize("size", [1, 2, 6])
def test_accepted_steps_spare_evaluations(size):
    image, _ = linear(size, 5.0, np.random.Generator(np.random.Philox(2)))
    method = QuasiNewton()
    first = solve(method, image, np.zeros(size), tolerance=1e-6)[1]
    assert solve(method, lambda v: image(v) + 1.0, np.zeros(size), tolerance=1e-6)[1] == 2 < first


@pytest.mark.parametrize("size", [1, 2, 5])
def test_noise_below_the_allowed_errors_does_no_harm(size):
    rng = np.random.Generator(np.random.Philox(4))
    image, exact = linear(size, 20.0, rng)
    v, count = solve(QuasiNewton(), lambda v: image(v) + 1e-7 * rng.uniform(-1.0, 1.0, size), np.zeros(size), 1e-6)
    assert v == approx(exact, abs=1e-3)
    assert count <= size + 8


def test_units_do_not_matter_to_the_quasi_newton_step():
    rng = np.random.Generator(np.random.Philox(6))
    runs, rises, left = rng.standard_normal((2, 4)), rng.standard_normal((2, 4)), rng.standard_normal(4)
    units = 10.0 ** np.array([6.0, -6.0, 0.0, 3.0])
    step, rest = multi_secant(runs, rises, left)
    scaled_step, scaled_rest = multi_secant(runs * units, rises * units, left * units)
    assert scaled_step == approx(step * units)
    assert scaled_rest == approx(rest * units)


def test_as_many_differences_as_unknowns_make_newtons_step():
    rng = np.random.Generator(np.random.Philox(8))
    jacobian, runs, left = rng.standard_normal((5, 5)), rng.standard_normal((5, 5)), rng.standard_normal(5)
    repeated = np.vstack((runs[:2], runs[:1] + runs[1:2], runs[2:]))
    step, rest = multi_secant(repeated, repeated @ jacobian.T, left)
    assert step == approx(-np.linalg.solve(jacobian, left))
    assert rest == approx(np.zeros(5), abs=1e-12)


@given(
    st.sampled_from(sorted(METHODS)),
    st.integers(1, 4),
    st.lists(st.sampled_from([0.0, 1.0, -1.0, 1e-300, 1e6, -1e6]), min_size=8, max_size=8),
)
@settings(max_examples=200)
def test_whatever_is_returned_the_next_values_are_finite(name, size, images):
    method, v = METHODS[name](), np.zeros(size)
    method.start(np.full(size, 1e-6))
    for image in images:
        v = method.next(v, np.full(size, image))
        assert np.isfinite(v).all()
    method.accept(v, v.copy())
    method.start(np.full(size, 1e-6))
    assert np.isfinite(method.next(v, v + 1.0)).all()


@pytest.mark.parametrize("size", [1, 3])
@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_quasi_newton_turns_back_from_images_that_are_not_finite(size, wrong):
    def image(v):  # as of a model that fails beyond 2
        return np.where(np.abs(v).max() > 2.0, wrong, 1.0 + 4.0 * (v - 0.9))

    v, count = solve(QuasiNewton(), image, np.full(size, 1.9))
    assert v == approx(np.full(size, 2.6 / 3.0))
    assert count < 20


@pytest.mark.parametrize(("low", "high", "slope"), [(-1.0, 0.1, -1.0), (-0.01, 1.0, -10.0)])
def test_the_slope_that_is_kept_is_that_towards_the_nearer_end(low, high, slope):
    """Of a residual with a kink at its root, -v above and -10 v below."""
    secant = Secant()
    secant.start(1e-6)
    secant.next(low, -10.0 * low)
    secant.next(high, -high)
    secant.accept(0.0, 0.0)
    assert secant.slope == approx(slope)
