import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import solve_ivp

import contact_core
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
    warm = scene.operation.temperature
    for exposed in scene.tribofilm.rate(warm) * steps:
        film = scene.tribofilm.evolve(*film, np.array([exposed]), np.zeros(1), warm)
        found.append(thickness(*film)[0])
    return np.array(found)


@pytest.mark.parametrize("name", CURVES)
def test_the_closed_form_has_the_printed_values(name):
    assert closed_form(name, 60.0 * MINUTES) * 1e9 == approx(CURVES[name], abs=0.06)


@pytest.mark.parametrize("name", CURVES)
def test_the_law_in_steps_has_the_printed_values(name):
    assert stepped(name, np.diff(60.0 * MINUTES, prepend=0.0)) * 1e9 == approx(CURVES[name], abs=0.06)


@pytest.mark.parametrize(
    ("name", "seconds", "peak", "end"),
    [("azam_case_a", 807, 114.4e-9, 63.5e-9), ("mtm_zddp", 2947, 156.8e-9, 145.7e-9)],
)
def test_the_film_overshoots_and_settles_where_growth_less_removal_leaves_it(name, seconds, peak, end):
    film = stepped(name, np.ones(7200))
    assert 1 + np.argmax(film) == approx(seconds, abs=2)
    assert film.max() == approx(peak, abs=0.05e-9)
    law = Scene.from_toml(name).tribofilm
    settled = stepped(name, np.array([1e6]))[0]
    assert settled == approx(law.full_thickness - law.removal_thickness, rel=1e-12, abs=0.0)
    assert settled == approx(end, abs=0.05e-9)


@pytest.mark.parametrize(("name", "rate"), [("azam_case_a", 3.125e-3), ("mtm_zddp", 1.2215e-3)])
def test_growth_rates_of_the_shipped_cases(name, rate):
    scene = Scene.from_toml(name)
    assert scene.tribofilm.rate(scene.operation.temperature) == approx(rate, rel=1e-4)


def test_temperature_enters_the_growth_rate_in_proportion():
    law = Scene.from_toml("mtm_zddp").tribofilm
    rates = np.array([law.rate(t) / law.rate_factor for t in (333.15, 353.15, 363.15, 373.15)])
    assert rates == approx([6.942e12, 7.358e12, 7.567e12, 7.775e12], rel=1e-4)


BY_ENERGY = {"tribofilm.set": "andersson_90c"}


def test_growth_by_energy_is_that_of_the_differential_equation():
    """A power that swings across the threshold, 50 times over, against the sum of its energy in one step."""
    law = replace(Scene.from_toml("azam_case_a", BY_ENERGY).tribofilm, least_power=3e3)

    def power(t):
        return 5e3 * (1.0 + np.sin(t))

    def exposed(t):
        return law.exposure(np.ones(1), np.array([power(t) / 0.005]), -0.005, 363.15)[0]

    def growing(t, h):
        return law.growth_per_energy * (1.0 - h / law.full_thickness) * max(power(t) - law.least_power, 0.0)

    end = 50.0 * 2.0 * np.pi
    found = solve_ivp(growing, (0.0, end), [20e-9], max_step=0.1, rtol=1e-8, atol=1e-16).y[0, -1]
    middle = (np.arange(50_000) + 0.5) * end / 50_000
    energy = sum(exposed(t) for t in middle[:1000]) * (end / 50_000) * 50  # of one swing, 50 times
    growth, removal = law.evolve(np.array([20e-9]), np.zeros(1), np.array([energy]), np.zeros(1), 363.15)
    assert 40e-9 < found < 175e-9
    assert growth[0] == approx(found, rel=1e-5, abs=0.0)
    assert not removal.any()


def case_a_by_energy(seconds: np.ndarray) -> np.ndarray:
    """Film [m] on the ball of case A under the mean Hertz pressure at mu = 0.1, from its time in contact."""
    scene = Scene.from_toml("azam_case_a", BY_ENERGY)
    hertz, zero = scene.hertz(scene.operation.load), np.zeros_like(seconds)
    pressure = np.array([2.0 / 3.0 * hertz.pressure_max])
    share = 2.0 * hertz.a / scene.geometry.track_length_1
    exposure = scene.tribofilm.exposure(pressure, 0.1 * pressure, scene.operation.point.sliding_speed, 363.15)
    return thickness(*scene.tribofilm.evolve(zero, zero, exposure * share * seconds, zero, 363.15))


def test_the_assumed_constants_by_energy_start_as_fast_as_the_published_ones():
    published = stepped("azam_case_a", np.array([0.1]))
    assert case_a_by_energy(np.array([0.1])) == approx(published, rel=3e-3, abs=0.0)


def test_constants_that_nobody_published_are_marked_as_assumed():
    path = Path(contact_core.__file__).parent / "data" / "tribofilms.toml"
    sources = {name: table["source"] for name, table in tomllib.loads(path.read_text("utf-8")).items()}
    fitted = {name for name, source in sources.items() if "Assumed" not in source}
    assert fitted == {"zddp_90c", "zddp_80c", "combined_80c"}  # that of the last says of each number that it is assumed


def test_growth_by_energy_shows_no_overshoot():
    film = case_a_by_energy(60.0 * MINUTES)
    assert np.all(np.diff(film) > 0.0)
    assert np.all(np.diff(closed_form("azam_case_a", 60.0 * MINUTES))[5:] < 0.0)
    assert film[-1] == approx(176e-9, rel=1e-3, abs=0.0)


ACTIVATED = (
    "zhang_spikes_80c_ethylhexyl",
    "zhang_spikes_80c_octyl",
    "zhang_spikes_80c_cyclohexylethyl",
    "gosvami",
)


def rates_of_case_b(scene: Scene) -> tuple[float, float]:
    """Growth over h_max and removal [1/s of test time] of the ball of case B, all nodes under the mean pressure."""
    law, op = scene.tribofilm, scene.operation
    hertz = scene.hertz(op.load)
    pressure = np.array([2.0 / 3.0 * hertz.pressure_max])
    speed = op.point.sliding_speed
    share = 2.0 * hertz.a / scene.geometry.track_length_1
    growing = law.exposure(pressure, scene.boundary_friction.film * pressure, speed, op.temperature)[0]
    return growing * (1.0 if law.dose == "contact_length" else share), law.abrasion(pressure, speed, None)[0] * share


@pytest.mark.parametrize("name", ACTIVATED)
def test_the_assumed_constants_of_activated_growth_start_and_settle_like_the_published_ones_of_case_b(name):
    published = Scene.from_toml("mtm_zddp").tribofilm
    scene = Scene.from_toml("mtm_zddp", {"tribofilm.set": name})
    growing, taking = rates_of_case_b(scene)
    full = scene.tribofilm.full_thickness
    assert full * growing == approx(0.2225e-9, rel=1e-3, abs=0.0)
    start = published.evolve(np.zeros(1), np.zeros(1), np.array([0.1 * published.rate(353.15)]), np.zeros(1), 353.15)
    assert full * growing * 0.1 == approx(thickness(*start)[0], rel=1e-3, abs=0.0)
    settled = published.full_thickness - published.removal_thickness
    assert full * growing / (growing + taking) == approx(settled, rel=1e-3, abs=0.0)


def test_the_combined_constants_are_half_of_both():
    half = rates_of_case_b(Scene.from_toml("mtm_zddp", {"tribofilm.set": "combined_80c"}))
    sheared = rates_of_case_b(Scene.from_toml("mtm_zddp", {"tribofilm.set": "zhang_spikes_80c_ethylhexyl"}))
    assert half[0] == approx(0.5 * (sheared[0] + 1.2215e-3), rel=1e-3, abs=0.0)
    assert half[1] == sheared[1]


def test_growth_with_removal_is_that_of_the_differential_equation():
    """Azam's (5-6) with the factor 1 - h / h_max and first-order removal, under 150 MPa in a contact."""
    law = replace(
        Scene.from_toml("mtm_zddp", {"tribofilm.set": "zhang_spikes_80c_ethylhexyl"}).tribofilm, prefactor=0.1
    )
    barrier, volume, k_t = 65e3 / 6.02214076e23, 0.13e-27, 1.380649e-23 * 353.15
    speed, pressure = 0.005, 1e9

    def changing(t, h):
        growth = 0.1 * np.exp(-(barrier - 150e6 * volume) / k_t) * (1.0 - h / 200e-9)
        return growth - 2.168e-8 * h * pressure * speed

    end = 20.0
    found = solve_ivp(changing, (0.0, end), [20e-9], rtol=1e-10, atol=1e-18).y[0, -1]
    exposed = law.exposure(np.zeros(1), np.array([150e6]), speed, 353.15) * end
    abraded = law.abrasion(np.array([pressure]), speed, None) * end
    growth, removal = law.evolve(np.array([20e-9]), np.zeros(1), exposed, abraded, 353.15)
    assert abs(found - 20e-9) > 5e-9
    assert growth[0] == approx(found, rel=1e-8, abs=0.0)
    assert not removal.any()
