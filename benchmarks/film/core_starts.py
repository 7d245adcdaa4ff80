"""Dependence of films on their start, and the limits of zero and high speed."""

from dataclasses import replace

import numpy as np

from benchmarks.pages import Page
from benchmarks.timing import timed
from contact_core import Scene
from contact_core.deterministic.instant import instant_of
from contact_core.film.instant import FilmSolution, Instant, Settings
from contact_core.film.outputs import film_outputs
from contact_core.film.routes import solve_film
from contact_core.film.scaled import Scaled
from contact_core.film.solutions import solution
from contact_core.film.starts import dry_start, lifted_start
from contact_core.kernels.half_space import HalfSpace
from contact_core.kernels.mixed.fixed_point import solve_mixed
from contact_core.kernels.mixed.problem import Iterate, Problem, Solution
from contact_core.scene import Case
from contact_core.surfaces.patches import bare_heights

SPEEDS = (0.005, 0.05, 0.1, 0.25, 1.0, 4.0)
ASKED_FROM = 0.05
SLOW, FAST = 1e-6, 40.0


def instant(scene: Scene, speed: float, rough: bool = True) -> Instant:
    """The scene's surfaces as new, at a speed."""
    heights = sum(bare_heights(scene, scene.film.points))
    heights = np.concatenate([heights, heights[:, :1]], axis=1)
    op = scene.operation.point
    if not rough:
        heights = np.zeros_like(heights)
    limit = np.full(heights.shape, scene.plasticity.hardness)
    return replace(instant_of(Case(scene, op), heights, limit), entrainment_speed=speed)


def marched(half_space: HalfSpace, problem: Problem, start: Iterate, tolerance: float, iterations: int) -> Solution:
    """The steady film as the end of a march in time of surfaces that stand still, in steps of three nodes."""
    found = solve_mixed(half_space, problem, start, 0.0, 5)
    for _ in range(iterations):
        step = replace(problem, mass_old=found.mass, per_dt=1.0 / (3.0 * problem.spacing))
        found = solve_mixed(half_space, step, found.iterate, 0.0, 15)
    return solve_mixed(half_space, problem, found.iterate, tolerance, 200)


# iterations, or steps, at most
METHODS = {"hybrid": (solve_mixed, 1000), "marched": (marched, 120)}


def solved(scaled: Scaled, method: str, start: Iterate) -> FilmSolution:
    """Steady film by a method from a start, whatever the table would have it begin with."""
    solve, most = METHODS[method]
    found = solve(scaled.half_space, scaled.problem(), start, scaled.settings.tolerance, most)
    return solution(scaled, found, "mixed", method)


def off(pressure: np.ndarray, reference: np.ndarray) -> float:
    return float(np.abs(pressure - reference).sum() / reference.sum())


def run() -> None:
    report = Page("film/core", "Starts and limits", "starts")
    scene = Scene.from_toml("mtm_zddp")
    grid, settings = scene.grid(scene.film.points), Settings(scene.film.floor, 1e-3, 400, "pyfftw", fitted=True)
    report.say(
        "Case B, fresh surfaces, 129 nodes, steady films to a pressure change of 1e-3, started from the dry contact and from a Hertz-like pressure under a film that clears the asperities, each algorithm by itself. (`point_contact` chooses its start.) Marched: in time, surfaces standing still, 120 steps of three nodes and 15 iterations. Gap: mean over r < 2a/3. Pairs: from dry, from thick."
    )
    report.header(
        "u [m/s]",
        "by",
        "L1 of pressure [%]",
        "gap [nm]",
        "A_c",
        "W_c",
        "imbalance",
        "converged",
        "s",
        "within the bars",
    )
    for method in METHODS:
        passed, worst = [], np.zeros(4)
        for speed in SPEEDS:
            scaled = Scaled(instant(scene, speed), grid, settings)
            films, seconds = timed(
                lambda s=scaled, m=method: [solved(s, m, start) for start in (dry_start(s), lifted_start(s))]
            )
            hertz = scene.hertz(scaled.now.load)
            dry, thick = (
                film_outputs(grid, film.state, film.gap, film.touching, scaled.now.load, hertz) for film in films
            )
            pairs = [(dry[key], thick[key]) for key in ("h_c", "contact_area_ratio", "contact_load_ratio")]
            off_by = np.array(
                [off(films[1].state.pressure, films[0].state.pressure), abs(pairs[0][1] / pairs[0][0] - 1.0)]
            )
            apart = np.array([abs(b - a) for a, b in pairs[1:]])
            near = [abs(b - a) <= max(0.01, 0.05 * max(a, b)) for a, b in pairs[1:]]
            within = bool((off_by <= 0.02).all() and all(near))
            gap, area, share = (
                f"{a:.3g}, {b:.3g}" for a, b in ((1e9 * a, 1e9 * b) if a < 1e-3 > b else (a, b) for a, b in pairs)
            )
            report.row(
                speed, method, 100.0 * off_by[0], gap, area, share, ", ".join(f"{film.imbalance:.1g}" for film in films),
                ", ".join("yes" if film.converged else "no" for film in films), round(seconds, 1), within,
            )  # fmt: skip
            if speed >= ASKED_FROM:
                passed.append(within)
                worst = np.maximum(worst, [*(100 * off_by), *apart])
        report.verdict(
            f"started dry or thick, u >= 0.05 m/s, {method}: pressure (L1) and mean gap within 2 %, A_c and W_c within 5 % or 0.01",
            f"{sum(passed)} of {len(passed)} speeds; worst L1 {worst[0]:.2f} %, gap {worst[1]:.2f} %, A_c {worst[2]:.3f}, "
            f"W_c {worst[3]:.3f}",
            all(passed),
        )
    limits(report, scene, settings)
    report.write()


def limits(report: Page, scene: Scene, settings: Settings) -> None:
    report.say("### Limits of speed\n\nThe same surfaces.")
    report.header("u [m/s]", "beside", "what", "found", "algorithm", "converged")
    grid = scene.grid(scene.film.points)
    dry, slow = (solve_film(instant(scene, speed), grid, settings) for speed in (0.0, SLOW))
    error = off(slow.state.pressure, dry.state.pressure)
    report.row(SLOW, "dry contact", "L1 of the pressure", error, slow.algorithm, slow.converged)
    report.verdict(f"u = {SLOW:g} m/s gives the dry answer to 1e-4 in L1", f"{error:.1g}", error <= 1e-4)
    rough, smooth = (solve_film(instant(scene, FAST, rough), grid, settings) for rough in (True, False))
    hertz = scene.hertz(scene.operation.load)
    h_rough, h_smooth = (
        film_outputs(grid, film.state, film.gap, film.touching, scene.operation.load, hertz)["h_c"]
        for film in (rough, smooth)
    )
    ratio = h_rough / h_smooth - 1.0
    report.row(FAST, "smooth bodies", "h_c off [%]", 100.0 * ratio, rough.algorithm, rough.converged)
    report.verdict(
        "large u gives the smooth-film answer (taken as: h_c within 3 %)",
        f"{100 * ratio:+.2f} % at {FAST:g} m/s, h_c {1e9 * h_rough:.0f} nm",
        abs(ratio) <= 0.03,
    )
