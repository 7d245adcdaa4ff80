"""One instant of a mixed film in the units of the kernels: problem, iterate and solution."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..arrays import Array, Mask
from ..convergence import SolverConvergence


class Tables(NamedTuple):
    """Oil over p = 0, step, 2 step..., in the order in which kernels take it (as `*problem.tables`).

    Compiled functions get the fields one by one: unpacking a named tuple costs each call about 1.5 us, 5 % of an
    iteration on 65 x 65 nodes.
    """

    step: float
    density: Array
    fluidity: Array
    potential: Array  # integral of the fluidity over pressure


class Terms(NamedTuple):
    """Coefficients of the terms that carry mass along, in the order in which kernels take them."""

    per_dt: float
    wedge: float
    spacing: float


@dataclass(frozen=True)
class Problem:
    """One instant, entrainment along +x. Arrays [ny, nx]; tables over p = 0, step, 2 step...

    Units: length l, pressure q, gap l^2 / radius.

    In Hertz units (l = a, q = p_H) the deformation is 2 / pi^2 * integral p / r; `compliance` is the factor on that in
    the units at hand. Units are chosen so that pressures and lengths of the solution are of order one.
    """

    undeformed: Array  # gap of the undeformed bodies, roughness included, up to a constant
    cap: Array  # largest pressure
    floor: float
    spacing: float
    load: float  # sum of weight * p over the nodes
    mobility: Array  # pressure flow of a unit's gap, gradient and fluidity
    thinned: Array  # fluidity that shear adds
    per_dt: float  # 1 / time step, 0: steady
    wedge: float  # entrainment speed: 1, or less if it is too slow a unit for the time step
    mass_old: Array  # mass of the previous instant
    fluidity: Array  # table of 1 / viscosity
    density: Array  # table
    step: float
    compliance: float
    edge: Array  # ratio of the pressure on an edge node to that of its inner neighbour; zero elsewhere
    weight: Array  # of each node in the load: 1, on the edge with the film beyond it
    lumped: bool = False  # one pressure for fluid and solids, as in the unified Reynolds equation: f = p everywhere
    # periodic along y: the first and the last row are images of the last and the first but one; edge and weight 0 there
    wrapped: bool = False
    conserving: bool = False  # cavities hold the oil that flows into them; else they count as full
    supply: float | Array | None = None  # mass [ny] that enters, None: as much as the first column can take
    first: int = 0  # first column in which oil has pressure; upstream of it none presses
    stress: float = 0.0  # pressure that asperities below the grid carry at the floor
    depth: float = 0.0  # gap over which that falls by the factor e; 0: no such asperities
    slow_mass: Array | None = None  # part M of the mass that stands still; the rest, and the nodes, move with the oil
    gap_before: Array | None = None  # of the nodes at the previous instant, at least the floor; None: as it is now
    passing: float = 1.0  # part of its change since then that takes all of the step; the rest is at once
    empty: Mask | None = None  # nodes whose oil had no pressure at the previous instant
    fitted: bool = False  # flow through faces exact for a constant flow in each cell; else second order upstream

    @cached_property
    def potential(self) -> Array:
        """Table of the integral of the fluidity over pressure."""
        return np.concatenate([[0.0], np.cumsum(0.5 * self.step * (self.fluidity[1:] + self.fluidity[:-1]))])

    @cached_property
    def tables(self) -> Tables:
        """Arguments of kernels: tables of the oil over pressure."""
        return Tables(self.step, self.density, self.fluidity, self.potential)

    @cached_property
    def terms(self) -> Terms:
        """Arguments of kernels: time step, entrainment, spacing."""
        return Terms(self.per_dt, self.wedge, self.spacing)

    @property
    def nodes_per_step(self) -> float:
        """Nodes that the oil is carried along in a time step."""
        return self.wedge / (self.per_dt * self.spacing)

    @property
    def layer(self) -> tuple[float, float, float]:
        """Arguments of kernels: floor, and stress and depth of the asperities above it."""
        return self.floor, self.stress, self.depth

    @property
    def by_flux(self) -> bool:
        """True if the film is balanced by its flow through faces, as cavities and an inlet meniscus need it."""
        return self.conserving or self.first > 1


@dataclass(frozen=True)
class Iterate:
    """Start or end of an iteration. Arrays [ny, nx]."""

    pressure: Array
    fluid: Array
    solid: Mask
    rigid: float


@dataclass(frozen=True)
class Solution(SolverConvergence):
    """End of an iteration, and its convergence."""

    iterate: Iterate
    gap: Array  # below the floor where the pressure is capped: the rest yields plastically
    mass: Array


def failed(start: Iterate, gap: Array, mass: Array, iterations: int, why: str) -> Solution:
    """Return the start of an iteration that found nothing, with infinite errors."""
    return Solution(
        start,
        gap,
        mass,
        converged=False,
        shortfall=why,
        iterations=iterations,
        pressure_change=np.inf,
        load_error=np.inf,
        complementarity=np.inf,
        imbalance=np.inf,
    )
