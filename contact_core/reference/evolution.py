"""Tribofilm over time."""

import numpy as np

from ..kernels.arrays import Array
from .constants import BOLTZMANN, PLANCK


def ghanbarzadeh_thickness(
    time: float | Array,
    temperature: float,
    full_thickness: float,
    rate_factor: float,
    removal_thickness: float,
    removal_rate: float,
) -> Array:
    """Return the tribofilm [m] on a point rubbed for `time` [s] from bare: h_max (1 - e^-kt) - C3 (1 - e^-C4 t).

    k = (k_B T / h) rate_factor [1/s] at `temperature` [K]; h_max and C3 [m]; C4 = removal_rate [1/s].
    Source: Ghanbarzadeh et al., Tribol. Int. 93 (2016) 573, doi:10.1016/j.triboint.2014.12.018.
    """
    rate = BOLTZMANN * temperature / PLANCK * rate_factor
    formed = full_thickness * (1.0 - np.exp(-rate * np.asarray(time)))
    return formed - removal_thickness * (1.0 - np.exp(-removal_rate * np.asarray(time)))
