"""Solids that carry a load in dry contact, beside the pressure of oil: choice of the kernel."""

from ..kernels.arrays import Array
from ..kernels.dry import solve_dry
from ..kernels.dry_asperities import solve_dry_asperities
from ..kernels.dry_giving import solve_dry_giving
from ..kernels.half_space import HalfSpace
from ..kernels.surface_give import SurfaceGive


def pressed(
    half_space: HalfSpace,
    gap: Array,
    cap: Array,
    load: float,
    start: Array,
    fluid: Array,
    layer: tuple[float, float],
    give: SurfaceGive | None,
    tolerance: float,
    iterations: int,
) -> tuple[Array, float, bool, int]:
    """Return the solids' pressure, rigid gap, convergence and iterations, in the units of the kernels.

    Parameters
    ----------
    gap : of the undeformed bodies and what the half space gives under the oil.
    cap : largest pressure of oil and solids together.
    fluid : pressure of the oil.
    layer : stress and depth of asperities below the grid; depth 0: none.
    give : by which surfaces give way under oil and solids together, besides the half space; None: by nothing.

    """
    contact, limits = (half_space, gap, cap - fluid, load, start), (tolerance, iterations)
    if give is not None:
        give = give.above(fluid)
        contact = half_space, gap + give.soft * fluid, cap - fluid, load, start
    if layer[1] > 0.0:
        return solve_dry_asperities(*contact, layer, *limits, give)
    if give is not None:
        return solve_dry_giving(*contact, give, *limits)
    return solve_dry(*contact, *limits)
