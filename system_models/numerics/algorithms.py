"""Outputs of the running step that the FMUs see: a coupling scheme is one function and one entry of `ALGORITHMS`.

A scheme returns, from the FMUs that have made the step so far in the sequence, those whose new outputs the next one
sees. The outputs of all others are known at the beginning of the step only.
"""

from collections.abc import Callable, Sequence


def jacobi(stepped: Sequence[str]) -> Sequence[str]:
    """Return no FMU: all make the step from its beginning."""
    return ()


def gauss_seidel(stepped: Sequence[str]) -> Sequence[str]:
    """Return all FMUs that have made the step."""
    return stepped


ALGORITHMS: dict[str, Callable[[Sequence[str]], Sequence[str]]] = {"jacobi": jacobi, "gauss_seidel": gauss_seidel}
