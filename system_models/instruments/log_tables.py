"""A duty for `tribofmu run` and data for `tribofmu fit` from a log of a test rig. Body 1 is the ball, body 2 the disc.

Steps follow one another without a pause. An input that a step holds, but for scatter, has its mean there.
"""

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from contact_core.errors import ContactError
from contact_core.quantities import CELSIUS, TABLE

from .log_columns import OF_RIGS
from .log_file import Log, Step

INPUTS = {"load": "N", "speed_1": "m/s", "speed_2": "m/s", "temperature": "degC"}  # in the order of columns
_HELD = {"load": 0.03, "rolling_speed": 0.03, "srr": 0.05, "speed_1": 0.03, "speed_2": 0.03}  # relative scatter
_HELD_SRR, _HELD_K = 0.01, 1.5  # absolute: of the slide-to-roll ratio, and of temperature [K]
_ROLLING = 1e-3  # assumed: slide-to-roll ratio that a rig does not tell from pure rolling
_DIGITS = 3  # of inputs that a step changes
_OF_SPEEDS = (*OF_RIGS, *INPUTS)
_PIN = "pod"  # beginning of the kind of a step with a pin that stands still
_DISPLAY = {"h_c": ("nm", 1e9), "friction_coefficient": ("1", 1.0)}


@dataclass(frozen=True)
class Row:
    """One row of a log: time since its beginning [s], inputs of the contact and what was measured, in SI."""

    time: float
    inputs: dict[str, float]
    measured: dict[str, float]


def rows_of(log: Log, chosen: Sequence[int], faster: int | None, srr: float | None) -> list[Row]:
    """Return the rows of the steps of some numbers, from 1, of all without any.

    `faster` is the body that a positive slide-to-roll ratio makes the faster one, without it that of `faster_of`; `srr`
    is the ratio of a log that does not say it. Raises ContactError for a step that is not there, or speeds that are not
    told.
    """
    bad = [number for number in chosen if not 1 <= number <= len(log.steps)]
    if bad:
        raise ContactError(f"--step {bad[0]}: '{log.name}' has steps 1 to {len(log.steps)}.")
    steps = [log.steps[number - 1] for number in chosen] if chosen else log.steps
    rows: list[Row] = []
    begin = 0.0
    for step in steps:
        times = _times(step)
        speeds = _speeds(log, step, faster or faster_of(step) or 1, srr)
        held = _held(step, speeds)
        for k, row in enumerate(step.rows):
            inputs = {name: held[name][k] for name in INPUTS if name in held}
            measured = {name: x for name, x in row.items() if name not in _OF_SPEEDS and math.isfinite(x)}
            if math.isfinite(times[k]) and all(map(_can_be, inputs, inputs.values())):
                rows.append(Row(begin + times[k], inputs, measured))
        known = [time for time in times if math.isfinite(time)]
        if known:
            last = known[-1] - known[-2] if len(known) > 1 else 1.0
            begin += known[-1] + last if step.has("time") else 0.0
    return rows


def _can_be(name: str, value: float) -> bool:
    """Return whether an input is a number that the contact takes."""
    return TABLE[name].minimum <= value <= TABLE[name].maximum


def duty(rows: Sequence[Row]) -> list[list[str]]:
    """Return header and rows of a duty, one for each change of an input; none where `no_duty` says why."""
    if no_duty(rows):
        return []
    names = _names(rows)
    return [["time [s]", *(f"{name} [{INPUTS[name]}]" for name in names)], *_changes(rows, names)]


def no_duty(rows: Sequence[Row]) -> str:
    """Return why the rows are no duty, in a sentence without its end; an empty text if they are one."""
    names = _names(rows)
    if not names:
        return "no load, speed or temperature is taken"
    found = _changes(rows, names)
    for row in found:
        if "" in row:
            return f"some steps have no {names[row.index('') - 1]}. Choose others by --step"
    if len(found) > 1 and not any(row.time for row in rows):
        return "inputs change, but there is no column of time to say when"
    for early, late in pairwise(row.time for row in rows):
        if late < early:
            return f"the time falls back from {early:g} s to {late:g} s, as in another test. Make a log of each"
    for before, after in pairwise(row[0] for row in found):
        if before == after:
            return f"inputs change at {after} s, and again at that time"
    return ""


def _changes(rows: Sequence[Row], names: Sequence[str]) -> list[list[str]]:
    """Return time and inputs of each row in which one of these has changed."""
    found: list[list[str]] = []
    for row in rows:
        cells = [_cell(name, row.inputs.get(name)) for name in names]
        if not found or cells != found[-1][1:]:
            found.append([f"{row.time - rows[0].time:.10g}", *cells])
    return found


def data(rows: Sequence[Row]) -> list[list[str]]:
    """Return header and rows of the data; none if nothing was measured."""
    names = _names(rows)
    outputs = list(dict.fromkeys(name for row in rows for name in row.measured))
    measured = [row for row in rows if row.measured]
    if not measured:
        return []
    heads = [f"{name} [{_DISPLAY[name][0] if name in _DISPLAY else _si(name)}]" for name in outputs]
    body = [
        [
            f"{row.time:.10g}",
            *(_cell(name, row.inputs.get(name)) for name in names),
            *(
                f"{row.measured[name] * _DISPLAY.get(name, ('', 1.0))[1]:.6g}" if name in row.measured else ""
                for name in outputs
            ),
        ]
        for row in measured
    ]
    return [["time [s]", *(f"{name} [{INPUTS[name]}]" for name in names), *heads], *body]


def write(table: list[list[str]], file: Path) -> Path:
    """Write header and rows as CSV and return the path."""
    with file.open("w", encoding="utf-8", newline="") as out:
        csv.writer(out).writerows(table)
    return file


def _times(step: Step) -> list[float]:
    """Return the times [s] of a step since it began; zeros if it says none."""
    if not step.has("time"):
        return [0.0] * len(step.rows)
    return [row["time"] for row in step.rows]


def faster_of(step: Step) -> int:
    """Return the body that a positive slide-to-roll ratio makes faster, by ball and disc speeds; 0: unknown."""
    name = "srr" if step.has("srr") else "sliding_speed"
    if not (step.has("ball_speed") and step.has("disc_speed") and step.has(name)):
        return 0
    table = np.array([[row["ball_speed"] - row["disc_speed"], row[name]] for row in step.rows])
    told = float(np.nansum(table[:, 0] * table[:, 1]))
    return 0 if told == 0.0 else 1 if told > 0.0 else 2


def _speeds(log: Log, step: Step, faster: int, srr: float | None) -> dict[str, list[float]]:
    """Return rolling speed and slide-to-roll ratio (speed_1 - speed_2 over their mean), or both speeds, of each row."""
    if step.has("speed_1") and step.has("speed_2"):
        return {name: [row[name] for row in step.rows] for name in ("speed_1", "speed_2")}
    if not step.has("rolling_speed"):
        return _of_sliding(log, step, faster, srr) if step.has("sliding_speed") else {}
    sign = 1.0 if faster == 1 else -1.0
    rolling = [row["rolling_speed"] for row in step.rows]
    if step.has("srr"):
        ratio = [sign * row["srr"] for row in step.rows]
    elif step.has("sliding_speed"):
        ratio = [sign * row["sliding_speed"] / u if u else math.nan for row, u in zip(step.rows, rolling, strict=True)]
    elif srr is not None:
        ratio = [sign * srr] * len(rolling)
    else:
        raise ContactError(
            f"'{log.name}' has a rolling speed but neither slide-to-roll ratio nor sliding speed. Give --srr, such as "
            "--srr '0 %' of pure rolling."
        )
    return {"rolling_speed": rolling, "srr": ratio}


def of_pin(step: Step) -> bool:
    """Return whether the step says that body 1 is a pin that stands still."""
    return step.kind.lower().startswith(_PIN)


def _of_sliding(log: Log, step: Step, faster: int, srr: float | None) -> dict[str, list[float]]:
    """Return speeds of rows that have the sliding speed alone: of a pin that stands still, or by the ratio `srr`."""
    sliding = [abs(row["sliding_speed"]) for row in step.rows]
    if of_pin(step):
        return {"speed_1": [0.0] * len(sliding), "speed_2": sliding}
    if not srr:
        raise ContactError(
            f"'{log.name}' has a sliding speed, but neither a rolling speed nor a slide-to-roll ratio. Give --srr: "
            "'200 %' if one body stands still, and by --faster the one that moves."
        )
    sign = 1.0 if faster == 1 else -1.0
    return {"rolling_speed": [x / abs(srr) for x in sliding], "srr": [sign * abs(srr)] * len(sliding)}


def _held(step: Step, speeds: dict[str, list[float]]) -> dict[str, list[float]]:
    """Return the inputs of the contact in each row: their mean over the step where it holds them."""
    own = {name: [row[name] for row in step.rows] for name in ("load", "temperature") if step.has(name)}
    found = {name: _steady(name, np.array(values)) for name, values in (own | speeds).items()}
    if "srr" in found:
        rolling, ratio = found.pop("rolling_speed"), found.pop("srr")
        found["speed_1"], found["speed_2"] = rolling * (1.0 + 0.5 * ratio), rolling * (1.0 - 0.5 * ratio)
    return {name: values.tolist() for name, values in found.items()}


def _steady(name: str, values: np.ndarray) -> np.ndarray:
    good = values[np.isfinite(values)]
    if not good.size:
        return values
    mean, sd = float(good.mean()), float(good.std())
    allowed = _HELD_K if name == "temperature" else _HELD[name] * abs(mean)
    if sd <= max(allowed, _HELD_SRR if name == "srr" else 0.0):
        return np.where(np.isfinite(values), _rounded(name, mean), np.nan)
    return np.array([_rounded(name, x) if math.isfinite(x) else math.nan for x in values])


def _rounded(name: str, x: float) -> float:
    if name == "temperature":
        return round(x - CELSIUS, 1) + CELSIUS
    if name == "srr" and abs(x) < _ROLLING:
        return 0.0
    return float(f"{x:.{_DIGITS}g}")


def _names(rows: Sequence[Row]) -> list[str]:
    return [name for name in INPUTS if any(name in row.inputs for row in rows)]


def _cell(name: str, value: float | None) -> str:
    if value is None:
        return ""
    return f"{value - CELSIUS if name == 'temperature' else value:.6g}"


def _si(name: str) -> str:
    return TABLE[name].unit or "1"
