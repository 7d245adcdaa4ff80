"""Measures of stress tensors, held against matrices and their eigenvalues by LAPACK."""

import numpy as np
import pytest
from comparison import approx

from contact_core.kernels.stress_measures import hydrostatic, largest_shear, principal, second_invariant, von_mises


def matrices(stress):
    xx, yy, zz, yz, xz, xy = stress
    return np.moveaxis(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), (0, 1), (-2, -1))


def anything(scale=1.0):
    return scale * np.random.Generator(np.random.Philox(5)).normal(size=(6, 4, 5, 7))


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e9])
def test_principal_stresses_are_eigenvalues_from_the_largest_down(scale):
    stress = anything(scale)
    found = principal(stress)
    expected = np.moveaxis(np.linalg.eigvalsh(matrices(stress)), -1, 0)[::-1]
    assert found == approx(expected, abs=1e-12 * scale)
    assert (np.diff(found, axis=0) <= 0.0).all()
    assert largest_shear(stress) == approx(0.5 * (expected[0] - expected[2]), abs=1e-12 * scale)


@pytest.mark.parametrize(
    "values", [(0, 0, 0), (1, 1, 1), (-2, -2, -2), (3, 1, 1), (1, 1, -4), (1, 0, 0), (0, 0, -1), (1e9, 1e9 - 1, -1e9)]
)
def test_principal_stresses_that_agree_are_found(values):
    turn, _ = np.linalg.qr(np.random.Generator(np.random.Philox(9)).normal(size=(3, 3)))
    matrix = turn @ np.diag(values) @ turn.T
    stress = np.array([matrix[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))])
    size = max(map(abs, values)) or 1.0
    for given in (stress, np.array([*values, 0.0, 0.0, 0.0], dtype=float)):
        assert principal(given) == approx(np.array(values, dtype=float), abs=5e-8 * size)
    assert principal(np.full(6, 1e-200)).shape == (3,)


def test_von_mises_is_the_norm_of_the_deviator():
    stress = anything()
    tensor = matrices(stress)
    mean = np.trace(tensor, axis1=-2, axis2=-1) / 3.0
    deviator = tensor - mean[..., None, None] * np.eye(3)
    assert hydrostatic(stress) == approx(mean, abs=1e-15)
    assert second_invariant(stress) == approx(0.5 * (deviator**2).sum(axis=(-2, -1)), rel=1e-13)
    assert von_mises(stress) == approx(np.sqrt(1.5 * (deviator**2).sum(axis=(-2, -1))), rel=1e-13)


def test_pure_tension_and_pure_shear_have_the_values_of_their_definitions():
    tension, shear = np.array([[7.0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, -7.0]])
    measures = [[measure(stress) for measure in (von_mises, largest_shear, hydrostatic)] for stress in (tension, shear)]
    assert measures[0] == approx([7.0, 3.5, 7.0 / 3.0], rel=1e-14)
    assert measures[1] == approx([7.0 * 3**0.5, 7.0, 0.0], abs=1e-14)
    assert principal(shear) == approx(np.array([7.0, 0.0, -7.0]), abs=1e-14)
