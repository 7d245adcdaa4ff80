"""Dry contact of two rough bodies in one call: heights in, pressure and gap out. SI, arrays [ny, nx]."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..errors import OperatingPointError
from ..film.grid_steps import GridStep, area_by_chance
from ..film.instant import Grid
from ..kernels.arrays import Array
from ..quantities import out_of_range, parameter
from ..reference import hertz_point
from .refinement import refined_cells, surface_of, wants_accuracy

_ITERATIONS = 1000
_RELATIVE, _ABSOLUTE = ("pressure_max", "approach"), ("contact_area_ratio",)  # errors that `accuracy` bounds
_TOLERANCE, _TOLERANCE_OF_ACCURACY = 1e-8, 0.01  # by default, and over an accuracy
_LEAST_ACCURACY, _MOST_ACCURACY = 1e-4, 0.5
_LEAST_NODES = 8  # along each side of a surface to refine


@dataclass(frozen=True)
class DryContact:
    """Frictionless contact of elastic-perfectly-plastic bodies under a load. Arrays [ny, nx]."""

    pressure: Array  # [Pa]
    gap: Array  # [m], 0 in contact
    overlap: Array  # [m] overlap beyond a gap of 0 where the pressure is at the hardness; else 0
    approach: float  # [m] of the bodies, from first touching of their shapes without heights
    contact_area: float  # [m2] of the nodes under pressure
    contact_area_ratio: float  # to the area of Hertz's contact; to that of the array if the radius is infinite
    pressure_max: float  # [Pa]
    reaches_edge: bool  # the contact reaches the edge of the array, where the bodies end
    converged: bool
    iterations: int  # on the grid itself, without the coarser ones
    error: float  # estimate of sum |pressure - exact pressure| / sum pressure
    load_error: float  # (sum of the pressure on its cells) / load - 1
    complementarity: float  # mean |gap| under pressures below the hardness, by pressure, in rms heights (see below)
    spacing: float  # [m] of the nodes that the fields lie on
    error_estimate: dict[str, float] = field(default_factory=dict)  # with `accuracy`: half widths, each in its unit
    steps: tuple[GridStep, ...] = ()  # with `accuracy`: grids that were solved, in their order
    warnings: tuple[str, ...] = ()  # with `accuracy`: what is not met


@dataclass(frozen=True)
class _Solved:
    """A contact on one grid, as a sequence of grids needs it."""

    contact: DryContact

    @property
    def spacing(self) -> float:
        return self.contact.spacing

    @property
    def nodes(self) -> tuple[int, int]:
        ny, nx = self.contact.pressure.shape
        return ny, nx

    @property
    def converged(self) -> bool:
        return self.contact.converged

    @property
    def iterations(self) -> int:
        return self.contact.iterations

    @property
    def area_by_chance(self) -> float:
        cell = self.spacing**2
        area = self.contact.contact_area / self.contact.contact_area_ratio
        return area_by_chance(self.contact.pressure > 0.0, cell, area)

    @property
    def values(self) -> dict[str, float]:
        return {name: getattr(self.contact, name) for name in (*_RELATIVE, *_ABSOLUTE)}


@dataclass(frozen=True)
class _Numbers:
    """Numbers of a call, with their ranges."""

    spacing: float = parameter("m", "distance between nodes along x and y", above=0.0, most=1.0)
    radius: float = parameter("m", "combined radius of curvature, inf for flat bodies", above=0.0, most=1e3)
    radius_y: float = parameter("m", "combined radius of curvature along y, inf with radius", above=0.0, most=1e3)
    load: float = parameter("N", "normal load", above=0.0, most=1e9)
    reduced_modulus: float = parameter("Pa", "E' = 2 / [(1 - v1^2)/E1 + (1 - v2^2)/E2]", above=1e3, most=1e13)
    hardness: float = parameter("Pa", "largest pressure, None for elastic bodies", above=0.0, most=1e13)
    tolerance: float = parameter("", "relative error of the pressure", least=1e-13, most=0.1)
    fft: str = parameter("", "library of the transforms", choices=("pyfftw", "scipy"))


def dry_contact(
    heights: ArrayLike,
    spacing: float,
    radius: float,
    load: float,
    reduced_modulus: float,
    hardness: float | None = None,
    tolerance: float | None = None,
    *,
    radius_y: float | None = None,
    accuracy: float | None = None,
    fft: str = "pyfftw",
) -> DryContact:
    """Press two rough bodies together: no fluid, no friction, elastic half spaces that yield at the hardness.

    The gap at (x, y) from the centre of the array is x^2 / (2 radius) + y^2 / (2 radius_y) - heights + deformation -
    approach.

    Without rms height, complementarity is in terms of the approach. A solution that has not converged is reported by
    `converged`.

    Parameters
    ----------
    heights
        Heights [ny, nx] of both bodies together [m], positive toward the other body, any sizes from 2 on.
    spacing
        Distance between nodes along x and y [m].
    radius
        Combined radius of curvature [m], 1 / (1/R1 + 1/R2); inf for flat bodies that end with the array.
    load
        Normal load [N].
    reduced_modulus
        E' = 2 / [(1 - v1^2)/E1 + (1 - v2^2)/E2] [Pa].
    hardness
        Largest pressure [Pa]; None for elastic bodies.
    tolerance
        Largest relative error of the pressure on the nodes, sum |p - exact p| / sum p, by estimate; 1e-8 if not given.
    radius_y
        Radius along y [m] where it differs; then both are finite.
    accuracy
        Largest error of pressure_max and approach, relative, and of contact_area_ratio, absolute, by estimate; instead
        of `tolerance`. The heights then define a surface, by a cubic spline between their nodes, and coarser and finer
        grids over the same area sample it, from coarse to fine: `steps` tells which, and the fields of the result lie
        on the last, which is at least as fine as the heights. Where the accuracy is not reached, `warnings` tells so.
        The approach of flat bodies is left out.
    fft
        "pyfftw" or "scipy"; FFTW is under the GPL.

    Raises
    ------
    OperatingPointError
        For values that cannot be used.

    """
    z = _heights(heights)
    wants_accuracy(accuracy, tolerance=tolerance)
    if accuracy is not None:
        tolerance = _TOLERANCE_OF_ACCURACY * _accuracy(accuracy, z)
    elif tolerance is None:
        tolerance = _TOLERANCE
    numbers = _numbers(spacing, radius, radius_y, load, reduced_modulus, hardness, tolerance, fft)
    radii = float(radius), float(radius if radius_y is None else radius_y)
    limit = None if hardness is None else float(hardness)
    _check_capacity(z, numbers.spacing, numbers.load, limit)
    if accuracy is None:
        return _pressed(z, numbers, radii, limit)
    return _refined(z, numbers, radii, limit, accuracy)


def _refined(
    z: Array, numbers: _Numbers, radii: tuple[float, float], hardness: float | None, accuracy: float
) -> DryContact:
    """Return the contact on the first grid that meets the accuracy."""
    from ..film.estimate import stated_errors  # the kernels: loaded where a contact is solved
    from ..film.refined import Request, refined

    ny, nx = z.shape
    grids = refined_cells(ny, nx, numbers.spacing)
    surface = surface_of(z, Grid.centred(ny, nx, numbers.spacing))

    def solve(at: int, before: _Solved | None) -> _Solved:
        on = replace(numbers, spacing=grids[at].spacing)
        return _Solved(_pressed(surface.on(grids[at]), on, radii, hardness))

    def stated(solved: Sequence[_Solved]) -> dict[str, float]:
        return stated_errors(solved, numbers.tolerance)

    relative = _RELATIVE if math.isfinite(radii[0]) else _RELATIVE[:1]
    request = Request(accuracy, relative, _ABSOLUTE, max(surface.spacing, grids[-1].spacing))
    found = refined([grid.spacing for grid in grids], solve, stated, request)
    return replace(found.best.contact, error_estimate=found.errors, steps=found.steps, warnings=found.warnings)


def _pressed(z: Array, numbers: _Numbers, radii: tuple[float, float], hardness: float | None) -> DryContact:
    """Return the contact of heights [m] on the nodes that they are given on."""
    from ..film.shared import half_space  # the kernels: loaded where a contact is solved
    from ..kernels.dry import dry_solution

    spacing, load, (radius, radius_y) = numbers.spacing, numbers.load, radii
    ny, nx = z.shape
    # pressures by their mean over the array; gaps by what gives the kernel a factor of one
    p_unit = load / (spacing**2 * z.size)
    h_unit = 2.0 * spacing * p_unit / (math.pi * numbers.reduced_modulus)
    x, y = (spacing * (np.arange(n) - 0.5 * (n - 1)) for n in (nx, ny))
    ratio = 1.0 if radius == radius_y else radius / radius_y
    radius_2 = x[None, :] ** 2 + ratio * y[:, None] ** 2
    cap = np.full(z.shape, np.inf if hardness is None else hardness / p_unit)
    start, area = np.ones(z.shape), spacing**2 * z.size
    if math.isfinite(radius):
        hertz = hertz_point(load, radius, radius_y, numbers.reduced_modulus)
        ellipse = x[None, :] ** 2 + (hertz.a / hertz.b) ** 2 * y[:, None] ** 2
        start, area = np.sqrt(np.maximum(1.0 - ellipse / hertz.a**2, 0.0)), hertz.area
    found = dry_solution(
        half_space((ny, nx), 1.0, numbers.fft),
        (radius_2 / (2.0 * radius) - z) / h_unit,
        cap,
        float(z.size),
        start,
        numbers.tolerance,
        _ITERATIONS,
    )
    p, touch, yields = found.pressure, found.pressure > 0.0, found.pressure >= cap
    below = touch & ~yields
    rms = float(z.std()) or abs(found.rigid) * h_unit or h_unit
    return DryContact(
        pressure=p * p_unit,
        gap=np.where(touch, 0.0, np.maximum(found.gap, 0.0)) * h_unit,
        overlap=np.where(yields, np.maximum(-found.gap, 0.0), 0.0) * h_unit,
        approach=-found.rigid * h_unit,
        contact_area=float(touch.sum()) * spacing**2,
        contact_area_ratio=float(touch.sum()) * spacing**2 / area,
        pressure_max=float(p.max()) * p_unit,
        reaches_edge=bool(touch[[0, -1]].any() or touch[:, [0, -1]].any()),
        converged=found.converged,
        iterations=found.iterations,
        error=found.error,
        load_error=float(p.sum()) / z.size - 1.0,
        complementarity=float((p * np.abs(found.gap))[below].sum()) / z.size * h_unit / rms,
        spacing=spacing,
    )


def _accuracy(accuracy: Any, z: Array) -> float:
    """Return a checked accuracy for heights [m]."""
    numbers = isinstance(accuracy, (int, float, np.integer, np.floating)) and not isinstance(accuracy, bool)
    if not numbers or not _LEAST_ACCURACY <= accuracy <= _MOST_ACCURACY:
        raise OperatingPointError(
            f"accuracy = {accuracy!r} (largest error) must be a number from {_LEAST_ACCURACY:g} to {_MOST_ACCURACY:g}."
        )
    if min(z.shape) < _LEAST_NODES:
        raise OperatingPointError(
            f"heights of {z.shape} nodes [ny, nx] define no surface between them: accuracy needs {_LEAST_NODES} along "
            "each side."
        )
    return float(accuracy)


def _heights(heights: ArrayLike) -> Array:
    try:
        z = np.asarray(heights, dtype=np.float64)
    except (TypeError, ValueError):
        raise OperatingPointError("heights must be an array [ny, nx] of numbers in metres.") from None
    if z.ndim != 2 or min(z.shape) < 2:
        raise OperatingPointError(
            f"heights has the shape {z.shape}; it must be an array [ny, nx] with at least 2 nodes along each side."
        )
    bad = int((~np.isfinite(z)).sum())
    if bad:
        raise OperatingPointError(
            f"heights holds {bad} of {z.size} values that are not finite. Fill them in, for instance from their "
            "neighbours."
        )
    return z


def _numbers(
    spacing: Any, radius: Any, radius_y: Any, load: Any, reduced_modulus: Any, hardness: Any, tolerance: Any, fft: str
) -> _Numbers:
    given = {
        "spacing": spacing,
        "radius": radius,
        "radius_y": radius if radius_y is None else radius_y,
        "load": load,
        "reduced_modulus": reduced_modulus,
        "hardness": 1.0 if hardness is None else hardness,
        "tolerance": tolerance,
    }
    for name, value in given.items():
        try:
            given[name] = float(value)
        except (TypeError, ValueError):
            text = next(f.metadata["text"] for f in fields(_Numbers) if f.name == name)
            raise OperatingPointError(f"{name} = {value!r} ({text}) must be a number in SI units.") from None
    flat = given["radius"] == given["radius_y"] == math.inf
    numbers = _Numbers(**(given | ({"radius": 1.0, "radius_y": 1.0} if flat else {})), fft=fft)
    sentences = list(out_of_range(numbers, ""))
    if radius_y is None:  # report one fault once
        sentences = [sentence for sentence in sentences if not sentence.startswith("radius_y")]
    if sentences:
        raise OperatingPointError(" ".join(sentences))
    return numbers


def _check_capacity(z: Array, spacing: float, load: float, hardness: float | None) -> None:
    if hardness is None:
        return
    ny, nx = z.shape
    most = 0.99 * float(hardness) * spacing**2 * z.size
    if load > most:
        raise OperatingPointError(
            f"load = {load:g} N is more than bodies of {nx * spacing:g} m by {ny * spacing:g} m can carry at "
            f"hardness = {float(hardness):g} Pa, at most {most:.3g} N. Lower the load, raise the hardness or give a "
            "larger array."
        )
