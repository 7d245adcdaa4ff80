"""Start-stop cycles of ball bearing 209 with and without changes of its surfaces.

python -m benchmarks.machines.bearing_memory
"""

import math
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from benchmarks.pages import Page
from system_models.machines import reading
from system_models.machines.ball_bearing.record import Array, BearingRun
from system_models.master import simulate

MACHINE = "bearing_209_start_stop"
MEMORYLESS = {"contact.tribofilm.model": "none", "contact.wear.bare": "0", "contact.wear.film": "0"}
NO_FILM = {"contact.tribofilm.model": "none"}
SPEEDS = (20.0, 50.0, 100.0)  # rpm
RPM = 30.0 / math.pi
CYCLES = 10
FIRST = 1  # index of the first start on the ramp: the motor is at its speed from the beginning
FEW = {"duty.repeat": str(CYCLES)}


def run(changes: dict[str, str]) -> BearingRun:
    assembly = reading.assemble(reading.read(MACHINE, changes))
    with tempfile.TemporaryDirectory() as folder:
        return BearingRun(
            assembly, simulate(assembly.system(Path(folder)), **assembly.settings, outputs=assembly.outputs())
        )


def torque_at(found: BearingRun, rpm: float) -> Array:
    """Friction torque [N m] of each start at a speed on the way up."""
    torque, speed = found.of("bearing.friction_torque"), found.speed * RPM
    return np.array([np.interp(rpm, speed[rows], torque[rows]) for rows in found.starts])


def of_starts(found: BearingRun, contact: str, name: str) -> Array:
    """Outputs of a contact at the end of each start."""
    return np.array([found.of(f"{contact}.{name}")[rows[-1]] for rows in found.starts])


def tables(report: Page, runs: dict[str, BearingRun]) -> None:
    report.say(
        "### Friction torque of the starts\n\nN mm, at speeds on the way up. The first start is abrupt, as the motor has its speed from the beginning; the later ones differ in their surfaces only and are compared."
    )
    report.header("start", *(f"{kind}, {rpm:g} rpm" for rpm in SPEEDS for kind in runs))
    columns = [1e3 * torque_at(found, rpm) for rpm in SPEEDS for found in runs.values()]
    count = len(columns[0])
    for k in sorted({0, 1, 2, 4, 9, count - 1}):
        report.row(k + 1, *(float(column[k]) for column in columns))
    full, bare = (1e3 * torque_at(runs[kind], SPEEDS[1]) for kind in ("memory", "none"))
    grown, still = full[-1] / full[FIRST] - 1.0, bare[-1] / bare[FIRST] - 1.0
    step = abs(1e3 * torque_at(runs["memory, half the steps"], SPEEDS[1])[-1] - full[-1])
    apart = abs(full[-1] - bare[-1])
    report.verdict(
        "memory changes the torque from start to start",
        f"{grown:+.1%} at 50 rpm from the second to the last",
        abs(grown) > 0.02,
    )
    report.verdict("without memory it stays", f"{still:+.1%}", abs(still) < 0.25 * abs(grown))
    report.verdict(
        "the difference is above what the steps' size does", f"{apart:.3g} over {step:.2g} N mm", apart > 3 * step
    )


def growth(report: Page, found: BearingRun) -> None:
    top = found.bearing.levels
    report.say(
        "### Surfaces\n\nAt the end of starts, of the most loaded classes. Film, wear and roughness in nm; solids: load that "
        "they carry at the speed reached."
    )
    names = ("tribofilm_1", "tribofilm_2", "wear_depth_1", "wear_depth_2", "roughness_2")
    heads = ("film, ball", "film, ring", "wear, ball", "wear, ring", "roughness, ring")
    report.header("contact", "start", *heads, "lambda", "solids")
    for race in ("inner", "outer"):
        contact = f"{race}_{top}"
        columns = [1e9 * of_starts(found, contact, name) for name in names]
        ratio, solids = (of_starts(found, contact, name) for name in ("lambda_ratio", "contact_load_ratio"))
        for k in sorted({0, 1, 4, 9, len(ratio) - 1}):
            report.row(contact, k + 1, *(float(column[k]) for column in columns), float(ratio[k]), float(solids[k]))


def picture(report: Page, runs: dict[str, BearingRun]) -> None:
    found, colours = runs["memory"], {"inner": "#0072B2", "outer": "#D55E00"}
    figure = Figure(figsize=(11.0, 7.0), layout="constrained")
    torque, starts, film, wear = figure.subplots(2, 2).flat
    for (kind, each), style in zip(runs.items(), ("-", "--", ":", "-."), strict=False):
        if "steps" in kind:
            continue
        for rpm, colour in zip(SPEEDS, ("black", "#009E73", "#CC79A7"), strict=True):
            values = 1e3 * torque_at(each, rpm)
            label = {"memory": "memory", "no film": "wear only", "none": "without memory"}[kind]
            torque.plot(
                range(FIRST + 1, len(values) + 1), values[FIRST:], style, color=colour, label=f"{rpm:g} rpm, {label}"
            )
    torque.set(xlabel="start", ylabel="friction torque [N mm]")
    torque.legend(frameon=False, fontsize=7, ncols=3)
    own, speed = 1e3 * found.of("bearing.friction_torque"), found.speed * RPM
    for k in (FIRST, len(found.starts) // 2, len(found.starts) - 1):
        rows = found.starts[k][1:]
        starts.loglog(
            speed[rows], own[rows], label=f"start {k + 1}", color=str(0.7 * (1 - k / (len(found.starts) - 1)))
        )
    starts.set(xlabel="speed [rpm]", ylabel="friction torque [N mm]")
    starts.legend(frameon=False, fontsize=8)
    for axes, name, label in ((film, "tribofilm", "mean tribofilm [nm]"), (wear, "wear_depth", "mean wear depth [nm]")):
        for race, colour in colours.items():
            for body, what, style in ((1, "ball", "-"), (2, "ring", "--")):
                values = 1e9 * of_starts(found, f"{race}_{found.bearing.levels}", f"{name}_{body}")
                axes.plot(range(1, len(values) + 1), values, style, color=colour, label=f"{what}, {race} race")
        axes.set(xlabel="start", ylabel=label)
        axes.legend(frameon=False, fontsize=8)
    wear.set_yscale("log")
    for axes in (torque, starts, film, wear):
        axes.spines[["top", "right"]].set_visible(False)
    report.picture(figure, "bearing_memory.png", "friction torque, tribofilm and wear from start to start")


def main() -> None:
    report = Page("machines/bearing_memory", "Run-in surfaces of a ball bearing from start to start")
    runs = {"memory": run(FEW), "no film": run(FEW | NO_FILM), "none": run(FEW | MEMORYLESS)}
    runs["memory, half the steps"] = run(FEW | {"simulate.max_step": "0.25 s"})
    report.say(
        f"`{MACHINE}`: 209 under 4 kN with thin oil at 90 degC, from standstill to 200 rpm and back, {CYCLES} times. 'no film': wear, but no tribofilm; 'none': neither. Mechanisms: the tribofilm lowers the solids' own friction, from "
        "0.13 to 0.115 under a full film, and wear with it; it also makes the surfaces rougher, as it lies on their heights. The solids then carry more load at a given speed, which raises friction in mixed lubrication and outweighs the first effect. Wear of less than a nanometre smooths: the torque falls slightly. The regression level has no plastic smoothing."
    )
    picture(report, runs)
    tables(report, runs)
    growth(report, runs["memory"])
    report.write()


if __name__ == "__main__":
    main()
