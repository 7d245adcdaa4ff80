"""The options of a simulation, and what they require of its FMUs."""

import math
from collections.abc import Collection
from dataclasses import MISSING, dataclass, field
from itertools import pairwise
from numbers import Real
from typing import Any

from contact_core.errors import did_you_mean

from ..fmu.errors import CouplingError
from ..numerics.algorithms import ALGORITHMS
from ..numerics.iteration import METHODS
from .system import System

_MIN_STEP = 1e-6  # of the step
_ITERATION_TOLERANCE = 1e-6
_SAME = 1e-9  # of a step
_MOST_STEPS = 1e9  # days of computing, and results of many GB


def _setting(read: str, default: Any = MISSING, choices: Collection[Any] = ()) -> Any:
    """Declare a setting; `read`: its form in TOML, one of those of `reading`."""
    return field(default=default, metadata={"read": read, "choices": tuple(choices)})


@dataclass(frozen=True)
class Settings:
    """The options of a simulation: their one statement, for `simulate` and for TOML.

    Raises CouplingError for a value that makes no sense.

    stop_time, step_size [s]
        End of the simulation, and the communication step; with a tolerance the first step, also after a change of a
        schedule or an event.
    algorithm
        Which outputs of the running step the FMUs see: `numerics.algorithms`. The sequence of the FMUs follows from
        the connections.
    order
        Of the polynomials that extrapolate inputs over a step, through derivatives where the FMU takes them; another
        FMU holds their mean. Signals that are discrete at one end hold their values.
    iterate
        Repeat each step until the inputs at its end are those that follow from the outputs: `numerics.iteration`. A
        step that does not converge stands, and is counted in `unconverged`.
    iteration_tolerance
        Of these inputs, relative to their magnitude; by default 1e-6, or what `tolerance` needs.
    tolerance
        Of the coupled outputs, relative to their magnitude: the larger of `nominal` and the largest value so far. The
        estimated errors of all steps add up to it at most over the `horizon`. A system that amplifies errors, or whose
        phase drifts, ends with larger errors. A step of `min_step` that is still too inaccurate stands, and is counted
        in `below_min_step`.
    min_step [s]
        The smallest step, 1e-6 step_size by default. Events are located to it, unless two events of one output lie
        between two rows.
    horizon [s]
        The time over which errors add up: the whole simulation, unless errors are known to decay sooner.
    max_step [s]
        The longest step, however accurate: where FMUs evolve slowly inside, rows stay close enough to show it.
    controlled
        The coupled outputs that must keep the tolerance, by default all. Where some follow others at once, as a
        friction force its speed, name those with inertia or heat capacity.
    points [s]
        Communication points in place of the multiples of step_size.
    """

    stop_time: float = _setting("seconds")
    step_size: float = _setting("seconds")
    algorithm: str = _setting("choice", "jacobi", ALGORITHMS)
    order: int = _setting("choice", 0, (0, 1, 2))
    iterate: str | None = _setting("choice", None, METHODS)
    tolerance: float | None = _setting("number", None)
    iteration_tolerance: float | None = _setting("number", None)
    min_step: float | None = _setting("seconds", None)
    horizon: float | None = _setting("seconds", None)
    max_step: float | None = _setting("seconds", None)
    controlled: tuple[str, ...] = _setting("names", ())
    points: tuple[float, ...] = _setting("times", ())

    def __post_init__(self) -> None:
        for name in ("controlled", "points"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        _choose("algorithm", self.algorithm, list(ALGORITHMS))
        if self.iterate is not None:
            _choose("iterate", self.iterate, list(METHODS))
        if self.order not in (0, 1, 2) or isinstance(self.order, bool):
            raise CouplingError(f"order = {self.order!r} is no hold order. Give 0, 1 or 2.")
        for name in ("stop_time", "step_size"):
            _positive(name, getattr(self, name), math.inf, "s")
        for name in ("min_step", "horizon", "max_step"):
            if getattr(self, name) is not None:
                _positive(name, getattr(self, name), math.inf, "s")
        for name in ("tolerance", "iteration_tolerance"):
            if getattr(self, name) is not None:
                _positive(name, getattr(self, name), 1.0, "")
        if self.min_step is not None and self.min_step > self.step_size:
            raise CouplingError(f"min_step = {self.min_step:g} s is above step_size = {self.step_size:g} s. Lower it.")

        if self.max_step is not None and self.max_step < self.step_size:
            raise CouplingError(f"max_step = {self.max_step:g} s is below step_size = {self.step_size:g} s. Raise it.")
        if self.controlled and self.tolerance is None:
            raise CouplingError(f"controlled = {list(self.controlled)} must keep a tolerance. Give one as well.")
        if self.max_step is not None and self.tolerance is None:
            raise CouplingError(f"max_step = {self.max_step:g} s limits steps chosen by a tolerance. Give one as well.")
        if self.horizon is not None and self.tolerance is None:
            raise CouplingError(f"horizon = {self.horizon:g} s is that of a tolerance. Give one as well.")
        if self.iteration_tolerance is not None and self.iterate is None:
            raise CouplingError(
                f"iteration_tolerance = {self.iteration_tolerance:g} is that of iterate. Give one as well."
            )

        if self.points and self.tolerance is not None:
            raise CouplingError(f"tolerance = {self.tolerance:g} chooses the steps, and so do points. Leave one out.")
        if any(not one < other for one, other in pairwise((0.0, *self.points))):
            raise CouplingError("points, times in s, must be above 0 and rise.")
        self._check_end()

    def _check_end(self) -> None:
        """Raise CouplingError if the steps are too short for the stop time ever to be reached."""
        longest = "step_size" if self.tolerance is None else "max_step"
        rest = self.stop_time - (self.points[-1] if self.points else 0.0)
        rounding = _rounding(self.stop_time)
        for name, least, why in (
            (longest, rest / _MOST_STEPS, f"needs more than {_MOST_STEPS:g} steps to"),
            *((name, rounding, "is lost by rounding beside") for name in ("step_size", "min_step", "max_step")),
        ):
            size = getattr(self, name)
            if size is not None and size < least:
                raise CouplingError(
                    f"{name} = {size:g} s {why} stop_time = {self.stop_time:g} s. Give at least {1.01 * least:.3g} s, "
                    "or an earlier stop_time."
                )

    @property
    def smallest_step(self) -> float:
        """The step [s] below which none is made, and how near an event is found."""
        return max(_MIN_STEP * self.step_size, _rounding(self.stop_time)) if self.min_step is None else self.min_step

    def margin(self, time: float) -> float:
        """Return by how much [s] another time may differ from `time` and still be the same: no step lies between."""
        return max(min(_SAME * min(self.step_size, self.stop_time), self.smallest_step), _rounding(time))

    @property
    def past(self) -> list[float]:
        """The times [s] before the start at which a history is asked for, the earliest first."""
        return [-n * self.step_size for n in range(self.order, 0, -1)]

    @property
    def converged(self) -> float:
        """The relative tolerance of the iteration, unless the error control has one of its own."""
        return _ITERATION_TOLERANCE if self.iteration_tolerance is None else self.iteration_tolerance

    def check(self, system: System) -> None:
        """Raise CouplingError if an FMU of the system lacks a capability that these settings need."""
        reasons = {
            f"iterate = '{self.iterate}'": self.iterate is not None,
            f"tolerance = {self.tolerance}": self.tolerance is not None,
            f"the event '{system.events[0].name if system.events else ''}'": bool(system.events),
        }
        for reason, applies in reasons.items():
            for name, model in system.models.items():
                if applies and not model.restores:
                    raise CouplingError(
                        f"{reason} repeats steps, but the FMU '{name}' cannot go back: it does not save and restore "
                        "its state (canGetAndSetFMUstate is false). Export it with its state, or leave that out."
                    )
        fixed = [n for n, m in system.models.items() if not m.capabilities.canHandleVariableCommunicationStepSize]
        if fixed and (self.tolerance is not None or system.events):
            raise CouplingError(
                f"The FMU '{fixed[0]}' takes steps of one size only (canHandleVariableCommunicationStepSize is false), "
                "which neither a tolerance nor events allow. Leave them out."
            )
        times = [time for steps in system.schedule.values() for time, _ in steps if 0.0 < time < self.stop_time]
        for time in [*times, *self.points, self.stop_time] if fixed else []:
            if abs(time / self.step_size - round(time / self.step_size)) > _SAME:
                raise CouplingError(
                    f"The FMU '{fixed[0]}' takes steps of one size only (canHandleVariableCommunicationStepSize is "
                    f"false), but {time:g} s is no multiple of step_size = {self.step_size:g} s. Make it one."
                )


def _rounding(time: float) -> float:
    """Return by how much [s] a time is known, computed by a few additions."""
    return 4.0 * math.ulp(time)


def _choose(name: str, value: object, choices: list[str]) -> None:
    if value not in choices:
        raise CouplingError(
            f"{name} = {value!r} is none of {', '.join(map(repr, choices))}.{did_you_mean(str(value), choices)}"
        )


def _positive(name: str, value: object, most: float, unit: str) -> None:
    number = float(value) if isinstance(value, Real) and not isinstance(value, bool) else math.nan
    if not 0.0 < number < most:
        limit = "a finite number above 0" if most == math.inf else f"a number between 0 and {most:g}"
        raise CouplingError(f"{name} = {value!r} is not {limit}{f', in {unit}' if unit else ''}.")
