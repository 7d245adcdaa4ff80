"""The tribofilm of a point that is always rubbed: the shipped law in steps beside the printed equation."""

from dataclasses import dataclass

import numpy as np

from contact_core import Scene
from contact_core.laws.tribofilm import thickness
from contact_core.reference import ghanbarzadeh_thickness

from .model import Array, Comparison, Curve, Kind, Outcome, Row, exactly, relative, rounding

MINUTES = (1.0, 5.0, 15.0, 30.0, 60.0, 120.0)


@dataclass(frozen=True)
class Printed:
    """Constants as they are printed: temperature [K], h_max [m], factor of k_B T / h, C3 [m], C4 [1/s]."""

    temperature: float
    full: float
    factor: float
    removed: float
    removal: float
    last_digit: float  # of the factor


PRINTED = {
    "azam_case_a": Printed(363.15, 176e-9, 4.13e-16, 0.1125e-6, 6.799e-4, 0.01e-16),
    "mtm_zddp": Printed(353.15, 200e-9, 1.66e-16, 0.05432e-6, 4.022e-4, 0.01e-16),
}


def _stepped(name: str, seconds: Array) -> Array:
    """Return the film [m] of a shipped scene's law after each of the times."""
    scene = Scene.from_toml(name)
    warm = scene.operation.temperature
    film, found = (np.zeros(1), np.zeros(1)), []
    for exposed in scene.tribofilm.rate(warm) * np.diff(seconds, prepend=0.0):  # type: ignore[attr-defined]
        film = scene.tribofilm.evolve(*film, np.array([exposed]), np.zeros(1), warm)
        found.append(thickness(*film)[0])
    return np.array(found)


def run() -> Outcome:
    """Compare both sets of constants over two hours."""
    rows, curves = [], []
    for name, printed in PRINTED.items():
        fine = 60.0 * np.arange(1.0, 121.0)
        numbers = (printed.temperature, printed.full, printed.factor, printed.removed, printed.removal)
        stepped, exact = _stepped(name, fine), ghanbarzadeh_thickness(fine, *numbers)
        share = rounding((printed.factor, printed.last_digit, 1.0))
        for minute in MINUTES:
            k = round(minute) - 1
            rows.append(
                Row(
                    f"{name}, {minute:g} min", "nm", exactly(1e9 * exact[k]), 1e9 * stepped[k],
                    1e9 * relative(exact[k], share), "half of the last printed digit of the growth factor",
                )
            )  # fmt: skip
        curves.append(Curve(name, "time [min]", "film [nm]", (fine / 60.0, 1e9 * exact), (fine / 60.0, 1e9 * stepped)))
    return Outcome(tuple(rows), tuple(curves))


COMPARISON = Comparison(
    "Growth of a tribofilm that is always rubbed",
    Kind.CLOSED_FORM,
    "h = h_max (1 - exp(-k t)) - C3 (1 - exp(-C4 t)) with the constants as the thesis prints them; the law of the "
    "shipped scene in 120 steps. The constants were fitted by others to measured films.",
    "Ghanbarzadeh et al., Tribol. Int. 93 (2016) 573, doi:10.1016/j.triboint.2014.12.018; Azam, PhD thesis, University "
    "of Leeds 2018, sections 5.6 and 5.8",
    run,
)
