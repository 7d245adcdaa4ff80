"""Anderson's mixing of a linear fixed point: exact, but for its regularisation, after one round more than unknowns."""

import numpy as np

from contact_core.kernels.anderson import Anderson


def test_as_many_differences_as_unknowns_find_a_linear_fixed_point():
    random = np.random.default_rng(1)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    matrix, constant = turn @ np.diag([0.6, 0.3, -0.5]) @ turn.T, random.normal(size=3)
    exact = np.linalg.solve(np.eye(3) - matrix, constant)
    x, memory, errors = np.zeros(3), Anderson(3, 3), []
    for _ in range(8):  # more rounds than images are kept
        memory.image[:] = matrix @ x + constant
        memory.mix(x)
        errors.append(np.abs(x - exact).max() / np.abs(exact).max())
    assert errors[2] > 1e-2
    assert errors[3] < 1e-4
    assert max(errors[5:]) < 1e-12
