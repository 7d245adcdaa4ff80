"""The dry contact of smooth bodies beside Hertz's."""

import numpy as np

from contact_core import dry_contact
from contact_core.kernels.arrays import Array
from contact_core.reference import hertz_point

from .model import Outcome, Row, compared, exactly

LOAD, RADIUS, MODULUS, ACCURACY = 50.0, 9.525e-3, 2.3e11, 0.01
NODES = 65


def run() -> Outcome:
    """Compare largest pressure and approach, whose stated errors are those of the call."""
    hertz = hertz_point(LOAD, RADIUS, RADIUS, MODULUS)
    spacing = 2.6 * hertz.a / (NODES - 1)
    found = dry_contact(np.zeros((NODES, NODES)), spacing, RADIUS, LOAD, MODULUS, accuracy=ACCURACY)
    error = found.error_estimate
    rows = (
        Row(
            "largest pressure", "GPa", exactly(1e-9 * hertz.pressure_max), 1e-9 * found.pressure_max, 0.0,
            "exact", 1e-9 * error["pressure_max"],
        ),
        Row(
            "approach", "um", exactly(1e6 * hertz.approach), 1e6 * found.approach, 0.0, "exact",
            1e6 * error["approach"],
        ),
    )  # fmt: skip
    middle = found.pressure[found.pressure.shape[0] // 2]
    x = (np.arange(middle.size) - middle.size // 2) * found.spacing / hertz.a
    exact: Array = hertz.pressure_max * np.sqrt(np.maximum(1.0 - x**2, 0.0))
    curve = compared("pressure", "x / a", "p [GPa]", (x, 1e-9 * exact), (x, 1e-9 * middle))
    return Outcome(rows, (curve,))
