"""Stresses of load cycles: `kernels.load_cycle`."""

import numpy as np
import pytest
from comparison import approx
from scipy.optimize import nnls

from contact_core.errors import ContactError
from contact_core.kernels.load_cycle import cycle_of
from contact_core.kernels.smallest_sphere import PRECISION, smallest_sphere

XX, YY, ZZ, YZ, XZ, XY = range(6)
FREE = np.zeros(6)
SLOPE = 0.3
PHASE = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)


def history_of(**components):
    """A history of one point, [n, 6, 1]."""
    columns = {"xx": XX, "yy": YY, "zz": ZZ, "yz": YZ, "xz": XZ, "xy": XY}
    values = np.zeros((max(np.size(value) for value in components.values()), 6, 1))
    for name, value in components.items():
        values[:, columns[name], 0] = value
    return values


def measured(history, unloaded=FREE, slope=SLOPE):
    cycle = cycle_of(history, unloaded, slope)
    return [float(field[0]) for field in cycle]


@pytest.mark.parametrize("component", ["yz", "xz", "xy"])
def test_torsion_alternates_by_its_amplitude_and_pulsates_by_half_its_height(component):
    assert measured(history_of(**{component: [1e9, -1e9]})) == approx([1e9, 0.0, 1e9], abs=1e-6)
    assert measured(history_of(**{component: [0.2e9, 1e9]})) == approx([0.5e9, 0.0, 0.5e9], abs=1e-6)  # from unloaded


@pytest.mark.parametrize("component", ["xx", "yy", "zz"])
def test_tension_has_the_amplitude_and_the_hydrostatic_stress_of_tension(component):
    root = np.sqrt(3.0)
    alternating = [1e9 / root, 1e9 / 3.0, 0.5e9 + SLOPE * 1e9 / 3.0]
    assert measured(history_of(**{component: [1e9, -1e9]})) == approx(alternating, rel=1e-8)
    pulsating = [0.5e9 / root, 1e9 / 3.0, 0.25e9 + SLOPE * 1e9 / 3.0]
    assert measured(history_of(**{component: [1e9]})) == approx(pulsating, rel=1e-8)
    pressed = [0.5e9 / root, 0.0, 0.25e9]  # at rest the hydrostatic stress is highest, and the shear as large
    assert measured(history_of(**{component: [-1e9]})) == approx(pressed, rel=1e-8, abs=1e-3)


@pytest.mark.parametrize(("tension", "torsion"), [(1.0, 0.8), (1.0, 1.0 / np.sqrt(3.0)), (1.0, 0.3)])
def test_tension_and_torsion_out_of_phase_have_the_larger_of_their_amplitudes(tension, torsion):
    """The deviators lie on an ellipse."""
    found = measured(history_of(xx=tension * np.cos(PHASE), xy=torsion * np.sin(PHASE)))
    assert found[0] == approx(max(tension / np.sqrt(3.0), torsion), rel=2.0 * PRECISION)
    in_phase = measured(history_of(xx=tension * np.cos(PHASE), xy=torsion * np.cos(PHASE)))
    assert in_phase[0] == approx(np.sqrt(tension**2 / 3.0 + torsion**2), rel=2.0 * PRECISION)


def test_pressure_from_all_sides_has_no_shear():
    history = history_of(xx=[-1e9, 2e9], yy=[-1e9, 2e9], zz=[-1e9, 2e9])
    assert measured(history) == approx([0.0, 2e9, SLOPE * 2e9], abs=1e-6)


def test_a_residual_stress_counts_as_one_more_instant():
    residual = np.array([-4e8, -4e8, 0.0, 0.0, 0.0, 0.0])
    loaded = history_of(xz=[1e9])[0, :, 0] + residual
    assert measured(loaded[None, :, None], residual)[0] == approx(0.5e9, rel=1e-9)
    assert measured(loaded[None, :, None])[0] > 0.5e9
    assert measured(loaded[None, :, None], residual)[1] == approx(-8e8 / 3.0, rel=1e-9)


def test_a_rotation_of_the_axes_or_another_order_of_the_instants_changes_nothing():
    rng = np.random.default_rng(3)
    history = rng.normal(size=(9, 6, 50))
    tensor = history[:, [[XX, XY, XZ], [XY, YY, YZ], [XZ, YZ, ZZ]]]
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turned = np.einsum("ia,jb,nabm->nijm", turn, turn, tensor)
    rotated = np.stack([turned[:, i, j] for i, j in ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))], axis=1)
    found = cycle_of(history, FREE, SLOPE)
    for other in (cycle_of(rotated, FREE, SLOPE), cycle_of(rng.permutation(history), FREE, SLOPE)):
        for one, two in zip(found, other, strict=True):
            assert two == approx(one, rel=1e-8)


def test_dang_vans_shear_is_half_the_difference_of_the_principal_stresses_of_a_cycle_about_zero():
    rng = np.random.default_rng(4)
    half = rng.normal(size=(5, 6, 40))
    history = np.concatenate((half, -half))
    tensor = history[:, [[XX, XY, XZ], [XY, YY, YZ], [XZ, YZ, ZZ]]].transpose(0, 3, 1, 2)
    principal = np.linalg.eigvalsh(tensor)
    shear, mean = 0.5 * (principal[..., 2] - principal[..., 0]), principal.mean(axis=-1)
    for slope in (0.0, 0.5):
        expected = (shear + slope * mean).max(axis=0)
        assert cycle_of(history, FREE, slope).dang_van == approx(expected, rel=1e-7)


def line_contact(x, z, p0):
    """Stress xx, zz, xz below Hertz's line contact of half width 1: Johnson, Contact Mechanics, 1985, section 4.2."""
    a = 1.0 - x * x + z * z
    b = np.sqrt(a * a + 4.0 * x * x * z * z)
    m, n = np.sqrt(0.5 * (b + a)), np.sign(x) * np.sqrt(0.5 * (b - a))
    ratio = (z * z + n * n) / (m * m + n * n)
    return -p0 * (m * (1.0 + ratio) - 2.0 * z), -p0 * m * (1.0 - ratio), -p0 * n * (m * m - z * z) / (m * m + n * n)


def test_rolling_shears_alternately_by_a_quarter_of_hertzs_pressure_at_half_the_half_width():
    x, depths = np.linspace(-4.0, 4.0, 4001), np.linspace(0.3, 0.7, 81)
    shear = np.array([line_contact(x, z, 1.0)[2] for z in depths])
    history = np.zeros((x.size, 6, depths.size))
    history[:, XZ] = shear.T
    found = cycle_of(history, FREE, SLOPE).shear
    assert found.max() == approx(0.25, rel=1e-4)
    assert depths[found.argmax()] == approx(0.5, rel=0.011)


def test_the_largest_amplitude_in_rolling_is_that_of_the_orthogonal_shear():
    """The other stresses lie within the sphere about both shears; 24 instants find what 2001 do within 2 %."""
    depths = np.linspace(0.2, 1.5, 27)
    found = []
    for count in (24, 2001):
        x = np.linspace(-3.0, 3.0, count)
        history = np.zeros((count, 6, depths.size))
        for i, z in enumerate(depths):
            xx, zz, xz = line_contact(x, z, 1e9)
            history[:, [XX, YY, ZZ, XZ], i] = np.stack((xx, 0.3 * (xx + zz), zz, xz), axis=1)
        found.append(cycle_of(history, FREE, 0.0).shear)
    assert found[0] == approx(found[1], rel=0.02)
    assert found[1].max() == approx(0.25e9, rel=1e-4)
    assert depths[found[1].argmax()] == approx(0.5, rel=1e-12)


KINDS = {
    "anywhere": lambda rng, n: rng.normal(size=(n, 5)),
    "on a line": lambda rng, n: rng.normal(size=(n, 1)) * rng.normal(size=(1, 5)),
    "in a plane": lambda rng, n: rng.normal(size=(n, 2)) @ rng.normal(size=(2, 5)),
    "almost in a plane": lambda rng, n: rng.normal(size=(n, 5)) * [1.0, 1.0, 1e-7, 1e-7, 1e-7],
    "on a lattice": lambda rng, n: rng.integers(-2, 3, size=(n, 5)).astype(float),
    "on a sphere": lambda rng, n: (lambda x: x / np.linalg.norm(x, axis=1)[:, None])(rng.normal(size=(n, 5))),
    "twice": lambda rng, n: np.repeat(rng.normal(size=(n // 2 + 1, 5)), 2, axis=0),
    "far away": lambda rng, n: 1e4 + rng.normal(size=(n, 5)),
}


@pytest.mark.parametrize("kind", KINDS)
def test_no_sphere_around_the_points_is_smaller(kind):
    """Weights u of the points on the sphere bound all squared radii: sum u |x - sum u x|^2."""
    rng = np.random.default_rng(5)
    for _ in range(40):
        x = KINDS[kind](rng, int(rng.integers(2, 33)))
        centre = np.empty(5)
        radius = smallest_sphere(x, centre, np.empty(7, np.int64), np.empty(7))
        distance = np.linalg.norm(x - centre, axis=1)
        assert distance.max() <= radius * (1.0 + 1e-12)
        on = x[distance >= radius * (1.0 - 1e-6)]
        equations = np.vstack(((on - centre).T / radius, np.ones(len(on))))
        u = nnls(equations, np.array([0.0] * 5 + [1.0]))[0]
        u /= u.sum()
        bound = np.sqrt(u @ ((on - u @ on) ** 2).sum(axis=1))
        assert radius <= bound * (1.0 + 2.0 * PRECISION)


def test_a_stress_that_is_no_number_is_refused():
    with pytest.raises(ContactError, match="not finite"):
        cycle_of(np.full((3, 6, 2), np.nan), FREE, SLOPE)
