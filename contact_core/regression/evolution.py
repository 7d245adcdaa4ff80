"""The fast level, `film.model = "regression"`: the means of both surfaces over time.

A step solves nothing: `mean_contact` has the film from a formula and the friction from curves fitted to the
deterministic level, and what the surfaces have become is a handful of numbers per body. The patches of the state wait
meanwhile; `folding` brings them up to date when a run goes back to the deterministic level.
"""

import math
from functools import lru_cache
from typing import Any

import numpy as np

from ..deterministic.growth_and_wear import track_length
from ..errors import ConvergenceError
from ..film.instant import Grid
from ..scene import OperatingPoint, Scene
from ..shapes import Line
from ..state import ContactState, Mean, Outputs, changed
from ..surfaces.track_means import means_of
from .contact import MeanContact, evaluate
from .oil import Law
from .outputs import outputs_of
from .surfaces import Films, Means, composite_roughness, films_of, hardness_of, mean_cover, scene_film

_SAME = 1e-4  # a contact evaluated before the surfaces changed by less, relative, is the contact after it
_AGREED = 0.05  # of control.change: contacts before and after a step that make of the surfaces what differs less
_TRIAL = 1.0  # s: step that tells how fast the surfaces change
# pressures over their mean and what they weigh, of an exponential distribution
_PARTS, _OF_PARTS = np.polynomial.laguerre.laggauss(6)
# rows |y| / b of the track, what they weigh in its mean, and the mean pressure on each over that
_ROWS = 0.5 + 0.5 * np.polynomial.legendre.leggauss(6)[0]
_OF_ROWS = 0.5 * np.polynomial.legendre.leggauss(6)[1]
_ROWS_PRESSURE = 1.5 * (1.0 - _ROWS**2)


def advance_means(case: Case, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """`advance` at this level, for inputs that have been checked."""
    before = state.means or means_of(case.scene, state)
    means, films, left = before, films_of(before), dt
    contact = evaluate(case, films)
    speed = 0.0  # at which the surfaces change [m/s]
    while left > 0.0:
        start = means
        step, means, films, speed = _stepped(case, contact, start, left)
        left -= step
        if _has_changed(case.scene, contact, films):
            contact = evaluate(case, films)
            settled = _settled(case.scene, start, means, _evolved(case, contact, start, step))
            if settled is not means:
                means, films = settled, films_of(settled)
                contact = evaluate(case, films)
    if dt > 0.0:
        rates = [(now.worn - then.worn) / dt for now, then in zip(means, before, strict=True)]
    else:
        speed = _stepped(case, contact, means, _TRIAL)[3]
        rates = [_wear_rate(case, contact, i, films[i].thickness) for i in (0, 1)]
    if not math.isfinite(contact.solid + contact.fluid + contact.gap):
        raise ConvergenceError(
            f"Friction or film at load = {case.op.load:g} N, speeds {case.op.speed_1:g} and {case.op.speed_2:g} m/s is not finite: "
            "the laws of the oil do not reach that far. Lower load or sliding speed."
        )
    outputs = outputs_of(case, state.outputs, contact, means, films, rates, speed)
    return changed(state, time=state.time + dt, means=means, outputs=outputs, solved_for=None), outputs


def _stepped(
    case: Case, contact: MeanContact, means: Means, left: float
) -> tuple[float, Means, Films, float]:
    """Time [s], at most `left`, in which the surfaces change by control.change; they after it; their speed [m/s]."""
    step, budget = left, case.scene.control.change
    while True:
        after = _evolved(case, contact, means, step)
        change = max(_distance(means[0], after[0]), _distance(means[1], after[1]))
        if change <= 1.01 * budget:
            return step, after, films_of(after), change / step
        step *= min(max(budget / change, 0.05), 0.95)


def _settled(scene: Scene, start: Means, after: Means, again: Means) -> Means:
    """The surfaces after a step that contacts of its beginning and its end agree on, to first order.

    The contact of the start makes `after` of them, the contact after that makes `again`. Where more tribofilm grows
    less, the first goes too far, and a long step would swing about the balance of growth and removal.
    """
    first = np.array([_change(*pair) for pair in zip(start, after, strict=True)])
    second = np.array([_change(*pair) for pair in zip(start, again, strict=True)])
    back = float(np.vdot(first - second, first))
    if back <= 0.0 or float(np.abs(first - second).max()) < _AGREED * scene.control.change:
        return after
    share = 1.0 / (1.0 + back / float(np.vdot(first, first)))
    one, two = (_between(*pair, share) for pair in zip(after, again, strict=True))
    return one, two


def _between(one: Mean, other: Mean, share: float) -> Mean:
    return Mean(*(a + share * (b - a) for a, b in zip(one.__dict__.values(), other.__dict__.values(), strict=True)))


def _change(then: Mean, now: Mean) -> tuple[float, float]:
    """Changes [m] of a body's tribofilm, as rms over the track, and of its solid's roughness."""
    film = (now.growth - now.removal) - (then.growth - then.removal)
    return film / math.sqrt(max(now.coverage, 1e-3)), now.roughness - then.roughness


def _distance(then: Mean, now: Mean) -> float:
    """Size of the change [m]."""
    film, roughness = _change(then, now)
    return abs(film) + abs(roughness)


def _has_changed(scene: Scene, contact: MeanContact, films: Films) -> bool:
    """Whether the surfaces are others than those that the contact was evaluated for."""
    return (
        abs(composite_roughness(films) - contact.sigma) > _SAME * contact.sigma
        or abs(mean_cover(scene, films) - contact.cover) > _SAME
    )


def _evolved(case: Case, contact: MeanContact, means: Means, step: float) -> Means:
    """Both bodies after `step` [s] of what the contact does to them."""
    (first, second), doses = _doses(case, contact, means)
    return (
        _body_after(case, contact, 0, means[0], step, first, doses[0] * step),
        _body_after(case, contact, 1, means[1], step, second, doses[1] * step),
    )


def _body_after(
    case: Case,
    contact: MeanContact,
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
        evolve: Law = case.scene.tribofilm.evolve
        abraded = _abrasion(case, contact, i) * step / coverage
        warm = case.op.bodies[i] + contact.rise
        grown, removed = evolve(growth / coverage, removal / coverage, exposed, abraded, warm)
        growth, removal, new = float(grown) * coverage, float(removed) * coverage, max(float(grown - removed), 0.0)
    volume = step * _wear_rate(case, contact, i, 0.5 * (contact.films[i].thickness + new))
    speed = (case.op.speed_1, case.op.speed_2)[i]
    depth = volume / _track_area(case.scene, i, speed != 0.0)
    smoother = math.exp(-scene_film(case.scene).smoothing * depth / contact.sigma) if contact.sigma > 0.0 else 1.0
    return changed(
        mean,
        growth=growth,
        removal=removal,
        coverage=coverage,
        wear=mean.wear + depth,
        roughness=mean.roughness * smoother,
        worn=mean.worn + volume,
        cycles=mean.cycles + abs(speed) * step / track_length(case.scene, i),
    )


def _wear_rate(case: Case, contact: MeanContact, i: int, film: float) -> float:
    """Volume [m3/s] that a body loses under a tribofilm [m]: the law's depth rate, for force in place of pressure."""
    force, cover = contact.load_ratio * case.op.load, min(film / case.scene.tribofilm.full_thickness, 1.0)
    if force == 0.0:
        return 0.0
    speeds = (case.op.speed_1, case.op.speed_2)
    if case.op.spin and case.scene.wear.of_sliding:
        speeds = contact.slide, 0.0
    rate: Law = case.scene.wear.rate
    return float(rate(force, cover, speeds, i, case.scene.plasticity.hardness))


def _track_area(scene: Scene, i: int, moving: bool) -> float:
    """Area [m2] of a body's track |y| < b; at rest, of the patch's part of it."""
    hertz, shape = scene.unit_hertz, scene.shape()
    b = hertz.growth(scene.operation.load)[1] * hertz.b
    film = scene.film
    width = 2.0 * b if shape.periodic else _track_width(scene.rows, film.points, film.domain, b)
    return width * (track_length(scene, i) if moving else film.domain)


@lru_cache(maxsize=64)
def _track_width(rows: int, points: int, domain: float, b: float) -> float:
    """Width [m] of a patch's rows with |y| < b, at least the middle one."""
    grid = Grid.centred(rows, rows, domain / (points - 1))
    return grid.spacing * int((np.abs(grid.y) < max(b, 0.51 * grid.spacing)).sum())


def _doses(
    case: Case, contact: MeanContact, means: Means
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Share of each track that has been rubbed, and exposure of that share per test time."""
    law, old = case.scene.tribofilm, (means[0].coverage, means[1].coverage)
    if not case.op.slides or not case.loaded:
        return old, (0.0, 0.0)
    exposure: Law = law.exposure
    warm = case.op.inlet_temperature + contact.rise
    touching = _touching(case.scene, contact, warm)
    oiled = float(exposure(0.0, contact.fluid_shear, contact.slide, warm))
    first, dose_1 = _dose(case, contact, 0, means[0].coverage, touching, oiled)
    second, dose_2 = _dose(case, contact, 1, means[1].coverage, touching, oiled)
    return (first, second), (dose_1, dose_2)


def _touching(scene: Scene, contact: MeanContact, warm: float) -> float:
    """Mean exposure where solids touch. Stress counts by its exponential for laws that it activates, so that the
    pressure may not be taken as even there: it falls off exponentially up to the hardness (assumed).
    """
    law: Any = scene.tribofilm
    if not law.abrades or contact.solid_pressure == 0.0:
        return float(law.exposure(contact.solid_pressure, contact.solid_shear, contact.slide, warm))
    parts = np.minimum(_PARTS, hardness_of(scene, contact.films) / contact.solid_pressure)
    exposure = law.exposure(parts * contact.solid_pressure, parts * contact.solid_shear, contact.slide, warm)
    return float(_OF_PARTS @ exposure)


def _dose(
    case: Case, contact: MeanContact, i: int, coverage: float, touching: float, oiled: float
) -> tuple[float, float]:
    """`_doses` of one body, for the exposures of a point that touches and of one under oil."""
    first, second = case.scene.surface_1.rq, case.scene.surface_2.rq
    as_rougher = (True, False) if first == second else ((first > second) == (i == 0),)  # alike: between both curves
    area, dry = contact.area_ratio, contact.load_ratio > case.scene.control.dry_above
    curves = [scene_film(case.scene).sharing.exposed(area, rougher=rougher, dry=dry) for rougher in as_rougher]
    met = sum(curves) / len(curves)
    coverage = max(coverage, 1.0 if oiled > 0.0 else met if touching > 0.0 else 0.0)
    if coverage == 0.0:
        return 0.0, 0.0
    moving = (case.op.speed_1, case.op.speed_2)[i] != 0.0
    if case.scene.tribofilm.dose == "clock" and moving:
        return coverage, (met * touching + (1.0 - met) * oiled) / coverage
    mean = contact.area_ratio * touching + (1.0 - contact.area_ratio) * oiled
    chord = case.scene.tribofilm.dose == "contact_length"
    stay = case.unit_hertz.chord_share if chord else _residence(case, i)
    return coverage, mean * stay / coverage


def _abrasion(case: Case, contact: MeanContact, i: int) -> float:
    """Rate [1/s] at which rubbing takes tribofilm from a track, mean over it; none is taken where there is none."""
    law: Any = case.scene.tribofilm
    if not law.abrades:
        return 0.0
    felt = contact.solid_pressure * contact.area_ratio * _residence(case, i)
    if isinstance(case.scene.shape(), Line):  # even along the face
        return float(law.abrasion(np.array([felt]), contact.slide, None)[0])
    return float(_OF_ROWS @ law.abrasion(felt * _ROWS_PRESSURE, contact.slide, _ROWS))


def _residence(case: Case, i: int) -> float:
    """Share of its time that a point of the track |y| < b is in Hertz's contact."""
    way = track_length(case.scene, i) if (case.op.speed_1, case.op.speed_2)[i] != 0.0 else case.scene.film.domain
    hertz = case.unit_hertz
    return 2.0 * hertz.chord_share * hertz.a * hertz.growth(case.op.load)[0] / way
