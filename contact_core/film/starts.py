"""Starts of the iterations, in the units of `Scaled`."""

import numpy as np

from ..kernels.dry import solve_dry
from ..kernels.mixed.problem import Iterate
from .scaled import Scaled
from .solids import pressed

_DRY_TOLERANCE = 1e-6
_DRY_ITERATIONS = 1000
_START_TOLERANCE = 1e-2
_SOLID_SHARE = 0.85  # of the load in `shared_start`: the best of 0.03 to 0.95, from light contact to nearly dry


def dry_start(scaled: Scaled) -> Iterate:
    """Return the dry contact, without fluid."""
    return shared(scaled, 1.0, _DRY_TOLERANCE)[0]


def lifted_start(scaled: Scaled) -> Iterate:
    """Return a Hertz-like pressure under the film of smooth bodies and the highest asperities.

    The ends of a roller carry their part of the load. Another share would change the gap in the middle by many
    films, so the pressure of the dry, smooth roller is used.
    """
    pressure = np.minimum(scaled.smooth * (scaled.load / max(float(scaled.smooth.sum()), 1e-300)), scaled.cap)
    lift = scaled.smooth_film + 0.5 * max(float(scaled.now.heights.max()), 0.0)
    if scaled.now.shape.ends:
        smooth = scaled.undeformed + scaled.now.heights / scaled.h_unit
        limits = scaled.load, scaled.smooth, _START_TOLERANCE, _DRY_ITERATIONS
        pressure, rigid, _, _ = solve_dry(scaled.half_space, smooth, scaled.cap, *limits)
        return Iterate(pressure, pressure.copy(), np.zeros(pressure.shape, np.bool_), rigid + lift / scaled.h_unit)
    settled = scaled.compliance if scaled.now.shape.circular else float(scaled.half_space.deform(pressure).max())
    rigid = lift / scaled.h_unit - settled  # less the deformation of the centre by that pressure
    return Iterate(pressure, pressure.copy(), np.zeros(pressure.shape, np.bool_), rigid)


def shared_start(scaled: Scaled) -> Iterate:
    """Return solids that carry most of the load, above oil that carries the rest.

    Filled valleys drain faster than dry ones fill: from a dry contact, the oil has to open every seal. The solids'
    share of the solution is far lower.
    """
    return shared(scaled, _SOLID_SHARE, _START_TOLERANCE)[0]


def shared(scaled: Scaled, share: float, tolerance: float) -> tuple[Iterate, bool, int]:
    """Return solids that carry `share` of the load in dry contact, above oil; convergence, iterations.

    The oil carries the rest with the pressure of smooth bodies.
    """
    fluid, gap = np.zeros_like(scaled.cap), scaled.undeformed
    if share < 1.0:
        fluid = np.minimum(scaled.smooth * ((1.0 - share) * scaled.load / scaled.smooth.sum()), 0.5 * scaled.cap)
        gap = gap + scaled.half_space.deform(fluid)
    left = scaled.load - float(fluid.sum())
    contact, limits = (scaled.half_space, gap, scaled.cap, left, scaled.smooth), (tolerance, _DRY_ITERATIONS)
    solid, rigid, converged, iterations = pressed(*contact, fluid, (scaled.stress, scaled.fade), scaled.give, *limits)
    return Iterate(solid + fluid, fluid, solid > 0.0, rigid + scaled.floor), converged, iterations
