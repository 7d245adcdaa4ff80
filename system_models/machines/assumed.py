"""What the assumptions of a machine are worth: half widths of its results by the intervals of what it assumes.

Each end goes, with those of the contacts' scene, through one state of the duty at the regression level: that which
lasts long under much load and speed, with temperatures settled in it and new surfaces.
"""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr

from contact_core import advance, initial_state
from contact_core.assumed import OUTPUTS, TRIBOFILM, WEAR, Answers, Assumption, half_widths, text
from contact_core.errors import ContactError
from contact_core.film import Regression
from contact_core.quantities import CELSIUS
from contact_core.scene import OperatingPoint, Scene
from contact_core.scene.intervals import Interval

from ..parts.part import start_values
from ..parts.thermal import ThermalNetwork
from ..run.cosim_report import aligned
from ..run.trust import wrapped
from ..store.results import ASSUMED, half_width
from .assembly import Assembly
from .kind import Kind
from .report import loss_error
from .timeline import Timeline

Values = dict[str, float]  # by "part.variable", SI
_MOST_ROWS = 100  # of a duty that are looked at
_SETTLED = 1e9  # s, after which a network of heat has settled
_NEAR, _MOST_TURNS = 0.05, 100  # K between temperatures and what follows from them; turns to get there
_SHARE = 0.5  # of the way there in a turn: hotter oil makes less heat, all the way would overshoot
_MUCH, _MOST = 0.3, 3  # share of a half width from which on its cause is named, and how many are
_LEAST = 1e-3  # smallest half widths that are printed: relative, in K, or of shares
_NO_WEAR = 1e-18  # m/s: a rate below 0.03 nm in a year is none, by whatever factor it is not known
_NONE = "-"
_OUTPUTS = tuple(output for output in OUTPUTS if output != TRIBOFILM)  # of contacts, on new surfaces
ATTRIBUTE = "machine_assumed_json"  # of a machine's result
_TEMPERATURE, _SHARE_OF_SOLIDS = ".temperature_", "contact_load_ratio"


@dataclass(frozen=True)
class Worth:
    """What the assumptions of a machine are worth in one state of its duty."""

    time: float  # from which on the duty has it [s]
    intervals: tuple[Interval, ...]
    values: Answers  # results in this state
    halves: Mapping[str, Assumption]  # by result, of wear relative
    shown: tuple[str, ...]  # results that matter most


def worth(kind: Kind, assembly: Assembly, duty: Timeline) -> Worth | None:
    """Return what is assumed is worth in the state of the duty with most work.

    None if that has no answer, or the kind does not say what its main results are.
    """
    if not kind.main:
        return None
    state = _State(kind, assembly, *_hardest(kind, assembly, duty))
    try:
        values, warm = state.settled({})
    except ContactError:
        return None
    ends = {
        each.key: [[state.with_values(end).results(warm) for end in both] for both in assembly.ends(each)]
        for each in assembly.intervals
    }
    here = state.results_of(values)
    return Worth(state.time, assembly.intervals, here, half_widths(here, ends), state.shown(values))


def _hardest(kind: Kind, assembly: Assembly, duty: Timeline) -> tuple[float, dict[str, float]]:
    """Return time [s] and signals of the state of the run with the largest load times speed times duration."""
    stop = assembly.settings["stop_time"]
    rows = [row for row in duty.filled() if row[0] < stop]
    found: dict[tuple[tuple[str, float], ...], list[float]] = {}  # by signals: where they begin, and how long they last
    for (time, signals), end in zip(rows, [*(time for time, _ in rows[1:]), min(duty.end, stop)], strict=True):
        found.setdefault(tuple(signals.items()), [time]).append(end - time)
    some = list(found.items())[:: math.ceil(len(found) / _MOST_ROWS)]
    points = {name: contact.own_scene.operation.point for name, contact in assembly.contacts.items()}

    def work(row: tuple[tuple[tuple[str, float], ...], list[float]]) -> float:
        inputs = kind.foreseen(assembly.parts, dict(row[0]))
        here = [replace(point, **inputs[name]) for name, point in points.items()]
        return sum(row[1][1:]) * sum(op.load * abs(op.entrainment_speed) for op in here)

    hardest, (start, *_) = max(some, key=work)
    return start, dict(hardest)


@dataclass(frozen=True)
class _State:
    """A machine in one state of its duty, its contacts at the regression level."""

    kind: Kind
    assembly: Assembly
    time: float
    signals: Mapping[str, float]

    def with_values(self, values: Values) -> "_State":
        """Return the state of the machine with other values [SI] by dotted key."""
        return replace(self, assembly=self.assembly.with_values(values))

    def results(self, warm: Values) -> Answers | None:
        """Return the results once temperatures have settled, `warm` to begin with; None if there are none."""
        try:
            return self.results_of(self.settled(warm)[0])
        except ContactError:
            return None

    def settled(self, warm: Values) -> tuple[Values, Values]:
        """Return outputs of parts and contacts, and temperatures of networks of heat; `warm` to begin with.

        Raises ContactError if they do not settle, or a contact has no answer.
        """
        warm = warm or self._temperatures({}, 0.0)
        for _ in range(_MOST_TURNS):
            values = self._outputs(warm)
            follow = self._temperatures(values, _SETTLED)
            if all(abs(follow[key] - warm[key]) < _NEAR for key in follow):
                return values, warm
            warm = {key: _SHARE * follow[key] + (1.0 - _SHARE) * warm[key] for key in follow}
        raise ContactError(f"The temperatures of '{self.assembly.name}' do not settle at {self.time:g} s.")

    @cached_property
    def _contacts(self) -> dict[str, tuple[Scene, OperatingPoint]]:
        """Scenes and points of the contacts, with temperatures of the scenes."""
        inputs, found = self.kind.foreseen(self.assembly.parts, self.signals), {}
        for name, contact in self.assembly.contacts.items():
            scene = contact.own_scene.at_level(Regression.name)
            found[name] = scene, replace(scene.operation.point, **inputs[name])
        return found

    @cached_property
    def _links(self) -> dict[str, list[tuple[str, str, float]]]:
        """Input, the output connected to it, and their ratio, by part or contact."""
        found: dict[str, list[tuple[str, str, float]]] = {}
        for source, target, *factor in self.assembly.connections:
            owner, _, key = target.partition(".")
            found.setdefault(owner, []).append((key, source, *(factor or [1.0])))
        return found

    def _connected(self, name: str, values: Values) -> Values:
        """Return the inputs of a part or contact that known values give."""
        links = self._links.get(name, [])
        return {key: values[source] * factor for key, source, factor in links if source in values}

    def _outputs(self, warm: Values) -> Values:
        """Return outputs of contacts under temperatures, and of the part between them and the heat."""
        values = dict(warm)
        for name, (scene, point) in self._contacts.items():
            op = replace(point, **{key: x for key, x in self._connected(name, warm).items() if hasattr(point, key)})
            outputs = vars(advance(scene, op, initial_state(scene), 0.0)[1])
            values |= {f"{name}.{key}": value for key, value in outputs.items() if isinstance(value, float)}
            values[f"{name}.{WEAR}"] = outputs["wear_rate_1"] + outputs["wear_rate_2"]
        for name in {target.partition(".")[0] for target in self._turning}:
            values |= self._of_part(name, values, 0.0)
        return values

    def _temperatures(self, values: Values, step: float) -> Values:
        """Return temperatures of networks of heat under values, after a step [s] from their start."""
        networks = [name for name, part in self.assembly.parts.items() if isinstance(part, ThermalNetwork)]
        found = {key: value for name in networks for key, value in self._of_part(name, values, step).items()}
        return {key: value for key, value in found.items() if _TEMPERATURE in key}

    @cached_property
    def _turning(self) -> Values:
        return self.kind.turning(self.assembly.parts, self.signals)

    def _of_part(self, name: str, values: Values, step: float) -> Values:
        """Return the outputs of a part after a step [s] from its start."""
        part, inputs = self.assembly.parts[name], {}
        for key, start in start_values(part).items():
            course = self.assembly.schedule.get(f"{name}.{key}", ((0.0, start),))
            held = [value for begin, value in course if begin <= self.time][-1]
            inputs[key] = self._turning.get(f"{name}.{key}", float(held))
        inputs |= self._connected(name, values)
        state = part.initial(inputs)
        state = part.advance(state, inputs, step) if step else state
        return {f"{name}.{key}": value for key, value in part.outputs(state, inputs).items()}

    def results_of(self, values: Values) -> Answers:
        """Return the results among outputs: those of the kind, temperatures, and those of each contact."""
        of_contacts = [f"{name}.{output}" for name in self.assembly.contacts for output in _OUTPUTS]
        warm = [key for key in values if _TEMPERATURE in key and key.partition(".")[0] in self.assembly.parts]
        return {key: values[key] for key in (*self.kind.main, *warm, *of_contacts)}

    def shown(self, values: Values) -> tuple[str, ...]:
        """Return results that matter most: of the kind, hottest temperature, most loaded contact, most wear."""
        contacts = self.assembly.contacts
        loaded = max(contacts, key=lambda name: self._contacts[name][1].load)
        warm = self._temperatures({}, 0.0)
        worn = max((f"{name}.{WEAR}" for name in contacts), key=lambda key: values[key])
        hottest = [max(warm, key=lambda key: values[key])] if warm else []
        film, solids = (f"{loaded}.{output}" for output in _OUTPUTS[1:3])
        return (*self.kind.main, *hottest, film, solids, worn)


def with_half_widths(dataset: xr.Dataset, found: Worth | None) -> xr.Dataset:
    """Return a machine's result with half widths by what it assumes as coordinates, in their outputs' units.

    That of `bearing.power_loss` is `bearing.power_loss_assumed`. Those of temperatures and shares are held at what they
    are in the state that `worth` looks at; the others have the same share of the output at all times as there.
    """
    halves = {}
    for name, each in found.halves.items() if found else ():
        prefix, _, output = name.rpartition(".")
        for key in (name, *(f"{prefix}.{WEAR}_{body}" for body in (1, 2) if output == WEAR)):
            if found and key in dataset.data_vars:
                variable = dataset.variables[key]
                half = _over_time(name, each.together, found.values[name], np.abs(variable.values))
                told = {"units": variable.attrs.get("units", "1"), "long_name": f"half width of {key} by assumptions"}
                halves[f"{key}{ASSUMED}"] = (variable.dims, half, told)
    return dataset.assign_coords(halves)


def _over_time(name: str, half: float, here: float, values: np.ndarray) -> np.ndarray:
    if name.endswith(f".{WEAR}"):
        return half * values
    if _absolute(name) or here == 0.0:
        return np.full_like(values, half)
    return half / abs(here) * values


def _absolute(name: str) -> bool:
    return _TEMPERATURE in name or name.endswith(_SHARE_OF_SOLIDS)


def lines(assembly: Assembly, dataset: xr.Dataset, found: Worth | None) -> list[str]:
    """Return a table of the main results with their errors at the end and what is assumed is worth beside them."""
    if not found or not found.intervals:
        return []
    rows, causes = [["result", "there", "error", "assumed"]], ["mostly by"]
    for name in found.shown:
        each = found.halves[name]
        most = [key for key, half in each.parts.items() if half > _MUCH * each.together][:_MOST]
        there = _value(name, found.values[name], dataset), _error(assembly, dataset, name), _text(found, name)
        rows.append([name, *there])
        causes.append(", ".join(most) if there[-1] != _NONE else "")
    told = [f"{row}  {cause}".rstrip() for row, cause in zip(aligned(rows, 1), causes, strict=True)]
    return [*wrapped(where(found)), "", *told]


def where(found: Worth) -> str:
    """Return a sentence on the state in which assumptions are looked at."""
    return (
        f"What is assumed is worth, beside the errors, in the duty's state from {found.time:g} s on, with all "
        "temperatures settled, on new surfaces, by the regression level:"
    )


def _value(name: str, value: float, dataset: xr.Dataset) -> str:
    """Return a result in its unit as text; wear as a rate, by time."""
    if _TEMPERATURE in name:
        return f"{value - CELSIUS:.1f} degC"
    if name.endswith(f".{WEAR}"):
        return f"{3.6e12 * value:.3g} nm/h" if value > _NO_WEAR else _NONE
    if _absolute(name):
        return f"{value:.4f}"
    unit = dataset[name].attrs["units"]
    return f"{1e9 * value:.3g} nm" if unit == "m" else f"{value:.3g} {unit}".removesuffix(" 1")


def _error(assembly: Assembly, dataset: xr.Dataset, name: str) -> str:
    """Return the error that a result has at the end of a run as text; of losses that of their energy."""
    prefix, _, output = name.rpartition(".")
    if _TEMPERATURE in name:
        return _NONE
    if prefix not in assembly.contacts:
        return f"{100.0 * loss_error(assembly, dataset):.2g} %"
    key = f"{name}_1" if output == WEAR else name
    half = half_width(dataset, key)
    if half is None:
        return _NONE
    value = 1.0 if _absolute(name) else float(np.abs(dataset[key].values[-1]))
    if not _LEAST * value <= half[-1] < math.inf or value == 0.0:
        return _NONE
    return f"{half[-1]:.2g}" if _absolute(name) else text(WEAR, half[-1] / value)


def attribute(found: Worth | None) -> dict[str, str]:
    """Return the table of all intervals as an attribute of a machine's result."""
    return {ATTRIBUTE: json.dumps({"where": where(found), "rows": table(found)})} if found and found.intervals else {}


def table(found: Worth) -> list[tuple[str, ...]]:
    """Return head and rows: each interval and its worth in the results that matter, the largest first; [] of none."""
    first = found.halves[found.shown[0]].parts
    rows = [
        (each.key, f"{each.least} to {each.most}", *(_text(found, name, each.key) for name in found.shown))
        for each in sorted(found.intervals, key=lambda each: -first.get(each.key, 0.0))
    ]
    whole = ("together", "", *(_text(found, name) for name in found.shown))
    return [("assumed", "between", *found.shown), *rows, whole] if rows else []


def _text(found: Worth, name: str, key: str = "") -> str:
    """Return a half width by all that is assumed, or by that of a key, as text."""
    each, here = found.halves[name], found.values[name]
    half = each.parts.get(key, 0.0) if key else each.together
    if name.endswith(f".{WEAR}"):
        return text(WEAR, half if here > _NO_WEAR else 0.0)
    least = _LEAST if _absolute(name) else _LEAST * abs(here)
    if half <= least:
        return _NONE
    if _TEMPERATURE in name:
        return f"{half:.2g} K"
    return f"{half:.2g}" if _absolute(name) else text(WEAR, half / abs(here))
