"""What many instants share: half spaces with their plans, and an oil's tables over pressure."""

import threading
from collections.abc import Callable
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ..kernels.arrays import Array
from ..kernels.half_space import HalfSpace, PeriodicHalfSpace

if TYPE_CHECKING:
    from ..kernels.subsurface import Subsurface


ENTRIES = 16385  # of a table over 0 <= p <= hardness: relative error of the viscosity below 1e-4

_LOCAL = threading.local()  # plans and scratch may not be shared between threads


def half_space(shape: tuple[int, int], scale: float, library: str, reference: float | None = None) -> HalfSpace:
    """Return the half space of a grid, with stored plans; with a `reference` [nodes] that of a periodic grid."""
    store: dict[tuple[tuple[int, int], float, str, float | None], HalfSpace]
    store = _LOCAL.__dict__.setdefault("half_spaces", {})
    key = (shape, scale, library, reference)
    if key not in store:
        if len(store) >= 8:
            store.pop(next(iter(store)))
        made = HalfSpace if reference is None else partial(PeriodicHalfSpace, reference=reference)
        store[key] = made(*shape, scale, library)
    return store[key]


@lru_cache(maxsize=8)
def tables(
    viscosity: Callable[[Array, float], Array], density: Callable[[Array], Array], temperature: float, top: float
) -> tuple[Array, Array, float]:
    """Return tables of 1 / viscosity over that at p = 0 and of the density ratio, and the viscosity at p = 0."""
    pressure = np.linspace(0.0, top, ENTRIES)
    values = viscosity(pressure, temperature)
    return values[0] / values, density(pressure), float(values[0])


def subsurface(
    shape: tuple[int, int], spacing: float, depths: tuple[float, ...], poisson: float, library: str, *, periodic: bool
) -> "Subsurface":
    """Return the stresses below a grid at depths [m], with stored plans."""
    from ..kernels.subsurface import Subsurface  # loads the compiler

    store: dict[tuple[Any, ...], Subsurface] = _LOCAL.__dict__.setdefault("subsurfaces", {})
    key = (shape, spacing, depths, poisson, library, periodic)
    if key not in store:
        if len(store) >= 4:
            store.pop(next(iter(store)))
        store[key] = Subsurface(shape, spacing, np.array(depths), poisson, library, periodic=periodic)
    return store[key]
