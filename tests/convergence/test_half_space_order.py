import numpy as np
from independent import deformation

from contact_core.kernels.half_space import HalfSpace

# Hertz units: lengths a, pressures p_H, heights a^2 / R


def error(n, side=2.5):
    """Largest error of the parabola that a Hertz pressure presses, over the contact."""
    spacing = side / (n - 1)
    x = (np.arange(n) - 0.5 * (n - 1)) * spacing
    r2 = x[None, :] ** 2 + x[:, None] ** 2
    fine = (np.arange(8) + 0.5) / 8.0 - 0.5  # cell means: the kernel's pressures are constant on cells
    p = np.mean(
        [
            np.sqrt(np.maximum(1.0 - (x[None, :] + u * spacing) ** 2 - (x[:, None] + v * spacing) ** 2, 0.0))
            for u in fine
            for v in fine
        ],
        axis=0,
    )
    settled = HalfSpace(n, n, 2.0 / np.pi**2 * spacing, "scipy").deform(p)
    return np.abs(settled - (1.0 - 0.5 * r2))[r2 < 0.9].max()


def test_the_hertz_pressure_presses_a_parabola_to_second_order():
    errors = [error(n) for n in (33, 65, 129)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert (orders > 1.7).all()
    assert errors[-1] < 2e-4


def test_heights_in_metres_are_those_of_the_formula():
    """The product's Hertz units against Love's integral in SI, E' = 2 / sum (1 - v^2)/E."""
    n, a, radius, modulus = 33, 172e-6, 10e-3, 230.47e9
    spacing = 3.0 * a / (n - 1)
    p_h = a * modulus / (np.pi * radius)
    p = np.random.Generator(np.random.Philox(4)).random((n, n))
    scaled = HalfSpace(n, n, 2.0 / np.pi**2 * spacing / a, "scipy").deform(p) * a**2 / radius
    assert np.abs(scaled - deformation(p * p_h, spacing, modulus)).max() < 1e-12 * scaled.max()
