"""Rolling resistance: the couple by which the oil's pressure flow resists rolling.

The shear stress of the pressure flow, (h/2) dp/dx against +x on both surfaces, is the rolling resistance

    F_r = integral of (h/2) dp/dx, p the pressure of the oil alone.

Conservation of mass makes 2 u_e F_r the power that the pressure flow dissipates, but for the integral of p dh/dt: what
the flanks of moving roughness take from the bodies and give back, and where bodies slide, what they add to friction. It
averages out of rolling where h and p are means over the instants in which roughness passes (that of a body at rest does
not), and F_r is that of the mean film: the hydrodynamic couple of the inlet, which formulas of smooth bodies have
(`reference.rolling_line`, `reference.rolling_point`). A grid ends within the inlet; what lies beyond is added in closed
form.

Source: Biboulet & Houpert, Proc. IMechE J 224 (2010) 765 and 777, doi:10.1243/13506501JET790 and 791.
"""

import numpy as np

from ..film.instant import Grid
from ..kernels.arrays import Array
from ..scene import Case
from .oil_temperature import inlet_ease


def couple(grid: Grid, gap: Array, fluid: Array) -> float:
    """Return the integral of (h/2) dp/dx [N] of the oil over the grid; rows of a line are samples of one mean."""
    cell = grid.cell
    if grid.periodic:
        cell *= gap.shape[0]
        gap, fluid = gap.mean(axis=0, keepdims=True), fluid.mean(axis=0, keepdims=True)
    return float((0.5 * gap * np.gradient(fluid, grid.spacing, axis=1)).sum()) * cell


def beyond_grid(case: Case, grid: Grid) -> float:
    """Return the part of the couple [N] that the full inlet makes beyond the edge of the grid."""
    op, oil = case.op, case.scene.lubricant
    reach = oil.supply.reach(case.hertz.a, case.shape.radius_x) if case.loaded else 0.0
    before, beside = -float(grid.x[0]), float(np.abs(grid.y).max())
    if not case.entrained or reach <= before:
        return 0.0
    speed, viscosity = op.entrainment_speed, float(oil.viscosity(0.0, op.inlet_temperature)) / inlet_ease(case)
    all_of_it = case.shape.rolling_beyond(abs(speed), viscosity, before, beside)
    without = case.shape.rolling_beyond(abs(speed), viscosity, reach, np.inf) if np.isfinite(reach) else 0.0
    return float(np.copysign(max(all_of_it - without, 0.0), speed))
