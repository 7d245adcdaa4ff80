"""Central films of a steel ball on glass by optical interferometry, 5 mm/s to 4 m/s."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from contact_core import ConvergenceError, point_contact
from contact_core.kernels.arrays import Array
from contact_core.laws.viscosity import AstmD341
from contact_core.quantities import CELSIUS

from .model import Outcome, Row, compared, exactly
from .tables import read

BALL, MODULUS = 9.525e-3, 2.0 / ((1.0 - 0.3**2) / 207e9 + (1.0 - 0.22**2) / 75e9)  # m; Pa, steel on glass
DENSITY = 885.0  # kg/m3 at 15 degC, assumed
USUAL = (20e-9, 30e-9)  # 1/Pa, of mineral oils: the oil's own is not given
SLOW = 1.0  # m/s, below which the oil of the inlet stays cool


@dataclass(frozen=True)
class Films:
    """Films [m] over the speed [m/s]: measured, their standard deviations, and computed."""

    speed: Array
    measured: Array
    deviation: Array
    found: Array

    def slopes(self) -> tuple[float, float]:
        """Return the exponents of speed, measured and found."""
        first, second = (float(np.polyfit(np.log(self.speed), np.log(h), 1)[0]) for h in (self.measured, self.found))
        return first, second

    def slope_error(self) -> float:
        """Return the standard error of the measured exponent, from the standard deviations of the films."""
        away = np.log(self.speed) - np.log(self.speed).mean()
        return float(np.sqrt((away**2 * (self.deviation / self.measured) ** 2).sum()) / (away**2).sum())

    def factor(self) -> tuple[float, float, float]:
        """Return the mean ratio of found to measured films, the scatter about it and the least ratio."""
        ratio = np.log(self.found / self.measured)
        return float(np.exp(ratio.mean())), float(ratio.std()), float(np.exp(ratio.min()))

    def below(self, most: float) -> "Films":
        """Return the part at lower speeds."""
        slow = self.speed < most
        return Films(self.speed[slow], self.measured[slow], self.deviation[slow], self.found[slow])


def films(coefficient: float, grid: int = 129, rows: Sequence[dict[str, float]] | None = None) -> Films:
    """Return the central films of all measured points, or of some, under a pressure coefficient [1/Pa]."""
    oil = AstmD341(67.0e-6, 18.9e-6, DENSITY, coefficient, 304.65)
    rows, found = rows or read("optical_films.csv"), []
    for row in rows:
        viscosity = float(oil(0.0, row["oil_temperature_degC"] + CELSIUS))
        speed = row["entrainment_speed_mm_s"] * 1e-3
        answer = point_contact(
            load=row["load_N"], radius_x=BALL, reduced_modulus=MODULUS, speed_1=speed, speed_2=speed,
            viscosity=viscosity, pressure_viscosity=coefficient, grid=grid, flux="fitted",
        )  # fmt: skip
        if not answer.converged:
            raise ConvergenceError(f"The film at {speed:g} m/s has not converged: {answer.shortfall}")
        found.append(answer.h_central)
    speeds, film, spread = (
        np.array([row[key] for row in rows]) for key in ("entrainment_speed_mm_s", "film_nm", "film_sd_nm")
    )
    return Films(speeds * 1e-3, film * 1e-9, spread * 1e-9, np.array(found))


def run() -> Outcome:
    """Compare slope and scatter of the slow films; the level is not judged."""
    slow = [row for row in read("optical_films.csv") if row["entrainment_speed_mm_s"] < 1e3 * SLOW]
    low, high = (films(coefficient, rows=slow) for coefficient in USUAL)
    measured, exponent = low.slopes()
    other, error = high.slopes()[1], 2.0 * low.slope_error()
    scatter = float(np.sqrt(((low.deviation / low.measured) ** 2).mean()))
    power = np.log(high.factor()[0] / low.factor()[0]) / np.log(USUAL[1] / USUAL[0])
    implied = USUAL[1] * high.factor()[0] ** (-1.0 / power)
    middle = float(np.sqrt(low.factor()[1] * high.factor()[1]))
    rows = (
        Row(
            f"exponent of speed below {SLOW:g} m/s", "", exactly(measured), 0.5 * (exponent + other), error,
            "two standard errors by the films' measured standard deviations, up to 12 % of the thinnest",
            0.5 * abs(other - exponent),
        ),
        Row(
            "rms deviation from one factor", "%", (0.0, 0.0), 100.0 * middle, 100.0 * scatter,
            "rms of the measured standard deviations",
        ),
        Row(
            "pressure coefficient that the films imply", "1/GPa", (1e9 * USUAL[0], 1e9 * USUAL[1]), 1e9 * implied, 0.0,
            "usual of mineral oils", not_judged="the oil's pressure coefficient is not given",
        ),
    )  # fmt: skip
    mean = np.sqrt(low.found * high.found)
    curve = compared(
        "central films", "entrainment speed [m/s]", "film [nm]", (low.speed, 1e9 * low.measured),
        (low.speed, 1e9 * mean), 1e9 * low.deviation, logarithmic=True,
    )  # fmt: skip
    return Outcome(rows, (curve,))
