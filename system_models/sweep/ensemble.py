"""Several patches, or seeds, of one surface: the mean of each output over them, and its band by Student's t.

The stated error of the runs comes on top: it is common to them, and not averaged.
"""

import re
from collections.abc import Sequence

import numpy as np
import scipy  # its parts are loaded at their first use
import xarray as xr

from ..store.results import BAND
from .plan import Plan

MEMBER = "member"  # axis of an ensemble of a scene
SD = "_sd"  # after the name of an output: the standard deviation of its members
_SAME_SURFACE = re.compile(r"surface_[12]\.(set|seed|file|heights\.file)$")  # choices of these are samples of a surface


def patches_of(plan: Plan) -> tuple[str, ...]:
    """Return the keys of a plan whose choices are patches or seeds of one surface."""
    return tuple(factor.key for factor in plan.grid if factor.key == MEMBER or _SAME_SURFACE.match(factor.key))


def averaged(plan: Plan, dataset: xr.Dataset, outputs: Sequence[str]) -> xr.Dataset:
    """Return mean (by its name), `_sd` and `_band` of outputs over the patches; and their `count`.

    A band is the half width that holds the mean with 95 %; it and `_sd` are nan of a single patch.
    """
    keys = patches_of(plan)
    found: dict[str, xr.DataArray] = {}
    for name in outputs:
        values = dataset[name].reset_coords(drop=True).astype(float)  # half widths would be reduced, too
        count = values.notnull().sum(keys)
        sd = values.std(keys, ddof=1).where(count > 1)
        factor = scipy.special.stdtrit(np.maximum(count - 1, 1), 0.975) / np.sqrt(np.maximum(count, 1))
        said = {**values.attrs}
        found |= {
            name: values.mean(keys).assign_attrs(said),
            f"{name}{SD}": sd.assign_attrs(said | {"long_name": f"standard deviation of {name} between patches"}),
            f"{name}{BAND}": (factor * sd).assign_attrs(said | {"long_name": f"half width (95 %) of the mean {name}"}),
        }
    found["count"] = count.assign_attrs(units="1", long_name="patches that were run")
    return xr.Dataset(found)
