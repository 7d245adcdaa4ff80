"""Contacts of a finished run, solved again deterministically, to test the errors of the regression level.

A contact goes through the recorded inputs once more; at chosen rows its state goes to the deterministic level.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from contact_core import ContactError, ContactState, OperatingPoint, Outputs, RangeFlag, advance, initial_state
from contact_core.corrections.kriging import pair_of, place
from contact_core.corrections.places import Place
from contact_core.kernels.arrays import Array, Mask
from contact_core.quantities import LEVELS
from contact_core.scene import Case, Scene, tunables, with_values

from ..master.saving import pack, unpack
from ..store.checkpoint import Checkpoint
from .assembly import Assembly, Contact

FAST, DEEP = LEVELS[:2]
_IDLE = 0.1  # of the mean load and speed
_ENOUGH = 5  # states needed to judge a machine
_TRIES = 3  # contacts at a time
_UNSURE = RangeFlag.NOT_CONVERGED | RangeFlag.FALLBACK | RangeFlag.DOMAIN_EDGE
COMPARED = {"friction_coefficient": "error_friction", "h_c": "error_film"}  # and the error output of each


@dataclass(frozen=True)
class Resolved:
    """One state at both levels; values and errors by output, errors are relative half widths."""

    contact: str
    row: int  # of the run
    time: float  # [s]
    fast: Outputs
    deep: Outputs | None  # None: there is no solution
    replayed: float  # relative deviation of the regression level from the run's row
    reason: str = ""
    pair: str = ""  # of surfaces
    place: Place | None = None

    def deviation(self, name: str) -> float:
        """Return the deviation of the regression level, relative to its own value."""
        value, solved = getattr(self.fast, name), getattr(self.deep, name) if self.deep else math.nan
        return abs(value - solved) / abs(value) if value else math.inf

    def allowed(self, name: str) -> float:
        """Return the relative half width of the error that the regression level states."""
        return float(getattr(self.fast, COMPARED[name]))

    @property
    def solved(self) -> bool:
        """True if the deterministic level has an answer that can judge: one that has converged."""
        return self.deep is not None and not RangeFlag(self.deep.range_flags) & _UNSURE

    @property
    def valid(self) -> bool:
        """True if all errors cover the deviations, as far as there is a solution."""
        return self.solved and not self.shortfalls

    @property
    def shortfalls(self) -> list[str]:
        """Return a sentence for each output whose stated error does not cover the deviation of the solution."""
        return [
            f"{name} of {self.contact} at {self.time:.4g} s deviates by {self.deviation(name):.1%} from its solution, "
            f"and {COMPARED[name]} states {self.allowed(name):.1%}."
            for name in COMPARED
            if not self.deviation(name) <= self.allowed(name)
        ]

    @property
    def verdict(self) -> str:
        """Verdict in one word, and the reason if there is none."""
        if self.deep is None:
            return f"no solution: {self.reason}"
        return ("yes" if self.valid else "NO") if self.solved else "not decided: not converged"


def resolve(
    assembly: Assembly,
    dataset: xr.Dataset,
    progress: Callable[[str], None],
    count: int = 6,
    store: Checkpoint | None = None,
) -> list[Resolved]:
    """Solve states again, spread over the contacts and over the time of the run.

    It ends with `count` states that can be judged, or after twice as many tries. `progress` is called with each. Those
    that `store` has are not solved once more; others are added to it.
    """
    known = {(state.contact, state.row): state for state in map(_unpacked, store.kept if store else ())}
    found: list[Resolved] = []
    usable = {name: _usable(dataset, name, assembly.contacts[name]) for name in _spread(assembly, dataset, count)}
    for rows in _windows(dataset["time"].values, count):
        tried = Counter(state.contact for state in found)
        for contact, row in _candidates(rows, usable, tried):
            if len(found) == 2 * count:
                return found
            found.append(known.get((contact, row)) or _solved_and_stored(assembly, dataset, contact, row, store))
            judged = sum(state.solved for state in found)
            progress(f"{contact} at {found[-1].time:.4g} s, {judged} of {count} judged")
            if found[-1].solved:
                break
    return found


def _solved_and_stored(
    assembly: Assembly, dataset: xr.Dataset, contact: str, row: int, store: Checkpoint | None
) -> Resolved:
    """Return a state as a continued run will read it."""
    state = solved_again(assembly, dataset, contact, row)
    packed = pack({}, {**asdict(state), "place": state.place and tuple(state.place)})
    if store:
        store.kept.append(packed)
        store.save(state.time, b"", np.array([(state.time,)], [("time", "f8")]))
    return _unpacked(packed)


def _unpacked(packed: bytes) -> Resolved:
    """Return a state that `_solved_and_stored` has packed."""
    _, table = unpack(packed)
    deep, place = table["deep"], table["place"]
    outputs = {"fast": Outputs(**table["fast"]), "deep": deep and Outputs(**deep)}
    return Resolved(**{**table, **outputs, "place": place and Place(*place)})


def _windows(times: Array, count: int) -> Iterator[Sequence[int]]:
    """Yield rows from which one state is to be taken, best first.

    First all rows; then those of `count` - 1 equal parts of the time, each from its end.
    """
    yield range(1, len(times))
    edges = np.searchsorted(times, np.linspace(0.0, times[-1], count), "right")
    for begin, end in pairwise(edges.tolist()):
        yield range(end - 1, begin - 1, -1)


def _candidates(rows: Sequence[int], usable: Mapping[str, Mask], tried: Mapping[str, int]) -> list[tuple[str, int]]:
    """Return a contact and a row to try, and more for the case that it has no solution.

    Those are of other contacts, the least tried ones first, and if there are none, other rows.
    """
    working = {name: [row for row in rows if at_work[row]] for name, at_work in usable.items()}
    turn = sorted((name for name, its in working.items() if its), key=lambda name: tried.get(name, 0))
    found = []
    for k in range(_TRIES if turn else 0):
        again, place = divmod(k, len(turn))
        its = working[turn[place]]
        found.append((turn[place], its[again * len(its) // _TRIES]))
    return found


def solved_again(assembly: Assembly, dataset: xr.Dataset, contact: str, row: int) -> Resolved:
    """Return the state of a contact at a row of its run, at both levels."""
    replay = _replayed(assembly, dataset, contact, row)
    time, deep, reason = float(dataset["time"].values[row]), None, ""
    try:
        _, deep = advance(replay.scene.at_level(DEEP), replay.point, replay.state, 0.0)
    except ContactError as error:
        reason = str(error)
    pair, where = pair_of(replay.scene), place_at(Case.bind(replay.scene, replay.point), replay.fast)
    return Resolved(contact, row, time, replay.fast, deep, replay.off, reason, pair, where)


def place_at(case: Case, fast: Outputs) -> Place:
    """Return the place of a contact for the correction of the regression level."""
    return place(vars(fast), case.op.load, case.speeds, case.pressed)


def _spread(assembly: Assembly, dataset: xr.Dataset, count: int) -> list[str]:
    """Return the contacts at the regression level: first `count` that are far apart, then their neighbours."""
    level = 1 + LEVELS.index(FAST)
    names = [name for name in sorted(assembly.contacts) if (dataset[f"{name}.fidelity_used"].values == level).all()]
    stride = max(1, len(names) // count)
    return [name for shift in range(stride) for name in names[(shift + stride // 2) % stride :: stride]]


def _usable(dataset: xr.Dataset, name: str, contact: Contact) -> Mask:
    """Return the rows in which a contact works.

    It is above a tenth of its mean load and speed, now and before, and stands for some contact of the machine.
    """
    start = started(contact)[1]  # has what is neither connected nor scheduled
    load, first, second = (
        dataset.get(f"{name}.{key}", xr.full_like(dataset["time"], getattr(start, key))).values
        for key in ("load", "speed_1", "speed_2")
    )
    speed = np.abs(first + second)
    steps = np.diff(dataset["time"].values, prepend=0.0)
    means = [float(values @ steps) / float(steps.sum()) for values in (load, speed)]
    working = (load > _IDLE * means[0]) & (speed > _IDLE * means[1]) & dataset[f"{name}.valid"].values.astype(bool)
    if contact.count:
        working &= dataset[contact.count].values > _IDLE
    return np.asarray(working & np.roll(working, 1))


class _Replay(NamedTuple):
    """A contact led once more to a row of its run."""

    scene: Scene
    point: OperatingPoint
    state: ContactState
    fast: Outputs
    off: float  # largest relative difference from the recorded run


def _replayed(assembly: Assembly, dataset: xr.Dataset, name: str, last: int) -> _Replay:
    """Return the contact at a row, by the regression level.

    Its inputs in each step were those recorded at its end, at its beginning, or their mean, by its place in the
    sequence and the hold order. The choice that reproduces the record is the right one.
    """
    return min((_led(assembly, dataset, name, last, share) for share in (0.0, 1.0, 0.5)), key=lambda replay: replay.off)


def started(contact: Contact) -> tuple[Scene, OperatingPoint]:
    """Return the scene of a contact with its parameters at the regression level, and its inputs at the start."""
    numbers = {key: value for key, value in contact.parameters.items() if key in tunables(contact.scene)}
    scene = with_values(contact.scene, numbers).at_level(FAST)  # type: ignore[arg-type]
    names = {*OperatingPoint.__dataclass_fields__}
    inputs: dict[str, Any] = {key: value for key, value in contact.parameters.items() if key in names}
    return scene, replace(scene.operation.point, **inputs)


def _led(assembly: Assembly, dataset: xr.Dataset, name: str, last: int, begin: float) -> _Replay:
    scene, start = started(assembly.contacts[name])
    recorded = {key: dataset[f"{name}.{key}"].values for key in assembly.inputs_of(name)}
    columns = {key: begin * np.roll(values, 1) + (1.0 - begin) * values for key, values in recorded.items()}
    times = dataset["time"].values
    state = initial_state(scene)
    for row in range(1, last + 1):
        point = replace(start, **{key: float(values[row]) for key, values in columns.items()})
        state, fast = advance(scene, point, state, float(times[row] - times[row - 1]))
    off = max(_difference(getattr(fast, key), float(dataset[f"{name}.{key}"].values[last])) for key in COMPARED)
    return _Replay(scene, point, state, fast, off)


def _difference(one: float, other: float) -> float:
    return abs(one - other) / max(abs(one), abs(other)) if one != other else 0.0


def marked(dataset: xr.Dataset, states: Sequence[Resolved]) -> xr.Dataset:
    """Return the run with `valid` false where a contact's errors do not cover its deviation, or nothing can judge."""
    found = dataset.copy(deep=True)
    for state in states:
        if not state.valid:
            valid = found[f"{state.contact}.valid"]
            valid.values[state.row] = False
            valid.attrs["comment"] = "also false where errors do not cover a state solved again, or no solution judges"
    return found


def to_dataset(states: Sequence[Resolved]) -> xr.Dataset:
    """Return the comparison along `state`."""
    columns: dict[str, Any] = {
        "resolved.contact": ("state", [s.contact for s in states], {"units": "1", "long_name": "contact"}),
        "resolved.time": ("state", [s.time for s in states], {"units": "s", "long_name": "time of the state"}),
        "resolved.solved": (
            "state",
            [s.solved for s in states],
            {"units": "1", "long_name": "true if the deterministic solution has converged"},
        ),
        "resolved.valid": (
            "state",
            [s.valid for s in states],
            {"units": "1", "long_name": "true if the errors of the regression level cover its deviations"},
        ),
    }
    for name, error in COMPARED.items():
        for suffix, values, text in (
            (FAST, [getattr(s.fast, name) for s in states], "by the regression level"),
            (DEEP, [getattr(s.deep, name) if s.deep else np.nan for s in states], "solved deterministically"),
            ("deviation", [s.deviation(name) for s in states], "relative to the regression level's"),
            (error, [s.allowed(name) for s in states], "relative half width that the regression level states"),
        ):
            unit = "m" if name == "h_c" and suffix in LEVELS else "1"
            columns[f"resolved.{name}.{suffix}"] = ("state", np.array(values), {"units": unit, "long_name": text})
    number = ("state", np.arange(1, len(states) + 1), {"units": "1", "long_name": "number of the state"})
    return xr.Dataset(columns, coords={"state": number})


def lines(states: Sequence[Resolved]) -> Iterator[str]:
    """Yield a table, and the accuracy of the replay."""
    if not states:
        yield "No contact was at the regression level, so there is none to solve again."
        return
    heads = f"{'regr.':>9} {'solved':>9} {'dev.':>7} {'stated':>7}"
    yield f"{'state':>24}  mu: {heads}  h_c: {heads}  valid"
    for s in states:
        where = f"{s.contact} at {s.time:.4g} s"
        if s.deep is None:
            yield f"{where:>24}  {s.verdict}"
            continue
        mu, film = "friction_coefficient", "h_c"
        yield (
            f"{where:>24}      {s.fast.friction_coefficient:9.4f} {s.deep.friction_coefficient:9.4f} "
            f"{s.deviation(mu):7.1%} {s.allowed(mu):7.1%}       {1e9 * s.fast.h_c:6.1f} nm {1e9 * s.deep.h_c:6.1f} nm "
            f"{s.deviation(film):7.1%} {s.allowed(film):7.1%}  {s.verdict}"
        )
    judged = sum(s.solved for s in states)
    if judged < _ENOUGH:
        yield f"WARNING: only {judged} states could be JUDGED; elsewhere the regression level's deviation is unknown."
    worst = max(s.replayed for s in states)
    yield f"The states were computed once more from the recorded inputs; they agree with the run to {worst:.1g}."
