"""Deterministic mixed lubrication: fluid and solid pressure node by node, from full film to dry contact."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..errors import ConvergenceError
from ..kernels.mixed import Iterate, Solution, advected, solve_mixed
from ..quantities import parameter
from .scaled import FilmSolution, FilmState, Instant, Scaled

Array = NDArray[np.float64]

_DIRECT = 60  # iterations a steady film gets before it is marched in time
_MARCH_NODES = 3.0  # nodes by which the oil moves in such a time step
_MARCH_ITERATIONS = 10
_MARCH_IMBALANCE = 0.02  # share of its mass that a steady film may still gain or lose in a / u_e
_MARCH_CALM = 3  # time steps that must agree
# a mixed solution short of its tolerance is still better than the dry one within these
_LOAD_ACCEPTED = 1e-3
_CHANGE_ACCEPTED = 0.1
_INTRUSION_ACCEPTED = 20.0


@dataclass(frozen=True)
class Deterministic:
    """Reynolds' equation for the fluid on every node, solids where the gap is at its floor, 0 <= p <= hardness.

    The half space deforms under the sum of both pressures. The boundary pressure is zero at the edge of the grid.
    """

    name: ClassVar[str] = "deterministic"
    source: ClassVar[str] = (
        "Azam et al. 2019, doi:10.1016/j.triboint.2018.11.011; the split of fluid and solid pressure is ours"
    )

    points: int = parameter("", "grid nodes along x and along y", least=17, most=4097, shapes_arrays=True)
    domain: float = parameter(
        "m", "side of the square grid, centred on the contact", above=0.0, most=1.0, shapes_arrays=True
    )
    floor: float = parameter(
        "m", "gap at which solids touch: thickness of the adsorbed boundary layer", above=1e-11, most=1e-7
    )
    tolerance: float = parameter(
        "", "pressure change at which a solution counts as converged, relative", above=0.0, most=0.1
    )
    iterations: int = parameter(
        "", "most iterations of one steady solution; an instant of a block gets at most 40", least=1, most=100_000
    )
    fft: str = parameter("", "library of the Fourier transforms", choices=("pyfftw", "scipy"), default="pyfftw")

    @property
    def spacing(self) -> float:
        """Distance between nodes [m]."""
        return self.domain / (self.points - 1)

    @property
    def axis(self) -> Array:
        """Coordinates of the nodes along x, and along y [m]; zero is the centre of the contact."""
        nodes: Array = np.arange(self.points, dtype=np.float64)
        return (nodes - 0.5 * (self.points - 1)) * self.spacing

    def solve(
        self, now: Instant, start: FilmState | None, step: float | None, moved: int, iterations: int | None = None
    ) -> FilmSolution:
        """Solve one instant.

        start: a solution nearby, or None to start dry. step: time [s] since `start`, or None for a steady film.
        moved: nodes by which the rough surfaces have moved along +x since `start`. iterations: fewer than the scene
        allows. Raises ConvergenceError if even the dry contact has no solution. Entrainment along -x is solved in the
        mirror.
        """
        if now.entrainment_speed < 0.0:
            mirrored = replace(
                now, entrainment_speed=-now.entrainment_speed, heights=now.heights[:, ::-1], limit=now.limit[:, ::-1]
            )
            return _mirror(self.solve(mirrored, start and _mirror_state(start), step, -moved, iterations))
        scaled = Scaled(self, now)
        if now.dry or now.entrainment_speed == 0.0:
            return scaled.dry("dry")
        begins = scaled.fresh_starts()
        if start is not None:
            begins.insert(0, lambda: advected(scaled.iterate(start), scaled.smooth, moved))
        budget, spent = min(iterations or self.iterations, self.iterations), 0
        for begin in begins:
            if start is None or step is None:
                found = _steady(scaled, begin(), self.tolerance, budget)
            else:
                problem = scaled.problem(start.mass / scaled.length, scaled.per_dt(step))
                found = solve_mixed(scaled.half_space, problem, begin(), self.tolerance, budget)
            spent += found.iterations
            if _usable(found):
                return scaled.solution(found, spent)
        if scaled.full_film:  # no dry contact can stand in for that
            raise ConvergenceError(
                f"No solution was found for an oil film of about {scaled.smooth_film:.2g} m on a grid of "
                f"{self.domain:g} m. Lower speed or viscosity, or enlarge film.domain for a film that thick."
            )
        return replace(scaled.dry("fallback"), converged=False, iterations=spent)


def _steady(scaled: Scaled, begin: Iterate, tolerance: float, iterations: int) -> Solution:
    """A steady film: at once where that works; else by time steps over standing surfaces until nothing moves.

    Time lets the oil in step by step and keeps the mass; without it a rough film from a dry start takes thousands of
    iterations, of which each looks converged.
    """
    found = solve_mixed(scaled.half_space, scaled.problem(None, 0.0), begin, tolerance, min(iterations, _DIRECT))
    spent, calm = found.iterations, 0
    if found.converged:
        return found
    per_dt = 1.0 / (_MARCH_NODES * scaled.dx)
    while spent < iterations:
        before = found
        problem = scaled.problem(before.mass, per_dt)
        found = solve_mixed(scaled.half_space, problem, before.iterate, 0.0, min(_MARCH_ITERATIONS, iterations - spent))
        spent += found.iterations
        weight = found.iterate.pressure
        imbalance = float((np.abs(found.mass - before.mass) * weight).sum() * per_dt / (found.mass * weight).sum())
        moved = float(np.abs(found.iterate.pressure - before.iterate.pressure).sum()) / scaled.load
        found = replace(found, iterations=spent, imbalance=imbalance, change=moved)
        calm = calm + 1 if moved < 0.25 * tolerance and imbalance < _MARCH_IMBALANCE else 0
        if calm == _MARCH_CALM:
            return replace(found, converged=True)
    return found


def _usable(solution: Solution) -> bool:
    finite = np.isfinite(solution.change) and np.isfinite(solution.iterate.rigid)
    settled = solution.change < _CHANGE_ACCEPTED and solution.intrusion < _INTRUSION_ACCEPTED
    return bool(finite and settled and abs(solution.load_error) < _LOAD_ACCEPTED)


def _mirror_state(state: FilmState) -> FilmState:
    pressure, fluid, mass = (np.ascontiguousarray(f[:, ::-1]) for f in (state.pressure, state.fluid, state.mass))
    return FilmState(pressure, fluid, np.ascontiguousarray(state.solid[:, ::-1]), mass, state.rigid_gap)


def _mirror(solution: FilmSolution) -> FilmSolution:
    return replace(
        solution,
        state=_mirror_state(solution.state),
        gap=np.ascontiguousarray(solution.gap[:, ::-1]),
        overlap=np.ascontiguousarray(solution.overlap[:, ::-1]),
    )
