"""Choice of the algorithm for a contact: a table, and its execution.

A steady film belongs to the first row of REGIMES that it fits; the algorithms of that row are tried in turn until one
satisfies the stopping rule (`kernels.mixed.stopping_rule`). An instant that follows from another one starts from it,
and the film found is used if it is usable at all, unless the step is thorough.
"""

import math
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from ..errors import ConvergenceError, FilmTooWideError
from ..kernels.arrays import Array
from ..kernels.dry import dry_solution
from ..kernels.grids import prolong, restrict
from ..kernels.mixed.advection import advected
from ..kernels.mixed.asperities import REACH
from ..kernels.mixed.fixed_point import solve_mixed
from ..kernels.mixed.held import solve_held
from ..kernels.mixed.marched import solve_marched
from ..kernels.mixed.newton import solve_newton
from ..kernels.mixed.problem import Iterate, Solution
from ..kernels.mixed.stopping_rule import excess
from ..kernels.multigrid.cycle import is_applicable, solve_smooth
from ..progress import ALGORITHM, tell
from .instant import FilmSolution, FilmState, Grid, Instant, Settings, Step
from .lengths import inlet_length
from .scaled import Scaled
from .slow_film import slow_film
from .solutions import LOAD_ACCEPTED, dry, load_balance, solution
from .starts import dry_start, lifted_start, shared_start

_ALL = (0.0, math.inf)
_SEVERAL = (2, math.inf)
_LASTING = 4 * (("hybrid", "last"),)  # lines couple contacts over long distances: they converge slowly
_FULL_FILM = 3.0  # formula film over rms roughness, above which a dry contact is no substitute
_MOST_BEYOND = 0.3  # share of the load that may lie beyond the grid
_NESTED_FROM = 65  # nodes along an axis, from which on a film starts on the grid of half of them
_HYBRID_ITERATIONS, _MARCHED_ITERATIONS = 150, 2000  # of one try at a steady film
_HELD_ITERATIONS = 400  # of one round
_CYCLES = {True: 25, False: 15}  # of multigrid, by `Problem.fitted`
_NEWTON_STEPS = 30
_WORN_TOLERANCE, _WORN_ITERATIONS = 1e-4, 1000  # of the pressure that wears a body at rest
_DAMPED = ((0.5, 15), (0.25, 40))  # multigrid's next tries, and cycles: nearly rigid bodies under thickening oil
# film of smooth bodies over rms roughness of a line, from which on Newton's method is more reliable: without side
# flow, a residual of the hybrid in the inlet stays in the film
_CLEAR_LINE = 1.5
_RESOLVED_INLET = 2.0  # nodes: on an inlet that the grid does not resolve that method is slow and finds no film
_EXCESS = 10.0  # of the stopping rule's limits, that a thorough step over roughness may have
_CLOSINGS = 4  # solutions of a light film, at most, until the pressure beyond the grid fits the bodies' gap
# a film that has not converged is still better than the dry contact within these
_CHANGE_ACCEPTED = 0.1
_COMPLEMENTARITY_ACCEPTED = 20.0


@dataclass(frozen=True)
class Regime:
    """A row of the table: conditions on a contact, and its algorithms as (method, start), in turn."""

    name: str
    algorithms: tuple[tuple[str, str], ...]
    floors: tuple[float, float] = _ALL  # formula film of smooth bodies / floor
    clearance: tuple[float, float] = _ALL  # formula film of smooth bodies / rms roughness (smooth: infinite)
    load: tuple[float, float] = _ALL  # Moes' M, as `Scaled.moes_load`
    rows: tuple[float, float] | None = None  # of a periodic grid; None: any grid
    by_flux: tuple[tuple[str, str], ...] = ()  # algorithms for cavities that conserve mass or a meniscus, if not those
    ends: bool = False  # for lines with ends only

    def holds(self, scaled: Scaled) -> bool:
        """Return True if a contact belongs to this row."""
        load, film = scaled.moes_load, scaled.film
        clearance = film / scaled.roughness if scaled.roughness > 0.0 else math.inf
        if self.rows is not None and not scaled.grid.periodic:
            return False
        if self.ends and not scaled.now.shape.ends:
            return False
        rows = (self.rows or _ALL, scaled.grid.shape[0])
        pairs = ((self.floors, film / scaled.settings.floor), (self.clearance, clearance), (self.load, load), rows)
        return all(low <= value <= high for (low, high), value in pairs)


REGIMES = (
    Regime("dry", (("hybrid", "dry"),), floors=(0.0, 0.5)),
    Regime(
        "line",
        (
            ("newton", "nested"),
            ("newton", "film"),
            ("newton", "dry"),
            ("newton", "last"),
            ("hybrid", "shared"),
        ),
        rows=(1, 1),
    ),
    Regime(
        "clear line",
        (("hybrid", "smooth"), ("newton", "film"), ("hybrid", "shared"), ("hybrid", "last")),
        clearance=(1.5, math.inf),
        rows=_SEVERAL,
    ),
    Regime(
        "light line",
        (("newton", "film"), ("hybrid", "dry")),
        clearance=(0.03, math.inf),
        load=(0.0, 50.0),
        rows=_SEVERAL,
    ),
    Regime(
        "rough line",
        (("hybrid", "dry"), ("hybrid", "shared"), *_LASTING),
        clearance=(0.03, 0.2),
        load=(0.0, 2000.0),
        rows=_SEVERAL,
    ),
    Regime(
        "moderate line",
        (("hybrid", "shared"), ("newton", "film"), ("hybrid", "smooth"), ("newton", "last"), *_LASTING),
        clearance=(0.03, math.inf),
        load=(0.0, 600.0),
        rows=_SEVERAL,
    ),
    Regime(
        "mixed line",
        (("hybrid", "shared"), ("hybrid", "smooth"), *_LASTING),
        clearance=(0.03, math.inf),
        rows=_SEVERAL,
    ),
    Regime(
        "roller",
        (
            ("multigrid", "none"),
            ("multigrid", "none, damped"),
            ("hybrid", "film"),
            ("hybrid", "nested"),
            ("hybrid", "last"),
        ),
        clearance=(1e3, math.inf),
        ends=True,
    ),
    Regime(
        "smooth",
        (("multigrid", "none"), ("hybrid", "film"), ("multigrid", "none, damped"), ("newton", "film")),
        clearance=(1e3, math.inf),
        by_flux=(("hybrid", "flooded"), ("hybrid", "nested"), ("hybrid", "last"), ("newton", "film")),
    ),
    Regime(
        "light",
        (("newton", "film"), ("newton", "dry"), ("hybrid", "last")),
        load=(0.0, 50.0),
        by_flux=(("hybrid", "flooded"), ("newton", "film"), ("newton", "dry"), ("hybrid", "last")),
    ),
    Regime("boundary", (("hybrid", "dry"),), clearance=(0.0, 0.03)),
    Regime("thick film", (("hybrid", "nested"), ("newton", "film")), clearance=(1.5, math.inf), load=(0.0, 300.0)),
    Regime("film", (("hybrid", "nested"),), clearance=(1.5, math.inf)),
    Regime("moderate", (("hybrid", "shared"), ("newton", "film")), load=(0.0, 300.0)),
    Regime("mixed", (("hybrid", "shared"), ("hybrid", "nested"))),
)


def solve_film(
    now: Instant,
    grid: Grid,
    settings: Settings,
    start: FilmState | None = None,
    step: Step | None = None,
) -> FilmSolution:
    """Solve one instant on a grid.

    Entrainment along -x is solved in the mirror. Without entrainment there is only a film that was there before and is
    squeezed out. A converged solution carries the load. If no film is found, the dry contact replaces it (`route`).

    Parameters
    ----------
    now
        The instant.
    grid
        Its nodes.
    settings
        Accuracy and algorithms.
    start
        A solution nearby, or None.
    step
        Time step from `start`, or None for a steady film.

    Raises
    ------
    ConvergenceError
        If the dry contact has no solution, or is no substitute as the film is thicker than the roughness.

    """
    if now.entrainment_speed < 0.0:
        back = start and start.mirrored(), step and step.mirrored()
        return solve_film(now.mirrored(), grid.mirrored(), settings, *back).mirrored()
    if now.dry or (now.entrainment_speed == 0.0 and not (start and step)):
        return dry(Scaled(now, grid, settings), "dry", now.solid_share)
    step = step if start else None
    at_rest = now.entrainment_speed == 0.0
    closing, pull = float(at_rest), now.entrainment_speed * grid.spacing  # at rest its size does not matter
    apart: float | None = None
    slow = slow_film(now, grid, step.shifted, settings, solve_film) if step and (step.rolled or step.shifted) else None
    for _ in range(_CLOSINGS):
        scaled = Scaled(now, grid, settings, start, step, closing, apart, slow)
        found, last, settled = _film(scaled, start, step), closing, True
        if start and step and step.thorough and scaled.is_light and not at_rest:
            closing = (start.rigid_gap - found.state.rigid_gap) / step.dt
            settled = abs(closing - last) * now.shape.radius_x < 0.1 * pull
        balance = load_balance(scaled, found)
        if not balance.holds and balance.apart is not None and found.route == "mixed":
            apart, settled = balance.apart, False  # roughness holds the bodies apart, or they are flattened
        if settled:
            break
    if balance.holds or not found.converged:
        return found
    why = f"load error {balance.error:.2g}, with what lies beyond the grid"
    return replace(found, converged=False, shortfall=why, load_error=balance.error)


def conformed(now: Instant, grid: Grid, settings: Settings, fluid: Array, load: float, soft: Array) -> Array:
    """Return the pressure [Pa] of solids that carry `load` [N] in dry contact, beside that of the oil [Pa].

    Each node gives way by `soft` [m/Pa] times its solid pressure, on top of the half space. The last column, which
    repeats the first one of the patches, carries none.
    """
    scaled = Scaled(replace(now, dry=True), grid, settings)
    oil = fluid / scaled.p_unit
    room = np.maximum(scaled.cap - oil, 0.0)
    room[:, -1] = 0.0
    gap = scaled.undeformed + scaled.half_space.deform(oil)
    limits = load / now.load * scaled.load, scaled.smooth, _WORN_TOLERANCE, _WORN_ITERATIONS
    found = dry_solution(scaled.half_space, gap, room, *limits, soft * (scaled.p_unit / scaled.h_unit))
    return found.pressure * scaled.p_unit


def _film(scaled: Scaled, start: FilmState | None, step: Step | None) -> FilmSolution:
    """Return the film of an instant, entrained along +x or not at all."""
    grid, settings = scaled.grid, scaled.settings
    regime = next(row for row in REGIMES if row.holds(scaled))
    by_flux = scaled.now.conserving or scaled.first > 0
    algorithms = regime.by_flux if by_flux and regime.by_flux else regime.algorithms
    by_march = (settings.fitted or scaled.fade > 0.0) and not step
    if by_march and any(method == "hybrid" for method, _ in algorithms):  # where solids carry much
        algorithms = (*algorithms, ("marched", "last"))
    if settings.patient and not step:
        algorithms = (*algorithms, ("held", "last"))
    tries = (*_first_tries(scaled, step), *algorithms) if step else algorithms
    solver, used, spent, least = _Solver(scaled, start, step), "", 0, (True, True, math.inf)
    apart = _stays_apart(scaled, start, step)
    for number, (method, begin) in enumerate(tries, 1):
        tell(ALGORITHM, number, len(tries))
        if settings.lumped and method != "hybrid":  # the other methods have the split criterion only
            continue
        found = solver.run(method, begin)
        if found is None:
            continue
        spent += found.iterations
        worst = excess(found, settings.tolerance, solver.problem)
        touches = apart and bool(found.iterate.solid.any())
        rank = touches, not found.converged, worst
        if _usable(found) and rank < least:
            solver.best, used, least = found, f"{regime.name}: {method} from {begin}", rank
        if touches:
            continue
        if found.converged or (step and solver.best is found and worst < _accepted_excess(scaled, step)):
            break
    best = solver.best
    if best is not None and 1.0 - float(best.iterate.pressure.sum()) / scaled.load < _MOST_BEYOND:
        return solution(scaled, replace(best, iterations=spent), "mixed", used)
    if scaled.film > _FULL_FILM * scaled.roughness:  # the dry contact is no substitute
        width, depth = (n * grid.spacing for n in reversed(grid.shape))
        raise (FilmTooWideError if scaled.is_light else ConvergenceError)(
            f"No solution was found for an oil film of about {scaled.film:.2g} m on a grid of {width:.3g} m by "
            f"{depth:.3g} m. Lower speed or viscosity, or enlarge the domain (film.domain) for a film that thick."
        )
    why = "no mixed solution was found; the dry contact replaces it"
    return replace(dry(scaled, "fallback"), converged=False, shortfall=why, iterations=spent)


def _stays_apart(scaled: Scaled, start: FilmState | None, step: Step | None) -> bool:
    """Return True if bodies that an oil film separates stay apart in the next instant.

    A solution in which they touch is then accepted only as a last resort.
    """
    if start is None or step is None or not step.thorough or start.solid.any():
        return False
    return scaled.film > _FULL_FILM * max(scaled.roughness, scaled.settings.floor)


def _first_tries(scaled: Scaled, step: Step) -> tuple[tuple[str, str], ...]:
    """Return the algorithms that a time step tries before its row of the table."""
    hybrid, newton = (("hybrid", "before"),), (("newton", "before"),)
    inlet = inlet_length(scaled.a, scaled.now.shape, scaled.film) / scaled.grid.spacing
    clear_line = scaled.grid.periodic and scaled.film > _CLEAR_LINE * scaled.roughness and inlet > _RESOLVED_INLET
    if not step.thorough and not clear_line:
        return hybrid
    return (*newton, *hybrid) if scaled.is_light or clear_line else (*hybrid, *newton)


def _accepted_excess(scaled: Scaled, step: Step) -> float:
    """Return the accepted excess of a time step over the limits of the stopping rule: the next step corrects it."""
    if not step.thorough:
        return math.inf
    return _EXCESS if scaled.roughness > 0.0 else 0.0


class _Solver:
    """Algorithms and starts of the table, for one instant."""

    def __init__(self, scaled: Scaled, start: FilmState | None, step: Step | None) -> None:
        self.scaled, self.state, self.step = scaled, start, step
        self.best: Solution | None = None
        self.problem = scaled.problem()
        self.quick = replace(scaled.settings, patient=False)  # of starts, which need not be found

    def run(self, method: str, begin: str) -> Solution | None:
        """Return the solution of a method from a start; None where they do not apply."""
        scaled, settings, steady = self.scaled, self.scaled.settings, self.step is None
        if method == "multigrid":
            reach = self.problem.floor + REACH * self.problem.depth  # of asperities, which this method ignores
            film, layered = scaled.smooth_film / scaled.h_unit, self.problem.depth > 0.0
            if scaled.give is not None or not (steady and is_applicable(self.problem)) or (layered and film < reach):
                return None
            shape = scaled.depth, scaled.curvature
            given = (self.problem, scaled.x, scaled.y, settings.fft, film)
            tries = ((1.0, _CYCLES[self.problem.fitted]),) if begin == "none" else _DAMPED
            for part, cycles in tries:
                found = solve_smooth(*given, settings.tolerance, cycles, *shape, part)[0]
                if found.converged:
                    break
            return None if layered and found.gap.min() < reach else found
        start = self._start(begin)
        if method == "held":
            if self.problem.by_flux or self.problem.depth > 0.0:
                return None
            start = dry_start(scaled) if start is None else start
        if start is None:
            return None
        solve, most = {
            "hybrid": (solve_mixed, _HYBRID_ITERATIONS if steady else settings.iterations),
            "marched": (solve_marched, _MARCHED_ITERATIONS),
            "newton": (solve_newton, _NEWTON_STEPS),
            "held": (solve_held, _HELD_ITERATIONS),
        }[method]
        limits = settings.tolerance, min(most, settings.iterations)
        return scaled.images.removed(solve(scaled.surfaces, self.problem, scaled.images.iterate(start), *limits))

    def _start(self, name: str) -> Iterate | None:
        scaled, state = self.scaled, self.state
        if name == "before" and state is not None and self.step is not None:
            return advected(scaled.iterate(state), scaled.smooth, self.step.moved)
        if name == "nested" and self.step is None:
            if state is None and _is_nested(scaled.grid):
                now, grid = coarser(scaled.now, scaled.grid)
                with suppress(ConvergenceError):
                    state = prolonged(solve_film(now, grid, self.quick).state, scaled.grid.shape)
            return dry_start(scaled) if state is None else scaled.iterate(state)
        if name == "flooded" and self.problem.supply is None and self.problem.first == 0:
            now = replace(scaled.now, conserving=False, meniscus=None)
            return scaled.iterate(solve_film(now, scaled.grid, self.quick, state, self.step).state)
        if name == "smooth" and scaled.grid.periodic:
            return self._above_smooth()
        if name == "last" and self.best is not None:
            return self.best.iterate
        starts = {"dry": dry_start, "shared": shared_start, "film": lifted_start}
        return starts[name](scaled) if name in starts else None

    def _above_smooth(self) -> Iterate | None:
        """Return the film of smooth bodies, which is one row, in every row of rough ones."""
        scaled, now = self.scaled, self.scaled.now
        ny, nx = scaled.grid.shape
        ease, thinned = (None if field is None else field.mean(axis=0)[None] for field in (now.ease, now.thinned))
        limit = now.limit.max(axis=0)[None]
        row = replace(now, heights=np.zeros((1, nx)), limit=limit, ease=ease, thinned=thinned, give=None)
        grid = replace(scaled.grid, y=np.zeros(1), repeats=scaled.grid.repeats * ny)
        try:
            state = solve_film(row, grid, self.quick).state
        except ConvergenceError:
            return None
        pressure, fluid, mass = (np.tile(field, (ny, 1)) for field in (state.pressure, state.fluid, state.mass))
        return scaled.iterate(FilmState(pressure, fluid, np.zeros((ny, nx), np.bool_), mass, state.rigid_gap))


def coarser(now: Instant, grid: Grid) -> tuple[Instant, Grid]:
    """Return the same instant on a grid of half the nodes."""
    alone = grid.periodic and grid.shape[0] == 1  # such a row represents twice as much of a line
    repeats = 0.5 * grid.repeats if alone else grid.repeats
    return now.mapped(restrict), replace(grid, x=restrict(grid.x), y=restrict(grid.y), repeats=repeats)


def _is_nested(grid: Grid) -> bool:
    """Return True if a film on the grid starts from that on half its nodes."""
    ny, nx = grid.shape
    if grid.periodic and ny % 2:  # only a single row has half its period
        return ny == 1 and nx >= _NESTED_FROM
    return min(ny, nx) >= _NESTED_FROM


def prolonged(state: FilmState, shape: tuple[int, int]) -> FilmState:
    """Return a film state of the coarser grid on one of `shape` nodes [ny, nx]."""
    pressure, fluid, mass = (prolong(field, shape) for field in (state.pressure, state.fluid, state.mass))
    solid = prolong(state.solid.astype(np.float64), shape) > 0.5
    ease, thinned = (field if field.size == 1 else prolong(field, shape) for field in (state.ease, state.thinned))
    return FilmState(pressure, fluid, solid, mass, state.rigid_gap, ease, thinned)


def _usable(solution: Solution) -> bool:
    """Return True if a film that has not converged is still better than the dry contact."""
    finite = np.isfinite(solution.pressure_change) and np.isfinite(solution.iterate.rigid)
    settled = solution.pressure_change < _CHANGE_ACCEPTED and solution.complementarity < _COMPLEMENTARITY_ACCEPTED
    return bool(finite and settled and abs(solution.load_error) < LOAD_ACCEPTED)
