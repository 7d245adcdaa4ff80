"""Film of the smooth bodies by the formula of their shape, thinned, starved, and its changes with the inputs."""

import math
from functools import lru_cache
from typing import NamedTuple

from ..reference import FILM_OF_VISCOSITY, inlet_shear_factor
from ..scene import Case, Scene
from .oil import Law

STEP, KELVIN = 1e-6, 1e-4  # of differences, relative and in temperature
SLOWEST, LIGHTEST = 1e-30, 1e-9  # m/s, N: less is at rest, and without load: it would divide by zero
_PROBE = 1e6  # Pa: pressure at which the pressure coefficient is taken
_THICKEST = 0.01  # of the radius: bodies are no parabolas on the scale of a thicker film


class SmoothFilm(NamedTuple):
    """Film of the smooth bodies."""

    film: float  # [m]
    by_sliding: float  # relative change per sliding speed [s/m]
    by_speed: float  # per entrainment speed [s/m]
    by_load: float  # [1/N]
    by_temperature: float  # [1/K]
    rolling: float  # resistance [N]
    supplied: float  # part of that of a flooded inlet


def smooth_film(case: Case, further: float) -> SmoothFilm:
    """Return the central film of the smooth bodies by the formula of their shape, and its changes with the inputs.

    `further` [m/s] is the difference of the sliding speed.
    """
    scene, op, shape, hertz = case.scene, case.op, case.shape, case.unit_hertz
    entrainment, load, slide, inlet = op.entrainment_speed, op.load, op.sliding_speed, op.inlet_temperature
    speed = abs(entrainment)
    oil, warm = _oil(scene.lubricant.viscosity, inlet)
    largest, modulus, supply = hertz.pressure_max, scene.solids.reduced_modulus, scene.lubricant.supply
    sheared = scene.heat.inlet_shear != "none" or scene.lubricant.flow == "local"
    thins, starves = sheared and speed > 0.0, supply.starves

    def film(speed: float, load: float, slide: float, oil: tuple[float, float], temperature: float) -> float:
        newtonian = shape.film(max(load, LIGHTEST), max(speed, SLOWEST), *oil, modulus)
        if not (thins or starves):
            return newtonian
        grown, flooded = hertz.growth(load)[0], newtonian
        if thins:
            flooded *= _thinned(scene, speed, largest * grown, slide, oil[0], newtonian, temperature)
        return supply.film(flooded, hertz.a * grown, shape.radius_x, shape.side_resistance)

    now = film(speed, load, slide, oil, inlet)
    flooded = shape.film(max(load, LIGHTEST), max(speed, SLOWEST), *oil, modulus)
    by_heat = 1.0
    if thins:
        by_heat = _thinned(scene, speed, largest * hertz.growth(load)[0], slide, oil[0], flooded, inlet)
        flooded *= by_heat
    by_load = film(speed, load * (1.0 + STEP), slide, oil, inlet) / now - 1.0
    by_temperature = film(speed, load, slide, warm, inlet + KELVIN) / now - 1.0
    by_speed = film(speed * (1.0 + STEP), load, slide, oil, inlet) / now - 1.0
    by_sliding = film(speed, load, slide + further, oil, inlet) / now - 1.0 if thins else 0.0
    return SmoothFilm(
        min(now, _THICKEST * shape.radius_x),
        by_sliding / further,
        by_speed / math.copysign(STEP * max(speed, SLOWEST), entrainment),
        by_load / (STEP * load),
        by_temperature / KELVIN,
        *_rolling(case, oil[0], by_heat, now / flooded),
    )


def _rolling(case: Case, viscosity: float, thinned: float, starved: float) -> tuple[float, float]:
    """Return the rolling resistance [N] of smooth bodies, and its part of that of a flooded inlet.

    `thinned`: film by heat and shear of the inlet over the one without, which is that of a less viscous oil; `starved`:
    film over the flooded one. The inlet is full as far as `reach` says: what lies beyond makes nothing, and the
    meniscus takes from what lies before it the more, the nearer it is (fitted to solved films:
    benchmarks.machines.rolling).
    """
    entrainment, shape, supply = case.op.entrainment_speed, case.shape, case.scene.lubricant.supply
    speed = abs(entrainment)
    if speed < SLOWEST:
        return 0.0, 1.0
    eta = viscosity * thinned ** (1.0 / FILM_OF_VISCOSITY)
    load = max(case.op.load, LIGHTEST)
    flooded = shape.rolling(load, speed, eta, case.scene.solids.reduced_modulus)
    left = 1.0
    if supply.starves:
        half_width = case.unit_hertz.a * case.unit_hertz.growth(load)[0]
        reach = max(supply.reach(half_width, shape.radius_x), half_width)
        beyond = shape.rolling_beyond(speed, eta, reach, math.inf)
        near = (flooded - shape.rolling_beyond(speed, eta, half_width, math.inf)) * (half_width / reach) ** 4
        left = min(max(1.0 - (beyond + near) / flooded, 0.0), 1.0)
        if supply.layer is not None:  # a layer enters as a whole, and what it makes is of the film that it leaves
            left *= starved
    return math.copysign(left * flooded, entrainment), left


def _thinned(
    scene: Scene, speed: float, pressure: float, slide: float, viscosity: float, newtonian: float, temperature: float
) -> float:
    """Return the film of an oil that shear heats in the inlet or thins, over a `newtonian` one [m].

    For a speed above zero and Hertz's largest pressure [Pa].
    """
    factor = 1.0
    if scene.heat.inlet_shear != "none":
        modulus = scene.solids.reduced_modulus
        beta, oil = _thinning(scene, temperature), scene.lubricant.conductivity
        factor = inlet_shear_factor(viscosity, beta, speed, slide / speed, oil, pressure, modulus)
    if scene.lubricant.flow == "local":
        factor *= scene.lubricant.rheology.film_factor(newtonian, speed, viscosity, slide / speed)
    return factor


def _thinning(scene: Scene, temperature: float) -> float:
    """Return -d ln(viscosity)/dT [1/K] at p = 0."""
    (eta, _), (thin, _) = _oil(scene.lubricant.viscosity, temperature)
    return math.log(eta / thin) / KELVIN


@lru_cache(maxsize=16)
def _oil(viscosity: Law, temperature: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return viscosity [Pa s] and pressure coefficient [1/Pa] at p = 0, at a temperature [K] and a little above."""
    return _thin(viscosity, temperature), _thin(viscosity, temperature + KELVIN)


def _thin(viscosity: Law, temperature: float) -> tuple[float, float]:
    eta = float(viscosity(0.0, temperature))
    return eta, max(math.log(viscosity(_PROBE, temperature) / eta) / _PROBE, 1e-12)
