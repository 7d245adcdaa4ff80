"""Oil in cavities: filling of the gap, and the flow of mass through every face, marched downstream.

    f >= 0, theta <= 1, f (1 - theta) = 0,   div(e grad f) - wedge d(m)/dx - d(m)/dt = 0,
    m = theta M, M = rho max(h, floor)

A node with pressure is full. A node without has what the balance leaves it, M at most; beyond that it is full and its
net inflow is what its pressure has to drive out. Entrainment is along +x and carries all of the oil, so that one
march along each row solves the balance of its cavities exactly.

The flow F(i + 1/2) = theta_i G_i leaves node i through the face before node i + 1. G_i is what `flow` says where the
film is full, and falls to M_i, first order, where the node upstream is not: gradually, as a jump would leave nodes at
which neither state fits. Sources: Elrod, J. Lubr. Technol. 103
(1981) 350, doi:10.1115/1.3251669 (mass-conserving cavitation); Giacopini et al., J. Tribol. 132 (2010) 041702,
doi:10.1115/1.4002215 (complementarity).
"""

import numpy as np

from ..arrays import Array
from ..compiled import jit
from .edge import wrap
from .flow import Flow
from .problem import Problem

FADE = 4.0  # how fast the second order fades with the emptiness of the node upstream
# least share of a node's mass that flows on: at second order oil would flow back where a film falls to under half of
# itself from node to node. With this limit next to cavities only, nodes change sides for ever
LEAST = 0.5


@jit
def close_inlet(p, f, solid, first):  # type: ignore[no-untyped-def]
    """Remove the pressure of oil upstream of column `first`."""
    for j in range(p.shape[0]):
        for i in range(first):
            f[j, i] = 0.0
            if not solid[j, i]:
                p[j, i] = 0.0


@jit
def carry(  # type: ignore[no-untyped-def]
    f, full, carried, mass_old, ex, ey, per_dt, wedge, dx, conserving, supply, first, mass, flux, filling
):
    """Compute filling theta, mass and mass flow of every node from the fluid pressure and the full masses.

    full, mass, flux, filling [ny, nx]; carried: what flows on where the film is full; supply [ny]: the flow that
    enters, infinite if flooded; `first`: column upstream of which the flow is that. Not conserving: every node is full.
    """
    ny, nx = f.shape
    per_dx2, wedge_per_dx = 1.0 / (dx * dx), wedge / dx
    for j in range(ny):
        before = 1.0
        for i in range(nx):
            own = full[j, i]
            most = carried[j, i] if i < nx - 1 else own
            if i > 0:
                order = max(1.0 - FADE * (1.0 - before), 0.0)
                most = max(own + order * (most - own), LEAST * own)
            theta = 1.0
            if conserving and (i == 0 or i < first):
                theta = min(supply[j] / most, 1.0)
            elif conserving and f[j, i] <= 0.0:
                inflow = wedge_per_dx * flux[j, i - 1] + per_dt * mass_old[j, i]
                if 0 < j < ny - 1 and i < nx - 1:
                    driven = ex[j, i - 1] * f[j, i - 1] + ex[j, i] * f[j, i + 1]
                    driven += ey[j - 1, i] * f[j - 1, i] + ey[j, i] * f[j + 1, i]
                    inflow += per_dx2 * driven
                theta = min(max(inflow / (wedge_per_dx * most + per_dt * own), 0.0), 1.0)
            flux[j, i], filling[j, i], mass[j, i] = theta * most, theta, theta * own
            before = theta


class Carried:
    """Oil of a film with cavities or an inlet meniscus: `carry` and its scratch arrays."""

    def __init__(self, problem: Problem) -> None:
        self.problem, shape = problem, problem.cap.shape
        self.full: Array = np.zeros(shape)
        self.flux: Array = np.zeros(shape)
        self.filling: Array = np.ones(shape)
        supply = np.inf if problem.supply is None else problem.supply
        self.supply: Array = np.broadcast_to(np.asarray(supply, np.float64), shape[:1]).copy()
        self.first = max(problem.first, 1)

    def carry(self, f: Array, flow: Flow, mass: Array) -> None:
        """Compute mass and mass flow of every node from a fluid pressure; `full` holds the full masses."""
        q = self.problem
        if q.slow_mass is not None:  # there are no cavities where the oil moves along
            mass[:], self.flux[:] = self.full, flow.carried
            return
        inlet = (q.conserving, self.supply, self.first)
        through = (flow.carried, q.mass_old, *flow.faces)
        carry(f, self.full, *through, *q.terms, *inlet, mass, self.flux, self.filling)
        if q.wrapped:
            for field in (mass, self.flux, self.filling):
                wrap(field)
