"""Tribofilms that give way elastically as thin layers (`solids.film_modulus`)."""

from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import CHEAP, cheap
from comparison import HARD, approx
from independent import gap

from contact_core import Scene, SceneError, initial_state, solve
from contact_core.kernels.dry_giving import solve_dry_giving
from contact_core.kernels.half_space import HalfSpace
from contact_core.kernels.surface_give import SurfaceGive

SMOOTH = {"surface_1.rq": "0 m", "surface_2.rq": "0 m", **HARD}
MODULUS = {"solids.film_modulus": "30 GPa"}


def covered(changes, thickness, only=None):
    """Case A under even tribofilms [m] on both bodies, or uneven ones by `only`, a generator."""
    scene, state, op = cheap(changes)
    bodies = []
    for body in state.bodies:
        share = 1.0 if only is None else only.uniform(0.0, 1.0, body.wear.shape)
        bodies.append(replace(body, growth=np.full_like(body.growth, 0.5 * thickness) * share))
    return scene, replace(state, bodies=(bodies[0], bodies[1])), op


def give(scene):
    """Thinning [1/Pa] of a layer that cannot spread, less that of steel with Poisson's ratio 0.3, by Hooke's law."""

    def thinning(modulus, v):
        side = v / (1.0 - v)  # stress across per stress along, so that no side strains
        return (1.0 - 2.0 * v * side) / modulus

    return thinning(30e9, scene.solids.film_poisson_ratio) - thinning(scene.solids.reduced_modulus * 0.91, 0.3)


@pytest.mark.parametrize("ratio", [0.0, 0.2, 0.3, 0.45])
def test_a_thin_layer_gives_way_by_its_oedometric_modulus_less_that_of_steel(ratio):
    scene, _, _ = cheap(CHEAP | MODULUS | {"solids.film_poisson_ratio": str(ratio)})
    assert scene.solids.film_give == approx(give(scene), rel=1e-12)


def test_a_film_of_the_solids_own_modulus_changes_nothing():
    steel = 230.47e9 * 0.91
    scene, state, op = covered(CHEAP | {"solids.film_modulus": f"{steel * (1 - 1e-12)!r} Pa"}, 150e-9)
    rigid, _, _ = covered(CHEAP, 150e-9)
    found, expected = (solve(each, op, state, dry=True) for each in (scene, rigid))
    assert found.pressure == approx(expected.pressure, abs=1e-6 * expected.pressure.max())


def test_an_even_layer_lets_a_ball_approach_by_half_of_what_it_gives_at_the_largest_pressure():
    """The energy of the layer, 1/2 s h integral p^2, over the load: d/dW gives s h p0 / 2 for Hertz's pressure."""
    fine = {"film.points": "129", "film.tolerance": "1e-7"}
    layered, state, op = covered(CHEAP | SMOOTH | MODULUS | fine, 150e-9)
    rigid, _, _ = covered(CHEAP | SMOOTH | fine, 150e-9)
    found, expected = (solve(scene, op, state, dry=True) for scene in (layered, rigid))
    closer = expected.film.rigid_gap - found.film.rigid_gap
    p0 = rigid.hertz(op.load).pressure_max
    assert closer == approx(0.5 * give(layered) * 150e-9 * p0, rel=0.01)
    assert 1e-9 < closer < 5e-9


def test_a_layer_far_softer_than_the_half_space_is_winklers_foundation():
    """p = p0 (1 - r^2/a^2), a^4 = 4 s W R / pi (Johnson, Contact Mechanics, 1985, section 4.3), units of the kernel."""
    n, soft = 96, 400.0
    x = np.linspace(-1.3, 1.3, n)
    r_2 = x[None, :] ** 2 + x[:, None] ** 2
    spacing = x[1] - x[0]
    load = np.pi / (4.0 * soft)  # a = 1 for a gap of r^2 / 2
    none = np.full((n, n), np.inf)
    layer = SurfaceGive(np.full((n, n), soft), none, none, 0.0)
    given = HalfSpace(n, n, 1e-6, "scipy"), 0.5 * r_2, np.full((n, n), 1e9), load / spacing**2
    pressure, _, converged, _ = solve_dry_giving(*given, np.ones((n, n)), layer, 1e-9, 2000)
    assert converged
    assert pressure == approx(np.maximum(1.0 - r_2, 0.0) / (2.0 * soft), abs=1e-3 / (2.0 * soft))


@pytest.mark.parametrize("dry", [True, False])
def test_bodies_fit_together_under_what_the_half_space_and_the_layer_give(dry):
    """The gap is that of the rough shapes, the half space (written anew) and an uneven layer."""
    tight = {"film.tolerance": "1e-6" if dry else "3e-3", "film.iterations": "2000"}
    thick = {"lubricant.viscosity.viscosity": "20 mPa s"}  # a film that carries a part
    uneven = np.random.Generator(np.random.Philox(2))
    scene, state, op = covered(CHEAP | HARD | MODULUS | tight | thick, 300e-9, uneven)
    fields = solve(scene, op, state, dry=dry)
    assert fields.converged
    floor, film = scene.film.floor, (fields.cover_1 + fields.cover_2) * scene.tribofilm.full_thickness
    thinner = give(scene) * film * fields.pressure
    left = gap(scene, fields) + thinner
    assert fields.gap == approx(np.maximum(left, floor), rel=1e-9)
    solid = fields.film.solid
    assert solid.sum() > 20
    below = solid & (fields.pressure < scene.plasticity.limit(fields.cover_1, fields.cover_2, 0.0, 1.0))
    carried = fields.solid_pressure[below]
    apart = (carried * np.abs(left - floor)[below]).sum() / carried.sum()
    assert apart < (0.001 if dry else 0.05) * floor
    assert thinner.max() > 3.0 * floor


@pytest.mark.parametrize("speed", [1.0, 3.0])
def test_a_smooth_film_under_a_layer_has_the_thickness_of_one_without(speed):
    """The film of smooth bodies is made in the inlet; a layer that gives way by 2 nm moves the bodies together."""
    more = {"film.points": "65", "operation.speed_1": f"{speed} m/s", "operation.speed_2": f"{speed} m/s"}
    more |= {"film.tolerance": "1e-3", "film.iterations": "500"}
    layered, state, op = covered(CHEAP | SMOOTH | MODULUS | more, 150e-9)
    rigid, _, _ = covered(CHEAP | SMOOTH | more, 150e-9)
    found, expected = (solve(scene, op, state) for scene in (layered, rigid))
    assert found.converged
    inside = np.hypot(found.x[None, :], found.y[:, None]) < 0.6 * rigid.hertz(op.load).a
    assert found.gap[inside].mean() == approx(expected.gap[inside].mean(), rel=0.03)


def test_without_a_modulus_or_without_a_film_no_bit_changes():
    plain, state, op = covered(CHEAP, 0.0)
    layered, _, _ = covered(CHEAP | MODULUS, 0.0)
    assert np.array_equal(solve(plain, op, state).pressure, solve(layered, op, state).pressure)
    assert plain.solids.film_modulus is None
    assert plain.solids.film_give == 0.0


@pytest.mark.parametrize(
    ("modulus", "said"),
    [
        ("300 GPa", "stiffer than its solids"),
        ("1 GPa", "more than 50% of a tribofilm's thickness"),
        ("-3 GPa", "above"),
    ],
)
def test_a_modulus_out_of_range_is_refused_with_a_way_out(modulus, said):
    with pytest.raises(SceneError, match=said):
        Scene.from_toml("azam_case_a", {"solids.film_modulus": modulus})


def test_a_scene_keeps_its_film_modulus():
    scene = Scene.from_toml("azam_case_a", MODULUS | {"solids.film_poisson_ratio": "0.25"})
    again = Scene.from_dict(scene.to_dict())
    assert again == scene
    assert initial_state(again).digest == initial_state(Scene.from_toml("azam_case_a")).digest
