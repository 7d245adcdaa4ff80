"""Mobilities of the coarse grid levels' corrections where the finest grid level has a fitted flow.

The corrections keep the wedge of second order upstream, which smooths well. Their mobilities decide whether they fit
the finest grid level: where viscosity rises by orders of magnitude from node to node, the fitted flow has the mean
fluidity over pressure, Phi' of `mixed.flow`, which is far below the mean of both nodes. With the latter alone
corrections of light loads diverge in the spike before the outlet, with the former alone those of heavy loads, whose
stiff zone has hardly any flow to correct. So

    e = e_up (1 + s^2 q) / (1 + s^2),   q = Phi' / mean of both fluidities,   s = e_up / (compliance dx^2),

e_up that of the upwind flow.
"""

from ..compiled import jit


@jit
def _blended(e, drop, driven, fluid, thinned, per_stiff):  # type: ignore[no-untyped-def]
    """Return e of a face from e_up, the differences of pressure and potential and the means of both fluidities."""
    square = (e * per_stiff) ** 2
    return e * (1.0 + square * (driven / drop + thinned) / (fluid + thinned)) / (1.0 + square)


@jit
def blend(p, fluid, potential, thinned, per_stiff, step, ex, ey):  # type: ignore[no-untyped-def]
    """Change the upwind flow's mobilities ex, ey of all faces into e; arguments as in `mixed.flow`."""
    ny, nx = p.shape
    for j in range(ny):
        for i in range(nx - 1):
            drop, driven = p[j, i + 1] - p[j, i], potential[j, i + 1] - potential[j, i]
            mean, thin = 0.5 * (fluid[j, i] + fluid[j, i + 1]), 0.5 * (thinned[j, i] + thinned[j, i + 1])
            if abs(drop) >= 0.5 * step:  # else q is 1
                ex[j, i] = _blended(ex[j, i], drop, driven, mean, thin, per_stiff)
    for j in range(ny - 1):
        for i in range(nx):
            drop, driven = p[j + 1, i] - p[j, i], potential[j + 1, i] - potential[j, i]
            mean, thin = 0.5 * (fluid[j, i] + fluid[j + 1, i]), 0.5 * (thinned[j, i] + thinned[j + 1, i])
            if abs(drop) >= 0.5 * step:
                ey[j, i] = _blended(ey[j, i], drop, driven, mean, thin, per_stiff)
