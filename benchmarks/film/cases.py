"""Contacts that benchmarks share: smooth ones in Moes' numbers, rough ones in SI, cascades of grids."""

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from contact_core.film.fitted import fitted_grid
from contact_core.film.instant import FilmSolution, Grid, Instant, Settings
from contact_core.film.outputs import film_outputs
from contact_core.film.routes import prolonged, solve_film
from contact_core.film.scaled import Scaled
from contact_core.film.solutions import solution
from contact_core.kernels.mixed.fixed_point import solve_mixed
from contact_core.kernels.mixed.newton import solve_newton
from contact_core.laws.density import DowsonHigginson, Incompressible
from contact_core.laws.viscosity import Barus, Roelands
from contact_core.reference import Hertz, SmoothContact, hertz_point, nijenbanning_venner_moes
from contact_core.shapes import Point

Array = np.ndarray


@dataclass(frozen=True)
class MoesCase:
    """A smooth contact given by Moes' numbers of load and lubricant (M, L), on its radius along x; the rest is steel
    and oil.
    """

    load: float
    lubricant: float
    viscosity_law: str = "barus"
    density_law: str = "none"
    radius: float = 10e-3
    ratio: float = 1.0  # radius along y over that along x
    modulus: float = 2.26e11
    viscosity: float = 0.04
    alpha: float = 2.2e-8

    @property
    def speed_number(self) -> float:
        """U = eta0 (u1 + u2) / (E' R), from L; any small one if there is no piezoviscosity."""
        return (self.lubricant / (self.alpha * self.modulus)) ** 4 if self.lubricant > 0.0 else 1e-11

    @property
    def unit(self) -> float:
        """Moes' unit of the film [m]."""
        return self.radius * math.sqrt(self.speed_number)

    @property
    def newtons(self) -> float:
        """Load."""
        return self.load * self.speed_number**0.75 * self.modulus * self.radius**2

    @property
    def hertz(self) -> Hertz:
        """The dry contact."""
        return hertz_point(self.newtons, self.radius, self.ratio * self.radius, self.modulus)

    @property
    def a(self) -> float:
        """Hertz's half width along x [m]."""
        return self.hertz.a

    @property
    def pressure(self) -> float:
        """Hertz's pressure [Pa]."""
        return self.hertz.pressure_max

    @property
    def smooth(self) -> SmoothContact:
        """In the terms of film formulas."""
        given = self.arguments()
        oil = self.viscosity, given["pressure_viscosity"]
        return SmoothContact(self.newtons, given["speed_1"], *oil, self.radius, self.ratio * self.radius, self.modulus)

    def arguments(self) -> dict[str, Any]:
        """Of `point_contact`."""
        speed = 0.5 * self.speed_number * self.modulus * self.radius / self.viscosity
        return {
            "load": self.newtons,
            "radius_x": self.radius,
            "radius_y": self.ratio * self.radius,
            "reduced_modulus": self.modulus,
            "speed_1": speed,
            "speed_2": speed,
            "viscosity": self.viscosity,
            "pressure_viscosity": self.alpha if self.lubricant > 0.0 else 0.0,
            "viscosity_law": self.viscosity_law,
            "density_law": self.density_law,
        }


def domain_of(case: MoesCase, width: Sequence[float]) -> tuple[float, ...]:
    """A domain in half widths, in metres."""
    return tuple(case.a * side for side in width)


def instant_of_call(arguments: dict[str, Any], heights: Array, hardness: float = 1e12) -> Instant:
    """Return the instant that `point_contact` makes of its arguments; heights [ny, nx]."""
    laws = {"barus": Barus, "roelands": Roelands, "none": Incompressible, "dowson_higginson": DowsonHigginson}
    viscosity = laws[arguments.get("viscosity_law", "roelands")]
    return Instant(
        load=arguments["load"],
        entrainment_speed=0.5 * (arguments["speed_1"] + arguments["speed_2"]),
        temperature=300.0,
        shape=Point(arguments["radius_x"], arguments.get("radius_y", arguments["radius_x"])),
        reduced_modulus=arguments["reduced_modulus"],
        viscosity=viscosity(arguments["viscosity"], 300.0, arguments["pressure_viscosity"], 0.0),
        density=laws[arguments.get("density_law", "dowson_higginson")](),
        heights=heights,
        limit=np.full(heights.shape, hardness),
        hardness=hardness,
    )


def grid_of(domain: Sequence[float], nodes: int) -> Grid:
    """Nodes x nodes on (x_min, x_max, y_min, y_max)."""
    return Grid(np.linspace(*domain[:2], nodes), np.linspace(*domain[2:], nodes))


def scaled_of(arguments: dict[str, Any], domain: Sequence[float], nodes: int, tolerance: float) -> Scaled:
    """A smooth contact in the units of the kernels, on a grid of nodes x nodes, with the upwind flow."""
    now = instant_of_call(arguments, np.zeros((nodes, nodes)))
    return Scaled(now, grid_of(domain, nodes), Settings(1e-9, tolerance, 2000, "pyfftw"))


@dataclass(frozen=True)
class RoughCase:
    """A rough ball on a flat, in SI; the same surface on every grid."""

    load: float
    radius: float
    viscosity: float
    alpha: float
    rq: float
    correlation: float
    speed: float
    modulus: float = 230.47e9
    hardness: float = 6e9
    seed: int = 1

    @property
    def smooth(self) -> SmoothContact:
        """The contact without its roughness."""
        return SmoothContact(self.load, self.speed, self.viscosity, self.alpha, self.radius, self.radius, self.modulus)

    @property
    def film(self) -> float:
        """Film of smooth bodies by formula [m]."""
        return nijenbanning_venner_moes(self.smooth)

    @property
    def hertz(self) -> Hertz:
        """The contact without roughness and oil."""
        return hertz_point(self.load, self.radius, self.radius, self.modulus)

    @property
    def domain(self) -> tuple[float, ...]:
        """The domain that fits the film."""
        grid = fitted_grid(Point(self.radius, self.radius), self.load, self.modulus, self.film, 129, 129)
        return tuple(float(side) for axis in (grid.x, grid.y) for side in (axis[0], axis[-1]))

    def heights(self, nodes: int) -> Array:
        """[nodes, nodes] on the domain."""
        grid = grid_of(self.domain, nodes)
        return waves(grid.x, grid.y, self.rq, self.correlation, self.seed)

    def arguments(self) -> dict[str, Any]:
        """Of `point_contact`, the grid aside."""
        return {
            "load": self.load,
            "radius_x": self.radius,
            "reduced_modulus": self.modulus,
            "speed_1": self.speed,
            "speed_2": self.speed,
            "viscosity": self.viscosity,
            "pressure_viscosity": self.alpha,
        }


@dataclass(frozen=True)
class Level:
    """A film on one grid of a cascade."""

    nodes: int
    grid: Grid
    film: FilmSolution
    outputs: dict[str, float]
    seconds: float


def cascade(case: RoughCase, grids: Sequence[int], settings: Settings) -> list[Level]:
    """Films of a case from grid to grid: the first as `film/routes.py` has it, finer ones from the film of the grid before, of
    half their nodes: by Newton's method where the film clears the roughness twice, else by the hybrid iteration. Ends with
    what the iterations of the settings reach.
    """
    levels: list[Level] = []
    thick = case.film > 2.0 * case.rq and not settings.lumped
    solve, most, name = (solve_newton, 60, "newton") if thick else (solve_mixed, settings.iterations, "hybrid")
    for nodes in grids:
        grid, now = grid_of(case.domain, nodes), instant_of_call(case.arguments(), case.heights(nodes), case.hardness)
        start = time.process_time()
        if not levels:
            film = solve_film(now, grid, settings)
        else:
            scaled = Scaled(now, grid, settings)
            begin = scaled.iterate(prolonged(levels[-1].film.state, grid.shape))
            found = solve(scaled.half_space, scaled.problem(), begin, settings.tolerance, most)
            film = solution(scaled, found, "mixed", f"{name} from the coarser grid")
        seconds = time.process_time() - start
        outputs = film_outputs(grid, film.state, film.gap, film.touching, case.load, case.hertz)
        levels.append(Level(nodes, grid, film, outputs, seconds))
    return levels


def waves(x: Array, y: Array, rq: float, correlation: float, seed: int, number: int = 600) -> Array:
    """Gaussian heights [ny, nx], autocorrelation rq^2 exp(-(r/l)^2), as a sum of waves: the same on every grid."""
    random = np.random.Generator(np.random.Philox(key=[seed, 3]))
    kx, ky = random.normal(0.0, math.sqrt(2.0) / correlation, (2, number))
    phase = random.uniform(0.0, 2.0 * np.pi, number)
    along, across = np.exp(1j * (kx[:, None] * x + phase[:, None])), np.exp(1j * ky[:, None] * y)
    heights: Array = rq * math.sqrt(2.0 / number) * (across.T @ along).real
    return heights
