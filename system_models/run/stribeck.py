"""Stribeck curves of a contact that is being rubbed.

At given rubbing times its surfaces, as they are then, run through a range of entrainment speeds at one slide-to-roll
ratio. Time stands still in a sweep: each speed starts from the rubbed contact itself.
"""

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from itertools import chain, pairwise

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from contact_core import ContactState, OperatingPoint, Outputs, Scene, advance, initial_state
from contact_core.errors import ContactError, ConvergenceError
from contact_core.kernels.arrays import Array
from contact_core.progress import tell
from contact_core.quantities import TABLE

from ..store.results import with_half_widths
from .contact import communication_points
from .duty import Duty
from .origin import with_scene
from .workers import Workers, WorkersLostError, done_by, workers

log = logging.getLogger(__name__)

_DIMENSIONS = ("rubbing_time", "entrainment_speed")
_SWEPT = (  # at every speed
    "friction_coefficient",
    "lambda_ratio",
    "contact_load_ratio",
    "contact_area_ratio",
    "h_c",
    "pressure_max",
    "error_friction",
    "error_film",
    "error_load_ratio",
    "unconverged",
)
_RUBBED = tuple(  # at every rubbing time
    f"{name}_{body}" for name in ("tribofilm", "tribofilm_roughness", "roughness", "wear_depth") for body in (1, 2)
)


@dataclass(frozen=True)
class Plan:
    """Times at which the rubbing stops, and the speeds that are swept then."""

    times: tuple[float, ...]  # of rubbing [s], increasing
    speeds: tuple[float, ...]  # of entrainment [m/s], from fast to slow
    slide_roll_ratio: float  # (u1 - u2) / u_e
    reference: OperatingPoint  # load, temperatures, spin and direction of the sweeps

    @staticmethod
    def of(
        duty: Duty, times: Sequence[float], fastest: float, slowest: float, points: int, srr: float | None = None
    ) -> "Plan":
        """Return `points` speeds [m/s], evenly spaced in their logarithm, after each of `times` [s] of the duty.

        Load, temperature, direction and, without `srr`, the slide-to-roll ratio are those at the duty's beginning.
        Raises ContactError for values that cannot be swept.
        """
        reference = duty.points[0]
        if not (0.0 < slowest < fastest < np.inf):
            raise ContactError(
                f"The speeds of a sweep, {fastest:g} m/s down to {slowest:g} m/s, must be above 0 and fall. "
                "Use --fastest and --slowest the other way round, or others (in Python: fastest, slowest)."
            )
        if points < 2:
            raise ContactError(f"A sweep of {points} speeds is no curve. Use --points 2 or more (in Python: points).")
        if not times or not all(0.0 <= time < np.inf for time in times):
            raise ContactError("The rubbing times must be at least one, finite and not negative. Use for example 0,30.")
        if srr is None:
            if reference.entrainment_speed == 0.0:
                raise ContactError(
                    "The duty begins without entrainment (speed_1 + speed_2 = 0 m/s), so it has no slide-to-roll "
                    "ratio. Give one with --srr (in Python: srr)."
                )
            srr = reference.sliding_speed / reference.entrainment_speed
        speeds = tuple(np.geomspace(fastest, slowest, points).tolist())
        plan = Plan(tuple(sorted(set(times))), speeds, srr, reference)
        plan.point(fastest).check()
        return plan

    def point(self, speed: float) -> OperatingPoint:
        """Return the operating point at an entrainment speed [m/s], in the direction of the reference."""
        entrained = -speed if self.reference.entrainment_speed < 0.0 else speed
        half = 0.5 * self.slide_roll_ratio
        return replace(self.reference, speed_1=entrained * (1.0 + half), speed_2=entrained * (1.0 - half))


class Curves:
    """Results so far. NaN and `valid` False stand for points that have not been measured, or cannot be."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        shape = len(plan.times), len(plan.speeds)
        self._swept = {name: np.full(shape, np.nan) for name in _SWEPT}
        self._rubbed = {name: np.full(shape[0], np.nan) for name in _RUBBED}
        self._flags = np.zeros(shape, np.int64)
        self._valid = np.zeros(shape, np.bool_)
        self._failures: dict[tuple[int, int], str] = {}

    @property
    def count(self) -> int:
        """Points measured, or found to have no solution."""
        return int(self._valid.sum()) + len(self._failures)

    def rubbed(self, i: int, outputs: Outputs) -> None:
        """Keep the surfaces after the rubbing time `i`."""
        for name, values in self._rubbed.items():
            values[i] = getattr(outputs, name)

    def swept(self, i: int, j: int, outputs: Outputs) -> None:
        """Keep the contact's answer after the rubbing time `i` at the speed `j`."""
        for name, values in self._swept.items():
            values[i, j] = getattr(outputs, name)
        self._flags[i, j], self._valid[i, j] = outputs.range_flags, True

    def failed(self, i: int, j: int, error: ConvergenceError) -> None:
        """Keep why there is no answer, and say so."""
        sentence = f"After {self.plan.times[i] / 60.0:g} min at {self.plan.speeds[j]:.4g} m/s: {error}"
        self._failures[i, j] = sentence
        log.warning("%s", sentence)

    def dataset(self, scene: Scene, duty: Duty) -> xr.Dataset:
        """Return variables along rubbing time [s] and entrainment speed [m/s].

        The attribute `failures` lists the missing points, line by line.
        """
        level = _midway(self._swept["friction_coefficient"])
        both = np.hypot(self._rubbed["roughness_1"], self._rubbed["roughness_2"])
        half, midway = self._transitions("contact_load_ratio", 0.5), self._transitions("friction_coefficient", level)
        at_half = "entrainment speed at which the solids carry half of the load"
        at_midway = "entrainment speed at which friction is midway between all curves' extremes"
        along_times, valid = _DIMENSIONS[:1], _described("1", "false: not measured, or no solution")
        variables = {
            **{name: (_DIMENSIONS, values.copy(), _attributes(name)) for name, values in self._swept.items()},
            "range_flags": (_DIMENSIONS, self._flags.copy(), _attributes("range_flags")),
            "valid": (_DIMENSIONS, self._valid.copy(), valid),
            **{name: (along_times, values.copy(), _attributes(name)) for name, values in self._rubbed.items()},
            "composite_roughness": (along_times, both, _described("m", "root of the sum of both roughnesses' squares")),
            "transition_speed": (along_times, half, _described("m/s", at_half)),
            "transition_speed_friction": (along_times, midway, _described("m/s", at_midway)),
        }
        found = with_half_widths(xr.Dataset(variables, self._coordinates()))
        missing = self._valid.size - self.count
        failures = [sentence for _, sentence in sorted(self._failures.items())]
        sentences = [*failures, *([f"{missing} points were not reached."] if missing else [])]
        return with_scene(found, scene, duty).assign_attrs(
            film=scene.film.fidelity, friction_midway=level, failures="\n".join(sentences)
        )

    def _coordinates(self) -> dict[str, tuple[tuple[str, ...], ArrayLike, dict[str, str]]]:
        reference = self.plan.reference
        return {
            "rubbing_time": (_DIMENSIONS[:1], np.array(self.plan.times), _described("s", "time of rubbing")),
            "entrainment_speed": (
                _DIMENSIONS[1:],
                np.array(self.plan.speeds),
                _described("m/s", "magnitude of (speed_1 + speed_2) / 2"),
            ),
            "slide_roll_ratio": ((), self.plan.slide_roll_ratio, _described("1", "(speed_1 - speed_2) / entrainment")),
            "load": ((), reference.load, _attributes("load")),
            "temperature": ((), reference.temperature, _attributes("temperature")),
        }

    def _transitions(self, name: str, level: float) -> Array:
        return np.array([transition_speed(self.plan.speeds, row, level) for row in self._swept[name]])


def measure(
    scene: Scene,
    duty: Duty,
    curves: Curves,
    progress: Callable[[str, int], None] = lambda stage, count: None,
    processes: int = 1,
) -> None:
    """Rub the contact and fill `curves`, which keep their points if this ends early.

    With several `processes`, so many solve points while this one rubs; what they find is the same to the bit. If one of
    them is lost, this process solves what is left. `progress` is called with words for the next stage and the number of
    points so far. A point without a solution is kept as such; ContactError means that the rubbing itself cannot
    continue, and comes once all points before that are solved.
    """
    sweeps = _Sweeps(scene, duty, curves, progress)
    points = sweeps.asked()
    try:
        with workers(min(processes, sweeps.size), None) as given:
            sweeps.take(given, points)
    except WorkersLostError as loss:
        log.warning("%s What is left is solved in one process.", loss.reason)
        sweeps.take(Workers(), chain([*sweeps.left.values()], points))
    if sweeps.refusal:
        raise sweeps.refusal
    progress("done", curves.count)


_Point = tuple[int, int, Scene, Plan, ContactState]  # numbers of rubbing time and speed; the rubbed state


class _Sweeps:
    """The points of all sweeps: those asked for have no answer yet as long as they are `left`."""

    def __init__(self, scene: Scene, duty: Duty, curves: Curves, progress: Callable[[str, int], None]) -> None:
        self._scene, self._duty, self._curves, self._progress = scene, duty, curves, progress
        self.size = len(curves.plan.times) * len(curves.plan.speeds)
        self.left: dict[tuple[int, int], _Point] = {}
        self.refusal: ContactError | None = None  # why the rubbing has ended early
        self._alone = True

    def asked(self) -> Iterator[_Point | None]:
        """Rub the contact; yield the points of each stop, the slow ones first, which take longest, and None between."""
        curves, plan = self._curves, self._curves.plan
        # a speed is solved for itself however near that of the duty, and until its film has settled
        control = replace(self._scene.control, input_change=0.0, inputs="quasi_steady")
        sharp = replace(self._scene, control=control)
        try:
            for time, state, outputs in _rubbed(self._scene, self._duty, plan.times):
                self._progress(f"rubbed {time / 60.0:.0f} min", curves.count)
                if time in plan.times:
                    i = plan.times.index(time)
                    curves.rubbed(i, outputs)
                    for j in reversed(range(len(plan.speeds))):
                        if self._alone:
                            self._show(i, j)
                        self.left[i, j] = (i, j, sharp, plan, state)
                        yield self.left[i, j]
                yield None
        except ContactError as error:
            self.refusal = error
        tell("", 0, 0)  # this process has no part of its own any more

    def take(self, given: Workers, points: Iterator[_Point | None]) -> None:
        """Let workers solve points, and keep what they find."""
        self._alone = given.executor is None  # each point is solved as soon as it is asked for
        with closing(done_by(given, _solved, points, self.size)) as answers:
            for i, j, answer in answers:
                del self.left[i, j]
                if isinstance(answer, ConvergenceError):
                    self._curves.failed(i, j, answer)
                else:
                    self._curves.swept(i, j, answer)
                if not self._alone:
                    self._show(i, j)

    def _show(self, i: int, j: int) -> None:
        plan = self._curves.plan
        self._progress(f"{plan.times[i] / 60.0:g} min, {plan.speeds[j]:.3g} m/s", self._curves.count)


def _solved(
    i: int, j: int, scene: Scene, plan: Plan, state: ContactState
) -> tuple[int, int, Outputs | ConvergenceError]:
    """Return a point's numbers, and its outputs or why there are none."""
    try:
        return i, j, advance(scene, plan.point(plan.speeds[j]), state, 0.0)[1]
    except ConvergenceError as error:
        return i, j, error


def rubbing(scene: Scene, duty: Duty, times: Sequence[float]) -> Iterator[tuple[ContactState, Outputs]]:
    """Yield state and outputs after each of the increasing `times` [s] of the duty, in the steps of a run with it."""
    return ((state, outputs) for time, state, outputs in _rubbed(scene, duty, times) if time in times)


def _rubbed(scene: Scene, duty: Duty, times: Sequence[float]) -> Iterator[tuple[float, ContactState, Outputs]]:
    """Yield time [s], state and outputs at the beginning and after each step of the rubbing."""
    rows = tuple(sorted({*duty.times, *times}))
    steps = Duty(rows, tuple(duty.at(time) for time in rows))
    points = communication_points(steps, times[-1], scene.operation.interval) if times[-1] > 0.0 else [0.0]
    state, outputs = advance(scene, duty.at(0.0), initial_state(scene), 0.0)
    yield 0.0, state, outputs
    for time, end in pairwise(points):
        state, outputs = advance(scene, duty.at(time), state, end - time)
        yield end, state, outputs


def transition_speed(speeds: ArrayLike, values: ArrayLike, level: float = 0.5) -> float:
    """Return the fastest speed [m/s] where `values`, falling with the speed, cross `level`.

    By default `values` are the solids' share of the load, and `level` is one half.
    Linear in the logarithm of the speed between neighbours, in any order; NaN values are left out. NaN if no two
    neighbours bracket the level.
    """
    u, v = np.asarray(speeds, dtype=float), np.asarray(values, dtype=float)
    order = np.argsort(u)
    u, v = (x[order][np.isfinite(v[order])] for x in (u, v))
    crossings = np.flatnonzero((v[:-1] >= level) & (v[1:] < level))
    if not crossings.size:
        return float("nan")
    k = int(crossings[-1])
    part = (v[k] - level) / (v[k] - v[k + 1])
    return float(u[k] ** (1.0 - part) * u[k + 1] ** part)


def _midway(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(0.5 * (known.min() + known.max())) if known.size else float("nan")


def _attributes(name: str) -> dict[str, str]:
    return _described(TABLE[name].unit or "1", TABLE[name].text)


def _described(unit: str, text: str) -> dict[str, str]:
    return {"units": unit, "long_name": text}
