"""The bound on the parts of one step: without it, numbers far from the usual would ask for a step that never ends."""

from ..errors import ConvergenceError
from ..scene import Case

MOST_PARTS = 20_000  # more than the longest steps of shipped scenes take, also where bodies store heat
MOST_TRIES = 1000  # each at most 0.95 of the one before


def check_parts(case: Case, parts: int) -> None:
    """Raise ConvergenceError if a step that has taken so many parts would take another one."""
    if parts >= MOST_PARTS:
        control = case.scene.control
        raise ConvergenceError(
            f"The step needs more than {MOST_PARTS} parts, in each of which the surfaces change by "
            f"control.change = {control.change:g} m at most, and inputs by control.input_change = "
            f"{control.input_change:g}. Raise these, or take shorter steps."
        )


def check_tries(case: Case, tries: int) -> None:
    """Raise ConvergenceError if so many parts, each shorter than the one before, were all too long."""
    if tries >= MOST_TRIES:
        op, change = case.op, case.scene.control.change
        raise ConvergenceError(
            f"At load = {op.load:g} N, speeds {op.speed_1:g} and {op.speed_2:g} m/s the surfaces change by more than "
            f"control.change = {change:g} m in any time, or by what is no number. Raise it, or lower load or sliding "
            "speed."
        )
