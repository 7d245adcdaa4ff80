"""Communication steps as large as a tolerance allows."""

import logging
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from contact_core.errors import did_you_mean
from contact_core.kernels.arrays import Array, Mask

from ..fmu.errors import CouplingError, NotFiniteError
from ..numerics.control import StepControl, wrms
from ..numerics.richardson import halves
from .coupled import Coupled, Point
from .recorder import Recorder
from .stepping import Attempt, Stepper

log = logging.getLogger(__name__)

_MATTERS = 0.1  # of the error that a step may have: less says nothing about how it adds up
_LEAST_SHARE = 1e-5  # of the tolerance: a hundred thousand such steps use it up
_ROUNDING = 1e-12  # no iteration is asked for more
_EVIDENCE = 3  # repeated steps in a row
_SINGLE = 2.0**-22  # of a magnitude: differences of values of single precision are known to that
_ITERATED = 0.05  # of the allowed error of a step: the iteration's part


class ControlledStepper(Stepper):
    """Makes steps whose errors add up to the tolerance at most.

    Step doubling: every step is made whole and as two halves, whose result is kept. The error of the two halves is
    factor * (whole - halves), with the factor 1 / (2^p - 1), p = hold order + 1, for regular nodes
    (`numerics.richardson`). In a step the error of an output may grow by tolerance * its magnitude * step / horizon, so
    that over the horizon the errors add up to the tolerance at most. The error of an output that follows the inputs of
    its FMU at once does not add up, and may be the tolerance itself; which outputs do shows when a rejected step is
    repeated.
    """

    def __init__(self, coupled: Coupled, recorder: Recorder, tolerance: float) -> None:
        super().__init__(coupled, recorder)
        self.tolerance, self.horizon = tolerance, coupled.settings.horizon or coupled.settings.stop_time
        self.size = self.step_size
        # errors are of first order where some inputs hold their values, whatever the order
        self._holds = coupled.settings.order > 0 and bool(coupled.wiring.sampled.any())
        self.control = StepControl(1 if self._holds else coupled.settings.order + 1)
        self._controlled = _mask(coupled)
        self._noise = _SINGLE if any(connection.single for connection in coupled.system.connections) else 0.0
        self._noise_told = False
        # how often in a row a coupled output has seemed to lag only
        self.lags = np.zeros(len(coupled.wiring.coupled), dtype=int)
        self._may_lag = np.array([coupled.may_lag(place) for place in coupled.wiring.coupled], dtype=bool)

    def begin_anew(self) -> None:
        super().begin_anew()
        self.control.after_event()
        self.size = min(self.size, self.step_size)

    def stored(self) -> dict[str, Any]:
        own = {"size": self.size, "control": self.control.copy(), "lags": self.lags}
        return super().stored() | own

    def continue_from(self, memory: Mapping[str, Any]) -> None:
        super().continue_from(memory)
        self.size, self.lags = memory["size"], memory["lags"]
        self.control.restore(memory["control"])

    def _proposed_end(self, limit: float) -> float:
        time, remaining = self.coupled.time, limit - self.coupled.time
        if self.size >= remaining * (1.0 - 1e-9):
            return limit
        return time + (remaining / 2.0 if 2.0 * self.size > remaining else self.size)

    def _attempt_to(self, end: float, start: Point) -> Attempt:
        """Repeat the step, each time shorter, until its error is allowed."""
        before: Attempt | None = None
        while True:
            try:
                attempt = self._unstopped(end, start)
            except NotFiniteError:
                size = end - start.time
                if self._is_smallest(size):
                    raise
                before, end = None, self._rejected(size, math.inf, start)
                continue
            if before:
                attempt = self._with_new_evidence(before, attempt)
            if attempt.error <= 1.0 or self._is_smallest(attempt.size):
                self._tell_noise(attempt)
                self.statistics.below_min_step += attempt.error > 1.0
                size = max(self.min_step, attempt.size * self.control.accept(attempt.error))
                self.size = min(size, self.coupled.settings.max_step or math.inf)
                return attempt
            before, end = attempt, self._rejected(attempt.size, attempt.error, start)

    def _is_smallest(self, size: float) -> bool:
        return size <= self.min_step * (1.0 + 1e-9) + 2.0 * math.ulp(self.coupled.time)  # a difference of times

    def _rejected(self, size: float, error: float, start: Point) -> float:
        """Go back, and give the end of a shorter step."""
        self.statistics.rejected += 1
        self.coupled.restore(start)
        return start.time + max(self.min_step, size * self.control.reject(error))

    def _attempt(self, end: float, start: Point) -> Attempt:
        coupled = self.coupled
        size, middle_time = end - start.time, start.time + 0.5 * (end - start.time)
        if coupled.settings.iteration_tolerance is None:
            coupled.iteration_tolerance = max(_ROUNDING, self._noise, _ITERATED * self.tolerance * self._share(size))
        whole_nodes, first_nodes = coupled.nodes(size), coupled.nodes(0.5 * size)
        whole = coupled.advance(end, start)
        outputs, before = coupled.outputs[coupled.wiring.coupled], coupled.ends()
        if not self.statistics.steps:
            coupled.magnitudes.expect(coupled.outputs)
        coupled.restore(start)
        first = coupled.advance(middle_time, start)
        row, indicators, event = self.recorder.row(0.5 * size, first), self._indicators.values(), coupled.event()
        of_halves = halves(size, whole_nodes, first_nodes, coupled.nodes(0.5 * size))
        middle = coupled.save() if coupled.repeats else start
        try:
            second = coupled.advance(end, middle)
        finally:
            if middle is not start:
                coupled.release(middle)
        changes = np.abs(coupled.outputs[coupled.wiring.coupled] - outputs)
        first_order = self._holds or self._lagging.any()
        errors = changes * (max(of_halves.per_difference, 1.0) if first_order else of_halves.per_difference)
        errors = np.where(self._controlled, errors, 0.0)
        ratio = self._ratio(errors, size)
        if max(whole.residual, first.residual, second.residual) > 1.0:
            ratio = max(ratio, 2.0)
        rows = [row, self.recorder.row(0.5 * size, second, ratio)]
        seen, gains = [indicators, self._indicators.values()], self._gains(changes, coupled.ends() - before)
        return Attempt(size, rows, seen, ratio, errors, gains, of_halves, event)

    def _gains(self, changes: Array, of_inputs: Array) -> Array:
        """Return the changes of the coupled outputs over those of the inputs of their FMUs."""
        norms = np.array([np.linalg.norm(of_inputs[beside]) for beside in self.coupled.wiring.beside])
        return np.divide(changes, norms, out=np.zeros(len(changes)), where=norms > 0.0)

    @property
    def _lagging(self) -> Mask:
        """The outputs that belong to an earlier time than the inputs that they set: the order is one with them."""
        return np.asarray((self.lags >= _EVIDENCE) & self._may_lag)

    def _share(self, size: float) -> float:
        """Return the share of the tolerance for a step: in proportion to it, but no less than the level of noise."""
        return min(1.0, max(_LEAST_SHARE, size / self.horizon))

    def _scales(self) -> Array:
        """Return magnitudes of the outputs that set inputs."""
        return self.coupled.magnitudes.scales(self.coupled.outputs)[self.coupled.wiring.coupled]

    def _ratio(self, errors: Array, size: float) -> float:
        return wrms(errors, np.maximum(self._shares(size), self._noise) * self._scales())

    def _shares(self, size: float) -> Array:
        """Return the errors that a step may have, relative to the magnitudes."""
        return self.tolerance * np.where(self.lags < _EVIDENCE, self._share(size), 1.0)

    def _tell_noise(self, attempt: Attempt) -> None:
        """Warn, once, of an error that is not seen for the noise of single precision."""
        if (
            self._noise
            and not self._noise_told
            and wrms(attempt.errors, self._shares(attempt.size) * self._scales()) > 1
        ):
            self._noise_told = True
            log.warning(
                "FMUs exchange values of single precision (Float32): errors of steps are known to %.1e of the values, "
                "and the result may miss tolerance = %g. Take a larger one, or a hold order of 1 or 2.",
                _SINGLE,
                self.tolerance,
            )

    def _with_new_evidence(self, earlier: Attempt, attempt: Attempt) -> Attempt:
        """Look which errors add up, now that a step is repeated with another size."""
        least = max(_MATTERS * self.tolerance * self._share(attempt.size), self._noise)
        matters = (attempt.errors > least * self._scales()) & (attempt.gains > 0.0)
        settings = self.coupled.settings
        does_not = self._order_is_reduced if settings.iterate else self._follows_at_once
        self.lags = np.where(matters, np.where(does_not(earlier, attempt), self.lags + 1, 0), self.lags)
        return attempt._replace(error=self._ratio(attempt.errors, attempt.size))

    @staticmethod
    def _follows_at_once(earlier: Attempt, attempt: Attempt) -> Mask:
        """Return True if an output follows the inputs of its FMU at once, or integrated, the more the longer the step.

        The changes of the inputs over the halves are known, so kinks in them do not matter.
        """
        return np.asarray(earlier.gains < attempt.gains * math.sqrt(earlier.size / attempt.size))

    @staticmethod
    def _order_is_reduced(earlier: Attempt, attempt: Attempt) -> Mask:
        """Return True if an error falls too slowly with the step to add up: as that of a stiff force, soon gone."""
        expected = earlier.halves.error / attempt.halves.error * math.sqrt(attempt.size / earlier.size)
        return np.asarray(earlier.errors < expected * attempt.errors)


def _mask(coupled: Coupled) -> Mask:
    """Return True for the coupled outputs that must keep the tolerance. Raises CouplingError for other names."""
    names = [coupled.wiring.outputs[place] for place in coupled.wiring.coupled]
    chosen = coupled.settings.controlled
    for name in chosen:
        if name not in names:
            raise CouplingError(
                f"controlled has '{name}', which sets no input.{did_you_mean(name, names)} The outputs that set inputs "
                f"are {', '.join(names)}."
            )
    return np.array([not chosen or name in chosen for name in names])
