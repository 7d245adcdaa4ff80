"""Prediction of a film after its rough surfaces have moved."""

from ..arrays import Array
from ..compiled import jit
from .problem import Iterate

_CARRIED = 0.3  # pressure of smooth bodies above which the pattern of the rough ones moves along with them


def advected(start: Iterate, smooth: Array, nodes: int) -> Iterate:
    """Predict the iterate after the rough surface has moved by `nodes` along +x: its pressure pattern moves along.

    smooth [ny, nx] is the pressure of the smooth bodies; where it is high, the ratio to it is what moves.
    """
    if nodes == 0:
        return start
    pressure, fluid, solid = start.pressure.copy(), start.pressure.copy(), start.solid.copy()
    _advect(start.pressure, start.fluid, start.solid, smooth, nodes, pressure, fluid, solid)
    return Iterate(pressure, fluid, solid, start.rigid)


@jit
def _advect(p_old, f_old, solid_old, smooth, nodes, p, f, solid):  # type: ignore[no-untyped-def]
    ny, nx = p.shape
    for j in range(ny):
        for i in range(nx):
            k = i - nodes if 0 <= i - nodes < nx and smooth[j, i] > _CARRIED < smooth[j, i - nodes] else i
            p[j, i] = p_old[j, k] * (smooth[j, i] / smooth[j, k] if k != i else 1.0)
            solid[j, i] = solid_old[j, k]
            f[j, i] = p[j, i] * (f_old[j, k] / p_old[j, k] if solid[j, i] and p_old[j, k] > 0.0 else 1.0)
