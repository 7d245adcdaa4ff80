"""Load sharing between solids and oil of rough bodies, by curves fitted to the deterministic level."""

import math
from typing import NamedTuple

from ..laws.load_sharing import Films, Parting, flattening_of, layer_height, rms_slope
from ..scene import Case
from .oil import Law
from .surfaces import Tribofilms, added_friction, hardness_of, mean_cover, peaks_of, regression_film, under_film


class Fit(NamedTuple):
    """Place of a contact among the points of the fit; see `laws.load_sharing.FittedSharing`."""

    clearance: float
    layers: float
    flattening: float
    below: float
    slip: float
    pressed: float


UNFITTED = Fit(math.inf, math.inf, 0.0, 0.0, 0.0, 0.0)  # no load


class Surfaces(NamedTuple):
    """Properties of the surfaces that friction and load sharing need at any operating point."""

    sigma: float  # composite rms roughness as before wear, with tribofilms [m]
    solid: float  # likewise, without them [m]
    cover: float  # mean cover of both bodies where they touch
    hardness: float  # where they touch [Pa]
    flattening: float  # per Hertz's largest pressure [1/Pa]
    below: float  # of the longest wave below the grid, likewise
    layer: float  # height to which roughness below the grid reaches [m]
    oxide: float  # what oxides add to the coefficient of boundary friction


class Shares(NamedTuple):
    """Shares of solids and oil in the load."""

    fit: Fit
    gap: float  # mean [m]
    load: float  # contact_load_ratio
    area: float  # contact_area_ratio of elastic solids
    raised: float  # pressure of the oil over Hertz's
    kept: float  # friction of the oil over that under even pressure


def surfaces_of(case: Case, tribofilms: Tribofilms) -> Surfaces:
    """Return the properties of the surfaces under their tribofilms."""
    scene, hertz, below = case.scene, case.unit_hertz, case.microroughness
    first, second = scene.surface_1, scene.surface_2
    # the load ratio is that of surfaces with the peaks that wear has left
    solids = [peaks_of(film, side.surface.rms) for film, side in zip(tribofilms, case.sides, strict=True)]
    peaks = [under_film(film, solid) for film, solid in zip(tribofilms, solids, strict=True)]
    rough = rms_slope(peaks[0], first.length, peaks[1], second.length)
    flattening = [
        flattening_of(hertz.mean_share, scene.solids.reduced_modulus, slope) if slope > 0.0 else math.inf
        for slope in (rough, below.slope if below else 0.0)
    ]
    return Surfaces(
        sigma=math.hypot(*peaks),
        solid=math.hypot(*solids),
        cover=mean_cover(scene, tribofilms),
        hardness=hardness_of(scene, tribofilms),
        flattening=flattening[0],
        below=flattening[1],
        layer=layer_height(scene.film.floor, below.rms if below else 0.0),
        oxide=added_friction(scene, tribofilms),
    )


class Parted(NamedTuple):
    """Rough bodies parted by a film: what does not depend on sliding."""

    fit: Fit  # its slip is that of rolling
    parting: Parting
    films: Films
    rough: float  # height over which the oil flows [m]
    dry_area: float
    raised: float  # pressure of the oil over Hertz's
    oil_pressure: float  # largest of the oil that carries load [Pa]


def parted(case: Case, surfaces: Surfaces, film: float, grown: tuple[float, float]) -> Parted:
    """Return how a film of smooth bodies [m] parts rough ones.

    `grown` are the factors of Hertz's contact at 1 N along x and y that give it at the load.
    """
    root, wide = grown
    scene, hertz = case.scene, case.unit_hertz
    sharing = regression_film(scene).sharing
    sigma = max(surfaces.sigma, surfaces.layer)  # bodies smooth on the grid touch by what is below it
    pressure, half = root * hertz.pressure_max, root * hertz.a
    fit = Fit(
        film / sigma,
        film / surfaces.layer,
        surfaces.flattening * pressure,
        surfaces.below * pressure,
        0.0,
        pressure / surfaces.hardness,
    )
    clearance, below = fit.clearance, fit.below
    flattening = sharing.nearest(fit.flattening)  # powers of it have no meaning far from the fit
    density: Law = scene.lubricant.density
    rough = max(surfaces.solid, surfaces.layer)  # tribofilms fill what they part
    dense = film / rough / float(density(hertz.mean_share * pressure))
    carrying = sharing.oil_pressure(clearance, flattening, *case.shape.depths(film, half, wide * hertz.b))
    raised = min(carrying, scene.plasticity.hardness / pressure)  # no pressure is above the hardness
    return Parted(
        fit,
        sharing.parting(clearance, fit.layers, flattening, below, fit.pressed),
        sharing.films(dense, flattening, surfaces.layer / rough),
        rough,
        sharing.dry_area(flattening, below),
        raised,
        raised * pressure,
    )


def shared(case: Case, parted: Parted, slip: float) -> Shares:
    """Return the shares of rough bodies parted by a film, `slip` being sliding over entrainment speed."""
    sharing = regression_film(case.scene).sharing
    share = sharing.load_ratio_at(slip, parted.parting)
    gap = max(parted.rough * parted.films.ratio(share), case.scene.film.floor)
    area = parted.dry_area * share**sharing.area_exponent
    kept = float(sharing.kept(parted.fit.flattening))
    return Shares(parted.fit._replace(slip=slip), gap, share, area, parted.raised, kept)
