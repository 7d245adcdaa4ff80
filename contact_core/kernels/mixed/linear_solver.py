"""Linear systems of Newton's method: GMRES, and the order in which a sparse factorisation eliminates nodes.

Source of the order: George, SIAM J. Numer. Anal. 10 (1973) 345, doi:10.1137/0710032.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from ..arrays import Array, Indices

_LINEAR_TOLERANCE = 1e-2
_KRYLOV = 40  # most GMRES steps; no restart


@lru_cache(maxsize=8)
def elimination_order(ny: int, nx: int, wrapped: bool) -> Indices:
    """Return the nodes of a grid in the order of nested dissection.

    Separators are two nodes thick, as the stencil reaches two nodes west. `wrapped`: the last inner row neighbours the
    first. A single row is in order.
    """
    if wrapped and ny == 3:
        return np.arange(nx + 1, 2 * nx - 1)
    order: list[int] = []

    def dissect(j0: int, j1: int, i0: int, i1: int, ring: bool = False) -> None:
        if (j1 - j0) * (i1 - i0) <= 24:
            order.extend(j * nx + i for i in range(i0, i1) for j in range(j0, j1))
        elif i1 - i0 >= j1 - j0:
            middle = (i0 + i1) // 2
            dissect(j0, j1, i0, middle, ring)
            dissect(j0, j1, middle + 2, i1, ring)
            order.extend(j * nx + i for j in range(j0, j1) for i in range(middle, middle + 2))
        elif ring:  # cut open
            dissect(j0 + 1, j1, i0, i1)
            order.extend(j0 * nx + i for i in range(i0, i1))
        else:
            middle = (j0 + j1) // 2
            dissect(j0, middle, i0, i1)
            dissect(middle + 1, j1, i0, i1)
            order.extend(middle * nx + i for i in range(i0, i1))

    dissect(1, ny - 1, 1, nx - 1, wrapped)
    return np.array(order)


def gmres(operator: Callable[[Array], Array], invert: Callable[[Array], Array], right: Array) -> Array:
    """Solve a linear system by right-preconditioned GMRES from zero.

    Source: Saad & Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856, doi:10.1137/0907058.

    The solution is not a number where the operator or its inverse is not.
    """
    size = np.linalg.norm(right)
    if size == 0.0:
        return np.zeros_like(right)
    basis: list[Array] = [right / size]
    images: list[Array] = []
    hessenberg = np.zeros((_KRYLOV + 1, _KRYLOV))
    target = np.zeros(_KRYLOV + 1)
    target[0] = size
    weights: Array = np.zeros(1)
    for k in range(_KRYLOV):
        images.append(invert(basis[k]))
        v = operator(images[k])
        for n, u in enumerate(basis):
            hessenberg[n, k] = u @ v
            v -= hessenberg[n, k] * u
        hessenberg[k + 1, k] = np.linalg.norm(v)
        used = hessenberg[: k + 2, : k + 1]
        if not np.isfinite(used).all():
            return np.full_like(right, np.nan)
        weights = np.asarray(np.linalg.lstsq(used, target[: k + 2], rcond=None)[0], np.float64)
        short = np.linalg.norm(used @ weights - target[: k + 2])
        if not np.isfinite(short) or short < _LINEAR_TOLERANCE * size or hessenberg[k + 1, k] == 0.0:
            break
        basis.append(v / hessenberg[k + 1, k])
    return np.sum([w * image for w, image in zip(weights, images, strict=True)], axis=0)
