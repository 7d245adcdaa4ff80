"""Local inverse of the Jacobian of `newton` on the single row of a periodic contact: a smooth line.

The deformation by a node of a line falls so slowly that a patch of three nodes describes little of it; a band of a few
tens leaves GMRES a few steps. LAPACK's band factorisation costs no more than the patch's.
"""

from collections.abc import Callable

import numpy as np
import scipy

from ..arrays import Array, Indices
from ..compiled import jit

_WIDE = 64  # nodes on either side that a node is coupled to


@jit
def _assemble(by_f, by_h, scale, kernel, nodes, column, held, give, edge, wide, band):  # type: ignore[no-untyped-def]
    nx = held.size
    for k in range(nodes.size):
        i, factor = nodes[k], scale[nodes[k]]
        for m in range(max(k - wide, 0), min(k + wide + 1, nodes.size)):
            at = nodes[m]
            if held[i]:
                value = kernel[abs(i - at)] + (give[i] if at == i else 0.0)
            else:
                value = by_h[0, i] * kernel[abs(i - at)] + by_h[1, i] * kernel[abs(i - 1 - at)]
                value += by_h[2, i] * kernel[abs(i + 1 - at)] + by_h[5, i] * kernel[abs(i - 2 - at)]
            band[2 * wide + k - m, m] = value * factor
        if held[i]:
            continue
        for n in range(6 if i > 1 else 5):
            at, part = i + (0, -1, 1, 0, 0, -2)[n], by_f[n, i]
            if at == 0 or at == nx - 1:  # an edge follows its inner neighbour
                part *= edge[at]
                at = min(max(at, 1), nx - 2)
            m = column[at]
            if m >= 0 and not held[at]:
                band[2 * wide + k - m, m] += part * factor


def band_inverse(
    by_f: Array,
    by_h: Array,
    scale: Array,
    response: Array,
    nodes: Indices,
    held: Array,
    give: Array,
    edge: Array,
) -> Callable[[Array], Array] | None:
    """Return a function that solves the local system of the `nodes`, ascending, of a row; None if it is singular.

    by_f, by_h [6, nx]: derivatives of the net inflow on the stencil; scale [nx] of the equations; response [nx]:
    deformation by the unit pressure of a node at a distance; held, give [nx] as by `asperities.sort_nodes`,
    edge [nx] as in `problem`.
    """
    size = nodes.size
    wide = max(min(_WIDE, size - 1), 2)
    kernel = response - response[min(wide, response.size - 1)]  # what is constant belongs to the rigid gap
    column = np.full(held.size, -1)
    column[nodes] = np.arange(size)
    band = np.zeros((3 * wide + 1, size), order="F")
    _assemble(by_f, by_h, scale, kernel, nodes, column, held, give, edge, wide, band)
    lapack = scipy.linalg.lapack
    factors, pivots, fault = lapack.dgbtrf(band, wide, wide, overwrite_ab=1)
    if fault:
        return None
    return lambda b: np.asarray(lapack.dgbtrs(factors, wide, wide, b, pivots)[0])
