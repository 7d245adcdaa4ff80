"""The fast level, `film.model = "regression"`: one mean film, one mean real contact, and the means of both surfaces.

A step solves nothing: the film is a formula's, curves fitted to the deterministic level share the load, and what the
surfaces have become is a handful of numbers per body. The patches of the state wait meanwhile; `folded` brings them up
to date when a run goes back to the deterministic level.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .evolution import track_length, track_rows
from .film import Regression
from .film.instant import Grid
from .laws.heat import FlashTemperature, TemperatureField
from .patches import bare_heights, roughness_of
from .reference import inlet_shear_factor, moes_film
from .scene import OperatingPoint, Scene
from .state import Body, ContactState, Mean, Outputs, RangeFlag, changed
from .surfaces import rms_roughness

Array = NDArray[np.float64]
Means = tuple[Mean, Mean]
# laws take anything that broadcasts: plain floats, which are faster than arrays of one, and arrays of temperatures
Law = Callable[..., Any]

_LAMBDA_CAP = 1e3
_SAME = 1e-4  # a contact evaluated before the surfaces changed by less, relative, is the contact after it
_LONGEST = 10.0  # times the duty: no step need be shorter than that
_TRIAL = 1.0  # s: step that tells how fast the surfaces change

# quadrature over the Hertz ellipse: at the distance sqrt(1 - t^2) from its centre p is in proportion to t, dA to t dt
_T = 0.5 + 0.5 * np.polynomial.legendre.leggauss(10)[0]
_WEIGHTS = _T * np.polynomial.legendre.leggauss(10)[1]  # of the mean over the ellipse

# nine operating points: as it is, then up and down by sliding, entrainment, load, temperature
_D, _KELVIN = 1e-4, 1e-2  # how far, relative, and in temperature
_SLIDING, _ENTRAINMENT, _LOAD, _TEMPERATURE = np.concatenate(
    [np.zeros((4, 1)), np.kron(np.eye(4), [1.0, -1.0])], axis=1
)
_SLIDING, _TEMPERATURE, _FASTER = _D * _SLIDING, _KELVIN * _TEMPERATURE, 1.0 + _D * _ENTRAINMENT
_ROOT = np.cbrt(1.0 + _D * _LOAD)  # lengths and pressures of Hertz's contact at these points, relative
_ROOT_2 = _ROOT * _ROOT
_TINY = 1e-6  # relative step of a slope by one difference
_LAMBDA_CAPPED, _OUTSIDE_FIT = int(RangeFlag.LAMBDA_CAPPED), int(RangeFlag.OUTSIDE_FIT)
_TRIBOFILM_TEMPERATURE = int(RangeFlag.TRIBOFILM_TEMPERATURE)  # numbers are faster to add up
_BLANK = Outputs()
_PROBE = np.array([[0.0], [1e6]])  # Pa: pressures that tell viscosity and its pressure coefficient
_WARMTHS = np.array([0.0, _KELVIN, -_KELVIN])
_SPIN = 3.0 * math.pi / 16.0  # mean lever of friction under Hertz's pressure, over a
_ROUNDS, _SETTLED = 30, 1e-7  # of the oil's temperature: at most, and the change [K] that ends them
_SLOWEST, _LIGHTEST = 1e-30, 1e-9  # m/s, N: less makes no other film, and would divide by zero


class Film(NamedTuple):
    """What the tribofilm makes of a body."""

    thickness: float  # mean where there is one [m]
    roughness: float  # rms deviation of its thickness over the track [m]
    both: float  # rms roughness of solid and tribofilm [m]


Films = tuple[Film, Film]


class _Fit(NamedTuple):
    """Where a contact lies among the points of the fit; see `load_sharing.FittedSharing`."""

    clearance: float
    flattening: float
    resolution: float


_UNFITTED = _Fit(math.inf, 0.0, 0.0)  # smooth bodies, or no load


class _Contact(NamedTuple):
    """The contact of an operating point and of the surfaces as they were."""

    films: Films
    sigma: float  # composite rms roughness [m]
    cover: float  # mean cover of both bodies where they touch
    fit: _Fit
    gap: float  # mean, of the oil [m]
    load_ratio: float
    area_ratio: float
    solid: float  # friction of the solids on body 1 along +x [N]
    fluid: float
    derivatives: tuple[float, ...]  # of the sum, by speed_1, speed_2, load, temperature
    solid_pressure: float  # mean over the real contact [Pa]
    solid_shear: float  # mean over it, absolute
    fluid_shear: float  # mean over the oil that carries load
    rise: float  # of the surfaces' temperature over the bulk [K]
    slide: float  # sliding speed, with spin [m/s]
    power: float  # [W]
    into_1: float  # part of it that goes into body 1 [W]
    spin_torque: float  # on body 1 [N m]


class _Heat(NamedTuple):
    """Heat of friction that leaves through the Hertz ellipse, at the nine operating points; both surfaces as warm."""

    conductance_1: Array  # of the bodies [W/(m2 K)]
    conductance_2: Array
    body_1: Array  # bulk temperatures [K]
    body_2: Array
    areas: Array  # [m2]
    across: Array  # rise of the oil over the surfaces, per heat [m2 K/W]

    @staticmethod
    def of(
        law: TemperatureField, op: OperatingPoint, radius: Array, areas: Array, gaps: Array, oil_conductivity: float
    ) -> "_Heat":
        """Both bodies as half spaces under an even source on a circle of `radius` [m] that holds still."""
        first, second = law.conductances(radius, (op.speed_1, op.speed_2))
        one, two = op.bodies
        across = gaps / (12.0 * oil_conductivity)
        return _Heat(first, second, one + _TEMPERATURE, two + _TEMPERATURE, areas, across)

    def _surfaces(self, power: Array) -> Array:
        """Temperature [K] of the surfaces under a power [W]."""
        one, two = self.conductance_1, self.conductance_2
        return (power / self.areas + one * self.body_1 + two * self.body_2) / (one + two)

    def film(self, start: Array, power: Callable[[Array], Array]) -> Array:
        """Temperature [K] of the oil with which its friction makes it that warm, by Steffensen's method."""

        def warmed(film: Array) -> Array:
            heat = power(film)
            return self._surfaces(heat) + heat / self.areas * self.across

        film = start
        for _ in range(_ROUNDS):
            first = warmed(film)
            second = warmed(first)
            bend = second - 2.0 * first + film
            jump = np.divide((first - film) ** 2, bend, out=np.zeros_like(bend), where=np.abs(bend) > 1e-12)
            film, change = np.where(np.abs(bend) > 1e-12, film - jump, second), np.abs(second - first).max()
            film = np.clip(film, np.minimum(start, second), np.maximum(first, second) + np.abs(first - start))
            if change < _SETTLED:
                break
        return film

    def surface(self, power: float) -> tuple[float, float]:
        """Rise [K] of the surfaces over the bodies' mean and heat [W] into body 1, at the first point."""
        warm = float(self._surfaces(np.full_like(self.areas, power))[0])
        into_1 = float(self.areas[0] * self.conductance_1[0]) * (warm - float(self.body_1[0]))
        return warm - 0.5 * float(self.body_1[0] + self.body_2[0]), into_1


def advance_means(scene: Scene, op: OperatingPoint, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """`advance` at this level, for inputs that have been checked."""
    before = state.means or means_of(scene, state)
    means, films, left = before, films_of(before), dt
    contact = _evaluate(scene, op, films)
    speed = 0.0  # at which the surfaces change [m/s]
    while left > 0.0:
        step, means, films, speed = _stepped(scene, op, contact, means, left)
        left -= step
        if _has_changed(scene, contact, films):
            contact = _evaluate(scene, op, films)
    if dt > 0.0:
        rates = [(now.worn - then.worn) / dt for now, then in zip(means, before, strict=True)]
    else:
        speed = _stepped(scene, op, contact, means, _TRIAL)[3]
        rates = [_wear_rate(scene, op, contact, i, films[i].thickness) for i in (0, 1)]
    outputs = _outputs(scene, op, state.outputs, contact, means, films, rates, speed)
    return changed(state, time=state.time + dt, means=means, outputs=outputs, solved_for=None), outputs


# the contact


def _evaluate(scene: Scene, op: OperatingPoint, films: Films) -> _Contact:
    """Film, load sharing and friction at the operating point, and at eight beside it for the derivatives."""
    sigma, cover = _sigma(films), _cover(scene, films)
    if op.load == 0.0:
        return _apart(scene, films, sigma, cover)
    entrained, sliding, temperature = abs(op.entrainment_speed), op.sliding_speed, op.inlet_temperature
    slip = max(abs(sliding), scene.boundary_friction.slip_speed)
    slides = sliding + slip * _SLIDING
    hertz, scale = scene.unit_hertz, op.load ** (1 / 3)
    pressures = (hertz.pressure_max * scale) * _ROOT
    areas = (hertz.area * scale * scale) * _ROOT_2
    film = _smooth_films(scene, entrained, op.load, temperature)
    if scene.heat.inlet_shear != "none" and entrained > 0.0:
        film = film * _inlet_factors(scene, entrained, slides, pressures, temperature)
    fit, gaps, solid_share, area_share, raised = _shared(scene, films, sigma, film, pressures)
    carried = solid_share * pressures
    carried *= 2.0 / 3.0  # mean over the Hertz area
    # no solid contact is smaller than the hardness allows
    touching = np.maximum(area_share, carried / scene.plasticity.hardness)
    solid_pressures = carried / (touching + 1e-300)
    turning = _SPIN * op.spin * hertz.a * scale  # speed of the spin
    rubbing = np.hypot(slides, turning * _ROOT) if op.spin else slides
    boundary: Law = scene.boundary_friction
    solid_shears = boundary(solid_pressures, cover, rubbing)
    solid, oily = areas * touching * solid_shears, areas * (1.0 - solid_share) / raised

    def oil(warm: Array) -> Array:
        return oily * oil_shear(scene, raised * pressures, rubbing / gaps, warm)

    fluid = oil(temperature + _TEMPERATURE)
    if isinstance(scene.heat, TemperatureField):
        circle = math.sqrt(hertz.a * hertz.b) * scale * _ROOT
        heat = _Heat.of(scene.heat, op, circle, areas, gaps, scene.lubricant.conductivity)
        fluid = oil(heat.film(temperature + _TEMPERATURE, lambda warm: np.abs((solid + oil(warm)) * rubbing)))
    slide, pull = abs(float(rubbing[0])), abs(float(solid[0] + fluid[0]))
    pressure, shear = float(solid_pressures[0]), abs(float(solid_shears[0]))
    if isinstance(scene.heat, TemperatureField):
        rise, into_1 = heat.surface(pull * slide)
    else:
        rise, into_1 = _flash_rise(scene, shear, slide), 0.5 * pull * slide
    oil_stress = abs(float(fluid[0])) / float(oily[0]) if oily[0] > 0.0 else 0.0
    if op.spin:
        along = slides / np.maximum(rubbing, _SLOWEST)
        solid, fluid = solid * along, fluid * along
    forces = (solid + fluid).tolist()  # on body 2
    by_sliding = -_slope(forces, 1, _D * slip)
    by_entrainment = -_slope(forces, 3, _D * entrained) * math.copysign(1.0, op.entrainment_speed)
    return _Contact(
        films,
        sigma,
        cover,
        fit,
        float(gaps[0]),
        float(solid_share[0]),
        float(touching[0]),
        -float(solid[0]),
        -float(fluid[0]),
        (
            0.5 * by_entrainment + by_sliding,
            0.5 * by_entrainment - by_sliding,
            -_slope(forces, 5, _D * op.load),
            -_slope(forces, 7, _KELVIN),
        ),
        pressure,
        shear,
        oil_stress,
        rise,
        slide,
        pull * slide,
        into_1,
        -_SPIN * hertz.a * scale * pull * turning / max(slide, _SLOWEST),
    )


def _apart(scene: Scene, films: Films, sigma: float, cover: float) -> _Contact:
    """Without load the bodies just touch and nothing presses."""
    return _Contact(
        films, sigma, cover, _UNFITTED, max(sigma, scene.film.floor), 0.0, 0.0, 0.0, 0.0, (0.0,) * 4, *(0.0,) * 8
    )


def _slope(forces: list[float], row: int, step: float) -> float:
    """Central difference of two rows; zero if they are the same point."""
    return (forces[row] - forces[row + 1]) / (2.0 * step) if step > 0.0 else 0.0


def scene_film(scene: Scene) -> Regression:
    """The scene's film, which is of this level."""
    assert isinstance(scene.film, Regression)
    return scene.film


def _smooth_films(scene: Scene, speed: float, load: float, temperature: float) -> Array:
    """Nijenbanning, Venner & Moes' central film [m] of the smooth bodies, at the nine operating points.

    Beside the first one by its powers of viscosity times speed, load and pressure coefficient.
    """
    (eta, alpha), (thin, alpha_thin), (thick, alpha_thick) = _oil(scene.lubricant.viscosity, temperature)
    radius, modulus = scene.geometry.radius_x, scene.solids.reduced_modulus
    ratio = radius / scene.geometry.radius_y
    root = math.sqrt(2.0 * eta * max(speed, _SLOWEST) / (modulus * radius))
    quarter = math.sqrt(root)
    m = max(load, _LIGHTEST) / (modulus * radius * radius * root * quarter)
    oil = alpha * modulus * quarter
    film = moes_film(m, oil, ratio)
    by_load = (moes_film(m * (1.0 + _TINY), oil, ratio) / film - 1.0) / _TINY
    by_alpha = (moes_film(m, oil * (1.0 + _TINY), ratio) / film - 1.0) / _TINY
    by_speed = 0.5 - 0.75 * by_load + 0.25 * by_alpha
    now = film * root * radius
    warmer = by_speed * math.log(thin / eta) + by_alpha * math.log(alpha_thin / alpha)
    cooler = by_speed * math.log(thick / eta) + by_alpha * math.log(alpha_thick / alpha)
    faster, heavier = 1.0 + _D * by_speed, 1.0 + _D * by_load
    beside = (faster, 2.0 - faster, heavier, 2.0 - heavier, 1.0 + warmer, 1.0 + cooler)
    return now * np.array([1.0, 1.0, 1.0, *beside])


def _inlet_factors(scene: Scene, speed: float, slides: Array, pressures: Array, temperature: float) -> Array:
    """Films with the heat of shear in the inlet over those without, at the nine operating points."""
    (eta, _), (thin, _), (thick, _) = _oil(scene.lubricant.viscosity, temperature)
    beta = math.log(thick / thin) / (2.0 * _KELVIN)
    viscosities = np.full(9, eta)
    viscosities[7:] = thin, thick
    solid = (scene.lubricant.conductivity, scene.solids.reduced_modulus)
    points = zip(viscosities.tolist(), (speed * _FASTER).tolist(), slides.tolist(), pressures.tolist(), strict=True)
    factors = [inlet_shear_factor(v, beta, u, slide / u, solid[0], p, solid[1]) for v, u, slide, p in points]
    return np.array(factors)


@lru_cache(maxsize=16)
def _oil(viscosity: Law, temperature: float) -> list[tuple[float, float]]:
    """Viscosity [Pa s] and pressure coefficient [1/Pa] at p = 0, at a temperature [K] and a little above and below."""
    low, high = viscosity(_PROBE, temperature + _WARMTHS).tolist()
    return [(eta, max(math.log(stiff / eta) * 1e-6, 1e-12)) for eta, stiff in zip(low, high, strict=True)]


def _shared(
    scene: Scene, films: Films, sigma: float, film: Array, pressures: Array
) -> tuple[_Fit, Array, Array, Array, Array]:
    """Where the contact lies in the fit; mean gaps [m], contact_load_ratio, contact_area_ratio and pressure of the oil
    over Hertz's, of rough bodies, for films of smooth ones [m] and Hertz's largest pressures [Pa].
    """
    floor, sharing = scene.film.floor, scene_film(scene).sharing
    if sigma == 0.0:
        touching = (film <= floor).astype(np.float64)
        return _UNFITTED, np.maximum(film, floor), touching, touching, np.ones_like(film)
    first, second = scene.surface_1, scene.surface_2
    slope = 2.0 * math.hypot(films[0].both / first.correlation_length, films[1].both / second.correlation_length)
    resolution = (first if first.rq > second.rq else second).correlation_length / scene.film.spacing
    clearance, flattening = film / sigma, pressures * (4.0 / 3.0 / (scene.solids.reduced_modulus * slope))
    fit = _Fit(float(clearance[0]), float(flattening[0]), resolution)
    (flattest, fullest), (coarsest, finest) = sharing.FITTED["flattening"], sharing.FITTED["resolution"]
    if not flattest <= fit.flattening <= fullest:  # powers of it mean nothing far from the fit
        flattening = np.full_like(film, min(max(fit.flattening, flattest), fullest))
    resolution = min(max(resolution, coarsest), finest)
    share = sharing.load_ratio(clearance, flattening, resolution)
    gaps = np.maximum(sigma * sharing.film_ratio(clearance, share, flattening, resolution), floor)
    return fit, gaps, share, sharing.area_ratio(share, flattening), sharing.oil_pressure(clearance, flattening)


def oil_shear(scene: Scene, pressures: Array, rates: Array, temperatures: Array) -> Array:
    """Mean shear stress [Pa] of oil under Hertz's semi-ellipsoids of largest `pressures`, one for each row."""
    local = pressures[:, None] * _T
    viscosity: Law = scene.lubricant.viscosity
    newtonian = viscosity(local, temperatures[:, None]) * rates[:, None]
    return scene.lubricant.rheology(newtonian, local) @ _WEIGHTS


def _flash_rise(scene: Scene, shear: float, sliding: float) -> float:
    """Flash temperature rise [K] of a spot as wide as the rougher body's correlation length."""
    if not isinstance(scene.heat, FlashTemperature) or shear == 0.0:
        return 0.0
    rougher = scene.surface_1 if scene.surface_1.rq > scene.surface_2.rq else scene.surface_2
    rise: Law = scene.heat.rise
    return float(rise(0.5 * rougher.correlation_length, shear, sliding))


# the surfaces


def films_of(means: Means) -> Films:
    """The tribofilms of both bodies."""
    first, second = means
    return _film_of(first), _film_of(second)


def _film_of(mean: Mean) -> Film:
    """A tribofilm that lies evenly on the highest part of a track of Gaussian heights (assumed)."""
    share = mean.coverage
    if share == 0.0:
        return Film(0.0, 0.0, mean.roughness)
    thickness = max(mean.growth - mean.removal, 0.0) / share
    apart = share * (1.0 - share)
    roughness = math.sqrt(apart) * thickness
    # the normal density at the height above which `share` of the heights lie, to 8 % from 2 to 98 %
    density = 0.3989 * (4.0 * apart) ** 0.8
    heights = mean.roughness
    return Film(
        thickness, roughness, math.sqrt((heights + 2.0 * density * thickness) * heights + roughness * roughness)
    )


def _sigma(films: Films) -> float:
    """Composite rms roughness [m]."""
    return math.hypot(films[0].both, films[1].both)


def _cover(scene: Scene, films: Films) -> float:
    """Mean cover of both bodies where they touch."""
    return min(0.5 * (films[0].thickness + films[1].thickness) / scene.tribofilm.full_thickness, 1.0)


def _stepped(
    scene: Scene, op: OperatingPoint, contact: _Contact, means: Means, left: float
) -> tuple[float, Means, Films, float]:
    """Time [s], at most `left`, in which the surfaces change by control.change; they after it; their speed [m/s]."""
    step, budget = left, scene.control.change
    while True:
        after = _evolved(scene, op, contact, means, step)
        change = max(_distance(means[0], after[0]), _distance(means[1], after[1]))
        if change <= 1.01 * budget:
            return step, after, films_of(after), change / step
        step *= min(max(budget / change, 0.05), 0.95)


def _distance(then: Mean, now: Mean) -> float:
    """Change [m] of a body's tribofilm, as rms over the track, and of its solid's roughness."""
    film = abs((now.growth - now.removal) - (then.growth - then.removal))
    return film / math.sqrt(max(now.coverage, 1e-3)) + abs(now.roughness - then.roughness)


def _has_changed(scene: Scene, contact: _Contact, films: Films) -> bool:
    """Whether the surfaces are others than those that the contact was evaluated for."""
    return (
        abs(_sigma(films) - contact.sigma) > _SAME * contact.sigma or abs(_cover(scene, films) - contact.cover) > _SAME
    )


def _evolved(scene: Scene, op: OperatingPoint, contact: _Contact, means: Means, step: float) -> Means:
    """Both bodies after `step` [s] of what the contact does to them."""
    (first, second), doses = _doses(scene, op, contact, means)
    return (
        _body_after(scene, op, contact, 0, means[0], step, first, doses[0] * step),
        _body_after(scene, op, contact, 1, means[1], step, second, doses[1] * step),
    )


def _body_after(
    scene: Scene,
    op: OperatingPoint,
    contact: _Contact,
    i: int,
    mean: Mean,
    step: float,
    coverage: float,
    exposed: float,
) -> Mean:
    """A body whose covered part was `exposed` to the tribofilm law, worn under the mean of the old and the new film.

    Wear takes heights that stand out of the composite roughness by `smoothing` of it. A body's share in such a height
    is that of its variance, so its roughness falls by smoothing Rq_i / sigma for each depth worn (assumed).
    """
    growth, removal, new = mean.growth, mean.removal, 0.0
    if coverage > 0.0:
        evolve: Law = scene.tribofilm.evolve
        abraded = _abrasion(scene, op, contact, i) * step / coverage
        warm = op.bodies[i] + contact.rise
        grown, removed = evolve(growth / coverage, removal / coverage, exposed, abraded, warm)
        growth, removal, new = float(grown) * coverage, float(removed) * coverage, max(float(grown - removed), 0.0)
    volume = step * _wear_rate(scene, op, contact, i, 0.5 * (contact.films[i].thickness + new))
    speed = (op.speed_1, op.speed_2)[i]
    depth = volume / _track_area(scene, i, speed != 0.0)
    smoother = math.exp(-scene_film(scene).smoothing * depth / contact.sigma) if contact.sigma > 0.0 else 1.0
    return Mean(
        growth,
        removal,
        coverage,
        mean.wear + depth,
        mean.roughness * smoother,
        mean.worn + volume,
        mean.cycles + abs(speed) * step / track_length(scene, i),
    )


def _wear_rate(scene: Scene, op: OperatingPoint, contact: _Contact, i: int, film: float) -> float:
    """Volume [m3/s] that a body loses under a tribofilm [m]: the law's depth rate, for force in place of pressure."""
    force, cover = contact.load_ratio * op.load, min(film / scene.tribofilm.full_thickness, 1.0)
    if force == 0.0:
        return 0.0
    speeds = (op.speed_1, op.speed_2)
    if op.spin and scene.wear.slide(speeds, i) == abs(op.sliding_speed):  # a law of sliding, not of surface speed
        speeds = contact.slide, 0.0
    rate: Law = scene.wear.rate
    return float(rate(force, cover, speeds, i, scene.plasticity.hardness))


def _track_area(scene: Scene, i: int, moving: bool) -> float:
    """Area [m2] of a body's track |y| < b; at rest, of the patch's part of it."""
    b = scene.operation.load ** (1 / 3) * scene.unit_hertz.b
    return _track_width(scene.film.points, scene.film.domain, b) * (
        track_length(scene, i) if moving else scene.film.domain
    )


@lru_cache(maxsize=64)
def _track_width(points: int, domain: float, b: float) -> float:
    """Width [m] of a patch's rows with |y| < b, at least the middle one."""
    grid = Grid.centred(points, points, domain / (points - 1))
    return grid.spacing * int((np.abs(grid.y) < max(b, 0.51 * grid.spacing)).sum())


def _doses(
    scene: Scene, op: OperatingPoint, contact: _Contact, means: Means
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Share of each track that has been rubbed, and exposure of that share per test time."""
    law, old = scene.tribofilm, (means[0].coverage, means[1].coverage)
    if not op.slides or op.load == 0.0:
        return old, (0.0, 0.0)
    pressures = np.array([contact.solid_pressure, 0.0])
    shears = np.array([contact.solid_shear, contact.fluid_shear])
    warm = op.inlet_temperature + contact.rise
    touching, oiled = law.exposure(pressures, shears, contact.slide, warm).tolist()
    first, dose_1 = _dose(scene, op, contact, 0, means[0].coverage, touching, oiled)
    second, dose_2 = _dose(scene, op, contact, 1, means[1].coverage, touching, oiled)
    return (first, second), (dose_1, dose_2)


def _dose(
    scene: Scene, op: OperatingPoint, contact: _Contact, i: int, coverage: float, touching: float, oiled: float
) -> tuple[float, float]:
    """`_doses` of one body, for the exposures of a point that touches and of one under oil."""
    rougher = (scene.surface_1.rq > scene.surface_2.rq) == (i == 0)
    dry = contact.load_ratio > scene.control.dry_above
    k, m = scene_film(scene).sharing.exposure_constants(rougher=rougher, dry=dry)
    share = -math.expm1(-k * contact.area_ratio**m)
    coverage = max(coverage, 1.0 if oiled > 0.0 else share if touching > 0.0 else 0.0)
    if coverage == 0.0:
        return 0.0, 0.0
    moving = (op.speed_1, op.speed_2)[i] != 0.0
    if scene.tribofilm.dose == "clock" and moving:
        return coverage, (share * touching + (1.0 - share) * oiled) / coverage
    mean = contact.area_ratio * touching + (1.0 - contact.area_ratio) * oiled
    return coverage, mean * _time_share(scene, op, i, moving) / coverage


def _abrasion(scene: Scene, op: OperatingPoint, contact: _Contact, i: int) -> float:
    """Rate [1/s] at which rubbing takes tribofilm from a track, mean over it; none is taken where there is none."""
    law: Any = scene.tribofilm
    if not law.abrades:
        return 0.0
    felt = contact.solid_pressure * contact.area_ratio * _time_share(scene, op, i, (op.speed_1, op.speed_2)[i] != 0.0)
    return float(law.abrasion(felt, contact.slide, None))


def _time_share(scene: Scene, op: OperatingPoint, i: int, moving: bool) -> float:
    """Share of the time that a point of the track counts as under the Hertz ellipse, by the law's dose."""
    if scene.tribofilm.dose == "contact_length":
        return 0.25 * math.pi  # a mean chord over 2a
    a = scene.unit_hertz.a
    way = track_length(scene, i) if moving else scene.film.domain
    return 0.5 * math.pi * a * op.load ** (1 / 3) / way


# the outputs


def _outputs(
    scene: Scene,
    op: OperatingPoint,
    before: Outputs,
    contact: _Contact,
    means: Means,
    films: Films,
    rates: list[float],
    speed: float,
) -> Outputs:
    """What this level can tell; the rest stays zero. Counters of solved blocks go on."""
    force = contact.solid + contact.fluid
    scale = op.load ** (1 / 3)
    hertz = scene.unit_hertz
    hot_1, hot_2 = op.bodies
    first, second = means
    longest = _LONGEST * scene.operation.duration
    return changed(
        _BLANK,
        friction_force=force,
        friction_coefficient=abs(force) / op.load if op.load > 0.0 else 0.0,
        friction_solid=contact.solid,
        friction_fluid=contact.fluid,
        dfriction_dspeed_1=contact.derivatives[0],
        dfriction_dspeed_2=contact.derivatives[1],
        dfriction_dload=contact.derivatives[2],
        dfriction_dtemperature=contact.derivatives[3],
        power_loss=contact.power,
        wear_rate_1=rates[0],
        wear_rate_2=rates[1],
        wear_volume_1=first.worn,
        wear_volume_2=second.worn,
        wear_depth_1=first.wear,
        wear_depth_2=second.wear,
        h_c=contact.gap,
        h_central=contact.gap,
        lambda_ratio=_lambda_ratio(op, contact),
        tribofilm_1=max(first.growth - first.removal, 0.0),
        tribofilm_2=max(second.growth - second.removal, 0.0),
        tribofilm_roughness_1=films[0].roughness,
        tribofilm_roughness_2=films[1].roughness,
        roughness_1=films[0].both,
        roughness_2=films[1].both,
        contact_area_ratio=contact.area_ratio,
        contact_load_ratio=contact.load_ratio,
        flash_temperature_rise=contact.rise,
        temperature_1=hot_1,
        temperature_2=hot_2,
        heat_flow_1=contact.into_1,
        heat_flow_2=contact.power - contact.into_1,
        spin_torque=contact.spin_torque,
        approach=hertz.approach * scale * scale - contact.gap,
        range_flags=_flags(scene, op, contact),
        suggested_step=min(scene.control.change / speed, longest) if speed > 0.0 else longest,
        load_cycles_1=first.cycles,
        load_cycles_2=second.cycles,
        coverage_1=first.coverage,
        coverage_2=second.coverage,
        blocks_dry=before.blocks_dry,
        blocks_mixed=before.blocks_mixed,
        blocks_fallback=before.blocks_fallback,
        **_errors(scene, op, contact),
    )


def _lambda_ratio(op: OperatingPoint, contact: _Contact) -> float:
    if contact.sigma == 0.0 or op.load == 0.0:
        return _LAMBDA_CAP
    return min(contact.gap / contact.sigma, _LAMBDA_CAP)


def _flags(scene: Scene, op: OperatingPoint, contact: _Contact) -> int:
    flags = 0
    if contact.sigma == 0.0 or op.load == 0.0:
        flags |= _LAMBDA_CAPPED
    elif not scene_film(scene).sharing.covers(*contact.fit):
        flags |= _OUTSIDE_FIT
    if not all(scene.tribofilm.covers(temperature) for temperature in op.bodies):
        flags |= _TRIBOFILM_TEMPERATURE
    return flags


def _errors(scene: Scene, op: OperatingPoint, contact: _Contact) -> dict[str, Any]:
    """Half widths (two sigma) of the errors by the fit, relative. Friction is wrong where load counts for solids and is
    oil's.
    """
    force, share = abs(contact.solid + contact.fluid), contact.load_ratio
    if force == 0.0 or contact.sigma == 0.0:
        return {}
    sharing = scene_film(scene).sharing
    error = 2.0 * sharing.load_scatter
    solid = abs(contact.solid) / (share * op.load) if share > 0.0 else 0.0
    fluid = abs(contact.fluid) / ((1.0 - share) * op.load) if share < 1.0 else 0.0
    return {
        "error_friction": min(abs(solid - fluid) * error * op.load / force, 1.0),
        "error_film": 2.0 * sharing.film_scatter,
        # no film is less sure than the share of the rougher body that is exposed
        "error_tribofilm": sharing.HALF_WIDTHS["exposure_rougher"] / sharing.exposure_rougher,
        "error_wear": min(error / share, 1.0) if share > 0.0 else 0.0,
    }


# from patches to means and back


def means_of(scene: Scene, state: ContactState) -> Means:
    """Means of the patches over the track."""
    first, second = (_mean_of(scene, state, i) for i in (0, 1))
    return first, second


def _mean_of(scene: Scene, state: ContactState, i: int) -> Mean:
    body, rows = state.bodies[i], state.rows
    track = track_rows(scene, rows)
    bare = bare_heights(scene, rows)[i]
    solid = roughness_of(bare, bare - body.wear - body.plastic)
    return Mean(
        growth=float(body.growth[track].mean()),
        removal=float(body.removal[track].mean()),
        coverage=float((body.growth[track] > 0.0).mean()),
        wear=float(body.wear[track].mean()),
        roughness=rms_roughness(solid, track_rows(scene, rows, 2.0 / 3.0)),
        worn=body.worn,
        cycles=body.cycles,
    )


def folded(scene: Scene, state: ContactState) -> ContactState:
    """The state with its patches brought up to date: the change of the means added to them.

    Tribofilm goes on where there is some and on the highest points that had none, wear in proportion to the pressure
    that the points felt last. Means that have not changed change nothing.
    """
    if state.means is None:
        return state
    old = means_of(scene, state)
    first, second = (
        body if now == then else _folded(scene, state.rows, i, body, then, now)
        for i, (body, then, now) in enumerate(zip(state.bodies, old, state.means, strict=True))
    )
    return replace(state, bodies=(first, second), means=None, solved_for=None)


def _folded(scene: Scene, rows: int, i: int, body: Body, then: Mean, now: Mean) -> Body:
    """A body whose track has gone from one mean to another."""
    track = track_rows(scene, rows)
    bare = bare_heights(scene, rows)[i]
    heights = (bare - body.wear - body.plastic)[track]
    felt = body.pressure[track]
    felt = felt / felt.mean() if felt.any() else np.ones_like(felt)
    covered = _covered(heights, body.growth[track] > 0.0, now.coverage)
    full = scene.tribofilm.full_thickness
    changed: dict[str, Any] = {
        "growth": _raised(body.growth[track], covered, then.growth, now.growth, full),
        "removal": _raised(body.removal[track], covered, then.removal, now.removal, full),
        "wear": body.wear[track] + (now.wear - then.wear) * felt,
    }
    arrays = {name: getattr(body, name).copy() for name in changed}
    for name, array in arrays.items():
        array[track] = changed[name]
    return replace(body, **arrays, worn=now.worn, cycles=now.cycles)


def _covered(heights: Array, before: NDArray[np.bool_], coverage: float) -> NDArray[np.bool_]:
    """Nodes that are to carry a tribofilm: those that did, and as many of the highest as make up the coverage."""
    more = round(coverage * heights.size) - int(before.sum())
    if more <= 0:
        return before
    order = np.argsort(np.where(before, -np.inf, heights), axis=None, kind="stable")
    after = before.copy()
    after.flat[order[-more:]] = True
    return after


def _raised(field: Array, covered: NDArray[np.bool_], then: float, now: float, most: float) -> Array:
    """A field [m] whose mean goes from `then` to `now`: up, by the same part of what is missing to `most` everywhere
    that is covered; down, by the same part of what is there.
    """
    if now <= then or not covered.any():
        return field * (now / then) if then > 0.0 else field
    room = np.where(covered, np.maximum(most - field, 0.0), 0.0)
    return field + room * ((now - then) / float(room.mean()))
