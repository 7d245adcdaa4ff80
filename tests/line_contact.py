"""Lubricated line contacts of Moes' load and lubricant parameter, for the tests of the kernels.

Lengths are in units of l, l^2 = a^2 + 1.4 R h with Hertz's half width a and the film h of the formula, gaps in l^2 / R
and pressures in p_H a / l.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter

from contact_core.kernels.dry import solve_dry
from contact_core.kernels.half_space import PeriodicHalfSpace
from contact_core.kernels.mixed.problem import Iterate, Problem
from contact_core.reference import moes_line_film


@dataclass
class Line:
    """A problem, its half space, a Hertz-like film to start from, and its units."""

    half_space: PeriodicHalfSpace
    problem: Problem
    start: Iterate
    x: np.ndarray
    film: float  # formula's, in the unit of gaps
    moes: float  # the unit of gaps in that of Moes, R U^(1/2)

    def dry_start(self):
        """The contact without a fluid."""
        gap, q = self.problem.undeformed[1:-1], self.problem
        p, rigid, _, _ = solve_dry(self.half_space, gap, q.cap[1:-1], q.load, np.ones_like(gap), 1e-6, 1000)
        p = with_images(p)
        return Iterate(p, np.zeros_like(p), p > 0.0, rigid + q.floor)


def with_images(field):
    """Rows of images around a field [ny, nx]."""
    return np.pad(field, ((1, 1), (0, 0)), mode="wrap")


def roughness(rows, nx, seed=3):
    """Heights [rows, nx] of unit rms, the first row following the last."""
    noise = np.random.Generator(np.random.Philox(seed)).standard_normal((rows, nx))
    z = gaussian_filter(noise, 2.0, mode=("wrap", "nearest"))
    return z / z.std()


def line(load, oil, nx, heights=None, left=2.5, right=1.5, floor=1e-3, cap=30.0):
    """heights [rows, nx] and the least gap `floor`, both over the film of the formula; None: one smooth row."""
    heights = np.zeros((1, nx)) if heights is None else heights
    moes_film = moes_line_film(load, oil)
    a2 = 8.0 * load / np.pi  # (a / R)^2 U^(-1/2)
    moes = a2 + 1.4 * moes_film
    film, shrink = moes_film / moes, np.sqrt(a2 / moes)
    x = np.linspace(-left, right, nx)
    dx, table = x[1] - x[0], np.linspace(0.0, cap, 16385)
    z = with_images(heights) * film
    zeros, weight = np.zeros_like(z), np.ones_like(z)
    weight[[0, -1]] = 0.0
    problem = Problem(
        undeformed=0.5 * x**2 - z,
        cap=np.full(z.shape, cap),
        floor=floor * film,
        spacing=dx,
        load=0.5 * np.pi * len(heights) / dx,
        mobility=np.full(z.shape, moes * a2 / 24.0),
        thinned=zeros,
        per_dt=0.0,
        wedge=1.0,
        mass_old=zeros,
        fluidity=np.exp(-np.minimum(0.25 * oil * a2 / np.sqrt(moes) * table, 200.0)),
        density=1.0 + 0.3 * table / (table + 5.0),
        step=table[1],
        compliance=0.25 * np.pi * shrink**2,
        edge=zeros,
        weight=weight,
        wrapped=True,
    )
    half_space = PeriodicHalfSpace(len(heights), nx, problem.compliance * 2.0 / np.pi**2 * dx, "scipy", 8.0 / dx)
    p = np.broadcast_to(np.sqrt(np.maximum(1.0 - x**2, 0.0)), z.shape)
    p = p * (problem.load / p[1:-1].sum())
    settled = half_space.deform(p)[1, np.abs(x).argmin()]
    start = Iterate(p, p.copy(), np.zeros(z.shape, np.bool_), film + 0.5 * max(float(z.max()), 0.0) - settled)
    return Line(half_space, problem, start, x, film, moes)
