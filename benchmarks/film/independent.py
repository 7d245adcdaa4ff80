"""An independent implementation of the equations of a film: residuals of a solution, without solving."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from scipy.signal import fftconvolve

from contact_core import ContactFields, OperatingPoint, Scene
from contact_core.calls.point_contact import PointContact
from contact_core.reference import SmoothContact, hertz_point, nijenbanning_venner_moes

FLOOR = 1e-9  # m
# what an answer called converged must be within
LIMITS = {"force": 2e-3, "imbalance": 0.1, "complementarity": 0.3, "cavity": 0.01, "gap": 0.01, "bounds": 1e-9}

Array = np.ndarray


@dataclass(frozen=True)
class Answer:
    """A solution of a contact, in SI, entrained along +x. Arrays [ny, nx]."""

    x: Array
    y: Array
    pressure: Array
    fluid: Array
    solid: Array  # in contact
    film: Array  # gap, at least the floor
    rigid: float
    heights: Array
    load: float
    radius: float  # along x
    radius_y: float
    modulus: float
    speed: float
    hardness: float | Array
    size: float  # half width of what carries the load
    viscosity: Callable[[Array], Array]
    before: Array | None = None  # density ratio times film, one time step ago
    step: float = np.inf
    fitted: bool = True  # flow through faces fitted to cells; else second order upstream

    def mirrored(self) -> "Answer":
        """Seen from the other side."""
        names = ("pressure", "fluid", "solid", "film", "heights", "before")
        turned = {name: values[:, ::-1] for name in names if (values := getattr(self, name)) is not None}
        return replace(self, x=-self.x[::-1], speed=-self.speed, **turned)


def limit(name: str, beyond: float) -> float:
    """The most that a number may be. The solver's formula for what lies beyond the grid is good to 5 %."""
    return LIMITS[name] + (0.05 * abs(beyond) if name == "force" else 0.0)


@dataclass(frozen=True)
class Judgement:
    """Residuals of a solution: 0 for the exact one."""

    force: float  # force on the grid and beyond it, relative
    beyond: float  # share of it beyond the grid
    imbalance: float  # mass gained or lost in l / u by the film, relative, weighted by pressure
    cavity: float  # load that nodes without pressure would carry if their inflow were dammed up, relative
    complementarity: float  # |gap - floor| of contacts, overlap of others, mean by pressure, in floors
    beneath: float  # as imbalance, of the fluid under the contacts
    gap: float  # between the film reported and that of the pressure, in floors
    bounds: float  # 0 <= fluid <= total <= hardness, fluid = total off contact; in Hertz pressures

    @property
    def failures(self) -> list[str]:
        """Names of the limits that are exceeded."""
        return [name for name in LIMITS if not abs(getattr(self, name)) < limit(name, self.beyond)]


@lru_cache(maxsize=4)
def _love(ny: int, nx: int) -> Array:
    """Integrals of 1/r over a unit cell at every distance on the grid."""
    x, y = np.arange(1 - nx, nx)[None, :], np.arange(1 - ny, ny)[:, None]

    def corner(u: Array, v: Array) -> Array:
        return u * np.arcsinh(v / np.abs(u)) + v * np.arcsinh(u / np.abs(v))

    return sum(s * t * corner(x + 0.5 * s, y + 0.5 * t) for s in (-1, 1) for t in (-1, 1))


def deformation(pressure: Array, spacing: float, modulus: float) -> Array:
    """Settlement [m] of both bodies."""
    return 2.0 * spacing / (np.pi * modulus) * fftconvolve(pressure, _love(*pressure.shape), mode="same")


def roelands(viscosity: float, alpha: float) -> Callable[[Array], Array]:
    """Viscosity over pressure."""
    span = np.log(viscosity) + 9.67
    return lambda p: viscosity * np.exp(np.minimum(span * ((1.0 + 5.1e-9 * p) ** (alpha / 5.1e-9 / span) - 1.0), 500.0))


def load_beyond(at: Answer, gap: Array) -> float:
    """Force [N] beyond the inlet edges: p goes on like -x / h^2 under rigid parabolas, ray by ray from the contact."""
    dx, total = at.x[1] - at.x[0], 0.0
    nodes, weights = np.polynomial.legendre.leggauss(60)
    t, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    xx, yy = np.meshgrid(at.x, at.y)
    for edge, normal in ((np.s_[1:-1, 0], xx), (np.s_[0, :], yy), (np.s_[-1, :], yy)):
        x, p, h = xx[edge], at.pressure[edge], gap[edge]
        radius, distance = np.hypot(x, yy[edge]), np.abs(normal[edge])
        begin = radius * (1.0 + 0.5 * dx / distance)  # the cells of the edge reach half a spacing beyond their nodes
        r = begin[:, None] / t
        curvature = ((x / radius) ** 2 / at.radius + (yy[edge] / radius) ** 2 / at.radius_y)[:, None]
        film = h[:, None] + 0.5 * curvature * (r**2 - radius[:, None] ** 2)
        decay = r / radius[:, None] * (h[:, None] / film) ** 2
        ray = (decay * r * begin[:, None] / t**2) @ weights
        total += float((p * ray * dx * distance / radius**2)[x < 0.0].sum())
    return total


def along_cells(film: Array) -> tuple[Array, Array]:
    """1 / I_3 and I_2 / I_3, I_k the mean of film^-k over each cell along x [ny, nx - 1], the film a cubic there.

    It goes on as a parabola beyond the grid, and stays between 0.6 times the smaller and 1.5 times the larger end.
    """
    before, after = film[:, :3] @ [3.0, -3.0, 1.0], film[:, -3:] @ [1.0, -3.0, 3.0]
    ends = np.column_stack([before, film, after])
    points, weights = np.polynomial.legendre.leggauss(4)
    cubic = np.vander(0.5 + 0.5 * points, 4) @ np.linalg.inv(np.vander([-1.0, 0.0, 1.0, 2.0], 4))
    inside = np.einsum("qk,jik->qji", cubic, np.lib.stride_tricks.sliding_window_view(ends, 4, axis=1))
    both = np.stack([film[:, :-1], film[:, 1:]])
    inside = np.clip(inside, 0.6 * both.min(axis=0), 1.5 * both.max(axis=0))
    square, cube = (np.tensordot(0.5 * weights, inside**-k, axes=1) for k in (2, 3))
    return 1.0 / cube, square / cube


def mean_fluidity(viscosity: Callable[[Array], Array], one: Array, other: Array) -> Array:
    """Mean of 1 / viscosity over the pressures between two, by quadrature."""
    points, weights = np.polynomial.legendre.leggauss(32)
    parts = (0.5 + 0.5 * points)[:, None, None]
    return np.tensordot(0.5 * weights, 1.0 / viscosity(one + parts * (other - one)), axes=1)


def fitted_flow(
    film: Array, fluid: Array, density: Array, viscosity: Callable[[Array], Array], stiffness: float, floor: float
) -> tuple[Array, Array, Array]:
    """Ease of the flow through faces along and across x [m2 s/kg times m], and the mass carried along per speed [m].

    Exact for a flow that is constant in a cell, where that ease e is large against `stiffness` [the same unit]; carried
    along by third order upstream where it is small, and beside nodes at the floor: s^2 / (1 + s^2) is the former's
    share, s = e / stiffness.
    """
    dense, mass = 0.5 * (density[:, 1:] + density[:, :-1]), density * film
    ease, width = along_cells(film)
    ease = ease * dense * mean_fluidity(viscosity, fluid[:, :-1], fluid[:, 1:]) / 12.0
    open_gap = np.minimum(film[:, :-1], film[:, 1:]) > floor
    share = np.where(open_gap, ease**2 / (ease**2 + stiffness**2), 0.0)
    left, right = mass[:, :-1], mass[:, 1:]
    before = np.column_stack([2.0 * mass[:, 0] - mass[:, 1], mass[:, :-2]])
    upstream = np.clip((3.0 * right + 6.0 * left - before) / 8.0, np.minimum(left, right), np.maximum(left, right))
    one, other = film[:-1], film[1:]
    across = 2.0 * (one * other) ** 2 / (one + other) * 0.5 * (density[1:] + density[:-1])
    across = across * mean_fluidity(viscosity, fluid[:-1], fluid[1:]) / 12.0
    return ease, across, share * dense * width + (1.0 - share) * upstream


def upwind_flow(film: Array, mass: Array, viscosity: Array) -> tuple[Array, Array, Array]:
    """The same of second order upstream."""
    ease = mass * film**2 / (12.0 * viscosity)
    faces = np.column_stack([0.5 * (mass[:, 0] + mass[:, 1]), 1.5 * mass[:, 1:-1] - 0.5 * mass[:, :-2]])
    return 0.5 * (ease[:, 1:] + ease[:, :-1]), 0.5 * (ease[1:] + ease[:-1]), faces


def net_inflow(at: Answer, film: Array) -> tuple[Array, Array]:
    """Mass per density and area that comes into each node [m/s], zero on the edge; and rho h^3 / 12 eta about it."""
    dx, f = at.x[1] - at.x[0], at.fluid
    density = (5.9e8 + 1.34 * f) / (5.9e8 + f)
    mass = density * film
    ease = mass * film**2 / (12.0 * at.viscosity(f))
    if at.fitted:
        stiffness = np.pi * at.speed * dx**2 / at.modulus
        ease_x, ease_y, faces = fitted_flow(film, f, density, at.viscosity, stiffness, FLOOR)
    else:
        ease_x, ease_y, faces = upwind_flow(film, mass, at.viscosity(f))
    along, across = ease_x * np.diff(f, axis=1) / dx, ease_y * np.diff(f, axis=0) / dx
    net, around = np.zeros_like(f), np.ones_like(f)
    inner = np.s_[1:-1, 1:-1]
    net[inner] = (np.diff(along, axis=1)[1:-1] + np.diff(across, axis=0)[:, 1:-1]) / dx
    net[inner] -= at.speed * np.diff(faces, axis=1)[1:-1] / dx
    if at.before is not None:
        net[inner] -= ((mass - at.before) / at.step)[inner]
    around[inner] = 0.5 * ease[inner] + 0.125 * (ease[:-2, 1:-1] + ease[2:, 1:-1] + ease[1:-1, :-2] + ease[1:-1, 2:])
    return net, around


def judge(at: Answer) -> Judgement:
    """Hold an answer against the equations."""
    if at.speed < 0.0:
        at = at.mirrored()
    dx, p, f, solid = at.x[1] - at.x[0], at.pressure, at.fluid, at.solid
    hertz = hertz_point(at.load, at.radius, at.radius_y, at.modulus)
    gap = at.rigid + at.x[None, :] ** 2 / (2.0 * at.radius) + at.y[:, None] ** 2 / (2.0 * at.radius_y) - at.heights
    gap = gap + deformation(p, dx, at.modulus)
    below, total = p < at.hardness * (1.0 - 1e-12), p.sum()
    beyond = load_beyond(at, gap + at.heights) / at.load if at.speed != 0.0 else 0.0
    # a contact is at the floor or, at the hardness, below it; nothing else overlaps unless it yields
    away = np.where(solid & below, np.abs(gap - FLOOR), np.where(solid, np.maximum(gap - FLOOR, 0.0), 0.0))
    away = np.where(~solid & below, np.maximum(FLOOR - gap, 0.0), away)
    imbalance = cavity = beneath = 0.0
    if at.speed != 0.0:
        film = np.where(solid, FLOOR, np.maximum(gap, FLOOR))
        net, ease = net_inflow(at, film)
        oil = ~solid & (p > 0.0)
        # a film that loses mass sinks to the floor at most; solids at the hardness yield to one that gains
        loss = np.minimum(np.maximum(-net, 0.0), at.speed * film * (film / FLOOR - 1.0) / dx)
        wrong = loss + np.where(below, np.maximum(net, 0.0), 0.0)
        per_mass = at.size / at.speed / max(float((film * p)[oil].sum()), 1e-300)
        imbalance = float((wrong * p)[oil].sum() * per_mass * p[oil].sum() / total)
        dammed = np.where(~solid & (p <= 0.0), np.maximum(net, 0.0), 0.0) * dx**2 / (4.0 * ease)
        cavity = float(np.minimum(dammed, hertz.pressure_max).sum() / total)
        under = np.where(f > 0.0, np.abs(net), np.maximum(net, 0.0)) * np.where(solid, f, 0.0)
        beneath = float(under.sum() * at.size / at.speed / FLOOR / total)
    violated = [-f.min(), (f - p).max(), (p - at.hardness).max(), np.abs(p - f)[~solid].max(initial=0.0)]
    return Judgement(
        force=float(total * dx**2 / at.load + beyond - 1.0),
        beyond=beyond,
        imbalance=imbalance,
        cavity=cavity,
        complementarity=float((away * p).sum() / total / FLOOR),
        beneath=beneath,
        gap=float(np.abs(np.maximum(gap, FLOOR) - at.film).max() / FLOOR),
        bounds=float(max(violated) / hertz.pressure_max),
    )


def film_of(given: dict[str, Any]) -> tuple[float, float]:
    """Moes' M and the film [m] of smooth bodies by formula, of the arguments of `point_contact`."""
    speed = 0.5 * abs(given["speed_1"] + given["speed_2"])
    if speed == 0.0:
        return np.inf, 0.0
    names = ("viscosity", "pressure_viscosity", "radius_x", "radius_y", "reduced_modulus")
    contact = SmoothContact(given["load"], speed, *(given[name] for name in names))
    return contact.moes_parameters[0], nijenbanning_venner_moes(contact)


def answer(given: dict[str, Any], found: PointContact) -> Answer:
    """Return the solution of `point_contact` for its arguments."""
    load, radius, radius_y, modulus = (given[name] for name in ("load", "radius_x", "radius_y", "reduced_modulus"))
    size = np.sqrt(hertz_point(load, radius, radius_y, modulus).a ** 2 + 1.4 * radius * film_of(given)[1])
    return Answer(
        x=found.x,
        y=found.y,
        pressure=found.pressure,
        fluid=found.fluid_pressure,
        solid=found.solid_pressure > 0.0,
        film=found.film,
        rigid=-found.approach,
        heights=given["heights_2"],
        load=load,
        radius=radius,
        radius_y=radius_y,
        modulus=modulus,
        speed=0.5 * (given["speed_1"] + given["speed_2"]),
        hardness=given["hardness"],
        size=float(size),
        viscosity=roelands(given["viscosity"], given["pressure_viscosity"]),
        fitted=given.get("flux", "fitted") == "fitted",
    )


def answer_in_time(scene: Scene, op: OperatingPoint, found: ContactFields, before: Array, dt: float) -> Answer:
    """One instant of `contact_core.solve` with upwind flow over a hard floor."""
    return Answer(
        x=found.x,
        y=found.y,
        pressure=found.pressure,
        fluid=found.fluid_pressure,
        solid=found.film.solid,
        film=found.gap,
        rigid=found.film.rigid_gap,
        heights=found.heights,
        load=op.load,
        radius=scene.geometry.radius_x,
        radius_y=scene.geometry.radius_y,
        modulus=scene.solids.reduced_modulus,
        speed=op.entrainment_speed,
        hardness=scene.plasticity.limit(found.cover_1, found.cover_2, 0.0, 1.0),
        size=scene.hertz(op.load).a,
        viscosity=lambda p: scene.lubricant.viscosity(p, op.temperature),
        before=before,
        step=dt,
        fitted=False,
    )
