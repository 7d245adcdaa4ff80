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

The gap within a cell along the flow is the cubic through four nodes; across the flow it is straight, 1 / I_3 =
2 h_1^2 h_2^2 / (h_1 + h_2). Source of fitted fluxes: Scharfetter & Gummel, IEEE Trans. Electron Devices 16 (1969) 64,
doi:10.1109/T-ED.1969.16566, for drift and diffusion; of m_u: Leonard, Comput. Methods Appl. Mech. Eng. 19 (1979) 59,
doi:10.1016/0045-7825(79)90034-3.

A face has the index of the node before it: ex[j, i], carried[j, i] lie between i and i + 1, ey[j, i] between j and
j + 1.
"""

import numpy as np
from numpy.typing import NDArray

from ..compiled import jit
from .problem import Problem

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# four Gauss points on a cell of unit length, and the cubic through the nodes -1, 0, 1, 2 there
_POINTS, _WEIGHTS = (0.5 + 0.5 * x for x in np.polynomial.legendre.leggauss(4))
_WEIGHTS = 0.5 * np.polynomial.legendre.leggauss(4)[1]
_CUBIC = np.array(
    [
        -_POINTS * (_POINTS - 1.0) * (_POINTS - 2.0) / 6.0,
        (_POINTS + 1.0) * (_POINTS - 1.0) * (_POINTS - 2.0) / 2.0,
        -(_POINTS + 1.0) * _POINTS * (_POINTS - 2.0) / 2.0,
        (_POINTS + 1.0) * _POINTS * (_POINTS - 1.0) / 6.0,
    ]
)
_LEAST, _MOST = 0.6, 1.5  # of a cubic, times the smaller and the larger of the two nodes' gaps
_TINY = 1e-300


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
def _along(before, left, right, after):  # type: ignore[no-untyped-def]
    """Return 1 / I_3 and I_2 / I_3 of a cell between two nodes, from the gaps of four in a row."""
    least, most = _LEAST * min(left, right), _MOST * max(left, right)
    square, cube = 0.0, 0.0
    for q in range(4):
        h = _CUBIC[0, q] * before + _CUBIC[1, q] * left + _CUBIC[2, q] * right + _CUBIC[3, q] * after
        thin = 1.0 / min(max(h, least), most)
        part = _WEIGHTS[q] * thin * thin
        square += part
        cube += part * thin
    return 1.0 / cube, square / cube


@jit
def gap_means(gap, conductance, width, across):  # type: ignore[no-untyped-def]
    """Compute 1 / I_3 and I_2 / I_3 of the faces along the flow and 1 / I_3 of those across it, all [ny, nx].

    gap [ny, nx] is at least the floor. The gap beyond the grid goes on as a parabola.
    """
    ny, nx = gap.shape
    for j in range(ny):
        g = gap[j]
        for i in range(1, nx - 2):
            conductance[j, i], width[j, i] = _along(g[i - 1], g[i], g[i + 1], g[i + 2])
        first, last = 3.0 * (g[0] - g[1]) + g[2], 3.0 * (g[nx - 1] - g[nx - 2]) + g[nx - 3]
        conductance[j, 0], width[j, 0] = _along(first, g[0], g[1], g[2])
        conductance[j, nx - 2], width[j, nx - 2] = _along(g[nx - 3], g[nx - 2], g[nx - 1], last)
    _across(gap, across)


@jit
def _across(gap, across):  # type: ignore[no-untyped-def]
    """Compute 1 / I_3 of the faces across the flow."""
    ny, nx = gap.shape
    for j in range(ny - 1):
        for i in range(nx):
            here, there = gap[j, i], gap[j + 1, i]
            across[j, i] = 2.0 * here * here * there * there / (here + there)


@jit
def _slow_width(before, left, right, after, slow_before, slow_left, slow_right, slow_after):  # type: ignore[no-untyped-def]
    """Return 1 / I_3 and the mean of M / h^3 over I_3 of a cell, from gaps and slow masses M of four nodes in a row."""
    least, most = _LEAST * min(left, right), _MOST * max(left, right)
    low, high = _LEAST * min(slow_left, slow_right), _MOST * max(slow_left, slow_right)
    carried, cube = 0.0, 0.0
    for q in range(4):
        a, b, c, d = _CUBIC[0, q], _CUBIC[1, q], _CUBIC[2, q], _CUBIC[3, q]
        thin = 1.0 / min(max(a * before + b * left + c * right + d * after, least), most)
        slow = min(max(a * slow_before + b * slow_left + c * slow_right + d * slow_after, low), high)
        part = _WEIGHTS[q] * thin * thin * thin
        carried += part * slow
        cube += part
    return 1.0 / cube, carried / cube


@jit
def slow_means(gap, slow, conductance, width, across):  # type: ignore[no-untyped-def]
    """Compute the same as `gap_means`, with m_M in place of I_2 / I_3."""
    ny, nx = gap.shape
    for j in range(ny):
        g, s = gap[j], slow[j]
        for i in range(nx - 1):
            g_0 = g[i - 1] if i > 0 else 3.0 * (g[0] - g[1]) + g[2]
            s_0 = s[i - 1] if i > 0 else 3.0 * (s[0] - s[1]) + s[2]
            g_3 = g[i + 2] if i < nx - 2 else 3.0 * (g[nx - 1] - g[nx - 2]) + g[nx - 3]
            s_3 = s[i + 2] if i < nx - 2 else 3.0 * (s[nx - 1] - s[nx - 2]) + s[nx - 3]
            conductance[j, i], width[j, i] = _slow_width(g_0, g[i], g[i + 1], g_3, s_0, s[i], s[i + 1], s_3)
    _across(gap, across)


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
    ex, ey, share, carried, slow,
):  # fmt: skip
    """Compute mobilities ex, ey, the share t and the carried mass m_f of all faces, from properties of the nodes.

    per_stiff: 1 / (compliance dx^2). fitted: False for second order upstream and means of the nodes' mobilities.
    slow: m_u(M), where width is m_M; None: the mass of now stands still.
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
            share[j, i] = t
            if slow is not None:
                carried[j, i] = t * width[j, i] + (1.0 - t) * slow[j, i]
                continue
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
        self.empty: Mask | None = None
        scratch: list[Array] = [np.zeros(shape) for _ in range(11)]
        self.gap, self.rho, self.fluid, self.potential = scratch[:4]
        self.conductance, self.width, self.across = scratch[4:7]
        self.ex, self.ey, self.share, self.carried = scratch[7:]

    @staticmethod
    def of(problem: Problem) -> "Flow":
        """Return the flows of a problem."""
        per_stiff = 1.0 / (problem.compliance * problem.spacing**2)
        flow = Flow(problem.cap.shape, problem.floor, problem.step, per_stiff, problem.fitted)
        if problem.slow_mass is not None:
            flow.slow_mass, flow.slow = problem.slow_mass, np.zeros(problem.cap.shape)
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
        if self.slow_mass is not None:
            slow_means(self.gap, self.slow_mass, self.conductance, self.width, self.across)
        elif self.fitted:
            gap_means(self.gap, self.conductance, self.width, self.across)

    def drive(self, f: Array, full: Array, mobility: Array, thinned: Array) -> None:
        """Compute the flows through all faces from fluid pressure, full masses and properties of the oil."""
        nodes = (self.gap, full, self.rho, self.fluid, self.potential, mobility, thinned)
        means = (self.conductance, self.width, self.across)
        face_flows(f, *nodes, *self._scales, self.fitted, *means, *self.faces, self.share, self.carried, self.slow)
        if self.slow is not None and self.empty is not None:
            np.copyto(self.carried, self.slow, where=self.empty)
