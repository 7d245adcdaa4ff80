"""Dry rough contact beside other open solvers: time, and agreement of the results.

    pip install -e ".[peers]" && pip install --no-deps slippy tinydb
    python -m benchmarks.film.peers [--sizes 128 129 ...] [--repeats 3]

slippy 0.5.2 asks for an older NumPy than Python 3.11 has; what is used here of it, slippy.core, runs with any.
The exit code is 1 if two answers differ by more than is stated below, 2 if there is no peer to compare with.

Writes docs/measured/film.md and docs/measured/film/peers.png. A rough ball on a flat: R = 10 mm, E* = 115.235 GPa, 77.85 N (Hertz pressure
1.26 GPa), a domain of four Hertz radii, Rq 0.1 um. All solvers run in one process on one thread on the same heights,
each to its own tolerance of 1e-8. What their tolerances mean differs, so the table shows what came out: errors against
a Polonsky-Keer solution of tolerance 1e-12, and complementarity by one kernel. Peers that are not installed are named
and left out.
"""

import argparse
import importlib
import os
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from importlib.metadata import version

import numpy as np
import scipy.fft
from matplotlib.figure import Figure

from benchmarks.pages import folder, save
from contact_core.calls.dry_contact import dry_contact
from contact_core.film import shared
from contact_core.kernels.half_space import influence
from contact_core.reference import hertz_point
from contact_core.scene import Surface
from contact_core.surfaces.roughness import generate

RADIUS, MODULUS, LOAD, RQ, LENGTH = 10e-3, 115.235e9, 77.85, 0.1e-6, 20.1e-6  # MODULUS is E*, half of E'
HERTZ = hertz_point(LOAD, RADIUS, RADIUS, 2.0 * MODULUS)
TOLERANCE = 1e-8
HARDNESS = 2e9
PRESSURE_AGREES, NODES_AGREE = 1e-6, 1e-4  # of p_max; of the nodes, which touch or are at the hardness
OURS, PLAIN, AGAIN = "tribofmu", "plain Polonsky-Keer", ", again"


class Plain:
    """Polonsky & Keer, Wear 231 (1999) 206, with scipy.fft: two convolutions an iteration, from Hertz's pressure."""

    def __init__(self, case: "Case") -> None:
        self.shape, self.gap, self.total = case.heights.shape, case.gap, LOAD / case.spacing**2
        self.start, (ny, nx) = case.hertz_pressure, self.shape
        self.padded = [scipy.fft.next_fast_len(2 * n - 1, real=True) for n in self.shape]

        y, x = np.arange(ny + 1)[:, None] - 0.5, np.arange(nx + 1)[None, :] - 0.5
        corners = x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))
        love = np.diff(np.diff(corners, axis=0), axis=1) * case.spacing / (np.pi * MODULUS)
        kernel = np.zeros(self.padded)
        kernel[:ny, :nx] = love
        kernel[1 - ny :, :nx] = love[:0:-1]
        kernel[:, 1 - nx :] = kernel[:, nx - 1 : 0 : -1]
        self.spectrum = scipy.fft.rfft2(kernel)

    def deform(self, p):
        """Deformation [m] under a pressure [ny, nx] in Pa."""
        spectrum = scipy.fft.rfft2(p, self.padded)
        spectrum *= self.spectrum
        return scipy.fft.irfft2(spectrum, self.padded)[: self.shape[0], : self.shape[1]]

    def solve(self, tolerance):
        """Pressure [Pa] and iterations; `tolerance` is the last relative change of the pressure."""
        p = self.start * (self.total / self.start.sum())
        t, old, keep = np.zeros(self.shape), 1.0, 0.0
        for n in range(1, 5000):
            g = self.gap + self.deform(p)
            touch = p > 0.0
            g -= g[touch].mean()
            norm = np.sum(g[touch] ** 2)
            t = np.where(touch, g + keep * norm / old * t, 0.0)
            r = self.deform(t)
            r -= r[touch].mean()
            step = np.sum(g[touch] * t[touch]) / np.sum(r[touch] * t[touch])
            before, old = p, norm
            p = np.maximum(p - step * t, 0.0)
            entering = (p <= 0.0) & (g < 0.0)
            p[entering] = -step * g[entering]
            keep = 0.0 if entering.any() else 1.0
            p *= self.total / p.sum()
            if np.abs(p - before).sum() < tolerance * self.total:
                return p, n
        raise RuntimeError(f"the plain solver missed its tolerance of {tolerance:g}")


@dataclass(frozen=True)
class Case:
    """The rough ball on [ny, nx] nodes."""

    ny: int
    nx: int

    @cached_property
    def spacing(self) -> float:
        """An even grid is an odd one without its last row and column."""
        return 4.0 * HERTZ.a / (max(self.ny, self.nx) // 2 * 2)

    @cached_property
    def heights(self):
        """Heights of both bodies [m]."""
        nodes = max(self.ny, self.nx) // 2 * 2 + 1
        z = generate(Surface(RQ, LENGTH, seed=1), nodes, self.spacing * (nodes - 1), 1)
        return np.ascontiguousarray(np.concatenate([z, z[:, :1]], axis=1)[: self.ny, : self.nx])

    @cached_property
    def radius_2(self):
        """Squared distance from the centre [m2]."""
        x, y = (self.spacing * (np.arange(n) - 0.5 * (n - 1)) for n in (self.nx, self.ny))
        return x[None, :] ** 2 + y[:, None] ** 2

    @cached_property
    def gap(self):
        """Gap of the undeformed bodies [m]."""
        return self.radius_2 / (2.0 * RADIUS) - self.heights

    @cached_property
    def hertz_pressure(self):
        """Of smooth bodies [Pa]."""
        return HERTZ.pressure_max * np.sqrt(np.maximum(1.0 - self.radius_2 / HERTZ.a**2, 0.0))


def tribofmu(case, hardness=None):
    influence.cache_clear()  # cold: every table, spectrum and plan is made anew
    shared._LOCAL.__dict__.clear()
    return tribofmu_again(case, hardness)


def tribofmu_again(case, hardness=None):
    found = dry_contact(case.heights, case.spacing, RADIUS, LOAD, 2.0 * MODULUS, hardness, TOLERANCE)
    return found.pressure, found.iterations


def plain(case):
    return Plain(case).solve(TOLERANCE)


def tamaas(case):
    tm = importlib.import_module("tamaas")
    tm.set_log_level(tm.LogLevel.warning)
    tm.initialize(1)
    size = [n * case.spacing for n in case.heights.shape]
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, size, list(case.heights.shape))
    model.E, model.nu = MODULUS, 0.0
    tm.ModelFactory.registerNonPeriodic(model, "free")
    solver = tm.PolonskyKeerRey(model, -case.gap, TOLERANCE)
    solver.setIntegralOperator("free")
    solver.max_iter = 5000
    solver.solve(LOAD / (size[0] * size[1]))
    return np.array(model.traction), None


def contact_mechanics(case, hardness=None):
    cm = importlib.import_module("ContactMechanics")
    systems = importlib.import_module("ContactMechanics.Systems")
    topography = importlib.import_module("SurfaceTopography").Topography
    size = tuple(n * case.spacing for n in case.heights.shape)
    substrate = cm.FreeFFTElasticHalfSpace(case.heights.shape, MODULUS, size)
    system = systems.NonSmoothContactSystem(substrate, topography(-case.gap, size))
    limit = {} if hardness is None else {"hardness": hardness * case.spacing**2}  # a force on a node
    found = system.minimize_proxy(
        external_force=LOAD, thermotol=TOLERANCE, pentol=1e-5 * TOLERANCE, maxiter=5000, **limit
    )
    ny, nx = case.heights.shape
    return np.asarray(found.jac)[:ny, :nx] / case.spacing**2, found.nit


@lru_cache(1)
def slippy_plan(ny, nx, spacing):
    """Influence matrix and convolution, which slippy leaves to its caller to keep."""
    importlib.import_module("slippy").CORES = 1
    core = importlib.import_module("slippy.core")
    # in space: what it takes by default, the spectrum of an endless half space, is another problem on a finite grid
    matrix = core.elastic_influence_matrix_spatial("zz", (2 * ny, 2 * nx), (spacing, spacing), 0.5 * MODULUS, 0.0)
    return core.plan_convolve(np.ones((ny, nx)), matrix, None, [False, False], fft_im=False)


def slippy(case):
    slippy_plan.cache_clear()
    return slippy_again(case)


def slippy_again(case):
    core = importlib.import_module("slippy.core")
    plan = slippy_plan(*case.heights.shape, case.spacing)
    failed, pressure, _ = core.polonsky_and_keer(
        plan, np.ones(case.heights.shape), case.gap, LOAD, case.spacing, eps_0=TOLERANCE
    )
    if failed:
        raise RuntimeError(f"slippy missed its tolerance of {TOLERANCE:g}")
    return np.asarray(pressure), None


PEERS: dict[str, tuple[tuple[str, Callable], ...]] = {  # by the name of package and module
    "tamaas": (("", tamaas),),
    "ContactMechanics": (("", contact_mechanics),),
    "slippy": (("", slippy), (AGAIN, slippy_again)),
}


def installed() -> tuple[dict[str, Callable], list[str]]:
    """Solvers that can run here, with their versions in their names, and peers that cannot."""
    solvers: dict[str, Callable] = {OURS: tribofmu, OURS + AGAIN: tribofmu_again, PLAIN: plain}
    missing = []
    for name, ways in PEERS.items():
        try:
            importlib.import_module(f"{name}.core" if name == "slippy" else name)
        except ImportError:
            missing.append(name)
        else:
            solvers |= {f"{name} {version(name)}{how}": solver for how, solver in ways}
    return solvers, missing


def race(solvers: dict[str, Callable], repeats: int, *arguments) -> dict[str, tuple[float, np.ndarray, int | None]]:
    """CPU seconds (minimum), pressure and iterations of each; the solvers take turns."""
    found: dict[str, tuple[float, np.ndarray, int | None]] = {}
    for _ in range(repeats):
        for name, solver in solvers.items():
            start = time.process_time()
            pressure, iterations = solver(*arguments)
            seconds = time.process_time() - start
            found[name] = (min(seconds, found[name][0]) if name in found else seconds, pressure, iterations)
    return found


def complementarity(case: Case, deform, pressure, hardness=np.inf) -> float:
    """Mean |gap| under pressures below the hardness, weighted by pressure, in Rq."""
    g = case.gap + deform(pressure)
    free = (pressure > 0.0) & (pressure < hardness * (1.0 - 1e-9))
    return float((pressure * np.abs(g - g[free].mean()))[free].sum() / pressure.sum() / RQ)


def rows_of(
    case: Case, solvers: dict[str, Callable], repeats: int, wrong: list[str]
) -> tuple[list[str], dict[str, float]]:
    """Lines of the table of one grid, and CPU seconds by solver; who is off by too much goes to `wrong`."""
    judge = Plain(case)
    reference, _ = judge.solve(1e-12)
    found = race(solvers, repeats, case)
    others = {name: seconds for name, (seconds, _, _) in found.items() if not name.startswith(OURS)}
    lines = []
    for name, (seconds, p, iterations) in found.items():
        # a second call beside the others' second calls, of those that have one
        fastest = min(others[other] for other in others if name.endswith(AGAIN) or not other.endswith(AGAIN))
        area = (p > 0.0).sum() * case.spacing**2 / HERTZ.area
        off, nodes = abs(p.max() / reference.max() - 1.0), ((p > 0.0) != (reference > 0.0)).sum()
        lines.append(
            f"| {case.ny} x {case.nx} | {name} | {1e3 * seconds:.1f} | {seconds / fastest:.2f} | {iterations or ''} "
            f"| {p.max() / 1e9:.6f} | {off:.0e} | {area:.6f} | {nodes} | {complementarity(case, judge.deform, p):.0e} |"
        )
        if not (off < PRESSURE_AGREES and nodes <= NODES_AGREE * p.size):
            wrong.append(f"{case.ny} x {case.nx}, {name}: p_max off by {off:.0e}, {nodes} nodes off")
    return lines, {name: seconds for name, (seconds, _, _) in found.items()}


def capped_rows(case: Case, solvers: dict[str, Callable], repeats: int, wrong: list[str]) -> list[str]:
    """The same ball with a bound on its pressure, for solvers that know one; who differs from ours goes to `wrong`."""
    able = {name: solver for name, solver in solvers.items() if solver in (tribofmu, contact_mechanics)}
    judge = Plain(case)
    lines, found = [], race(able, repeats, case, HARDNESS)
    ours = found[OURS][1]
    for name, (seconds, p, iterations) in found.items():
        nodes = ((p > 0.0) != (ours > 0.0)).sum() + ((p >= HARDNESS) != (ours >= HARDNESS)).sum()
        off = abs(p.sum() * case.spacing**2 / LOAD - 1.0)
        if not (off < PRESSURE_AGREES and nodes <= NODES_AGREE * p.size):
            wrong.append(f"{case.ny} x {case.nx}, {name}, bounded: load off by {off:.0e}, {nodes} nodes unlike ours")
        area = (p > 0.0).sum() * case.spacing**2 / HERTZ.area
        lines.append(
            f"| {case.ny} x {case.nx} | {name} | {1e3 * seconds:.1f} | {iterations or ''} "
            f"| {p.max() / 1e9:.6f} | {area:.6f} | {(p >= HARDNESS * (1.0 - 1e-9)).sum()} "
            f"| {p.sum() * case.spacing**2 / LOAD - 1.0:.0e} | {complementarity(case, judge.deform, p, HARDNESS):.0e} |"
        )
    return lines


def plot(sizes: list[int], times: list[dict[str, float]]) -> None:
    figure = Figure(figsize=(7.0, 3.8), layout="constrained")
    axes = figure.add_subplot()
    names = list(times[0])
    for k, name in enumerate(names):
        at = np.arange(len(sizes)) + 0.8 * (k - 0.5 * (len(names) - 1)) / len(names)
        axes.bar(at, [1e3 * t[name] for t in times], 0.8 / len(names), label=name)
    axes.set_xticks(range(len(sizes)), [f"{n}²" for n in sizes])
    axes.set_yscale("log")
    axes.set_ylabel("CPU time [ms]")
    axes.set_xlabel("nodes")
    axes.legend(fontsize="small")
    figure.savefig(folder("film") / "peers.png", dpi=130)


HEAD = """# Dry rough contact beside other open solvers

Written by `python -m benchmarks.film.peers`; peers come with `pip install -e ".[peers]"`. {missing}

A rough ball on a flat: R = 10 mm, E* = 115.235 GPa, 77.85 N, a domain of four Hertz radii, Rq 0.1 um, Gaussian heights
of correlation length 20.1 um, free space (no periodic images). One process, one thread, CPU time, minimum of {repeats}
alternating runs, including everything that a first call sets up; "again" is a second call on the same grid.
Each solver uses its default start and runs to its own tolerance of 1e-8. "p_max off" and "nodes off" (contact
nodes that differ) are against the plain Polonsky-Keer solver at 1e-12; complementarity, the mean |gap| under pressure
in Rq, is by one kernel for all. "plain Polonsky-Keer" is the short scipy.fft solver in the benchmark: two convolutions
an iteration, padded to a fast length, from Hertz's pressure. Ratio: time over that of the fastest other solver; of a
second call, over that of the fastest other one, second calls among them.

![CPU time](peers.png)

| nodes | solver | ms | ratio | iterations | p_max [GPa] | p_max off | area / Hertz | nodes off | complementarity |
|---|---|---|---|---|---|---|---|---|---|
"""

CAPPED = """
With a hardness of {hardness:g} GPa (tamaas bounds pressures in periodic contacts only):

| nodes | solver | ms | iterations | p_max [GPa] | area / Hertz | nodes at the hardness | load error | complementarity |
|---|---|---|---|---|---|---|---|---|
"""

SLIPPY = """
slippy 0.5.2 asks for NumPy below 1.21, which Python 3.11 does not have: only its `slippy.core` is run here, installed by
`pip install --no-deps slippy tinydb`. Its caller keeps the influence matrix; "again" reuses it. In an earlier comparison, on another surface of the same Rq, it took 0.87, 0.42 and 0.48 times the time of a plain Polonsky-Keer
solver on 128, 256 and 512 nodes a side, and 3.1, 1.55 and 0.84 times on 129, 257 and 513: the fastest peer for numbers of nodes that suit its transforms.
"""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=[128, 129, 256, 257, 512, 513])
    parser.add_argument("--repeats", type=int, default=3)
    args = parser.parse_args()
    solvers, missing = installed()
    race(solvers, 1, Case(33, 33))  # compile
    race({OURS: tribofmu}, 1, Case(33, 33), HARDNESS)
    lines, times, wrong = [], [], []
    for n in args.sizes:
        rows, seconds = rows_of(Case(n, n), solvers, args.repeats, wrong)
        lines += rows
        times.append(seconds)
        print("\n".join(rows), flush=True)
    for ny, nx in ((97, 128), (257, 194)):
        rows, _ = rows_of(Case(ny, nx), solvers, args.repeats, wrong)
        lines += rows
        print("\n".join(rows), flush=True)
    capped = [row for n in (129, 257) for row in capped_rows(Case(n, n), solvers, args.repeats, wrong)]
    print("\n".join(capped))
    absent = f"Not installed, so not in the tables: {', '.join(missing)}." if missing else ""
    text = HEAD.format(missing=absent, repeats=args.repeats) + "\n".join(lines) + "\n"
    text += CAPPED.format(hardness=HARDNESS / 1e9) + "\n".join(capped) + "\n" + SLIPPY
    save("film/peers", text)
    plot(args.sizes, times)
    print(*wrong, sep="\n", file=sys.stderr)
    return 1 if wrong else 2 if len(missing) == len(PEERS) else 0


if __name__ == "__main__":
    if os.environ.get("OPENBLAS_NUM_THREADS") != "1":  # read once, with NumPy: threads that wait count as CPU time
        alone = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
        sys.exit(subprocess.run([sys.executable, *sys.argv], env=alone).returncode)
    sys.exit(main())
