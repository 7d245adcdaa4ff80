"""One mean film, one mean real contact: film, load sharing, friction and heat of an operating point.

The film is a formula's, curves fitted to the deterministic level share the load. Friction is evaluated at the point
that is asked for and at four beside it: with a little more sliding, film, load and temperature, the others held. Its
derivatives are these differences, with those of the film by the chain rule. Where the bodies' speeds decide how they
take up heat, there is a sixth point with more entrainment.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..laws.heat import FlashTemperature, TemperatureField
from ..laws.load_sharing import flattening_of, rms_slope
from ..laws.rheology import Carreau
from ..laws.supply import Flooded
from ..reference import Hertz, bair_thinning_factor, inlet_shear_factor
from ..scene import OperatingPoint, Scene
from .oil import Law, MeanHeat, oil_shear
from .surfaces import Films, composite_roughness, hardness_of, mean_cover, scene_film

Array = NDArray[np.float64]

_D, _KELVIN = 1e-6, 1e-4  # how far the points lie apart, relative and in temperature
_WARMER = np.array([0.0, 0.0, 0.0, 0.0, _KELVIN, 0.0])
_PROBE = 1e6  # Pa: pressure that tells the pressure coefficient
_THICKEST = 0.01  # of the radius: thicker a film, and the bodies are no parabolas on its scale
_SLOWEST, _LIGHTEST = 1e-30, 1e-9  # m/s, N: less is at rest, and without load: it would divide by zero


class Fit(NamedTuple):
    """Where a contact lies among the points of the fit; see `load_sharing.FittedSharing`."""

    clearance: float
    flattening: float
    resolution: float


_UNFITTED = Fit(math.inf, 0.0, 0.0)  # no load


class MeanContact(NamedTuple):
    """The contact of an operating point and of the surfaces as they were."""

    films: Films
    sigma: float  # composite rms roughness [m]
    cover: float  # mean cover of both bodies where they touch
    fit: Fit
    gap: float  # mean, of the oil [m]
    load_ratio: float
    area_ratio: float
    solid: float  # friction of the solids on body 1 along +x [N]
    fluid: float
    derivatives: tuple[float, float, float, float]  # of the sum, by speed_1, speed_2, load, temperature
    solid_pressure: float  # mean over the real contact [Pa]
    solid_shear: float  # mean over it, absolute
    fluid_shear: float  # mean over the oil that carries load
    rise: float  # of the surfaces' temperature over the bulk [K]
    slide: float  # sliding speed, with spin [m/s]
    power: float  # [W]
    into_1: float  # part of it that goes into body 1 [W]
    spin_torque: float  # on body 1 [N m]
    rolling: float  # resistance of the oil [N]
    oil_slope: float  # d ln(its friction) / d ln(sliding speed)


class _Surfaces(NamedTuple):
    """What friction and the sharing of the load ask of the surfaces, at any operating point."""

    sigma: float  # composite rms roughness [m]
    cover: float
    hardness: float  # where they touch [Pa]
    flattening: float  # per Hertz's largest pressure [1/Pa]
    resolution: float  # correlation length of the rougher body over the distance of the nodes


class _Smooth(NamedTuple):
    """Film of the smooth bodies."""

    film: float  # [m]
    by_sliding: float  # relative change per sliding speed [s/m]
    by_speed: float  # per entrainment speed [s/m]
    by_load: float  # [1/N]
    by_temperature: float  # [1/K]
    rolling: float  # resistance [N]


class _Shares(NamedTuple):
    """How solids and oil share the load."""

    fit: Fit
    gap: float  # mean [m]
    load: float  # contact_load_ratio
    area: float  # contact_area_ratio of elastic solids
    raised: float  # pressure of the oil over Hertz's


class _Point(NamedTuple):
    """The solids at an operating point, and what its oil is asked to do."""

    shares: _Shares
    rubbing: float  # sliding speed, with spin [m/s]
    along: float  # share of it along x, of friction in proportion to the speed
    turned: float  # of friction that is the same at any speed
    touching: float  # contact_area_ratio
    pressure: float  # of the solids, mean over the real contact [Pa]
    shear: float  # of the solids [Pa], with the sign of `rubbing`
    solid: float  # friction of the solids [N], likewise
    area: float  # Hertz's [m2]
    oily: float  # part of it on which the oil carries load [m2]
    oil_pressure: float  # largest of the oil that carries load [Pa]
    oil_rate: float  # of shear [1/s]
    grip: float  # share of the limiting stress


def evaluate(case: Case, films: Films) -> MeanContact:
    """The contact of an operating point and its derivatives; without load the bodies just touch."""
    sigma, cover = composite_roughness(films), mean_cover(case.scene, films)
    if case.op.load < _LIGHTEST:
        gap = max(sigma, case.scene.film.floor)
        return MeanContact(films, sigma, cover, _UNFITTED, gap, *(0.0,) * 4, (0.0,) * 4, *(0.0,) * 10)
    sliding = case.op.sliding_speed
    further = _D * math.copysign(max(abs(sliding), case.scene.boundary_friction.slip_speed), sliding)
    hertz = case.unit_hertz
    smooth = _smooth(case, hertz, further)
    points = _points(case, hertz, _surfaces(case.scene, hertz, films, sigma, cover), smooth.film, further)
    fluid, heat = _oil_friction(case, hertz, points, further)
    now, slide, pull = points[0], abs(points[0].rubbing), abs(points[0].solid + fluid[0])
    if heat is None:
        rise, into_1 = _flash_rise(case.scene, abs(now.shear), slide), 0.5 * pull * slide
    else:
        rise, into_1 = heat.surface(pull * slide)
    slope = _slope(points, fluid)
    solid = [point.solid * point.turned for point in points]
    oil = [force * _between(point, slope) for point, force in zip(points, fluid, strict=True)]
    forces = [one + other for one, other in zip(solid, oil, strict=True)]
    turning = pull * slide - abs(forces[0] * case.op.sliding_speed)  # what power sliding leaves to spin
    return MeanContact(
        films,
        sigma,
        cover,
        now.shares.fit,
        now.shares.gap,
        now.shares.load,
        now.touching,
        -solid[0],
        -oil[0],
        _derivatives(case.op, smooth, forces, further),
        now.pressure,
        abs(now.shear),
        abs(fluid[0]) / now.oily if now.oily > 0.0 else 0.0,
        rise,
        slide,
        pull * slide,
        into_1,
        -turning / case.op.spin if case.op.spin != 0.0 else 0.0,
        smooth.rolling * (1.0 - now.shares.load),  # solids make no oil flow
        slope,
    )


def _slope(points: list[_Point], fluid: list[float]) -> float:
    """Power of the sliding speed with which the friction of the oil grows; where nothing slides, a Newtonian oil's."""
    now, sliding = points[0].rubbing, points[1].rubbing
    if now == sliding or fluid[0] == 0.0:
        return 1.0
    return (fluid[1] / fluid[0] - 1.0) * now / (sliding - now)


def _between(point: _Point, slope: float) -> float:
    """Share of friction along x that grows with a power, 0 to 1, of the sliding speed."""
    newtonian = min(max(slope, 0.0), 1.0)
    return point.turned + (point.along - point.turned) * newtonian


def _points(
    case: Case, hertz: Hertz, surfaces: _Surfaces, film: float, further: float
) -> list[_Point]:
    """The operating point, and those with more sliding (by `further` [m/s]), film, load and temperature; `hertz` is the
    contact at 1 N.
    """
    (root, wide), (longer, wider), slide = hertz.growth(case.op.load), hertz.growth(1.0 + _D), case.op.sliding_speed
    grown, more = (root, wide), (root * longer, wide * wider)
    shares = _shared(case, hertz, surfaces, film, grown)
    thicker = _shared(case, hertz, surfaces, film * (1.0 + _D), grown)
    heavier = _shared(case, hertz, surfaces, film, more)
    now = _point(case.scene, hertz, surfaces, shares, grown, slide, case.op.spin)
    points = [
        now,
        _point(case.scene, hertz, surfaces, shares, grown, slide + further, case.op.spin),
        _point(case.scene, hertz, surfaces, thicker, grown, slide, case.op.spin),
        _point(case.scene, hertz, surfaces, heavier, more, slide, case.op.spin),
        now,
    ]
    return [*points, now] if isinstance(case.scene.heat, TemperatureField) else points


def _faster(op: OperatingPoint) -> float:
    """By how much [m/s] entrainment is more at the sixth point."""
    return _D * max(abs(op.speed_1), abs(op.speed_2), _SLOWEST)


def _derivatives(
    op: OperatingPoint, smooth: _Smooth, forces: list[float], further: float
) -> tuple[float, float, float, float]:
    """Of the friction on body 1 along +x by speed_1, speed_2, load and temperature, from `forces` on body 2 [N]."""
    now, sliding, thicker, heavier, warmer, *faster = forces
    by_film = (now - thicker) / _D
    by_sliding = (now - sliding) / further + by_film * smooth.by_sliding
    by_speed = 0.5 * by_film * smooth.by_speed
    if faster:
        by_speed += 0.5 * (now - faster[0]) / _faster(op)
    by_load = (now - heavier) / (_D * op.load) + by_film * smooth.by_load
    by_temperature = (now - warmer) / _KELVIN + by_film * smooth.by_temperature
    return by_speed + by_sliding, by_speed - by_sliding, by_load, by_temperature


# the film of smooth bodies


def _smooth(case: Case, hertz: Hertz, further: float) -> _Smooth:
    """Central film of the smooth bodies by the formula of their shape, and what the inputs do to it."""
    entrainment, load, slide, inlet = case.op.entrainment_speed, case.op.load, case.op.sliding_speed, case.op.inlet_temperature
    speed = abs(entrainment)
    oil, warm = _oil(case.scene.lubricant.viscosity, inlet)
    shape, largest, modulus = case.shape, hertz.pressure_max, case.scene.solids.reduced_modulus
    supply = case.scene.lubricant.supply
    thins = speed > 0.0 and (case.scene.heat.inlet_shear != "none" or case.scene.lubricant.flow == "local")
    starves = not isinstance(supply, Flooded)

    def film(speed: float, load: float, slide: float, oil: tuple[float, float], temperature: float) -> float:
        newtonian = shape.film(max(load, _LIGHTEST), max(speed, _SLOWEST), *oil, modulus)
        if not (thins or starves):
            return newtonian
        grown, flooded = hertz.growth(load)[0], newtonian
        if thins:
            flooded *= _thinned(scene, speed, largest * grown, slide, oil[0], newtonian, temperature)
        return supply.film(flooded, hertz.a * grown, shape.radius_x, shape.side_resistance)

    now = film(speed, load, slide, oil, inlet)
    by_load = film(speed, load * (1.0 + _D), slide, oil, inlet) / now - 1.0
    by_temperature = film(speed, load, slide, warm, inlet + _KELVIN) / now - 1.0
    by_speed = film(speed * (1.0 + _D), load, slide, oil, inlet) / now - 1.0
    by_sliding = film(speed, load, slide + further, oil, inlet) / now - 1.0 if thins else 0.0
    return _Smooth(
        min(now, _THICKEST * shape.radius_x),
        by_sliding / further,
        by_speed / math.copysign(_D * max(speed, _SLOWEST), entrainment),
        by_load / (_D * load),
        by_temperature / _KELVIN,
        _rolling(scene, op, oil, now if thins or starves else None),
    )


def _rolling(case: Case, oil: tuple[float, float], film: float | None) -> float:
    """Rolling resistance [N] of the smooth bodies. What leaves less of the flooded film of cold oil, `film` [m], is
    taken to leave as little of the force.
    """
    speed = case.op.entrainment_speed
    if abs(speed) < _SLOWEST:
        return 0.0
    shape, modulus, load = case.shape, case.scene.solids.reduced_modulus, max(case.op.load, _LIGHTEST)
    left = 1.0 if film is None else film / shape.film(load, abs(speed), *oil, modulus)
    return math.copysign(left * shape.rolling(load, abs(speed), oil[0], modulus), speed)


def _thinned(
    scene: Scene, speed: float, pressure: float, slide: float, viscosity: float, newtonian: float, temperature: float
) -> float:
    """Film of an oil that shear heats in the inlet or thins, over a `newtonian` one [m], for a speed above zero and
    Hertz's largest pressure [Pa].
    """
    factor, law = 1.0, scene.lubricant.rheology
    if scene.heat.inlet_shear != "none":
        modulus = scene.solids.reduced_modulus
        beta, oil = _thinning(scene, temperature), scene.lubricant.conductivity
        factor = inlet_shear_factor(viscosity, beta, speed, slide / speed, oil, pressure, modulus)
    if scene.lubricant.flow == "local" and isinstance(law, Carreau):
        factor *= bair_thinning_factor(newtonian, speed, viscosity, law.critical_stress, law.exponent, slide / speed)
    return factor


def _thinning(scene: Scene, temperature: float) -> float:
    """-d ln(viscosity)/dT [1/K] at p = 0."""
    (eta, _), (thin, _) = _oil(scene.lubricant.viscosity, temperature)
    return math.log(eta / thin) / _KELVIN


@lru_cache(maxsize=16)
def _oil(viscosity: Law, temperature: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Viscosity [Pa s] and pressure coefficient [1/Pa] at p = 0, at a temperature [K] and a little above."""
    return _thin(viscosity, temperature), _thin(viscosity, temperature + _KELVIN)


def _thin(viscosity: Law, temperature: float) -> tuple[float, float]:
    eta = float(viscosity(0.0, temperature))
    return eta, max(math.log(viscosity(_PROBE, temperature) / eta) / _PROBE, 1e-12)


# how rough bodies share the load


def _surfaces(scene: Scene, hertz: Hertz, films: Films, sigma: float, cover: float) -> _Surfaces:
    first, second = scene.surface_1, scene.surface_2
    slope = rms_slope(films[0].both, first.correlation_length, films[1].both, second.correlation_length)
    rougher = first if first.rq > second.rq else second
    per_pressure = flattening_of(hertz.mean_share, scene.solids.reduced_modulus, slope) if slope > 0.0 else math.inf
    resolution = rougher.correlation_length / scene.film.spacing
    return _Surfaces(sigma, cover, hardness_of(scene, films), per_pressure, resolution)


def _shared(
    case: Case, hertz: Hertz, surfaces: _Surfaces, film: float, grown: tuple[float, float]
) -> _Shares:
    """Of rough bodies, for a film of smooth ones [m] and the load at which the contact at 1 N, `hertz`, has
    `grown` by so much along x and y.
    """
    root, wide = grown
    floor, sharing, shape = case.scene.film.floor, scene_film(case.scene).sharing, case.shape
    sigma = max(surfaces.sigma, floor)  # smooth bodies touch where their adsorbed layers do
    pressure, half = root * hertz.pressure_max, root * hertz.a
    clearance, flattening, resolution = fit = Fit(film / sigma, surfaces.flattening * pressure, surfaces.resolution)
    if not sharing.covers(*fit):  # powers of them mean nothing far from the fit
        flattening, resolution = sharing.nearest(flattening, resolution)
    density: Law = case.scene.lubricant.density
    share = sharing.load_ratio(clearance, flattening, resolution, film / floor)
    dense = clearance / float(density(hertz.mean_share * pressure))
    gap = max(sigma * sharing.film_ratio(dense, share, flattening, resolution), floor)
    raised = sharing.oil_pressure(clearance, flattening, *shape.depths(film, half, wide * hertz.b))
    # no pressure is above the hardness
    return _Shares(
        fit, gap, share, sharing.area_ratio(share, flattening), min(raised, case.scene.plasticity.hardness / pressure)
    )


# friction and heat


def _point(
    scene: Scene,
    hertz: Hertz,
    surfaces: _Surfaces,
    shares: _Shares,
    grown: tuple[float, float],
    slide: float,
    spin: float,
) -> _Point:
    """What the solids do at a sliding speed [m/s], spin [rad/s] and the load at which the contact at 1 N, `hertz`, has
    `grown` by so much.
    """
    root, wide = grown
    largest, area = hertz.pressure_max * root, hertz.area * root * wide
    carried = hertz.mean_share * shares.load * largest  # mean over the Hertz area
    touching = max(shares.area, carried / surfaces.hardness)  # the hardness allows no smaller contact
    pressure = carried / (touching + 1e-300)
    rubbing, along, turned = slide, 1.0, 1.0
    if spin != 0.0:
        edge = spin * hertz.b * wide
        rubbing = math.hypot(slide, hertz.lever_share * edge)
        along = slide / max(rubbing, _SLOWEST)
        turned = slide / max(math.hypot(slide, hertz.turn_share * edge), _SLOWEST)
    boundary: Law = scene.boundary_friction
    shear = boundary(pressure, surfaces.cover, rubbing)
    oily = area * (1.0 - shares.load) / shares.raised
    return _Point(
        shares,
        rubbing,
        along,
        turned,
        touching,
        pressure,
        shear,
        area * touching * shear,
        area,
        oily,
        shares.raised * largest,
        rubbing / shares.gap,
        abs(float(scene.boundary_friction.grip(rubbing))),
    )


def _oil_friction(
    case: Case, hertz: Hertz, points: list[_Point], further: float
) -> tuple[list[float], MeanHeat | None]:
    """Friction of the oil [N] at the points, and the heat where it warms the film."""
    oily, pressures, rates, grips = np.array([point[-4:] for point in points]).T
    warmer = _WARMER[: len(points)]
    start = case.op.inlet_temperature + warmer

    def friction(warm: Array) -> Array:
        return oily * oil_shear(scene, hertz, pressures, rates, grips, warm)

    if not isinstance(scene.heat, TemperatureField):
        return friction(start).tolist(), None
    solid, rubbing, areas, gaps = np.array([(p.solid, p.rubbing, p.area, p.shares.gap) for p in points]).T
    first, second = np.full(6, op.speed_1, np.float64), np.full(6, op.speed_2, np.float64)
    first[1], second[1] = op.speed_1 + 0.5 * further, op.speed_2 - 0.5 * further
    first[5], second[5] = op.speed_1 + _faster(op), op.speed_2 + _faster(op)
    one, two = op.bodies
    bodies = (one + warmer, two + warmer)
    heat = MeanHeat.of(scene.heat, hertz, (first, second), bodies, areas, gaps, scene.lubricant.conductivity)
    warm = heat.film(start, lambda film: np.abs((solid + friction(film)) * rubbing))
    return friction(warm).tolist(), heat


def _flash_rise(scene: Scene, shear: float, sliding: float) -> float:
    """Flash temperature rise [K] of a spot as wide as the rougher body's correlation length."""
    if not isinstance(scene.heat, FlashTemperature) or shear == 0.0:
        return 0.0
    rougher = scene.surface_1 if scene.surface_1.rq > scene.surface_2.rq else scene.surface_2
    rise: Law = scene.heat.rise
    return float(rise(0.5 * rougher.correlation_length, shear, sliding))
