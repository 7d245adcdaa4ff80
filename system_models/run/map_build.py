"""Makes the map of a scene: histories until it is as accurate as asked for, or the time is over.

Most are solved on a grid with half as many intervals, some on the scene's own too: what the two differ by.
"""

import json
import math
import time
from collections.abc import Callable, Container, Generator, Iterator, Mapping, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass, fields, replace
from itertools import takewhile
from pathlib import Path
from typing import Any

import numpy as np

from contact_core.corrections.correction import CORRECTED
from contact_core.corrections.fitting import Rule, Samples, TooFewError, fitted, widths_at
from contact_core.corrections.knot import History, coarser, contact_of, samples_of, solve
from contact_core.corrections.map import Map, digest_of
from contact_core.corrections.query import here, told
from contact_core.errors import ContactError
from contact_core.kernels.arrays import Array
from contact_core.regression.outputs import half_widths
from contact_core.scene import Scene

from .map_ranges import Ranges
from .workers import done_by, workers

SEED = 1  # of the histories
_GROUP = 4  # histories on the coarser grid, the first of which is solved on the scene's as well
_HELD = {True: 4 * _GROUP, False: 5}  # one history in so many judges the map: if there is a coarser grid, if not
_ROUND = 10  # new histories after which the map is fitted again
_MOST = 100_000


@dataclass(frozen=True)
class Order:
    """The request for a map."""

    scene: Scene
    ranges: Ranges
    accuracy: float  # median half width of friction and h_c, relative
    seconds: float  # time for all histories; those of an earlier run do not count
    processes: int = 1
    executor: str | None = None


@dataclass(frozen=True)
class Judged:
    """Held-back knots on the scene's grid: deviations from the map, and half widths, [knots, outputs]; as `Samples`."""

    samples: Samples
    raw: Array  # deviations from the regression level
    off: Array  # from the map
    of_map: Array  # half widths of the map alone
    of_block: Array  # that the blocks state themselves
    outside: int  # knots beyond the ranges of the map, where the regression level takes over

    @property
    def stated(self) -> Array:
        """Half widths of map and blocks together."""
        return np.asarray(np.hypot(self.of_map, self.of_block))


@dataclass(frozen=True)
class Built:
    """A map, its histories and how good it is."""

    order: Order
    chart: Map
    histories: tuple[History, ...]  # all, in their order
    reached: bool  # False: the time was over first
    halves: tuple[float, ...]  # median half width of each output over the knots, in the units of `Samples.off`
    judged: Judged | None  # None: no knot that counts is held back

    @property
    def fitted(self) -> list[History]:
        """Histories that the map is fitted to."""
        return fit_histories(self.order, self.histories)

    @property
    def held(self) -> list[History]:
        """Histories that the map is judged by, and not fitted to."""
        return [history for history in self.histories if is_held(self.order, history.number)]


Task = tuple[int, bool]  # number of a history, and whether it is on the scene's grid
Progress = Callable[[int, tuple[float, ...] | None], None]


def build(order: Order, file: Path, progress: Progress = lambda histories, halves: None) -> Built:
    """Return the map of a scene; histories in `file` are not solved again, new histories are added to it.

    `progress` is called with the number of histories and the half widths reached, None before there are any. Raises
    ContactError if too few can be solved in the time.
    """
    known = read(order, file)
    end, checked = time.monotonic() + order.seconds, 0
    halves: tuple[float, ...] | None = None
    reached, scene = False, scene_of_histories(order.scene)
    with workers(order.processes, order.executor) as given, file.open("a", encoding="utf-8") as out:
        asked = ((scene, *task, order.ranges.draw(SEED, task[0])) for task in tasks(order) if task not in known)
        with closing(_with_none_first(done_by(given, solve, asked))) as results:
            for history in results:
                if history is not None:
                    known[history.number, history.fine] = history
                    out.write(json.dumps(history.to_dict()) + "\n")
                    out.flush()
                whole = _whole(order, known)
                if len(whole) >= checked + _ROUND:
                    checked = len(whole) - len(whole) % _ROUND
                    with suppress(TooFewError):
                        halves = medians(order, mapped(order, whole[:checked]), whole[:checked])
                        reached = max(halves[:2]) <= order.accuracy
                progress(len(known), halves)
                if reached or time.monotonic() > end:
                    break
    used = _whole(order, known)[:checked] if reached else tuple(known[task] for task in tasks(order, known))
    chart = mapped(order, used)
    return Built(order, chart, used, reached, medians(order, chart, used), judged(order, chart, used))


def tasks(order: Order, known: Container[Task] | None = None) -> Iterator[Task]:
    """Yield the histories to be solved, in their order; with `known` those that are known alone."""
    two = coarser(order.scene) is not None
    for number in range(_MOST):
        for fine in [True] * (not two or number % _GROUP == 0) + [False] * two:
            if known is None or (number, fine) in known:
                yield number, fine


def _with_none_first(results: Iterator[History]) -> Generator[History | None]:
    """Yield None, then the results: the histories that are known already may be enough."""
    yield None
    yield from results


def _whole(order: Order, known: Mapping[Task, History]) -> tuple[History, ...]:
    """Return the histories from the first one on without a gap."""
    return tuple(known[task] for task in takewhile(known.__contains__, tasks(order)))


def scene_of_histories(scene: Scene) -> Scene:
    """Return the scene that histories are solved with: its tribofilm grows at any temperature of the ranges."""
    tribofilm: Any = scene.tribofilm
    if "beyond_fit" in {f.name for f in fields(tribofilm)}:
        tribofilm = replace(tribofilm, beyond_fit="extrapolate")
    return replace(scene, tribofilm=tribofilm)


def is_held(order: Order, number: int) -> bool:
    """Return True if a history judges the map, which is fitted without it."""
    every = _HELD[coarser(order.scene) is not None]
    return number % every == every - _GROUP


def fit_histories(order: Order, histories: Sequence[History]) -> list[History]:
    """Return the histories that a map is fitted to."""
    return [history for history in histories if not is_held(order, history.number)]


def mapped(order: Order, histories: Sequence[History]) -> Map:
    """Return the map of histories. Raises TooFewError for too few."""
    chosen = fit_histories(order, histories)
    samples = samples_of(scene_of_histories(order.scene), chosen)
    return fitted(samples, order.scene.name, digest_of(order.scene), order.ranges.rows, Rule())


def medians(order: Order, chart: Map, histories: Sequence[History]) -> tuple[float, ...]:
    """Return the median half widths of a map alone over the knots on the scene's grid."""
    fine = [history for history in fit_histories(order, histories) if history.fine]
    samples = samples_of(scene_of_histories(order.scene), fine)
    return tuple(map(float, np.median(widths_at(chart, samples.places), axis=0)))


def judged(order: Order, chart: Map, histories: Sequence[History]) -> Judged | None:
    """Return what held-back histories on the scene's grid say of a map."""
    held = [history for history in histories if history.fine and is_held(order, history.number)]
    knots = [knot for history in held for knot in history.knots if knot.counts]
    if not knots:
        return None
    scene = scene_of_histories(order.scene)
    samples = samples_of(scene, held)
    trust, slips = np.empty((len(knots), 1)), np.empty((len(knots), 1))
    off, regression = np.empty_like(samples.off), np.empty_like(samples.off)
    for row, knot in enumerate(knots):
        case, contact = contact_of(scene, knot)
        place = here(chart, case, contact)
        friction, film, ratio = told(chart, place, contact.load_ratio)
        off[row] = samples.off[row] - (math.log(friction), math.log(film), ratio - contact.load_ratio)
        stated = half_widths(case, contact)
        regression[row] = [stated[error] for error in CORRECTED.values()]
        trust[row], slips[row] = place.trust, place.trust * place.slides
    trusted = np.hstack([slips, trust, trust])
    of_map = trusted * widths_at(chart, samples.places) + (1.0 - trusted) * regression
    return Judged(samples, samples.off, off, of_map, samples.stated, int(np.sum(trust < 1.0)))


def _head(order: Order) -> dict[str, object]:
    return {"map of": digest_of(order.scene), "ranges": [list(row) for row in order.ranges.rows], "seed": SEED}


def read(order: Order, file: Path) -> dict[Task, History]:
    """Return the histories of a file by their tasks; without a file, begin one.

    A last line that a kill has cut is left out. Raises ContactError if they are of another scene or other ranges.
    """
    head = json.dumps(_head(order))
    if not file.exists():
        file.write_text(head + "\n", encoding="utf-8")
        return {}
    first, *lines = file.read_text("utf-8").split("\n")
    if first != head:
        raise ContactError(
            f"The histories in '{file}' are of another scene, or of other ranges. Use another --out, or delete the "
            "file."
        )
    whole = lines[:-1]  # behind the last end of line there is nothing, or what a kill has left
    if lines[-1:] != [""]:
        file.write_text("\n".join([first, *whole]) + "\n", encoding="utf-8")
    found = [History.from_dict(json.loads(line)) for line in whole]
    return {(history.number, history.fine): history for history in found}
