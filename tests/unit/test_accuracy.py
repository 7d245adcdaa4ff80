"""The argument `accuracy` of the calls, and the sequence of grids behind it."""

from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from comparison import approx

from contact_core import ConvergenceError, OperatingPointError, dry_contact, line_contact, point_contact
from contact_core.calls.refinement import grids_within, refined_cells, refined_grid, surface_of
from contact_core.film.instant import FilmState, Grid
from contact_core.film.refined import Request, moved, refined
from contact_core.reference import hertz_point

OIL = {"reduced_modulus": 230e9, "viscosity": 0.01, "pressure_viscosity": 15e-9}
BALL = OIL | {"load": 20.0, "radius_x": 10e-3, "speed_1": 0.5, "speed_2": 0.5}
FLANK = OIL | {"load": 1e5, "radius": 10e-3, "speed_1": 1.0, "speed_2": 1.0}
THIN = {"viscosity": 0.004, "speed_1": 0.25, "speed_2": 0.25}
RELATIVE, RATIOS = ("h_central", "h_c", "pressure_max"), ("contact_load_ratio", "contact_area_ratio")


def ridges(nodes, spacing, rq, length=60e-6):
    """Heights [1, nx] of two waves."""
    x = spacing * (np.arange(nodes) - 0.5 * (nodes - 1))
    return rq * (np.cos(2.0 * np.pi * x / length) + np.cos(2.0 * np.pi * x / (1.7 * length) + 1.0))[None]


def rough_line(accuracy=None, nodes=65, **more):
    side = 3.0e-4
    spacing = 2.0 * side / (nodes - 1)
    return line_contact(
        **(FLANK | {"speed_1": 0.02, "speed_2": 0.02}),
        heights_2=ridges(nodes, spacing, 6e-8),
        spacing=spacing,
        hardness=4e9,
        accuracy=accuracy,
        **more,
    )


def rough_ball(accuracy=None, nodes=65, speed=0.25, **more):
    side = 2.0 * hertz_point(20.0, 10e-3, 10e-3, 230e9).a
    x = np.linspace(-side, side, nodes)
    heights = 4e-8 * np.cos(4.0 * np.pi * x / side)[:, None] * np.cos(4.0 * np.pi * x / side + 0.4)
    slow = {"speed_1": speed, "speed_2": speed}
    return point_contact(**(BALL | THIN | slow), heights_1=heights, spacing=x[1] - x[0], accuracy=accuracy, **more)


FINER = {
    "ball": (
        lambda **more: point_contact(**(BALL | THIN), **more),
        lambda: point_contact(**(BALL | THIN), grid=257, tolerance=1e-4),
    ),
    "line": (
        lambda **more: line_contact(**FLANK, **more),
        lambda: line_contact(**FLANK, grid=2049, tolerance=1e-4),
    ),
    "rough ball": (rough_ball, lambda: rough_ball(nodes=193)),
    "rough ball in contact": (
        lambda **more: rough_ball(speed=1e-4, **more),
        lambda: rough_ball(speed=1e-4, nodes=193),
    ),
    "rough line": (rough_line, lambda: rough_line(nodes=513)),
}


def errors(found, true):
    """Errors as the accuracy counts them, [true, stated]."""
    scale = dict.fromkeys(RATIOS, 1.0) | {name: abs(getattr(true, name)) for name in RELATIVE}
    return np.array(
        [
            (abs(getattr(found, name) - getattr(true, name)) / one, found.error_estimate[name] / one)
            for name, one in scale.items()
        ]
    )


@cache
def solved(case):
    """The answer at 5 %, and its errors."""
    call, finer = FINER[case]
    found = call(accuracy=0.05)
    return found, errors(found, finer())


@pytest.mark.parametrize("case", FINER)
def test_true_errors_are_within_the_accuracy_and_within_what_is_stated(case):
    found, (true, stated) = solved(case)[0], solved(case)[1].T
    assert not any("not reached" in line for line in found.warnings)
    assert (true <= 0.05).all()
    assert (true <= stated).all()
    assert (stated <= 0.05).all()


def test_a_tenth_of_the_stated_errors_would_not_cover_the_true_ones():
    true, stated = np.concatenate([solved(case)[1] for case in FINER]).T
    assert (true > 0.1 * stated).sum() >= 3


def test_a_smaller_accuracy_takes_finer_grids():
    coarse, fine = (point_contact(**BALL, accuracy=accuracy) for accuracy in (0.1, 0.02))
    assert coarse.film.shape < fine.film.shape
    assert fine.error_estimate["h_central"] < coarse.error_estimate["h_central"]


def test_the_steps_are_the_grids_that_were_solved_and_end_with_that_of_the_result():
    found = rough_ball(accuracy=0.05)
    nodes = [step.nodes for step in found.steps]
    assert nodes == sorted(set(nodes))
    assert nodes[-1] == found.film.shape == (found.y.size, found.x.size)
    assert all(step.converged and step.iterations > 0 for step in found.steps)
    assert found.steps[0].error == np.inf
    worst = max(errors(found, found)[:, 1])
    assert found.steps[-1].error == approx(worst, rel=0.02)  # the rest is by the inlet, which no finer grid changes
    assert all(step.error > 0.05 for step in found.steps[:-1])
    assert point_contact(**BALL, grid=65).steps == ()


def test_a_dry_contact_is_as_near_to_hertz_as_it_states():
    hertz = hertz_point(50.0, 10e-3, 10e-3, 230e9)
    found = dry_contact(np.zeros((48, 48)), 4.0 * hertz.a / 48, 10e-3, 50.0, 230e9, accuracy=0.02)
    true = np.array([abs(found.contact_area_ratio - 1.0), abs(found.pressure_max / hertz.pressure_max - 1.0)])
    stated = np.array(
        [found.error_estimate["contact_area_ratio"], found.error_estimate["pressure_max"] / found.pressure_max]
    )
    assert found.warnings == ()
    assert (true <= stated).all()
    assert (stated <= 0.02).all()
    assert (true > 0.1 * stated).any()
    assert abs(found.approach - hertz.approach) <= found.error_estimate["approach"] <= 0.02 * hertz.approach
    assert found.steps[-1].nodes == found.pressure.shape
    assert found.spacing * found.pressure.shape[0] == approx(4.0 * hertz.a)


def test_area_that_two_grids_have_in_common_by_chance_is_not_taken_for_exact():
    """On 32 and on 48 cells over two diameters of a Hertz contact the nodes in contact have the same area."""
    hertz = hertz_point(50.0, 10e-3, 10e-3, 230e9)
    areas = [dry_contact(np.zeros((n, n)), 4.0 * hertz.a / n, 10e-3, 50.0, 230e9).contact_area_ratio for n in (32, 48)]
    assert areas[0] == approx(areas[1], rel=1e-9)
    assert areas[0] - 1.0 > 0.03
    found = dry_contact(np.zeros((48, 48)), 4.0 * hertz.a / 48, 10e-3, 50.0, 230e9, accuracy=0.03)
    assert abs(found.contact_area_ratio - 1.0) <= found.error_estimate["contact_area_ratio"] <= 0.03


CALLS = {
    "point": lambda **more: point_contact(**BALL, **more),
    "line": lambda **more: line_contact(**FLANK, **more),
    "dry": lambda **more: dry_contact(np.zeros((33, 33)), 1e-5, 10e-3, 20.0, 230e9, **more),
}


@pytest.mark.parametrize("call", ["point", "line"])
def test_accuracy_together_with_grid_and_tolerance_is_refused(call):
    with pytest.raises(
        OperatingPointError, match=r"accuracy = 0\.02 chooses grid and tolerance itself: leave out grid"
    ):
        CALLS[call](accuracy=0.02, grid=65)
    with pytest.raises(OperatingPointError, match=r"leave out grid = 65 and tolerance = 0\.001, or give grid and tol"):
        CALLS[call](accuracy=0.02, grid=65, tolerance=1e-3)


def test_accuracy_of_a_dry_contact_together_with_its_tolerance_is_refused():
    with pytest.raises(OperatingPointError, match=r"accuracy = 0\.02 chooses tolerance itself: leave out tolerance = "):
        CALLS["dry"](accuracy=0.02, tolerance=1e-6)


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("accuracy", [0.0, -0.1, 1e-5, 0.6, np.nan, "2 %", True])
def test_accuracies_that_mean_nothing_are_refused(call, accuracy):
    with pytest.raises(OperatingPointError, match=r"accuracy = "):
        CALLS[call](accuracy=accuracy)


def test_heights_that_define_no_surface_are_refused():
    with pytest.raises(OperatingPointError, match=r"heights of \(4, 33\) nodes .* accuracy needs 8 along each side"):
        dry_contact(np.zeros((4, 33)), 1e-5, 10e-3, 20.0, 230e9, accuracy=0.02)


def test_an_accuracy_that_no_grid_reaches_is_told_with_what_was_reached():
    """The pressure at the edges of a punch grows with every finer grid."""
    punch = dry_contact(np.zeros((16, 16)), 1e-5, np.inf, 20.0, 230e9, accuracy=0.01)
    assert len(punch.warnings) == 1
    reached = punch.error_estimate["pressure_max"] / punch.pressure_max
    assert (
        f"accuracy = 0.01 is not reached: the stated error on 128 by 128 nodes is {reached:.2g} of pressure_max"
        in (punch.warnings[0])
    )
    assert reached > 0.01


def test_a_film_that_does_not_converge_on_any_grid_is_told():
    found = rough_line(accuracy=0.05, iterations=1)
    assert not found.converged
    said = "accuracy = 0.05 is not reached: no error can be stated on"
    assert any(said in line and "grids in a row gave no converged solution" in line for line in found.warnings)
    assert not any(step.converged for step in found.steps)
    assert set(found.error_estimate.values()) == {np.inf}


def test_the_domain_that_is_asked_for_is_kept():
    side = 2.0 * hertz_point(20.0, 10e-3, 10e-3, 230e9).a
    found = point_contact(**BALL, domain=(-side, side, -side, side), accuracy=0.1)
    assert found.x[[0, -1]] == approx([-side, side])
    assert found.y[[0, -1]] == approx([-side, side])


@pytest.mark.parametrize(
    ("call", "given"),
    [
        (point_contact, BALL | {"accuracy": 0.1}),
        (point_contact, BALL | {"grid": 65}),
        (line_contact, FLANK | {"grid": 129}),
    ],
)
def test_entrainment_the_other_way_is_the_mirror_image(call, given):
    there, back = (call(**(given | {"speed_1": u, "speed_2": u})) for u in (0.5, -0.5))
    assert -there.x[0] > 1.3 * there.x[-1]  # more room where oil comes in
    assert back.x == approx(-there.x[::-1])
    assert back.film == approx(there.film[:, ::-1], rel=1e-9)


# ---- grids and surfaces


def test_finer_grids_mean_the_same_surface():
    given = Grid.centred(33, 49, 1e-5)
    heights = np.random.Generator(np.random.Philox(3)).normal(size=(33, 49))
    surface = surface_of(heights, given).on
    assert surface(given) == approx(heights, abs=1e-12)
    fine = surface(refined_grid(given, 64))
    assert fine[::2, ::2] == approx(heights, abs=1e-12)
    finer = surface(refined_grid(given, 128))
    assert finer[::2, ::2] == approx(fine, abs=1e-12)


def test_the_surface_of_a_line_repeats_with_its_period_on_every_grid():
    rows, spacing = 16, 1e-5
    given = Grid.centred(rows, 65, spacing, periodic=True, repeats=3.0)

    def wave(grid):
        return np.cos(2.0 * np.pi * grid.y / (rows * spacing))[:, None] * np.ones(grid.x.size)

    for count in (32, 48, 96, 128):
        grid = refined_grid(given, count)
        assert grid.periodic
        assert grid.shape[0] % 2 == 0
        assert grid.shape[0] * grid.spacing == approx(rows * spacing)
        assert grid.repeats == 3.0
        assert surface_of(wave(given), given).on(grid) == approx(wave(grid), abs=2e-3)


def test_a_line_of_one_row_stands_for_its_whole_length_on_every_grid():
    given = Grid(1e-5 * np.arange(-32.0, 33.0), np.zeros(1), periodic=True, repeats=100.0)
    for grid in grids_within(given):
        assert grid.repeats * grid.shape[0] * grid.spacing == approx(100.0 * given.spacing)


@pytest.mark.parametrize("nodes", [(33, 33), (40, 57), (17, 129), (64, 31)])
def test_grids_lie_within_the_given_nodes_and_grow_finer(nodes):
    given = Grid.centred(*nodes, 1e-5)
    grids = grids_within(given)
    assert min(grids[0].shape) == 33
    for grid in grids:
        assert np.ptp(grid.x) <= np.ptp(given.x) * (1.0 + 1e-9)
        assert np.ptp(grid.y) <= np.ptp(given.y) * (1.0 + 1e-9)
        assert np.ptp(grid.x) > np.ptp(given.x) - grid.spacing
        assert np.ptp(grid.y) > np.ptp(given.y) - grid.spacing
        assert np.diff(grid.x) == approx(grid.spacing)
    assert all(fine.spacing < 0.9 * coarse.spacing for coarse, fine in pairwise(grids))


@pytest.mark.parametrize("nodes", [(33, 33), (64, 48), (17, 100)])
def test_cells_of_dry_contacts_cover_the_same_area(nodes):
    grids = refined_cells(*nodes, 1e-5)
    assert (*nodes,) in [grid.shape for grid in grids]
    for grid in grids:
        assert np.array(grid.shape) * grid.spacing == approx(1e-5 * np.array(nodes))


def test_a_film_moved_to_another_grid_keeps_linear_fields():
    old, new = Grid.centred(17, 33, 1.0), Grid.centred(24, 41, 0.625)

    def plane(grid):
        return 100.0 + 2.0 * grid.x[None, :] + 3.0 * grid.y[:, None]

    solid = np.broadcast_to(old.x[None, :] > 0.0, old.shape).copy()
    found = moved(FilmState(plane(old), 0.5 * plane(old), solid, 2.0 * plane(old), -7.0), old, new)
    assert found.pressure == approx(plane(new))
    assert found.fluid == approx(0.5 * plane(new))
    assert found.mass == approx(2.0 * plane(new))
    assert found.rigid_gap == -7.0
    assert np.array_equal(found.solid, np.broadcast_to(new.x[None, :] > 0.5, new.shape))


# ---- the sequence of grids


@dataclass(frozen=True)
class Made:
    """A solution with an error that falls with the square of the spacing."""

    spacing: float
    converged: bool = True
    values: dict = field(default_factory=lambda: {"film": 2.0})
    iterations: int = 3
    area_by_chance: float = 0.0

    @property
    def nodes(self):
        n = round(1.0 / self.spacing) + 1
        return n, n


SPACINGS = [1 / 32, 1 / 48, 1 / 64, 1 / 96, 1 / 128, 1 / 192, 1 / 256]


def climbed(accuracy, converged=lambda spacing: True, found=lambda spacing: True, coarsest=np.inf):
    def solve(at, before):
        if not found(SPACINGS[at]):
            raise ConvergenceError("none")
        return Made(SPACINGS[at], converged(SPACINGS[at]))

    def stated(solved):
        return {"film": np.inf if len(solved) == 1 else 2.0 * (10.0 * solved[-1].spacing) ** 2}

    return refined(SPACINGS, solve, stated, Request(accuracy, ("film",), (), coarsest))


def nodes_of(found):
    return [step.nodes[0] - 1 for step in found.steps]


def test_the_grid_after_one_is_as_fine_as_its_error_asks_for_but_at_most_twice_as_fine():
    assert nodes_of(climbed(0.03)) == [32, 64]
    assert nodes_of(climbed(0.012)) == [32, 64, 96]
    assert nodes_of(climbed(0.0016)) == [32, 64, 128, 192, 256]
    assert climbed(0.012).best.spacing == 1 / 96
    assert climbed(0.012).warnings == ()


def test_no_grid_is_the_answer_that_does_not_show_the_surface():
    assert nodes_of(climbed(0.5)) == [32, 64]
    assert nodes_of(climbed(0.5, coarsest=1 / 128)) == [32, 64, 128]
    heights = np.zeros((64, 64))
    assert dry_contact(heights, 5e-6, 10e-3, 20.0, 230e9, accuracy=0.3).pressure.shape < (64, 64)
    heights[30, 30] = 1e-8
    assert dry_contact(heights, 5e-6, 10e-3, 20.0, 230e9, accuracy=0.3).pressure.shape >= (64, 64)
    assert rough_ball(accuracy=0.4).film.shape >= (65, 65)


def test_a_grid_without_a_converged_solution_is_passed_over():
    found = climbed(0.012, converged=lambda spacing: spacing != 1 / 64)
    assert [step.converged for step in found.steps] == [True, False, True]
    assert found.best.converged
    assert found.warnings == ()


def test_after_two_grids_without_one_the_last_that_has_is_the_answer_with_a_warning():
    found = climbed(0.001, converged=lambda spacing: spacing > 1 / 100)
    assert found.best.spacing == 1 / 64
    assert nodes_of(found)[-2:] == [128, 256]
    assert (
        "accuracy = 0.001 is not reached: the stated error on 65 by 65 nodes is 0.024 of film; no finer"
        in (found.warnings[0])
    )


def test_where_no_solution_is_found_at_all_the_error_of_the_grid_is_raised():
    with pytest.raises(ConvergenceError, match="none"):
        climbed(0.01, found=lambda spacing: False)
    found = climbed(0.012, found=lambda spacing: spacing != 1 / 32)
    assert found.best.converged
