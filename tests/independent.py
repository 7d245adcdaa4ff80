"""The contact's equations written a second time, in SI and plain numpy, for tests to hold the solver against."""

from dataclasses import dataclass

import numpy as np
from scipy.signal import fftconvolve


def love(dx, dy):
    """Integral of 1/r over a unit square cell whose centre is (dx, dy) cells away."""

    def corner(x, y):
        return x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))

    return sum(s * t * corner(dx + 0.5 * s, dy + 0.5 * t) for s in (-1, 1) for t in (-1, 1))


def love_matrix(ny, nx):
    """Dense matrix of `love` between all pairs of nodes of a grid, row by row."""
    y, x = (index.ravel() for index in np.indices((ny, nx)))
    return love(x[:, None] - x[None, :], y[:, None] - y[None, :])


def deformation(pressure, spacing, reduced_modulus):
    """Settlement [m] of both bodies under a pressure [Pa] of any size of grid."""
    ny, nx = pressure.shape
    kernel = love(np.arange(1 - nx, nx)[None, :], np.arange(1 - ny, ny)[:, None])
    full = fftconvolve(kernel, pressure, mode="full")
    return 2.0 * spacing / (np.pi * reduced_modulus) * full[ny - 1 : 2 * ny - 1, nx - 1 : 2 * nx - 1]


def gap(scene, fields):
    """Gap [m] of the loaded bodies, negative where they overlap."""
    x, y = fields.x[None, :], fields.y[:, None]
    shape = x**2 / (2.0 * scene.geometry.radius_x) + y**2 / (2.0 * scene.geometry.radius_y)
    settled = deformation(fields.pressure, scene.film.spacing, scene.solids.reduced_modulus)
    return fields.film.rigid_gap + shape - fields.heights + settled


def net_inflow(scene, op, fluid, gap, before=None, dt=None):
    """Net inflow of volume at p = 0 [m/s] into interior nodes: div(rho h^3/12 eta grad p) - u_e d(rho h)/dx - d(rho h)/dt.

    Written for entrainment along +x. `before` is rho h of `dt` ago.
    """
    spacing = scene.film.spacing
    mass = scene.lubricant.density(fluid) * gap
    flow = mass * gap**2 / (12.0 * scene.lubricant.viscosity(fluid, op.temperature))
    along = 0.5 * (flow[:, 1:] + flow[:, :-1]) * np.diff(fluid, axis=1) / spacing
    across = 0.5 * (flow[1:] + flow[:-1]) * np.diff(fluid, axis=0) / spacing
    first = 0.5 * (mass[:, :1] + mass[:, 1:2])
    carried = op.entrainment_speed * np.concatenate([first, 1.5 * mass[:, 1:] - 0.5 * mass[:, :-1]], axis=1)
    inflow = np.full_like(fluid, np.nan)
    inflow[1:-1, 1:-1] = np.diff(along, axis=1)[1:-1] + np.diff(across, axis=0)[:, 1:-1] - np.diff(carried, axis=1)[1:-1, :-1]
    inflow /= spacing
    return inflow if before is None else inflow - (mass - before) / dt


@dataclass(frozen=True)
class Judgement:
    """How far fields are from solving the equations; every number is relative and would be 0 for the exact answer."""

    load: float  # error of the total force
    intrusion: float  # |gap - floor| on solid contacts below the hardness, weighted by their solid pressure, in floors
    penetration: float  # largest overlap of nodes that are not in contact, in floors
    film: float  # volume that appears or vanishes per time on nodes with fluid pressure alone / carried through the contact
    cavity: float  # the same, on nodes without pressure that would have to fill up
    beneath: float  # the same, on solid contacts whose fluid pressure is between 0 and the total


def judge(scene, op, fields):
    """Hold the steady fields of `solve` against the equations."""
    if op.entrainment_speed < 0.0:
        raise ValueError("written for entrainment along +x")
    spacing, floor = scene.film.spacing, scene.film.floor
    p, f, h = fields.pressure, fields.fluid_pressure, gap(scene, fields)
    solid = fields.film.solid
    cap = scene.plasticity.limit(np.maximum(fields.cover_1, fields.cover_2))
    below = solid & (p < cap)
    inflow = net_inflow(scene, op, f, np.where(solid, floor, np.maximum(h, floor)))
    inside = np.isfinite(inflow)
    hertz = scene.hertz(op.load)
    centre = fields.gap[np.hypot(fields.x[None, :], fields.y[:, None]) < hertz.a].mean()
    through = op.entrainment_speed * float(centre) * 2.0 * hertz.b

    def lost(where, bounded=np.abs):
        return float(bounded(inflow[where & inside]).sum()) * spacing**2 / through

    weight = (p - f)[below]
    return Judgement(
        load=float(p.sum() * spacing**2 / op.load - 1.0),
        intrusion=float((weight * np.abs(h - floor)[below]).sum() / max(weight.sum(), 1e-300) / floor),
        penetration=float(np.maximum(floor - h, 0.0)[~solid].max(initial=0.0) / floor),
        film=lost(~solid & (p > 0.0)),
        cavity=lost(~solid & (p == 0.0), lambda r: np.maximum(r, 0.0)),
        beneath=lost(solid & (f > 0.0) & (f < p)),
    )
