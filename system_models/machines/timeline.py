"""The duty of a machine: its signals against time, each held from one change to the next; docs/how-to/machines.md.

Constant, in steps (signals that a step does not name stay), in cycles of running and standing still, or from a table,
whose last row holds where the simulation is longer. `repeat` does all of it again.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from contact_core.errors import SceneError, did_you_mean
from contact_core.quantities import Quantity, value_out_of_range
from contact_core.scene import units
from contact_core.scene.toml import flat

from ..run import duty_table
from ..run.duty_table import Row

_KEYS = ("duration", "steps", "start_stop", "file", "repeat")
_START_STOP = ("signals", "run", "standstill")
_MOST_CHANGES = 1_000_000


@dataclass(frozen=True)
class Timeline:
    """Signals against time up to `end` [s].

    rows: time [s] and the signals that take a value from then on, in SI by name; the first is at 0 and has all.
    """

    end: float
    rows: tuple[Row, ...]

    def course(self, name: str) -> list[tuple[float, float]]:
        """Return times [s] and values of a signal, from 0 on, where it changes."""
        given = [(time, values[name]) for time, values in self.rows if name in values]
        return given[:1] + [later for before, later in pairwise(given) if later[1] != before[1]]

    def schedule(self, inputs: Mapping[str, str] | None = None) -> dict[str, list[tuple[float, float]]]:
        """Return the schedule for `master.System`; `inputs` maps signals to "part.variable" where the names differ."""
        names = inputs or {}
        return {names.get(name, name): self.course(name) for name in self.rows[0][1]}

    def filled(self) -> list[Row]:
        """Return the rows with all signals in each, for signals that make others."""
        now: dict[str, float] = {}
        return [(time, now := now | values) for time, values in self.rows]


def with_file(table: Mapping[str, Any], path: str | Path) -> dict[str, Any]:
    """Return the table [duty] with a file in place of its steps or cycles."""
    return {key: value for key, value in table.items() if key not in _KEYS} | {"file": str(path)}


def read(
    table: Mapping[str, Any],
    signals: Mapping[str, Quantity],
    folder: Path,
    needed: Iterable[str] = (),
    stop: float | None = None,
) -> Timeline:
    """Return the duty that the table [duty] describes; a relative path of a file starts from `folder`.

    The simulation lasts until `stop` [s], without it to the end of the duty, where a row of a table has no effect.
    Raises SceneError with a sentence if a signal is unknown, out of range, or one of those `needed` is missing.
    """
    start = _values({key: value for key, value in table.items() if key not in _KEYS}, signals, "duty")
    kinds = [key for key in ("steps", "start_stop", "file") if key in table]
    if len(kinds) > 1:
        raise SceneError(f"[duty] has {' and '.join(kinds)}. Keep one of them.")
    duration = _seconds(table["duration"], "duty.duration") if "duration" in table else None
    if "file" in table:
        rows, end = _of_file(folder / str(table["file"]), start, signals, duration, stop)
    elif "start_stop" in table:
        rows, end = _of_start_stop(table["start_stop"], start, duration)
    else:
        rows, end = _of_steps(table.get("steps", []), start, signals, duration)
    for name in needed:
        if name not in rows[0][1]:
            raise SceneError(f"'duty.{name}' is missing. {_example(name, signals)}")
    return _repeated(rows, end, table.get("repeat", 1), stop)


def _of_steps(
    steps: Any, start: dict[str, float], signals: Mapping[str, Quantity], duration: float | None
) -> tuple[list[Row], float]:
    if duration is None:
        raise SceneError("'duty.duration' is missing. Write for example duration = \"2 h\".")
    if not isinstance(steps, list) or not all(isinstance(step, Mapping) for step in steps):
        raise SceneError("duty.steps must be a list of tables. Write [[duty.steps]] above each.")
    rows: list[Row] = [(0.0, start)]
    for i, step in enumerate(steps):
        where = f"duty.steps[{i}]"
        if "time" not in step:
            raise SceneError(f"'{where}.time' is missing. Write for example time = \"10 min\".")
        time = _seconds(step["time"], f"{where}.time")
        if not rows[-1][0] < time < duration:
            raise SceneError(
                f"{where}.time = {time:g} s must come after the {rows[-1][0]:g} s before it, and before the end of the "
                f"duty at {duration:g} s."
            )
        values = _values({key: value for key, value in step.items() if key != "time"}, signals, where)
        for name in values.keys() - start.keys():
            raise SceneError(f"{where} changes '{name}', which has no value at the start. {_example(name, signals)}")
        rows.append((time, values))
    return rows, duration


def _of_start_stop(table: Any, start: dict[str, float], duration: float | None) -> tuple[list[Row], float]:
    where = "duty.start_stop"
    if not isinstance(table, Mapping) or table.keys() != set(_START_STOP):
        raise SceneError(
            f"{where} must be a table with {', '.join(_START_STOP)}: "
            '{ signals = ["speed"], run = "60 s", standstill = "30 s" }.'
        )
    if duration is not None:
        raise SceneError(
            "[duty] has start_stop and duration. Leave the duration out: `repeat` is the number of cycles."
        )
    run, standstill = (_seconds(table[key], f"{where}.{key}") for key in ("run", "standstill"))
    names = table["signals"] if isinstance(table["signals"], list) else [table["signals"]]
    for name in names:
        if name not in start:
            raise SceneError(
                f"{where}.signals names '{name}', which has no value in [duty].{did_you_mean(str(name), list(start))} "
                "Give the value that it has while running."
            )
    return [(0.0, start), (run, dict.fromkeys(names, 0.0))], run + standstill


def _of_file(
    path: Path,
    start: dict[str, float],
    signals: Mapping[str, Quantity],
    duration: float | None,
    stop: float | None,
) -> tuple[list[Row], float]:
    rows = duty_table.read(path, signals)
    last = rows[-1][0]
    end = (last or stop or 0.0) if duration is None else duration
    if end == 0.0:
        raise SceneError(f"The duty file '{path}' has one row only. Add one at the end of the duty, or duty.duration.")
    if end < last:
        raise SceneError(
            f"duty.duration = {end:g} s, but the duty file '{path}' lasts to {last:g} s. Make it longer, or leave it "
            "out."
        )
    return [(0.0, start | rows[0][1]), *rows[1:]], end


def _repeated(rows: Sequence[Row], end: float, repeat: Any, stop: float | None) -> Timeline:
    count = units.parse(repeat, "", "duty.repeat")
    most = _MOST_CHANGES // len(rows)
    if count != int(count) or not 1 <= count <= most:
        raise SceneError(f"duty.repeat = {repeat!r} must be a whole number from 1 to {most}.")
    again = [(k * end + time, values) for k in range(int(count)) for time, values in rows if time < end]
    whole = end * int(count)
    if stop is not None and stop > whole:
        again += [(whole, values) for time, values in rows if time == end]
    return Timeline(whole, tuple(again))


def _values(table: Mapping[str, Any], signals: Mapping[str, Quantity], where: str) -> dict[str, float]:
    """Return SI values of signals from a table, whose names with dots TOML may have nested."""
    found = {}
    for name, value in flat(table).items():
        if name not in signals:
            known = [*signals, *(_KEYS if where == "duty" else ("time",))]
            raise SceneError(f"[{where}] has no '{name}'.{did_you_mean(name, known)} Known are {', '.join(known)}.")
        found[name] = units.parse(value, signals[name].unit, f"{where}.{name}")
        for sentence in value_out_of_range(signals[name], found[name]):
            raise SceneError(f"In [{where}]: {sentence}")
    return found


def _seconds(value: Any, name: str) -> float:
    time = units.parse(value, "s", name)
    if time <= 0.0:
        raise SceneError(f"{name} = {value!r} must be above 0.")
    return time


def _example(name: str, signals: Mapping[str, Quantity]) -> str:
    unit = signals[name].display or signals[name].unit
    return f'Write in [duty] for example {name} = "10 {unit}".' if unit else f"Write in [duty] {name} = 0.5."
