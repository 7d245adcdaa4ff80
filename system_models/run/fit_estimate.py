"""Constants by weighted least squares, with intervals: arrays in, arrays out.

A curve y(x) of shares x in [0, 1] is fitted to measured numbers m with deviations

    m = y(x) + e,   variance of e = sd² + (s w)²,

sd being the given standard deviation, or 0, and s the scatter of a quantity beyond it. w is 1, or |y| (at least a
hundredth of the quantity's largest), whichever makes the deviations of the quantity likelier. s follows from
sum(r² / variance) = degrees of freedom, r being the residuals of the fitted points, of which each constant takes its
leverage; it is 0 where the given sd explain the residuals.

The minimum is searched by trust regions within the bounds, from the best of a low-discrepancy set of starts. With the
Jacobian J and C = (J^T V^-1 J)^-1, constants have the variance C, a further measurement V + J C J^T; intervals are
Student's t quantiles of these (Bates & Watts, Nonlinear Regression Analysis, 1988, doi:10.1002/9780470316757,
chapter 2). Where an interval would leave the range of a constant, its limits are those of the profile likelihood
(chapter 6), and a limit that is not reached within the range is open.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, least_squares
from scipy.stats import norm, qmc, t

from contact_core.arrays import Array

Curve = Callable[[Array], Array]  # shares of the ranges to numbers at all points; NaN where there are none

COVERED = 0.9  # of the intervals
_STEP = 0.01  # of a range: differences; curves of levels are smooth to a thousandth only
_LEAST = 0.01  # of a quantity's largest value: a scatter in proportion is at least that of it
_FIRST = 0.1  # scatter before any fit, over the rms of a quantity
_FAR = 1e3  # residual where the model has no answer
_SAME = 0.02  # scatter that changes by less has settled
_ROUNDS = 6  # of scatter and constants
_CLEARLY = 2.0  # log likelihood by which a scatter in proportion must be likelier than an even one
_WEAK = 1e-6  # least information on a share, so that nothing is singular
_ROUGHLY = 1e-2  # change of the sum of squares, or of shares, at which a first search ends
_BISECTIONS = 7


@dataclass(frozen=True)
class Problem:
    """What is fitted: a curve and measured numbers, of which some are held back."""

    curve: Curve
    measured: Array
    sd: Array  # 0: not given
    group: NDArray[np.int64]  # quantity of each point, from 0
    fitted: NDArray[np.bool_]
    count: int  # constants


@dataclass(frozen=True)
class Limits:
    """Interval of a constant, as shares of its range; None: open on that side."""

    low: float | None
    high: float | None

    @property
    def open(self) -> bool:
        """True if the points tell nothing about the constant within its range."""
        return self.low is None and self.high is None


@dataclass(frozen=True)
class Estimate:
    """Fitted constants, as shares of their ranges, and what follows for all points."""

    shares: Array
    limits: tuple[Limits, ...]
    curve: Array
    sigma: Array  # standard deviation of a measurement about the curve
    half: Array  # half width of the interval for a further measurement
    band: Array  # half width of the interval for the curve
    covariance: Array  # of the shares
    quantile: float
    scatter: tuple[float, ...]  # by group, beyond the given sd
    proportional: tuple[bool, ...]  # by group: the scatter is a share of the curve
    freedom: float

    def about(self, curve: Array, slope: Array, group: NDArray[np.int64], sd: Array) -> tuple[Array, Array]:
        """Return half widths for the curve, and for a measurement with an `sd`, at other places."""
        spread = _spread(slope, self.covariance)
        scatter = np.zeros(len(curve))
        for g, (s, proportional) in enumerate(zip(self.scatter, self.proportional, strict=True)):
            here = group == g
            scatter[here] = s * _weight(curve[here], proportional)
        return self.quantile * spread, self.quantile * np.sqrt(spread**2 + scatter**2 + sd**2)


def starts(count: int, number: int) -> Array:
    """Return a low-discrepancy set of shares [number, count]."""
    found: Array = qmc.Halton(count, scramble=False).random(number + 1)[1:]
    return found


def silent(curves: Array) -> NDArray[np.bool_]:
    """Return at which points curves [set, point] of different constants are all the same."""
    known = curves[~np.isnan(curves).any(axis=1)]
    return np.ptp(known, axis=0) <= 1e-12 * np.abs(known).max(axis=0)


def searched(problem: Problem, tried: Array, curves: Array, locally: int) -> Estimate:
    """Return the best of the fits from the first and from the best of the shares `tried`, whose curves are known."""
    sigma = _first_sigma(problem)
    costs = np.array([_cost(problem, sigma, curve) for curve in curves])
    best_first = [i for i in np.argsort(costs, kind="stable").tolist() if i != 0]
    begins = [tried[0], *tried[best_first[:locally]]]
    ends = [_minimum(problem, sigma, begin, close=_ROUGHLY) for begin in begins]
    best = min(ends, key=lambda end: end[1])[0]
    others = [end for end, _ in ends if not np.allclose(end, best, atol=_STEP)]
    return _estimate(problem, best, sigma, others)


def refined(problem: Problem, begin: Estimate) -> Estimate:
    """Return the fit that is found from another one."""
    return _estimate(problem, begin.shares, begin.sigma, [])


def jacobian(curve: Curve, shares: Array) -> Array:
    """Return the derivatives [point, constant] by central differences within the range."""
    columns = []
    for i in range(len(shares)):
        ends = np.clip(shares[i] + np.array([-_STEP, _STEP]), 0.0, 1.0)
        below, above = (curve(_with(shares, i, end)) for end in ends)
        if np.isnan(below).any() or np.isnan(above).any():  # one side has no answer: the middle and the other side
            middle = curve(shares)
            below, above = np.where(np.isnan(below), middle, below), np.where(np.isnan(above), middle, above)
            columns.append((above - below) / _STEP)
        else:
            columns.append((above - below) / (ends[1] - ends[0]))
    return np.column_stack(columns)


def _with(shares: Array, i: int, value: float) -> Array:
    changed = shares.copy()
    changed[i] = value
    return changed


def _residuals(problem: Problem, sigma: Array, curve: Array) -> Array:
    found = (curve - problem.measured)[problem.fitted] / sigma[problem.fitted]
    return np.where(np.isnan(found), _FAR, np.clip(found, -_FAR, _FAR))


def _cost(problem: Problem, sigma: Array, curve: Array) -> float:
    return float((_residuals(problem, sigma, curve) ** 2).sum())


def _minimum(
    problem: Problem, sigma: Array, begin: Array, free: NDArray[np.bool_] | None = None, close: float = 1e-4
) -> tuple[Array, float]:
    """Return shares and sum of squares of a minimum within the ranges, closer than `close`; only `free` ones move."""
    moves = np.ones(len(begin), np.bool_) if free is None else free

    def all_of(part: Array) -> Array:
        shares = begin.copy()
        shares[moves] = part
        return shares

    def residuals(part: Array) -> Array:
        return _residuals(problem, sigma, problem.curve(all_of(part)))

    def slopes(part: Array) -> Array:
        here = residuals(part)
        steps = np.where(part + _STEP <= 1.0, _STEP, -_STEP)
        return np.column_stack([(residuals(_with(part, i, part[i] + h)) - here) / h for i, h in enumerate(steps)])

    if not moves.any():
        return begin, _cost(problem, sigma, problem.curve(begin))
    inside = np.clip(begin[moves], 1e-6, 1.0 - 1e-6)
    found = least_squares(
        residuals, inside, jac=slopes, bounds=(0.0, 1.0), x_scale=0.1, ftol=close, xtol=close, gtol=1e-8, max_nfev=30
    )
    return all_of(found.x), float(2.0 * found.cost)


def _first_sigma(problem: Problem) -> Array:
    """Return the standard deviations to begin with: those given, else a tenth of the rms of their quantity."""
    sigma = problem.sd.copy()
    for g in range(int(problem.group.max()) + 1):
        here = problem.group == g
        size = float(np.sqrt((problem.measured[here] ** 2).mean()))
        sigma[here & (sigma == 0.0)] = _FIRST * size or 1.0
    return sigma


def _estimate(problem: Problem, begin: Array, sigma: Array, others: list[Array]) -> Estimate:
    """Return constants and scatter that agree with each other, with intervals."""
    shares, used = begin, problem.fitted
    scatter: tuple[float, ...] = ()
    for _ in range(_ROUNDS):
        shares = _minimum(problem, sigma, shares)[0]
        curve = problem.curve(shares)
        slope = jacobian(problem.curve, shares)
        covariance = _covariance(slope[used], sigma[used])
        leverage = np.einsum("ij,jk,ik->i", slope[used], covariance, slope[used]) / sigma[used] ** 2
        before, (scatter, proportional, sigma) = scatter, _scatter(problem, curve, leverage)
        if before and np.allclose(before, scatter, rtol=_SAME):
            break
    covariance = _covariance(slope[used], sigma[used])
    freedom = float(used.sum() - problem.count)
    quantile = _quantile(freedom if any(scatter) else np.inf)
    spread = _spread(slope, covariance)
    found = Estimate(
        shares, (), curve, sigma, quantile * np.hypot(spread, sigma), quantile * spread, covariance, quantile,
        scatter, proportional, freedom,
    )  # fmt: skip
    return replace(found, limits=_all_limits(problem, found, others))


def _quantile(freedom: float) -> float:
    tail = 0.5 * (1.0 + COVERED)
    return float(t.ppf(tail, freedom) if np.isfinite(freedom) else norm.ppf(tail))


def _covariance(slope: Array, sigma: Array) -> Array:
    weighted = slope / sigma[:, None]
    information = weighted.T @ weighted + _WEAK * np.eye(slope.shape[1])
    return np.asarray(np.linalg.inv(information), dtype=np.float64)


def _spread(slope: Array, covariance: Array) -> Array:
    variance: Array = np.einsum("ij,jk,ik->i", slope, covariance, slope)
    return np.sqrt(np.maximum(variance, 0.0))


def _weight(curve: Array, proportional: bool) -> Array:
    if not proportional:
        return np.ones(len(curve))
    return np.maximum(np.abs(curve), _LEAST * float(np.abs(curve).max(initial=0.0)))


def _scatter(problem: Problem, curve: Array, leverage: Array) -> tuple[tuple[float, ...], tuple[bool, ...], Array]:
    """Return the scatter of each group, whether it is in proportion to the curve, and all standard deviations."""
    lever, sigma = np.zeros(len(curve)), problem.sd.copy()
    lever[problem.fitted] = leverage
    scatter, proportional = [], []
    for g in range(int(problem.group.max()) + 1):
        here = problem.group == g
        fitted = problem.fitted[here]
        residual, sd = (problem.measured - curve)[here], problem.sd[here]
        freedom = max(float((1.0 - lever[here][fitted]).sum()), 0.5)
        kinds = []
        for kind in (False, True):
            weight = np.maximum(_weight(curve[here], kind), 1e-300)
            s = _root(residual[fitted], sd[fitted], weight[fitted], freedom)
            spread = np.hypot(sd, s * weight)
            kinds.append((_likelihood(residual[fitted], spread[fitted]) - (_CLEARLY if kind else 0.0), kind, s, spread))
        _, kind, s, spread = max(kinds, key=lambda item: item[0])
        sigma[here] = spread
        scatter.append(s)
        proportional.append(kind)
    return tuple(scatter), tuple(proportional), sigma


def _likelihood(residual: Array, sigma: Array) -> float:
    return float(-np.log(sigma).sum() - 0.5 * ((residual / sigma) ** 2).sum())


def _root(residual: Array, sd: Array, weight: Array, freedom: float) -> float:
    """Return the scatter with which the residuals are as large as their degrees of freedom make likely."""

    def excess(s: float) -> float:
        return float((residual**2 / (sd**2 + (s * weight) ** 2)).sum()) - freedom

    largest = float(np.sqrt((residual**2 / weight**2).sum() / freedom))  # without any sd
    smallest = 1e-9 * max(largest, 1e-9 * float(np.abs(residual).max(initial=0.0)), 1e-300)
    if (sd > 0.0).all() and excess(0.0) <= 0.0:
        return 0.0
    if not (sd > 0.0).any() or excess(largest) > 0.0:
        return max(largest, 1e-12)
    return float(brentq(excess, smallest, largest)) if excess(smallest) > 0.0 else smallest


def _all_limits(problem: Problem, found: Estimate, others: list[Array]) -> tuple[Limits, ...]:
    """Return the intervals of all constants; minima that are nearly as good widen them."""
    limit = found.quantile**2
    least = _cost(problem, found.sigma, found.curve)
    as_good = [other for other in others if _cost(problem, found.sigma, problem.curve(other)) - least < limit]
    return tuple(_limits(problem, found, i, least, limit, as_good) for i in range(problem.count))


def _limits(problem: Problem, found: Estimate, i: int, least: float, limit: float, as_good: list[Array]) -> Limits:
    half, middle = found.quantile * float(np.sqrt(found.covariance[i, i])), float(found.shares[i])
    low, high = middle - half, middle + half
    if low <= 0.0 and high >= 1.0:
        return Limits(None, None)
    if low > 0.0 and high < 1.0:
        known = [low, high, *(float(end[i]) for end in as_good)]
        return Limits(min(known), max(known))
    return Limits(*(_profile(problem, found, i, end, least, limit) for end in (0.0, 1.0)))


def _profile(problem: Problem, found: Estimate, i: int, end: float, least: float, limit: float) -> float | None:
    """Return the share between the best one and an end at which the sum of squares is higher by `limit`, or None."""
    free = np.arange(problem.count) != i
    shares = _with(found.shares, i, end)
    shares, cost = _minimum(problem, found.sigma, shares, free)
    if cost - least < limit:
        return None
    inside, outside = float(found.shares[i]), end
    for _ in range(_BISECTIONS):
        middle = 0.5 * (inside + outside)
        shares, cost = _minimum(problem, found.sigma, _with(shares, i, middle), free)
        inside, outside = (middle, outside) if cost - least < limit else (inside, middle)
    return 0.5 * (inside + outside)
