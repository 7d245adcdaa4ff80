"""No verdict hangs on rounding: every regime and algorithm from inputs and starts that are disturbed by 1e-12."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.film.cases import RoughCase, grid_of, instant_of_call
from benchmarks.film.random_points import MODULUS, Point
from contact_core import Logarithmic, Rounded, line_contact, point_contact
from contact_core.film import routes
from contact_core.film.instant import Settings, Step
from contact_core.film.routes import solve_film
from contact_core.laws.asperity_layer import AsperityLayer

NODES, TOLERANCE, SIZE = 33, 3e-3, 1e-12
SEED = 1
FILM, SHARE = (
    0.2e-9,
    0.02,
)  # differences that always may be: of films [m], a fifth of a floor; of the solids' share of the load
NEAR_THE_FLOOR = "held", "marched"  # methods of films of a few floors: values agree within their stated errors
CONSERVING = {"cavitation": "mass_conserving"}
OIL_UNDER_CONTACTS = Point(14, 0.006276386, 4.616751, -5.319565e-05, 1.791374, 2.216535e-07)
NODES_AT_THE_FLOOR = Point(81, 0.01397999, 13.89818, -0.1151738, 0.0002544781, 2.16063e-07)
POCKETS = Point(238, 0.01048254, 345.1453, 1.754212, 0.001713903, 5.780584e-07)
LINE = Point(273, 0.03933275, 699.0351, 0.001999361, 0.01332778, 3.584066e-08)


class Noise:
    """Relative disturbances by a generator; None disturbs nothing."""

    def __init__(self, seed):
        self.random = None if seed is None else np.random.Generator(np.random.Philox(seed))

    def __call__(self, value):
        if self.random is None:
            return value
        return value * (1.0 + SIZE * self.random.standard_normal(np.shape(value)))


def ball(load, speed, rq=0.0, ratio=1.0, **more):
    """Arguments of `point_contact`; waves of five nodes and more."""
    point = Point(3, 0.01, load, speed, 0.02, rq, ratio)
    given = point.arguments(NODES)
    grid = point.grid(NODES)
    return point_contact, given | {"heights_2": point.heights(grid, 3.0 * grid.spacing)} | more


def line(load, speed, rq=0.0, **more):
    return line_contact, Point(3, 0.01, load, speed, 0.02, rq).line_arguments(NODES) | more


def roller(load, profile):
    oil = {"viscosity": 0.05, "pressure_viscosity": 2e-8, "speed_1": 5.0, "speed_2": 5.0}
    given = {"load": load, "radius": 0.01, "reduced_modulus": MODULUS, "length": 3e-3, "profile": profile}
    return line_contact, given | oil | {"grid": NODES}


ONE_ROW = {key: value for key, value in line(20.0, 1.0)[1].items() if key not in ("heights_2", "spacing")}
ONE_ROW = ONE_ROW | {"grid": NODES}
CALLS = {  # by the row of `routes.REGIMES` that they belong to
    "smooth: circle": ball(20.0, 1.0),
    "smooth: circle, light": ball(0.05, 1.0),
    "smooth: circle, of second order upstream": ball(20.0, 1.0, flux="upwind"),
    "smooth: circle, heavy": ball(300.0, 0.05),
    "light: circle": ball(0.1, 1.0, 30e-9),
    "light: circle, thin film": ball(2.0, 0.3, 150e-9),
    "light: circle, thick film": ball(2.0, 1.0, 30e-9),
    "film: circle": ball(100.0, 0.5, 50e-9),
    "thick film: circle": ball(50.0, 1.0, 50e-9),
    "mixed: circle": ball(50.0, 0.3, 150e-9),
    "mixed: circle, entrained the other way": ball(50.0, -0.3, 150e-9),
    "boundary: circle": ball(50.0, 0.003, 300e-9),
    "dry: circle": ball(50.0, 1e-6, 300e-9),
    "smooth: circle, conserving": ball(20.0, 1.0, **CONSERVING),
    "smooth: circle, starved": ball(20.0, 1.0, **CONSERVING, supply=5e-8),
    "smooth: circle, meniscus": ball(20.0, 1.0, meniscus=2e-4),
    "smooth: circle, light, conserving": ball(0.1, 1.0, **CONSERVING),
    "light: circle, conserving": ball(0.1, 1.0, 30e-9, **CONSERVING),
    "smooth: circle, light, starved": ball(0.1, 1.0, 30e-9, **CONSERVING, supply=1e-7),
    "light: circle, meniscus": ball(0.1, 1.0, 30e-9, meniscus=8e-5),
    "thick film: circle, conserving": ball(50.0, 1.0, 50e-9, **CONSERVING),
    "moderate: circle, starved": ball(50.0, 1.0, 50e-9, **CONSERVING, supply=5e-8),
    "mixed: circle, conserving": ball(50.0, 0.3, 150e-9, **CONSERVING),
    "mixed: circle, meniscus": ball(50.0, 0.3, 150e-9, meniscus=3e-4),
    "smooth: ellipse": ball(20.0, 1.0, ratio=3.0),
    "smooth: ellipse, conserving": ball(20.0, 1.0, ratio=3.0, **CONSERVING),
    "mixed: ellipse": ball(50.0, 0.3, 150e-9, ratio=0.3),
    "light: ellipse": ball(0.1, 1.0, 30e-9, ratio=0.3),
    "line: one row": (line_contact, ONE_ROW),
    "line: one row, conserving": (line_contact, ONE_ROW | CONSERVING),
    "line: one row, starved": (line_contact, ONE_ROW | CONSERVING | {"supply": 1e-7}),
    "clear line: heavy": line(20.0, 1.0, 50e-9),
    "clear line: conserving": line(20.0, 1.0, 50e-9, **CONSERVING),
    "clear line: starved": line(20.0, 1.0, 50e-9, **CONSERVING, supply=2e-7),
    "clear line: thick film": line(0.1, 1.0, 100e-9),
    "light line: rough": line(0.1, 0.03, 150e-9),
    "rough line: thin film": line(0.5, 0.03, 150e-9),
    "moderate line: rough": line(2.0, 0.3, 300e-9),
    "mixed line: rough": line(100.0, 0.1, 150e-9),
    "dry: line": line(50.0, 1e-6, 300e-9),
    "roller: smooth": roller(3e5, Logarithmic(3e-6)),
    "roller: conserving": (line_contact, roller(3e5, Logarithmic(3e-6))[1] | CONSERVING),
    "roller: its ends touch": roller(3e5, Rounded(2.2e-3, 1.0)),
    "boundary: near the floor, oil under contacts": (point_contact, OIL_UNDER_CONTACTS.arguments(NODES)),
    "boundary: near the floor, nodes at it": (point_contact, NODES_AT_THE_FLOOR.arguments(NODES)),
    "mixed: near the floor, pockets": (point_contact, POCKETS.arguments(NODES)),
    "mixed line: near the floor": (line_contact, LINE.line_arguments(65)),
}
SLOW = (  # each beside a quick one of its row and its algorithm
    "smooth: circle, heavy",
    "roller: its ends touch",
    "boundary: near the floor, nodes at it",
    "mixed: near the floor, pockets",
    "mixed line: near the floor",
)
DISTURBED = "load", "speed_1", "speed_2", "viscosity", "heights_2"


@pytest.fixture
def noise(monkeypatch):
    """A function that makes what follows start from disturbed iterates, and returns the noise."""
    start = routes._Solver._start

    def set_seed(seed):
        new = Noise(seed)

        def disturbed(solver, name):
            it = start(solver, name)
            if it is None or seed is None:
                return it
            p = new(it.pressure)
            alone = (it.fluid == it.pressure) & ~it.solid
            fluid = np.where(alone, p, np.minimum(new(it.fluid), p))
            return replace(it, pressure=p, fluid=fluid, rigid=float(new(it.rigid)))

        monkeypatch.setattr(routes._Solver, "_start", disturbed)
        return new

    return set_seed


def agree(one, other, stated=(0.0, 0.0)):
    """The same verdict, and values as near as the tolerance has them, or `stated` errors of film and share."""
    assert one[0]
    assert other[0]
    method, other_method = (algorithm.split(": ")[-1].split(" from ")[0] for algorithm in (one[1], other[1]))
    assert method == other_method
    (p, film, share), (q, other_film, other_share) = one[2:], other[2:]
    film_error, share_error = stated if method in NEAR_THE_FLOOR else (0.0, 0.0)
    weight = p / p.sum()
    assert np.abs(p - q).sum() < 2.0 * TOLERANCE * p.sum()
    assert (weight * np.abs(film - other_film)).sum() < max(5.0 * TOLERANCE * (weight * film).sum() + FILM, film_error)
    assert abs(share - other_share) < max(SHARE, share_error)


def test_every_row_of_the_table_is_here():
    assert {name.partition(":")[0] for name in CALLS} == {row.name for row in routes.REGIMES}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.long) if name in SLOW else name for name in CALLS]
)
def test_a_call_gives_the_same_verdict_and_values(name, noise):
    call, given = CALLS[name]
    answers = []
    for seed in (None, SEED):
        off = noise(seed)
        moved = {key: off(given[key]) for key in DISTURBED if key in given}
        found = call(**given | moved, tolerance=TOLERANCE)
        share = found.solid_pressure.sum() / found.pressure.sum()
        answers.append((found.converged, found.algorithm, found.pressure, found.film, share))
        stated = [found.error_estimate[each] for each in ("h_c", "contact_load_ratio")]
    assert answers[0][1].partition(":")[0] == name.partition(":")[0]
    agree(*answers, stated)


def layered(ratio, rms, rq=131.5e-9, **more):
    """A film over asperities of an rms height [m] below the grid; film of smooth bodies over rq."""
    case = RoughCase(53.70, 9.525e-3, 0.004, 14.94e-9, rq, 40e-6, ratio)
    grid = grid_of(case.domain, NODES)
    now = instant_of_call(case.arguments(), case.heights(NODES), case.hardness)
    return replace(now, microroughness=AsperityLayer(rms, 4e-6) if rms else None, **more), grid


LAYERS = {
    "hardly any film": layered(0.05, 10e-9),
    "thin film": layered(0.3, 10e-9),
    "film": layered(1.0, 10e-9),
    "thick film, higher asperities": layered(4.0, 50e-9),
    "smooth": layered(0.3, 50e-9, 0.0),
    "conserving": layered(0.3, 10e-9, 0.0, conserving=True),
    "meniscus": layered(1.0, 10e-9, 0.0, meniscus=300e-6),
}
SETTINGS = Settings(1e-9, TOLERANCE, 2000, "scipy", fitted=True)


def answer(found):
    p = found.state.pressure
    return found.converged, found.algorithm, p, found.gap, (p - found.state.fluid).sum() / p.sum()


@pytest.mark.parametrize("name", LAYERS)
def test_a_film_under_asperities_gives_the_same_verdict_and_values(name, noise):
    now, grid = LAYERS[name]
    answers = []
    for seed in (None, SEED):
        off = noise(seed)
        moved = replace(now, heights=off(now.heights), load=float(off(now.load)))
        answers.append(answer(solve_film(moved, grid, SETTINGS)))
    agree(*answers)


MARCHES = {
    "mixed": layered(0.3, 0.0),
    "mixed, asperities below the grid": layered(0.3, 10e-9),
    "film": layered(1.0, 0.0),
    "film, asperities below the grid": layered(1.0, 10e-9),
    "film, conserving": layered(1.0, 0.0, conserving=True),
    "film, starved": layered(1.0, 0.0, conserving=True, supply=3e-7),
    "thick film": layered(4.0, 0.0),
}


@pytest.mark.parametrize("thorough", [False, True])
@pytest.mark.parametrize("name", MARCHES)
def test_a_march_gives_the_same_verdict_and_values(name, thorough, noise):
    now, grid = MARCHES[name]
    first, answers = solve_film(now, grid, SETTINGS).state, []
    for seed in (None, SEED):
        off, state, heights = noise(seed), first, now.heights
        for _ in range(3):
            heights = np.roll(heights, 1, axis=1)
            step = Step(grid.spacing / now.entrainment_speed, 1, thorough=thorough, rolled=1)
            state = replace(state, mass=off(state.mass))
            found = solve_film(replace(now, heights=off(heights)), grid, replace(SETTINGS, iterations=150), state, step)
            state = found.state
        answers.append(answer(found))
    agree(*answers)
