"""Films that follow load, speeds and radii in time: closed form, orders, trapped oil, and the mesh of a gear tooth.

    python -m benchmarks.film.transient [--rough]

Writes docs/measured/film/transient.md and docs/measured/film/transient.png. `--rough` adds a mesh of rough flanks, some minutes.
"""

import argparse
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from benchmarks.folders import MEASURED
from benchmarks.pages import save
from contact_core import ContactState, Moment, OperatingPoint, Scene, advance, initial_state, march, parted
from contact_core.film.instant import FilmState, Grid, Instant, Settings, Step
from contact_core.film.routes import solve_film
from contact_core.laws.density import Incompressible
from contact_core.shapes import Point

DOCS = MEASURED / "film"
SMOOTH = {"surface_1.rq": "0 m", "surface_2.rq": "0 m"}
RAMP = 1e-4  # s
OUTPUTS = ("h_c", "h_min", "friction_force")

# a rigid ball over a plane, in oil of one viscosity
RADIUS, VISCOSITY, LOAD, GAP = 10e-3, 0.1, 1e-3, 20e-6
SINKING_TIME = 6.0 * np.pi * VISCOSITY * RADIUS**2 / LOAD

# FZG type C: m = 4.5 mm, z = 16/24, working pressure angle 22.439 deg; distances on the line of action [m]
LINE, A, B, C, D, E = 34.925e-3, 4.482e-3, 10.276e-3, 13.970e-3, 17.767e-3, 23.561e-3
PINION, WHEEL = 2170.0 * 2.0 * np.pi / 60.0, 2170.0 * 2.0 * np.pi / 60.0 * 16.0 / 24.0  # rad/s
ALONG = PINION * 33.829e-3  # m/s, of the contact along it
SHARED = 0.3e-3  # m: over which a tooth takes its load, assumed


def viscosity(pressure: np.ndarray, temperature: float) -> np.ndarray:
    return np.full_like(pressure, VISCOSITY)


def sunk(points: int, steps: int, order: int, width: float = 6.0) -> float:
    """Gap over the first one after SINKING_TIME; `width`: half the grid's, over sqrt(2 R h0)."""
    grid = Grid.centred(points, points, 2.0 * width * math.sqrt(2.0 * RADIUS * GAP) / (points - 1))
    now = Instant(
        load=LOAD,
        entrainment_speed=0.0,
        temperature=300.0,
        shape=Point(RADIUS, RADIUS),
        reduced_modulus=1e18,
        viscosity=viscosity,
        density=Incompressible(),
        heights=np.zeros(grid.shape),
        limit=np.full(grid.shape, 1e12),
        hardness=1e12,
    )
    zeros = np.zeros(grid.shape)
    state = FilmState(zeros, zeros, zeros > 0.0, GAP + grid.radius_2 / (2.0 * RADIUS), GAP)
    for _ in range(steps):
        step = Step(SINKING_TIME / steps, 0, order, True)
        state = solve_film(now, grid, Settings(1e-9, 1e-7, 200, "pyfftw"), state, step).state
    return state.rigid_gap / GAP


def still(points: int, width: float = 6.0) -> float:
    """The same at a time step of zero."""
    coarse, fine = (sunk(points, steps, 2, width) for steps in (10, 20))
    return fine + (fine - coarse) / 3.0


def sinking() -> list[str]:
    """Tables of the sinking ball."""
    exact = math.exp(-1.0)
    lines = [
        "## A rigid ball sinks through oil at rest",
        "",
        "W = 6 pi eta R^2 V / h for a ball near a plane, so h = h0 exp(-t / tau), tau = 6 pi eta R^2 / W. Error of h "
        "after tau, the time step extrapolated to zero; `width` is half the grid's side over sqrt(2 R h0). The pressure continues beyond the grid like 1 / h^2 (`contact_core/kernels/far_field.py`), so the width does not matter.",
        "",
        "| nodes along x and y | width | error of h |",
        "|---|---|---|",
    ]
    for points, width in ((33, 6.0), (65, 6.0), (129, 6.0), (33, 3.0), (97, 9.0)):
        lines.append(f"| {points} | {width:g} | {100.0 * (still(points, width) / exact - 1.0):+.2f} % |")
    lines += [
        "",
        "Error by the time step on 33 nodes, against a step of zero:",
        "",
        "| steps | first order | second order |",
        "|---|---|---|",
    ]
    limit = still(33)
    for steps in (5, 10, 20, 40):
        row = " | ".join(f"{100.0 * (sunk(33, steps, order) / limit - 1.0):+.3f} %" for order in (1, 2))
        lines.append(f"| {steps} | {row} |")
    return [*lines, ""]


def rolling(rough: bool) -> tuple[Scene, OperatingPoint, ContactState]:
    """A ball under 10 N in a film of 80 nm; rough, with a disc at rest over which it slides."""
    changes = {"film.points": "65", "film.domain": "0.4 mm", "film.tolerance": "1e-6", "operation.load": "10 N"}
    changes |= SMOOTH
    if rough:
        changes |= {"surface_2.rq": "40 nm", "surface_2.correlation_length": "16 um", "film.tolerance": "1e-4"}
    scene = Scene.from_toml("mtm_zddp", changes)
    op = replace(scene.operation.point, speed_1=6.0 if rough else 3.2, speed_2=0.0 if rough else 2.8)
    return scene, op, next(march(scene, initial_state(scene), lambda time: op, [0.0])).state


def flank() -> tuple[Scene, OperatingPoint, ContactState]:
    """A smooth line, that of `fzg_flank`."""
    line = {"film.points": "129", "film.width": "0 m", "film.tolerance": "1e-7", "tribofilm.model": "none"}
    scene = Scene.from_toml("fzg_flank", SMOOTH | line)
    op = scene.operation.point
    return scene, op, next(march(scene, initial_state(scene), lambda time: op, [0.0])).state


def duties(scene: Scene, op: OperatingPoint) -> dict[str, Callable[[float], OperatingPoint]]:
    """The changes, by name."""
    radius = scene.radii(op)[0]

    def part(time: float) -> float:
        x = min(time / RAMP, 1.0)
        return x * x * (3.0 - 2.0 * x)

    def with_radius(time: float) -> OperatingPoint:
        now = radius * (1.0 + 0.5 * part(time))
        return replace(op, radius_x=now, radius_y=now if len(scene.radii(op)) == 2 else None)

    def with_speed(time: float) -> OperatingPoint:
        slower = 1.0 - 0.5 * part(time)
        return replace(op, speed_1=slower * op.speed_1, speed_2=slower * op.speed_2)

    return {
        "load x 2 at once": lambda time: replace(op, load=2.0 * op.load if time > 0.0 else op.load),
        "load x 2": lambda time: replace(op, load=op.load * (1.0 + part(time))),
        "radii x 1.5": with_radius,
        "speeds x 0.5": with_speed,
    }


def orders() -> list[str]:
    """Table of the orders in time."""
    lines = [
        "## Orders in time",
        "",
        f"Changes within {RAMP:g} s (about a passage of the oil), films at the end. Errors are against second order with 128 steps, extrapolated; the order is that between the coarsest and the finest step. Rough: a ball slides "
        "over a disc of 40 nm at rest, so the time step is free; changing sets of cavities and the tolerance (1e-4) limit the order. "
        "Smooth line: the flank of `fzg_flank` without roughness, one row of 129 nodes.",
        "",
        "| change | bodies | scheme | steps | error of h_c | of h_min | of friction | order by h_c |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for bodies, (scene, op, state), names in (
        ("smooth", rolling(False), None),
        ("rough", rolling(True), ("load x 2",)),
        ("smooth line", flank(), None),
    ):
        for name, duty in duties(scene, op).items():
            if names and name not in names:
                continue
            found = {
                (order, steps): ends(scene, state, duty, steps, order)
                for order in (1, 2)
                for steps in (8, 16, 32, 64, 128)
            }
            exact = (4.0 * found[2, 128] - found[2, 64]) / 3.0
            for order in (1, 2):
                errors = {steps: np.abs(found[order, steps] / exact - 1.0) for steps in (8, 16, 32, 64)}
                fit = math.log2(errors[8][0] / errors[64][0]) / 3.0
                scheme = ("Euler", "BDF2")[order - 1]
                for steps, error in errors.items():
                    row = " | ".join(f"{100.0 * each:.3f} %" for each in error)
                    said = f"{fit:.2f}" if steps == 64 else ""
                    lines.append(f"| {name} | {bodies} | {scheme} | {steps} | {row} | {said} |")
    return [*lines, ""]


def ends(
    scene: Scene, state: ContactState, duty: Callable[[float], OperatingPoint], steps: int, order: int
) -> np.ndarray:
    """Outputs at the end of a change."""
    *_, last = march(scene, state, duty, np.linspace(0.0, RAMP, steps + 1).tolist(), order=order)
    return np.array([last.outputs[name] for name in OUTPUTS])


def trapped() -> list[str]:
    """Table of the oil that an elastic ball traps."""
    scene = Scene.from_toml(
        "mtm_zddp", {"film.points": "129", "film.domain": "0.8 mm", "film.tolerance": "1e-4"} | SMOOTH
    )
    op = replace(scene.operation.point, speed_1=0.0, speed_2=0.0, load=30.0)
    state = parted(scene, op, initial_state(scene), 2e-6)
    times = np.concatenate([[0.0], np.geomspace(1e-7, 1e-5, 41)])
    lines = [
        "## An elastic ball falls on a plane",
        "",
        "30 N on the ball of `mtm_zddp`, 2 um above the disc, without rolling: oil is trapped in a dimple, which drains through the ring that closes first. Smallest gap and its position over Hertz's half width.",
        "",
        "| time [s] | h_central [nm] | h_min [nm] | at r / a | p_max / p_H |",
        "|---|---|---|---|---|",
    ]
    hertz = scene.hertz_at(op)
    for k, moment in enumerate(march(scene, state, lambda time: op, times.tolist())):
        if k % 8 == 0:
            row = moment.fields.gap[moment.fields.gap.shape[0] // 2]
            at = abs(float(moment.fields.x[row.argmin()])) / hertz.a
            seen = moment.outputs
            lines.append(
                f"| {moment.time:.1e} | {1e9 * seen['h_central']:.0f} | {1e9 * seen['h_min']:.0f} | {at:.2f} "
                f"| {seen['pressure_max'] / hertz.pressure_max:.2f} |"
            )
    return [*lines, ""]


def tooth(scene: Scene) -> Callable[[float], OperatingPoint]:
    """The duty of a pair of flanks from A to E."""
    op = scene.operation.point

    def taken(s: float, at: float) -> float:
        return min(max((s - at) / SHARED, 0.0), 1.0)

    def duty(time: float) -> OperatingPoint:
        s = A + ALONG * time
        share = 0.5 * (taken(s, A) + taken(s, B - SHARED) - taken(s, D) - taken(s, E - SHARED))
        speeds = {"speed_1": PINION * s, "speed_2": WHEEL * (LINE - s)}
        return replace(op, load=share * op.load, radius_x=s * (LINE - s) / LINE, **speeds)

    return duty


def meshes(rough: bool) -> tuple[list[str], dict[str, list[Moment]]]:
    """Table of the mesh of a tooth, and its instants."""
    scene = Scene.from_toml("fzg_flank", SMOOTH | {"film.width": "6.25 um", "film.tolerance": "1e-4"})
    end, state, duty = (E - A) / ALONG, initial_state(scene), tooth(scene)
    begin = time.perf_counter()
    found = {"smooth": list(march(scene, state, duty, np.linspace(0.0, end, 801).tolist()))}
    cost = {"smooth": time.perf_counter() - begin}
    times = np.linspace(0.0, end, 161)[1:-1]
    found["quasi-steady"] = [next(march(scene, state, duty, [float(each)])) for each in times]
    if rough:
        scene = Scene.from_toml("fzg_flank", {"film.width": "0.2 mm"})
        begin = time.perf_counter()
        found["rough"] = list(march(scene, initial_state(scene), tooth(scene), np.linspace(0.0, end, 201).tolist()))
        cost["rough"] = time.perf_counter() - begin
    spent = ", ".join(f"{name} {len(found[name])} instants in {seconds:.0f} s" for name, seconds in cost.items())
    lines = [
        "## The mesh of a tooth: FZG type C, load stage 6, 2170 rpm",
        "",
        "`fzg_flank` (a line contact) from A to E on the line of action: radius, both speeds and load change; the load is "
        f"shared by two pairs of teeth up to B and from D on, taken over within {1e3 * SHARED:g} mm (assumed). "
        f"Quasi-steady: a steady film at each station. Instants: {spent}; instants not converged: "
        + ", ".join(f"{name} {sum(not m.fields.converged for m in found[name])}" for name in cost)
        + ".",
        "",
        "| s [mm] | load [N] | u_e [m/s] | SRR | h_c, h_min [nm] | quasi-steady | friction coefficient | quasi-steady |"
        + (" rough: h_c [nm], W_c, friction |" if rough else ""),
        "|---" * (9 if rough else 8) + "|",
    ]
    for s in (
        A + 0.1e-3,
        A + 0.5e-3,
        7.5e-3,
        B - 0.15e-3,
        B + 0.05e-3,
        B + 0.5e-3,
        C,
        D - 0.1e-3,
        D + 0.15e-3,
        D + 0.5e-3,
        20.5e-3,
        E - 0.4e-3,
    ):
        now, steady = (at(found[name], (s - A) / ALONG) for name in ("smooth", "quasi-steady"))
        op, row = now.op, f"| {1e3 * s:.2f} | {now.op.load:.0f} | {now.op.entrainment_speed:.2f} "
        row += f"| {op.sliding_speed / op.entrainment_speed:+.2f} "
        for moment in (now, steady):
            row += f"| {1e9 * moment.outputs['h_c']:.0f}, {1e9 * moment.outputs['h_min']:.0f} "
        row += "| " + " | ".join(f"{moment.outputs['friction_coefficient']:.4f}" for moment in (now, steady)) + " |"
        if rough:
            seen = at(found["rough"], (s - A) / ALONG).outputs
            row += f" {1e9 * seen['h_c']:.0f}, {seen['contact_load_ratio']:.2f}, {seen['friction_coefficient']:.3f} |"
        lines.append(row)
    return [*lines, ""], found


def at(moments: Sequence[Moment], time: float) -> Moment:
    """The instant next to a time."""
    return min(moments, key=lambda moment: abs(moment.time - time))


def plot(found: dict[str, list[Moment]]) -> None:
    figure = Figure(figsize=(6.4, 5.6), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True)
    for name, style in (("rough", "0.75"), ("quasi-steady", "k:"), ("smooth", "k-")):
        if name not in found:
            continue
        loaded = [moment for moment in found[name] if moment.fields.route == "mixed"]
        s = [1e3 * (A + ALONG * moment.time) for moment in loaded]
        upper.plot(s, [1e9 * moment.outputs["h_c"] for moment in loaded], style, label=f"h_c, {name}")
        lower.plot(s, [moment.outputs["friction_coefficient"] for moment in loaded], style, label=name)
    for axes in (upper, lower):
        for station in (A, B, C, D, E):
            axes.axvline(1e3 * station, color="0.85", zorder=0, linewidth=0.8)
        axes.legend(fontsize="small")
    upper.set_ylabel("film [nm]")
    lower.set_ylabel("friction coefficient")
    lower.set_xlabel("on the line of action [mm], from A over B, C, D to E")
    figure.savefig(DOCS / "transient.png", dpi=130)


def steps_of_callers() -> list[str]:
    """Table of `advance` with `control.inputs = "transient"`."""
    changes = {"film.points": "65", "film.domain": "0.4 mm", "film.tolerance": "1e-4", "operation.load": "10 N"}
    changes |= SMOOTH | {"control.inputs": "transient", "control.driver": "mixed"}
    scene = Scene.from_toml("mtm_zddp", changes)
    op = replace(scene.operation.point, speed_1=3.2, speed_2=2.8)
    start, duty = advance(scene, op, initial_state(scene), 0.0)[0], duties(scene, op)["speeds x 0.5"]
    lines = [
        '## Steps of a caller: `advance` with `control.inputs = "transient"`',
        "",
        f"Speeds fall by half within {RAMP:g} s; inputs are held over each step of the caller.",
        "",
        "| steps | h_c [nm] | friction [N] | h_c, quasi-steady |",
        "|---|---|---|---|",
    ]
    quasi = replace(scene, control=replace(scene.control, inputs="quasi_steady"))
    for steps in (5, 10, 20, 40, 80):
        row = []
        for each in (scene, quasi):
            state = start
            for k in range(1, steps + 1):
                state, out = advance(each, duty(RAMP * k / steps), state, RAMP / steps)
            row.append(out)
        lines.append(f"| {steps} | {1e9 * row[0].h_c:.2f} | {row[0].friction_force:.4f} | {1e9 * row[1].h_c:.2f} |")
    return [*lines, ""]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rough", action="store_true", help="a mesh of rough flanks, too")
    args = parser.parse_args()
    mesh, found = meshes(args.rough)
    plot(found)
    lines = [
        "# Films that follow load, speeds and radii in time",
        "",
        f"Written by `python -m benchmarks.film.transient{' --rough' if args.rough else ''}`. `contact_core.march` yields the "
        "instants, `contact_core.run_cycle` repeats a sampled cycle; `advance` follows its inputs in time where "
        '`control.inputs = "transient"`.',
        "",
        *sinking(),
        *orders(),
        *trapped(),
        *mesh,
        "![mesh of a tooth](transient.png)",
        "",
        *steps_of_callers(),
        "## Limits",
        "",
        "- A march makes one instant for each node of a rough body.",
        "- A contact at rest without an earlier film has none: a contact that starts at rest is dry (`route`).",
        "- Without a load the contact is open and loses its film; likewise where a film is too wide for the grid. The next load begins with a steady film of any width.",
        "- A load that jumps by ten within a step is solved, but the flow of the oil in that step is of first order.",
        "- The pressure beyond the grid of a light point contact is a formula of rigid bodies (closing and rolling); there is none for lines.",
        "- Bodies have no mass: the load balance holds at every instant.",
        "",
    ]
    save("film/transient", "\n".join(lines))
    print("\n".join(lines))


if __name__ == "__main__":
    main()
