"""When the solution of a film counts as converged."""

from .problem import Solution

_LOAD_TOLERANCE = 1e-4
_COMPLEMENTARITY_TOLERANCE = 0.2
_IMBALANCE_PER_TOLERANCE = 100.0  # what a time step still owes is made up for in the next one...
_STEADY_IMBALANCE_PER_TOLERANCE = 5.0  # ...but a steady film has no next one,
_OWED_PER_STEP = 6.0  # and a long step must not lose much of its film


def shortfall(
    tolerance: float, change: float, load_error: float, complementarity: float, imbalance: float, per_dt: float
) -> str:
    """The stopping rule of every film: what is short of it, in words, or nothing. `per_dt`: 1 / time step or 0."""
    rules = _rules(tolerance, change, load_error, complementarity, imbalance, per_dt)
    return "; ".join(f"{name} {value:.2g}, not below {most:.2g}" for name, value, most in rules if not value < most)


def excess(found: Solution, tolerance: float, per_dt: float) -> float:
    """How many times the stopping rule's worst number is above its limit."""
    numbers = (found.pressure_change, found.load_error, found.complementarity, found.imbalance)
    return max(value / most for _, value, most in _rules(tolerance, *numbers, per_dt))


def _rules(
    tolerance: float, change: float, load_error: float, complementarity: float, imbalance: float, per_dt: float
) -> tuple[tuple[str, float, float], ...]:
    least = _STEADY_IMBALANCE_PER_TOLERANCE
    owed = tolerance * min(max(_OWED_PER_STEP * per_dt, least), _IMBALANCE_PER_TOLERANCE)
    return (
        ("pressure change", change, tolerance),
        ("load error", abs(load_error), _LOAD_TOLERANCE),
        ("distance of contacts from the floor", complementarity, _COMPLEMENTARITY_TOLERANCE),
        ("mass imbalance", imbalance, owed),
    )
