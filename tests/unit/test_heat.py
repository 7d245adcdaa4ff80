from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import solve_ivp

import contact_core.laws.heat
from contact_core import Scene, SceneError, advance, initial_state
from contact_core.kernels.moving_source import MovingSurface, partition
from contact_core.laws.bulk import InputBulk, LumpedBulk, OilBulk
from contact_core.laws.heat import FlashTemperature, NoHeat, TemperatureField
from contact_core.laws.temperatures import Rubbing, Temperatures
from contact_core.scene import tunables, with_values

SPACING, FLOOR, OIL = 4e-6, 1e-9, 0.14
STEEL = (46.0, 1.25e-5)  # conductivity, diffusivity
N = 33
AT = (np.arange(N) - N // 2) * SPACING
RADIUS = np.hypot(AT[:, None], AT[None, :])
INSIDE = RADIUS < 50e-6
SOLID = INSIDE & (np.random.default_rng(5).random((N, N)) < 0.4)
GAP = np.where(SOLID, FLOOR, 50e-9 + RADIUS**2 / 0.02)
HEAT = np.where(SOLID, 4e8, np.where(INSIDE, 2e7, 1e5))  # W/m2
TOTAL = HEAT.sum() * SPACING**2


def surfaces(one: tuple[float, float, float], two: tuple[float, float, float]) -> tuple[MovingSurface, MovingSurface]:
    """Of conductivity, diffusivity and speed each."""
    return MovingSurface((N, N), SPACING, *one), MovingSurface((N, N), SPACING, *two)


def field(bodies=(350.0, 350.0), speeds=(1.0, 0.8), heat=HEAT, inside=INSIDE, one=STEEL, two=STEEL) -> Temperatures:
    law = TemperatureField(one[0], two[0], one[1], two[1])
    return law.temperatures(Rubbing(heat, GAP, SOLID, inside, SPACING, speeds, bodies, OIL))


def test_equal_bodies_at_equal_speed_share_the_heat_in_halves_at_every_node():
    found = partition(HEAT, GAP / OIL, INSIDE, 0.0, surfaces((*STEEL, 1.0), (*STEEL, 1.0)))
    assert np.array_equal(found.into_1, 0.5 * HEAT)
    assert np.array_equal(found.rise_1, found.rise_2)
    assert found.mismatch == 0.0


@pytest.mark.parametrize("speeds", [(1.0, 0.8), (5.0, -2.0), (-0.1, 20.0), (0.0, 0.5)])
@pytest.mark.parametrize("two", [STEEL, (1.1, 6e-7)], ids=["steel", "glass"])
@pytest.mark.parametrize("difference", [0.0, 30.0])
def test_the_heat_through_the_film_is_what_its_two_temperatures_drive(speeds, two, difference):
    found = partition(HEAT, GAP / OIL, INSIDE, difference, surfaces((*STEEL, speeds[0]), (*two, speeds[1])))
    through = 0.5 * (found.into_1 - found.into_2)
    drop = difference + found.rise_2 - found.rise_1
    largest = np.abs(found.rise_1 + found.rise_2).max() + difference
    assert np.abs(through * GAP / OIL - drop)[INSIDE].max() < 1e-5 * largest
    assert not through[~INSIDE].any()
    assert np.abs(through[INSIDE]).max() > 1e4  # not trivial
    assert found.into_1 + found.into_2 == approx(HEAT, rel=1e-14)
    assert found.rise_2 == approx(MovingSurface((N, N), SPACING, *two, speeds[1]).rise(found.into_2), rel=1e-13)
    print(f"{two}, {speeds} m/s: {found.convolutions} convolutions, mismatch {found.mismatch:.1e}")


def test_where_solids_touch_both_surfaces_are_nearly_as_warm_though_the_bodies_are_not():
    found = field(bodies=(350.0, 380.0), speeds=(3.0, 0.5))
    assert found.solved
    apart = np.abs(np.asarray(found.surface_1) - found.surface_2)
    assert apart[SOLID].max() < 3.0 < 29.0 < apart[~INSIDE].max()


def test_a_heated_film_is_warmer_inside_than_its_surfaces():
    found = field()
    mean = 0.5 * (np.asarray(found.surface_1) + found.surface_2)
    assert found.film == approx(mean + HEAT * GAP / (12.0 * OIL), rel=1e-14)


def test_a_partition_that_does_not_converge_says_so(monkeypatch):
    few = partition(HEAT, GAP / OIL, INSIDE, 30.0, surfaces((*STEEL, 5.0), (1.1, 6e-7, 0.1)), iterations=2)
    assert few.mismatch > 1e-4
    assert few.into_1 + few.into_2 == approx(HEAT, rel=1e-14)
    monkeypatch.setattr(contact_core.laws.heat, "partition", lambda *_: few)
    assert not field().solved


@pytest.mark.parametrize("law", ["flash", "field", "none"])
@pytest.mark.parametrize("speeds", [(1.0, 0.8), (-4.0, 3.0), (0.5, 0.5)])
def test_the_heat_into_the_bodies_is_the_friction_power_to_round_off(law, speeds):
    one, two = STEEL, (1.1, 6e-7)
    chosen = {
        "none": NoHeat(),
        "flash": FlashTemperature(one[0], two[0], one[1], two[1]),
        "field": TemperatureField(one[0], two[0], one[1], two[1]),
    }[law]
    found = chosen.temperatures(Rubbing(HEAT, GAP, SOLID, INSIDE, SPACING, speeds, (350.0, 360.0), OIL))
    assert found.into_1 + found.into_2 == approx(TOTAL, rel=1e-13)


def test_the_faster_of_two_equal_bodies_takes_up_more_heat():
    found = field(speeds=(5.0, 0.1))
    assert found.into_1 > 1.05 * found.into_2
    swapped = field(speeds=(0.1, 5.0))
    assert (swapped.into_1, swapped.into_2) == approx((found.into_2, found.into_1), rel=1e-7)


def test_an_insulator_leaves_all_heat_to_the_other_body():
    everywhere = np.ones((N, N), np.bool_)
    found = field(inside=everywhere, two=(46e-7, 1.25e-5))
    assert found.into_1 == approx(TOTAL, rel=1e-5)
    one = MovingSurface((N, N), SPACING, *STEEL, 1.0).rise(HEAT)
    assert np.asarray(found.surface_1) - 350.0 == approx(one, rel=1e-4)


def test_bodies_of_different_temperature_exchange_heat_without_friction():
    found = field(bodies=(350.0, 380.0), heat=np.zeros((N, N)))
    assert found.into_1 > 0.0
    assert found.into_1 + found.into_2 == approx(0.0, abs=1e-12 * found.into_1)
    assert np.all((np.asarray(found.film) > 350.0) & (np.asarray(found.film) < 380.0))
    turned = field(bodies=(380.0, 350.0), heat=np.zeros((N, N)))
    assert turned.into_1 < 0.0


def test_outside_the_pressure_the_heat_is_split_in_halves_whatever_the_bodies():
    found = field(bodies=(350.0, 380.0), inside=np.zeros((N, N), np.bool_), two=(1.1, 6e-7))
    assert found.into_1 == approx(found.into_2, rel=1e-14)


def test_a_reversed_contact_has_the_mirrored_temperatures():
    mirror = np.s_[:, ::-1]
    law = TemperatureField(46.0, 1.1, 1.25e-5, 6e-7)
    ways = []
    for cut, sign in ((np.s_[:, :], 1.0), (mirror, -1.0)):
        arrays = HEAT[cut], GAP[cut], SOLID[cut], INSIDE[cut]
        found = law.temperatures(Rubbing(*arrays, SPACING, (3.0 * sign, 1.0 * sign), (350.0, 360.0), OIL))
        ways.append([np.asarray(found.surface_1)[cut], np.asarray(found.surface_2)[cut], found.into_1])
    for one, other in zip(*ways, strict=True):
        assert one == approx(other, rel=1e-6)


def test_the_flash_rise_is_the_mean_of_both_surfaces_over_the_real_contact():
    found = field()
    rise = 0.5 * (np.asarray(found.surface_1) + found.surface_2) - 350.0
    assert found.flash_rise == approx(rise[SOLID].mean(), rel=1e-9)
    assert found.flash_rise > 1.0


def test_the_cheap_law_and_the_field_agree_on_one_slow_spot():
    """A circle at rest on equal bodies: half the heat each, 8/(3 pi) q r/K in the mean."""
    spot, gap = RADIUS <= 40e-6, np.full((N, N), FLOOR)
    heat = np.where(spot, 1e9, 0.0)
    args = (heat, gap, spot, spot, SPACING, (1e-6, -1e-6), (350.0, 350.0), OIL)
    flash = FlashTemperature(46.0, 46.0, 1.25e-5, 1.25e-5).temperatures(Rubbing(*args))
    found = TemperatureField(46.0, 46.0, 1.25e-5, 1.25e-5).temperatures(Rubbing(*args))
    assert found.flash_rise == approx(flash.flash_rise, rel=0.02)
    assert found.into_1 == approx(flash.into_1, rel=1e-6)


def one_spot(law: FlashTemperature, radius: float, heat: float, speed: float) -> Temperatures:
    """A spot of one node under a heat flux [W/m2]."""
    solid = np.zeros((3, 3), np.bool_)
    solid[1, 1] = True
    spacing, gap = radius * np.sqrt(np.pi), np.full((3, 3), FLOOR)
    return law.temperatures(Rubbing(heat * solid, gap, solid, solid, spacing, (speed, 0.0), (350.0, 350.0), OIL))


FLASH = FlashTemperature(46.0, 46.0, 1.25e-5, 1.25e-5)


def test_a_slow_spot_of_two_equal_bodies_sends_half_its_heat_into_each():
    found = one_spot(FLASH, 10e-6, 1e9, 1e-9)
    average = 8.0 / (3.0 * np.pi) * 0.5 * 1e9 * 10e-6 / 46.0  # of a uniform, static circular source
    assert found.flash_rise == approx(average, rel=1e-4)
    assert found.into_1 == found.into_2


def test_a_slow_spot_against_an_insulator_sends_all_its_heat_into_the_conductor():
    found = one_spot(replace(FLASH, conductivity_2=46e-12), 10e-6, 1e9, 1e-9)
    assert found.flash_rise == approx(8.0 / (3.0 * np.pi) * 1e9 * 10e-6 / 46.0, rel=1e-4)
    assert found.into_1 == approx(1e9 * np.pi * 10e-6**2, rel=1e-9, abs=0.0)


def test_a_fast_spot_warms_with_the_inverse_root_of_its_speed():
    slow, fast = one_spot(FLASH, 10e-6, 1e9, 1e6), one_spot(FLASH, 10e-6, 1e9, 4e6)
    assert fast.flash_rise / slow.flash_rise == approx(0.5, rel=1e-5)


def test_the_flash_temperature_is_blind_to_the_direction_of_sliding():
    forward, back = one_spot(FLASH, 10e-6, 1e9, 0.3), one_spot(FLASH, 10e-6, 1e9, -0.3)
    assert np.array_equal(forward.surface_1, back.surface_1)
    assert (forward.into_1, forward.flash_rise) == (back.into_1, back.flash_rise)
    assert forward.flash_rise > 1.0


@pytest.mark.parametrize(("radius", "shear"), [(1e-6, 0.2e9), (20e-6, 0.6e9)])
def test_flash_temperatures_of_the_shipped_cases_are_below_one_kelvin(radius, shear):
    assert 0.005 < one_spot(FLASH, radius, shear * 0.005, 0.005).flash_rise < 0.7


def test_each_spot_has_a_rise_of_its_own_size_and_heat_and_the_rest_stays_as_warm_as_the_bodies():
    solid = np.zeros((6, 9), np.bool_)
    solid[1:3, 1:3] = solid[4, 6] = True
    heat = np.where(solid, 1e9, 1e6)
    heat[4, 6] = 3e9
    args = (np.full((6, 9), FLOOR), solid, solid, SPACING, (0.3, 0.0), (350.0, 360.0), OIL)
    found = FLASH.temperatures(Rubbing(heat, *args))
    alone = [one_spot(FLASH, np.sqrt(n / np.pi) * SPACING, q, 0.3).flash_rise for n, q in ((4, 1e9), (1, 3e9))]
    assert found.surface_1[1:3, 1:3] == approx(350.0 + alone[0], rel=1e-12)
    assert found.surface_2[4, 6] == approx(360.0 + alone[1], rel=1e-12)
    assert np.all(found.surface_1[~solid] == 350.0)
    assert found.flash_rise == approx((4.0 * alone[0] + alone[1]) / 5.0, rel=1e-12)
    assert found.film == 355.0


def test_heat_without_a_law_makes_no_array_and_asks_no_kernel(monkeypatch):
    calls = []
    for name in ("partition", "MovingSurface"):
        monkeypatch.setattr(contact_core.laws.heat, name, lambda *_, name=name: calls.append(name))
    found = NoHeat().temperatures(Rubbing(HEAT, GAP, SOLID, INSIDE, SPACING, (1.0, 0.8), (350.0, 360.0), OIL))
    assert not calls
    assert (found.surface_1, found.surface_2, found.film, found.flash_rise) == (350.0, 360.0, 355.0, 0.0)
    assert found.into_1 == found.into_2 == approx(0.5 * TOTAL, rel=1e-13)
    with pytest.raises(AttributeError):  # the counter counts: the field does ask
        field()
    assert calls


LUMPED = LumpedBulk(heat_capacity_1=5.0, heat_capacity_2=80.0, conductance_1=0.2, conductance_2=0.0)


def test_a_lumped_body_follows_its_differential_equation():
    def slopes(_: float, t: np.ndarray) -> np.ndarray:
        return np.array([(3.0 - 0.2 * (t[0] - 350.0)) / 5.0, 7.0 / 80.0])

    exact = solve_ivp(slopes, (0.0, 40.0), [370.0, 340.0], rtol=1e-11, atol=1e-11).y[:, -1]
    assert LUMPED.after((370.0, 340.0), (3.0, 7.0), 350.0, 40.0) == approx(exact, rel=1e-9)


def test_a_lumped_body_that_loses_no_heat_keeps_all_of_it():
    first, second = replace(LUMPED, conductance_1=1e-300).after((350.0, 350.0), (5.0, -8.0), 300.0, 10.0)
    assert (first, second) == approx((360.0, 349.0), rel=1e-14)


def test_a_lumped_body_ends_where_its_heat_leaves_it():
    assert LUMPED.after((300.0, 300.0), (4.0, 0.0), 350.0, 1e9)[0] == approx(370.0, rel=1e-14)


def test_bodies_take_their_temperature_from_the_oil_the_inputs_or_the_state():
    assert OilBulk().bodies(350.0, (400.0, None), (1.0, 2.0)) == (350.0, 350.0)
    assert InputBulk().bodies(350.0, (400.0, None), (1.0, 2.0)) == (400.0, 350.0)
    assert LUMPED.bodies(350.0, (400.0, None), (351.0, 352.0)) == (351.0, 352.0)
    assert LUMPED.bodies(350.0, (400.0, None), None) == (350.0, 350.0)
    assert InputBulk().after((400.0, 350.0), (1.0, 1.0), 350.0, 9.0) == (400.0, 350.0)
    assert OilBulk().after((400.0, 350.0), (1.0, 1.0), 360.0, 9.0) == (360.0, 360.0)


LUMPED_TABLE = {
    "heat.bulk.model": "lumped",
    "heat.bulk.heat_capacity_1": "5 J/K",
    "heat.bulk.heat_capacity_2": "0.08 kJ/K",
    "heat.bulk.conductance_1": "200 mW/K",
    "heat.bulk.conductance_2": "0 W/K",
}


@pytest.mark.parametrize(
    ("changes", "bulk"),
    [
        ({}, OilBulk()),
        ({"heat.bulk": "oil"}, OilBulk()),
        ({"heat.bulk": "inputs"}, InputBulk()),
        (LUMPED_TABLE, LUMPED),
    ],
)
@pytest.mark.parametrize("model", [{}, {"heat.model": "none"}, {"heat.model": "field", "heat.set": "steel"}])
def test_the_bulk_of_any_law_is_read_from_its_name_or_table_and_written_again(model, changes, bulk):
    scene = Scene.from_toml("azam_case_a", model | changes)
    assert scene.heat.bulk == bulk
    assert Scene.from_dict(scene.to_dict()) == scene


def test_the_set_of_steel_serves_the_field_too():
    table = Scene.from_toml("azam_case_a").to_dict() | {"heat": {"set": "steel", "model": "field"}}
    assert Scene.from_dict(table).heat == TemperatureField(46.0, 46.0, 1.25e-5, 1.25e-5)


def test_numbers_of_a_lumped_body_are_tunable():
    scene = Scene.from_toml("azam_case_a", LUMPED_TABLE)
    assert tunables(scene)["heat.bulk.heat_capacity_2"][0] == 80.0
    assert with_values(scene, {"heat.bulk.conductance_2": 0.5}).heat.bulk == replace(LUMPED, conductance_2=0.5)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"heat.bulk": "oli"}, r"\[heat\.bulk\] has no model 'oli'\. Did you mean 'oil'\?"),
        ({"heat.bulk": "lumped"}, r"heat\.bulk\.heat_capacity_1 \[J/K\] \(C, heat capacity of body 1\); heat"),
        (
            LUMPED_TABLE | {"heat.bulk.conductance_1": "1 J/K"},
            r"heat\.bulk\.conductance_1 = '1 J/K' has the wrong unit",
        ),
        (
            LUMPED_TABLE | {"heat.bulk.heat_capacity_1": "0 J/K"},
            r"heat\.bulk\.heat_capacity_1 = 0 J/K .* at least 1e-09",
        ),
        ({"heat.inlet_shear": "gutpa"}, r"heat\.inlet_shear = 'gutpa' is not one of none, gupta"),
    ],
)
def test_a_wrong_bulk_or_inlet_is_refused_by_name(changes, told):
    with pytest.raises(SceneError, match=told):
        Scene.from_toml("azam_case_a", changes)


@pytest.mark.parametrize("turn", [1, 2, 4])
def test_a_spot_across_the_seam_of_a_line_that_repeats_itself_is_one(turn):
    solid = np.zeros((6, 9), np.bool_)
    solid[1:4, 1:3] = solid[2, 6] = True
    heat = np.where(solid, 1e9, 1e6)

    def rises(solid, heat, face):
        args = (np.full((6, 9), FLOOR), solid, solid, SPACING, (0.3, 0.0), (350.0, 350.0), OIL, face)
        return FLASH.temperatures(Rubbing(heat, *args)).surface_1 - 350.0

    whole = rises(solid, heat, 1e-3)
    assert np.array_equal(whole, rises(solid, heat, None))
    turned = rises(np.roll(solid, turn, axis=0), np.roll(heat, turn, axis=0), 1e-3)
    assert turned == approx(np.roll(whole, turn, axis=0), rel=1e-12)


def test_both_levels_put_little_heat_into_glass():
    """Of a solid contact on steel; the share was a half at the regression level, whatever the bodies conduct."""
    glass = {"heat.conductivity_2": "1.1 W/(m K)", "heat.diffusivity_2": "5e-7 m2/s", "heat.model": "flash"}
    slow = {"operation.speed_1": "12 mm/s", "operation.speed_2": "8 mm/s", "film.points": "65"}
    scene = Scene.from_toml("mtm_zddp", glass | slow)
    shares = {}
    for level in ("deterministic", "regression"):
        own = scene.at_level(level)
        out = advance(own, own.operation.point, initial_state(own), 0.0)[1]
        shares[level] = out.heat_flow_2 / out.power_loss
    assert shares["deterministic"] < 0.1
    assert shares["regression"] == approx(shares["deterministic"], abs=0.03)
