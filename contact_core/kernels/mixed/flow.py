"""Flow of oil through the faces between nodes: what a pressure difference drives, and what entrainment carries.

Through the face between two nodes, h [l^2 / radius] along the cell between them and I_k the mean of h^-k over it,

    F = wedge m_f - e_f (f_right - f_left) / dx,
    e_f = mobility rho <1 / eta> / I_3,   m_c = rho I_2 / I_3,

<1 / eta> = (Phi(f_right) - Phi(f_left)) / (f_right - f_left), Phi the integral of the fluidity over pressure
(Kirchhoff's transform), are exact for a flow that is constant within the cell, however much the gap and the viscosity
change there. Where the half space is stiff against the flow, the film is carried along as it is: m_u, of third order
upstream, kept between the masses of both nodes. m_f = t m_c + (1 - t) m_u, t = s^2 / (1 + s^2),
s = e_f / (compliance dx^2).

A moving pattern must not spread because time goes by in steps: bodies of nearly one speed would pump oil under each
other's asperities. Where the nodes move on with the oil (`Problem.slow_mass`), the film is what moves with it, m - M,
and a film M that stands still and hardly changes. Only M passes the faces. A flow that is constant within the cell but
for what moves along is exact with

    m_f = t m_M + (1 - t) m_u(M),   m_M = (mean of M / h^3) / I_3,

for m - M needs no pressure: with m_c, which stands still, roughness that rolls would be pumped along by as much as the
step moves it. Oil without pressure is carried along as it is: of M, a face behind it passes the mean over the way of
the nodes, M (x - C / 2) at C nodes per step. Else half a cell of a closing gap would be lost where oil fills up.

While asperities pass each other, the gap of a node that moves with the oil changes from h_0 to h_1 in a step. Under a
constant pressure time goes by as dh / h^3: the mean conductance of the step is that of a gap h with
1 / h^3 = mean of 1 / h^3 between both = (h_0 + h_1) / (2 h_0^2 h_1^2). With that of its end, oil would be trapped under
asperities that close, and lost where they open, the more the longer the step.

The gap within a cell along the flow is the cubic through four nodes; across the flow it is straight, 1 / I_3 =
2 h_1^2 h_2^2 / (h_1 + h_2). Source of fitted fluxes: Scharfetter & Gummel, IEEE Trans. Electron Devices 16 (1969) 64,
doi:10.1109/T-ED.1969.16566, for drift and diffusion; of m_u: Leonard, Comput. Methods Appl. Mech. Eng. 19 (1979) 59,
doi:10.1016/0045-7825(79)90034-3.

A face has the index of the node before it: ex[j, i], carried[j, i] lie between i and i + 1, ey[j, i] between j and
j + 1.
"""

import numpy as np

from ..arrays import Array
from ..compiled import jit
from .problem import Problem


def _cubic(x: float) -> tuple[float, float, float, float]:
    """Return the weights of the nodes -1, 0, 1, 2 in their cubic at x."""
    return (
        -x * (x - 1.0) * (x - 2.0) / 6.0,
        (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0,
        -(x + 1.0) * x * (x - 2.0) / 2.0,
        (x + 1.0) * x * (x - 1.0) / 6.0,
    )


# four Gauss points on a cell of unit length
_CUBIC_1, _CUBIC_2, _CUBIC_3, _CUBIC_4 = (_cubic(float(0.5 + 0.5 * x)) for x in np.polynomial.legendre.leggauss(4)[0])
_WEIGHT_1, _WEIGHT_2 = (float(0.5 * w) for w in np.polynomial.legendre.leggauss(4)[1][:2])  # outer ones, inner ones
_LEAST, _MOST = 0.6, 1.5  # of a cubic, times the smaller and the larger of the two nodes' gaps
_TINY = 1e-300
_HALLEY = 4  # steps to a cube root, in vectors; from the geometric mean enough for gaps up to 1e4 times each other


@jit
def properties(p, step, density, fluidity, potential):  # type: ignore[no-untyped-def]
    """Return density, fluidity and the integral of fluidity over pressure, at a pressure; the last entries above."""
    at = p / step
    k = int(at)
    last = density.size - 1
    if k >= last:
        return density[last], fluidity[last], potential[last] + (p - last * step) * fluidity[last]
    part = at - k
    rho, flow = density[k], fluidity[k]
    rise = fluidity[k + 1] - flow
    within = step * part * (flow + 0.5 * part * rise)
    return rho + part * (density[k + 1] - rho), flow + part * rise, potential[k] + within


@jit
def node_pass(  # type: ignore[no-untyped-def]
    f, gap_before, fixed, df, dh, part, floor, step, density, fluidity, potential, out, mass, gap, rho, fluid, driven
):
    """Compute pressure, full mass and properties of nodes whose pressure changes by a part of df, and gap of dh.

    fixed: nodes whose gap does not change.
    """
    for j in range(f.shape[0]):
        for i in range(f.shape[1]):
            out[j, i] = f[j, i] + part * df[j, i]
            rise = 0.0 if fixed[j, i] else part * dh[j, i]
            gap[j, i] = max(gap_before[j, i] + rise, floor)
            rho[j, i], fluid[j, i], driven[j, i] = properties(out[j, i], step, density, fluidity, potential)
            mass[j, i] = rho[j, i] * gap[j, i]


@jit
def _between(x, least, most):  # type: ignore[no-untyped-def]
    """Return a value kept within two others; unlike `min` and `max`, it lets loops run in vectors."""
    x = least if x < least else x
    return most if x > most else x


@jit
def _bounds(left, right):  # type: ignore[no-untyped-def]
    """Return the least and the largest value of a cubic between two nodes."""
    lower = left if left < right else right
    return _LEAST * lower, _MOST * (left + right - lower)


@jit
def _at(weights, n_0, n_1, n_2, n_3, bounds):  # type: ignore[no-untyped-def]
    """Return the cubic of four nodes at a Gauss point, within its bounds."""
    x = weights[0] * n_0 + weights[1] * n_1 + weights[2] * n_2 + weights[3] * n_3
    return _between(x, bounds[0], bounds[1])


@jit
def _along_row(g, m, conductance, width):  # type: ignore[no-untyped-def]
    """Compute 1 / I_3 and the mean of m / h^3 over I_3 of the nx - 1 faces of a row, from gaps g and masses m [nx + 2].

    These go on by a node at either end. The body stands in the loop, which runs in vectors then.
    """
    for i in range(g.size - 3):
        g_0, g_1, g_2, g_3 = g[i], g[i + 1], g[i + 2], g[i + 3]
        m_0, m_1, m_2, m_3 = m[i], m[i + 1], m[i + 2], m[i + 3]
        of_gap, of_mass = _bounds(g_1, g_2), _bounds(m_1, m_2)
        h_1, h_2 = _at(_CUBIC_1, g_0, g_1, g_2, g_3, of_gap), _at(_CUBIC_2, g_0, g_1, g_2, g_3, of_gap)
        h_3, h_4 = _at(_CUBIC_3, g_0, g_1, g_2, g_3, of_gap), _at(_CUBIC_4, g_0, g_1, g_2, g_3, of_gap)
        p, q = _WEIGHT_1 / (h_1 * h_1 * h_1), _WEIGHT_2 / (h_2 * h_2 * h_2)
        r, s = _WEIGHT_2 / (h_3 * h_3 * h_3), _WEIGHT_1 / (h_4 * h_4 * h_4)
        carried = p * _at(_CUBIC_1, m_0, m_1, m_2, m_3, of_mass) + q * _at(_CUBIC_2, m_0, m_1, m_2, m_3, of_mass)
        carried += r * _at(_CUBIC_3, m_0, m_1, m_2, m_3, of_mass) + s * _at(_CUBIC_4, m_0, m_1, m_2, m_3, of_mass)
        cube = p + q + r + s
        conductance[i] = 1.0 / cube
        width[i] = carried / cube


@jit
def _extended(row, out):  # type: ignore[no-untyped-def]
    """Put a row [nx] into one [nx + 2] that goes on as a parabola at either end."""
    n = row.size
    out[1 : n + 1] = row
    out[0] = 3.0 * (row[0] - row[1]) + row[2]
    out[n + 1] = 3.0 * (row[n - 1] - row[n - 2]) + row[n - 3]


@jit
def face_means(gap, mass, conductance, width, across):  # type: ignore[no-untyped-def]
    """Compute 1 / I_3 and the mean of mass / h^3 over I_3 of the faces along the flow, 1 / I_3 of those across it.

    All [ny, nx]; the gap is at least the floor. With the gap as mass the mean is I_2 / I_3.
    """
    ny, nx = gap.shape
    g, m = np.empty(nx + 2), np.empty(nx + 2)
    for j in range(ny):
        _extended(gap[j], g)
        _extended(mass[j], m)
        _along_row(g, m, conductance[j], width[j])
    for j in range(ny - 1):
        for i in range(nx):
            here, there = gap[j, i], gap[j + 1, i]
            across[j, i] = 2.0 * here * here * there * there / (here + there)


@jit
def gap_of_step(before, now, passing, out):  # type: ignore[no-untyped-def]
    """Compute the gap whose conductance is the mean of a step in which a part of the gap's change passes by.

    passing: that part, the regression coefficient of what slides on the whole change where both are Gaussian.
    """
    for j in range(now.shape[0]):
        for i in range(now.shape[1]):
            h_1 = now[j, i]
            h_0 = h_1 + passing * (before[j, i] - h_1)
            both = h_0 * h_1
            cube, x = 2.0 * both * both / (h_0 + h_1), np.sqrt(both)
            for _ in range(_HALLEY):
                x *= (x * x * x + 2.0 * cube) / (2.0 * x * x * x + cube)
            out[j, i] = x


@jit
def slow_upstream(slow, out):  # type: ignore[no-untyped-def]
    """Compute m_u(M) of the faces along the flow, [ny, nx]."""
    ny, nx = slow.shape
    for j in range(ny):
        for i in range(nx - 1):
            before = slow[j, i - 1] if i > 0 else 2.0 * slow[j, i] - slow[j, i + 1]
            out[j, i] = _upstream(before, slow[j, i], slow[j, i + 1])


@jit
def _upstream(before, left, right):  # type: ignore[no-untyped-def]
    """Return the mass at a face by third order upstream, kept between those of its nodes."""
    value = 0.375 * right + 0.75 * left - 0.125 * before
    return min(max(value, min(left, right)), max(left, right))


@jit
def face_flows(  # type: ignore[no-untyped-def]
    f, gap, mass, rho, fluid, potential, mobility, thinned, floor, step, per_stiff, fitted, conductance, width, across,
    ex, ey, share, carried, slow, empty,
):  # fmt: skip
    """Compute mobilities ex, ey, the share t and the carried mass m_f of all faces, from properties of the nodes.

    per_stiff: 1 / (compliance dx^2). fitted: False for second order upstream and means of the nodes' mobilities.
    slow: m_u(M), where width is m_M; None: the mass of now stands still. empty: nodes whose oil had no pressure.
    """
    ny, nx = f.shape
    for j in range(ny):
        for i in range(nx - 1):
            drop, dense = f[j, i + 1] - f[j, i], 0.5 * (rho[j, i] + rho[j, i + 1])
            left, right = mass[j, i], mass[j, i + 1]
            if not fitted:
                here, there = gap[j, i], gap[j, i + 1]
                e = mobility[j, i] * rho[j, i] * (fluid[j, i] + thinned[j, i]) * here * here * here
                e += mobility[j, i + 1] * rho[j, i + 1] * (fluid[j, i + 1] + thinned[j, i + 1]) * there * there * there
                ex[j, i] = 0.5 * e + _TINY
                share[j, i] = 0.0
                carried[j, i] = 1.5 * left - 0.5 * mass[j, i - 1] if i > 0 else 0.5 * (left + right)
                continue
            if abs(drop) < 0.5 * step:
                flows = 0.5 * (fluid[j, i] + fluid[j, i + 1])
            else:
                flows = (potential[j, i + 1] - potential[j, i]) / drop
            flows += 0.5 * (thinned[j, i] + thinned[j, i + 1])
            e = 0.5 * (mobility[j, i] + mobility[j, i + 1]) * dense * flows * conductance[j, i] + _TINY
            ex[j, i] = e
            t = 0.0
            if gap[j, i] > floor and gap[j, i + 1] > floor:
                s = e * per_stiff
                t = 1.0 - 1.0 / (1.0 + s * s)
            if slow is not None:
                t *= not empty[j, i]
                share[j, i] = t
                carried[j, i] = t * width[j, i] + (1.0 - t) * slow[j, i]
                continue
            share[j, i] = t
            upstream = _upstream(mass[j, i - 1] if i > 0 else 2.0 * left - right, left, right)
            carried[j, i] = t * dense * width[j, i] + (1.0 - t) * upstream
    for j in range(ny - 1):
        for i in range(nx):
            drop = f[j + 1, i] - f[j, i]
            if not fitted:
                here, there = gap[j, i], gap[j + 1, i]
                e = mobility[j, i] * rho[j, i] * (fluid[j, i] + thinned[j, i]) * here * here * here
                e += mobility[j + 1, i] * rho[j + 1, i] * (fluid[j + 1, i] + thinned[j + 1, i]) * there * there * there
                ey[j, i] = 0.5 * e + _TINY
                continue
            if abs(drop) < 0.5 * step:
                flows = 0.5 * (fluid[j, i] + fluid[j + 1, i])
            else:
                flows = (potential[j + 1, i] - potential[j, i]) / drop
            flows += 0.5 * (thinned[j, i] + thinned[j + 1, i])
            ease, dense = 0.5 * (mobility[j, i] + mobility[j + 1, i]), 0.5 * (rho[j, i] + rho[j + 1, i])
            ey[j, i] = ease * dense * flows * across[j, i] + _TINY


class Flow:
    """Properties of the oil at the nodes and flows through the faces of a film, all [ny, nx].

    floor: gap beside which the film is carried along as it is; step of the tables; per_stiff: 1 / (compliance dx^2);
    fitted: see `face_flows`; slow_mass: M of `Problem`.
    """

    def __init__(self, shape: tuple[int, int], floor: float, step: float, per_stiff: float, fitted: bool) -> None:
        self._scales, self.fitted = (floor, step, per_stiff), fitted
        self.slow_mass: Array | None = None
        self.slow: Array | None = None
        self.empty = np.zeros(shape, np.bool_)
        self.gap_before: Array | None = None
        self.passing = 1.0
        scratch: list[Array] = [np.zeros(shape) for _ in range(12)]
        self.gap, self.rho, self.fluid, self.potential = scratch[:4]
        self.conductance, self.width, self.across = scratch[4:7]
        self.ex, self.ey, self.share, self.carried, self.gap_of_step = scratch[7:]

    @staticmethod
    def of(problem: Problem) -> "Flow":
        """Return the flows of a problem."""
        per_stiff = 1.0 / (problem.compliance * problem.spacing**2)
        flow = Flow(problem.cap.shape, problem.floor, problem.step, per_stiff, problem.fitted)
        if problem.slow_mass is not None:
            flow.slow_mass, flow.slow = problem.slow_mass, np.zeros(problem.cap.shape)
            flow.gap_before, flow.passing = problem.gap_before, problem.passing
            slow_upstream(flow.slow_mass, flow.slow)
            if problem.empty is not None:
                flow.empty, part = problem.empty, min(problem.nodes_per_step, 1.0)
                flow.slow[flow.empty] += part * (flow.slow_mass - flow.slow)[flow.empty]
        return flow

    @property
    def nodes(self) -> tuple[Array, Array, Array, Array]:
        """Arguments of kernels: gap through which oil flows, density, fluidity, potential."""
        return self.gap, self.rho, self.fluid, self.potential

    @property
    def faces(self) -> tuple[Array, Array]:
        """Arguments of kernels: mobilities along and across the flow."""
        return self.ex, self.ey

    @property
    def through(self) -> tuple[Array, Array, Array]:
        """Arguments of kernels: mobilities along and across the flow, and the mass that is carried along."""
        return self.ex, self.ey, self.carried

    def measure(self) -> None:
        """Compute what the faces owe to the gap."""
        if self.fitted:
            gap, mass = self.gap, self.gap if self.slow_mass is None else self.slow_mass
            if self.gap_before is not None:
                gap_of_step(self.gap_before, gap, self.passing, self.gap_of_step)
                gap = self.gap_of_step
            face_means(gap, mass, self.conductance, self.width, self.across)

    def drive(self, f: Array, full: Array, mobility: Array, thinned: Array) -> None:
        """Compute the flows through all faces from fluid pressure, full masses and properties of the oil."""
        nodes = (self.gap, full, self.rho, self.fluid, self.potential, mobility, thinned)
        means = (self.conductance, self.width, self.across)
        face_flows(
            f, *nodes, *self._scales, self.fitted, *means, *self.faces, self.share, self.carried, self.slow, self.empty
        )
