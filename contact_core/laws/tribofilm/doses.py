"""Mean exposure per test time from the instants of a pass: the `dose` of a tribofilm law.

A new dose is one class and one entry in `DOSES`.
"""

from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Protocol

import numpy as np

from ...arrays import Array
from ..equations import Equations


class Passes(NamedTuple):
    """Passes of a body's points through the contact during a block, on its patch."""

    since: Array  # passes since a point had the exposure `peak`
    peak: Array  # largest exposure in the last pass
    moves: bool  # the body moves through the contact
    reach: float  # share of its time that a point spends on the grid
    domain: float  # length of the grid [m]
    contact_length: float | None  # 2a [m]; None without a load


class MeanPasses(NamedTuple):
    """Passes of a body's track through Hertz's contact, as means."""

    moves: bool
    exposed: float  # share of the track that is exposed in a pass
    touching: float  # share of the contact in which solids touch
    chord: float  # mean length of a crossing over 2a
    residence: float  # share of its time that a point of the track is in the contact


class Dose(Protocol):
    """The rule for the mean exposure per test time."""

    name: ClassVar[str]
    whole_pass: ClassVar[bool]  # the exposure of a whole pass counts: it is late by half a pass
    equations: ClassVar[Equations]  # for documentation

    def on_patch(self, exposure: Array, passes: Passes) -> Array:
        """Return the exposure per test time from the mean `exposure` of the sampled instants."""

    def mean(self, touching: float, oiled: float, passes: MeanPasses) -> float:
        """Return the mean exposure per test time of a track.

        `touching` and `oiled` are the exposures of a point in solid contact and of one under oil.
        """


@dataclass(frozen=True)
class Clock:
    """The largest exposure of any instant of the last pass, for the whole time.

    A pass stands for the many real ones of a block: a smooth body keeps meeting new asperities, so all of it is
    exposed.
    """

    name: ClassVar[str] = "clock"
    whole_pass: ClassVar[bool] = True
    equations: ClassVar[Equations] = Equations(
        (), "Dose 'clock': a point rubbed at any instant of a pass counts as rubbed all the time."
    )

    def on_patch(self, exposure: Array, passes: Passes) -> Array:
        """Return the largest exposure in the last pass."""
        return np.where(passes.since < 1.0, passes.peak, 0.0) if passes.moves else exposure

    def mean(self, touching: float, oiled: float, passes: MeanPasses) -> float:
        """Return the mean over the exposed and the other points."""
        if passes.moves:
            return passes.exposed * touching + (1.0 - passes.exposed) * oiled
        return Residence().mean(touching, oiled, passes)


@dataclass(frozen=True)
class ContactLength:
    """The mean over the crossing of the contact's length 2a."""

    name: ClassVar[str] = "contact_length"
    whole_pass: ClassVar[bool] = False
    equations: ClassVar[Equations] = Equations(
        (), "Dose 'contact_length': growth by the mean over the crossing of the contact's length."
    )

    def on_patch(self, exposure: Array, passes: Passes) -> Array:
        """Return the mean over the contact's length in place of the grid's; a point at rest crosses nothing."""
        if passes.contact_length is None or not passes.moves:
            return exposure
        return exposure * passes.domain / passes.contact_length

    def mean(self, touching: float, oiled: float, passes: MeanPasses) -> float:
        """Return the mean over the contact, by the mean length of a crossing."""
        if not passes.moves:
            return Residence().mean(touching, oiled, passes)
        return (passes.touching * touching + (1.0 - passes.touching) * oiled) * passes.chord


@dataclass(frozen=True)
class Residence:
    """The mean over the whole track."""

    name: ClassVar[str] = "residence"
    whole_pass: ClassVar[bool] = False
    equations: ClassVar[Equations] = Equations((), "Dose 'residence': growth by the mean over the whole track.")

    def on_patch(self, exposure: Array, passes: Passes) -> Array:
        """Return the mean over the track in place of the grid's."""
        return exposure * passes.reach

    def mean(self, touching: float, oiled: float, passes: MeanPasses) -> float:
        """Return the mean over the contact, by the share of time spent in it."""
        return (passes.touching * touching + (1.0 - passes.touching) * oiled) * passes.residence


DOSES: dict[str, Dose] = {dose.name: dose for dose in (Clock(), ContactLength(), Residence())}
