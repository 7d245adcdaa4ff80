"""Which algorithm solves which contact: a table, and the little that carries it out.

A steady film goes to the first row of REGIMES that it fits; the algorithms of that row are tried in turn until one
meets the stopping rule (`kernels.mixed.shortfall`). An instant that follows from another one is marched from it first.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..errors import ConvergenceError
from ..kernels.direct import solve_direct
from ..kernels.grids import prolong, restrict
from ..kernels.mixed import Iterate, Solution, advected, solve_mixed
from ..kernels.multigrid import is_applicable, solve_smooth
from .instant import FilmSolution, FilmState, Grid, Instant, Settings
from .scaled import Scaled

_ALL = (0.0, math.inf)
_FULL_FILM = 3.0  # formula film over rms roughness from which on a dry contact means nothing
_NESTED_FROM = 65  # nodes along an axis from which on a film begins on the grid of half of them
_HYBRID_ITERATIONS, _DIRECT_ITERATIONS = 200, 100  # of one try at a steady film
_CYCLES = 30
# a film short of its tolerance is still better than the dry contact within these
_LOAD_ACCEPTED = 1e-3
_CHANGE_ACCEPTED = 0.1
_INTRUSION_ACCEPTED = 20.0


@dataclass(frozen=True)
class Regime:
    """A row of the table: what a contact has to be like, and its algorithms, as (method, start), in turn."""

    name: str
    algorithms: tuple[tuple[str, str], ...]
    clearance: tuple[float, float] = _ALL  # formula film of smooth bodies / rms roughness (smooth: infinite)
    load: tuple[float, float] = _ALL  # Moes' M

    def holds(self, scaled: Scaled) -> bool:
        """Whether a contact belongs to this row."""
        load, _ = scaled.contact.moes_parameters
        clearance = scaled.smooth_film / scaled.roughness if scaled.roughness > 0.0 else math.inf
        pairs = ((self.clearance, clearance), (self.load, load))
        return all(low <= value <= high for (low, high), value in pairs)


REGIMES = (
    Regime(
        "smooth",
        (("multigrid", "none"), ("hybrid", "film"), ("direct", "film"), ("direct", "dry")),
        clearance=(1e3, math.inf),
    ),
    Regime("light film", (("direct", "film"), ("direct", "dry")), clearance=(1.0, math.inf), load=(0.0, 50.0)),
    Regime("light mixed", (("direct", "dry"), ("direct", "film")), load=(0.0, 30.0)),
    Regime("boundary", (("hybrid", "dry"), ("direct", "dry"), ("hybrid", "nested")), clearance=(0.0, 0.03)),
    Regime("film", (("hybrid", "nested"), ("hybrid", "film"), ("direct", "film")), clearance=(3.0, math.inf)),
    Regime("mixed", (("hybrid", "nested"), ("direct", "nested"), ("direct", "dry"), ("direct", "film"))),
)


def solve_film(
    now: Instant,
    grid: Grid,
    settings: Settings,
    start: FilmState | None = None,
    follows: tuple[float, int] | None = None,
) -> FilmSolution:
    """Solve one instant on a grid.

    start: a solution nearby, or None. follows: time [s] since `start` and the nodes by which the rough surfaces have
    moved along +x since then, or None for a steady film. Entrainment along -x is solved in the mirror. A film that
    cannot be had is replaced by the dry contact, which says so (`route`); raises ConvergenceError if that has no
    solution, or no meaning because the film clears the roughness.
    """
    if now.entrainment_speed < 0.0:
        back = follows and (follows[0], -follows[1])
        return solve_film(now.mirrored(), grid.mirrored(), settings, start and start.mirrored(), back).mirrored()
    scaled = Scaled(now, grid, settings)
    if now.dry or now.entrainment_speed == 0.0:
        return scaled.dry("dry")
    regime = next(row for row in REGIMES if row.holds(scaled))
    best: Solution | None = None
    used, spent = "", 0
    for name, algorithm in _algorithms(scaled, regime, start, follows):
        found = algorithm()
        spent += found.iterations
        if _usable(found) and (best is None or found.converged or found.change < best.change):
            best, used = found, name
        if found.converged:
            break
    if best is not None:
        return scaled.solution(replace(best, iterations=spent), "mixed", f"{regime.name}: {used}")
    if scaled.smooth_film > _FULL_FILM * scaled.roughness:  # no dry contact can stand in for that
        width, depth = (n * grid.spacing for n in reversed(grid.shape))
        raise ConvergenceError(
            f"No solution was found for an oil film of about {scaled.smooth_film:.2g} m on a grid of {width:.3g} m by "
            f"{depth:.3g} m. Lower speed or viscosity, or enlarge the domain (film.domain) for a film that thick."
        )
    why = "no mixed solution was found; the dry contact stands in"
    return replace(scaled.dry("fallback"), converged=False, shortfall=why, iterations=spent)


def _algorithms(
    scaled: Scaled, regime: Regime, start: FilmState | None, follows: tuple[float, int] | None
) -> list[tuple[str, Callable[[], Solution]]]:
    """What is tried, in turn."""
    settings = scaled.settings
    begins: dict[str, Callable[[], Iterate]] = {"dry": scaled.dry_start, "film": scaled.lifted_start}
    if start is not None and follows is None:
        begins["nested"] = lambda: scaled.iterate(start)
    elif min(scaled.grid.shape) >= _NESTED_FROM:
        begins["nested"] = lambda: scaled.iterate(_nested(scaled))
    problem = scaled.problem()
    tried: list[tuple[str, Callable[[], Solution]]] = []
    if start is not None and follows is not None:
        step, moved = follows
        problem = scaled.problem(start.mass / scaled.h_unit, scaled.per_dt(step))
        begins = {"dry": scaled.dry_start, "film": scaled.lifted_start} | {
            "before": lambda: advected(scaled.iterate(start), scaled.smooth, moved)
        }

    def hybrid(begin: str) -> Solution:
        most = settings.iterations if problem.per_dt > 0.0 else min(settings.iterations, _HYBRID_ITERATIONS)
        return solve_mixed(scaled.half_space, problem, begins[begin](), settings.tolerance, most)

    def direct(begin: str) -> Solution:
        most = min(settings.iterations, _DIRECT_ITERATIONS)
        return solve_direct(scaled.half_space, problem, begins[begin](), settings.tolerance, most)

    def multigrid(_: str) -> Solution:
        film = scaled.smooth_film / scaled.h_unit
        return solve_smooth(problem, scaled.x, scaled.y, settings.fft, film, settings.tolerance, _CYCLES)[0]

    methods = {"hybrid": hybrid, "direct": direct, "multigrid": multigrid}
    if "before" in begins:
        tried.append(("marched", lambda: hybrid("before")))
    for method, begin in regime.algorithms:
        if (begin in begins) or (method == "multigrid" and problem.per_dt == 0.0 and is_applicable(problem)):
            tried.append((f"{method} from {begin}", lambda method=method, begin=begin: methods[method](begin)))
    return tried


def coarser(now: Instant, grid: Grid) -> tuple[Instant, Grid]:
    """The same instant on a grid of half the nodes."""
    instant = replace(now, heights=restrict(now.heights), limit=restrict(now.limit))
    return instant, Grid(restrict(grid.x), restrict(grid.y))


def prolonged(state: FilmState, shape: tuple[int, int]) -> FilmState:
    """A film state of the coarser grid on one of `shape` nodes [ny, nx]."""
    pressure, fluid, mass = (prolong(field, shape) for field in (state.pressure, state.fluid, state.mass))
    solid = prolong(state.solid.astype(np.float64), shape) > 0.5
    return FilmState(pressure, fluid, solid, mass, state.rigid_gap)


def _nested(scaled: Scaled) -> FilmState:
    now, grid = coarser(scaled.now, scaled.grid)
    return prolonged(solve_film(now, grid, scaled.settings).state, scaled.grid.shape)


def _usable(solution: Solution) -> bool:
    """Whether a film short of its tolerance is still better than the dry contact."""
    finite = np.isfinite(solution.change) and np.isfinite(solution.iterate.rigid)
    settled = solution.change < _CHANGE_ACCEPTED and solution.intrusion < _INTRUSION_ACCEPTED
    return bool(finite and settled and abs(solution.load_error) < _LOAD_ACCEPTED)
