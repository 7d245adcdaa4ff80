"""Makes the map of a scene: knots until it is as accurate as asked for, or the time is over."""

import json
import math
import time
from collections.abc import Callable, Generator, Iterator
from contextlib import closing
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact_core.correction import CORRECTED
from contact_core.errors import ContactError
from contact_core.mapped.fitting import FEWEST, Rule, Samples, fitted, widths_at
from contact_core.mapped.knot import Knot, contact_of, samples_of, solve
from contact_core.mapped.map import Map, digest_of
from contact_core.mapped.query import here, told
from contact_core.regression.outputs import half_widths
from contact_core.scene import Scene

from .map_ranges import Ranges
from .map_workers import done_by, workers

Array = NDArray[np.float64]

SEED = 1  # of the places of the knots
_HELD = 5  # every so many knots, one is held back: it judges the map, which knows nothing of it
_ROUND = 16  # knots after which the map is made anew
_MOST = 100_000
_MIXED, _DRY = 0.375, 9  # least instants of a block: mixed ones over the nodes along x, dry ones


@dataclass(frozen=True)
class Order:
    """What is asked for."""

    scene: Scene
    ranges: Ranges
    accuracy: float  # median half width of friction and h_c, relative
    seconds: float  # time for all knots; those of an earlier run do not count
    processes: int = 1
    executor: str | None = None


@dataclass(frozen=True)
class Judged:
    """Held-back knots: deviations from the map, and half widths, [knots, outputs]; as `Samples.off`."""

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
    """A map and what it is made of."""

    order: Order
    chart: Map
    knots: tuple[Knot, ...]  # all, by number
    reached: bool  # False: the time was over first
    halves: tuple[float, ...]  # median half width of each output over the knots, in the units of `Samples.off`
    judged: Judged | None  # None: no knot that counts is held back


Progress = Callable[[int, tuple[float, ...] | None], None]


def build(order: Order, file: Path, progress: Progress = lambda knots, halves: None) -> Built:
    """Return the map of a scene; knots that `file` has are not solved again, new ones are added to it.

    `progress` is called with the number of knots and the half widths reached, None before there are any. Raises
    ContactError if too few knots can be solved in the time.
    """
    known = read(order, file)
    end, checked = time.monotonic() + order.seconds, 0
    chart: Map | None = None
    halves: tuple[float, ...] | None = None
    reached = False
    with workers(order.processes, order.executor) as given, file.open("a", encoding="utf-8") as out:
        todo = (number for number in range(_MOST) if number not in known)
        tasks = ((scene_of_knots(order.scene), number, *order.ranges.draw(SEED, number)) for number in todo)
        with closing(_with_none_first(done_by(given, solve, tasks))) as results:
            for knot in results:
                if knot is not None:
                    known[knot.number] = knot
                    out.write(json.dumps(knot.to_dict()) + "\n")
                    out.flush()
                whole = _whole(known)
                if whole >= checked + _ROUND:
                    checked = whole - whole % _ROUND
                    first = tuple(known[number] for number in range(checked))
                    if len(fit_knots(first)) >= FEWEST:
                        chart = mapped(order, first)
                        halves = medians(order, chart, first)
                        reached = max(halves[:2]) <= order.accuracy
                progress(len(known), halves)
                if reached or time.monotonic() > end:
                    break
    used = tuple(known[number] for number in sorted(known) if not reached or number < checked)
    chart = mapped(order, used)
    return Built(order, chart, used, reached, medians(order, chart, used), judged(order, chart, used))


def _with_none_first(results: Iterator[Knot]) -> Generator[Knot | None]:
    """Yield None, then the results: what is known already may do."""
    yield None
    yield from results


def _whole(known: dict[int, Knot]) -> int:
    """Return how many knots there are from number 0 without a gap."""
    number = 0
    while number in known:
        number += 1
    return number


def scene_of_knots(scene: Scene) -> Scene:
    """Return the scene that knots are solved with.

    Its tribofilm grows at any temperature of the ranges, so that films differ. Its blocks have more instants: a block
    settles ten times as long as it is sampled, so that these cost little and leave less scatter.
    """
    tribofilm: Any = scene.tribofilm
    if "beyond_fit" in {f.name for f in fields(tribofilm)}:
        tribofilm = replace(tribofilm, beyond_fit="extrapolate")
    mixed = max(scene.control.mixed_instants, math.ceil(_MIXED * (scene.film.points - 1)))
    dry = max(scene.control.dry_instants, _DRY)
    return replace(scene, tribofilm=tribofilm, control=replace(scene.control, mixed_instants=mixed, dry_instants=dry))


def fit_knots(knots: tuple[Knot, ...]) -> list[Knot]:
    """Return the knots that a map is fitted to."""
    return [knot for knot in knots if knot.counts and knot.number % _HELD != _HELD - 1]


def held_knots(knots: tuple[Knot, ...]) -> list[Knot]:
    """Return the knots that judge it."""
    return [knot for knot in knots if knot.counts and knot.number % _HELD == _HELD - 1]


def mapped(order: Order, knots: tuple[Knot, ...]) -> Map:
    """Return the map of knots. Raises ContactError for too few."""
    chosen = fit_knots(knots)
    if len(chosen) < FEWEST:
        raise ContactError(
            f"{len(chosen)} of {len(knots)} knots can be fitted, too few for a map: it takes {FEWEST}. Give more "
            "--time, or ranges in which the deterministic level converges. What is solved is kept: the same command "
            "continues."
        )
    samples = samples_of(scene_of_knots(order.scene), chosen)
    return fitted(samples, order.scene.name, digest_of(order.scene), order.ranges.rows, Rule())


def medians(order: Order, chart: Map, knots: tuple[Knot, ...]) -> tuple[float, ...]:
    """Return the median half widths of a map alone over its knots."""
    samples = samples_of(scene_of_knots(order.scene), fit_knots(knots))
    return tuple(map(float, np.median(widths_at(chart, samples.places), axis=0)))


def judged(order: Order, chart: Map, knots: tuple[Knot, ...]) -> Judged | None:
    """Return what held-back knots say of a map."""
    held = held_knots(knots)
    if not held:
        return None
    scene = scene_of_knots(order.scene)
    samples = samples_of(scene, held)
    blocks, trust = np.array([knot.errors for knot in held]), np.empty((len(held), 1))
    off, regression = np.empty_like(samples.off), np.empty_like(samples.off)
    for row, knot in enumerate(held):
        case, contact = contact_of(scene, knot)
        place = here(chart, case, contact)
        friction, film, ratio = told(chart, place, contact.load_ratio)
        off[row] = samples.off[row] - (math.log(friction), math.log(film), ratio - contact.load_ratio)
        stated = half_widths(case, contact)
        regression[row], trust[row] = [stated[error] for error in CORRECTED.values()], place.trust
    of_map = trust * widths_at(chart, samples.places) + (1.0 - trust) * regression
    return Judged(samples, samples.off, off, of_map, blocks, int(np.sum(trust < 1.0)))


def _head(order: Order) -> dict[str, object]:
    return {"map of": digest_of(order.scene), "ranges": [list(row) for row in order.ranges.rows], "seed": SEED}


def read(order: Order, file: Path) -> dict[int, Knot]:
    """Return the knots of a file by number; without one it is begun.

    A last line that a kill has cut is left out. Raises ContactError if the knots are of another scene or other ranges.
    """
    head = json.dumps(_head(order))
    if not file.exists():
        file.write_text(head + "\n", encoding="utf-8")
        return {}
    first, *lines = file.read_text("utf-8").split("\n")
    if first != head:
        raise ContactError(
            f"The knots in '{file}' are of another scene, or of other ranges. Use another --out, or delete the file."
        )
    whole = lines[:-1]  # behind the last end of line there is nothing, or what a kill has left
    if lines[-1:] != [""]:
        file.write_text("\n".join([first, *whole]) + "\n", encoding="utf-8")
    knots = [Knot.from_dict(json.loads(line)) for line in whole]
    return {knot.number: knot for knot in knots}
