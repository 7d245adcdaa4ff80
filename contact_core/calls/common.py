"""Common parts of the calls that solve one film: checks of arguments, solution, result."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from operator import index
from typing import Any, TypeVar

import numpy as np

from ..film import Convergence
from ..film.grid_steps import GridStep
from ..film.instant import FilmSolution, Grid, Instant, Settings
from ..kernels.arrays import Array
from ..laws.density import DowsonHigginson, Incompressible
from ..laws.viscosity import Barus, Roelands
from ..quantities import TABLE, out_of_range, parameter
from ..reference import SmoothContact, SmoothLine
from ..reference.starvation import supplied_film
from ..shapes import Shape
from .inlet import extent_before, with_inlet
from .options import refuse
from .refinement import FINEST, Surface, grids_within, surface_of, wants_accuracy

UNLIMITED = 1e12  # Pa
_REFERENCE = 300.0  # K: any; temperatures are constant here
_SLOWEST = 1e-30  # m/s
_THICKEST = 0.01  # film over the smaller radius
_VISCOSITY = {law.name: law for law in (Roelands, Barus)}
_DENSITY = {law.name: law for law in (DowsonHigginson, Incompressible)}


@dataclass(frozen=True)
class FilmContact(Convergence):
    """Result of a call: `PointContact` says what its attributes are."""

    x: Array  # [nx]
    y: Array  # [ny]
    pressure: Array  # total
    fluid_pressure: Array
    solid_pressure: Array
    film: Array  # gap, at least the floor
    oil: Array  # density ratio times thickness of the oil in the gap: less than the gap in cavities
    h_central: float
    h_c: float
    h_min: float
    contact_area_ratio: float
    contact_load_ratio: float
    pressure_max: float
    approach: float
    error_estimate: dict[str, float]  # half width of each output above, in its unit, by coarser grids and a cut inlet
    warnings: tuple[str, ...]  # reasons why the answer is less reliable
    steps: tuple[GridStep, ...] = ()  # grids that were solved to meet `accuracy`, in their order


Found = TypeVar("Found", bound=FilmContact)


@dataclass(frozen=True, kw_only=True)
class Numbers:
    """The scalars that every call takes, with their ranges."""

    reduced_modulus: float = parameter("Pa", "E' = 2 / [(1 - v1^2)/E1 + (1 - v2^2)/E2]", above=1e3, most=1e13)
    speed_1: float = parameter("m/s", TABLE["speed_1"].text, least=-1e3, most=1e3)
    speed_2: float = parameter("m/s", TABLE["speed_2"].text, least=-1e3, most=1e3)
    viscosity: float = parameter("Pa s", "viscosity at p = 0", least=1e-4, most=1e3)
    pressure_viscosity: float = parameter("Pa^-1", "d ln(viscosity)/dp at p = 0", least=0.0, most=1e-7)
    hardness: float = parameter("Pa", "largest pressure", above=1e6, most=UNLIMITED, default=UNLIMITED)
    floor: float = parameter("m", "gap at which solids touch", above=1e-11, most=1e-6)
    tolerance: float = parameter(
        "", "relative pressure change that counts as converged", above=0.0, most=0.1, default=1e-3
    )
    accuracy: float = parameter("", "largest error, relative, of ratios absolute", least=1e-4, most=0.5, default=0.5)
    iterations: int = parameter("", "most iterations", least=1, most=100_000)
    spacing: float = parameter("m", "distance between nodes along x and y", above=0.0, most=1.0, default=1.0)
    supply: float = parameter("m", "oil on both surfaces before the contact", above=0.0, most=1.0, default=1.0)
    meniscus: float = parameter("m", "distance of the inlet meniscus", above=0.0, most=1.0, default=1.0)

    @property
    def entrainment_speed(self) -> float:
        """u_e = (u1 + u2) / 2 [m/s]; 0 where it is so small that the film would be thinner than any atom."""
        speed = 0.5 * (self.speed_1 + self.speed_2)
        return speed if abs(speed) > _SLOWEST else 0.0


Given = TypeVar("Given", bound=Numbers)


def numbers_of(cls: type[Given], given: Mapping[str, Any]) -> Given:
    """Return the checked numbers among the arguments of a call; those that are None keep their defaults."""
    names = {f.name for f in fields(cls)}
    values = {name: value for name, value in given.items() if name in names and value is not None}
    refuse(no_numbers(values))
    whole = {name: int(value) if name == "iterations" else float(value) for name, value in values.items()}
    numbers = cls(**whole)  # type: ignore[arg-type]
    refuse(list(out_of_range(numbers, "")))
    return numbers


@dataclass(frozen=True)
class FilmCall(ABC):
    """A contact that a call asks for."""

    shape: Shape
    load: float  # [N] of the whole shape
    numbers: Numbers
    options: Mapping[str, Any]  # all of `ContactOptions`, and the criterion
    domain: tuple[float, ...] | None
    heights: Array | None  # of both bodies together

    @abstractmethod
    def nodes(self, grid: int | tuple[int, int] | None) -> Grid:
        """Return the nodes that the arguments ask for."""

    @abstractmethod
    def grids(self) -> list[Grid]:
        """Return grids for smooth bodies, from coarse to fine."""

    @cached_property
    def film(self) -> float:
        """Film [m] of smooth bodies by formula, behind an oil layer [m] or flooded; 0 at rest.

        Raises OperatingPointError if it is too thick for the bodies' shape.
        """
        if self.numbers.entrainment_speed == 0.0:
            return 0.0
        shape, film, supply = self.shape, self.smooth.film, self.options["supply"]
        if supply is not None:
            film = supplied_film(film, supply, resistance=shape.side_resistance)
        radius, least = min((value, name) for name, value in shape.radii)
        if len(shape.radii) == 1:
            least = "radius"  # as the call of a line names it
        if film > _THICKEST * radius:
            refuse(
                [
                    f"The oil film would be about {film:.2g} m, over {_THICKEST:g} of {least} = {radius:g} m: the "
                    "parabolic shape does not hold on its scale. Raise load, or lower speed_1, speed_2 or viscosity."
                ]
            )
        return film

    @cached_property
    def smooth(self) -> SmoothContact | SmoothLine:
        """The flooded contact of the smooth bodies in the terms of film formulas."""
        numbers = self.numbers
        oil = Barus(numbers.viscosity, _REFERENCE, numbers.pressure_viscosity, 0.0), _REFERENCE
        smooth = self.shape.smooth(self.load, abs(numbers.entrainment_speed), *oil, numbers.reduced_modulus)
        return replace(smooth, pressure_coefficient=max(numbers.pressure_viscosity, 1e-12))

    def before(self) -> float:
        """Return the extent [m] before the centre that the accuracy needs; 0 without a film."""
        a = self.shape.hertz(self.load, self.numbers.reduced_modulus).a
        return extent_before(self.numbers.accuracy, a, self.shape, self.smooth) if self.film > 0.0 else 0.0

    def instant(self, nodes: Grid, heights: Array | None) -> Instant:
        """Return what is to be solved on the nodes of a grid, with heights on them."""
        numbers, options = self.numbers, self.options
        supply, meniscus, conserving = (options[name] for name in ("supply", "meniscus", "cavitation"))
        hertz = self.shape.hertz(self.load, numbers.reduced_modulus)
        if meniscus is not None and meniscus <= hertz.a:
            refuse(
                [
                    f"meniscus = {meniscus:g} m must be more than the half width of Hertz's contact, {hertz.a:.3g} m: "
                    "no oil would be before it."
                ]
            )
        if supply is not None and conserving != "mass_conserving":
            refuse([f"supply = {supply:g} m needs cavitation = 'mass_conserving'; otherwise every gap counts as full."])
        oil = numbers.viscosity, _REFERENCE, numbers.pressure_viscosity, 0.0
        return Instant(
            load=self.load,
            entrainment_speed=numbers.entrainment_speed,
            temperature=_REFERENCE,
            shape=self.shape,
            reduced_modulus=numbers.reduced_modulus,
            viscosity=_VISCOSITY[options["viscosity_law"]](*oil),
            density=_DENSITY[options["density_law"]](),
            heights=np.zeros(nodes.shape) if heights is None else heights,
            limit=np.full(nodes.shape, numbers.hardness),
            hardness=numbers.hardness,
            conserving=conserving == "mass_conserving",
            supply=supply,
            meniscus=meniscus,
        )

    @property
    def settings(self) -> Settings:
        """How it is solved."""
        numbers, options = self.numbers, self.options
        lumped, fitted = options["criterion"] == "lumped", options["flux"] == "fitted"
        return Settings(numbers.floor, numbers.tolerance, numbers.iterations, options["fft"], lumped, fitted)


def solved(found_as: type[Found], call: FilmCall, finest: int = FINEST) -> Found:
    """Solve for one steady film: on the grid that is asked for, or on the first that meets an accuracy.

    `finest`: most intervals along the shorter side of the grids of rough bodies.
    """
    options, heights, _ = call.options, call.heights, call.film  # which refuses films that are too thick
    if not wants_accuracy(options["accuracy"], grid=options["grid"], tolerance=options["tolerance"]):
        from ..film.estimate import solve_with_estimate  # kernels are loaded when a film is solved

        nodes = call.nodes(options["grid"])
        now = call.instant(nodes, heights)
        found, values, errors = solve_with_estimate(now, nodes, call.settings)
        return _answer(found_as, now, nodes, found, values, errors)
    if heights is None:
        return _to_accuracy(found_as, call, call.grids(), None)
    given = call.nodes(None)
    return _to_accuracy(found_as, call, grids_within(given, finest), surface_of(heights, given))


def _to_accuracy(found_as: type[Found], call: FilmCall, grids: Sequence[Grid], surface: Surface | None) -> Found:
    """Solve for one steady film on the first of the grids, from coarse to fine, that meets the accuracy.

    `surface`: None if smooth; no grid that does not show it is the answer, but the finest.
    """
    from ..film.refined import Request, refined_film  # kernels are loaded when a film is solved

    def on(grid: Grid) -> Instant:
        return call.instant(grid, None if surface is None else surface.on(grid))

    shown = np.inf if surface is None else max(surface.spacing, grids[-1].spacing)
    found = refined_film(on, grids, call.settings, Request(call.numbers.accuracy, coarsest=shown))
    best = found.best
    answer = _answer(found_as, on(best.grid), best.grid, best.solution, best.values, found.errors)
    return replace(answer, steps=found.steps, warnings=(*answer.warnings, *found.warnings))


def _answer(
    found_as: type[Found],
    now: Instant,
    nodes: Grid,
    found: FilmSolution,
    values: dict[str, float],
    errors: dict[str, float],
) -> Found:
    state, hertz = found.state, now.shape.hertz(now.load, now.reduced_modulus)
    errors, cut = with_inlet(now, nodes, found, values, errors)
    return found_as(
        x=nodes.x,
        y=nodes.y,
        pressure=state.pressure,
        fluid_pressure=state.fluid,
        solid_pressure=state.pressure - state.fluid,
        film=found.gap,
        oil=state.mass,
        **(found.convergence | values),
        error_estimate=errors,
        warnings=(*_warnings(found, nodes, min(hertz.a, hertz.b)), *cut),
    )


def heights_of(options: Mapping[str, Any]) -> Array | None:
    """Return the heights of both bodies together, or None for smooth ones."""
    given = []
    for name in ("heights_1", "heights_2"):
        if (values := options[name]) is None:
            continue
        try:
            array = np.array(values, dtype=np.float64)
        except (TypeError, ValueError):
            refuse([f"{name} is not an array of real numbers; it must be an array [ny, nx] of heights in metres."])
        if array.ndim != 2:
            refuse([f"{name} has {array.ndim} dimensions; it must be an array [ny, nx] of heights in metres."])
        if not np.isfinite(array).all():
            refuse(
                [f"{name} holds {int((~np.isfinite(array)).sum())} values that are not finite. Fill the gaps first."]
            )
        given.append(array)
    if len(given) == 2 and given[0].shape != given[1].shape:
        refuse(
            [f"heights_1 is {given[0].shape} and heights_2 {given[1].shape}; both must lie on the same nodes [ny, nx]."]
        )
    return np.sum(given, axis=0) if given else None


def grid_nodes(grid: int | tuple[int, int] | None) -> tuple[int | None, int | None]:
    """Return the nodes (ny, nx) that `grid` gives; None where it leaves them open."""
    if grid is None:
        return None, None
    try:
        nodes = [index(n) for n in np.atleast_1d(np.asarray(grid)).tolist()]
    except (TypeError, ValueError):
        nodes = []
    if len(nodes) not in (1, 2):
        refuse([f"grid = {grid!r} must be one whole number or (ny, nx)."])
    return (None, nodes[0]) if len(nodes) == 1 else (nodes[0], nodes[1])


def nodes_of(heights: Array, ny: int | None, nx: int | None) -> tuple[int, int]:
    """Return the nodes of heights. Raises OperatingPointError if `grid` asks for others."""
    rows, columns = heights.shape
    if nx is not None and (ny or rows, nx) != heights.shape:
        asked = nx if ny is None else (ny, nx)
        refuse([f"grid = {asked} does not fit heights of {heights.shape} nodes. Leave grid out: heights decide it."])
    return rows, columns


def no_numbers(given: dict[str, Any]) -> list[str]:
    """Return one sentence for each value that is not a real number."""
    return [
        f"{name} = {value!r} is not a number. Give it as one, in SI units without a unit string."
        for name, value in given.items()
        if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.integer, np.floating))
    ]


def _warnings(found: FilmSolution, grid: Grid, a: float) -> list[str]:
    """Return sentences on what makes an answer less reliable."""
    sentences = [] if found.converged else [f"The solution has not converged: {found.shortfall}."]
    if found.route == "fallback":
        sentences.append("No film was found; the dry contact replaces it.")
    if not found.resolved:
        sentences.append(
            f"The film builds up across {found.inlet_nodes:.1f} nodes: its thickness depends on this grid. "
            "Use more nodes or a smaller domain."
        )
    if found.load_beyond > 0.1:
        sentences.append(
            f"{found.load_beyond:.0%} of the load are carried beyond the grid, by the formula of a rigid inlet. "
            "Integrals over the grid do not include that part."
        )
    pressure = found.state.pressure
    near = np.zeros(pressure.shape, np.bool_)  # the edge
    near[:, [0, 1, -2, -1]] = True
    if not grid.periodic:
        near[[0, 1, -2, -1], :] = True
    edges = float(pressure[near].max())
    if found.state.solid[near].any():
        sentences.append("Solids touch at the edge of the grid. Enlarge the domain.")
    elif edges > 0.05 * pressure.max():
        sentences.append(f"The pressure at the edge of the grid is {edges:.2g} Pa. Enlarge the domain.")
    if 2.0 * a < 8.0 * grid.spacing and found.route != "mixed":
        sentences.append("Fewer than 8 nodes lie across the Hertz contact.")
    return sentences
