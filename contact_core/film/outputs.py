"""The outputs of a film, from its fields. `quantities` says which mean each of them is."""

import numpy as np

from ..kernels.arrays import Array, Mask
from ..reference import Hertz
from .instant import FilmState, Grid


def disc(grid: Grid, hertz: Hertz) -> Mask:
    """Return the nodes that h_c is a mean over: within 2/3 of Hertz's half widths, at least the nearest ones."""
    radius_2 = grid.radius_2
    nearest = radius_2 <= radius_2.min() * (1.0 + 1e-9)
    inside: Mask = nearest | hertz.inside(grid.x, grid.y, 2.0 / 3.0)
    return inside


def at_centre(grid: Grid, field: Array) -> float:
    """Return a field [ny, nx] at the centre of the contact by bilinear interpolation; a mean along a line."""
    if grid.periodic:  # all rows are alike
        return float(np.interp(0.0, grid.x, field.mean(axis=0)))
    i, j = (min(max(int(np.searchsorted(axis, 0.0, "right")) - 1, 0), axis.size - 2) for axis in (grid.x, grid.y))
    u, v = -grid.x[i] / grid.spacing, -grid.y[j] / grid.spacing
    rows = field[j : j + 2, i : i + 2] @ np.array([1.0 - u, u])
    return float(rows @ np.array([1.0 - v, v]))


def film_outputs(
    grid: Grid, state: FilmState, gap: Array, touching: Array, load: float, hertz: Hertz
) -> dict[str, float]:
    """Return film thicknesses, contact ratios, largest pressure and approach of a loaded contact.

    `touching` is the share of a node's area where solids touch.

    They are h_central, h_c, h_min, contact_area_ratio, contact_load_ratio, pressure_max and approach.
    """
    solid_pressure = state.pressure - state.fluid
    cell = grid.cell
    return {
        "h_central": at_centre(grid, gap),
        "h_c": float(gap[disc(grid, hertz)].mean()),
        "h_min": float(gap.min()),
        "contact_area_ratio": float(touching.sum()) * cell / hertz.area,
        "contact_load_ratio": float(solid_pressure.sum()) * cell / load,
        "pressure_max": float(state.pressure.max()),
        # the film of a periodic grid counts displacements from those a grid's length away
        "approach": -state.rigid_gap + (hertz.approach_beyond(grid.x[-1] - grid.x[0]) if grid.periodic else 0.0),
    }


def open_outputs(grid: Grid, state: FilmState, gap: Array) -> dict[str, float]:
    """Return the same for bodies that just touch: h_c is the gap at the centre."""
    centre = at_centre(grid, gap)
    ratios = dict.fromkeys(("contact_area_ratio", "contact_load_ratio", "pressure_max"), 0.0)
    return {"h_central": centre, "h_c": centre, "h_min": float(gap.min()), "approach": -state.rigid_gap} | ratios
