"""What to trust of a machine's run: lines before it on its contacts, and after it on columns, flags and errors."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from contact_core.arrays import Array
from contact_core.scene import Case, OperatingPoint
from contact_core.state import RangeFlag

from ..charts.units import CELSIUS
from ..parts.part import start_values
from ..run import flags, grown, verdict
from ..run.trust import described, regime, span, wrapped
from .assembly import Assembly
from .kind import Kind
from .reading import Machine, duty_of
from .registry import kinds
from .timeline import Timeline

_MOST_ROWS = 100  # of a duty that are looked at
_ALIKE = 0.99  # rows with at least this part of the largest load count as rows of the largest load
_POINT = {*OperatingPoint.__dataclass_fields__}


def before(machine: Machine, assembly: Assembly) -> list[str]:
    """Return a paragraph for each class of contacts on the one that its duty loads most: pressure, motion, film."""
    return wrapped(*_most_loaded(kinds()[machine.kind], assembly, duty_of(machine)))


def _most_loaded(kind: Kind, assembly: Assembly, duty: Timeline) -> Iterator[str]:
    """Yield a text for each class of contacts."""
    rows = [(kind.foreseen(assembly.parts, signals), signals) for signals in _some(duty)]
    for title, names in classes(assembly.contacts).items():
        loads = {name: np.array([contacts[name]["load"] for contacts, _ in rows]) for name in names}
        name = max(names, key=lambda each: float(loads[each].max()))
        load = float(loads[name].max())
        who = f"{title}, {len(names)} contacts" if len(names) > 1 else title
        if load <= 0.0:
            yield f"{who}: no load."
            continue
        heavy = [row for row, each in zip(rows, loads[name], strict=True) if each >= _ALIKE * load]
        cases = [_case(assembly, name, contacts[name], signals) for contacts, signals in heavy]
        most = f"most loaded {name}" if len(names) > 1 else "at most"
        oil = span(case.op.temperature - CELSIUS for case in cases)
        told = " ".join(described(cases))
        beside = _beside([_case(assembly, each, heavy[0][0][each], heavy[0][1]) for each in names if loads[each].max()])
        yield f"{who}, {most} with {load:.4g} N, oil at {oil} degC. {told}{beside}"


def _beside(cases: Sequence[Case]) -> str:
    """Return a sentence on the lambda ratio of all contacts of a class at one time, if they are several and rough."""
    loaded = [(case, math.hypot(*(side.surface.rms for side in case.sides))) for case in cases if case.op.load > 0.0]
    ratios = [case.conventional_film / sigma for case, sigma in loaded if sigma > 0.0]
    if len(ratios) < 2:
        return ""
    return f" Over all of them lambda of handbooks is {span(ratios)}: {regime(min(ratios), max(ratios))}."


def classes(names: Sequence[str] | Mapping[str, object]) -> dict[str, list[str]]:
    """Return contacts by class: those whose names differ by their numbers."""
    found: dict[str, list[str]] = {}
    for name in names:
        found.setdefault(re.sub(r"_\d+$", "", name), []).append(name)
    return found


def _some(duty: Timeline) -> list[dict[str, float]]:
    """Return the signals of some different rows of a duty, evenly spread, with those of least and most of each."""
    different = [dict(row) for row in dict.fromkeys(tuple(row.items()) for _, row in duty.filled())]
    step = max(1, math.ceil(len(different) / _MOST_ROWS))
    ends = [f(different, key=lambda row: abs(row[key])) for key in different[0] for f in (min, max)]
    return [*different[::step], *ends]


def _case(assembly: Assembly, name: str, inputs: Mapping[str, float], signals: Mapping[str, float]) -> Case:
    """Return a contact under inputs; oil at the duty's temperature, or else at that of the start."""
    scene = assembly.contacts[name].own_scene
    given = {"temperature": signals.get("temperature", _temperature(assembly, name)), **inputs}
    return Case.bind(scene, replace(scene.operation.point, **given))


def _temperature(assembly: Assembly, name: str) -> float:
    """Return the temperature [K] of a contact's oil at the start: that of the part which gives it."""
    for source, target, *_ in assembly.connections:
        if target == f"{name}.temperature":
            part, _, output = source.partition(".")
            values = start_values(assembly.parts[part])
            return assembly.parts[part].outputs(assembly.parts[part].initial(values), values)[output]
    return assembly.contacts[name].own_scene.operation.point.temperature


def after(kind: Kind, assembly: Assembly, dataset: xr.Dataset) -> list[str]:
    """Return lines on a run: what `told` says."""
    return wrapped(*told(kind, assembly, dataset))


def told(kind: Kind, assembly: Assembly, dataset: xr.Dataset) -> list[str]:
    """Return what the columns of the tables are, the flags raised with their quantities, and a verdict."""
    columns = "; ".join(f"{heading}: {meaning}" for heading, meaning in kind.legend.items())
    contacts = {name: of_contact(assembly, dataset, name) for name in assembly.contacts}
    told = *sentences(assembly, contacts), *_grown(assembly, contacts), *_verdict(assembly, contacts)
    return [f"Columns: {columns}.", *told]


def _grown(assembly: Assembly, contacts: Mapping[str, xr.Dataset]) -> Iterator[str]:
    """Yield a sentence on tribofilms that oil has grown, of the contact in which they are thickest."""
    films = {name: grown.by_oil(assembly.contacts[name].own_scene, rows) for name, rows in contacts.items()}
    oiled = [name for name, text in films.items() if text]
    if oiled:
        thickest = max(oiled, key=lambda name: max(float(contacts[name][f"tribofilm_{i}"][-1]) for i in (1, 2)))
        others = f" ({len(oiled)} of {len(contacts)} contacts have such films.)" if len(contacts) > 1 else ""
        yield f"{thickest}: {films[thickest]}{others}"


def sentences(assembly: Assembly, contacts: Mapping[str, xr.Dataset]) -> Iterator[str]:
    """Yield a sentence for each flag that some contact raises, with the contacts, the quantity and by how much."""
    for flag in RangeFlag:
        up = {name: rows for name, rows in ((name, _up(contacts[name], flag)) for name in contacts) if rows.any()}
        if not up:
            continue
        worst, number = beyond(assembly, {name: contacts[name] for name in up}, flag)
        where = f"{worst}: " if len(contacts) > 1 else ""
        count, total = max(int(rows.sum()) for rows in up.values()), len(up[worst])
        when = "all rows" if all(rows.all() for rows in up.values()) else f"{count} of {total} rows"
        most = "up to " if len(up) > 1 and count < total else ""
        named = _named(list(up), list(contacts))
        yield f"Range, {named}{most}{when}: {flag.text}" + (f" ({where}{number})." if number else ".")


def beyond(assembly: Assembly, contacts: Mapping[str, xr.Dataset], flag: RangeFlag) -> tuple[str, str]:
    """Return the most loaded contact of those that raise a flag, and which of its quantities is beyond which limit."""
    worst = max(contacts, key=lambda name: _load(contacts[name], _up(contacts[name], flag)))
    rows = contacts[worst].isel(time=_up(contacts[worst], flag))
    return worst, flags.by_how_much(flag, assembly.contacts[worst].own_scene, rows)


def _up(rows: xr.Dataset, flag: RangeFlag) -> NDArray[np.bool_]:
    """Return the rows of a contact in which a flag is up."""
    return np.asarray((rows["range_flags"].values.astype(int) & flag) > 0)


def _load(rows: xr.Dataset, marked: NDArray[np.bool_]) -> float:
    """Return the largest load [N] in motion in marked rows; below zero without any."""
    moving = marked & (rows["speed_1"].values + rows["speed_2"].values != 0.0)
    return float(rows["load"].values[moving].max(initial=-1.0))


def _named(who: Sequence[str], every: Sequence[str]) -> str:
    """Return which of the contacts, with a comma behind; nothing if there is one only."""
    if len(every) == 1:
        return ""
    if len(who) == len(every):
        return "all contacts, "
    return f"{', '.join(who)}, " if len(who) <= 3 else f"{len(who)} of {len(every)} contacts, "


def of_contact(assembly: Assembly, dataset: xr.Dataset, name: str) -> xr.Dataset:
    """Return what a machine's run has of a contact, by the names that the run of a contact has.

    Inputs that the run does not record, as the schedule or nothing sets them, and temperatures of bodies are added.
    """
    before = f"{name}."
    own = {key: str(key).removeprefix(before) for key in dataset.variables if str(key).startswith(before)}
    found = dataset[list(own)].rename(own)
    point = assembly.contacts[name].own_scene.operation.point
    for f in fields(point):
        course = assembly.schedule.get(f"{name}.{f.name}")
        value = getattr(point, f.name)
        if f.name in found or (course is None and value is None):
            continue
        held = _held(course, dataset["time"].values) if course else float(value)
        found[f.name] = ("time", np.broadcast_to(held, dataset.sizes["time"]))
    for body in (1, 2):
        if f"temperature_{body}" not in found:
            found[f"temperature_{body}"] = found.get(f"body_temperature_{body}", found["temperature"])
    return found


def _held(course: Sequence[tuple[float, Any]], times: Array) -> Array:
    """Return the values that a scheduled input has in the steps that end at some times [s]."""
    starts, values = (np.array(column, dtype=float) for column in zip(*course, strict=True))
    return values[np.maximum(np.searchsorted(starts, times, "left") - 1, 0)]


def _verdict(assembly: Assembly, contacts: Mapping[str, xr.Dataset]) -> Iterator[str]:
    """Yield what is known least at the last row under load of each contact, and what would make it surer."""
    total = next(iter(contacts.values())).sizes["time"]
    invalid = sum(int((~rows["valid"].values.astype(bool)).sum()) for rows in contacts.values())
    if invalid:
        yield f"Verdict: contacts have {invalid} INVALID rows; their outputs stand there as they were before."
        return
    known: dict[str, list[tuple[str, verdict.Known]]] = {}
    for name, rows in contacts.items():
        loaded = np.flatnonzero(rows["load"].values > 0.0)
        if len(loaded):
            for each in verdict.known(rows.isel(time=int(loaded[-1])), {}):
                known.setdefault(each.word, []).append((name, each))
    if not known:
        yield f"Verdict: all {total} rows were computed; no errors are stated."
        return
    parts = [_least(found, len(contacts)) for found in known.values()]
    surer = verdict.way_out(contact.own_scene for contact in assembly.contacts.values())
    surer = surer.replace("film.correction=blocks or film.model=deterministic", "contact.film.correction=blocks")
    words = "known at the end" if len(contacts) == 1 else "known at the end, where it is known least"
    yield f"Verdict: {words}: {', '.join(parts)}. {surer}".rstrip()


def _least(found: Sequence[tuple[str, verdict.Known]], contacts: int) -> str:
    """Return how well an output is known in the contact that knows it least."""
    nothing = [name for name, each in found if each.nothing]
    name, worst = max(found, key=lambda pair: (pair[1].nothing, pair[1].half))
    if contacts == 1:
        return worst.text
    return f"{worst.text} ({f'{len(nothing)} of {contacts} contacts' if nothing else name})"
