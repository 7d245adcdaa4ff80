"""The oil at work: what heat and shear make of it in the contact, and how much more easily it then flows.

Warm oil shears more easily and so warms less; thinned or warm oil flows more easily, so that less of it is drawn in.
Where `lubricant.flow` is "newtonian" Reynolds' equation sees the viscosity at the inlet's temperature and the local
pressure alone; where it is "local", that of the local temperature, thinned by the local shear.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .film.instant import FilmSolution, FilmState, Grid, Instant
from .film.thinning import flow_ease, solve_thinning
from .friction import Film, Shear, shear, sliding
from .laws.heat import Temperatures
from .reference import inlet_shear_factor
from .scene import OperatingPoint, Scene

Array = NDArray[np.float64]

_ROUNDS = 30  # of shear and temperature of a steady film, at most
_TAKEN = 0.7  # share of a change of temperature that is taken over, lest the rounds swing
_ENOUGH = 1e-3  # change of temperature that ends them, of the highest rise
_FILM_OF_VISCOSITY = 0.67  # power of the viscosity in the film of smooth bodies (Hamrock & Dowson)


def sheared(grid: Grid, found: FilmSolution, cover: Array, temperature: float) -> Film:
    """What friction needs to know of a film solution, its oil at one temperature [K]."""
    state = found.state
    solid = np.where(state.solid, state.pressure - state.fluid, 0.0)
    return Film(grid, state.fluid, solid, found.gap, cover, temperature)


def warmed(
    scene: Scene, op: OperatingPoint, film: Film, before: FilmState | None
) -> tuple[Film, Shear, Temperatures, str]:
    """A film at its temperature, its shear, the temperatures, and why they do not belong together if so.

    A march goes on from the warmth of the instant before; a steady film (`before` None) repeats until its temperature
    stands still.
    """
    law, inlet = scene.heat, op.inlet_temperature
    if law.warms_film and before is not None:
        film = replace(film, temperature=inlet + before.warmth)
    change = 0.0
    for _ in range(_ROUNDS):
        stress = shear(scene, op, film)
        warm = law.temperatures(
            stress.dissipation,
            film.gap,
            film.solid > 0.0,
            film.fluid + film.solid > 0.0,
            film.grid.spacing,
            (op.speed_1, op.speed_2),
            op.sliding_speed,
            op.bodies,
            scene.lubricant.conductivity,
        )
        if not law.warms_film:
            return film, stress, warm, ""
        change = float(np.abs(warm.film - film.temperature).max())
        film = replace(film, temperature=film.temperature + _TAKEN * (warm.film - film.temperature))
        if before is not None or change <= _ENOUGH * (1.0 + float(np.abs(warm.film - inlet).max())):
            return film, stress, warm, "" if warm.solved else "the partition of heat was not solved"
    return film, stress, warm, f"the film's temperature still changes by {change:.2g} K"


def inlet_ease(scene: Scene, op: OperatingPoint) -> float:
    """How many times more easily the oil flows for the heat of shear in the inlet (`heat.inlet_shear`)."""
    if scene.heat.inlet_shear == "none" or op.load == 0.0 or op.entrainment_speed == 0.0:
        return 1.0
    return inlet_factor(scene, op) ** (-1.0 / _FILM_OF_VISCOSITY)


def inlet_factor(scene: Scene, op: OperatingPoint) -> float:
    """Film with the heat of shear in the inlet over that without."""
    oil, inlet = scene.lubricant, op.inlet_temperature
    viscosity, warmer, colder = (float(oil.viscosity(np.zeros(1), inlet + step)[0]) for step in (0.0, 0.5, -0.5))
    speed, pressure = abs(op.entrainment_speed), scene.hertz(op.load).pressure_max
    return inlet_shear_factor(
        viscosity,
        float(np.log(colder / warmer)),
        speed,
        op.sliding_speed / speed,
        oil.conductivity,
        pressure,
        scene.solids.reduced_modulus,
    )


def solve_flow(
    scene: Scene,
    op: OperatingPoint,
    grid: Grid,
    cover: Array,
    now: Instant,
    before: FilmState | None,
    solve: Callable[[Instant, FilmState | None], FilmSolution],
    tolerance: float,
) -> FilmSolution:
    """The film of an instant with the flow that the scene asks for; `solve` is the solution under a given ease.

    A march takes the ease of the instant before, a steady film (`before` None) repeats until both fit.
    """
    inlet = inlet_ease(scene, op)
    now = replace(now, ease=np.full(grid.shape, inlet) if inlet != 1.0 else None)
    if scene.lubricant.flow == "newtonian" or now.dry or op.entrainment_speed == 0.0:
        return solve(now, before)
    if before is not None:
        return solve(replace(now, ease=np.broadcast_to(before.ease, grid.shape).copy()), before)

    def ease_of(found: FilmSolution, ease: Array | None) -> Array:
        film = warmed(scene, op, sheared(grid, found, cover, op.inlet_temperature), None)[0]
        return next_ease(scene, op, film, ease)

    return solve_thinning(now, solve, ease_of, tolerance)


def next_ease(scene: Scene, op: OperatingPoint, film: Film, ease: Array | None) -> Array:
    """`Instant.ease` of a film that was solved under another one."""
    inlet = inlet_ease(scene, op)
    if scene.lubricant.flow == "newtonian":
        return np.full((1, 1), inlet)
    viscosity = scene.lubricant.viscosity
    found = flow_ease(
        scene.lubricant.rheology,
        sliding(op, film.grid)[0],
        film.gap,
        film.fluid,
        film.grid.spacing,
        viscosity(film.fluid, film.temperature),
        viscosity(film.fluid, op.inlet_temperature),
        None if ease is None else ease / inlet,
    )
    return inlet * found
