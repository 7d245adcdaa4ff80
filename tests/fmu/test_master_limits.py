"""The longest step, and the outputs that are to meet the tolerance."""

import numpy as np
import pytest
from built import Built
from comparison import approx

from benchmarks.models.systems import quarter_car_force, two_mass_force
from system_models.master import CouplingError, simulate
from system_models.master.coupled import Coupled


@pytest.fixture(scope="module")
def case(built: Built):
    return two_mass_force(built.models)


def run(case, **settings):
    return simulate(case.system, 2.0, 1e-3, outputs=case.states, **{"order": 2, "tolerance": 1e-3, **settings})


def test_no_step_is_longer_than_the_longest(case):
    free, bounded = run(case), run(case, max_step=4e-3)
    longest = free["master.step_size"].values.max()
    assert longest > 8e-3
    assert bounded["master.step_size"].values.max() == approx(2e-3)  # the halves of steps stand
    assert bounded.attrs["steps"] > free.attrs["steps"]


def test_after_a_change_of_the_schedule_steps_are_short_again(case, built):
    """Steps that have grown know nothing of what follows."""
    system = quarter_car_force(built.models).system
    system.schedule = {"wheel.road": [(0.0, 0.0), (1.0, 0.1)]}
    found = simulate(system, 1.5, 1e-4, order=2, tolerance=1e-2, outputs=["wheel.x"])
    sizes, times = found["master.step_size"].values, found["time"].values
    changed = int(np.flatnonzero(times == 1.0)[0])
    assert sizes[changed] > 1e-3
    assert sizes[changed + 1 : changed + 3].sum() <= 1e-4 * (1.0 + 1e-9)


def test_only_the_outputs_that_are_named_are_to_meet_the_tolerance(case):
    """A speed is rougher than a position: left out, it does not ask for short steps."""
    every, named = run(case), run(case, controlled=["one.x"])
    assert named.attrs["steps"] < every.attrs["steps"]
    exact = case.solution(named["time"].values)
    position = np.abs(named["one.x"].values - exact[:, case.states.index("one.x")])
    assert position.max() < 3e-3 * np.abs(exact).max()


@pytest.mark.parametrize("part", [0, 1, 2], ids=["whole step", "first half", "second half"])
def test_a_step_is_repeated_if_the_iteration_has_failed_in_any_part_of_it(case, monkeypatch, part):
    def rejected():
        calls.clear()
        found = simulate(case.system, 1e-2, 1e-3, tolerance=0.1, iterate="quasi_newton", outputs=case.states)
        return found.attrs["rejected"]

    calls, whole = [], Coupled.advance

    def failing(coupled, end, start):
        outcome = whole(coupled, end, start)
        calls.append(end)
        return outcome._replace(residual=1.5) if len(calls) == 1 + part else outcome

    assert rejected() == 0
    monkeypatch.setattr(Coupled, "advance", failing)
    assert rejected() == 1


def test_all_coupled_outputs_named_are_as_none_named(case):
    every, named = run(case), run(case, controlled=["two.F", "one.v", "one.x"])
    assert all((every[name].values == named[name].values).all() for name in case.states)


def test_communication_points_are_those_that_are_given_and_multiples_of_the_step_after_them(case):
    chosen = run(case)
    times = chosen["time"].values[1:]
    again = run(case, tolerance=None, points=times)
    assert again["time"].values.tolist() == chosen["time"].values.tolist()
    for name in case.states:
        np.testing.assert_allclose(again[name].values, chosen[name].values, rtol=1e-9, atol=1e-12)
    few = run(case, tolerance=None, points=[3e-4, 1.1e-3])
    assert few["time"].values[1:5].tolist() == [3e-4, 1.1e-3, 2e-3, 3e-3]


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"max_step": 1e-4}, "max_step = 0.0001 s is below step_size = 0.001 s. Raise it."),
        ({"max_step": 1e-2, "tolerance": None}, "limits steps chosen by a tolerance. Give one as well."),
        ({"controlled": ["one.x"], "tolerance": None}, "must keep a tolerance. Give one as well."),
        ({"points": [1.0]}, "tolerance = 0.001 chooses the steps, and so do points. Leave one out."),
        ({"points": [1.0, 1.0], "tolerance": None}, "points, times in s, must be above 0 and rise."),
        ({"points": [0.0, 1.0], "tolerance": None}, "points, times in s, must be above 0 and rise."),
        ({"controlled": ["one.y"]}, "controlled has 'one.y', which sets no input. Did you mean 'one.x'?"),
    ],
)
def test_what_makes_no_sense_is_refused(case, settings, sentence):
    with pytest.raises(CouplingError, match=sentence.replace(".", r"\.").replace("?", r"\?")):
        run(case, **settings)
