"""One mean film, one mean real contact: film, load sharing, friction and heat of an operating point.

The film is given by a formula; curves fitted to the deterministic level share the load. Friction is evaluated at the
operating point and at five points beside it: with a little more sliding, film, load, temperature and entrainment, the
others held. Its derivatives are these differences, with those of the film by the chain rule. More entrainment is less
sliding beside it, and where the bodies' speeds decide how they take up heat, that.
"""

import math
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..laws.load_sharing import sliding_ratio
from ..scene import Case
from .load_sharing import UNFITTED, Fit, Parted, Shares, Surfaces, parted, shared, surfaces_of
from .oil import Law, MeanHeat, oil_shear
from .smooth_film import KELVIN, LIGHTEST, SLOWEST, STEP, SmoothFilm, smooth_film
from .surfaces import Tribofilms, composite_roughness, mean_cover

_WARMER = np.array([0.0, 0.0, 0.0, 0.0, KELVIN, 0.0])
_TO_KNOW = 2  # points that all but the derivatives need


class MeanContact(NamedTuple):
    """The contact of an operating point and of the surfaces as they were."""

    tribofilms: Tribofilms
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
    supplied: float  # part of that of a flooded inlet
    oil_slope: float  # d ln(its friction) / d ln(sliding speed)
    hottest: float  # largest temperature of the surfaces [K]
    stated: "Stated | None" = None  # errors where another level knows them better than the curves


class Stated(NamedTuple):
    """Half widths (95 %) of a corrected contact."""

    friction: float  # relative
    film: float  # relative, of the gap
    load: float  # absolute, of load_ratio
    trust: float  # 1 where the correction holds, 0 where there is none


class _Point(NamedTuple):
    """The solids at an operating point, and the load and shear of its oil."""

    shares: Shares
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


def evaluate(case: Case, tribofilms: Tribofilms, derivatives: bool = True) -> MeanContact:
    """Return the contact of an operating point and its derivatives; without load the bodies just touch.

    Without `derivatives` those are zero, at a third of the cost.
    """
    scene, op = case.scene, case.op
    if op.load < LIGHTEST:
        sigma, cover = composite_roughness(tribofilms), mean_cover(scene, tribofilms)
        gap = max(sigma, scene.film.floor)
        return MeanContact(
            tribofilms, sigma, cover, UNFITTED, gap, *(0.0,) * 4, (0.0,) * 4, *(0.0,) * 9, 1.0, 0.0, max(op.bodies)
        )
    sliding, surfaces = op.sliding_speed, surfaces_of(case, tribofilms)
    further = STEP * math.copysign(max(abs(sliding), scene.boundary_friction.slip_speed), sliding)
    smooth = smooth_film(case, further)
    points = _points(case, surfaces, smooth.film, further)[: None if derivatives else _TO_KNOW]
    fluid, heat = _oil_friction(case, points, further)
    now, slide, pull = points[0], abs(points[0].rubbing), abs(points[0].solid + fluid[0])
    if heat is None:
        rise, into_1 = _flash_rise(case, abs(now.shear), slide), 0.5 * pull * slide
        hottest = max(op.bodies) + rise
    else:
        rise, into_1 = heat.surface(pull * slide)
        hottest = max(heat.hottest(pull * slide), *op.bodies)
    slope = _slope(points, fluid)
    solid = [point.solid * point.turned for point in points]
    oil = [force * _between(point, slope) for point, force in zip(points, fluid, strict=True)]
    forces = [one + other for one, other in zip(solid, oil, strict=True)]
    held = math.sqrt(now.shares.load) * (1.0 - min(math.sqrt(smooth.film / now.shares.gap), 1.0))
    turning = pull * slide - abs(forces[0] * op.sliding_speed)  # power that sliding leaves to spin
    return MeanContact(
        tribofilms,
        composite_roughness(tribofilms),
        surfaces.cover,
        now.shares.fit,
        now.shares.gap,
        now.shares.load,
        now.touching,
        -solid[0],
        -oil[0],
        _derivatives(case, smooth, forces, further) if derivatives else (0.0,) * 4,
        now.pressure,
        abs(now.shear),
        abs(fluid[0]) / now.oily if now.oily > 0.0 else 0.0,
        rise,
        slide,
        pull * slide,
        into_1,
        -turning / op.spin if op.spin != 0.0 else 0.0,
        smooth.rolling * (1.0 - held),  # the inlet is open where solids hold it so
        smooth.supplied,
        slope,
        hottest,
    )


def _slope(points: list[_Point], fluid: list[float]) -> float:
    """Return the power of the sliding speed with which the oil's friction grows; at rest that of a Newtonian oil."""
    now, sliding = points[0].rubbing, points[1].rubbing
    if now == sliding or fluid[0] == 0.0:
        return 1.0
    spread = points[0].oily / points[1].oily  # solids that carry less leave it more
    return (spread * fluid[1] / fluid[0] - 1.0) * now / (sliding - now)


def _between(point: _Point, slope: float) -> float:
    """Return the share of friction along x that grows with a power, 0 to 1, of the sliding speed."""
    newtonian = min(max(slope, 0.0), 1.0)
    return point.turned + (point.along - point.turned) * newtonian


def _points(case: Case, surfaces: Surfaces, film: float, further: float) -> list[_Point]:
    """Return the operating point, and those with more sliding (by `further` [m/s]), film, load, temperature, speed."""
    hertz, slide, speed = case.unit_hertz, case.op.sliding_speed, case.op.entrainment_speed
    (root, wide), (longer, wider) = case.growth, hertz.growth(1.0 + STEP)
    grown, more = (root, wide), (root * longer, wide * wider)
    here = parted(case, surfaces, film, grown)
    now = _point(case, surfaces, here, grown, slide, speed)
    return [
        now,
        _point(case, surfaces, here, grown, slide + further, speed),
        _point(case, surfaces, parted(case, surfaces, film * (1.0 + STEP), grown), grown, slide, speed),
        _point(case, surfaces, parted(case, surfaces, film, more), more, slide, speed),
        now,
        _point(case, surfaces, here, grown, slide, speed + _faster(case)),
    ]


def _point(
    case: Case, surfaces: Surfaces, parted: Parted, grown: tuple[float, float], slide: float, speed: float
) -> _Point:
    """Return the solids of bodies that are parted, at a sliding and an entrainment speed [m/s].

    The load is that at which the contact at 1 N has `grown` by factors.
    """
    root, wide = grown
    hertz, spin, boundary = case.unit_hertz, case.op.spin, case.scene.boundary_friction
    rubbing, along, turned = slide, 1.0, 1.0
    if spin != 0.0:
        edge = spin * hertz.b * wide
        rubbing = math.hypot(slide, hertz.lever_share * edge)
        along = slide / max(rubbing, SLOWEST)
        turned = slide / max(math.hypot(slide, hertz.turn_share * edge), SLOWEST)
    shares = shared(case, parted, sliding_ratio(rubbing, speed))
    largest, area = hertz.pressure_max * root, hertz.area * root * wide
    carried = hertz.mean_share * shares.load * largest  # mean over the Hertz area
    touching = max(shares.area, carried / surfaces.hardness)  # the hardness allows no smaller contact
    pressure = carried / (touching + 1e-300)
    stress: Law = boundary
    shear = stress(pressure, surfaces.cover, rubbing)
    if surfaces.oxide != 0.0:
        shear = shear + surfaces.oxide * pressure * boundary.grip(rubbing)
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
        parted.oil_pressure,
        rubbing / shares.gap,
        abs(float(boundary.grip(rubbing))),
    )


def _oil_friction(case: Case, points: list[_Point], further: float) -> tuple[list[float], MeanHeat | None]:
    """Return the friction of the oil [N] at the points, and the heat where it warms the film."""
    scene, op, hertz = case.scene, case.op, case.unit_hertz
    kept, pressures, rates, grips = np.array(
        [(p.oily * p.shares.kept, p.oil_pressure, p.oil_rate, p.grip) for p in points]
    ).T
    warmer, count = _WARMER[: len(points)], len(points)
    start = op.inlet_temperature + warmer

    def friction(warm: Array) -> Array:
        return kept * oil_shear(scene, hertz, pressures, rates, grips, warm)

    if not scene.heat.warms_film:
        return friction(start).tolist(), None
    solid, rubbing, areas, gaps = np.array([(p.solid, p.rubbing, p.area, p.shares.gap) for p in points]).T
    one, two, more, faster = op.speed_1, op.speed_2, 0.5 * further, _faster(case)
    first = np.array([one, one + more, one, one, one, one + faster][:count])
    second = np.array([two, two - more, two, two, two, two + faster][:count])
    one, two = op.bodies
    bodies = (one + warmer, two + warmer)
    conductivity = scene.lubricant.conductivity_under(hertz.mean_share * pressures)
    heat = MeanHeat.of(scene.heat, hertz, (first, second), bodies, areas, gaps, conductivity)
    warm = heat.film(start, lambda film: np.abs((solid + friction(film)) * rubbing))
    return friction(warm).tolist(), heat


def _flash_rise(case: Case, shear: float, sliding: float) -> float:
    """Return the flash temperature rise [K] of a spot as wide as the rougher body's correlation length."""
    if shear == 0.0:
        return 0.0
    return float(case.scene.heat.spot_rise(0.5 * case.sides[case.scene.rougher].surface.length, shear, sliding))


def _faster(case: Case) -> float:
    """Return by how much [m/s] entrainment is more at the last point."""
    return STEP * max(case.fastest, SLOWEST)


def _derivatives(
    case: Case, smooth: SmoothFilm, forces: list[float], further: float
) -> tuple[float, float, float, float]:
    """Return the derivatives of the friction on body 1 along +x, from `forces` on body 2 [N].

    They are those by speed_1, speed_2, load and temperature.
    """
    now, sliding, thicker, heavier, warmer, faster = forces
    by_film = (now - thicker) / STEP
    by_sliding = (now - sliding) / further + by_film * smooth.by_sliding
    by_speed = 0.5 * by_film * smooth.by_speed + 0.5 * (now - faster) / _faster(case)
    by_load = (now - heavier) / (STEP * case.op.load) + by_film * smooth.by_load
    by_temperature = (now - warmer) / KELVIN + by_film * smooth.by_temperature
    return by_speed + by_sliding, by_speed - by_sliding, by_load, by_temperature
