"""The contact's equations written a second time, in SI and plain numpy, for tests to hold the solver against."""

from dataclasses import dataclass

import numpy as np
from scipy.signal import fftconvolve

from benchmarks.film.independent import fitted_flow, upwind_flow


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
    """Settlement [m] of both bodies under a pressure [Pa] on a grid of any shape."""
    ny, nx = pressure.shape
    kernel = love(np.arange(1 - nx, nx)[None, :], np.arange(1 - ny, ny)[:, None])
    full = fftconvolve(kernel, pressure, mode="full")
    return 2.0 * spacing / (np.pi * reduced_modulus) * full[ny - 1 : 2 * ny - 1, nx - 1 : 2 * nx - 1]


def gap(scene, fields):
    """Gap [m] of the loaded bodies, below the floor where they overlap."""
    x, y = fields.x[None, :], fields.y[:, None]
    shape = x**2 / (2.0 * scene.geometry.radius_x) + y**2 / (2.0 * scene.geometry.radius_y)
    settled = deformation(fields.pressure, scene.film.spacing, scene.solids.reduced_modulus)
    return fields.film.rigid_gap + shape - fields.heights + settled


def volume_flow(scene, op, fluid, film):
    """What pressure brings into each inner node and what entrainment along +x carries away from it [m/s at p = 0].

    div(rho h^3 / (12 eta) grad p) and u_e d(rho h)/dx by the scene's rule of flow, NaN on the edge of the grid.
    """
    spacing, speed = scene.film.spacing, op.entrainment_speed
    density = scene.lubricant.density(fluid)

    def viscosity(pressure):
        return scene.lubricant.viscosity(pressure, op.temperature)

    if scene.film.flux == "fitted":
        stiffness = np.pi * speed * spacing**2 / scene.solids.reduced_modulus
        ease_x, ease_y, faces = fitted_flow(film, fluid, density, viscosity, stiffness, scene.film.floor)
    else:
        ease_x, ease_y, faces = upwind_flow(film, density * film, viscosity(fluid))
    along, across = ease_x * np.diff(fluid, axis=1) / spacing, ease_y * np.diff(fluid, axis=0) / spacing
    brought, carried = np.full_like(fluid, np.nan), np.full_like(fluid, np.nan)
    brought[1:-1, 1:-1] = (np.diff(along, axis=1)[1:-1] + np.diff(across, axis=0)[:, 1:-1]) / spacing
    carried[1:-1, 1:-1] = speed * np.diff(faces, axis=1)[1:-1] / spacing
    return brought, carried


def force_beyond(x, y, pressure, gap, radius_x, radius_y):
    """Force [N] beyond the inlet edges of a grid, entrained along +x: along each ray from the contact the pressure goes
    on like distance / gap^2, the gap that of smooth, rigid parabolas from that of the edge node on.
    """
    dx, total = x[1] - x[0], 0.0
    xx, yy = np.meshgrid(x, y)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    t = 0.5 * (nodes + 1.0)
    for edge, normal in ((np.s_[1:-1, 0], xx), (np.s_[0, :], yy), (np.s_[-1, :], yy)):
        out, p, h = (field[edge][xx[edge] < 0.0] for field in (np.hypot(xx, yy), pressure, gap))
        away = np.abs(normal[edge])[xx[edge] < 0.0]
        begin = out * (1.0 + 0.5 * dx / away)  # a cell reaches half a spacing beyond its node
        r = begin[:, None] / t
        bend = ((xx[edge] / radius_x**0.5) ** 2 + (yy[edge] / radius_y**0.5) ** 2)[xx[edge] < 0.0] / out**2
        rigid = h[:, None] + 0.5 * bend[:, None] * (r**2 - out[:, None] ** 2)
        along = (r / out[:, None] * (h[:, None] / rigid) ** 2 * r * begin[:, None] / t**2) @ (0.5 * weights)
        total += float((p * along * dx * away / out**2).sum())
    return total


@dataclass(frozen=True)
class Judgement:
    """How far steady fields are from solving the equations; each number is relative and 0 for the exact answer."""

    load: float  # error of the total force
    gap: float  # largest difference between the gap that is reported and that of the pressure, in floors
    complementarity: float  # |gap - floor| on solid contacts below the hardness, mean by solid pressure, in floors
    penetration: float  # largest overlap of nodes not in contact, in floors
    film: float  # volume gained or lost where fluid alone carries / what entrainment brings and takes there
    cavity: float  # volume that should fill a node without pressure / the same
    beneath: float  # as film, on solid contacts whose fluid pressure is between zero and the total
    bounds: float  # how far 0 <= fluid <= total <= limit is violated, and fluid = total off contact, in Hertz pressures


def judge(scene, op, fields):
    """Hold the steady fields of `solve`, entrained along +x, against the equations."""
    floor, hertz = scene.film.floor, scene.hertz(op.load)
    p, f, h, solid = fields.pressure, fields.fluid_pressure, gap(scene, fields), fields.film.solid
    limit = scene.plasticity.limit(fields.cover_1, fields.cover_2, 0.0, 1.0)
    film = np.where(solid, floor, np.maximum(h, floor))
    brought, carried = volume_flow(scene, op, f, film)
    inside, empty = np.isfinite(brought), p <= 1e-6 * hertz.pressure_max
    scale = np.abs(carried[inside & ~solid & ~empty]).sum()

    def lost(where, bounded=np.abs):
        return float(bounded((brought - carried)[where & inside]).sum() / scale) if scale > 0.0 else 0.0

    below = solid & (p < limit)
    weight = (p - f)[below]
    violated = [-f.min(), (f - p).max(), (p - limit).max(), np.abs(p - f)[~solid].max(initial=0.0)]
    return Judgement(
        load=float(p.sum() * scene.film.spacing**2 / op.load - 1.0),
        gap=float(np.abs(np.maximum(h, floor) - fields.gap).max() / floor),
        complementarity=float((weight * np.abs(h - floor)[below]).sum() / max(weight.sum(), 1e-300) / floor),
        penetration=float(np.maximum(floor - h, 0.0)[~solid].max(initial=0.0) / floor),
        film=lost(~solid & ~empty),
        cavity=lost(~solid & empty, lambda r: np.maximum(r, 0.0)),
        beneath=lost(solid & (f > 0.0) & (f < p)),
        bounds=float(max(violated) / hertz.pressure_max),
    )
