"""One instant of a case in a state: geometry, film, friction and flash temperature, node by node."""

from dataclasses import dataclass, replace

import numpy as np

from ..errors import SceneError
from ..film import Convergence, Deterministic
from ..film.instant import FilmSolution, FilmState, Grid, Instant, Step
from ..kernels.arrays import Array
from ..kernels.surface_give import SurfaceGive
from ..laws.temperatures import Temperatures
from ..scene import Case, OperatingPoint, Scene
from ..state import ContactState
from ..surfaces.patches import FacingSurfaces, added_friction, facing_surfaces
from .friction import Film, Friction, friction
from .oil_temperature import left_behind, sheared, solve_flow, warmed

_AHEAD = 1.1  # the faster body's speed over the entrainment speed, up to which that is near rolling
_SLIDE = 0.5  # way by which rough bodies slide past each other in an instant, at most, over their correlation length


@dataclass(frozen=True)
class Transient:
    """The step from the state's last film solution to an instant."""

    dt: float  # time since then [s]
    moved: int  # nodes by which the rougher surface has moved along +x on the grid since then
    iterations: int  # at most
    heated: bool = True  # False: temperatures are not needed; the film keeps its last ones
    order: int = 1  # of the squeeze term in time, 1 or 2
    thorough: bool = False  # True: try all algorithms; False: the residual carries over to the next instant
    shifted: float = 0.0  # nodes by which the grid itself has moved along +x
    rolled: int = 0  # and those by which the oil has moved along on the grid
    passing: float = 1.0  # part of the gap's change since then in which asperities pass each other; the rest is at once


@dataclass(frozen=True)
class ContactFields(Convergence):
    """Everything about one instant. Arrays [ny, nx] on the grid of the contact, x along entrainment, SI.

    Attributes
    ----------
    x, y
        Places of the columns and rows [m]; nodes of a march move on with the oil, by half of their distance at most.
    pressure, fluid_pressure, solid_pressure
        Total pressure, and its parts in the oil and on the solids [Pa].
    gap
        Gap, at least film.floor [m].
    heights, roughness
        Heights of both bodies together, positive into the gap, and the same without the grooves' shape [m].
    cover_1, cover_2
        Tribofilm of each body over its full thickness.
    overlap
        What yields plastically in this instant [m].
    fluid_shear, solid_shear
        Shear stress on body 2 along +x [Pa].
    shear, oil_shear, rubbing_shear
        Shear stress in the direction of the local sliding, of solids and oil together and of either [Pa].
    touching
        Share of a node's area where solids touch.
    friction, temperatures
        Forces, and temperatures of the contact.

    """

    x: Array  # [nx]; nodes of a march move on with the oil, by half of their distance at most
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
    shear: Array  # of solids and oil together, in the direction of the local sliding
    oil_shear: Array  # of these, the oil's
    rubbing_shear: Array  # and the solids', mean over a node's area
    touching: Array  # share of a node's area where solids touch
    friction: Friction
    sheared: Film  # what that friction is of
    temperatures: Temperatures
    film: FilmState


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

    Parameters
    ----------
    transient : how the film follows from the state's last one; None: the film is steady.
    dry : leave the film out.
    solid_share : share of the load that the solids of a dry contact carry; oil spread as in Hertz's contact carries the
        rest.

    Returns
    -------
    ContactFields
        A film solution that did not converge says so; if it cannot be used, the dry one replaces it (`route`).

    Raises
    ------
    OperatingPointError
        For values that cannot be used.
    ConvergenceError
        If no solution exists.
    SceneError
        For a scene of another level.

    """
    if not isinstance(scene.film, Deterministic):
        raise SceneError(f"film.model = '{scene.film.name}' has no fields. Solve scene.at_level('deterministic').")
    case = Case.bind(scene, op, state.temperatures)
    return solve_instant(case, state, transient, dry=dry, solid_share=solid_share)


def solve_instant(
    case: Case,
    state: ContactState,
    transient: Transient | None = None,
    *,
    dry: bool = False,
    solid_share: float = 1.0,
) -> ContactFields:
    """Solve a case at one instant; as `solve`, for an operating point that has been checked."""
    scene = case.scene
    full = scene.tribofilm.full_thickness
    faced = facing_surfaces(scene, state, moving=transient is not None)
    grid = scene.grid(state.rows).shifted(state.window)
    film_1, film_2 = faced.tribofilms
    covers = film_1 / full, film_2 / full
    cover = 0.5 * (covers[0] + covers[1])
    oxide = added_friction(scene, state, cover)
    now = replace(_pressed(case, faced), dry=dry, solid_share=solid_share)
    before = state.film if transient else None
    if not case.loaded:
        film = _open(case, grid, faced.heights)
    else:
        step = None
        if transient and before:
            how = transient.moved, transient.order, transient.thorough
            step = Step(transient.dt, *how, transient.shifted, transient.rolled, transient.passing)
        most = transient.iterations if transient else None
        film = solve_flow(case, grid, cover, now, before, step, most, oxide)
    rubbed = sheared(grid, film, cover, case.op.inlet_temperature, oxide)
    found, stress, warm, shortfall = warmed(case, rubbed, before, heated=not transient or transient.heated)
    convergence = film.convergence | {
        "converged": film.converged and not shortfall,
        "shortfall": "; ".join(text for text in (film.shortfall, shortfall) if text),
    }
    return ContactFields(
        x=grid.x,
        y=grid.y,
        pressure=film.state.pressure,
        fluid_pressure=film.state.fluid,
        solid_pressure=found.solid,
        gap=film.gap,
        heights=faced.heights,
        roughness=faced.roughness,
        cover_1=covers[0],
        cover_2=covers[1],
        overlap=film.overlap,
        fluid_shear=stress.fluid * stress.along_x,
        solid_shear=stress.solid * stress.along_x,
        shear=stress.total,
        oil_shear=stress.fluid,
        rubbing_shear=stress.solid,
        touching=film.touching,
        friction=friction(stress, grid),
        sheared=found,
        temperatures=warm,
        film=left_behind(case, now, film, found),
        **convergence,
    )


def near_rolling(case: Case) -> bool:
    """Return True if no body runs far ahead of the oil."""
    return case.fastest <= _AHEAD * abs(case.op.entrainment_speed)


def instant_time(case: Case) -> float:
    """Return the time [s] from instant to instant of a block."""
    return nodes_per_instant(case) * case.scene.film.spacing / _leading(case)


def nodes_per_instant(case: Case) -> float:
    """Return the way of the oil, or of a body that runs far ahead of it, from instant to instant, in nodes.

    That of the scene, or less where rough bodies would slide too far past each other.
    """
    asked, sliding = case.scene.control.nodes_per_instant, sliding_node_speed(case)
    return min(asked, _leading(case) / sliding) if sliding > 0.0 else asked


def sliding_node_speed(case: Case) -> float:
    """Return the speed [m/s] of what moves by a node while rough bodies slide as far as they may in an instant."""
    rougher, spacing = case.sides[case.scene.rougher].surface, case.scene.film.spacing
    if rougher.smooth:
        return 0.0
    return abs(case.op.sliding_speed) * spacing / (_SLIDE * max(rougher.length, spacing))


def _leading(case: Case) -> float:
    """Return the speed [m/s] of the oil, or of a body that runs far ahead of it."""
    return abs(case.op.entrainment_speed) if near_rolling(case) else case.fastest


def _pressed(case: Case, faced: FacingSurfaces) -> Instant:
    """Return the instant of facing surfaces, with the pressures at which they yield and by how much they give way."""
    scene, (film_1, film_2) = case.scene, faced.tribofilms
    law, films = scene.plasticity, (film_1, film_2, faced.plastic, scene.tribofilm.full_thickness)
    soft, thick = scene.solids.film_give, film_1 + film_2
    if not thick.any() or (soft == 0.0 and not law.iterated):
        return instant_of(case, faced.heights, law.limit(*films))
    if not law.iterated:
        rigid = np.full_like(thick, np.inf)
        give = SurfaceGive(soft * thick, rigid, rigid, 0.0)
        return replace(instant_of(case, faced.heights, law.limit(*films)), give=give)
    give = SurfaceGive(soft * thick, *law.hardening(*films))
    return replace(instant_of(case, faced.heights, np.full_like(thick, law.hardness)), give=give)


def instant_of(case: Case, heights: Array, limit: Array) -> Instant:
    """Return an instant of a case with heights and largest pressures as given, [ny, nx]."""
    return Instant(
        load=case.op.load,
        entrainment_speed=case.op.entrainment_speed,
        temperature=case.op.inlet_temperature,
        shape=case.shape,
        reduced_modulus=case.scene.solids.reduced_modulus,
        viscosity=case.scene.lubricant.viscosity,
        density=case.scene.lubricant.density,
        heights=heights,
        limit=limit,
        hardness=case.scene.plasticity.hardness,
        microroughness=case.microroughness,
        conserving=case.scene.lubricant.cavitation == "mass_conserving",
        supply=case.scene.lubricant.supply.layer,
        meniscus=case.scene.lubricant.supply.inlet,
    )


def _open(case: Case, grid: Grid, heights: Array) -> FilmSolution:
    """Return the film without a load: the bodies just touch and nothing presses."""
    bodies = case.shape
    shape = bodies.gap(grid.x, grid.y, 1.0) / bodies.radius_x - heights
    rigid = case.scene.film.floor - float(shape.min())
    zeros, nothing = np.zeros_like(shape), np.zeros(shape.shape, np.bool_)
    return FilmSolution(
        state=FilmState(zeros, zeros, nothing, shape + rigid, rigid),
        gap=shape + rigid,
        overlap=zeros,
        touching=zeros,
        converged=True,
        shortfall="",
        route="open",
        algorithm="none",
        iterations=0,
        pressure_change=0.0,
        load_error=0.0,
        load_beyond=0.0,
        complementarity=0.0,
        imbalance=0.0,
        inlet_nodes=np.inf,
        resolved=True,
    )
