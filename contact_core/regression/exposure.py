"""Exposure, abrasion and wear of a body's track in a mean contact."""

from typing import Any

import numpy as np

from ..laws.tribofilm import DOSES, MeanPasses
from ..scene import Case, Side
from ..state import Mean
from .contact import MeanContact
from .oil import Law
from .surfaces import Means, hardness_of, regression_film

# pressures over their mean and what they weigh, of an exponential distribution
_PARTS, _OF_PARTS = np.polynomial.laguerre.laggauss(6)
# rows |y| / b of the track, what they weigh in its mean, and the mean pressure on each over that
_ROWS = 0.5 + 0.5 * np.polynomial.legendre.leggauss(6)[0]
_OF_ROWS = 0.5 * np.polynomial.legendre.leggauss(6)[1]
_ROWS_PRESSURE = 1.5 * (1.0 - _ROWS**2)

Dose = tuple[float, float]  # share of a track that carries a tribofilm, and exposure of that share per test time


def doses(case: Case, contact: MeanContact, means: Means) -> tuple[Dose, Dose]:
    """Return the dose of each track."""
    if not case.op.slides or not case.loaded:
        return (means[0].coverage, 0.0), (means[1].coverage, 0.0)
    warm = case.op.inlet_temperature + contact.rise
    touching = case.slipping(contact.slide) * _touching(case, contact, warm)
    oiled = _oiled(case, contact, warm)
    first, second = (
        _dose(case, side, contact, mean, touching, oiled) for side, mean in zip(case.sides, means, strict=True)
    )
    return first, second


def _touching(case: Case, contact: MeanContact, warm: float) -> float:
    """Return the mean exposure where solids touch.

    Laws that stress activates take it in an exponential, so that the pressure may not be taken as even there: it falls
    off exponentially up to the hardness (assumed).
    """
    law: Any = case.scene.tribofilm
    if not law.abrades or contact.solid_pressure == 0.0:
        return float(law.exposure(contact.solid_pressure, contact.solid_shear, contact.slide, warm))
    parts = np.minimum(_PARTS, hardness_of(case.scene, contact.tribofilms) / contact.solid_pressure)
    exposure = law.exposure(parts * contact.solid_pressure, parts * contact.solid_shear, contact.slide, warm)
    return float(_OF_PARTS @ exposure)


def _oiled(case: Case, contact: MeanContact, warm: float) -> float:
    """Return the mean exposure under oil, whose shear stress follows Hertz's pressure where an exponential takes it."""
    law: Any = case.scene.tribofilm
    if not law.abrades:
        return float(law.exposure(0.0, contact.fluid_shear, contact.slide, warm))
    parts, weights = case.unit_hertz.pressure_nodes
    shear = contact.fluid_shear / float(weights @ parts[:, 0]) * parts[:, 0]
    return float(weights @ law.exposure(0.0 * shear, shear, contact.slide, warm))


def _dose(case: Case, side: Side, contact: MeanContact, mean: Mean, touching: float, oiled: float) -> Dose:
    """Return the dose of one body, for the exposures of a point in solid contact and of one under oil."""
    exposed, rubbed = _exposed(case, side, contact, mean)
    coverage = max(mean.coverage, 1.0 if oiled > 0.0 else rubbed if touching > 0.0 else 0.0)
    if coverage == 0.0:
        return 0.0, 0.0
    passes = MeanPasses(
        moves=side.moves,
        exposed=exposed,
        touching=contact.area_ratio,
        chord=case.unit_hertz.chord_share * _width(case),
        residence=_residence(case, side),
    )
    law: Any = case.scene.tribofilm
    return coverage, min(DOSES[law.dose].mean(touching, oiled, passes) / coverage, law.most_exposure)


def _exposed(case: Case, side: Side, contact: MeanContact, mean: Mean) -> tuple[float, float]:
    """Return the mean exposure of a track to solids in a pass, and the share of it that they rub."""
    scene = case.scene
    first, second = scene.surface_1.rms, scene.surface_2.rms
    as_rougher = (True, False) if first == second else ((first > second) == (side.body == 0),)  # alike: between both
    width = _width(case)
    dry = scene.control.driver == "dry" and DOSES[scene.tribofilm.dose].whole_pass  # it has fewer instants in a pass
    sharing = regression_film(scene).sharing
    curves = [sharing.exposed(contact.area_ratio, rougher=rougher, dry=dry) for rougher in as_rougher]
    exposed = sum(curves) / len(curves)
    if case.microroughness is None or exposed == 0.0:  # a point touches with all of its area, or not at all
        return width * exposed, width * exposed
    growth = min(mean.growth / (width * scene.tribofilm.full_thickness), 1.0)
    shares = [sharing.coverage(exposed, growth, rougher=rougher) for rougher in as_rougher]
    return width * exposed, width * sum(shares) / len(shares)


def abrasion(case: Case, side: Side, contact: MeanContact) -> float:
    """Return the rate [1/s] at which rubbing takes tribofilm from a track, mean over it; zero where there is none."""
    law: Any = case.scene.tribofilm
    by_wear = _film_removal(case, side, contact)
    if not law.abrades:
        return by_wear
    pressure = mean_pressure(case, side, contact)
    if case.shape.along_face:
        return by_wear + float(law.abrasion(np.array([pressure]), contact.slide, None)[0])
    return by_wear + float(_OF_ROWS @ law.abrasion(pressure * _ROWS_PRESSURE, contact.slide, _ROWS))


def _film_removal(case: Case, side: Side, contact: MeanContact) -> float:
    """Return the rate [1/s] at which the law of wear takes tribofilm, mean over a track."""
    scene = case.scene
    if not scene.wear.wears_film:
        return 0.0
    taken: Law = scene.wear.film_removal
    hardness, full = scene.plasticity.under(1.0), scene.tribofilm.full_thickness
    return float(
        taken(mean_pressure(case, side, contact), wearing_speeds(case, contact), side.body, float(hardness), full)
    )


def mean_pressure(case: Case, side: Side, contact: MeanContact) -> float:
    """Return the solid pressure [Pa] on a point of the track, mean over its time."""
    return contact.solid_pressure * contact.area_ratio * _residence(case, side)


def wearing_speeds(case: Case, contact: MeanContact) -> tuple[float, float]:
    """Return the speeds [m/s] of both surfaces as a law of wear takes them."""
    return (contact.slide, 0.0) if case.op.spin and case.scene.wear.of_sliding else case.speeds


def _residence(case: Case, side: Side) -> float:
    """Return the share of its time that a point of the track |y| < b is in Hertz's contact."""
    length = side.track_length if side.moves else case.scene.film.domain
    hertz = case.unit_hertz
    return 2.0 * hertz.chord_share * hertz.a * case.growth[0] * _width(case) / length


def _width(case: Case) -> float:
    """Return the share of the track's width, Hertz's at the reference load, that passes through the contact."""
    now, track = case.unit_hertz, case.scene.unit_hertz
    width = case.growth[1] * now.b
    return min(width / (track.growth(case.scene.operation.load)[1] * track.b), 1.0)


def wear_rate(case: Case, side: Side, contact: MeanContact, film: float, oxide: float) -> float:
    """Return the volume [m3/s] that a body loses now under a tribofilm and with an oxide [m]."""
    law = case.scene.oxide
    rate = solid_rate(case, side, contact, film, oxide)
    if not law.grows:
        return rate
    growing, rubbing = oxidation(case, side, contact, film)
    lost = rubbing if oxide > 0.0 else min(growing, rubbing)
    return rate + steel_in(case, lost) * track_area(case, side)


def solid_rate(case: Case, side: Side, contact: MeanContact, film: float, oxide: float) -> float:
    """Return the volume [m3/s] that the solid itself loses under a tribofilm [m] and beside an oxide [m].

    It is the law's depth rate, for force as pressure.
    """
    scene, full = case.scene, case.scene.tribofilm.full_thickness
    force, cover = contact.load_ratio * case.op.load, min(film / full, 1.0)
    if force == 0.0:
        return 0.0
    law: Law = scene.wear.rate
    rate = float(law(force, cover, wearing_speeds(case, contact), side.body, scene.plasticity.hardness, full))
    return rate * (1.0 - scene.oxide.cover(oxide)) if scene.oxide.grows else rate


def oxidation(case: Case, side: Side, contact: MeanContact, film: float) -> tuple[float, float]:
    """Return the rates [m/s] at which a bare track oxidises under a tribofilm [m], and at which oxide is rubbed off."""
    law = case.scene.oxide
    left_open = float(law.left_open(film))
    rubbing = float(law.removal(mean_pressure(case, side, contact), contact.slide))
    return law.growth(side.temperature) * left_open, rubbing * left_open


def oxidised(
    case: Case, side: Side, contact: MeanContact, film: float, oxide: float, step: float
) -> tuple[float, float, float]:
    """Return an oxide [m] after `step` [s] and after half of it, and the steel lost with what was rubbed off [m].

    `film` [m] is the tribofilm meanwhile.
    """
    law = case.scene.oxide
    if not law.grows:
        return oxide, oxide, 0.0
    growing, rubbing = oxidation(case, side, contact, film)
    after, rubbed = law.evolve(oxide, growing * step, rubbing * step)
    halfway, _ = law.evolve(oxide, growing * (0.5 * step), rubbing * (0.5 * step))
    return float(after), float(halfway), steel_in(case, float(rubbed))


def steel_in(case: Case, oxide: float) -> float:
    """Return the depth of steel [m] in an oxide [m]; nothing is lost where nothing wears."""
    return oxide * (case.scene.wear.wears / case.scene.oxide.volume_ratio)


def track_area(case: Case, side: Side) -> float:
    """Return the area [m2] of a body's track |y| < b; at rest, of as much of it as its patch is long."""
    hertz = case.scene.unit_hertz
    width = 2.0 * hertz.growth(case.scene.operation.load)[1] * hertz.b
    return width * (side.track_length if side.moves else case.scene.film.domain)
