"""Solutions of the coupled systems, from their equations as a whole, independent of the FMUs."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import expm

Floats = NDArray[np.float64]


def _linear(M: Floats, K: Floats, d: Floats, z0: Floats, rest: Floats, times: ArrayLike) -> Floats:
    """Solution of M x'' + d x' + K (x - rest) = 0 at `times`; rows (x, v) from z0 = (x, v)(0)."""
    n = len(M)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, d)]])
    shift = np.concatenate([rest, np.zeros(n)])
    return np.array([shift + expm(A * t) @ (z0 - shift) for t in np.atleast_1d(times)])


def two_mass(
    times: ArrayLike,
    m: float = 1.0,
    k: float = 10.0,
    d: float = 0.1,
    kc: float = 10.0,
    dc: float = 0.1,
    x1: float = 1.0,
) -> Floats:
    """Two equal masses, each on spring and damper to the ground, coupled by kc and dc; columns x1, x2, v1, v2."""
    stiffness = np.array([[k + kc, -kc], [-kc, k + kc]])
    damping = np.array([[d + dc, -dc], [-dc, d + dc]])
    return _linear(m * np.eye(2), stiffness, damping, np.array([x1, 0.0, 0.0, 0.0]), np.zeros(2), times)


def quarter_car(times: ArrayLike, road: float = 0.1) -> Floats:
    """Wheel and chassis after a step of the road at t = 0; columns x_wheel, x_chassis, v_wheel, v_chassis."""
    m_wheel, m_chassis, k_wheel, k, d = 40.0, 400.0, 150e3, 15e3, 1e3
    stiffness = np.array([[k_wheel + k, -k], [-k, k]])
    damping = np.array([[d, -d], [-d, d]])
    return _linear(np.diag([m_wheel, m_chassis]), stiffness, damping, np.zeros(4), np.array([road, road]), times)


def stiff_contact(times: ArrayLike, x0: float = 0.0, v0: float = 0.0) -> Floats:
    """Point mass that 300 N press into the contact; columns x, v. At rest: x = 1.0795e-6 m."""
    m, F0, x_ref, c = 1e-3, 300.0, 1.0795e-6, 50.0

    def rates(_: float, z: Floats) -> list[float]:
        x, v = z
        force = max(F0 * (x / x_ref) ** 1.5 + c * v, 0.0) if x > 0.0 else 0.0
        return [v, (F0 - force) / m]

    return _integrated(rates, [x0, v0], times, [1e-18, 1e-14])


def stick_slip(times: ArrayLike, x0: float = 0.0, v0: float = 0.0, u_r: float = 0.01) -> Floats:
    """Block on a belt of 0.1 m/s under falling friction; columns x, v."""
    m, k, v_belt, N, mu_s, mu_d, u_s = 1.0, 50.0, 0.1, 10.0, 0.4, 0.25, 0.1

    def rates(_: float, z: Floats) -> list[float]:
        x, v = z
        u = v - v_belt
        mu = (mu_d + (mu_s - mu_d) * np.exp(-abs(u) / u_s)) * np.tanh(u / u_r)
        return [v, (-k * x - N * mu) / m]

    return _integrated(rates, [x0, v0], times, 1e-13)


def _integrated(rates, z0: list[float], times: ArrayLike, atol: float | list[float]) -> Floats:
    """Solution from t = 0 at `times`, to twelve digits."""
    at = np.atleast_1d(np.asarray(times, float))
    solution = solve_ivp(rates, (0.0, max(at.max(), 1e-300)), z0, "DOP853", at, rtol=1e-12, atol=atol)
    if not solution.success:
        raise RuntimeError(solution.message)
    return solution.y.T
