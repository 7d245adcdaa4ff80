"""The level `map`: the regression level, corrected by a map of its scene."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from comparison import approx
from mapped_scene import NOISE, chart, drawn, histories, knots, mapped_scene, scene_of

from contact_core import Error, OperatingPoint, Outputs, RangeFlag, Scene, advance, initial_state, uncertainty
from contact_core.corrections.fitting import Rule, bounded, design, left_out, spread_at, widths_at
from contact_core.corrections.knot import _knot, contact_of, samples_of
from contact_core.corrections.map import Map, digest_of, read, shipped_maps
from contact_core.corrections.query import half_widths_of, here, leverage, told, total, trusted
from contact_core.errors import SceneError
from contact_core.scene import Case
from contact_core.state import changed

STATED = (0.3, 0.4, 0.2)  # half widths of the regression level
NAMES = ("friction_coefficient", "h_c", "contact_load_ratio")
ERRORS = ("error_friction", "error_film", "error_load_ratio")


def at(scene: Scene, point: OperatingPoint, dt: float = 0.0) -> Outputs:
    return advance(scene, point, initial_state(scene), dt)[1]


def test_a_query_is_the_polynomials_that_were_fitted() -> None:
    scene, found = scene_of(), knots(40)
    samples = samples_of(scene, histories(5))
    columns, wide = design(chart(), samples.places), spread_at(chart(), samples.places)
    off, alone = bounded(columns @ np.array(chart().weights).T, samples.shares), widths_at(chart(), samples.places)
    for k, knot in enumerate(found):
        case, contact = contact_of(scene, knot)
        place = here(chart(), case, contact)
        assert place.terms == approx(columns[k].tolist(), rel=1e-12, abs=1e-15)
        assert math.sqrt(1.0 + leverage(chart(), place.terms)) == approx(wide[k], rel=1e-9)
        assert place.trust == 1.0
        answer = told(chart(), place, contact.load_ratio)
        assert math.log(answer.friction) == approx(off[k, 0], rel=1e-9, abs=1e-12)
        assert math.log(answer.film) == approx(off[k, 1], rel=1e-9, abs=1e-12)
        assert answer.load_ratio - contact.load_ratio == approx(off[k, 2], rel=1e-9, abs=1e-12)
        own = [math.exp(total(weights, place.scaled)) for weights in chart().own]
        assert half_widths_of(chart(), place, STATED) == approx(tuple(np.hypot(alone[k], own)), rel=1e-9)


def test_a_knot_tells_what_all_blocks_share_of_its_errors_from_the_scatter_of_its_own(monkeypatch) -> None:
    scene = scene_of()
    case = Case.bind(scene.at_level("deterministic"), scene.operation.point)
    out = changed(Outputs(), friction_force=-10.0, h_c=1e-7, contact_load_ratio=0.5)
    state = changed(initial_state(scene), outputs=out)
    error = Error(grid=3.0, iteration=4.0, inlet=12.0, sampling=2.0, time=5.0)
    found = {"friction_force": error, "h_c": error.scaled(1e-8), "contact_load_ratio": error.scaled(0.01)}
    monkeypatch.setattr("contact_core.deterministic.errors_of", lambda scene, state: found)
    knot = _knot(case, knots(1)[0].means, state)
    assert knot.shared == approx((1.3, 1.3, 0.13))  # friction and film relative, W_c absolute
    assert knot.scatter == approx((0.2, 0.2, 0.02))


def test_the_variance_is_that_of_least_squares_by_its_textbook_formula() -> None:
    samples = samples_of(scene_of(), histories(20))
    columns = design(chart(), samples.places)
    squares = columns.T @ columns + Rule().ridge * np.diag([0.0] + [1.0] * (columns.shape[1] - 1))
    expected = np.einsum("ij,jk,ik->i", columns, np.linalg.inv(squares), columns)
    assert spread_at(chart(), samples.places) ** 2 - 1.0 == approx(expected, rel=1e-9)


def test_the_errors_cover_solutions_and_would_not_if_they_were_a_tenth(tmp_path: Path) -> None:
    scene = mapped_scene(tmp_path)
    inside = dict.fromkeys(NAMES, 0)
    narrower = dict.fromkeys(NAMES, 0)
    asked = knots(60, seed=2)  # none of which the map knows
    for knot in asked:
        state = replace(initial_state(scene), means=knot.means)
        out = advance(scene, knot.point, state, 0.0)[1]
        for name, error, exact in zip(NAMES, ERRORS, knot.found, strict=True):
            half = getattr(out, error) * (1.0 if name == "contact_load_ratio" else exact)
            inside[name] += abs(getattr(out, name) - exact) <= half
            narrower[name] += abs(getattr(out, name) - exact) <= 0.1 * half
    assert all(count >= 0.9 * len(asked) for count in inside.values()), inside
    assert all(count < 0.3 * len(asked) for count in narrower.values()), narrower


def test_a_map_narrows_the_errors_of_the_regression_level_and_takes_its_deviation_away(tmp_path: Path) -> None:
    scene, fast = mapped_scene(tmp_path), scene_of()
    point = scene.operation.point
    out, quick = at(scene, point), at(fast, point)
    assert out.error_friction < 0.5 * quick.error_friction
    assert out.error_film < 0.5 * quick.error_film
    ratio = out.friction_coefficient / quick.friction_coefficient
    assert out.power_loss / quick.power_loss == approx(ratio)
    assert out.friction_force / quick.friction_force == approx(ratio)
    assert out.h_c / quick.h_c == approx(math.exp(-0.2 - 0.05 * math.log(_pressed(fast))), rel=0.03)
    assert out.wear_rate_2 > quick.wear_rate_2
    errors = uncertainty(scene, advance(scene, point, initial_state(scene), 0.0)[0])
    assert errors["h_c"].together == approx(out.h_c * out.error_film)


def _pressed(scene: Scene) -> float:
    return scene.hertz(scene.operation.load).pressure_max / scene.plasticity.hardness


@pytest.mark.parametrize(
    "point",
    [
        OperatingPoint(0.0, 0.1, 0.09, 353.0),
        OperatingPoint(50.0, 0.0, 0.0, 353.0),
    ],
    ids=["no load", "at rest"],
)
def test_where_nothing_rubs_all_is_that_of_the_regression_level_to_the_bit(tmp_path: Path, point) -> None:
    scene = mapped_scene(tmp_path)
    assert at(scene, point) == at(scene.at_level("regression"), point)


@pytest.mark.parametrize("least", [1e-3, 1e-6, 1e-9])
def test_without_a_load_there_is_no_correction_and_toward_it_none(tmp_path: Path, least: float) -> None:
    scene = mapped_scene(tmp_path)
    lighter = replace(scene.operation.point, load=scene.operation.point.load * least)
    out, quick = at(scene, lighter), at(scene.at_level("regression"), lighter)
    assert out.h_c == approx(quick.h_c, rel=1e-12)
    assert out.friction_coefficient == approx(quick.friction_coefficient, rel=1e-12)


@pytest.mark.parametrize("least", [1e-3, 1e-6, 1e-9])
def test_toward_pure_rolling_friction_loses_its_correction_and_the_film_keeps_it(tmp_path: Path, least: float) -> None:
    scene = mapped_scene(tmp_path)
    own = scene.operation.point
    rolling = replace(own, speed_1=own.speed_2)
    creeping = replace(own, speed_1=own.speed_2 * (1.0 + 0.005 * least))
    out, quick = at(scene, creeping), at(scene.at_level("regression"), creeping)
    assert abs(math.log(out.friction_coefficient / quick.friction_coefficient)) <= 0.3 * 1.1 * least
    assert out.error_friction == approx(quick.error_friction, rel=2.0 * least)
    still, raw = at(scene, rolling), at(scene.at_level("regression"), rolling)
    assert still.h_c == approx(out.h_c, rel=100.0 * least)
    assert still.contact_load_ratio == approx(out.contact_load_ratio, rel=100.0 * least)
    assert still.error_film == approx(out.error_film, rel=100.0 * least)
    assert abs(math.log(still.h_c / raw.h_c)) > 0.02
    assert still.friction_force == 0.0
    for each in (out, still):
        assert RangeFlag.OUTSIDE_FIT in RangeFlag(each.range_flags)


@pytest.mark.parametrize(
    ("name", "step"), [("speed_1", 1e-6), ("speed_2", 1e-6), ("load", 1e-3), ("temperature", 0.01)]
)
def test_derivatives_of_the_friction_are_those_of_the_corrected_one(tmp_path: Path, name: str, step: float) -> None:
    scene = mapped_scene(tmp_path)
    own = scene.operation.point
    more, less = (at(scene, replace(own, **{name: getattr(own, name) + sign * step})) for sign in (1.0, -1.0))
    seen = (more.friction_force - less.friction_force) / (2.0 * step)
    assert getattr(at(scene, own), f"dfriction_d{name}") == approx(seen, rel=1e-3)


@pytest.mark.parametrize(("halves", "trust"), [(-1.0, 1.0), (1.25, 0.75), (-1.5, 0.5), (2.0, 0.0), (9.0, 0.0)])
def test_within_half_a_range_beyond_the_knots_a_map_fades_out(halves: float, trust: float) -> None:
    """By each coordinate alike; the worst one rules."""
    known = chart()
    for k in range(len(known.centres)):
        place = [
            centre + half * (halves if i == k else 0.3)
            for i, (centre, half) in enumerate(zip(known.centres, known.halves, strict=True))
        ]
        assert trusted(known, place) == approx(trust, abs=1e-12)


def test_nothing_jumps_at_the_border_of_the_ranges(tmp_path: Path) -> None:
    scene = mapped_scene(tmp_path)
    own = scene.operation.point
    loads = own.load * np.geomspace(0.01, 0.4, 400)
    films = np.log([at(scene, replace(own, load=float(load))).h_c for load in loads])
    assert np.abs(np.diff(films)).max() < 0.01


def test_outside_its_ranges_it_is_the_regression_level_with_that_one_s_half_widths_and_says_so(tmp_path: Path) -> None:
    scene = mapped_scene(tmp_path)
    far = replace(scene.operation.point, speed_1=20.5, speed_2=19.5)
    out, quick = at(scene, far), at(scene.at_level("regression"), far)
    for name in (*NAMES, *ERRORS):
        assert getattr(out, name) == approx(getattr(quick, name), rel=1e-9)
    assert RangeFlag.OUTSIDE_FIT in RangeFlag(out.range_flags)
    assert RangeFlag.OUTSIDE_FIT not in RangeFlag(at(scene, scene.operation.point).range_flags)


@pytest.mark.parametrize("change", [{"spin": 5.0}, {"radius_x": 9.0e-3}])
def test_inputs_that_no_knot_has_are_outside(tmp_path: Path, change: dict[str, float]) -> None:
    scene = mapped_scene(tmp_path)
    point = replace(scene.operation.point, **change)
    out, quick = at(scene, point), at(scene.at_level("regression"), point)
    assert out.h_c == quick.h_c
    assert RangeFlag.OUTSIDE_FIT in RangeFlag(out.range_flags)


def test_a_text_gives_the_same_map_again() -> None:
    assert Map.from_text(chart().to_text(), "map") == chart()
    assert len(chart().to_text()) < 2_000_000


def test_a_query_costs_little() -> None:
    assert chart().cost <= 1500


@pytest.mark.parametrize(
    ("change", "value"), [("surface_2__seed", "9"), ("wear__bare", "2e-5"), ("film__floor", "2 nm")]
)
def test_the_map_of_another_scene_is_refused(tmp_path: Path, change: str, value: str) -> None:
    scene = mapped_scene(tmp_path, **{change: value})
    with pytest.raises(SceneError, match=r"another contact .* tribofmu map mtm_zddp"):
        at(scene, scene.operation.point)


def test_duty_control_and_name_of_a_scene_leave_it_its_map() -> None:
    scene = scene_of()
    same = scene_of(operation__load="20 N", control__change="1 nm", tribofilm__beyond_fit="extrapolate")
    assert digest_of(replace(same, name="another", description="")) == digest_of(scene)
    assert digest_of(scene.at_level("deterministic")) == digest_of(scene)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "damaged"),
        ("[]", "damaged"),
        (json.dumps({"format": 0}), "format 0; this version reads 2"),
        (json.dumps({"format": 2}), "damaged"),
    ],
)
def test_a_file_that_is_no_map_is_refused(tmp_path: Path, text: str, message: str) -> None:
    scene = mapped_scene(tmp_path)
    (tmp_path / "map.json").write_text(text, "utf-8")
    with pytest.raises(SceneError, match=message):
        at(scene, scene.operation.point)


@pytest.mark.parametrize(("file", "message"), [("none", "no shipped map 'none'"), ("none.json", "cannot be read")])
def test_a_map_that_is_not_there_is_refused_with_a_way_out(file: str, message: str) -> None:
    scene = scene_of().at_level("map")
    scene = replace(scene, film=replace(scene.film, file=file))
    with pytest.raises(SceneError, match=message + ".*tribofmu map"):
        at(scene, scene.operation.point)


def test_a_map_is_found_beside_the_file_of_its_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    table = mapped_scene(tmp_path).to_dict()
    table["film"]["file"] = "map.json"
    scene = Scene.from_dict(table, tmp_path)
    monkeypatch.chdir("/")
    assert at(scene, scene.operation.point).error_friction < 0.1


def test_knots_are_drawn_by_their_number_alone() -> None:
    assert drawn(5) == drawn(5)
    assert drawn(5) != drawn(6)
    assert drawn(5) != drawn(5, seed=2)


def test_half_widths_are_found_without_the_contacts_that_they_are_of() -> None:
    samples = samples_of(scene_of(), histories(5))
    off, _ = left_out(samples, Rule(degree=2, sparse=False, ridge=1e-6))  # as many terms as contacts
    assert np.sqrt(np.mean(off[:, 0] ** 2)) > 1.5 * NOISE


def test_shipped_maps_are_small_and_cheap_and_of_the_shipped_scenes() -> None:
    for name in shipped_maps():
        found, scene = read(name), Scene.from_toml(name).at_level("map")
        assert found.digest == digest_of(scene)
        assert found.cost <= 1500
        assert len(found.to_text()) < 2_000_000
        speeds = np.geomspace(*next(ends for key, *ends in found.ranges if key == "entrainment"), 60)
        point, slip = (
            scene.operation.point,
            abs(scene.operation.point.sliding_speed / scene.operation.point.entrainment_speed),
        )
        outs = [
            at(scene, replace(point, speed_1=u * (1 + 0.5 * slip), speed_2=u * (1 - 0.5 * slip)))
            for u in map(float, speeds)
        ]
        inside = [out for out in outs if not out.range_flags & RangeFlag.OUTSIDE_FIT]
        assert len(inside) > 30
        assert (np.diff([out.h_c for out in inside]) > 0.0).all()
