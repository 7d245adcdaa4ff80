"""1000 h of the duty of `gear_fzg_c` with native FMUs, with the bound of the error.

python -m benchmarks.machines.thousand_hours

The duty of 97 h is repeated. Two parts make up the error. That of the regression level is stated by every contact, as
the half width (95 %) of its outputs. That of the time steps is stated as `tribofmu run` does it, from a second
simulation with steps of double size, and tested here by a third one with steps of half the size. A part of the duty is
simulated by FMUs in Python, too.
"""

import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from benchmarks.machines.tolerance import finer
from benchmarks.pages import Page
from system_models.machines import reading
from system_models.machines.assembly import Assembly
from system_models.machines.coupling_error import ATTRIBUTE, coarser, stated
from system_models.machines.gear_pair.mesh import flank
from system_models.master import System, simulate

MACHINE, HOURS, CYCLE = "gear_fzg_c", 1000.0, 97.0
TO_COMPARE = 10.0  # h, of the Python level: 1 h of load stage 3, then load stage 5
MOST_MINUTES = 10.0
HOUR, MICRO = 3600.0, 1e6
SAME = 1e-7  # of the largest value: what two levels of one arithmetic may differ by over hours
BODIES = {1: "pinion", 2: "wheel"}


class Reported(NamedTuple):
    """An output of the page: its name, how it is shown, the factor and the unit that it is shown in."""

    output: str
    text: str
    factor: float
    unit: str


def reported(run: xr.Dataset, assembly: Assembly) -> list[Reported]:
    """The outputs of the page, of those flanks that are worn most."""
    found = []
    for body, gear in BODIES.items():
        last = {name: float(run[f"{name}.wear_depth_{body}"].values[-1]) for name in assembly.contacts}
        worst = max(last, key=last.__getitem__)
        place = f"{gear}, at {worst} of {flank(len(last))}"
        found += [
            Reported(f"{worst}.wear_depth_{body}", f"wear depth of the {place}", MICRO, "um"),
            Reported(f"{worst}.roughness_{body}", f"roughness of the {place}", MICRO, "um"),
            Reported(f"{worst}.tribofilm_{body}", f"tribofilm on the {place}", 1e9, "nm"),
        ]
    return [*found, Reported("mesh.power_loss", "power loss of the mesh", 1.0, "W")]


def assembled(hours: float) -> Assembly:
    """The machine, its duty repeated as often as it takes."""
    repeat = str(int(np.ceil(hours / CYCLE)))
    return reading.assemble(reading.read(MACHINE, {"duty.repeat": repeat, "simulate.stop_time": f"{hours!r} h"}))


def simulated(assembly: Assembly, system: System, settings: Mapping[str, Any]) -> tuple[xr.Dataset, float]:
    """A result, and the seconds that it took."""
    begin = time.perf_counter()
    found = simulate(system, **{**settings, "outputs": assembly.outputs()})
    return found, time.perf_counter() - begin


def compared(folder: Path) -> tuple[float, float, float]:
    """Seconds of the Python level and of C for a part of the duty; largest difference over the output's largest value."""
    assembly, runs = assembled(TO_COMPARE), []
    for flavour in ("embedded", "native"):
        system = assembly.system(folder / flavour, flavour, here=True)
        runs.append(simulated(assembly, system, assembly.settings))
    (python, slow), (native, fast) = runs
    names = [
        name for name in python.data_vars if python[name].dtype.kind == "f" and not str(name).startswith("master.")
    ]
    apart = [
        float(np.abs(python[name].values - native[name].values).max() / np.abs(python[name].values).max())
        for name in names
        if np.any(python[name].values)
    ]
    return slow, fast, max(apart)


def half_width(run: xr.Dataset, output: str) -> float:
    """The half width (95 %) at the end that the contact states, in the output's unit; 0 if it states none."""
    name = f"{output}_error"
    return float(run[name].values[-1]) if name in run.coords else 0.0


def picture(report: Page, run: xr.Dataset, shown: list[Reported]) -> None:
    """Draw wear with its error, roughness and film, against time."""
    figure, hours = Figure(figsize=(11.0, 7.0), layout="constrained"), run["time"].values / HOUR
    for axes, name in zip(
        figure.subplots(2, 2).flat, ("wear_depth", "roughness", "tribofilm", "power_loss"), strict=True
    ):
        for each in shown:
            if name not in each.output:
                continue
            values = each.factor * run[each.output].values
            (line,) = axes.plot(hours, values, label=each.text)
            if f"{each.output}_error" in run.coords:
                width = each.factor * run[f"{each.output}_error"].values
                axes.fill_between(
                    hours, np.maximum(values - width, 0.0), values + width, color=line.get_color(), alpha=0.15
                )
            axes.set_ylabel(f"{each.text.split(' of ')[0].split(' on ')[0]} [{each.unit}]")
        axes.set_xlabel("time [h]")
        axes.legend(fontsize="small")
    report.picture(
        figure, "thousand_hours.png", "wear, roughness, tribofilm and loss against time, shaded: half widths stated"
    )


def main() -> None:
    """Simulate, compare and write the page."""
    report = Page("machines/thousand_hours", "1000 h of a gear pair")
    assembly = assembled(HOURS)
    with tempfile.TemporaryDirectory() as name:
        folder, begin = Path(name), time.perf_counter()
        system = assembly.system(folder / "fmus", "native", here=True)
        built = time.perf_counter() - begin
        run, seconds = simulated(assembly, system, assembly.settings)
        coarse, of_coarse = simulated(assembly, system, coarser(run, assembly.settings, assembly.schedule))
        run = stated(run, coarse, assembly.schedule)
        fine, of_fine = simulated(assembly, system, finer(run, assembly.settings, 2))
        slow, fast, apart = compared(folder)
    shown = reported(run, assembly)
    report.say(
        f"{HOURS:g} h, {len(assembly.contacts)} contacts and {len(assembly.parts)} components, all of them native FMUs in "
        f"one process with the master of this project: {run.attrs['steps']} steps of up to "
        f"{assembly.settings['max_step'] / 60.0:g} min in {seconds:.0f} s, {HOURS * HOUR / seconds:,.0f} times as fast as "
        f"the machine. Their sources were generated and compiled in {built:.0f} s before. The simulation with double steps "
        f"took {of_coarse:.0f} s, that with steps of half the size {of_fine:.0f} s."
    )
    report.say(
        "At the end of the test. Half width (95 %): of the regression level, as the contact states it. Time steps: three "
        "times the largest change at any time with steps of double size. Test: the change at the end with half of them."
    )
    report.header("output", "unit", "value", "half width", "time steps", "test")
    covered = True
    for each in shown:
        value, change = (each.factor * float(r[each.output].values[-1]) for r in (run, fine))
        steps = each.factor * float(run[each.output].attrs.get(ATTRIBUTE, np.nan))
        covered &= abs(change - value) <= steps
        half = each.factor * half_width(run, each.output)
        report.row(each.text, each.unit, value, half or "not stated", steps, abs(change - value))
    picture(report, run, shown)
    report.say(
        f"The first {TO_COMPARE:g} h by FMUs in Python: {slow:.0f} s, by native ones {fast:.1f} s, {slow / fast:.0f} times "
        f"as fast. No output differs by more than {apart:.1e} of its largest value, at any time."
    )
    minutes = (built + seconds + of_coarse) / 60.0
    report.verdict(
        f"1000 h under {MOST_MINUTES:g} min, with the bound of the error",
        f"{minutes:.1f} min, built and with double steps",
        minutes < MOST_MINUTES,
    )
    report.verdict("the error of the time steps is covered", "test column", covered)
    report.verdict("the same answers as in Python", f"to {apart:.1e}", apart < SAME)
    report.write()


if __name__ == "__main__":
    main()
