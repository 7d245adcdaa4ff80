"""One instant of a scene in a state: geometry, film, friction and flash temperature, node by node."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from .film.instant import FilmSolution, FilmState, Grid, Instant
from .laws.tribofilm import thickness
from .patches import bare_heights, contact_grid, heights_of, on_grid, patch_nodes, roughness_of
from .scene import OperatingPoint, Scene
from .state import ContactState

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Transient:
    """How an instant follows from the state's last film solution."""

    dt: float  # time since then [s]
    moved: int  # nodes by which the rougher surface has moved along +x since then
    iterations: int  # at most


@dataclass(frozen=True)
class ContactFields:
    """Everything about one instant. Arrays [ny, nx] on the grid of the contact, x along entrainment, SI."""

    x: Array  # [nx]
    y: Array  # [ny]
    pressure: Array  # total
    fluid_pressure: Array
    solid_pressure: Array
    gap: Array  # at least film.floor
    heights: Array  # of both bodies together, positive into the gap, tribofilm and wear included
    roughness: Array  # the same, free of the grooves' shape
    cover_1: Array  # tribofilm of each body / its full thickness
    cover_2: Array
    overlap: Array  # what yields plastically in this instant
    fluid_shear: Array  # on body 2 along +x
    solid_shear: Array
    flash_rise: float  # mean over the real contact [K]
    film: FilmState
    converged: bool
    shortfall: str  # why it is not converged, empty if it is
    # "mixed", "dry" (no entrainment, or asked for), "fallback" (dry for want of a mixed solution) or "open" (no load)
    route: str
    algorithm: str  # row of the table in film/routes.py and what of it found the film
    iterations: int
    pressure_change: float  # of the last iteration, relative
    load_error: float  # relative
    load_beyond: float  # share of the load that a film wider than the grid carries beyond its edge
    complementarity: float  # mean distance of solid contacts from the floor, weighted by pressure, in floors
    imbalance: float  # mass that the film gains or loses unasked, relative
    inlet_nodes: float  # nodes across the inlet zone; below 3 the film is a number of this grid


def solve(
    scene: Scene,
    op: OperatingPoint,
    state: ContactState,
    transient: Transient | None = None,
    *,
    dry: bool = False,
    solid_share: float = 1.0,
) -> ContactFields:
    """Solve the contact at one instant; time and state stand still.

    Without `transient` the film is steady. `dry` leaves the film out: the solids carry
    `solid_share` of the load, oil spread as in Hertz's contact the rest. Raises OperatingPointError for values that
    cannot be used and ConvergenceError if no solution exists. A film solution that did not converge says so; if it
    cannot be used, the dry one stands in (`route`).
    """
    op.check()
    bare, law = bare_heights(scene, state.rows), scene.plasticity
    nodes = [patch_nodes(scene, body) for body in state.bodies]
    patches = [heights_of(z, body) for z, body in zip(bare, state.bodies, strict=True)]
    heights = on_grid(patches[0], nodes[0]) + on_grid(patches[1], nodes[1])
    rough = on_grid(roughness_of(bare[0], patches[0]), nodes[0]) + on_grid(roughness_of(bare[1], patches[1]), nodes[1])
    full = scene.tribofilm.full_thickness
    film_1, film_2 = (
        on_grid(thickness(body.growth, body.removal), n) for body, n in zip(state.bodies, nodes, strict=True)
    )
    pressed = np.zeros_like(heights)
    if law.indentation == "total":
        pressed += sum(on_grid(body.plastic, n) for body, n in zip(state.bodies, nodes, strict=True))
    limit = law.limit(film_1, film_2, pressed, full)
    cover_1, cover_2 = film_1 / full, film_2 / full
    grid = contact_grid(scene, state.rows)
    if op.load == 0.0:
        film = _open(scene, grid, heights)
    else:
        now = replace(instant_of(scene, op, heights, limit), dry=dry, solid_share=solid_share)
        follows = (transient.dt, transient.moved) if transient and state.film else None
        film = scene.film.solve(
            now, grid, state.film if transient else None, follows, transient.iterations if transient else None
        )
    return _with_friction(scene, op, grid, film, heights, rough, cover_1, cover_2)


def instant_of(scene: Scene, op: OperatingPoint, heights: Array, limit: Array) -> Instant:
    """An instant of a scene with heights and largest pressures as given, [ny, nx]."""
    return Instant(
        load=op.load,
        entrainment_speed=op.entrainment_speed,
        temperature=op.temperature,
        radius_x=scene.geometry.radius_x,
        radius_y=scene.geometry.radius_y,
        reduced_modulus=scene.solids.reduced_modulus,
        viscosity=scene.lubricant.viscosity,
        density=scene.lubricant.density,
        heights=heights,
        limit=limit,
        hardness=scene.plasticity.hardness,
    )


def _open(scene: Scene, grid: Grid, heights: Array) -> FilmSolution:
    """No load: the bodies just touch and nothing presses."""
    x, y = grid.x[None, :], grid.y[:, None]
    shape = x**2 / (2 * scene.geometry.radius_x) + y**2 / (2 * scene.geometry.radius_y) - heights
    rigid = scene.film.floor - float(shape.min())
    zeros, nothing = np.zeros_like(shape), np.zeros(shape.shape, np.bool_)
    return FilmSolution(
        state=FilmState(zeros, zeros, nothing, shape + rigid, rigid),
        gap=shape + rigid,
        overlap=zeros,
        converged=True,
        shortfall="",
        route="open",
        algorithm="none",
        iterations=0,
        change=0.0,
        load_error=0.0,
        load_beyond=0.0,
        complementarity=0.0,
        imbalance=0.0,
        inlet_nodes=np.inf,
    )


def _with_friction(
    scene: Scene,
    op: OperatingPoint,
    grid: Grid,
    film: FilmSolution,
    heights: Array,
    rough: Array,
    cover_1: Array,
    cover_2: Array,
) -> ContactFields:
    fluid = film.state.fluid
    solid = np.where(film.state.solid, film.state.pressure - fluid, 0.0)
    sliding, oil = op.sliding_speed, scene.lubricant
    fluid_shear = oil.rheology(oil.viscosity(fluid, op.temperature) * sliding / film.gap, fluid)
    solid_shear = scene.boundary_friction(solid, 0.5 * (cover_1 + cover_2), sliding)
    rise = _flash_rise(scene, film.state.solid, fluid_shear + solid_shear, sliding)
    return ContactFields(
        x=grid.x,
        y=grid.y,
        pressure=film.state.pressure,
        fluid_pressure=fluid,
        solid_pressure=solid,
        gap=film.gap,
        heights=heights,
        roughness=rough,
        cover_1=cover_1,
        cover_2=cover_2,
        overlap=film.overlap,
        fluid_shear=fluid_shear,
        solid_shear=solid_shear,
        flash_rise=rise,
        film=film.state,
        converged=film.converged,
        shortfall=film.shortfall,
        route=film.route,
        algorithm=film.algorithm,
        iterations=film.iterations,
        pressure_change=film.change,
        load_error=film.load_error,
        load_beyond=film.load_beyond,
        complementarity=film.complementarity,
        imbalance=film.imbalance,
        inlet_nodes=film.inlet_nodes,
    )


def _flash_rise(scene: Scene, solid: NDArray[np.bool_], shear: Array, sliding: float) -> float:
    """Mean over the contact nodes of their spot's rise; a spot is a connected set of contact nodes."""
    if scene.heat.name == "none" or sliding == 0.0 or not solid.any():
        return 0.0
    spots, count = ndimage.label(solid)
    nodes = np.bincount(spots.ravel(), minlength=count + 1)[1:]
    mean_shear = np.bincount(spots.ravel(), np.abs(shear).ravel(), count + 1)[1:] / nodes
    radius = np.sqrt(nodes * scene.film.spacing**2 / np.pi)
    return float((scene.heat.rise(radius, mean_shear, sliding) * nodes).sum() / nodes.sum())
