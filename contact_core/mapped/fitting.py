"""A map from solved contacts: sparse polynomials by least squares, and half widths by contacts left out.

Terms are chosen one after the other, each the product of one that is there and a coordinate, which takes away most of
what is left of all outputs together; as many as leave the smallest sum of squares of each contact by all others
(orthogonal matching pursuit; Pati, Rezaiifar & Krishnaprasad, Asilomar 1993, doi:10.1109/ACSSC.1993.342465, and PRESS:
Allen, Technometrics 16 (1974) 125, doi:10.1080/00401706.1974.10489157). Half widths are such that, with the
scatter that a solution states for itself, 95 % of the contacts are inside when terms and weights are found without
them, a tenth of the contacts at a time.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import ContactError
from .map import COORDINATES, OUTPUTS, STEEPEST, Map

Array = NDArray[np.float64]

COVERED = 0.95  # of the contacts left out, by half widths
FEWEST = 30  # contacts that a map is made of, at least
_DEGREE, _TERMS, _SHARE = 3, 40, 4  # largest degree and number of terms; contacts for each term, at least
_PATIENCE = 6  # terms that are tried after the best
_RIDGE = 1.0  # squares that each weight adds to the sum of squares, over those of one contact
_EVEN = 30.0  # likewise, of half widths, which are known from few large deviations
_NARROWEST = 0.005  # half width that counts as none
_PARTS = 10  # of the contacts, each left out in turn
_ROOM = 1e-9  # of the ranges, so that no rounding puts a knot beyond them
_NARROW = 1e-9  # range of a coordinate that does not change
_UNLIKE = 1e-6  # of a term's square, that must be left of it beside the others
_EDGE = 0.01  # W_c: smaller ones, and larger ones than 1 less that, count as it


class Samples(NamedTuple):
    """Solved contacts; arrays have a row for each."""

    places: Array  # `query.coordinates` by the regression level
    slips: Array  # sliding over entrainment speed
    off: Array  # ln of friction and of h_c over those of the regression level, and the difference of W_c
    shares: Array  # contact_load_ratio of the regression level
    own: Array  # half widths of what all solutions share: grid, iteration; relative, of W_c absolute
    scatter: Array  # likewise of what each has for itself

    def some(self, which: NDArray[np.bool_]) -> "Samples":
        """Return some of the contacts."""
        return Samples(*(part[which] for part in self))


@dataclass(frozen=True)
class Rule:
    """How a map is fitted; the constants are chosen by docs/measured/regression/map.md."""

    degree: int = _DEGREE
    most: int = _TERMS  # terms
    ridge: float = _RIDGE
    sparse: bool = True  # otherwise all terms of the degree


def fitted(samples: Samples, name: str, digest: str, ranges: tuple[tuple[str, float, float], ...], rule: Rule) -> Map:
    """Return the map of solved contacts, with half widths by contacts left out.

    Raises ContactError for fewer than `FEWEST`.
    """
    if len(samples.shares) < FEWEST:
        raise ContactError(
            f"{len(samples.shares)} solved contacts are too few for a map: it takes {FEWEST}. Give more --time."
        )
    chart = polynomials(samples, name, digest, ranges, rule)
    off, wide = left_out(samples, name, digest, ranges, rule)
    needed = np.sqrt(np.maximum(off**2 - samples.scatter**2, 0.0)) / wide[:, None]
    linear = scaled_at(chart, samples.places)
    uneven = _smoothed(linear, np.log(np.hypot(needed, _NARROWEST)))
    uneven[:, 0] += np.log(np.quantile(needed / np.exp(linear @ uneven.T), COVERED, axis=0))
    return replace(chart, uneven=tuple(map(_tuple, uneven)))


def _smoothed(linear: Array, values: Array) -> Array:
    """Return the weights of 1 and each coordinate, [outputs, 1 + coordinates], of values [contacts, outputs]."""
    squares = linear.T @ linear + _EVEN * np.diag([0.0] + [1.0] * (linear.shape[1] - 1))
    return np.asarray(np.linalg.solve(squares, linear.T @ values).T)


def left_out(
    samples: Samples, name: str, digest: str, ranges: tuple[tuple[str, float, float], ...], rule: Rule
) -> tuple[Array, Array]:
    """Return what each contact deviates from a map without it by, [contacts, outputs], and root of 1 + leverage."""
    count = len(samples.shares)
    off, wide = np.empty((count, len(OUTPUTS))), np.empty(count)
    for part in range(_PARTS):
        out = np.arange(count) % _PARTS == part
        chart = polynomials(samples.some(~out), name, digest, ranges, rule)
        rest = samples.some(out)
        off[out] = rest.off - predicted(chart, rest)
        wide[out] = spread_at(chart, rest.places)
    return off, wide


def predicted(chart: Map, samples: Samples) -> Array:
    """Return the deviations that a map has for contacts within its ranges, as in `Samples.off`."""
    told = np.clip(design(chart, samples.places) @ np.array(chart.weights).T, -STEEPEST, STEEPEST)
    odds = np.exp(told[:, 2])
    told[:, 2] = odds * samples.shares / (1.0 + (odds - 1.0) * samples.shares) - samples.shares
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
    low, high = samples.places.min(0), samples.places.max(0)
    picked = tuple(k for k in range(len(COORDINATES)) if high[k] - low[k] > _NARROW)
    centres, halves = 0.5 * (high + low)[list(picked)], (0.5 + _ROOM) * (high - low)[list(picked)]
    scaled = (samples.places[:, picked] - centres) / halves
    deviations = samples.off.copy()
    deviations[:, 2] = _logit(samples.shares + samples.off[:, 2]) - _logit(samples.shares)
    made = _sparse(scaled, deviations, rule) if rule.sparse else _all(scaled, rule)
    terms = _columns(scaled, made)
    squares = terms.T @ terms + rule.ridge * np.diag([0.0] + [1.0] * len(made))
    root = np.linalg.cholesky(squares)
    weights = np.linalg.solve(squares, terms.T @ deviations).T
    own = _smoothed(np.column_stack([np.ones(len(scaled)), scaled]), np.log(samples.own))
    triangle = np.linalg.inv(root)
    return Map(
        scene=name,
        digest=digest,
        ranges=ranges,
        knots=len(scaled),
        picked=picked,
        centres=_tuple(centres),
        halves=_tuple(halves),
        least_slip=float(samples.slips.min()) * (1.0 - _ROOM),
        term=tuple(term for term, _ in made),
        coordinate=tuple(coordinate for _, coordinate in made),
        weights=tuple(map(_tuple, weights)),
        spread=tuple(_tuple(row[: k + 1]) for k, row in enumerate(triangle)),
        uneven=((0.0,) * (1 + len(picked)),) * len(OUTPUTS),
        own=tuple(map(_tuple, own)),
    )


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


def _sparse(scaled: Array, deviations: Array, rule: Rule) -> list[tuple[int, int]]:
    """Return the terms that deviations ask for, each as an earlier term and the coordinate that it is multiplied by."""
    count, size = scaled.shape
    known: list[tuple[int, ...]] = [()]
    made: list[tuple[int, int]] = []
    columns = [np.ones(count)]
    basis = np.ones((count, 1)) / np.sqrt(count)
    left = deviations - basis @ (basis.T @ deviations)
    scale = np.maximum(np.sqrt((left**2).mean(0)), 1e-12)
    left = left / scale
    told = np.full(count, 1.0 / count)  # leverage
    best, best_made = float(np.sum((left / (1.0 - told)[:, None]) ** 2)), 0
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
        told = told + direction**2
        known.append(fresh[chosen])
        made.append(candidates[fresh[chosen]])
        columns.append(raw[:, chosen])
        press = float(np.sum((left / np.maximum(1.0 - told, 1e-3)[:, None]) ** 2))
        if press < best:
            best, best_made = press, len(made)
    return made[:best_made]
