"""Films of smooth points and lines beside two published formulas for each, both fitted to numerical solutions."""

import math

from contact_core import ConvergenceError, LineContact, PointContact, line_contact, point_contact
from contact_core.reference import (
    SmoothContact,
    SmoothLine,
    dowson_line,
    hamrock_dowson,
    moes_line,
    nijenbanning_venner_moes,
)

from .model import Outcome, Row, exactly, relative

RADIUS, MODULUS, VISCOSITY, COEFFICIENT = 0.01, 2.26e11, 0.04, 2.2e-8  # m, Pa, Pa s, 1/Pa
POINTS = ((100.0, 5.0), (100.0, 10.0), (1000.0, 5.0))  # M, L
LINES = ((20.0, 10.0), (100.0, 10.0))
ACCURACY = 0.03
RANGE = tuple((load, lubricant) for load in (20.0, 100.0, 1000.0) for lubricant in (5.0, 10.0))
REASON = "rms difference of the two published formulas over M from 20 to 1000, L from 5 to 10"


def _speed(lubricant: float) -> float:
    """Return the entrainment speed [m/s] of a number L = alpha E' (2 U)^0.25."""
    return 0.5 * (lubricant / (COEFFICIENT * MODULUS)) ** 4 * MODULUS * RADIUS / VISCOSITY


def _point_of(load: float, lubricant: float) -> SmoothContact:
    speed = _speed(lubricant)
    force = load * (2.0 * VISCOSITY * speed / (MODULUS * RADIUS)) ** 0.75 * MODULUS * RADIUS**2
    return SmoothContact(force, speed, VISCOSITY, COEFFICIENT, RADIUS, RADIUS, MODULUS)


def _line_of(load: float, lubricant: float) -> SmoothLine:
    speed = _speed(lubricant)
    force = load * (2.0 * VISCOSITY * speed / (MODULUS * RADIUS)) ** 0.5 * MODULUS * RADIUS
    return SmoothLine(force, speed, VISCOSITY, COEFFICIENT, RADIUS, MODULUS)


def _spread(differences: list[float]) -> float:
    return math.sqrt(sum(difference**2 for difference in differences) / len(differences))


def _point(load: float, lubricant: float) -> Row:
    contact, speed = _point_of(load, lubricant), _speed(lubricant)
    found = point_contact(
        load=contact.load, radius_x=RADIUS, reduced_modulus=MODULUS, speed_1=speed, speed_2=speed,
        viscosity=VISCOSITY, pressure_viscosity=COEFFICIENT, viscosity_law="barus", density_law="none",
        accuracy=ACCURACY,
    )  # fmt: skip
    cases = [_point_of(*numbers) for numbers in RANGE]
    apart = _spread([hamrock_dowson(case)[0] / nijenbanning_venner_moes(case) - 1.0 for case in cases])
    return _row(f"point, M = {load:g}, L = {lubricant:g}", nijenbanning_venner_moes(contact), apart, found)


def _line(load: float, lubricant: float) -> Row:
    contact, speed = _line_of(load, lubricant), _speed(lubricant)
    found = line_contact(
        load=contact.load, radius=RADIUS, reduced_modulus=MODULUS, speed_1=speed, speed_2=speed,
        viscosity=VISCOSITY, pressure_viscosity=COEFFICIENT, viscosity_law="barus", density_law="none",
        accuracy=ACCURACY,
    )  # fmt: skip
    cases = [_line_of(*numbers) for numbers in RANGE]
    apart = _spread([dowson_line(case)[0] / moes_line(case) - 1.0 for case in cases])
    return _row(f"line, M = {load:g}, L = {lubricant:g}", moes_line(contact), apart, found)


def _row(quantity: str, formula: float, apart: float, found: PointContact | LineContact) -> Row:
    if not found.converged:
        raise ConvergenceError(f"{quantity}: {found.shortfall}")
    error = found.error_estimate["h_central"]
    return Row(
        quantity, "nm", exactly(1e9 * formula), 1e9 * found.h_central, 1e9 * relative(formula, apart), REASON,
        1e9 * error,
    )  # fmt: skip


def run() -> Outcome:
    """Compare incompressible oils under Barus' law, as the formulas are for."""
    return Outcome(tuple([_point(*numbers) for numbers in POINTS] + [_line(*numbers) for numbers in LINES]))
