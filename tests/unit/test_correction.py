"""The regression level corrected by solved contacts."""

import numpy as np
import pytest
from comparison import approx

from contact_core import Scene
from contact_core.corrections.correction import CORRECTED
from contact_core.corrections.kriging import (
    CORRELATIONS,
    NO_KNOTS,
    Conditioned,
    Conditioner,
    Knots,
    covariance,
    knots,
    nearness,
    pair_of,
    place,
)
from contact_core.corrections.places import Place

FAST = {
    "friction_coefficient": 0.08, "h_c": 50e-9, "contact_load_ratio": 0.4,
    "error_friction": 0.3, "error_film": 0.4, "error_load_ratio": 0.1,
}  # fmt: skip
DEEP = {
    "friction_coefficient": 0.095, "h_c": 42e-9, "contact_load_ratio": 0.45,
    "error_friction": 0.01, "error_film": 0.01, "error_load_ratio": 0.002,
}  # fmt: skip
HERE = Place(0.5, -1.0, -2.0, 0.4, -4.0)
WIDE = 1.96
SIZES = {"friction_coefficient": 0.08, "h_c": 50e-9, "contact_load_ratio": 1.0}  # that errors are relative to
OUTPUTS = list(CORRECTED)


def told(given: Knots, where: Place = HERE, pair: str = "a") -> dict[str, float]:
    """What knots make of FAST at a place."""
    found = Conditioner(given).at(np.array([pair], object), np.array([where], float)).of(FAST)
    return {name: float(np.squeeze(value)) for name, value in found.items()}


def knot(pair: str = "a", **changes: float) -> Knots:
    return knots([pair], [HERE], [FAST], [DEEP | changes])


@pytest.mark.parametrize("name", OUTPUTS)
def test_a_knot_is_reproduced_within_the_error_that_is_left(name: str) -> None:
    """Of two knots with the same place and no error of their own, the nugget alone is left."""
    law, error = CORRELATIONS[name], CORRECTED[name]
    many = [knot(**dict.fromkeys(CORRECTED.values(), 0.0))] * 200
    given = Knots(*(np.concatenate([getattr(one, part) for one in many]) for part in ("pairs", "places", "off", "own")))
    found = told(given)
    assert found[name] == approx(DEEP[name], rel=1e-3)
    size = 1.0 if name == "contact_load_ratio" else found[name]
    assert found[error] * size == approx(FAST[error] * SIZES[name] * law.wider * law.nugget**0.5, rel=0.02)
    one = told(knot())
    size = 1.0 if name == "contact_load_ratio" else one[name]
    assert abs(one[name] - DEEP[name]) < one[error] * size < FAST[error] * SIZES[name]


@pytest.mark.parametrize("name", OUTPUTS)
def test_a_solution_tells_the_less_the_less_sure_it_is(name: str) -> None:
    """One as unsure as the regression level takes half of the way, and leaves half of the variance; a wild one none."""
    law, k = CORRELATIONS[name], OUTPUTS.index(name)
    shared = 1.0 - law.nugget  # of two contacts in one place
    for own, told_of in ((0.0, 1.0), (1.0, 0.5), (1e4, 0.0)):
        given = Knots(np.array(["a"], object), np.array([HERE]), np.full((1, 3), 0.4), np.full((1, 3), own))
        found = Conditioner(given).at(given.pairs, given.places)
        assert found.mean[0, k] == approx(0.4 * told_of * shared, abs=1e-6)
        left = law.wider * (1.0 - told_of * shared**2) ** 0.5
        assert found.left[0, k] == approx(min(left, 1.0), abs=1e-6)


@pytest.mark.parametrize("name", OUTPUTS)
def test_far_away_and_on_other_surfaces_the_regression_level_is_as_it_was(name: str) -> None:
    far = Place(*(np.array(HERE) + 1e3))
    found = told(knot(), far, "b")
    assert found[name] == approx(FAST[name], rel=1e-12)
    assert found[CORRECTED[name]] == approx(FAST[CORRECTED[name]], rel=1e-12)
    near = [told(knot(), HERE, pair) for pair in ("a", "b")]
    same, other = (each[CORRECTED[name]] * (1.0 if SIZES[name] == 1.0 else each[name]) for each in near)
    assert same < other <= FAST[CORRECTED[name]] * SIZES[name]


def test_without_knots_nothing_changes_to_the_bit() -> None:
    found = told(NO_KNOTS)
    assert {name: found[name] for name in FAST} == FAST


def test_what_is_not_known_tells_nothing() -> None:
    """No solution, or a regression level that states no error, or a place without a load."""
    unknown = knots(["a"], [HERE], [FAST], [None])
    assert told(unknown) == told(NO_KNOTS)
    sure = knots(["a"], [HERE], [FAST | {"error_film": 0.0}], [DEEP])
    assert told(sure)["h_c"] == FAST["h_c"]
    assert told(sure)["friction_coefficient"] > FAST["friction_coefficient"]
    unloaded = place(FAST | {"lambda_ratio": 1.0, "friction_force": 0.0, "friction_solid": 0.0}, 0.0, (1.0, 0.5), 0.0)
    assert told(knot(), unloaded) == told(NO_KNOTS)


def test_a_corrected_contact_can_be() -> None:
    """Friction and film are more than nothing, and the solids carry a part of the load, whatever the knots say."""
    for mean in (-5.0, 5.0):
        found = Conditioned(np.full((1, 3), mean), np.ones((1, 3))).of(FAST)
        assert found["friction_coefficient"][0] > 0.0
        assert found["h_c"][0] > 0.0
        assert 0.0 <= found["contact_load_ratio"][0] <= 1.0


def test_one_contact_has_one_place_whichever_way_it_runs_and_however_large_it_is() -> None:
    oil = {"lambda_ratio": 0.5, "friction_force": 4.0, "friction_solid": 3.0}
    here = np.array(place(FAST | oil, 100.0, (0.3, 0.2), 0.1))
    for speeds in ((0.2, 0.3), (-0.3, -0.2), (3.0, 2.0)):
        assert np.array(place(FAST | oil, 100.0, speeds, 0.1)) == approx(here, rel=1e-12)
    larger = {"lambda_ratio": 0.5, "friction_force": -8.0, "friction_solid": -6.0}
    assert np.array(place(FAST | larger, 200.0, (0.3, 0.2), 0.1)) == approx(here, rel=1e-12)
    less = {"lambda_ratio": 0.5, "friction_force": 3.5, "friction_solid": 3.0, "contact_load_ratio": 0.7}
    half = place(FAST | less, 100.0, (0.3, 0.2), 0.1)  # of the oil's friction and load
    assert half.oil == approx(here[4], rel=1e-12)


def test_places_a_length_apart_deviate_alike_by_a_normal_curve_s_deviation() -> None:
    law, here = CORRELATIONS["h_c"], np.array([HERE])
    steps = np.diag(law.lengths)
    assert nearness(law, here, here + steps) == approx(np.exp(-0.5), rel=1e-12)
    assert nearness(law, here, here + steps[:1] - steps[1:]) == approx(np.exp(-1.0), rel=1e-12)


def test_a_pair_is_of_both_surfaces_and_of_nothing_else() -> None:
    def pair(**changes: str) -> str:
        return pair_of(Scene.from_toml("mtm_zddp", {name.replace("__", "."): value for name, value in changes.items()}))

    assert pair(operation__load="20 N", film__points="65") == pair()
    assert len({pair(), pair(surface_1__rq="30 nm"), pair(surface_2__rq="30 nm")}) == 3


def test_half_widths_never_grow_with_more_knots() -> None:
    draw = np.random.default_rng(1)
    places, off = draw.normal(0.0, 2.0, (30, 5)), draw.normal(0.0, 0.1, (30, 3))
    at, pair = draw.normal(0.0, 2.0, (50, 5)), np.full(50, "a", object)
    before = np.ones((50, 3))
    for count in (1, 5, 15, 30):
        pairs = np.array(["a", "b"] * 15, object)[:count]
        given = Knots(pairs, places[:count], off[:count], np.full((count, 3), 0.1))
        left = Conditioner(given).at(pair, at).left
        assert (left <= before + 1e-12).all()
        before = left
    assert (before < 0.99).any()


def test_solutions_that_deviate_by_more_than_was_stated_leave_more_but_no_more_than_was_stated() -> None:
    draw = np.random.default_rng(2)
    places, pairs = draw.normal(0.0, 0.3, (8, 5)), np.full(8, "a", object)
    lefts = [
        Conditioner(Knots(pairs, places, off * draw.normal(0.0, 0.5, (8, 3)), np.zeros((8, 3)))).at(pairs, places).left
        for off in (0.1, 3.0, 100.0)
    ]
    assert (lefts[0] < lefts[1]).all()
    assert (lefts[0] < 0.7).all()
    assert (lefts[2] <= 1.0).all()


def test_a_knot_is_left_out() -> None:
    given = knots(["a", "b"], [HERE, HERE], [FAST, FAST], [DEEP, None])
    assert given.but(1).pairs.tolist() == ["a"]
    assert given.but(0).count == 1
    assert told(given.but(0)) == told(NO_KNOTS)


def drawn(count: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pairs, places and deviations over half widths of friction, as the correlation has them."""
    draw, law = np.random.default_rng(seed), CORRELATIONS["friction_coefficient"]
    places = draw.normal(0.0, 0.6, (count, 5)) * np.array(law.lengths)
    pairs = np.array([f"{k % 3}" for k in range(count)], object)
    whole = covariance(law, pairs, places, pairs, places) + law.nugget * np.eye(count)
    return pairs, places, np.linalg.cholesky(whole) @ draw.normal(0.0, 1.0 / WIDE, count)


@pytest.mark.parametrize(("part", "least", "most"), [(1.0, 0.93, 0.97), (0.1, 0.0, 0.25)])
def test_half_widths_cover_19_in_20_of_synthetic_truths_and_not_if_they_were_a_tenth(
    part: float, least: float, most: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    exact = CORRELATIONS["friction_coefficient"]._replace(wider=1.0)  # these truths have no long tails
    monkeypatch.setitem(CORRELATIONS, "friction_coefficient", exact)
    covered, lefts = list[bool](), list[float]()
    for seed in range(40):
        pairs, places, off = drawn(60, seed)
        known = np.full((12, 3), np.nan)
        known[:, 0] = off[:12]
        given = Knots(pairs[:12], places[:12], known, np.zeros((12, 3)))
        found = Conditioner(given).at(pairs[12:], places[12:])
        covered += (np.abs(off[12:] - found.mean[:, 0]) <= part * found.left[:, 0]).tolist()
        lefts += found.left[:, 0].tolist()
    assert least <= np.mean(covered) <= most
    assert np.median(lefts) < 0.9
