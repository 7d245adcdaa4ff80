"""A wavy contact in Hertz units, for the tests of the film kernels."""

import numpy as np

from contact_core.kernels.half_space import HalfSpace
from contact_core.kernels.mixed.problem import Problem

BARUS = 10.0  # viscosity at the largest Hertz pressure: exp(10)


def axis(n, side=2.4):
    return (np.arange(n) - 0.5 * (n - 1)) * side / (n - 1)


def problem(ny, nx, wave=0.0, length=0.3, library="scipy", mobility=20.0, **changes):
    """A contact of sinusoidal waviness, its smooth pressure and its half space. `changes`: other fields."""
    x, y = axis(nx), axis(ny)
    dx = x[1] - x[0]
    radius_2 = x[None, :] ** 2 + y[:, None] ** 2
    ripple = np.cos(2 * np.pi * x[None, :] / length) * np.cos(2 * np.pi * y[:, None] / length)
    table = np.linspace(0.0, 5.0, 2001)
    zeros = np.zeros((ny, nx))
    fields = dict(
        undeformed=0.5 * radius_2 - wave * ripple,
        cap=np.full((ny, nx), 5.0),
        floor=1e-3,
        spacing=dx,
        load=2.0 * np.pi / 3.0 / dx**2,
        mobility=np.full((ny, nx), mobility),
        thinned=zeros,
        per_dt=0.0,
        wedge=1.0,
        mass_old=zeros,
        fluidity=np.exp(-BARUS * table),
        density=np.ones_like(table),
        step=table[1],
        compliance=1.0,
        edge=zeros,
        weight=np.ones((ny, nx)),
    )
    case = Problem(**fields | changes)
    smooth = np.sqrt(np.maximum(1.0 - radius_2, 0.0))
    return case, smooth, HalfSpace(ny, nx, 2.0 / np.pi**2 * dx, library)
