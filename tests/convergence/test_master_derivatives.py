"""An FMU that answers for held inputs costs the coupling its order, and its derivatives give it back."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from comparison import approx
from scipy.integrate import solve_ivp

from benchmarks.models import build
from system_models.master import System, simulate


@pytest.fixture(scope="module")
def fmus(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("models")
    return {"mass": build("mass_1_force", folder), "drag": build("drag", folder, interpolates=False)}


@cache
def speed() -> float:
    """Of m x'' + d x' + k x = -c v - q v |v| at t = 1, for m = 1, k = 10, d = 0.1, c = 1, q = 2, x(0) = 1."""

    def rates(_: float, z: np.ndarray) -> list[float]:
        x, v = z
        return [v, -10.0 * x - 0.1 * v - v - 2.0 * v * abs(v)]

    return float(solve_ivp(rates, (0.0, 1.0), [1.0, 0.0], "DOP853", rtol=1e-12, atol=1e-12).y[1, -1])


def errors(fmus: dict[str, Path], known: bool, **scheme: object) -> list[float]:
    derivatives = {("drag.F", "drag.u"): "drag.dF_du"} if known else None
    system = System(fmus, [("mass.v", "drag.u"), ("drag.F", "mass.F")], derivatives=derivatives)
    ends = [simulate(system, 1.0, h, outputs=["mass.v"], **scheme)["mass.v"].values[-1] for h in (0.01, 0.005, 0.0025)]
    return [abs(end - speed()) for end in ends]


SCHEMES = [
    {"order": 1},
    {"order": 1, "algorithm": "gauss_seidel"},
    {"order": 1, "iterate": "quasi_newton", "iteration_tolerance": 1e-10},
]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_derivatives_give_the_second_order_back(fmus: dict[str, Path], scheme: dict[str, object]) -> None:
    found = errors(fmus, known=True, **scheme)
    assert np.log2(found[-2] / found[-1]) == approx(2.0, abs=0.15)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_without_them_the_order_is_one(fmus: dict[str, Path], scheme: dict[str, object]) -> None:
    found = errors(fmus, known=False, **scheme)
    assert np.log2(found[-2] / found[-1]) == approx(1.0, abs=0.15)


def test_held_inputs_without_lag_err_less(fmus: dict[str, Path]) -> None:
    assert errors(fmus, known=True)[-1] < 0.6 * errors(fmus, known=False)[-1]
