"""Stress and damage at the regression level: limits, scaling, damage over time, and the change of level."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from comparison import approx

from benchmarks.stress.closed_forms import line_stress
from contact_core import ContactState, Outputs, Scene, advance, initial_state
from contact_core.kernels.stress_measures import von_mises
from contact_core.laws.stress import share_down_to
from contact_core.regression import fatigue, stress
from contact_core.regression.contact import evaluate
from contact_core.regression.near_surface import CURVES, HALF_WIDTH, meetings
from contact_core.regression.smooth_cycles import smooth_cycles
from contact_core.regression.surfaces import tribofilms_of
from contact_core.scene import Case
from contact_core.state import Classes, changed
from contact_core.state.classes import WEIGHTS, unharmed_classes
from contact_core.surfaces.patches import bare_heights
from contact_core.surfaces.track_means import folded, means_of

FAST = {"film.model": "regression", "stress.model": "half_space"}
BASQUIN = {"fatigue.model": "basquin", "fatigue.reference_stress": "900 MPa", "fatigue.life_exponent": "8"}
ENDLESS = {"fatigue.reference_stress": "100 GPa"}
NO_WEAR = {"wear.bare": "0", "wear.film": "0"}
SMOOTH = {f"surface_{i}.{name}": "0 m" for i in (1, 2) for name in ("rq", "microroughness.rms")}
COARSE = {"film.points": "33", "film.domain": "0.8 mm", "film.width": "0.4 mm", "control.mixed_instants": "4"}


def line(*changes: dict[str, str], **more: str) -> Scene:
    """Return the flank with changes, at the regression level."""
    merged: dict[str, str] = dict(FAST)
    for change in changes:
        merged |= change
    return Scene.from_toml("fzg_flank", merged | {name.replace("__", "."): value for name, value in more.items()})


def stressed(scene: Scene, load: float | None = None) -> stress.Stressed:
    """Return the cycles of new surfaces."""
    op = scene.operation.point if load is None else replace(scene.operation.point, load=load)
    case = Case.bind(scene, op)
    return stress.stressed(case, evaluate(case, tribofilms_of(means_of(scene, initial_state(scene)))))


def run(scene: Scene, steps: int, dt: float, state: ContactState | None = None) -> tuple[ContactState, Outputs]:
    """Return state and outputs after some steps at the scene's operating point."""
    state = state or initial_state(scene)
    outputs = state.outputs
    for _ in range(steps):
        state, outputs = advance(scene, scene.operation.point, state, dt)
    return state, outputs


def test_smooth_cycles_of_a_line_are_those_of_its_closed_form() -> None:
    """Half of the largest distance in the cycle of the deviator, in plane strain, at a few depths and two frictions."""
    depths, x = np.array([0.1, 0.3, 0.7, 1.5]), np.linspace(-40.0, 40.0, 20001)
    slope = line().stress.dang_van_slope
    for friction in (0.0, 0.08):
        (shear, _, _), peak = smooth_cycles(None, slope, 0.0).at(friction, np.zeros(1), depths)
        for k, depth in enumerate(depths):
            exact = line_stress(x, np.full_like(x, depth), 1.0, 1.0, 0.3, friction)
            mean = exact[:3].mean(axis=0)
            root_j2 = np.sqrt(0.5 * ((exact[:3] - mean) ** 2).sum(axis=0) + (exact[3:] ** 2).sum(axis=0))
            assert peak[k] == approx(np.sqrt(3.0) * root_j2.max(), rel=0.01)
            assert 0.5 * root_j2.max() <= shear[k, 0] * 1.01  # a sphere holds the way from zero to the largest
            assert shear[k, 0] <= root_j2.max()


def test_residual_stress_below_a_line_adds_to_its_von_mises_stress() -> None:
    depths, x, residual = np.array([0.1, 0.3, 0.7, 1.5]), np.linspace(-3.0, 3.0, 6001), 0.4
    _, peak = smooth_cycles(None, 0.2, residual).at(0.0, np.zeros(1), depths)
    along = residual * np.array([1.0, 1.0, 0.0, 0.0, 0.0, 0.0])[:, None]
    exact = [von_mises(line_stress(x, np.full_like(x, depth), 1.0, 1.0, 0.3) + along).max() for depth in depths]
    assert peak == approx(exact, rel=0.01)


def test_of_an_even_risk_the_share_down_to_a_depth_is_that_depth_over_the_deepest() -> None:
    """At the faces, halfway between the layers; nothing is known below the last one."""
    depths, even = np.array([1.0, 3.0, 4.0, 8.0]), np.ones(4)
    shares = [share_down_to(depth, even, depths) for depth in (0.5, 2.0, 3.5, 6.0, 8.0)]
    assert shares == approx([0.0, 2.0 / 8.0, 3.5 / 8.0, 6.0 / 8.0, 1.0])


def test_smooth_bodies_have_the_stress_of_hertz_and_scale_with_his_pressure() -> None:
    """The largest von Mises stress of a line is .557 p_H deep below it; a film's friction changes next to nothing."""
    scene = line(SMOOTH, stress__layers="24")
    pressure = scene.hertz(scene.operation.load).pressure_max
    found = stressed(scene)
    assert found.outputs["von_mises_max"] == approx(0.557 * pressure, rel=0.02)
    assert found.outputs["near_surface_share"] < 0.05
    shear = found.cycles.shear
    assert np.all(shear == shear[:1, :, :, :1])  # of both bodies, of all classes
    deep = replace(scene, operation=replace(scene.operation, load=4.0 * scene.operation.load))
    deeper = 2.0 * scene.depths[4:]  # as deep in half widths
    at = np.interp(deeper, deep.depths, stressed(deep).cycles.shear[0, :, 0, 0])
    assert at == approx(2.0 * shear[0, 4:, 0, 0], rel=0.03)


def test_a_body_meets_the_roughness_of_the_other_by_what_slides_past_a_point_on_its_way() -> None:
    """The way 2 a of 10 lengths takes 2 a / u, in which u_s 2 a / u of the other body pass: 10 u_s / u lengths."""
    assert meetings((0.5, 0.3), 10.0, (0.0, 1.0)) == approx([10.0 * 0.2 / 0.5, 0.0])  # all roughness is body 2's
    assert meetings((0.5, 0.3), 10.0, (1.0, 0.0)) == approx([0.0, 10.0 * 0.2 / 0.3])
    assert not meetings((0.4, 0.4), 10.0, (0.5, 0.5)).any()  # in rolling the same asperities stay together


def test_a_residual_stress_adds_its_hydrostatic_part_to_every_cycle_and_nothing_to_its_shear() -> None:
    """Along the surface in both directions: 2/3 of it, by superposition."""
    none, pressed = (stressed(line(stress__residual=given)) for given in ("0 Pa", "9 GPa"))
    torsion, bending = 361.4e6, 625.9e6
    dang_van, crossland = 3.0 * (torsion / bending - 0.5), 3.0 * torsion / bending - 3.0**0.5
    for part, weight in (("shear", 0.0), ("hydrostatic", 1.0), ("dang_van", dang_van)):
        before, after = getattr(none.cycles, part), getattr(pressed.cycles, part)
        assert after - before == approx(np.full_like(before, weight * 6e9), abs=1e-6 * 9e9)
    for name, weight in (("dang_van_ratio", dang_van), ("crossland_ratio", crossland)):
        assert pressed.outputs[name] - none.outputs[name] == approx(weight * 6e9 / torsion, rel=1e-6)
    assert pressed.outputs["von_mises_max"] > 8.9e9  # of the residual stress alone, beside the contact


def test_the_error_of_damage_is_that_of_stresses_off_by_their_half_width_and_wider_beyond_the_fit() -> None:
    """Damage rises with the eighth power of the stress; of half the error the half width would be a third smaller."""
    within = line(BASQUIN | ENDLESS)
    steep = line(BASQUIN | ENDLESS, surface_1__rq="2 um", surface_2__rq="2 um")
    point, fresh = within.operation.point, means_of(within, initial_state(within))
    rubbed = tuple(changed(mean, roughness=0.5 * mean.roughness) for mean in fresh)
    assert width_of(within, point, fresh) == approx(HALF_WIDTH, rel=1e-9)
    slow = replace(point, speed_1=1e-4 * point.speed_1, speed_2=1e-4 * point.speed_2)
    skids = replace(point, speed_2=0.2 * point.speed_1)
    for scene, op, means in (
        (steep, point, means_of(steep, initial_state(steep))),
        (within, slow, fresh),
        (within, skids, fresh),
        (within, point, rubbed),
    ):
        assert width_of(scene, op, means) > 1.5 * HALF_WIDTH


def width_of(scene: Scene, op: Any, means: Any) -> float:
    """Return the half width of stresses that the error of damage is of."""
    case = Case.bind(scene, op)
    harm = fatigue.harm_by(case, evaluate(case, tribofilms_of(means)))
    below = fatigue.outputs_below(case, Outputs(), harm, unharmed_classes(scene.depths.size, 1), means)
    return float((1.0 + below["error_damage"]) ** (1.0 / 8.0) - 1.0)


def test_the_error_of_damage_is_that_of_the_less_sure_body_and_pits_stay() -> None:
    """Whatever rates tell of a class now."""
    scene = line(BASQUIN)
    case, means = Case.bind(scene, scene.operation.point), means_of(scene, initial_state(scene))
    fresh = unharmed_classes(scene.depths.size, 1)
    once = np.full((2, scene.depths.size, 1, WEIGHTS.size), 1e-9)
    for factors in ((1.2, 3.0), (3.0, 1.2)):
        more = once * np.array(factors)[:, None, None, None]
        harm = fatigue.Harm({}, once, more)
        before = Outputs(micropitted_area_1=0.2, micropitted_area_2=0.1)
        found = fatigue.outputs_below(case, before, harm, fresh, means)
        assert found["error_damage"] == approx(2.0)
        assert (found["micropitted_area_1"], found["micropitted_area_2"]) == (0.2, 0.1)


def test_solids_and_oil_shear_alike_what_is_below() -> None:
    scene = line()
    case = Case.bind(scene, scene.operation.point)
    contact = evaluate(case, tribofilms_of(means_of(scene, initial_state(scene))))
    force = 0.2 * case.op.load
    solids, oil, none = (
        stress.stressed(case, contact._replace(solid=solid, fluid=fluid)).cycles.dang_van
        for solid, fluid in ((force, 0.0), (0.0, force), (0.0, 0.0))
    )
    assert np.array_equal(solids, oil)
    assert np.all(solids[:, 0] > none[:, 0])


def test_a_smooth_body_that_slides_along_a_rough_one_is_loaded_more_evenly() -> None:
    """Each of its points meets many asperities; one of the rough body always its own. Its length is nobody's."""
    one_way = line(surface_1__rq="0 nm", stress__layers="4")
    point = replace(one_way.operation.point, speed_1=1.2, speed_2=1.0)

    def cycles(scene: Scene) -> Any:
        case = Case.bind(scene, point)
        return stress.stressed(case, evaluate(case, tribofilms_of(means_of(scene, initial_state(scene))))).cycles

    smooth, rough = cycles(one_way).shear[:, 0, 0]
    assert np.ptp(smooth) < np.ptp(rough)
    assert smooth[0] > rough[0]
    other = line(surface_1__rq="0 nm", stress__layers="4", surface_1__correlation_length="60 um")
    assert cycles(other).shear == approx(cycles(one_way).shear, rel=1e-9)


def test_classes_that_fail_in_a_long_step_do_so_one_after_the_other() -> None:
    """As in many short ones: what lies in a pit gains nothing more, and all others as much as ever."""
    scene = line(BASQUIN)
    case, start = Case.bind(scene, scene.operation.point), means_of(scene, initial_state(scene))
    harm = fatigue.harm_by(case, evaluate(case, tribofilms_of(start)))
    lasts = 1.0 / float(harm.per_cycle.max())
    found = []
    for steps in (1, 300):
        classes, then = unharmed_classes(scene.depths.size, 1), start
        for _ in range(steps):
            now = tuple(changed(mean, cycles=mean.cycles + 6.0 * lasts / steps) for mean in then)
            classes, then = fatigue.fatigued(scene, classes, harm, then, now), now  # type: ignore[arg-type]
        found.append(classes)
    once, often = found
    assert 0 < np.count_nonzero(often.pits_1) < WEIGHTS.size
    assert np.array_equal(once.pits_1 > 0.0, often.pits_1 > 0.0)
    assert once.pits_1 == approx(often.pits_1, rel=0.1)


def test_fainter_roughness_ends_at_the_smooth_bodies() -> None:
    """Without a jump, whatever the class."""
    faint = {f"surface_{i}.rq": "1e-13 m" for i in (1, 2)}
    none = {f"surface_{i}.rq": "0 m" for i in (1, 2)}
    one, other = stressed(line(faint)), stressed(line(none))
    for rough, smooth in zip(one.cycles, other.cycles, strict=True):
        assert rough == approx(np.broadcast_to(smooth, rough.shape), rel=2e-3)
    assert one.outputs["von_mises_max"] == approx(other.outputs["von_mises_max"], rel=2e-3)


def test_rough_classes_rise_in_order_and_fade_with_depth() -> None:
    """The upper classes are loaded more, most of all near the surface."""
    shear = stressed(line()).cycles.shear
    assert np.all(np.diff(shear, axis=3) >= 0.0)
    apart = shear[:, :, 0, -1] / shear[:, :, 0, 0]
    assert apart[0, 0] > 3.0 * apart[0, -1]
    flat = CURVES.pressures.at(_rough(steepness=0.01), np.ones(1))[0]
    assert flat == approx(0.5 * 0.01, rel=0.05)  # what presses steep waves flat, Persson's


def _rough(**changes: Any) -> Any:
    plain = {"steepness": 1.0, "clearance": 0.0, "slip": 0.0, "load_ratio": 1.0, "spots": 100.0}
    return stress.Rough(**(plain | changes), meetings=np.zeros(2), depths=np.ones(1))


def test_constant_cycles_add_up_whatever_the_steps() -> None:
    """Palmgren and Miner: damage in proportion to the cycles, to rounding, up to the first that fail."""
    scene = line(BASQUIN)
    case, start = Case.bind(scene, scene.operation.point), means_of(scene, initial_state(scene))
    harm = fatigue.harm_by(case, evaluate(case, tribofilms_of(start)))
    lasts = 1.0 / float(harm.per_cycle.max())

    def after(steps: int) -> Classes:
        classes, then = unharmed_classes(scene.depths.size, 1), start
        for _ in range(steps):
            now = tuple(changed(mean, cycles=mean.cycles + 0.9 * lasts / steps) for mean in then)
            classes, then = fatigue.fatigued(scene, classes, harm, then, now), now  # type: ignore[arg-type]
        return classes

    once, often = after(1), after(7)
    assert once.damage_1.max() == approx(0.9, rel=1e-12) or once.damage_2.max() == approx(0.9, rel=1e-12)
    assert often.damage_1 == approx(once.damage_1, rel=1e-12)
    assert not once.pits_1.any()


def test_wear_in_small_steps_brings_damage_up_and_off() -> None:
    """Damage at one depth comes to the surface as the body wears, and is gone once that depth is."""
    scene = line(BASQUIN)
    case, start = Case.bind(scene, scene.operation.point), means_of(scene, initial_state(scene))
    harm, depths = fatigue.harm_by(case, evaluate(case, tribofilms_of(start))), scene.depths
    fresh = unharmed_classes(depths.size, 1)
    buried = fresh.damage_1.copy()
    buried[4] = 0.5
    classes, then = replace(fresh, damage_1=buried), start
    tops = []
    for _ in range(6000):
        now = tuple(changed(mean, wear=mean.wear + 5e-4 * depths[4]) for mean in then)
        classes, then = fatigue.fatigued(scene, classes, harm, then, now), now  # type: ignore[arg-type]
        tops.append(classes.damage_1[0, 0])
    assert tops[0] == 0.0
    assert max(tops) > 0.15
    assert tops[-1] < 0.03
    assert classes.damage_1.max() < 0.15


def test_pits_grow_without_jumps_and_less_where_wear_is_faster() -> None:
    """Wear takes away what is damaged before it breaks out."""
    areas = {}
    for wear in ("0", "1e-3"):
        scene = line(BASQUIN, {"fatigue.reference_stress": "600 MPa"}, wear__bare=wear, wear__film=wear)
        state, seen = initial_state(scene), []
        for _ in range(60):
            state, outputs = advance(scene, scene.operation.point, state, 60.0)
            seen.append(outputs.micropitted_area_1)
        assert np.all(np.diff(seen) >= -1e-12)
        assert np.diff(seen).max() < 0.05
        areas[wear] = seen[-1]
        assert outputs.profile_loss_1 >= outputs.wear_depth_1
        assert outputs.error_damage > 1.0
    assert areas["0"] > 0.02
    assert areas["1e-3"] < 0.7 * areas["0"]


def test_a_class_breaks_out_once() -> None:
    """What lies in a pit carries nothing, however long the run: no pit is deeper than the layers are."""
    scene = line(BASQUIN, NO_WEAR, {"fatigue.reference_stress": "300 MPa"})
    state, outputs = run(scene, 4, 3600.0)
    assert state.classes is not None
    assert outputs.micropitted_area_1 > 0.3
    assert 0.0 < max(state.classes.pits_1.max(), state.classes.pits_2.max()) <= 1.5 * scene.depths[-1]
    assert outputs.profile_loss_1 < scene.depths[-1]


def test_a_step_taken_back_leaves_no_trace() -> None:
    """The same step from a state, or from its bytes, gives the same bytes."""
    scene = line(BASQUIN)
    state, _ = run(scene, 3, 200.0)
    before = state.to_bytes()
    once, again = run(scene, 1, 200.0, state)[0], run(scene, 1, 200.0, state)[0]
    stored = ContactState.from_bytes(before, scene)
    assert state.to_bytes() == before
    assert once.to_bytes() == again.to_bytes() == run(scene, 1, 200.0, stored)[0].to_bytes()


def test_without_stress_nothing_is_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nor kept."""

    def fails(*_: Any) -> None:
        raise AssertionError("stresses that nobody asked for")

    monkeypatch.setattr("contact_core.regression.fatigue.stressed", fails)
    scene = Scene.from_toml("fzg_flank", {"film.model": "regression"})
    state, outputs = run(scene, 2, 60.0)
    assert state.classes is None and state.below is None
    assert outputs.von_mises_max == outputs.damage_1 == outputs.error_damage == 0.0


def test_an_unloaded_contact_does_no_damage() -> None:
    """What there was stays."""
    scene = line(BASQUIN, NO_WEAR)
    state, _ = run(scene, 1, 60.0)
    after, outputs = advance(scene, replace(scene.operation.point, load=0.0), state, 60.0)
    assert state.classes is not None and after.classes is not None
    assert after.classes.alike(state.classes)
    assert outputs.von_mises_max == 0.0
    assert outputs.damage_1 > 0.0


def test_the_change_of_level_keeps_damage_and_pits() -> None:
    """There and back nothing changes bit for bit; what the classes gain comes back to the patches."""
    deep = line(BASQUIN, COARSE).at_level("deterministic")
    quick = deep.at_level("regression")
    state, _ = run(deep, 2, 5.0)
    assert state.below is not None and state.below.damage_1.max() > 0.0
    same, _ = advance(quick, quick.operation.point, state, 0.0)
    assert same.classes is not None
    back = folded(quick, same)
    assert back.classes is None and back.below is state.below
    later, outputs = run(quick, 3, 10.0, state)
    assert later.classes is not None
    after = folded(quick, later)
    assert after.below is not None
    layers = after.below.damage_1.reshape(quick.depths.size, -1)
    told = later.classes.damage_1.reshape(quick.depths.size, 1, -1) @ WEIGHTS
    assert layers.mean(axis=1) == approx(told[:, 0], rel=0.1)  # classes of whole nodes
    pits = float(after.bodies[0].pits.mean())
    assert pits == approx(outputs.profile_loss_1 - outputs.wear_depth_1, rel=0.1, abs=1e-12)
    assert advance(deep, deep.operation.point, after, 1.0)[1].damage_1 > 0.0


def test_damage_of_a_new_contact_comes_to_the_patches_by_height() -> None:
    """A run that begins at the regression level has no field below: the highest points are taken as the most loaded."""
    scene = line(BASQUIN, COARSE, NO_WEAR)
    state, outputs = run(scene, 1, 60.0)
    after = folded(scene, state)
    assert after.below is not None
    worst = [damage.reshape(scene.depths.size, -1).max(axis=0) for damage in after.below.damage]
    for heights, each in zip(bare_heights(scene, scene.rows), worst, strict=True):
        assert np.all(np.diff(each[np.argsort(heights, axis=None)]) >= 0.0)
    # the error of what the curves have added stays with it
    assert after.below.late == approx([outputs.error_damage * each.mean() for each in worst], rel=1e-9)
    assert isinstance(state.classes, Classes)
    assert after.below.damage_1.max() == approx(min(state.classes.damage_1.max(), 1.0), rel=1e-9)
