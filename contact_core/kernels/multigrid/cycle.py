"""Smooth, fully flooded films by full multigrid: nested grids, each solved by cycles over all coarser ones.

Every grid level relaxes the pressure by lines (`relaxation`); the coarsest solves pressure and rigid gap together by
Newton's method (`coarsest`), so that the load needs no loop of its own. Coarse grid levels solve for the full unknowns;
their right sides hold the corrections from the finer one (full approximation scheme).

Sources: Brandt & Lubrecht, J. Comput. Phys. 90 (1990) 348, doi:10.1016/0021-9991(90)90171-V; Venner & Lubrecht,
Multilevel Methods in Lubrication, Elsevier 2000.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..far_field import far_field
from ..mixed.problem import Iterate, Problem, Solution
from ..mixed.stopping_rule import STEADY_IMBALANCE_PER_TOLERANCE, shortfall
from . import transfer
from .level import Level

_COARSEST = 9  # nodes along an axis, at least
_DENSE = 400  # unknowns that Newton's method is given at most
_START = 2  # grid level of the first guess: coarser ones do not resolve a thin film
_DOWN, _UP = 2, 1  # sweeps before and after the coarse correction
# visits of the coarser level by a cycle from above the starting level, by `Problem.fitted`: W there, V below. More
# visits solve corrections better than they fit a fitted flow, and diverge
_VISITS = {True: 1, False: 2}
_NESTED_CHANGE, _NESTED_CYCLES = 1e-2, 6  # where the grid levels below the finest stop
_LOST = 10.0  # change of a cycle, in loads, after which a solution is lost
_DAMPING_PARTS = (1.0, 0.75, 0.5)  # one after the other where a solution is lost
_SYMMETRY = 1e-9


@dataclass(frozen=True)
class LevelFilm:
    """Result of a grid level of the nested start."""

    spacing: float
    central: float  # gap at x = y = 0
    least: float  # smallest gap
    change: float  # of the pressure by its last cycle, relative


@dataclass(frozen=True)
class _Progress:
    """State of the cycles on a grid level."""

    cycles: int
    change: float  # of the pressure by the last cycle, relative
    load_error: float  # relative
    imbalance: float  # as in `reynolds.imbalance`

    def shortfall(self, tolerance: float) -> str:
        """Return which parts of the stopping rule do not hold."""
        return shortfall(tolerance, self.change, self.load_error, 0.0, self.imbalance, STEADY_IMBALANCE_PER_TOLERANCE)


class _Multigrid:
    """Grid levels from the coarsest to the finest, and the damping of their changes."""

    def __init__(
        self, levels: list[Level], load: float, depth: float, damping: tuple[float, float], visits: int
    ) -> None:
        self.levels, self.load, self.depth, self.damping, self.visits = levels, load, depth, damping, visits
        self._found: tuple[Array, float] | None = None  # pressure and rigid gap of the last level but one

    def nested(self, film: float, tolerance: float, cycles: int) -> tuple[_Progress, list[LevelFilm]]:
        """Solve from the first guess to the finest grid level; return the film of each."""
        films: list[LevelFilm] = []
        last = len(self.levels) - 1
        for k in range(min(_START, last), last + 1):
            if films and films[-1].change < _LOST:
                self._refine(k)
            else:  # at the start, and where a film is beyond the level before
                self._guess(k, film)
            limits = (tolerance, cycles, True) if k == last else (_NESTED_CHANGE, _NESTED_CYCLES, False)
            progress = self._iterate(k, *limits)
            films.append(LevelFilm(self.levels[k].dx, *self.levels[k].film_thickness(), progress.change))
        return progress, films

    def _guess(self, k: int, film: float) -> None:
        """Set a Hertz-like pressure under a film on grid level k."""
        level = self.levels[k]
        self._found = None
        level.state_problem(self.load)
        level.p[:] = np.sqrt(np.maximum(1.0 - 2.0 * level.undeformed, 0.0))
        level.p *= self.load / max(level.load(), 1e-300)
        level.rigid = film - self.depth
        level.set_edges()

    def _refine(self, k: int) -> None:
        """Start grid level k from level k - 1, extrapolated with the result of level k - 2."""
        fine, coarse = self.levels[k], self.levels[k - 1]
        before, self._found = self._found, (coarse.p.copy(), coarse.rigid)
        if before is not None:
            pressure, rigid = before
            transfer.interpolate_cubic(pressure, coarse.mirror, coarse.work)
            transfer.extrapolate(coarse.work, coarse.p)
            coarse.rigid += 0.25 * (coarse.rigid - rigid)
        fine.state_problem(self.load)
        transfer.interpolate_cubic(coarse.p, coarse.mirror, fine.p)
        fine.rigid = coarse.rigid
        fine.set_edges()

    def _iterate(self, k: int, tolerance: float, cycles: int, strictly: bool) -> _Progress:
        """Run cycles on grid level k until the pressure changes by less than `tolerance`.

        `strictly`: until the whole stopping rule holds.
        """
        level = self.levels[k]
        level.film()
        progress = _Progress(0, np.inf, np.inf, np.inf)
        for n in range(1, cycles + 1):
            start = level.p.copy()
            self._cycle(k)
            level.film()
            change = float(transfer.distance(level.weight, level.p, start)) * level.dx**2 / self.load
            progress = _Progress(n, change, level.load() / self.load - 1.0, level.defect())
            if not change < _LOST or (progress.shortfall(tolerance) == "" if strictly else change < tolerance):
                break
        return progress

    def _cycle(self, k: int) -> None:
        """Improve grid level k by one cycle.

        Its film must be up to date before, and is not afterwards.
        """
        level = self.levels[k]
        if k == 0:
            level.newton()
            return
        for _ in range(_DOWN):
            level.relax(*self.damping)
            level.film()
        coarse = self.levels[k - 1]
        coarse.restrict(level)
        for visit in range(self.visits if k > _START else 1):
            if visit > 0:
                coarse.film()
            self._cycle(k - 1)
        level.correct(coarse)
        for _ in range(_UP):
            level.film()
            level.relax(*self.damping)


def is_symmetric(problem: Problem) -> bool:
    """Return True if one half of the contact is the image of the other."""
    oil = (problem.mobility, problem.thinned)
    fields = (problem.undeformed, problem.edge, problem.weight, *oil)
    return fields[0].shape[0] % 2 == 1 and all(
        float(np.abs(f - f[::-1]).max()) <= _SYMMETRY * float(np.abs(f).max()) for f in fields
    )


def is_applicable(problem: Problem) -> bool:
    """Return True if multigrid can solve the problem.

    The film is steady, full where it has no pressure and not periodic, and its grid can be halved often enough.
    """
    (ny, nx), mirror = problem.undeformed.shape, is_symmetric(problem)
    halvings = _level_count(ny, nx, mirror) - 1
    unknowns = (ny >> halvings) * (nx >> halvings) / (2 if mirror else 1)
    plain = not (problem.per_dt > 0.0 or problem.by_flux or problem.wrapped)
    return plain and halvings >= 2 and unknowns <= _DENSE


def _level_count(ny: int, nx: int, mirror: bool) -> int:
    """Return the number of grid levels, the finest included. `mirror`: the middle row stays a row."""
    count, y, x = 1, ny - 1, nx - 1
    while y % (4 if mirror else 2) == 0 and x % 2 == 0 and min(x, y) // 2 >= _COARSEST - 1:
        count, y, x = count + 1, y // 2, x // 2
    return count


def _damping(problem: Problem, film: float) -> tuple[float, float]:
    """Return the damping of the single and the spread changes of `relaxation`.

    Light loads, which couple little, need less.
    """
    depth = 0.42 * problem.compliance / film
    thickening = float(np.log(problem.fluidity[0] / problem.fluidity[1])) / problem.step
    return float(np.clip(1.0 - 0.15 * depth - 0.2 * thickening, 0.4, 0.95)), 0.4


def _levels(problem: Problem, x: Array, y: Array, library: str, film: float, curvature: float) -> list[Level]:
    mirror, far = is_symmetric(problem), bool(problem.edge.any())
    surface = problem.undeformed - problem.undeformed.min()
    levels: list[Level] = []
    for k in range(_level_count(y.size, x.size, mirror)):
        xk, yk = x[:: 2**k], y[:: 2**k]
        level = Level(problem, xk, yk, mirror, library)
        edge, weight = problem.edge, problem.weight
        if k > 0:
            shape = (yk.size, xk.size)
            edge, weight = far_field(xk, yk, film, curvature) if far else (np.zeros(shape), np.ones(shape))
        every = np.s_[:: 2**k, :: 2**k]
        level.set_bodies(surface[every], edge, weight)
        level.set_oil(problem.mobility[every], problem.thinned[every])
        levels.insert(0, level)
    return levels


def solve_smooth(
    problem: Problem,
    x: Array,
    y: Array,
    library: str,
    film: float,
    tolerance: float,
    cycles: int,
    depth: float | None = None,
    curvature: float = 1.0,
    damping: float = 1.0,
) -> tuple[Solution, list[LevelFilm]]:
    """Return the steady film of smooth bodies on the nodes x [nx], y [ny], without a start.

    `film`: central film by a formula, for the first guess and the far field that `problem.edge` was made for; `depth`:
    approach of the dry bodies, for the same guess, that of a ball if not given; `curvature`: of the gap along y over
    that along x, for the same far field; `damping`: of all changes, beside the usual one. Ends after `cycles` on the
    finest grid, or when one of them changes the pressure by less than `tolerance` and load and mass balance are met.
    Floor and cap are not imposed: a film that violates them is not converged. The result is finite, or its change
    is infinite. The second result has the films of the grid levels, from coarse to fine.
    ValueError if not `is_applicable`.
    """
    if not is_applicable(problem):
        raise ValueError("multigrid needs a steady problem, full cavities and a grid of m 2^k + 1 nodes, m small")
    levels = _levels(problem, x, y, library, film, curvature)
    depth = problem.compliance ** (2.0 / 3.0) if depth is None else depth  # a^2 / R
    found, films = _failure(problem), list[LevelFilm]()
    single, spread = (damping * part for part in _damping(problem, film))
    load, visits = problem.load * problem.spacing**2, _VISITS[problem.fitted]
    for part in _DAMPING_PARTS:
        solver = _Multigrid(levels, load, depth, (part * single, spread), visits)
        progress, films = solver.nested(film, tolerance, cycles)
        found = _solution(problem, levels[-1], progress, tolerance)
        if progress.change < _LOST:
            break
    return found, [level for level in films if level.change < _LOST]


def extrapolated(films: list[LevelFilm]) -> tuple[float, float]:
    """Return central and smallest gap of an infinitely fine grid (Richardson).

    From the two finest grid levels; the error falls with the square of the spacing.
    """
    coarse, fine = films[-2:]
    return fine.central + (fine.central - coarse.central) / 3.0, fine.least + (fine.least - coarse.least) / 3.0


def _solution(problem: Problem, level: Level, progress: _Progress, tolerance: float) -> Solution:
    p, h, mass = (level.whole(field) for field in (level.p, level.h, level.mass))
    if not (progress.change < _LOST and np.isfinite(h).all() and np.isfinite(mass).all()):
        return _failure(problem)
    missing = progress.shortfall(tolerance)
    if not missing and (h < problem.floor).any():
        missing = "the film is below the floor"
    if not missing and (p > problem.cap).any():
        missing = "the pressure is above the cap"
    return Solution(
        iterate=Iterate(p, p.copy(), np.zeros(p.shape, np.bool_), level.rigid - float(problem.undeformed.min())),
        gap=h,
        mass=mass,
        converged=not missing,
        iterations=progress.cycles,
        pressure_change=progress.change,
        load_error=progress.load_error,
        complementarity=0.0,
        imbalance=progress.imbalance,
        shortfall=missing,
    )


def _failure(problem: Problem) -> Solution:
    zero = np.zeros_like(problem.undeformed)
    return Solution(
        iterate=Iterate(zero, zero.copy(), np.zeros(zero.shape, np.bool_), 0.0),
        gap=zero.copy(),
        mass=zero.copy(),
        converged=False,
        iterations=0,
        pressure_change=np.inf,
        load_error=np.inf,
        complementarity=0.0,
        imbalance=np.inf,
        shortfall="diverged",
    )
