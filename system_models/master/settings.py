"""How a system is simulated: what may be asked for, and what its FMUs must be able to do for it."""

import math
from dataclasses import dataclass
from itertools import pairwise
from numbers import Real

from contact_core.scene.toml import did_you_mean

from .errors import CouplingError
from .iteration import METHODS
from .system import System

_MIN_STEP = 1e-6  # of the step
_ITERATION_TOLERANCE = 1e-6
_SAME = 1e-9  # of a step


@dataclass(frozen=True)
class Settings:
    """The arguments of `simulate` that say how. Raises CouplingError for a value that makes no sense."""

    stop_time: float
    step_size: float
    algorithm: str = "jacobi"
    order: int = 0
    iterate: str | None = None
    tolerance: float | None = None
    iteration_tolerance: float | None = None
    min_step: float | None = None
    horizon: float | None = None
    max_step: float | None = None
    controlled: tuple[str, ...] = ()
    points: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        _choose("algorithm", self.algorithm, ["jacobi", "gauss_seidel"])
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
            raise CouplingError(f"controlled = {list(self.controlled)} are to meet a tolerance. Give one as well.")
        if self.max_step is not None and self.tolerance is None:
            raise CouplingError(f"max_step = {self.max_step:g} s limits steps chosen by a tolerance. Give one as well.")

        if self.points and self.tolerance is not None:
            raise CouplingError(f"tolerance = {self.tolerance:g} chooses the steps, and so do points. Leave one out.")
        if any(not one < other for one, other in pairwise((0.0, *self.points))):
            raise CouplingError("points, times in s, must be above 0 and rise.")

    @property
    def smallest_step(self) -> float:
        """The step [s] below which none is made, and how near an event is found."""
        return _MIN_STEP * self.step_size if self.min_step is None else self.min_step

    @property
    def past(self) -> list[float]:
        """The times [s] before the start at which a history is asked for, the earliest first."""
        return [-n * self.step_size for n in range(self.order, 0, -1)]

    @property
    def converged(self) -> float:
        """The relative tolerance of the iteration, unless the error control has one of its own."""
        return _ITERATION_TOLERANCE if self.iteration_tolerance is None else self.iteration_tolerance

    def check(self, system: System) -> None:
        """Raise CouplingError if an FMU of the system cannot do what these settings need."""
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
        for time in [*times, self.stop_time] if fixed else []:
            if abs(time / self.step_size - round(time / self.step_size)) > _SAME:
                raise CouplingError(
                    f"The FMU '{fixed[0]}' takes steps of one size only (canHandleVariableCommunicationStepSize is "
                    f"false), but {time:g} s is no multiple of step_size = {self.step_size:g} s. Make it one."
                )


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
