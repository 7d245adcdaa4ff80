"""Stresses below the bodies of a mean contact, and the load cycles of classes of points on both tracks."""

import math
from statistics import NormalDist
from typing import NamedTuple

import numpy as np

from ..kernels.load_cycle import Cycle
from ..laws.load_sharing import rms_slope, sliding_ratio
from ..laws.stress import OF_STRESS, ratios, risk, share_down_to
from ..scene import Case, Scene
from ..state.classes import EDGES, WEIGHTS
from ..surfaces.damage_classes import rows_of
from .contact import MeanContact
from .near_surface import CURVES, FITTED, HALF_WIDTH, Rough, meetings
from .smooth_cycles import smooth_cycles
from .smooth_film import LIGHTEST

_NORMAL = NormalDist()
_SCORES = np.array([_NORMAL.inv_cdf(share) for share in EDGES - 0.5 * WEIGHTS])  # of the middle of each class
_LEAST = 0.05  # local pressure over Hertz's largest, at least: beyond the contact there is none
_BEYOND = 2.0  # half widths outside the points of the fit over those within


class Stressed(NamedTuple):
    """What a pass through a mean contact does below both tracks."""

    cycles: Cycle  # of the classes [Pa], arrays [2, layers, rows, classes]
    outputs: dict[str, float]  # `OF_STRESS`
    half_width: float  # of the error of the cycles, relative


def stressed(case: Case, contact: MeanContact) -> Stressed:
    """Return the load cycles under a contact; without a load there are none.

    Hydrostatic stresses are those of smooth bodies: tension between asperities is left out.
    """
    scene, law = case.scene, case.scene.stress
    depths, rows = scene.depths, rows_of(scene)
    if case.op.load < LIGHTEST:
        none = np.zeros((2, depths.size, rows.size, WEIGHTS.size))
        return Stressed(Cycle(none, none, none), dict.fromkeys(OF_STRESS, 0.0), 0.0)
    hertz, (root, wide) = case.unit_hertz, case.growth
    largest, half, side = root * hertz.pressure_max, root * hertz.a, wide * hertz.b
    friction = abs(contact.solid + contact.fluid) / case.op.load
    residual = float(law.residual_stress()[0])
    line, chords, places = case.shape.along_face, np.ones(1), np.zeros(1)
    if not line:
        places = rows * (_track(scene)[1] / side)
        chords = np.sqrt(np.maximum(1.0 - places * places, _LEAST**2))
    table = smooth_cycles(
        None if line else hertz.b / hertz.a, law.dang_van_slope, residual and residual / _track(scene)[0]
    )
    smooth, peak = table.at(friction, places, depths / half)
    rough = _rough(case, contact, largest, half, side)
    shape = (2, depths.size, chords.size, WEIGHTS.size + 1)
    hydrostatic = np.broadcast_to(largest * smooth[1, ..., None], shape)
    if rough.steepness == 0.0:
        shear, dang_van = (np.broadcast_to(largest * smooth[k, ..., None], shape) for k in (0, 2))
    else:
        pressures = CURVES.pressures.at(rough, chords)
        scores = np.append(_SCORES, _extreme(rough.spots / chords.size))
        found = largest * CURVES.both.quantiles(smooth[::2], pressures, chords, rough, scores)
        shear, dang_van = found[:, 0], found[:, 1]
        over = math.sqrt(float(chords @ pressures**2) / float(chords.sum()))
        peak = CURVES.largest.at(peak, over, rough)
    if residual != 0.0:
        everywhere = 2.0 / 3.0 * residual
        hydrostatic, dang_van = hydrostatic + everywhere, dang_van + law.dang_van_slope * everywhere
    deepest = int(peak.argmax())
    risks = (risk(shear[..., :-1]) @ WEIGHTS).sum(axis=(0, 2))
    values = (
        largest * float(peak[deepest]),
        float(depths[deepest]),
        share_down_to(law.near_surface * half, risks, depths),
        *ratios(law, Cycle(shear, hydrostatic, dang_van)),
    )
    cycles = Cycle(shear[..., :-1], hydrostatic[..., :-1], dang_van[..., :-1])
    half_width = HALF_WIDTH if _within(rough) else _BEYOND * HALF_WIDTH
    return Stressed(cycles, dict(zip(OF_STRESS, values, strict=True)), half_width)


def _within(rough: Rough) -> bool:
    """Return True within the fit; contacts that roll, are smoother or have thicker films count as within."""
    return (
        rough.steepness <= FITTED["steepness"][1]
        and rough.clearance >= FITTED["clearance"][0]
        and rough.slip <= FITTED["slip"][1]
    )


def _track(scene: Scene) -> tuple[float, float]:
    """Return Hertz's largest pressure [Pa] and half width along y [m] at the scene's load."""
    hertz = scene.unit_hertz
    root, wide = hertz.growth(scene.operation.load)
    return root * hertz.pressure_max, wide * hertz.b


def _rough(case: Case, contact: MeanContact, largest: float, half: float, side: float) -> Rough:
    scene = case.scene
    first, second = scene.surface_1, scene.surface_2
    heights = [film.solid for film in contact.tribofilms]
    slope = float(rms_slope(heights[0], first.length, heights[1], second.length))
    length = case.sides[scene.rougher].surface.length
    both = heights[0] ** 2 + heights[1] ** 2
    shares = (heights[0] ** 2 / both, heights[1] ** 2 / both) if both > 0.0 else (0.5, 0.5)
    return Rough(
        0.5 * scene.solids.reduced_modulus * slope / largest,
        contact.fit.clearance,
        sliding_ratio(contact.slide, case.op.entrainment_speed),
        contact.load_ratio,
        meetings(case.speeds, 2.0 * half / length, shares),
        scene.depths / length,
        2.0 * half * min(2.0 * side, scene.rows * scene.film.spacing) / length**2,
    )


def _extreme(spots: float) -> float:
    """Return the normal score of the largest of some spots."""
    return _NORMAL.inv_cdf(1.0 - 1.0 / (max(spots, 1.0) + 1.0))
