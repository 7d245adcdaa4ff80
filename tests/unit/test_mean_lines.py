"""The regression level on lines and rollers: what changes with the shape, and what must not."""

from dataclasses import replace

import numpy as np
import pytest
from cheap_scene import cheap
from comparison import HARD, approx

from contact_core import OperatingPointError, RangeFlag, Scene, advance, initial_state
from contact_core.laws.load_sharing import FittedSharing
from contact_core.laws.rheology import Newtonian
from contact_core.reference import SmoothLine, hertz_line, hertz_point, moes_line
from contact_core.regression.oil import OilFriction
from contact_core.surfaces.patches import across_track

FACE, LOAD = 8e-3, 2000.0
LINE = {"film.model": "regression", "geometry.model": "line", "geometry.face_width": "8 mm", "operation.load": "2 kN"}
ROLLER = LINE | {
    "geometry.model": "roller", "geometry.profile.model": "logarithmic", "geometry.profile.depth": "3.5 um",
    "film.width": "10 mm", "film.points": "17", "surface_1.correlation_length": "80 um",
    "surface_2.correlation_length": "80 um",
}  # fmt: skip
SMOOTH = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"} | HARD
SHAPES = {"line": LINE, "roller": ROLLER}


def now(scene, op, state):
    return advance(scene, op, state, 0.0)[1]


def point(op, entrainment, sliding, **changes):
    return replace(op, speed_1=entrainment + 0.5 * sliding, speed_2=entrainment - 0.5 * sliding, **changes)


def smooth_film(scene, op) -> float:
    oil, shape = scene.lubricant.viscosity, scene.geometry
    return moes_line(
        SmoothLine.of(
            op.load / FACE, op.entrainment_speed, oil, op.temperature, shape.radius_x, scene.solids.reduced_modulus
        )
    )


@pytest.mark.parametrize("model", SHAPES)
def test_smooth_bodies_have_the_film_of_lines_and_the_oils_friction_under_hertzs_strip(model):
    scene, state, op = cheap(SHAPES[model] | SMOOTH)
    scene = replace(scene, lubricant=replace(scene.lubricant, rheology=Newtonian()))
    op = point(op, 5.0, 1e-9, load=100.0)
    found, hertz = now(scene, op, state), hertz_line(100.0, scene.geometry.radius_x, FACE, scene.solids.reduced_modulus)
    sharing, formula = scene.film.sharing, smooth_film(scene, op)
    film = sharing.film_factor * formula / scene.lubricant.density(hertz.pressure_mean)
    spread = np.sqrt(1.0 + sharing.oil_spread * formula * scene.geometry.radius_x / hertz.a**2)  # of the load
    x = (np.arange(20_000) + 0.5) / 20_000
    pressure = hertz.pressure_max / spread * np.sqrt(1.0 - x**2)
    shear = spread * scene.lubricant.viscosity(pressure, op.temperature) * 1e-9 / film
    assert spread > 1.1
    assert found.contact_load_ratio < 1e-9
    assert found.h_c == approx(film, rel=5e-3)  # the floor adds to it
    assert found.friction_force == approx(-4.0 * hertz.a * hertz.b * float(shear.mean()), rel=5e-3)
    assert found.approach == approx(hertz.approach - found.h_c, rel=1e-12)


@pytest.mark.parametrize("fall", [0.0, 0.02])
def test_the_mean_over_a_strip_is_that_of_many_nodes(fall):
    scene, _, op = cheap(LINE)
    rheology = replace(scene.lubricant.rheology, limiting_fall=fall)
    scene = replace(scene, lubricant=replace(scene.lubricant, rheology=rheology))
    pressures, rates, grips = np.array([2e8, 9e8]), np.array([1e3, 1e6]), np.array([1.0, 0.3])
    strip, ellipse = hertz_line(LOAD, 0.01, FACE, 230e9), hertz_point(LOAD, 0.01, 0.02, 230e9)
    warm = op.temperature + np.array([0.0, 40.0])
    left = np.exp(-fall * (warm - 313.15))
    part = (np.arange(50_000) + 0.5) / 50_000
    for hertz, weight in ((strip, np.ones_like(part)), (ellipse, 2.0 * part)):
        local = np.sqrt(1.0 - part[:, None] ** 2) * pressures
        shear = scene.lubricant.rheology(scene.lubricant.viscosity(local, warm) * rates, local * grips * left)
        oil = OilFriction(
            scene.lubricant.viscosity, scene.lubricant.rheology, hertz, np.ones(2), pressures, rates, grips
        )
        assert oil.shear(warm) == approx((weight[:, None] * shear).mean(axis=0), rel=1e-2)


@pytest.mark.parametrize("heat", ["flash", "field"])
def test_a_face_twice_as_long_under_twice_the_load_has_the_same_contact(heat):
    """A smooth roller that conducts heat loses the less of it the longer it is."""
    model, near = (LINE, 1e-9) if heat == "flash" else (ROLLER, 4e-2)
    changes = model | {"heat.model": heat} | (SMOOTH | {"film.width": "20 mm"} if heat == "field" else {})
    one, _, op = cheap(changes)
    two, _, _ = cheap(changes | {"geometry.face_width": "16 mm", "operation.load": "4 kN"})
    _, first = advance(one, op, initial_state(one), 600.0)
    _, second = advance(two, two.operation.point, initial_state(two), 600.0)
    for name in ("friction_coefficient", "h_c", "contact_load_ratio", "contact_area_ratio", "wear_depth_1",
                 "tribofilm_1", "coverage_2", "lambda_ratio", "error_friction"):  # fmt: skip
        assert getattr(second, name) == approx(getattr(first, name), rel=near, abs=0.0), name
    for name in ("friction_force", "wear_volume_1", "wear_volume_2", "dfriction_dspeed_1", "power_loss"):
        assert getattr(second, name) == approx(2.0 * getattr(first, name), rel=near, abs=0.0), name


@pytest.mark.parametrize("model", SHAPES)
@pytest.mark.parametrize("changes", [{}, {"heat.model": "field"}, {"heat.inlet_shear": "gupta"}], ids=str)
def test_derivatives_are_total(model, changes):
    scene, state, op = cheap(SHAPES[model] | changes)
    state, _ = advance(scene, op, state, 1800.0)
    for entrainment, sliding in ((0.4, 0.02), (2.0, -0.3)):
        at = point(op, entrainment, sliding)
        found = now(scene, at, state)
        for name, step in (("speed_1", 1e-7), ("speed_2", 1e-7), ("load", 2e-2), ("temperature", 4e-3)):
            up, down = (
                now(scene, replace(at, **{name: getattr(at, name) + s * step}), state).friction_force for s in (1, -1)
            )
            size = max(abs(up - down) / (2.0 * step), 1e-3 * abs(found.friction_force) / getattr(at, name))
            assert getattr(found, f"dfriction_d{name}") == approx((up - down) / (2.0 * step), abs=2e-3 * size)


def test_wear_is_archards_on_the_whole_face():
    for changes in SHAPES.values():
        scene, state, op = cheap(changes | {"tribofilm.model": "none"})
        state, found = advance(scene, op, state, 1e-3)
        volume = scene.wear.bare * found.contact_load_ratio * LOAD * abs(op.sliding_speed) / scene.plasticity.hardness
        assert found.wear_rate_1 == approx(volume, rel=1e-9)
        rows = 1e-9 * FACE if changes is LINE else 1.01 * scene.film.spacing  # whole ones
        width = found.wear_volume_1 / found.wear_depth_1 / scene.geometry.track_length_1
        assert width == approx(FACE, abs=rows)


def test_a_spinning_roller_rubs_over_half_its_half_length():
    scene, state, op = cheap(ROLLER | {"tribofilm.model": "none"})
    found = now(scene, point(op, 0.0, 0.0, spin=10.0), state)
    assert found.contact_load_ratio == approx(1.0, abs=1e-9)
    assert found.spin_torque == approx(-scene.boundary_friction.bare * LOAD * 0.25 * FACE, rel=1e-2)
    assert found.power_loss == approx(-10.0 * found.spin_torque, rel=1e-9)


def test_lines_and_rollers_have_curves_of_their_own_unless_a_scene_asks_for_others():
    for changes, law in (({"film.model": "regression"}, "fitted"), (LINE, "fitted_lines"), (ROLLER, "fitted_lines")):
        scene, _, _ = cheap(changes)
        assert (
            scene.film.sharing.name == scene.at_level("deterministic").at_level("regression").film.sharing.name == law
        )
        assert Scene.from_dict(scene.to_dict()) == scene
    asked, _, _ = cheap(LINE | {"film.sharing.load_factor": "3"})
    assert (asked.film.sharing.name, asked.film.sharing.load_factor) == ("fitted_lines", 3.0)
    other, _, _ = cheap(LINE | {"film.sharing.model": "fitted"})
    assert other.film.sharing == FittedSharing()


def test_a_flank_lies_within_the_fit_on_any_grid_and_one_twenty_times_as_rough_does_not():
    found = {}
    for change, value in (("film.points", "257"), ("film.points", "65"), ("surface_2.rq", "4 um")):
        scene = Scene.from_toml("fzg_flank", {"film.model": "regression", change: value})
        found[value] = now(scene, scene.operation.point, initial_state(scene))
    outside = {value: bool(out.range_flags & RangeFlag.OUTSIDE_FIT) for value, out in found.items()}
    assert outside == {"257": False, "65": False, "4 um": True}
    for name in ("friction_force", "contact_load_ratio", "contact_area_ratio", "h_c"):
        assert getattr(found["257"], name) == approx(getattr(found["65"], name), rel=2e-3), name


def test_a_load_above_the_hardness_is_refused_by_the_pressure_of_lines():
    scene, state, op = cheap(LINE)
    hertz = hertz_line(1.0, scene.geometry.radius_x, FACE, scene.solids.reduced_modulus)
    most = (scene.plasticity.hardness / hertz.pressure_max) ** 2
    now(scene, replace(op, load=0.999 * most), state)
    with pytest.raises(OperatingPointError, match="hardness"):
        now(scene, replace(op, load=1.001 * most), state)


def test_without_load_nothing_rubs():
    for changes in SHAPES.values():
        scene, state, op = cheap(changes)
        _, found = advance(scene, replace(op, load=0.0), state, 10.0)
        assert found.friction_force == found.wear_volume_1 == found.tribofilm_1 == 0.0
        assert np.isfinite(found.approach)


@pytest.mark.parametrize("model", SHAPES)
def test_along_a_face_films_are_rubbed_off_alike(model):
    """The tension that takes more at the edges is that of a circle."""
    films = []
    for weight in ("0", "20"):
        changes = {"tribofilm.set": "gosvami", "tribofilm.edge_weight": weight, "operation.temperature": "80 degC"}
        scene, state, op = cheap(SHAPES[model] | changes)
        slow = point(op, 0.1 * op.entrainment_speed, 0.1 * op.sliding_speed)
        films.append(advance(scene, slow, state, 1800.0)[1].tribofilm_1)
        assert across_track(scene, scene.rows) is None
    assert films[0] == films[1] > 1e-9
    scene, _, _ = cheap()
    assert across_track(scene, scene.rows).shape == (33, 1)


@pytest.mark.parametrize("share", [0.3, 0.6, 1.0])
def test_a_line_short_of_oil_has_the_film_that_comes_in(share):
    """Nothing flows to the sides of a line; a circular contact loses some."""
    smooth = SMOOTH | {"film.floor": "0.1 nm"}  # beside which a film that is short of oil is thick, too
    kept = []
    for changes in (LINE, {"film.model": "regression"}):
        full, state, op = cheap(changes | smooth)
        film = now(full, op, state).h_c
        density = full.lubricant.density(full.hertz(op.load).pressure_mean)
        layer = share * film * density / full.film.sharing.film_factor
        oil = {"lubricant.supply.model": "film", "lubricant.supply.thickness": f"{layer!r} m"}
        short, _, _ = cheap(changes | smooth | oil | {"lubricant.cavitation": "mass_conserving"})
        kept.append(now(short, op, state).h_c / film)
    assert kept[0] > kept[1]
    assert kept[0] == approx(share, rel=0.02)


def test_bodies_as_rough_as_each_other_get_films_as_thick():
    scene = Scene.from_toml("fzg_flank").at_level("regression")
    op = scene.operation.point
    slow = replace(op, speed_1=0.1 * op.speed_1, speed_2=0.1 * op.speed_2)
    _, found = advance(scene, slow, initial_state(scene), 300.0)
    assert found.tribofilm_1 == approx(found.tribofilm_2, rel=0.1)
    assert found.tribofilm_1 > 1e-9
