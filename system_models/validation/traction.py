"""Full-film friction of smooth rollers beside what twin discs measure, over sliding, load, speed and temperature."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy.optimize import brentq

from contact_core import Scene, advance, initial_state
from contact_core.quantities import CELSIUS
from contact_core.state import Outputs

from .model import Cause, Outcome, Row, exactly, relative
from .tables import read

LIMIT_BY_DISCS = {
    "lubricant.rheology.limiting_coefficient": "0.061", "lubricant.rheology.limiting_fall": "0.0055 K^-1",
}  # fmt: skip
SHARE = 0.2  # of a measured friction: what peak and slope may differ by
ROUNDED = 2.5e6  # Pa: what the 25 MPa of Dyson's formula, printed as 1e8 Pa / 4, may be off
PREDICTED = 0.005  # largest distance of the published prediction from the measured curves
FAST, PREDICTED_FAST = 8.0, 0.1  # m/s, above which peaks are predicted within this share
_LIMITED = 0.99  # of the limiting coefficient: a peak is the limit itself
_CALIBRATED = "the limiting stress of mineral oils was taken from this formula: a calibration"
SOLVED = 0.05  # most of what the level lies off solved films: docs/measured/friction.md
MEAN = np.pi / 4.0  # of Hertz's pressure, lines
_RADIUS = "20 mm"  # of two discs of 40 mm
_SMOOTH = {
    "surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "surface_1.microroughness.rms": "0 nm",
    "surface_2.microroughness.rms": "0 nm", "tribofilm.model": "none", "wear.model": "none",
    "film.model": "regression", "heat.model": "field", "geometry.radius_x": _RADIUS,
}  # fmt: skip
_CEILINGS = ("fva3", "m100")
_CEILING_SPEED, _CEILING_RATIOS = 2.0, (0.02, 0.05, 0.1, 0.2)  # m/s
_CURVES, _SPEEDS, _RATIOS = ("m100", "pao100", "n100"), (2.0, 8.0, 16.0), (0.005, 0.02, 0.05, 0.1, 0.2)
_PRESSURE, _WARM = 1e9, 333.15  # Pa, K
_CONDUCTIVITY, _DIFFUSIVITY = 46.0, 1.25e-5  # of steel [W/(m K), m2/s]
CONDUCTING = 0.14  # W/(m K), of the oil in the published prediction, at any pressure
_COEFFICIENT = {"m100": 0.047, "pao100": 0.035, "n100": 0.053}  # limiting stress over pressure, Arana et al., table 2


@dataclass(frozen=True)
class Point:
    """Rollers at a largest pressure [Pa], an entrainment speed [m/s] and an oil temperature [K]."""

    oil: str
    pressure: float
    speed: float
    temperature: float

    def __str__(self) -> str:
        warm = f"{self.temperature - CELSIUS:.0f} degC"
        return f"{self.oil}, {self.pressure * 1e-9:.2g} GPa, {warm}, {self.speed:g} m/s"

    def curve(self, ratios: tuple[float, ...], changes: Mapping[str, str] | None = None) -> list[Outputs]:
        """Return the answers of smooth discs at slide-to-roll ratios."""
        scene, load, answers = discs(self.oil, tuple((changes or {}).items())), self.load, []
        for ratio in ratios:
            one, two = self.speed * (1.0 + 0.5 * ratio), self.speed * (1.0 - 0.5 * ratio)
            op = replace(scene.operation.point, speed_1=one, speed_2=two, temperature=self.temperature, load=load)
            answers.append(advance(scene, op, initial_state(scene), 0.0)[1])
        return answers

    @property
    def load(self) -> float:
        """Load [N]."""
        scene = discs(self.oil, ())
        return float(brentq(lambda each: scene.hertz(each).pressure_max - self.pressure, 1.0, 1e6))

    @property
    def half_width(self) -> float:
        """Half width of the contact [m]."""
        return discs(self.oil, ()).hertz(self.load).a


@cache
def discs(oil: str, changes: tuple[tuple[str, str], ...]) -> Scene:
    """Return smooth steel discs under an oil."""
    return Scene.from_toml("fzg_flank", _SMOOTH | {"lubricant.set": oil} | dict(changes))


def peak(answers: list[Outputs]) -> Outputs:
    """Return the answer with the largest friction."""
    return max(answers, key=friction)


def friction(answer: Outputs) -> float:
    """Return the size of the friction coefficient."""
    return abs(answer.friction_coefficient)


def published(point: Point, film: float, ratio: float) -> float:
    """Return the friction that Arana et al. predict within `PREDICTED` of twin discs, eqs 13 and 26 to 28.

    For a film [m] and a slide-to-roll ratio: an Eyring oil at the mean pressure and temperature, its stress
    2 Lambda over the secant of ln(viscosity) to Hertz's pressure.
    """
    oil, limit, slide = discs(point.oil, ()).lubricant.viscosity, _COEFFICIENT[point.oil], ratio * point.speed
    mean = MEAN * point.pressure

    def at(temperature: float) -> float:
        stress = 2.0 * limit * point.pressure / np.log(oil(point.pressure, temperature) / oil(0.0, temperature))
        return min(stress / mean * float(np.arcsinh(oil(mean, temperature) * slide / film / stress)), limit)

    def missing(temperature: float) -> float:
        heat = at(temperature) * mean * slide
        flash = 0.53 * heat / _CONDUCTIVITY * np.sqrt(_DIFFUSIVITY * point.half_width / point.speed)
        return float(point.temperature + flash + film * heat / (8.0 * CONDUCTING) - temperature)

    return at(brentq(missing, point.temperature - 1.0, point.temperature + 600.0))


def ceilings() -> list[tuple[Point, float]]:
    """Return points under mineral oils, and the largest friction that discs have there."""
    found = []
    for row in read("traction_mineral.csv"):
        mean = 1e9 * row["pressure_mean_GPa"]
        for oil in _CEILINGS:
            point = Point(oil, mean / MEAN, _CEILING_SPEED, row["oil_temperature_degC"] + CELSIUS)
            found.append((point, 1e6 * row["largest_shear_stress_MPa"] / mean))
    return found


def points_of_curves() -> list[Point]:
    return [Point(oil, _PRESSURE, speed, _WARM) for oil in _CURVES for speed in _SPEEDS]


def _row(point: Point, what: str, measured: float, answer: Outputs, per: float, reason: str, doubt: float) -> Row:
    """Return a row: friction over `per`; `doubt`: what the reference may be off."""
    return Row(
        f"{point}: {what}",
        "", exactly(measured), friction(answer) / per, max(relative(measured, SHARE), doubt), reason,
        not_judged=_own(point, measured * per, doubt / measured),
    )  # fmt: skip


def _own(point: Point, largest: float, doubt: float) -> str:
    """Return why a reference gives no verdict: it is what the oil was given, or nobody knows it well enough."""
    if largest >= _LIMITED * _COEFFICIENT.get(point.oil, math.inf):
        return "the reference is the limiting coefficient that the oil's own was taken from"
    return f"the reference is known to {100.0 * doubt:.0f} %" if doubt > SHARE else ""


def run() -> Outcome:
    """Compare the largest friction of mineral oils, and peaks and slopes of three oils at 1 GPa."""
    rows = []
    reason = f"{100.0 * SHARE:.0f} %, or half of the last digit of the formula's 25 MPa"
    for point, measured in ceilings():
        answer = peak(point.curve(_CEILING_RATIOS))
        row = _row(point, "largest friction", measured, answer, 1.0, reason, ROUNDED / (MEAN * point.pressure))
        rows.append(replace(row, not_judged=_CALIBRATED))
    reason = (
        f"{100.0 * SHARE:.0f} %, or {PREDICTED:g}, of fast peaks {100.0 * PREDICTED_FAST:.0f} %, between prediction "
        "and measurement; the Eyring stress follows the same rule: pressures, film and heat are judged"
    )
    for point in points_of_curves():
        answers = point.curve(_RATIOS)
        found = np.array([published(point, each.h_c, ratio) for each, ratio in zip(answers, _RATIOS, strict=True)])
        largest = float(found.max())
        doubt = PREDICTED if point.speed < FAST else PREDICTED_FAST * largest
        row = _row(point, "largest friction", largest, peak(answers), 1.0, reason, doubt)
        rows.append(replace(row, cause=_warmer(point, row)))
        first = _RATIOS[0]
        slope = float(found[0]) / first
        rows.append(_row(point, f"slope to SRR {first:g}", slope, answers[0], first, reason, PREDICTED / first))
    rows.append(_remembered())
    return Outcome(tuple(rows))


def _warmer(point: Point, row: Row) -> Cause:
    """Return what the conductivity of the prediction, which does not rise with pressure, does to a peak."""
    same = {"lubricant.conductivity": f"{CONDUCTING:g} W/(m K)", "lubricant.conductivity_rise": "0 GPa^-1"}
    more = row.computed / friction(peak(point.curve(_RATIOS, same)))
    return Cause(
        f"the prediction has {CONDUCTING:g} W/(m K) at any pressure, which here takes "
        f"{100.0 * (1.0 - 1.0 / more):.0f} % of the friction away",
        row.reference[0], more * (row.reference[0] + row.uncertainty),
    )  # fmt: skip


def _remembered() -> Row:
    point = Point("pao100", 1.12e9, 2.0, 373.15)
    return Row(
        "polyalphaolefin, 1.12 GPa, 100 degC, SRR 0.5: friction", "", (0.02, 0.03), friction(point.curve((0.5,))[0]),
        0.0, "ball-on-disc rigs", not_judged="remembered, not read; another viscosity class",
    )  # fmt: skip
