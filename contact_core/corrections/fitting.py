"""A map from solved contacts: sparse polynomials by least squares, and half widths by histories left out.

Terms are chosen one after the other, each the product of one that is there and a coordinate, which takes away most of
what is left of all outputs together; as many as leave the smallest sum of squares of each history by all others
(orthogonal matching pursuit; Pati, Rezaiifar & Krishnaprasad, Asilomar 1993, doi:10.1109/ACSSC.1993.342465, and PRESS:
Allen, Technometrics 16 (1974) 125, doi:10.1080/00401706.1974.10489157). Contacts of the coarser grid, which cost
little, make most of the polynomials; what the scene's grid adds to them is a plane in the coordinates, in which the
sampling of both, which have the same surfaces, largely cancels (two levels of a multilevel method; Giles, Acta Numerica
24 (2015) 259, doi:10.1017/S096249291500001X).

Half widths are such that, with the scatter that a solution states for itself, 95 % of the contacts of each grid are
inside when terms and weights are found without their history, a tenth of the histories at a time: they are those of
what a long run averages to, not of one block.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..errors import ContactError
from ..kernels.arrays import Array, Indices, Mask
from .map import COORDINATES, OUTPUTS, STEEPEST, Map

COVERED = 0.95  # of the contacts left out, by half widths
FEWEST = 30  # contacts that a map is made of, at least
FEWEST_HISTORIES = 3  # on the scene's grid, at least
_DEGREE, _TERMS, _SHARE = 2, 34, 4  # largest degree and number of terms; contacts for each term, at least
_PATIENCE = 6  # terms that are tried after the best
_RIDGE = 1.0  # squares that each weight adds to the sum of squares, over those of one contact
_PLANE = 30.0  # likewise, of the planes that the scene's grid adds, which few histories have
_SURE = 1e-3  # least part of a contact that its history does not tell
_EVEN = 30.0  # likewise, of half widths, which are known from few large deviations
_NARROWEST = 0.005  # half width that counts as none
_PARTS = 10  # of the contacts, each left out in turn
_ROOM = 1e-9  # of the ranges, so that no rounding puts a knot beyond them
_NARROW = 1e-9  # range of a coordinate that does not change
_UNLIKE = 1e-6  # of a term's square, that must be left of it beside the others
_EDGE = 0.01  # W_c: smaller ones, and larger ones than 1 less that, count as it


class TooFewError(ContactError):
    """There are too few contacts for a map."""

    def __init__(self, contacts: int, histories: int) -> None:
        """Say how many contacts there are, and of how many histories on the scene's grid."""
        super().__init__(
            f"{contacts} contacts that can be fitted, of {histories} histories on the scene's grid, are too few for a "
            f"map: it takes {FEWEST} of {FEWEST_HISTORIES}. Give more --time, or ranges in which the deterministic "
            "level converges. What is solved is kept: the same command continues."
        )


class Samples(NamedTuple):
    """Solved contacts; arrays have a row for each."""

    places: Array  # `query.coordinates` by the regression level
    slips: Array  # sliding over entrainment speed
    radii: Array  # along x [m]
    off: Array  # ln of friction and of h_c over those of the regression level, and the difference of W_c
    shares: Array  # contact_load_ratio of the regression level
    own: Array  # half widths of what all solutions share: grid, iteration; relative, of W_c absolute
    scatter: Array  # likewise of what each has for itself
    stated: Array  # likewise of all
    history: Array  # number of the history of each
    fine: Array  # 1: on the grid of the scene, 0: on the coarser one

    def some(self, which: Mask) -> "Samples":
        """Return some of the contacts."""
        return Samples(*(part[which] for part in self))


@dataclass(frozen=True)
class Rule:
    """How a map is fitted; constants: `regression.map` of the benchmarks of revision 869ed0dc."""

    degree: int = _DEGREE
    most: int = _TERMS  # terms
    ridge: float = _RIDGE
    sparse: bool = True  # otherwise all terms of the degree


def fitted(samples: Samples, name: str, digest: str, ranges: tuple[tuple[str, float, float], ...], rule: Rule) -> Map:
    """Return the map of solved contacts, with half widths by histories left out.

    Raises TooFewError for fewer than `FEWEST` knots, or `FEWEST_HISTORIES` on the grid of the scene.
    """
    own = len(set(samples.history[samples.fine > 0.0]))
    if len(samples.shares) < FEWEST or own < FEWEST_HISTORIES:
        raise TooFewError(len(samples.shares), own)
    chart = polynomials(samples, name, digest, ranges, rule)
    off, wide = left_out(samples, rule)
    needed = np.sqrt(np.maximum(off**2 - samples.scatter**2, 0.0)) / wide[:, None]
    linear = scaled_at(chart, samples.places)
    uneven = _smoothed(linear, np.log(np.hypot(needed, _NARROWEST)))
    over = needed / np.exp(linear @ uneven.T)
    grids = [which for which in (samples.fine > 0.0, samples.fine == 0.0) if which.any()]
    uneven[:, 0] += np.log(np.max([np.quantile(over[which], COVERED, axis=0) for which in grids], axis=0))
    return replace(chart, uneven=tuple(map(_tuple, uneven)))


def _smoothed(linear: Array, values: Array) -> Array:
    """Return the weights of 1 and each coordinate, [outputs, 1 + coordinates], of values [contacts, outputs]."""
    squares = linear.T @ linear + _EVEN * np.diag([0.0] + [1.0] * (linear.shape[1] - 1))
    return np.asarray(np.linalg.solve(squares, linear.T @ values).T)


def left_out(samples: Samples, rule: Rule) -> tuple[Array, Array]:
    """Return what each contact deviates from a map without its history by, and root of 1 + leverage.

    The first is [contacts, outputs]. Histories of one number, on both grids, are left out together.
    """
    count = len(samples.shares)
    off, wide = np.empty((count, len(OUTPUTS))), np.empty(count)
    numbers = np.unique(samples.history)
    part_of = np.searchsorted(numbers, samples.history) % min(_PARTS, len(numbers))
    for part in range(min(_PARTS, len(numbers))):
        out = part_of == part
        fit = _Fit.of(samples.some(~out), rule)
        rest = samples.some(out)
        off[out] = rest.off - bounded(fit.at(rest.places, rest.fine), rest.shares)
        wide[out] = fit.spread(rest.places, rest.fine)
    return off, wide


def bounded(told: Array, shares: Array) -> Array:
    """Return deviations as in `Samples.off` from polynomials, [contacts, outputs]."""
    told = np.clip(told, -STEEPEST, STEEPEST)
    odds = np.exp(told[:, 2])
    told[:, 2] = odds * shares / (1.0 + (odds - 1.0) * shares) - shares
    return np.asarray(told)


def spread_at(chart: Map, places: Array) -> Array:
    """Return the root of 1 + leverage at places."""
    terms = design(chart, places)
    triangle = np.zeros((terms.shape[1],) * 2)
    for row, weights in enumerate(chart.spread):
        triangle[row, : row + 1] = weights
    return np.asarray(np.sqrt(1.0 + np.sum((terms @ triangle.T) ** 2, axis=1)))


def widths_at(chart: Map, places: Array) -> Array:
    """Return the half widths (95 %) of a map alone within its ranges, [places, outputs]."""
    return np.asarray(spread_at(chart, places)[:, None] * np.exp(scaled_at(chart, places) @ np.array(chart.uneven).T))


def scaled_at(chart: Map, places: Array) -> Array:
    """Return 1 and the coordinates from -1 to 1, [places, 1 + coordinates], as `query.scaled_to` has them."""
    scaled = np.clip((places[:, chart.picked] - chart.centres) / chart.halves, -1.0, 1.0)
    return np.column_stack([np.ones(len(places)), scaled])


def design(chart: Map, places: Array) -> Array:
    """Return the terms of places, [places, terms], as `query.terms` has them one by one."""
    return _columns(scaled_at(chart, places)[:, 1:], list(zip(chart.term, chart.coordinate, strict=True)))


def polynomials(
    samples: Samples, name: str, digest: str, ranges: tuple[tuple[str, float, float], ...], rule: Rule
) -> Map:
    """Return a map of samples without half widths."""
    fit = _Fit.of(samples, rule)
    fine = samples.fine > 0.0
    own = _smoothed(np.column_stack([np.ones(len(fit.scaled)), fit.scaled])[fine], np.log(samples.own[fine]))
    weights, triangle = fit.of_the_scene()
    return Map(
        scene=name,
        digest=digest,
        ranges=ranges,
        knots=len(fit.scaled),
        picked=fit.picked,
        centres=_tuple(fit.centres),
        halves=_tuple(fit.halves),
        least_slip=float(samples.slips.min()) * (1.0 - _ROOM),
        radii=(float(samples.radii.min()) * (1.0 - _ROOM), float(samples.radii.max()) * (1.0 + _ROOM)),
        term=tuple(term for term, _ in fit.made),
        coordinate=tuple(coordinate for _, coordinate in fit.made),
        weights=tuple(map(_tuple, weights)),
        spread=tuple(_tuple(row[: k + 1]) for k, row in enumerate(triangle)),
        uneven=((0.0,) * (1 + len(fit.picked)),) * len(OUTPUTS),
        own=tuple(map(_tuple, own)),
    )


@dataclass(frozen=True)
class _Fit:
    """Least squares: polynomials of the coarser grid, and planes that the scene's grid adds to them."""

    picked: tuple[int, ...]
    centres: Array
    halves: Array
    scaled: Array  # coordinates of the samples, [samples, picked]
    made: list[tuple[int, int]]
    planes: int  # 1 and coordinates of the planes; 0 where all samples are of one grid
    weights: Array  # [terms and planes, outputs]
    variance: Array  # of a fitted value over that of a sample: inverse of the squares

    @staticmethod
    def of(samples: Samples, rule: Rule) -> "_Fit":
        """Fit samples."""
        low, high = samples.places.min(0), samples.places.max(0)
        picked = _picked(samples.places)
        centres, halves = 0.5 * (high + low)[list(picked)], (0.5 + _ROOM) * (high - low)[list(picked)]
        scaled = (samples.places[:, picked] - centres) / halves
        deviations = samples.off.copy()
        deviations[:, 2] = _logit(samples.shares + samples.off[:, 2]) - _logit(samples.shares)
        fine, one_grid = samples.fine, len(set(samples.fine)) == 1
        planes = 0 if one_grid else 1 + len(picked)
        straight = [(0, k) for k in range(len(picked))]
        if not one_grid:  # the planes first, beside straight terms, so that these are of one grid's samples
            first = _solved(_both(_columns(scaled, straight), scaled, fine, planes), planes, deviations, rule)[0]
            alike = deviations - _both(np.zeros((len(scaled), 0)), scaled, fine, planes) @ first[-planes:]
        else:
            alike = deviations
        made = _sparse(scaled, alike, samples.history, rule) if rule.sparse else _all(scaled, rule)
        if planes:
            made = [*made, *(pair for pair in straight if pair not in made)]
        weights, variance = _solved(_both(_columns(scaled, made), scaled, fine, planes), planes, deviations, rule)
        return _Fit(picked, centres, halves, scaled, made, planes, weights, variance)

    def _columns(self, places: Array, fine: Array) -> Array:
        scaled = np.clip((places[:, self.picked] - self.centres) / self.halves, -1.0, 1.0)
        return _both(_columns(scaled, self.made), scaled, fine, self.planes)

    def at(self, places: Array, fine: Array) -> Array:
        """Return the polynomials at places on a grid, [places, outputs]."""
        return np.asarray(self._columns(places, fine) @ self.weights)

    def spread(self, places: Array, fine: Array) -> Array:
        """Return the root of 1 + leverage."""
        columns = self._columns(places, fine)
        return np.asarray(np.sqrt(1.0 + np.einsum("ij,jk,ik->i", columns, self.variance, columns)))

    def of_the_scene(self) -> tuple[Array, Array]:
        """Return weights [outputs, terms] on the scene's grid, and the triangle of their variance."""
        terms = 1 + len(self.made)
        into = np.eye(terms)
        if self.planes:
            plane = np.zeros((self.planes, terms))
            plane[0, 0] = 1.0
            for k in range(self.planes - 1):
                plane[1 + k, 1 + self.made.index((0, k))] = 1.0
            into = np.vstack([into, plane])
        squares = (into.T @ self.variance @ into)[::-1, ::-1]
        return (into.T @ self.weights).T, np.asarray(np.linalg.cholesky(squares))[::-1, ::-1].T


def _picked(places: Array) -> tuple[int, ...]:
    """Return the coordinates that change, and are no straight function of those before."""
    found: tuple[int, ...] = ()
    straight = np.ones((len(places), 1))
    for k in range(len(COORDINATES)):
        weights = np.linalg.lstsq(straight, places[:, k], rcond=None)[0]
        left = places[:, k] - straight @ weights
        if np.abs(left).max() > _NARROW:
            found = (*found, k)
            straight = np.column_stack([straight, places[:, k]])
    return found


def _both(terms: Array, scaled: Array, fine: Array, planes: int) -> Array:
    """Return terms, and beside them 1 and the coordinates on the scene's grid, 0 on the coarser one."""
    if not planes:
        return terms
    return np.hstack([terms, fine[:, None], fine[:, None] * scaled])


def _solved(columns: Array, planes: int, deviations: Array, rule: Rule) -> tuple[Array, Array]:
    """Return the weights [columns, outputs] of ridge regression, and the inverse of its squares."""
    terms = columns.shape[1] - planes
    ridge = [0.0] + [rule.ridge] * (terms - 1) + ([0.0] + [_PLANE] * (planes - 1) if planes else [])
    inverse = np.asarray(np.linalg.inv(columns.T @ columns + np.diag(ridge)))
    return inverse @ columns.T @ deviations, inverse


def _logit(shares: Array) -> Array:
    bounded = np.clip(shares, _EDGE, 1.0 - _EDGE)
    return np.asarray(np.log(bounded / (1.0 - bounded)))


def _tuple(values: Array) -> tuple[float, ...]:
    return tuple(map(float, values))


def _columns(scaled: Array, made: list[tuple[int, int]]) -> Array:
    found = [np.ones(len(scaled))]
    for term, coordinate in made:
        found.append(found[term] * scaled[:, coordinate])
    return np.array(found).T


def _all(scaled: Array, rule: Rule) -> list[tuple[int, int]]:
    """Return all terms up to the degree, each as an earlier term and the coordinate that it is multiplied by."""
    known: list[tuple[int, ...]] = [()]
    made = []
    for place, powers in enumerate(known):  # grows meanwhile
        if len(powers) < rule.degree:
            for coordinate in range(powers[-1] if powers else 0, scaled.shape[1]):
                known.append((*powers, coordinate))
                made.append((place, coordinate))
    return made


def _sparse(scaled: Array, deviations: Array, history: Array, rule: Rule) -> list[tuple[int, int]]:
    """Return the terms that deviations ask for, each as an earlier term and the coordinate that it is multiplied by."""
    count, size = scaled.shape
    groups = [np.flatnonzero(history == number) for number in np.unique(history)]
    known: list[tuple[int, ...]] = [()]
    made: list[tuple[int, int]] = []
    columns = [np.ones(count)]
    basis = np.ones((count, 1)) / np.sqrt(count)
    left = deviations - basis @ (basis.T @ deviations)
    scale = np.maximum(np.sqrt((left**2).mean(0)), 1e-12)
    left = left / scale
    best, best_made = _press(basis, left, groups), 0
    while len(made) < min(rule.most - 1, count // _SHARE - 1) and len(made) - best_made < _PATIENCE:
        candidates: dict[tuple[int, ...], tuple[int, int]] = {}
        for place, powers in enumerate(known):
            if len(powers) < rule.degree:
                for coordinate in range(size):
                    candidates.setdefault(tuple(sorted((*powers, coordinate))), (place, coordinate))
        fresh = [powers for powers in candidates if powers not in known]
        if not fresh:
            break
        raw = np.array([columns[candidates[p][0]] * scaled[:, candidates[p][1]] for p in fresh]).T
        rest = raw - basis @ (basis.T @ raw)
        size_2 = np.sum(rest**2, axis=0)
        usable = size_2 > _UNLIKE * np.sum(raw**2, axis=0)
        gain = np.where(usable, np.sum((rest.T @ left) ** 2, axis=1) / np.maximum(size_2, 1e-300), 0.0)
        chosen = int(np.argmax(gain))
        if gain[chosen] <= 0.0:
            break
        direction = rest[:, chosen] / np.sqrt(size_2[chosen])
        basis = np.column_stack([basis, direction])
        left = left - np.outer(direction, direction @ left)
        known.append(fresh[chosen])
        made.append(candidates[fresh[chosen]])
        columns.append(raw[:, chosen])
        press = _press(basis, left, groups)
        if press < best:
            best, best_made = press, len(made)
    return made[:best_made]


def _press(basis: Array, left: Array, groups: list[Indices]) -> float:
    """Return the sum of squares of each history by all others, from an orthonormal basis and what it leaves."""
    total = 0.0
    for group in groups:
        own = basis[group]
        told = np.eye(len(group)) * (1.0 + _SURE) - own @ own.T
        total += float(np.sum(np.linalg.solve(told, left[group]) ** 2))
    return total
