"""Edge of the grid: pressures that follow their inner neighbours, and image rows of a periodic grid."""

from ..compiled import jit


@jit
def wrap(field):  # type: ignore[no-untyped-def]
    """Make the first and the last row images of the last and the first but one."""
    ny, nx = field.shape
    for i in range(nx):
        field[0, i] = field[ny - 2, i]
        field[ny - 1, i] = field[1, i]


@jit
def set_edge(p, edge, wrapped):  # type: ignore[no-untyped-def]
    """Set the pressures of edge nodes from their inner neighbours, or from the nodes they are images of."""
    ny, nx = p.shape
    for j in range(ny):
        p[j, 0] = edge[j, 0] * p[j, 1]
        p[j, nx - 1] = edge[j, nx - 1] * p[j, nx - 2]
    if wrapped:
        wrap(p)
        return
    for i in range(nx):
        p[0, i] = edge[0, i] * p[1, i]
        p[ny - 1, i] = edge[ny - 1, i] * p[ny - 2, i]


@jit
def load_beyond(p, weight):  # type: ignore[no-untyped-def]
    """Return the load of the edge nodes and of the film beyond them."""
    ny, nx = p.shape
    total = 0.0
    for j in range(1, ny - 1):
        total += weight[j, 0] * p[j, 0] + weight[j, nx - 1] * p[j, nx - 1]
    for i in range(nx):
        total += weight[0, i] * p[0, i] + weight[ny - 1, i] * p[ny - 1, i]
    return total
