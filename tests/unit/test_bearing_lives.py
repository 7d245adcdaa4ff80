"""Lives of a bearing over a run made by hand: which of its contacts counts, and which friction on which race."""

from types import SimpleNamespace

import numpy as np
from comparison import approx

from system_models.machines.ball_bearing.geometry import BEARING_209
from system_models.machines.ball_bearing.lives import RatedRun
from system_models.machines.ball_bearing.rating import Rating
from system_models.machines.ball_bearing.record import ContactClass

LIGHT, HEAVY = ContactClass("inner", 1), ContactClass("outer", 1)
RATING = Rating()
ROUGHNESS = {"roughness_1": 30e-9, "roughness_2": 40e-9}  # together 50 nm


def rated(**run) -> RatedRun:
    return RatedRun(SimpleNamespace(time=np.array([0.0]), runs=np.array([True]), **run))  # type: ignore[arg-type]


def with_films(films: dict[ContactClass, float], loaded: set[ContactClass]) -> float:
    """The film ratio of a run of one row."""
    run = rated(
        classes=tuple(films),
        solved=lambda which, name: np.array([{"h_c": films[which], **ROUGHNESS}[name]]),
        loaded=lambda which: np.array([which in loaded]),
    )
    return float(run.film_ratio[0])


def test_the_thinnest_film_of_the_loaded_contacts_rates_the_bearing() -> None:
    both = {LIGHT, HEAVY}
    assert with_films({LIGHT: 100e-9, HEAVY: 50e-9}, both) == approx(1.0)
    assert with_films({LIGHT: 50e-9, HEAVY: 100e-9}, both) == approx(1.0)
    assert with_films({LIGHT: 50e-9, HEAVY: 100e-9}, {HEAVY}) == approx(2.0)


def life_with(inner: float, outer: float) -> float:
    """The life by stress with these coefficients of friction, in lives without any."""

    def life(friction: dict[str, float]) -> float:
        run = rated(
            bearing=SimpleNamespace(dimensions=BEARING_209, levels=1),
            of=lambda name: np.array([500.0]),
            solved=lambda which, name: np.array([friction[which.race]]),
            assembly=SimpleNamespace(reported={"rating": RATING}),
        )
        return float(run.stressed[0])

    return life({"inner": inner, "outer": outer}) / life({"inner": 0.0, "outer": 0.0})


def test_friction_on_either_race_shortens_the_life_by_stress() -> None:
    on_inner, on_outer, on_both = life_with(0.1, 0.0), life_with(0.0, 0.1), life_with(0.1, 0.1)
    assert on_both < min(on_inner, on_outer)
    assert max(on_inner, on_outer) < 1.0
    assert on_inner < on_outer  # the inner race, closer bent, is the one that fails
