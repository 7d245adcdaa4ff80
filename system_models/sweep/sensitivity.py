"""Sobol indices of the outputs of a sweep: which share of their variance is due to which key.

Saltelli et al., Comput. Phys. Commun. 181 (2010) 259, doi:10.1016/j.cpc.2009.09.018, by `scipy.stats.sobol_indices`.
"""

from typing import NamedTuple

import numpy as np
import xarray as xr

from .plan import Plan

Interval = tuple[float, float, float]  # value, low and high of 95 %
_STEADY = 1e-12  # relative range of an output that does not change
_SEED, _RESAMPLES = 1, 200  # of the bootstrap


class Indices(NamedTuple):
    """Of one output and one key: shares of the variance, with intervals of 95 % by the bootstrap."""

    output: str
    key: str
    first: Interval  # by the key alone
    total: Interval  # by the key and all that it does together with others


def indices(plan: Plan, dataset: xr.Dataset, outputs: tuple[str, ...]) -> list[Indices]:
    """Return the indices of outputs along the samples of a plan of method "indices" without choices.

    Outputs that do not change have none; nor has one that is not finite everywhere, as the design needs all samples.
    """
    keys = [factor.key for factor in plan.sampled]
    count = len(plan.shares) // (len(keys) + 2)
    rows = np.arange(len(plan.shares)).reshape(len(keys) + 2, count)
    found = []
    for output in outputs:
        values = dataset[output].values.astype(float)
        if not np.isfinite(values).all() or np.ptp(values) <= _STEADY * np.abs(values).max():
            continue
        once = _of(values[rows])
        draw = np.random.default_rng(_SEED)
        again = [_of(values[rows[:, draw.integers(count, size=count)]]) for _ in range(_RESAMPLES)]
        low, high = np.quantile(again, (0.025, 0.975), axis=0)
        for k, key in enumerate(keys):
            first, total = ((float(once[n, k]), float(low[n, k]), float(high[n, k])) for n in (0, 1))
            found.append(Indices(output, key, first, total))
    return found


def _of(values: np.ndarray) -> np.ndarray:
    """Return the indices [first, total; keys] of values [2 + keys, samples]: both matrices, then their mixtures."""
    from scipy.stats import sobol_indices

    parts = {"f_A": values[None, 0], "f_B": values[None, 1], "f_AB": values[2:, None]}
    result = sobol_indices(func=parts, n=values.shape[1])
    return np.stack([np.ravel(result.first_order), np.ravel(result.total_order)])
