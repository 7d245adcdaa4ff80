"""One accepted communication step of a given size, up to an event at most."""

import bisect
import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from contact_core.arrays import Array

from ..fmu import messages
from ..fmu.errors import CouplingError
from ..numerics.richardson import Halves
from .coupled import Coupled, Point, StoppedEarly
from .events import Indicators, Values, changed
from .recorder import Recorder, Row


class Attempt(NamedTuple):
    """A step that has been tried from a point."""

    size: float
    rows: list[Row]
    indicators: list[Values]  # of events, by row
    error: float = 0.0  # over the allowed one: up to 1 it is accepted
    errors: Array = np.zeros(0)  # of the coupled outputs
    gains: Array = np.zeros(0)  # their changes over those of the inputs of their FMU
    halves: Halves = Halves(0.0, 0.0)
    event: bool = False  # an FMU has met one of its own before the last row


@dataclass
class Statistics:
    """Counts of a simulation."""

    steps: int = 0
    rejected: int = 0
    iterations: int = 0
    unconverged: int = 0
    below_min_step: int = 0  # steps at min_step whose error was larger than allowed
    events: int = 0
    stopped_early: int = 0  # steps that an FMU did not go to the end of
    ended_by: str = ""  # the FMU that asked for the end


class Ended(Exception):  # noqa: N818 - no error
    """An FMU has asked for the end of the simulation."""


class Stepper:
    """Makes steps of at most `step_size`, each to a row or two."""

    def __init__(self, coupled: Coupled, recorder: Recorder) -> None:
        self.coupled, self.recorder = coupled, recorder
        self.step_size, self.min_step = coupled.settings.step_size, coupled.settings.smallest_step
        self.statistics = Statistics()
        self.check_interrupt: Callable[[], None] = lambda: None  # raises KeyboardInterrupt after Ctrl-C
        self._indicators = Indicators(coupled)

    def step(self, limit: float) -> list[Row]:
        """Advance to the end of a step, `limit` at most, and give its rows.

        Raises Ended if an FMU asks for the end, and CouplingError if no step can be made.
        """
        coupled = self.coupled
        start = coupled.save()
        try:
            before = self._indicators.values() if start.time else self._indicators.at_start()
            attempt = self._attempt_to(self._proposed_end(limit), start)
            event = self._first_change(start.time, before, attempt)
            if event is not None:
                attempt = self._to_event(attempt, event, start)
        finally:
            coupled.release(start)
        self._accepted(attempt, event is not None)
        return attempt.rows

    @staticmethod
    def _first_change(time: float, values: Values, attempt: Attempt) -> tuple[float, Values, float] | None:
        """Return the rows around the first event: time and values of the first, time of the second."""
        for row, following in zip(attempt.rows, attempt.indicators, strict=True):
            if changed(values, following):
                return time, values, row[0]
            time, values = row[0], following
        return None

    def _to_event(self, attempt: Attempt, between: tuple[float, Values, float], start: Point) -> Attempt:
        """Go back, and to just behind the first event."""
        low, before, behind = between
        self._require_return(f"An event lies between {low:g} s and {behind:g} s")

        def to(end: float) -> Values:
            nonlocal attempt
            self.coupled.restore(start)
            attempt = self._unstopped(end, start)
            return self._indicators.values()

        if self.coupled.time != behind:
            to(behind)
        reached = self._indicators.locate(to, low, before, self.coupled.time, self.min_step)
        if self.coupled.time != reached:
            to(reached)
        return attempt

    def _attempt_to(self, end: float, start: Point) -> Attempt:
        """Return an attempt with an error that is allowed."""
        return self._unstopped(end, start)

    def _unstopped(self, end: float, start: Point) -> Attempt:
        """Return an attempt that no FMU has stopped early."""
        while True:
            try:
                return self._attempt(end, start)
            except StoppedEarly as stop:
                self.check_interrupt()  # it may have reached the FMU, which then takes no step
                end = self._shorter(stop, end, start)

    def _shorter(self, stop: StoppedEarly, end: float, start: Point) -> float:
        """Go back, and give the end of a step that the FMU which has stopped may make."""
        size, reached = end - start.time, stop.time - start.time
        goes_on = reached >= self.min_step and self.coupled.restores
        if self.coupled.instances[stop.name].terminated and not goes_on:
            self.statistics.ended_by = stop.name
            raise Ended
        self._require_return(f"The FMU '{stop.name}' stopped at {stop.time:g} s in a step to {end:g} s")
        self.coupled.restore(start)
        self.statistics.stopped_early += 1
        shorter = reached if reached >= self.min_step else size / 2.0
        if shorter < self.min_step:
            raise CouplingError(
                f"The FMU '{stop.name}' refuses to step on from {start.time:g} s, also by {size:g} s. "
                f"{messages.cause(stop.name)} A smaller min_step lets it try smaller steps."
            )
        return start.time + shorter

    def _require_return(self, why: str) -> None:
        if not self.coupled.restores:
            fixed = [name for name, model in self.coupled.system.models.items() if not model.restores]
            raise CouplingError(
                f"{why}, but the system cannot go back: {', '.join(fixed)} cannot save and restore the state "
                "(canGetAndSetFMUstate). Export with it, or take steps that end there."
            )

    def _proposed_end(self, limit: float) -> float:
        """Return the next of the given points or else multiple of the step, or the limit."""
        time, points = self.coupled.time, self.coupled.settings.points
        margin = self.coupled.settings.margin(limit)
        following = bisect.bisect_right(points, time + margin)
        if following < len(points):
            end = points[following]
        else:
            end = self.step_size * (math.floor((time + margin) / self.step_size) + 1)
        return limit if end > limit - margin else end

    def _attempt(self, end: float, start: Point) -> Attempt:
        size = end - start.time
        row = self.recorder.row(size, self.coupled.advance(end, start))
        return Attempt(size, [row], [self._indicators.values()])

    def _accepted(self, attempt: Attempt, event: bool) -> None:
        coupled, statistics = self.coupled, self.statistics
        coupled.magnitudes.accept(coupled.outputs)
        statistics.steps += len(attempt.rows)
        for _, _, (_, iterations, residual, *_) in attempt.rows:
            statistics.iterations += int(iterations)
            statistics.unconverged += residual > 1.0
        if event or attempt.event or coupled.event():
            statistics.events += 1
            self.begin_anew()
        ended = [name for name, instance in coupled.instances.items() if instance.terminated]
        if ended:
            statistics.ended_by = ended[0]

    def begin_anew(self) -> None:
        """Forget the past: after an event it says nothing about the future."""
        self.coupled.restart()

    def stored(self) -> dict[str, Any]:
        """Return all that is needed to continue from now in another process."""
        return {"statistics": asdict(self.statistics)}

    def continue_from(self, memory: Mapping[str, Any]) -> None:
        """Go to a point that `stored` has returned."""
        self.statistics = Statistics(**memory["statistics"])
