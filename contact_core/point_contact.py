"""One call, SI, arrays in and arrays out: a lubricated, circular point contact at one instant."""

from dataclasses import dataclass
from operator import index
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import OperatingPointError
from .film.instant import FilmSolution, Grid, Instant, Settings
from .laws.density import DowsonHigginson, Incompressible
from .laws.viscosity import Barus, Roelands
from .quantities import TABLE, out_of_range, parameter
from .reading import did_you_mean
from .reference import SmoothContact, hertz_point, nijenbanning_venner_moes
from .reference_starvation import supplied_film

Array = NDArray[np.float64]

_REFERENCE = 300.0  # K: the laws of temperature play no part here
_UNLIMITED = 1e12  # Pa
_THICKEST = 0.01  # film over radius
_MOST_SUPPLY, _MOST_INLET = 0.01, 1.0  # m
_VISCOSITY = {law.name: law for law in (Roelands, Barus)}
_DENSITY = {law.name: law for law in (DowsonHigginson, Incompressible)}


@dataclass(frozen=True)
class PointContact:
    """What `point_contact` found, in SI. Arrays [ny, nx], x along entrainment of positive speed."""

    x: Array  # [nx]
    y: Array  # [ny]
    pressure: Array  # total
    fluid_pressure: Array
    solid_pressure: Array
    film: Array  # gap, at least the floor
    h_central: float
    h_c: float
    h_min: float
    contact_area_ratio: float
    contact_load_ratio: float
    pressure_max: float
    approach: float
    converged: bool
    shortfall: str  # why it is not converged; empty if it is
    algorithm: str  # regime and algorithm, as in film/routes.py
    iterations: int
    pressure_change: float  # of the last iteration, relative
    load_error: float  # relative
    load_beyond: float  # share of the load that a film wider than the grid carries beyond its edge
    complementarity: float  # mean distance of solid contacts from the floor, weighted by pressure, in floors
    imbalance: float  # mass that the film gains or loses unasked, relative
    error_estimate: dict[str, float]  # half width for each number above that is an output, in its unit; by two grids
    warnings: tuple[str, ...]  # what makes the answer less sure


@dataclass(frozen=True)
class _Numbers:
    """The scalars of a call, with their ranges."""

    load: float = parameter("N", TABLE["load"].text, above=0.0, most=1e6)
    radius_x: float = parameter("m", "combined radius of curvature along x", above=0.0, most=100.0)
    radius_y: float = parameter("m", "combined radius of curvature along y", above=0.0, most=100.0)
    reduced_modulus: float = parameter("Pa", "E' = 2 / [(1 - v1^2)/E1 + (1 - v2^2)/E2]", above=1e3, most=1e13)
    speed_1: float = parameter("m/s", TABLE["speed_1"].text, least=-1e3, most=1e3)
    speed_2: float = parameter("m/s", TABLE["speed_2"].text, least=-1e3, most=1e3)
    viscosity: float = parameter("Pa s", "viscosity at p = 0", least=1e-4, most=1e3)
    pressure_viscosity: float = parameter("Pa^-1", "d ln(viscosity)/dp at p = 0", least=0.0, most=1e-7)
    hardness: float = parameter("Pa", "largest pressure", above=1e6, most=_UNLIMITED)
    supply: float = parameter("m", "oil on both surfaces together before the contact", above=0.0, most=_MOST_SUPPLY)
    meniscus: float = parameter("m", "distance of the inlet meniscus before the centre", above=0.0, most=_MOST_INLET)
    floor: float = parameter("m", "gap at which solids touch", above=1e-11, most=1e-6)
    tolerance: float = parameter("", "relative pressure change that counts as converged", above=0.0, most=0.1)
    iterations: int = parameter("", "most iterations", least=1, most=100_000)


def point_contact(
    *,
    load: float,
    radius_x: float,
    radius_y: float | None = None,
    reduced_modulus: float,
    speed_1: float,
    speed_2: float,
    viscosity: float,
    pressure_viscosity: float,
    viscosity_law: str = "roelands",
    density_law: str = "dowson_higginson",
    heights_1: ArrayLike | None = None,
    heights_2: ArrayLike | None = None,
    spacing: float | None = None,
    hardness: float | None = None,
    grid: int | tuple[int, int] | None = None,
    domain: tuple[float, float, float, float] | None = None,
    floor: float = 1e-9,
    criterion: str = "split",
    cavitation: str = "reynolds",
    supply: float | None = None,
    meniscus: float | None = None,
    tolerance: float = 1e-3,
    iterations: int = 2000,
    fft: str = "pyfftw",
) -> PointContact:
    """Steady mixed lubrication of a circular point contact, from full film to dry.

    load [N]; radius_x = radius_y [m], combined; reduced_modulus E' [Pa]; speed_1, speed_2 [m/s] along x relative to
    the contact; viscosity [Pa s] and pressure_viscosity [1/Pa] at p = 0; viscosity_law "roelands" or "barus";
    density_law "dowson_higginson" or "none"; heights_1, heights_2 [ny, nx] of each body [m], positive toward the other
    one, centred on the contact, `spacing` [m] apart; hardness [Pa]: no pressure is above it (None: no limit); grid:
    nodes along both axes or (ny, nx) of smooth bodies, 129 if not given; domain: (x_min, x_max, y_min, y_max) [m] about
    the contact instead of the grid that fits the film; floor [m]: gap at which solids touch; criterion: "split" for
    fluid and solid pressure apart, "lumped" for one pressure as in Azam et al. 2019 (with floor = 0.47e-9); cavitation:
    "reynolds", or "mass_conserving" as Elrod, Jakobsson, Floberg and Olsson; supply [m]: oil on both surfaces together
    before the contact, which needs mass conservation (None: flooded); meniscus [m]: distance before the centre at which
    the inlet begins to be full (None: at the edge of the grid).

    Raises OperatingPointError for values that cannot be used and ConvergenceError if no solution was found. A solution
    short of the tolerance says so (`converged`, `shortfall`). At rest the dry contact is the answer; the gap of solids
    is the floor then, too, so that `approach` is a floor less than that of `dry_contact`.
    """
    from .film.estimate import solve_with_estimate  # the kernels: loaded where a film is solved

    given = {
        "load": load, "radius_x": radius_x, "reduced_modulus": reduced_modulus, "speed_1": speed_1, "speed_2": speed_2,
        "viscosity": viscosity, "pressure_viscosity": pressure_viscosity, "floor": floor, "tolerance": tolerance,
        "iterations": iterations,
    } | {
        name: value
        for name, value in (
            ("radius_y", radius_y),
            ("hardness", hardness),
            ("spacing", spacing),
            ("supply", supply),
            ("meniscus", meniscus),
        )
        if value is not None
    }  # fmt: skip
    _refuse(_no_numbers(given))
    numbers = _Numbers(
        load=float(load),
        radius_x=float(radius_x),
        radius_y=float(radius_x if radius_y is None else radius_y),
        reduced_modulus=float(reduced_modulus),
        speed_1=float(speed_1),
        speed_2=float(speed_2),
        viscosity=float(viscosity),
        pressure_viscosity=float(pressure_viscosity),
        hardness=_UNLIMITED if hardness is None else float(hardness),
        supply=_MOST_SUPPLY if supply is None else float(supply),
        meniscus=_MOST_INLET if meniscus is None else float(meniscus),
        floor=float(floor),
        tolerance=float(tolerance),
        iterations=int(iterations),
    )
    _refuse([*out_of_range(numbers, ""), *_circular(numbers)])
    choices = (("viscosity_law", viscosity_law, _VISCOSITY), ("density_law", density_law, _DENSITY))
    more = (
        ("criterion", criterion, ("split", "lumped")),
        ("fft", fft, ("pyfftw", "scipy")),
        ("cavitation", cavitation, ("reynolds", "mass_conserving")),
    )
    _refuse([_choice(name, value, list(known)) for name, value, known in (*choices, *more) if value not in list(known)])
    if supply is not None and cavitation != "mass_conserving":
        _refuse([f"supply = {supply:g} m needs cavitation = 'mass_conserving': else every gap counts as full. Set it."])
    heights, radius, speed = _heights(heights_1, heights_2), numbers.radius_x, 0.5 * (numbers.speed_1 + numbers.speed_2)
    law = _VISCOSITY[viscosity_law](numbers.viscosity, _REFERENCE, numbers.pressure_viscosity, 0.0)
    film = 0.0
    if speed != 0.0:
        rise = max(numbers.pressure_viscosity, 1e-12)
        smooth = SmoothContact(
            numbers.load, abs(speed), numbers.viscosity, rise, radius, radius, numbers.reduced_modulus
        )
        film = nijenbanning_venner_moes(smooth)
        if supply is not None:
            film = supplied_film(film, numbers.supply)
        if film > _THICKEST * radius:
            _refuse(
                [
                    f"The oil film would be about {film:.2g} m, over {_THICKEST:g} of radius_x = {radius:g} m: "
                    "the bodies are no parabolas on its scale. Raise load, or lower speed_1, speed_2 or viscosity."
                ]
            )
    nodes = _grid(numbers, film, heights, spacing, grid, domain)
    now = Instant(
        load=numbers.load,
        entrainment_speed=speed,
        temperature=_REFERENCE,
        radius_x=radius,
        radius_y=numbers.radius_y,
        reduced_modulus=numbers.reduced_modulus,
        viscosity=law,
        density=_DENSITY[density_law](),
        heights=np.zeros(nodes.shape) if heights is None else heights,
        limit=np.full(nodes.shape, numbers.hardness),
        hardness=numbers.hardness,
        conserving=cavitation == "mass_conserving",
        supply=None if supply is None else numbers.supply,
        meniscus=None if meniscus is None else numbers.meniscus,
    )
    hertz = hertz_point(numbers.load, radius, radius, numbers.reduced_modulus)
    settings = Settings(numbers.floor, numbers.tolerance, numbers.iterations, fft, criterion == "lumped")
    found, values, errors = solve_with_estimate(now, nodes, settings, hertz)
    state = found.state
    return PointContact(
        x=nodes.x,
        y=nodes.y,
        pressure=state.pressure,
        fluid_pressure=state.fluid,
        solid_pressure=np.where(state.solid, state.pressure - state.fluid, 0.0),
        film=found.gap,
        **values,
        converged=found.converged,
        shortfall=found.shortfall,
        algorithm=found.algorithm,
        iterations=found.iterations,
        pressure_change=found.change,
        load_error=found.load_error,
        load_beyond=found.load_beyond,
        complementarity=found.complementarity,
        imbalance=found.imbalance,
        error_estimate=errors,
        warnings=tuple(_warnings(found, nodes, hertz.a)),
    )


def _no_numbers(given: dict[str, Any]) -> list[str]:
    """One sentence for each value that is not a real number."""
    return [
        f"{name} = {value!r} is not a number. Give it as one, in SI units without a unit string."
        for name, value in given.items()
        if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.integer, np.floating))
    ]


def _refuse(sentences: list[str]) -> None:
    if sentences:
        raise OperatingPointError(" ".join(sentences))


def _choice(name: str, value: Any, known: list[str]) -> str:
    return f"{name} = {value!r} is not one of {', '.join(known)}.{did_you_mean(str(value), known)}"


def _circular(numbers: _Numbers) -> list[str]:
    if numbers.radius_y == numbers.radius_x:
        return []
    return [
        f"radius_y = {numbers.radius_y:g} m differs from radius_x = {numbers.radius_x:g} m: only circular contacts are "
        "solved by this call. Leave radius_y out, or use a Scene, which takes elliptical ones."
    ]


def _heights(first: ArrayLike | None, second: ArrayLike | None) -> Array | None:
    """Heights of both bodies together, or None for smooth ones."""
    given = []
    for name, values in (("heights_1", first), ("heights_2", second)):
        if values is None:
            continue
        try:
            array = np.array(values, dtype=np.float64)
        except (TypeError, ValueError):
            _refuse([f"{name} is no array of real numbers; it must be an array [ny, nx] of heights in metres."])
        if array.ndim != 2:
            _refuse([f"{name} has {array.ndim} dimensions; it must be an array [ny, nx] of heights in metres."])
        if not np.isfinite(array).all():
            _refuse(
                [f"{name} holds {int((~np.isfinite(array)).sum())} values that are not finite. Fill the gaps first."]
            )
        given.append(array)
    if len(given) == 2 and given[0].shape != given[1].shape:
        _refuse(
            [f"heights_1 is {given[0].shape} and heights_2 {given[1].shape}; both must lie on the same nodes [ny, nx]."]
        )
    return np.sum(given, axis=0) if given else None


def _grid(
    numbers: _Numbers,
    film: float,
    heights: Array | None,
    spacing: float | None,
    grid: int | tuple[int, int] | None,
    domain: tuple[float, float, float, float] | None,
) -> Grid:
    """The nodes that the arguments ask for."""
    try:
        shape = (129, 129) if grid is None else tuple(index(n) for n in np.broadcast_to(np.asarray(grid), 2).tolist())
    except (TypeError, ValueError):
        _refuse([f"grid = {grid!r} must be one whole number or (ny, nx)."])
    if heights is not None:
        if heights.shape[0] < 17 or heights.shape[1] < 17:
            _refuse([f"heights of {heights.shape} nodes [ny, nx] are too few: 17 along each axis are the least."])
        if grid is not None and shape != heights.shape:
            _refuse(
                [f"grid = {grid} does not fit heights of {heights.shape} nodes. Leave grid out: heights decide it."]
            )
        shape = heights.shape
    if len(shape) != 2 or min(shape) < 17 or max(shape) > 4097:
        _refuse([f"grid = {shape} must be one number or (ny, nx), from 17 to 4097 nodes along each axis."])
    ny, nx = shape
    if domain is not None:
        return _grid_of_domain(numbers, spacing, domain, ny, nx)
    if heights is not None and spacing is None:
        _refuse(["spacing = None: heights need the distance between their nodes in metres."])
    if spacing is not None:
        if not (np.isfinite(spacing) and spacing > 0.0):
            _refuse([f"spacing = {spacing:g} m must be finite and above 0."])
        return Grid.centred(ny, nx, spacing)
    from .film.fitted import fitted_grid

    found = fitted_grid(numbers.load, numbers.radius_x, numbers.reduced_modulus, film, ny, nx)
    return found if numbers.speed_1 + numbers.speed_2 >= 0.0 else found.mirrored()


def _grid_of_domain(
    numbers: _Numbers, spacing: float | None, domain: tuple[float, float, float, float], ny: int, nx: int
) -> Grid:
    try:
        x_min, x_max, y_min, y_max = (float(value) for value in domain)
        about = x_min < 0.0 < x_max and y_min < 0.0 < y_max and bool(np.isfinite(domain).all())
    except (TypeError, ValueError):
        about = False
    if not about:
        _refuse([f"domain = {domain!r} must be (x_min, x_max, y_min, y_max) in metres about the contact at (0, 0)."])
    x, y = np.linspace(domain[0], domain[1], nx), np.linspace(domain[2], domain[3], ny)
    dx, dy = x[1] - x[0], y[1] - y[0]
    if abs(dx - dy) > 1e-6 * dx or (spacing is not None and abs(spacing - dx) > 1e-6 * dx):
        _refuse(
            [
                f"domain = {domain} on {ny} by {nx} nodes gives distances of {dx:.6g} m along x and {dy:.6g} m along y"
                f"{'' if spacing is None else f', spacing says {spacing:.6g} m'}; they must be the same. "
                "Change grid or domain."
            ]
        )
    return Grid(x, y)


def _warnings(found: FilmSolution, grid: Grid, a: float) -> list[str]:
    """Sentences on what makes an answer less sure."""
    sentences = []
    if found.route == "fallback":
        sentences.append("The dry contact stands in for a film that was not found.")
    if found.route == "mixed" and found.inlet_nodes < 3.0:
        sentences.append(
            f"The film builds up across {found.inlet_nodes:.1f} nodes of the grid: it is a number of this grid. "
            "Use more nodes or a smaller domain for its own value."
        )
    if found.load_beyond > 0.1:
        sentences.append(
            f"{found.load_beyond:.0%} of the load are carried beyond the grid, by the formula of a rigid inlet. "
            "Integrals over the grid miss that part."
        )
    pressure = found.state.pressure
    edges = max(pressure[[1, -2], :].max(), pressure[:, [1, -2]].max())
    if found.state.solid[[0, 1, -2, -1], :].any() or found.state.solid[:, [0, 1, -2, -1]].any():
        sentences.append("Solids touch at the edge of the grid. Enlarge the domain.")
    elif edges > 0.05 * pressure.max():
        sentences.append(f"The pressure at the edge of the grid is {edges:.2g} Pa. Enlarge the domain.")
    if 2.0 * a < 8.0 * grid.spacing and found.route != "mixed":
        sentences.append("Fewer than 8 nodes lie across the Hertz contact.")
    return sentences
