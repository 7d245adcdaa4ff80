"""Films of points with too little oil beside the published curve of numerical solutions."""

from typing import Any

import numpy as np

from contact_core import ConvergenceError, point_contact
from contact_core.laws.density import DowsonHigginson
from contact_core.reference.starvation import supplied_film

from .model import Outcome, Row

LOAD, RADIUS, MODULUS, VISCOSITY, COEFFICIENT, SPEED = 100.0, 0.01, 2.2e11, 0.05, 2e-8, 1.0
SHARES = (0.25, 0.5, 1.0, 2.0)  # of the oil that a flooded contact takes
SIDE_FLOW = (2.0, 5.0)  # resistance to side flow of circular contacts, as published
GRIDS = (33, 65)


def _films(grid: int) -> list[float]:
    """Return the films over the flooded one."""
    given: dict[str, Any] = {
        "load": LOAD, "radius_x": RADIUS, "reduced_modulus": MODULUS, "speed_1": SPEED, "speed_2": SPEED,
        "viscosity": VISCOSITY, "pressure_viscosity": COEFFICIENT, "tolerance": 5e-4, "grid": grid,
    }  # fmt: skip
    flooded, found = point_contact(**given), []
    middle = flooded.pressure[np.abs(flooded.y).argmin(), np.abs(flooded.x).argmin()]
    taken = float(DowsonHigginson()(middle)) * flooded.h_central
    for share in SHARES:
        starved = point_contact(**given, cavitation="mass_conserving", supply=share * taken)
        if not starved.converged:
            raise ConvergenceError(f"The film of {share:g} of the oil has not converged: {starved.shortfall}")
        found.append(starved.h_central / flooded.h_central)
    return found


def run() -> Outcome:
    """Compare the film over the flooded one."""
    coarse, fine = (_films(grid) for grid in GRIDS)
    rows = []
    for share, film, less in zip(SHARES, fine, coarse, strict=True):
        low, high = (supplied_film(1.0, share, resistance=resistance) for resistance in SIDE_FLOW)
        reason = f"published resistance to side flow, {SIDE_FLOW[0]:g} to {SIDE_FLOW[1]:g}"
        quantity = f"film over the flooded one, {share:g} of its oil"
        rows.append(Row(quantity, "", (low, high), film, 0.0, reason, abs(film - less)))
    return Outcome(tuple(rows))
