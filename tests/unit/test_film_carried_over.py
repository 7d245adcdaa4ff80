"""A moving film over a time step: what lies between asperities moves along unchanged, and nothing hangs on the step."""

from dataclasses import replace

import numpy as np
import pytest
from comparison import approx
from wavy_contact import problem

from contact_core import Scene, advance, initial_state
from contact_core.deterministic.instant import Transient, solve_instant
from contact_core.deterministic.transient import begin, next_instant
from contact_core.film.routes import solve_film
from contact_core.film.slow_film import SlowFilm, slow_film
from contact_core.kernels.mixed.stopping_rule import allowed_imbalance
from contact_core.scene import Case

ROLLING = {"operation.speed_1": "0.25 m/s", "operation.speed_2": "0.25 m/s"}


def test_what_deviates_from_the_film_that_stands_still_moves_by_whole_nodes_unchanged():
    rough = np.random.default_rng(1).uniform(0.5, 1.5, (3, 65))
    still = np.full((3, 65), 2.0), np.full((3, 65), 3.0)
    for rolled in (1, 3):
        carried = SlowFilm(*still).carried(2.0 + rough, rolled)
        assert carried[:, rolled:] == approx(3.0 + rough[:, :-rolled], rel=1e-14)
    assert SlowFilm(*still).carried(2.0 + rough, 0) == approx(3.0 + rough, rel=1e-14)


@pytest.mark.parametrize("part", [0.25, 0.5])
def test_the_film_that_stands_still_is_known_between_the_nodes(part):
    """Of a grid of half the nodes, moved on by half of one: every other node of the finer grid."""
    case = bound({})
    coarse, fine = (replace(case.grid(n), x=np.linspace(-0.2e-3, 0.2e-3, n)) for n in (65, 65))
    now, settings = _instant(case, coarse), case.scene.film.settings
    still = slow_film(now, fine.shifted(part * fine.spacing), part, settings, solve_film)
    edge = np.abs(np.hypot(fine.x[None, :], fine.y[:, None]) / case.hertz.a - 1.0) < 0.2
    middle = 0.5 * (still.before[:, :-1] + still.before[:, 1:]) if part == 0.5 else None
    assert still.before[32, 32] == approx(still.now[32, 32], rel=2e-3)
    if middle is not None:  # next to the edge of the contact a straight line is far off, a cubic is off as well
        assert np.abs(still.now[:, :-1] / middle - 1.0)[edge[:, :-1]].max() > 0.05
