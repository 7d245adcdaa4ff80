"""The contract of a kind of machine."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import xarray as xr

from contact_core.quantities import Quantity

from ..charts.chart import Sheet
from ..parts.part import Part
from .assembly import Assembly, Contact, Schedule
from .timeline import Timeline


@dataclass(frozen=True)
class Design:
    """The parts and contacts of a machine, their connections, and the schedule that its duty makes."""

    parts: Mapping[str, Part]
    contacts: Mapping[str, Contact]
    connections: tuple[tuple[Any, ...], ...]
    schedule: Schedule
    reported: Mapping[str, Any] = field(default_factory=dict)  # records of tables that only the report reads, by table


@dataclass(frozen=True)
class Kind:
    """A kind of machine. `registry.kinds` lists them."""

    name: str  # value of `kind` in a machine's file
    tables: tuple[str, ...]  # of the file, beside contact, duty and simulate
    signals: Mapping[str, Quantity]  # of the duty, by name
    needed: tuple[str, ...]  # signals that the duty must give
    design: Callable[[Mapping[str, Any], Timeline], Design]  # from the tables and the duty; raises SceneError
    foreseen: Callable[[Mapping[str, Part], Mapping[str, float]], dict[str, dict[str, float]]]  # inputs of the contacts
    # by contact and input, under signals of the duty as they would be once all has settled
    legend: Mapping[str, str]  # headings of the printed tables, and what they mean
    lines: Callable[[Assembly, xr.Dataset], list[str]]  # the printed report of a run
    pictures: Callable[[Assembly, xr.Dataset], Mapping[str, Sheet]]  # of a run by name; "overview" first
    turning: Callable[[Mapping[str, Part], Mapping[str, float]], dict[str, float]] = lambda parts, signals: {}
    # inputs "part.variable" that the moving parts give then to the part between contacts and heat
    main: tuple[str, ...] = ()  # outputs "part.variable" that matter most; without, nothing is said of what is assumed
