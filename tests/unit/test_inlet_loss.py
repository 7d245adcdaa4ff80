"""Film that is missing where a domain ends within the inlet: what is stated of it, and domains chosen long enough."""

import tomllib
from importlib import resources

import pytest
from comparison import approx

from contact_core import Error, Outputs, Scene, line_contact, point_contact
from contact_core.deterministic.solution_error import with_errors_of_the_solution
from contact_core.film.inlet_loss import inlets_for, lost_film
from contact_core.film.lengths import FAR_FIELD_BELOW, inlet_length
from contact_core.laws.viscosity import Barus
from contact_core.reference import hertz_point
from contact_core.scene import Case
from contact_core.shapes import Line, Point

RADIUS, STEEL, RUBBER = 10e-3, 230e9, 10e6
CIRCLE, SLIM, WIDE, LINE = Point(RADIUS, RADIUS), Point(RADIUS, 3e-3), Point(RADIUS, 50e-3), Line(RADIUS, 1.0)
# shape, U, G, W, and the loss of the central film with so many lengths of the inlet: docs/measured/film.md
MEASURED = {
    "light load": (CIRCLE, 1e-12, 4600.0, 1e-7, STEEL, {0.79: 0.211, 1.58: 0.079, 2.97: 0.0223, 5.93: 0.0036}),
    "heavy load": (CIRCLE, 1e-11, 4600.0, 1e-5, STEEL, {0.81: 0.253, 1.47: 0.120, 2.14: 0.065, 4.14: 0.0171}),
    "far field": (CIRCLE, 1e-10, 1000.0, 1e-6, STEEL, {0.65: 0.0446, 1.03: 0.0174, 1.55: 0.0043}),
    "rubber": (CIRCLE, 1e-7, 0.2, 1e-3, RUBBER, {0.76: 0.087, 2.09: 0.0199, 4.09: 0.0055}),
    "slim": (SLIM, 1e-11, 4600.0, 1e-5, STEEL, {0.82: 0.272, 2.15: 0.070, 4.15: 0.0172}),
    "wide": (WIDE, 1e-10, 4600.0, 1e-5, STEEL, {0.67: 0.279, 2.00: 0.055, 4.00: 0.0117}),
    "line": (LINE, 1e-10, 4600.0, 1e-4, STEEL, {0.70: 0.423, 1.95: 0.135, 4.05: 0.0343}),
    "rubber line": (LINE, 1e-8, 0.2, 1e-3, RUBBER, {0.87: 0.194, 2.87: 0.043, 5.87: 0.0126}),
}
# the same of smooth bodies of shipped scenes, over the film that is found
CUT = {"ball_209_inner": {"film.domain": "0.3 mm", "film.points": "65"}}  # in place of its own
SCENES = {"ball_209_inner": 0.249, "dimple_rolling": 0.0245, "fzg_flank": 0.0118, "cam_tappet": 0.0032}
BALL = {
    "load": 20.0, "radius_x": RADIUS, "reduced_modulus": STEEL, "speed_1": 2.0, "speed_2": 2.0, "viscosity": 0.02,
    "pressure_viscosity": 2e-8,
}  # fmt: skip
TWENTY_LINES = resources.files("system_models.cli").joinpath("new_scene.toml").read_text("utf-8")
FAST = {"speed_1": "10 m/s", "speed_2": "10 m/s", "load": "500 N", "temperature": "60 degC", "duration": "120 s"}


def scene_of(name):
    """A shipped scene, on a domain that cuts the inlet off where its own does not."""
    return Scene.from_toml(name, CUT.get(name, {}))


def smooth(shape, speed, material, load, modulus):
    """Half width, smooth contact and length of the inlet."""
    newtons = load * modulus * RADIUS * (1.0 if shape is LINE else RADIUS)
    oil = Barus(speed * modulus * RADIUS, 300.0, material / modulus, 0.0)
    contact, a = shape.smooth(newtons, 1.0, oil, 300.0, modulus), shape.hertz(newtons, modulus).a
    return a, contact, inlet_length(a, shape, contact.film)


@pytest.mark.parametrize("case", MEASURED)
def test_what_is_stated_covers_measured_losses_and_a_tenth_of_it_would_not(case):
    shape, *numbers, measured = MEASURED[case]
    a, contact, d = smooth(shape, *numbers)
    pairs = [(lost / (1.0 - lost), lost_film(a + n * d, a, shape, contact)) for n, lost in measured.items()]
    assert all(true <= stated for true, stated in pairs), pairs
    assert all(true > 0.1 * stated for true, stated in pairs), pairs


def test_what_is_stated_covers_the_shipped_scenes_and_a_tenth_of_it_would_not():
    cases = {name: Case.bind(scene := scene_of(name), scene.operation.point) for name in SCENES}
    assert all(true <= cases[name].missing_film for name, true in SCENES.items())
    assert all(true > 0.1 * cases[name].missing_film for name, true in SCENES.items())


@pytest.mark.parametrize("shape", [CIRCLE, LINE])
def test_the_room_for_a_loss_has_that_loss(shape):
    a, contact, d = smooth(shape, 1e-11, 4600.0, 1e-5, STEEL)
    stated = lost_film(a + inlets_for(0.02, shape) * d, a, shape, contact)
    assert stated / (1.0 + stated) == approx(0.02)


def test_a_meniscus_on_the_domain_and_a_contact_at_rest_lose_nothing():
    a, contact, d = smooth(CIRCLE, 1e-11, 4600.0, 1e-5, STEEL)
    assert lost_film(a + d, a, CIRCLE, contact, meniscus=a + 0.5 * d) == 0.0
    assert lost_film(a + d, a, CIRCLE, contact, meniscus=a + 2.0 * d) == lost_film(a + d, a, CIRCLE, contact) > 0.1
    at_rest = CIRCLE.smooth(1.0, 0.0, Barus(0.02, 300.0, 2e-8, 0.0), 300.0, STEEL)
    assert lost_film(1.2 * a, a, CIRCLE, at_rest) == 0.0


def test_a_layer_of_oil_ends_the_far_field_of_a_light_point():
    a, contact, d = smooth(CIRCLE, 1e-10, 1000.0, 1e-6, STEEL)
    assert contact.circular_load < FAR_FIELD_BELOW
    assert lost_film(a + d, a, CIRCLE, contact, layer=1e-6) > 5.0 * lost_film(a + d, a, CIRCLE, contact)


# ---- errors of outputs


def errors_of(scene, **outputs):
    case = Case.bind(scene, scene.operation.point)
    names = "h_c", "lambda_ratio", "contact_load_ratio", "friction_force", "wear_depth_1", "roughness_1", "pressure_max"
    found = {name: Error() for name in names}
    return case, with_errors_of_the_solution(case, Outputs(**outputs), found)


def test_a_domain_that_cuts_the_inlet_off_is_a_cause_of_errors():
    out = {"h_c": 2e-7, "contact_load_ratio": 0.3, "friction_force": 10.0, "friction_solid": 8.0, "wear_depth_1": 1e-8}
    out |= {"roughness_1": 1e-8, "pressure_max": 1e9}
    case, found = errors_of(scene_of("ball_209_inner"), **out)
    assert found["h_c"].inlet == approx(0.7 * case.missing_film * 2e-7)
    assert found["h_c"].together > found["h_c"].inlet > found["h_c"].grid
    assert found["roughness_1"].inlet == 0.0 < found["pressure_max"].inlet < 1e9 * case.missing_film
    assert all(found[name].inlet > 0.0 for name in ("contact_load_ratio", "friction_force", "wear_depth_1"))


def test_a_loss_that_is_negligible_beside_other_errors_changes_none():
    case, found = errors_of(Scene.from_toml("mtm_zddp"), h_c=5e-8, contact_load_ratio=0.5)
    assert case.missing_film > 0.0
    assert {error.inlet for error in found.values()} == {0.0}


# ---- domains that are chosen


def twenty_lines(**operation):
    table = tomllib.loads(TWENTY_LINES)
    return table | {"name": "ball", "operation": FAST | operation}


@pytest.mark.parametrize("geometry", [{}, {"model": "line", "face_width": "8 mm"}])
@pytest.mark.parametrize("speed", ["0.1 m/s", "10 m/s"])
@pytest.mark.parametrize("accuracy", [0.2, 0.1])
def test_an_accuracy_leaves_a_quarter_of_itself_to_a_cut_inlet(accuracy, speed, geometry):
    table = twenty_lines(speed_1=speed, speed_2=speed)
    table["geometry"] = table["geometry"] | geometry
    scene = Scene.from_dict(table | {"control": {"accuracy": accuracy}})
    missing = Case.bind(scene, scene.operation.point).missing_film
    assert missing / (1.0 + missing) <= 0.25 * accuracy
    assert scene.film.domain >= 2.8 * scene.hertz(scene.operation.load).a


def test_a_contact_that_brings_no_oil_in_has_the_room_of_hertz_contact():
    scene = Scene.from_dict(twenty_lines(speed_2="-10 m/s") | {"control": {"accuracy": 0.2}})
    assert scene.film.domain == approx(2.88 * scene.hertz(500.0).a)


def test_the_longest_inlet_of_a_duty_counts():
    table = twenty_lines(speed_1="0.1 m/s", speed_2="0.1 m/s") | {"control": {"accuracy": 0.1}}
    alone = Scene.from_dict(table)
    table["operation"] = table["operation"] | {"steps": [{"time": "60 s", "speed_1": "10 m/s", "speed_2": "10 m/s"}]}
    assert Scene.from_dict(table).film.domain > 1.2 * alone.film.domain


def test_a_domain_that_is_given_stays_and_levels_without_a_grid_have_the_old_one():
    table = twenty_lines() | {"control": {"accuracy": 0.1}}
    assert Scene.from_dict(table | {"film": {"domain": "1 mm"}}).film.domain == 1e-3
    regression = Scene.from_dict(table | {"film": {"model": "regression"}})
    assert regression.film.domain == 2.88 * regression.hertz(500.0).a


# ---- calls


def cut(inlets):
    """A ball on a domain with so many lengths of the inlet before Hertz's contact; distance of the nodes alike."""
    a = hertz_point(20.0, RADIUS, RADIUS, STEEL).a
    step, side = a / 12.0, 24
    left = 12 + round(inlets * 12.0 * 0.4)
    right = 16 * -(-(left + 20) // 16) - left
    return point_contact(
        **BALL, domain=(-left * step, right * step, -side * step, side * step), grid=(2 * side + 1, left + right + 1)
    )


def test_error_estimates_cover_a_cut_inlet_and_a_tenth_of_them_would_not():
    short, whole = cut(1.0), cut(12.0)
    for name in ("h_central", "h_c"):
        true = abs(getattr(short, name) - getattr(whole, name))
        assert 0.1 * short.error_estimate[name] < true < short.error_estimate[name]
    assert any(line.startswith("The domain ends ") and "Begin the domain" in line for line in short.warnings)
    assert not any("domain ends" in line for line in whole.warnings)


def test_entrainment_the_other_way_looks_at_the_other_edge():
    a = hertz_point(20.0, RADIUS, RADIUS, STEEL).a
    domain, back = (-1.5 * a, 4.5 * a, -2.0 * a, 2.0 * a), BALL | {"speed_1": -2.0, "speed_2": -2.0}
    there, other = (point_contact(**given, domain=domain, grid=(65, 97)) for given in (BALL, back))
    assert any("domain ends" in line for line in there.warnings)
    assert not any("domain ends" in line for line in other.warnings)


def test_a_smaller_accuracy_looks_further_upstream_where_the_inlet_asks_for_it():
    line = BALL | {"load": 1e5, "radius": RADIUS}
    del line["radius_x"]
    rough, fine = (line_contact(**line, accuracy=accuracy) for accuracy in (0.2, 0.01))
    assert fine.x[0] < 1.3 * rough.x[0]
    assert fine.x[0] - fine.x[-1] < rough.x[0] - rough.x[-1]
    assert fine.error_estimate["h_central"] <= 0.01 * fine.h_central
