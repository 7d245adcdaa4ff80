"""Hardness of three layers as part of the solution: films that yield and harden until the steel below is reached."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import HARD, approx
from independent import gap

from contact_core import march, solve
from contact_core.deterministic.transient import rolled, yielded
from contact_core.film.solids import pressed
from contact_core.kernels.dry_giving import solve_dry_giving
from contact_core.kernels.giving_half_space import giving
from contact_core.kernels.half_space import HalfSpace
from contact_core.kernels.surface_give import SurfaceGive
from contact_core.laws.plasticity import ElasticPerfectlyPlastic
from contact_core.scene import Case
from contact_core.surfaces.patches import facing_films, on_patches

FULL = 100e-9
LAW = ElasticPerfectlyPlastic(hardness=6e9, film_hardness=1.2e9, indentation="iterated")
SOFT = {"plasticity.film_hardness": "1.2 GPa", "plasticity.hardness": "6 GPa"}  # a ratio of five
FINE = {"film.tolerance": "1e-6"}
ITERATED = ("iterated", "iterated_total")


def filmed(indentation, depth=0.0, cover=(0.9, 0.5), **more):
    """Case A under uneven tribofilms, thicker than the gap, into which a part `depth` of them has been pressed."""
    scene, state, op = cheap(CHEAP | SOFT | {"plasticity.indentation": indentation} | more)
    noise, full = np.random.Generator(np.random.Philox(4)), scene.tribofilm.full_thickness
    bodies = []
    for body, part in zip(state.bodies, cover, strict=True):
        growth = full * part * noise.uniform(0.3, 1.0, body.wear.shape)
        bodies.append(replace(body, growth=growth, plastic=depth * growth))
    return scene, replace(state, bodies=(bodies[0], bodies[1])), op


def pressed_through(scene, state, overlap):
    """Return how many nodes yield in the thicker film alone, in both, and in the steel."""
    (first, second), before = facing_films(scene, state)
    depth, yields = before + overlap, overlap > 0.0
    one, two = np.abs(first - second), first + second
    layers = depth < one, (depth >= one) & (depth < two * (1.0 - 1e-9)), depth >= two * (1.0 - 1e-9)
    return [int((yields & layer).sum()) for layer in layers]


def assert_balanced(scene, state, fields, slack):
    """Hold a solution against p <= H(U), U >= 0 and p < H => U = 0, the gap of both bodies written anew."""
    films, before = facing_films(scene, state)
    floor, p, pressed = scene.film.floor, fields.pressure, fields.overlap
    deepest = scene.plasticity.limit(*films, before + pressed, scene.tribofilm.full_thickness)
    untouched = scene.plasticity.limit(*films, before, scene.tribofilm.full_thickness)
    assert pressed.min() >= 0.0
    assert np.all(p <= deepest * (1.0 + 1e-12))
    assert not pressed[p < untouched * (1.0 - 1e-12)].any()
    assert p[pressed > 0.0] == approx(deepest[pressed > 0.0], rel=1e-12)
    left = gap(scene, fields) + pressed  # of the bodies with their dents
    assert np.abs(np.maximum(left, floor) - fields.gap).max() < 1e-6 * floor
    solid = fields.film.solid & (fields.solid_pressure > fields.fluid_pressure)
    assert solid.any()
    layer = Case(scene, scene.operation.point).microroughness
    if layer is not None:  # asperities hold the bodies apart by what their law says
        given = scene.solids.reduced_modulus, scene.plasticity.hardness
        rest = floor + layer.height_scale(*given) * np.log(np.maximum(layer.pressure_scale(*given) / p[solid], 1.0))
        below = (p < scene.plasticity.hardness)[solid]
        assert (p[solid] * np.abs(left[solid] - rest))[below].sum() < slack * p[solid].sum()
    else:
        assert np.abs(left - floor)[solid].max() < slack
        assert left[~fields.film.solid].min() > floor - slack


@pytest.mark.parametrize("seed", range(20))
def test_the_depth_at_a_pressure_inverts_the_hardness_at_a_depth(seed):
    noise = np.random.Generator(np.random.Philox(seed))
    film_1, film_2 = noise.uniform(0.0, FULL, (2, 1))
    before, share = noise.uniform(0.0, 0.7 * FULL), noise.uniform(0.0, 1.0)
    first, second, slope = LAW.hardening(film_1, film_2, before, FULL)
    pressure = first + share * (6e9 - first)
    depth = SurfaceGive(np.zeros(1), first, second, slope).yielded(pressure)
    per_depth, total = 4.8e9 / FULL, before + depth  # equations of section 5.5.2
    if total < abs(film_1 - film_2):
        hardness = 6e9 - per_depth * (max(film_1, film_2) - total)
    elif total <= film_1 + film_2:
        hardness = 6e9 - 0.5 * per_depth * (film_1 + film_2 - total)
    else:
        hardness = 6e9
    assert pressure == approx(hardness, rel=1e-12)


@pytest.mark.parametrize(
    ("depth", "overlap", "first", "second"),
    [
        (0.0, 20e-9, 20e-9, 0.0),  # the thicker film, of 80 nm over 30 nm, alone
        (0.0, 70e-9, 60e-9, 10e-9),  # then both
        (0.0, 200e-9, 125e-9, 75e-9),  # and the steel of both
        (40e-9, 20e-9, 15e-9, 5e-9),  # what was pressed in before counts
        (90e-9, 20e-9, 10e-9, 10e-9),
    ],
)
def test_the_softer_body_takes_the_depth(depth, overlap, first, second):
    thick, thin, pressed = np.array([80e-9]), np.array([30e-9]), np.array([overlap])
    for films, parts in (((thick, thin), (first, second)), ((thin, thick), (second, first))):
        assert np.concatenate(LAW.shares(*films, depth, pressed)) == approx(np.array(parts), abs=1e-20)
    assert all(np.array_equal(half, 0.5 * pressed) for half in LAW.shares(thick, thick, depth, pressed))
    for indentation in ("none", "total"):
        halves = replace(LAW, indentation=indentation).shares(thick, thin, depth, pressed)
        assert all(np.array_equal(half, 0.5 * pressed) for half in halves)


@pytest.mark.parametrize("indentation", ITERATED)
def test_the_parts_of_both_bodies_add_up_to_the_overlap(indentation):
    scene, state, op = filmed(indentation, depth=0.2)
    state = rolled(scene, state, (5 * scene.film.spacing, -3 * scene.film.spacing))
    overlap = solve(scene, op, state, dry=True).overlap
    after = yielded(scene, state, overlap)
    gained = [now.plastic - then.plastic for now, then in zip(after.bodies, state.bodies, strict=True)]
    assert gained[0].min() >= 0.0
    assert gained[1].min() >= 0.0
    assert sum(part.sum() for part in gained) == approx(overlap.sum(), rel=1e-12)
    assert gained[0].sum() > 1.2 * gained[1].sum()  # body 1 has the thicker film
    (first, second), before = facing_films(scene, state)
    expected = on_patches(scene, state, scene.plasticity.shares(first, second, before, overlap))
    for part, share in zip(gained, expected, strict=True):
        assert part == approx(share, abs=1e-20)


@pytest.mark.parametrize(("indentation", "depth"), [*product(ITERATED, [0.0, 0.3])])
@pytest.mark.parametrize("asperities", [HARD, {}])
def test_a_dry_contact_yields_through_the_films_into_the_steel(indentation, depth, asperities):
    scene, state, op = filmed(indentation, depth, **FINE, **asperities, **{"plasticity.hardness": "2.5 GPa"})
    fields = solve(scene, op, state, dry=True)
    assert fields.converged
    assert_balanced(scene, state, fields, 0.02 * scene.film.floor)
    assert min(pressed_through(scene, state, fields.overlap)) > 0
    assert fields.pressure.sum() * scene.film.spacing**2 == approx(op.load, rel=1e-6)


@pytest.mark.parametrize("indentation", ITERATED)
def test_a_march_of_mixed_films_yields_through_the_films_into_the_steel(indentation):
    more = {"plasticity.hardness": "2.5 GPa", "film.tolerance": "3e-3", "film.iterations": "300"}
    scene, state, op = filmed(indentation, **HARD, **more)
    dt, cases, converged = scene.film.spacing / op.speed_2, np.zeros(3), 0
    for moment in march(scene, state, lambda _: op, [k * dt for k in range(7)]):
        # the state is that after yielding: the films are the same, the depth before is that of the instant before
        first, second = zip(moment.state.bodies, state.bodies, strict=True)
        bodies = tuple(replace(now, plastic=then.plastic) for now, then in (first, second))
        faced, fields = replace(moment.state, bodies=bodies), moment.fields
        cases += pressed_through(scene, faced, fields.overlap)
        if fields.converged:
            converged += 1
            assert_balanced(scene, faced, fields, 2.0 * scene.film.floor)
        state = moment.state
    assert converged >= 4
    assert cases.min() > 0


def test_films_harden_as_they_are_pressed_in():
    fixed, iterated = (solve(*_in_order(filmed(name)), dry=True) for name in ("none", "iterated"))
    assert iterated.overlap.sum() < 0.7 * fixed.overlap.sum()
    both = (iterated.overlap > 0.0) & (fixed.overlap > 0.0)
    assert both.sum() >= 8
    assert np.all(iterated.pressure[both] > fixed.pressure[both])


def _in_order(made):
    scene, state, op = made
    return scene, op, state


@pytest.mark.parametrize("dry", [True, False])
def test_without_a_tribofilm_every_indentation_is_the_same_bit_for_bit(dry):
    found = []
    for indentation in ("none", "total", *ITERATED):
        scene, state, op = cheap(CHEAP | SOFT | {"plasticity.hardness": "2 GPa", "plasticity.indentation": indentation})
        fields = solve(scene, op, state, dry=dry)
        after = yielded(scene, state, fields.overlap)
        found.append((fields.pressure, fields.gap, fields.overlap, *(body.plastic for body in after.bodies)))
    assert found[0][2].any()
    for other in found[1:]:
        assert all(np.array_equal(a, b) for a, b in zip(found[0], other, strict=True))


@pytest.mark.parametrize(
    ("changes", "cover"),
    [
        ({"operation.load": "778 N", "film.domain": "1 mm", "film.points": "65"}, (0.9, 0.5)),  # ten times the load
        ({"plasticity.film_hardness": "5.9 GPa"}, (1.0, 1.0)),  # hardly any softer: a hundred times as steep a depth
        ({}, (1.0, 0.0)),  # on one body only
    ],
)
def test_hard_cases_have_a_solution(changes, cover):
    scene, state, op = filmed("iterated", cover=cover, **FINE, **HARD, **changes)
    fields = solve(scene, op, state, dry=True)
    assert fields.converged
    assert_balanced(scene, state, fields, 0.02 * scene.film.floor)


def test_a_contact_that_gives_way_has_one_solution_from_any_start():
    noise, n = np.random.Generator(np.random.Philox(7)), 24
    x = np.linspace(-1.2, 1.2, n)
    heights = x[None, :] ** 2 + x[:, None] ** 2 + 0.05 * noise.standard_normal((n, n))
    first = noise.uniform(0.1, 0.6, (n, n))
    give = SurfaceGive(noise.uniform(0.0, 0.3, (n, n)), first, first + 0.2, 5.0)
    half_space, cap, load = HalfSpace(n, n, 0.05, "scipy"), np.ones((n, n)), 60.0
    limits = 1e-9, 5000
    found = [
        solve_dry_giving(half_space, heights, cap, load, start, give, *limits)
        for start in (np.ones((n, n)), noise.uniform(0.0, 1.0, (n, n)))
    ]
    assert all(converged for *_, converged, _ in found)
    assert found[0][0] == approx(found[1][0], abs=1e-6)
    pressure, rigid, _, _ = found[0]
    left = rigid + heights + half_space.deform(pressure) + give.at(pressure)
    inside = (pressure > 0.0) & (pressure < 1.0)
    assert pressure.sum() == approx(load, rel=1e-10)
    assert np.abs(left[inside]).max() < 1e-6
    assert left[pressure == 0.0].min() > -1e-6
    assert left[pressure == 1.0].max(initial=0.0) < 1e-6
    assert (give.yielded(pressure) > 0.0).sum() > 20


def test_solids_beside_oil_give_way_under_both_together():
    """By the sum of both pressures, the half space under the solids' alone: `gap` holds what it gives under the oil."""
    noise, n = np.random.Generator(np.random.Philox(5)), 24
    x = np.linspace(-1.2, 1.2, n)
    heights = x[None, :] ** 2 + x[:, None] ** 2 + 0.05 * noise.standard_normal((n, n))
    first, fluid = noise.uniform(0.3, 0.6, (n, n)), noise.uniform(0.0, 0.4, (n, n))
    give = SurfaceGive(noise.uniform(0.1, 0.3, (n, n)), first, first + 0.2, 5.0)
    half_space, cap, start = HalfSpace(n, n, 0.05, "scipy"), np.ones((n, n)), np.ones((n, n))
    solids, rigid, converged, _ = pressed(half_space, heights, cap, 30.0, start, fluid, (0.0, 0.0), give, 1e-9, 5000)
    left = rigid + heights + half_space.deform(solids) + give.at(fluid + solids)
    bears = (solids > 0.0) & (solids + fluid < 1.0)
    assert converged
    assert bears.sum() > 20
    assert np.abs(left[bears]).max() < 1e-6


def test_a_surface_that_gives_way_responds_to_a_small_step_as_it_deforms():
    noise, n, small = np.random.Generator(np.random.Philox(3)), 12, 1e-6
    first = noise.uniform(0.2, 0.4, (n, n))
    give = SurfaceGive(noise.uniform(0.1, 0.3, (n, n)), first, first + 0.2, 5.0)
    surface = giving(HalfSpace(n, n, 0.05, "scipy"), give)
    pressure = noise.choice([0.1, 0.5, 0.9], (n, n)) + noise.uniform(0.0, 0.05, (n, n))
    pressure += np.where(np.abs(pressure - first) < 0.01, 0.02, 0.0)
    pressure += np.where(np.abs(pressure - first - 0.2) < 0.01, 0.02, 0.0)  # beside where the slope jumps
    step = noise.standard_normal((n, n))
    change = surface.deform(pressure + small * step) - surface.deform(pressure)
    assert surface.respond(pressure, step) == approx(change / small, rel=1e-5)
