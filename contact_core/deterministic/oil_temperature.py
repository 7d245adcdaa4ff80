"""Temperature and shear thinning of the oil in the contact, and the flow that follows from them.

Warm oil shears more easily and so warms less; thinned or warm oil flows more easily, so that less of it is drawn in.
Where `lubricant.flow` is "newtonian" Reynolds' equation sees the viscosity at the inlet's temperature and the local
pressure alone; where it is "local", that of the local temperature, thinned by the local shear. Double layers on the
surfaces raise either one with the local gap.
"""

from dataclasses import replace

import numpy as np

from ..film import Deterministic
from ..film.instant import FilmSolution, FilmState, Grid, Instant, Step
from ..film.thinning import Agreement, eased, recalled, remembering
from ..kernels.arrays import Array
from ..laws.heat import NoHeat
from ..laws.temperatures import Rubbing, Temperatures
from ..reference import FILM_OF_VISCOSITY, inlet_shear_factor
from ..scene import Case
from .friction import Film, Shear, shear, sliding

_ROUNDS = 30  # of shear and temperature of a steady film, at most
_UNDER_RELAXATION = 0.7  # of a change of temperature
_ENOUGH = 1e-3  # change of temperature that ends them, of the highest rise


def sheared(grid: Grid, found: FilmSolution, cover: Array, temperature: float, oxide: Array | None = None) -> Film:
    """Return a film solution as friction needs it, its oil at one temperature [K]."""
    state = found.state
    solid = state.pressure - state.fluid
    return Film(grid, state.fluid, solid, found.gap, cover, temperature, oxide=oxide)


def warmed(
    case: Case, film: Film, before: FilmState | None, *, heated: bool = True
) -> tuple[Film, Shear, Temperatures, str]:
    """Return a film at its temperature, its shear, the temperatures, and why they are not converged, if so.

    A march continues from the warmth of the instant before; a steady film (`before` None) repeats until its temperature
    does not change. Not `heated`, it keeps that warmth.
    """
    inlet = case.op.inlet_temperature
    law = case.scene.heat if heated else NoHeat()
    if case.scene.heat.warms_film and before is not None:
        film = replace(film, temperature=inlet + before.warmth)
    change = 0.0
    for _ in range(_ROUNDS):
        stress = shear(case, film)
        rubbing = Rubbing(
            dissipation=stress.dissipation,
            gap=film.gap,
            solid=film.solid > (0.0 if case.microroughness is None else film.fluid),  # where they carry the most
            inside=film.fluid + film.solid > 0.0,
            spacing=film.grid.spacing,
            speeds=case.speeds,
            bodies=case.op.bodies,
            oil_conductivity=case.scene.lubricant.conductivity_under(film.fluid),
            face=film.grid.repeats * film.grid.shape[0] * film.grid.spacing if film.grid.periodic else None,
        )
        warm = law.temperatures(rubbing)
        if not law.warms_film:
            return film, stress, warm, ""
        change = float(np.abs(warm.film - film.temperature).max())
        film = replace(film, temperature=film.temperature + _UNDER_RELAXATION * (warm.film - film.temperature))
        if before is not None or change <= _ENOUGH * (1.0 + float(np.abs(warm.film - inlet).max())):
            return film, stress, warm, "" if warm.solved else "the partition of heat was not solved"
    return film, stress, warm, f"the film's temperature still changes by {change:.2g} K"


def inlet_ease(case: Case) -> float:
    """Return the factor by which the oil flows more easily for the heat of shear in the inlet (`heat.inlet_shear`)."""
    if case.scene.heat.inlet_shear == "none" or not case.loaded or not case.entrained:
        return 1.0
    return inlet_factor(case) ** (-1.0 / FILM_OF_VISCOSITY)


def inlet_factor(case: Case) -> float:
    """Return the film with the heat of shear in the inlet over that without."""
    oil, inlet = case.scene.lubricant, case.op.inlet_temperature
    viscosity, warmer, colder = (float(oil.viscosity(np.zeros(1), inlet + step)[0]) for step in (0.0, 0.5, -0.5))
    speed, pressure = abs(case.op.entrainment_speed), case.hertz.pressure_max
    return inlet_shear_factor(
        viscosity,
        float(np.log(colder / warmer)),
        speed,
        case.op.sliding_speed / speed,
        oil.conductivity,
        pressure,
        case.scene.solids.reduced_modulus,
    )


def solve_flow(
    case: Case,
    grid: Grid,
    cover: Array,
    now: Instant,
    before: FilmState | None,
    step: Step | None,
    most: int | None,
    oxide: Array | None = None,
) -> FilmSolution:
    """Return the film of an instant with the flow that the scene asks for, by at most so many iterations.

    A march takes the oil as the instant before has left it; a steady film (`before` None) repeats until both agree.
    """
    level, inlet = case.scene.film, inlet_ease(case)
    assert isinstance(level, Deterministic)
    if inlet != 1.0:
        now = replace(now, ease=np.full(grid.shape, inlet))
    oil = case.scene.lubricant
    as_at_inlet = oil.flow == "newtonian" and not oil.double_layer.acts
    steady = before is None and not as_at_inlet and not now.dry and case.entrained
    if before is not None and not as_at_inlet and not now.dry and (oil.flow == "local" or before.ease.size > 1):
        now = recalled(now, before)
    found = level.solve(now, grid, before, step, most)
    if not steady:
        return found
    agreement = Agreement(level.tolerance)
    while agreement.asks_for_more(found):
        film = warmed(case, sheared(grid, found, cover, case.op.inlet_temperature, oxide), None)[0]
        then = _worked(case, now, found, film)
        if then is now:
            break
        now = agreement.towards(now, then)
        found = level.solve(now, grid, found.state, step, most)
    return agreement.film(found)


def _worked(case: Case, now: Instant, found: FilmSolution, film: Film) -> Instant:
    """Return an instant with the oil as a film `found` has left it."""
    oil, inlet, viscosity = case.scene.lubricant, inlet_ease(case), None
    if oil.flow == "newtonian":
        if found.route != "mixed":
            return now
        return replace(now, ease=inlet / oil.double_layer(found.gap, case.op.inlet_temperature))
    if inlet != 1.0 or case.scene.heat.warms_film or oil.double_layer.acts:
        viscosity = oil.viscosity(film.fluid, film.temperature) / inlet
    if viscosity is not None and oil.double_layer.acts:
        viscosity = viscosity * oil.double_layer(found.gap, case.op.inlet_temperature)
    speed = sliding(case.op, film.grid)[0]
    return eased(now, found, oil.rheology, speed, film.grid.spacing, viscosity)


def left_behind(case: Case, now: Instant, found: FilmSolution, film: Film) -> FilmState:
    """Return the state of a film with its oil as the next instant of a march starts from it."""
    oil = case.scene.lubricant
    if (oil.flow == "local" or oil.double_layer.acts) and found.route == "mixed":
        found = remembering(found, _worked(case, now, found, film))
    return replace(found.state, warmth=np.atleast_2d(film.temperature - case.op.inlet_temperature))
