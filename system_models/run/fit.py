"""Fits constants of a scene to measured numbers, at the regression level or, through it, at the deterministic one.

A fit at the deterministic level begins with that at the regression level. Then the curves of the regression level,
times what the deterministic level says over it at the constants found last (plus, where a curve is nearly 0), are
fitted again, until the deterministic level agrees with the fitted curves: it is run two to six times.

The stated errors of a level are no part of the intervals: they are common to all points of a test, so fitted constants
take them up, and are those of their level. What they miss of the shape of the curves is scatter.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contact_core import Scene
from contact_core.errors import ContactError
from contact_core.kernels.arrays import Array, Indices, Mask

from . import fit_estimate
from .duty import Duty
from .fit_data import Measured
from .fit_estimate import Curve, Estimate, Problem
from .fit_model import Constant, Model, Places, Points

FAST, SLOW = "regression", "deterministic"
_STARTS = 8  # sets of constants tried for each constant
_LOCALLY = 2  # of these sets a search starts, besides the scene's own
_AGREED = 0.3  # standard deviations by which fitted curves and the deterministic level may differ
_MOST = 6  # runs of the deterministic level
_FLAT = 0.01  # of a quantity's largest value: below, levels differ by a sum, not by a factor
_DRAWN = 41  # times of a drawn curve

Amend = Callable[[Curve], Curve]


@dataclass(frozen=True)
class Drawn:
    """Curves between the points: places, curve, half widths of its interval and of that of measurements."""

    test: Indices
    time: Array
    quantity: NDArray[np.str_]
    curve: Array
    band: Array
    half: Array


@dataclass(frozen=True)
class Fit:
    """Fitted constants and what they say of all measured points."""

    scene: Scene
    level: str
    constants: tuple[Constant, ...]
    measured: Measured
    held: Mask
    silent: Mask  # points that no constant changes, left out
    estimate: Estimate
    drawn: Drawn
    stated: dict[str, float]  # largest relative half width that the level states, by quantity
    runs: int  # simulated tests
    failures: int  # sets of constants with which the scene could not be computed
    off: float  # standard deviations by which the deterministic level differs from the fitted curves

    @property
    def agreed(self) -> bool:
        """True if the fitted curves are those of the level."""
        return self.off <= _AGREED

    @property
    def values(self) -> dict[str, float]:
        """Fitted constants [SI] by key."""
        return {c.key: c.at(float(x)) for c, x in zip(self.constants, self.estimate.shares, strict=True)}

    @property
    def inside(self) -> Mask:
        """Which points are within the interval of a measurement."""
        return np.abs(self.measured.value - self.estimate.curve) <= self.estimate.half


def fit(
    scene: Scene,
    measured: Measured,
    constants: tuple[Constant, ...],
    held: Mask,
    level: str = FAST,
    progress: Callable[[str], None] = lambda stage: None,
) -> Fit:
    """Return the constants of the scene that fit the measured numbers best; those `held` back are not fitted.

    `progress` is called with words for the stage at each set of constants. Raises ContactError if the scene cannot be
    computed as it is, or for too few points.
    """
    _check_count(measured, held, constants)
    sized, places = _sized(scene, measured), Places(measured.test, measured.time, measured.quantity)
    model = Model(sized.at_level(FAST), measured.tests, constants, measured.quantities)
    points = Points(model, *places)
    first = np.array([constant.share(constant.value) for constant in constants])
    points(first)  # a scene that cannot be computed as it is says why
    curve = _remembered(points, progress)
    tried = np.vstack([first, fit_estimate.starts(len(constants), _STARTS * len(constants))])
    curves = np.array([curve(shares) for shares in tried])
    silent = _silent(measured, curves, held, constants)
    group = _groups(measured, measured.quantity)
    problem = Problem(curve, measured.value, measured.sd, group, ~held & ~silent, len(constants))
    found, off, runs = fit_estimate.searched(problem, tried, curves, _LOCALLY), 0.0, 0
    amended: Amend = _as_it_is
    if np.isnan(found.curve).any():
        raise ContactError("The search ended where the scene cannot be computed. Narrow the ranges of --vary.")
    between = _between(measured)
    everywhere = Points(model, *(np.concatenate(pair) for pair in zip(places, between, strict=True)))
    if level == SLOW:
        model = Model(sized.at_level(SLOW), measured.tests, constants, measured.quantities)
        found, off, amended = _through(model, problem, found, everywhere, progress)
        runs = model.runs
    progress("curves")
    drawn = _drawn(measured, found, amended(everywhere.or_nothing), between)
    stated = model.stated(found.shares, [np.unique(measured.time[measured.test == i]) for i in range(len(model.tests))])
    runs, failures = points.model.runs + runs, points.failures + everywhere.failures
    return Fit(
        sized.at_level(level), level, constants, measured, held, silent, found, drawn, stated, runs, failures, off
    )


def _remembered(points: Points, progress: Callable[[str], None]) -> Curve:
    """Return the curve at the points, computed once for each set of constants."""
    known: dict[bytes, Array] = {}

    def curve(shares: Array) -> Array:
        key = shares.tobytes()
        if key not in known:
            progress("search")
            known[key] = points.or_nothing(shares)
        return known[key]

    return curve


def _as_it_is(curve: Curve) -> Curve:
    return curve


def _through(
    slow: Model, problem: Problem, found: Estimate, everywhere: Points, progress: Callable[[str], None]
) -> tuple[Estimate, float, Amend]:
    """Return the fit at the deterministic level, its deviation, what turns the other level's curves into its own."""
    count, places = len(problem.measured), everywhere.places
    slow_everywhere = Points(slow, *places)
    best: tuple[float, Estimate, float, Amend] | None = None
    for _ in range(_MOST):
        progress("deterministic level")
        truth, fast = slow_everywhere(found.shares), everywhere(found.shares)
        deviation = ((truth[:count] - found.curve) / found.sigma)[problem.fitted]
        off = float(np.sqrt((deviation**2).mean()))
        cost = float((((truth[:count] - problem.measured) / found.sigma)[problem.fitted] ** 2).mean())
        change = _correction(truth, fast, places.quantity)
        if best is None or cost < best[0]:
            best = cost, replace(found, curve=truth[:count]), off, change
        if off <= _AGREED:
            return replace(found, curve=truth[:count]), off, change
        here = _correction(truth[:count], problem.curve(found.shares), places.quantity[:count])
        found = fit_estimate.refined(replace(problem, curve=here(problem.curve)), found)
    assert best is not None
    return best[1:]


def _correction(truth: Array, fast: Array, quantity: NDArray[np.str_]) -> Amend:
    """Return what turns curves of the regression level into such that are the `truth` where they are `fast` now."""
    factor, shift = np.ones(len(truth)), np.zeros(len(truth))
    for name in np.unique(quantity):
        here = quantity == name
        flat = here & (np.minimum(np.abs(fast), np.abs(truth)) <= _FLAT * np.abs(fast[here]).max())
        shift[flat] = (truth - fast)[flat]
        factor[here & ~flat] = (truth / np.where(fast == 0.0, 1.0, fast))[here & ~flat]
    return lambda curve: lambda shares: factor * curve(shares) + shift


def _sized(scene: Scene, measured: Measured) -> Scene:
    """Return the scene with a grid that is checked for all tests."""
    return Duty(tuple(map(float, range(len(measured.tests)))), measured.tests).sized(scene)


def _groups(measured: Measured, quantity: NDArray[np.str_]) -> Indices:
    names = list(measured.quantities)
    return np.array([names.index(name) for name in quantity.tolist()], dtype=np.int64)


def _check_count(measured: Measured, held: Mask, constants: tuple[Constant, ...]) -> None:
    left = int((~held).sum())
    if left <= len(constants):
        raise ContactError(
            f"{left} points are too few for {len(constants)} constants ({', '.join(c.key for c in constants)}): there "
            f"must be more points than constants. Of {len(measured)}, {int(held.sum())} are held back. Vary fewer "
            "constants with --vary, or lower --hold-back."
        )
    for name in measured.quantities:
        here = (measured.quantity == name) & ~held
        if here.sum() < 2 and not (measured.sd[measured.quantity == name] > 0.0).all():
            raise ContactError(
                f"{int(here.sum())} fitted points of {name} say nothing about its scatter. Give its standard deviation "
                f"as a column '{name}_sd', or more points."
            )


def _silent(measured: Measured, curves: Array, held: Mask, constants: tuple[Constant, ...]) -> Mask:
    """Return which points no constant changes, by the curves of many sets of constants, the scene's own first.

    Raises ContactError if these are all of a quantity, or leave too few.
    """
    keys = ", ".join(c.key for c in constants)
    if np.isnan(curves[1:]).any(axis=1).all():
        raise ContactError(
            f"The scene can be computed with none of {len(curves) - 1} other sets of {keys} than its own. Narrow the "
            "ranges of --vary."
        )
    silent = fit_estimate.silent(curves)
    for name in measured.quantities:
        if silent[measured.quantity == name].all():
            raise ContactError(
                f"None of {keys} changes {name} of this scene. Vary another constant, or leave that column out."
            )
    left = int((~silent & ~held).sum())
    if left <= len(constants):
        raise ContactError(
            f"{left} points are too few for {len(constants)} constants ({keys}): the other {int(silent.sum())} do not "
            "depend on them, such as films at time 0."
        )
    return silent


def _between(measured: Measured) -> Places:
    """Return the places of the drawn curves: times of every test and quantity, denser early; none without a course."""
    test: list[int] = []
    time: list[float] = []
    quantity: list[str] = []
    for name in measured.quantities:
        for i in range(len(measured.tests)):
            here = measured.time[(measured.quantity == name) & (measured.test == i)]
            if len(here) and here.max() > 0.0:
                times = (here.max() * np.linspace(0.0, 1.0, _DRAWN) ** 2).tolist()
                test, time, quantity = test + [i] * len(times), time + times, quantity + [name] * len(times)
    return Places(np.array(test, dtype=np.int64), np.array(time), np.array(quantity, dtype=measured.quantity.dtype))


def _drawn(measured: Measured, found: Estimate, at_all: Curve, places: Places) -> Drawn:
    count, group = len(measured), _groups(measured, places.quantity)
    if not len(group):
        nothing = np.zeros(0)
        return Drawn(*places, nothing, nothing, nothing)
    curve = at_all(found.shares)[count:]
    slope = fit_estimate.jacobian(lambda shares: at_all(shares)[count:], found.shares)
    sd = np.array([float(np.median(measured.sd[measured.quantity == name])) for name in measured.quantities])
    return Drawn(*places, curve, *found.about(curve, slope, group, sd[group]))
