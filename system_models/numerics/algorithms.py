"""Outputs of the running step that the FMUs see: a coupling scheme is one function and one entry of `ALGORITHMS`.

It returns, from the FMUs that have made the step so far, those whose new outputs the next one sees.
"""

from collections.abc import Callable, Sequence


def jacobi(stepped: Sequence[str]) -> Sequence[str]:
    """Return no FMU: all make the step from its beginning."""
    return ()


def gauss_seidel(stepped: Sequence[str]) -> Sequence[str]:
    """Return all FMUs that have made the step."""
    return stepped


ALGORITHMS: dict[str, Callable[[Sequence[str]], Sequence[str]]] = {"jacobi": jacobi, "gauss_seidel": gauss_seidel}
