import numpy as np
import pytest

from contact_core import Scene
from contact_core.laws.tribofilm import thickness
from contact_core.reference import ghanbarzadeh_thickness

MINUTES = np.array([1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 60.0, 90.0, 120.0])
CURVES = {
    "azam_case_a": [25.6, 46.2, 86.3, 111.3, 113.9, 109.1, 96.0, 85.4, 73.2, 66.4, 64.3],
    "mtm_zddp": [12.8, 24.7, 55.2, 92.3, 116.9, 133.0, 149.8, 155.7, 156.0, 151.6, 148.7],
}


def closed_form(name: str, time: np.ndarray) -> np.ndarray:
    scene = Scene.from_toml(name)
    law = scene.tribofilm
    return ghanbarzadeh_thickness(
        time,
        scene.operation.temperature,
        law.full_thickness,
        law.rate_factor,
        law.removal_thickness,
        law.removal_rate,
    )


def stepped(name: str, steps: np.ndarray) -> np.ndarray:
    """Film after each step of a point that is always rubbed."""
    scene = Scene.from_toml(name)
    film, found = (np.zeros(1), np.zeros(1)), []
    for step in steps:
        film = scene.tribofilm.evolve(*film, np.array([step]), scene.operation.temperature)
        found.append(thickness(*film)[0])
    return np.array(found)


@pytest.mark.parametrize("name", CURVES)
def test_the_closed_form_has_the_printed_values(name):
    assert closed_form(name, 60.0 * MINUTES) * 1e9 == pytest.approx(CURVES[name], abs=0.06)


@pytest.mark.parametrize("name", CURVES)
def test_the_law_in_steps_has_the_printed_values(name):
    assert stepped(name, np.diff(60.0 * MINUTES, prepend=0.0)) * 1e9 == pytest.approx(CURVES[name], abs=0.06)


@pytest.mark.parametrize(
    ("name", "seconds", "peak", "end"),
    [("azam_case_a", 807, 114.4e-9, 63.5e-9), ("mtm_zddp", 2947, 156.8e-9, 145.7e-9)],
)
def test_the_film_overshoots_and_settles_where_growth_less_removal_leaves_it(name, seconds, peak, end):
    film = stepped(name, np.ones(7200))
    assert 1 + np.argmax(film) == pytest.approx(seconds, abs=2)
    assert film.max() == pytest.approx(peak, abs=0.05e-9)
    law = Scene.from_toml(name).tribofilm
    settled = stepped(name, np.array([1e6]))[0]
    assert settled == pytest.approx(law.full_thickness - law.removal_thickness, rel=1e-12, abs=0.0)
    assert settled == pytest.approx(end, abs=0.05e-9)


@pytest.mark.parametrize(("name", "rate"), [("azam_case_a", 3.125e-3), ("mtm_zddp", 1.2215e-3)])
def test_growth_rates_of_the_shipped_cases(name, rate):
    scene = Scene.from_toml(name)
    assert scene.tribofilm.rate(scene.operation.temperature) == pytest.approx(rate, rel=1e-4)


def test_temperature_enters_the_growth_rate_in_proportion():
    law = Scene.from_toml("mtm_zddp").tribofilm
    rates = np.array([law.rate(t) / law.rate_factor for t in (333.15, 353.15, 363.15, 373.15)])
    assert rates == pytest.approx([6.942e12, 7.358e12, 7.567e12, 7.775e12], rel=1e-4)
