"""The MTM rig at both fidelity levels over a whole run: differences, stated errors, cost.

    OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1 python -m benchmarks.machines.rig_levels

The machine `mtm_rig` rubs for two hours; before, after 30 min and at the end it runs through SPEEDS. Writes
docs/measured/machines/rig_levels.md and docs/measured/machines/rig_levels.png. Results are kept in results/machines/rig_levels: what is there of the same system is
not simulated again, and what was interrupted goes on.
"""

import json
import time
from itertools import pairwise

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from benchmarks.dependencies import kept
from benchmarks.folders import MEASURED
from benchmarks.pages import save
from contact_core.quantities import LEVELS as KNOWN
from system_models.machines import reading
from system_models.machines.assembly import Assembly
from system_models.machines.ball_on_disc import report as ball_on_disc_report
from system_models.master import simulate
from system_models.master.saving import identity
from system_models.store import results

LEVELS = KNOWN[:2]  # that are compared
DOCS, KEPT = MEASURED / "machines", kept("machines/rig_levels")
SPEEDS = (2.0, 0.5, 0.12, 0.03, 0.01)  # of entrainment in a sweep [m/s]
HELD, SWEPT_SRR = 10.0, 0.5  # s at each; slide-to-roll ratio
RUBBED = (0.0, 1800.0, 7200.0)  # s, before the sweeps
CONTACT = "contact"
# variable, what it is called, factor and unit for people, error output that covers it
SHOWN = (
    ("friction_coefficient", "friction coefficient", 1.0, "", "error_friction"),
    ("h_c", "central film thickness", 1e9, "nm", "error_film"),
    ("tribofilm_1", "tribofilm, ball", 1e9, "nm", ""),
    ("tribofilm_2", "tribofilm, disc", 1e9, "nm", ""),
    ("wear_depth_1", "wear depth, ball", 1e9, "nm", "error_wear"),
    ("wear_depth_2", "wear depth, disc", 1e9, "nm", "error_wear"),
    ("roughness_1", "roughness, ball", 1e9, "nm", ""),
    ("roughness_2", "roughness, disc", 1e9, "nm", ""),
)
COLOURS = {LEVELS[0]: "#0072B2", LEVELS[1]: "#D55E00"}


def duty() -> dict[str, object]:
    """The table [duty]."""
    steps, now = [], 0.0
    for before, rubbed in pairwise((*RUBBED[:1], *RUBBED)):
        if rubbed > before:
            steps.append((now, "0.1 m/s", 0.05))
            now += rubbed - before
        for speed in SPEEDS:
            steps.append((now, f"{speed} m/s", SWEPT_SRR))
            now += HELD
    rows = [{"time": f"{t} s", "entrainment_speed": u, "slide_roll_ratio": ratio} for t, u, ratio in steps]
    start = {key: value for key, value in rows.pop(0).items() if key != "time"}
    still = {"load": "53.7 N", "temperature": "80 degC", "ambient": "25 degC"}
    return {"duration": f"{now} s", **still, **start, "steps": rows}


def assembled(level: str) -> Assembly:
    """The rig with its contact at a level."""
    machine = reading.read("mtm_rig")
    machine.table["duty"] = duty()
    machine.table["deterministic"] = [CONTACT] if level == LEVELS[1] else []
    return reading.assemble(machine)


def run(level: str) -> xr.Dataset:
    """The run at a level: as it is kept, or simulated."""
    folder = KEPT / level
    folder.mkdir(parents=True, exist_ok=True)
    assembly = assembled(level)
    settings = {**assembly.settings, "outputs": assembly.outputs()}
    system = assembly.system(folder / "fmus")
    origin = {"simulation_json": json.dumps(identity(system, settings))}
    kept = results.find(origin, folder)
    if kept is not None:
        return kept
    begin = time.process_time()
    dataset = simulate(system, **settings, checkpoint=folder, resume=(folder / "checkpoint.tribofmu").exists())
    dataset = dataset.assign_attrs({**origin, "cpu_seconds": time.process_time() - begin})
    results.write(dataset, folder)
    return dataset


def on(times: np.ndarray, dataset: xr.Dataset, name: str) -> np.ndarray:
    """A variable of the contact at other times."""
    return np.interp(times, dataset["time"].values, dataset[f"{CONTACT}.{name}"].values)


def compared(fast: xr.Dataset, deep: xr.Dataset, name: str, error: str) -> list[str]:
    """A row of the table: differences over the largest value, and how much of the time stated errors cover them."""
    times, size = deep["time"].values, deep["master.step_size"].values
    ours, solved = on(times, fast, name), deep[f"{CONTACT}.{name}"].values
    difference, largest = np.abs(ours - solved), np.abs(solved).max()
    mean = float(size @ difference) / float(size @ np.abs(solved))
    cells = [f"{mean:.1%}", f"{difference.max() / largest:.1%}", f"{(ours[-1] - solved[-1]) / solved[-1]:+.1%}"]
    if not error:
        return [*cells, "-", "-"]
    half = on(times, fast, error) * np.abs(ours) + deep[f"{CONTACT}.{error}"].values * np.abs(solved)
    covered = float(size @ (difference <= half)) / float(size.sum())
    return [*cells, f"{np.median(on(times, fast, error)):.0%}", f"{covered:.0%}"]


def page(fast: xr.Dataset, deep: xr.Dataset) -> str:
    """docs/measured/machines/rig_levels.md."""
    both = dict(zip(LEVELS, (fast, deep), strict=True))
    cost = {level: json.loads(run.attrs["cost"])[CONTACT] for level, run in both.items()}
    span = float(deep["time"].values[-1])
    costs = [
        f"| {level} | {both[level].attrs['cpu_seconds']:.1f} | {entry['steps']} | {entry['seconds']:.1f} | "
        f"{span / both[level].attrs['cpu_seconds']:.0f} |"
        for level, entry in cost.items()
    ]
    rows = [f"| {text} | {' | '.join(compared(fast, deep, name, error))} |" for name, text, _, _, error in SHOWN]
    found = [ball_on_disc_report.sweeps(assembled(level), run) for level, run in both.items()]
    curves = [
        f"| {one.rubbed / 60.0:g} | {hold.entrainment_speed:g} | {a:.4f} | {b:.4f} | {a / b - 1.0:+.1%} |"
        for one, other in zip(*found, strict=True)
        for hold, i, j in zip(one.holds, one.rows, other.rows, strict=True)
        for a, b in [(friction(fast)[i], friction(deep)[j])]
    ]
    return "\n".join(
        [
            "# The MTM rig at both levels",
            "",
            "Written by `python -m benchmarks.machines.rig_levels`, which describes the run: the machine `mtm_rig` over two hours of",
            f"rubbing with {len(RUBBED)} sweeps, its contact once at the regression and once at the deterministic level, on the scene's own grid. Everything else is equal. One process, one thread, on a shared machine.",
            "",
            "![Both levels against time](rig_levels.png)",
            "",
            "| level | CPU time [s] | steps of the contact | in them [s of the clock] | times as fast as the rig |",
            "|---|---|---|---|---|",
            *costs,
            "",
            "Steps include rejected ones; a deterministic step solves as many blocks as its time needs.",
            "",
            "Differences over the whole run: their mean over the mean of the deterministic value, the largest over its",
            "largest value, and that at the end. Stated: median half width of the error output of the regression level; covered: share",
            "of the time in which the errors of both levels cover the difference.",
            "",
            "| | mean | largest | at the end | stated | covered |",
            "|---|---|---|---|---|---|",
            *rows,
            "",
            "Friction in the sweeps, at the end of each speed:",
            "",
            "| rubbed [min] | speed [m/s] | fast | deterministic | difference |",
            "|---|---|---|---|---|",
            *curves,
            "",
        ]
    )


def friction(dataset: xr.Dataset) -> np.ndarray:
    """Friction coefficients."""
    return np.asarray(dataset[f"{CONTACT}.friction_coefficient"].values)


def figure(fast: xr.Dataset, deep: xr.Dataset) -> Figure:
    """Both levels: the Stribeck curves, and all of SHOWN against time; the regression level's stated errors as bands."""
    drawn = Figure(figsize=(10.0, 12.0), layout="constrained")
    axes = drawn.subplots(5, 2).ravel()
    for axis, (name, text, factor, unit, error) in zip(axes, SHOWN, strict=False):
        for level, run in zip(LEVELS, (fast, deep), strict=True):
            values = factor * run[f"{CONTACT}.{name}"].values
            minutes = run["time"].values / 60.0
            axis.plot(minutes, values, color=COLOURS[level], linewidth=1.1, label=level)
            if error and run is fast:
                half = run[f"{CONTACT}.{error}"].values * values
                axis.fill_between(
                    minutes, values - half, values + half, color=COLOURS[level], alpha=0.15, linewidth=0.0
                )
        axis.set(xlabel="time [min]", ylabel=text + (f" [{unit}]" if unit else ""), xlim=(0.0, minutes[-1]))
        axis.set_ylim(0.0, 1.6 * factor * float(deep[f"{CONTACT}.{name}"].max()))
    for level, run in zip(LEVELS, (fast, deep), strict=True):
        for style, sweep in zip(("o-", "s--", "^:"), ball_on_disc_report.sweeps(assembled(level), run), strict=True):
            speeds, rows = [hold.entrainment_speed for hold in sweep.holds], list(sweep.rows)
            label = f"{level}, {sweep.rubbed / 60.0:g} min"
            for axis, name in ((axes[-2], "friction_coefficient"), (axes[-1], "h_c")):
                values = run[f"{CONTACT}.{name}"].values[rows] * (1.0 if name != "h_c" else 1e9)
                axis.semilogx(speeds, values, style, color=COLOURS[level], markersize=3.5, linewidth=1.1, label=label)
    for axis, text in zip(axes[-2:], ("friction in sweeps", "h_c in sweeps [nm]"), strict=True):
        axis.set(xlabel="entrainment speed [m/s]", ylabel=text, ylim=(0.0, None))
    axes[0].legend(frameon=False, fontsize="small")
    axes[-2].legend(frameon=False, fontsize="x-small")
    for axis in axes:
        axis.spines[["top", "right"]].set_visible(False)
    drawn.align_ylabels()
    return drawn


if __name__ == "__main__":
    runs = [run(level) for level in LEVELS]
    save("machines/rig_levels", page(*runs))
    figure(*runs).savefig(DOCS / "rig_levels.png", dpi=120)
