"""The stopping rule of every film."""

from .problem import Problem, Solution

_LOAD_TOLERANCE = 1e-4
_COMPLEMENTARITY_TOLERANCE = 0.2
# imbalance over tolerance: the residual of a time step is corrected in the next one, but a steady film has no next one,
# and a long step must not lose much of its film
_IMBALANCE_PER_TOLERANCE = 100.0
STEADY_IMBALANCE_PER_TOLERANCE = 5.0
_IMBALANCE_PER_STEP = 6.0
_CARRIED_PER_STEP = 2.0  # where the film is carried over as it is: nothing levels out what a step leaves there


def allowed_imbalance(problem: Problem) -> float:
    """Return the largest mass imbalance over the tolerance."""
    per_step = _IMBALANCE_PER_STEP if problem.slow_mass is None else _CARRIED_PER_STEP
    return min(max(per_step * problem.per_dt, STEADY_IMBALANCE_PER_TOLERANCE), _IMBALANCE_PER_TOLERANCE)


def shortfall(
    tolerance: float, change: float, load_error: float, complementarity: float, imbalance: float, allowed: float
) -> str:
    """Return which parts of the stopping rule do not hold, or an empty text.

    `allowed` is the imbalance over the tolerance, see `allowed_imbalance`.
    """
    rules = _rules(tolerance, change, load_error, complementarity, imbalance, allowed)
    return "; ".join(f"{name} {value:.2g}, not below {most:.2g}" for name, value, most in rules if not value < most)


def excess(found: Solution, tolerance: float, problem: Problem) -> float:
    """Return the worst number of the stopping rule over its limit."""
    numbers = (found.pressure_change, found.load_error, found.complementarity, found.imbalance)
    return max(value / most for _, value, most in _rules(tolerance, *numbers, allowed_imbalance(problem)))


def _rules(
    tolerance: float, change: float, load_error: float, complementarity: float, imbalance: float, allowed: float
) -> tuple[tuple[str, float, float], ...]:
    return (
        ("pressure change", change, tolerance),
        ("load error", abs(load_error), _LOAD_TOLERANCE),
        ("distance of contacts from the floor", complementarity, _COMPLEMENTARITY_TOLERANCE),
        ("mass imbalance", imbalance, allowed * tolerance),
    )
