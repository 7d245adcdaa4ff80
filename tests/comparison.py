"""Comparison of numbers in SI units, where 1e-12 is a wear volume and no rounding error."""

from typing import Any

import pytest

HARD = {f"surface_{i}.microroughness.rms": "0 m" for i in (1, 2)}  # solids that touch at the floor alone


def approx(expected: Any, rel: float | None = None, abs: float | None = None, nan_ok: bool = False) -> Any:
    """Return what is equal to `expected` within a relative error, 1e-6 unless told, or an absolute one that is given.

    `pytest.approx` takes anything below 1e-12 for zero and is therefore not used in tests: ruff forbids it.
    """
    if abs is None:
        rel, abs = 1e-6 if rel is None else rel, 0.0
    return pytest.approx(expected, rel=rel, abs=abs, nan_ok=nan_ok)  # noqa: TID251
