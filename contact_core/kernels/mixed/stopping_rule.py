"""The stopping rule of every film."""

from .problem import Solution

_LOAD_TOLERANCE = 1e-4
_COMPLEMENTARITY_TOLERANCE = 0.2
# imbalance over tolerance: the residual of a time step is corrected in the next one, but a steady film has no next one,
# and a long step must not lose much of its film
_IMBALANCE_PER_TOLERANCE = 100.0
_STEADY_IMBALANCE_PER_TOLERANCE = 5.0
_IMBALANCE_PER_STEP = 6.0


def shortfall(
    tolerance: float, change: float, load_error: float, complementarity: float, imbalance: float, per_dt: float
) -> str:
    """Return which parts of the stopping rule do not hold, or an empty text. `per_dt`: 1 / time step or 0."""
    rules = _rules(tolerance, change, load_error, complementarity, imbalance, per_dt)
    return "; ".join(f"{name} {value:.2g}, not below {most:.2g}" for name, value, most in rules if not value < most)


def excess(found: Solution, tolerance: float, per_dt: float) -> float:
    """Return the worst number of the stopping rule over its limit."""
    numbers = (found.pressure_change, found.load_error, found.complementarity, found.imbalance)
    return max(value / most for _, value, most in _rules(tolerance, *numbers, per_dt))


def _rules(
    tolerance: float, change: float, load_error: float, complementarity: float, imbalance: float, per_dt: float
) -> tuple[tuple[str, float, float], ...]:
    least = _STEADY_IMBALANCE_PER_TOLERANCE
    most = tolerance * min(max(_IMBALANCE_PER_STEP * per_dt, least), _IMBALANCE_PER_TOLERANCE)
    return (
        ("pressure change", change, tolerance),
        ("load error", abs(load_error), _LOAD_TOLERANCE),
        ("distance of contacts from the floor", complementarity, _COMPLEMENTARITY_TOLERANCE),
        ("mass imbalance", imbalance, most),
    )
