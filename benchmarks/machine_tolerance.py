"""The error of the coupling that machines state, beside what finer simulations change.

    OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1 python benchmarks/machine_tolerance.py [MACHINE ...]

Writes docs/machine_tolerance.md; every machine runs through its own duty, as `tribofmu run` has it.
"""

import sys
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from system_models.machine import reading
from system_models.machine.coupling_error import coarser, differences, relative, settled, stated
from system_models.master import simulate

DOCS = Path(__file__).parents[1] / "docs"
MACHINES = ("mtm_rig", "bearing_209", "bearing_218", "gear_fzg_c", "gear_fzg_a")
MOST = 5  # outputs of each that are shown
SMALL = 1e-3  # of the largest value: changes that nobody sees


def finer(run: xr.Dataset, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Steps of half the size of those of a result."""
    times = run["time"].values
    points = np.sort(np.concatenate([times[1:], 0.5 * (times[1:] + times[:-1])]))
    same = {key: value for key, value in settings.items() if key in ("stop_time", "step_size", "algorithm", "order")}
    return {**same, "points": points.tolist()}


def rows(name: str) -> tuple[str, list[str]]:
    """A line for a machine, and lines for the outputs with the largest errors."""
    assembly = reading.assemble(reading.read(name))
    given, schedule = assembly.settings, assembly.schedule
    begin = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        system = assembly.system(Path(folder))

        def simulated(settings: Mapping[str, Any]) -> xr.Dataset:
            return simulate(system, **{**settings, "outputs": assembly.outputs()})

        run = simulated(given)
        coarse = simulated(coarser(run, given, schedule))
        halved, fine = simulated({**given, "tolerance": 0.5 * given["tolerance"]}), simulated(finer(run, given))
    times = settled(coarse, schedule)
    run = stated(run, coarse, schedule)
    found = relative(run, assembly.nominals())
    scales = {key: run[key].attrs["error_coupling"] / error for key, error in found.items() if error}
    changes = [
        {key: change / scales[key] for key, change in differences(run, other, times).items() if key in scales}
        for other in (halved, fine)
    ]
    more = [[key for key in scales if change[key] > max(found[key], SMALL)] for change in changes]
    steps = ", ".join(str(each.attrs["steps"]) for each in (coarse, run, halved, fine))
    print(name, steps, *more, f"{time.process_time() - begin:.0f} s", flush=True)
    largest = [max(change.values()) for change in changes]
    line = (
        f"| {name} | {steps} | {len(found)} | {np.median([*found.values()]):.2%} | {max(found.values()):.1%} "
        f"| {largest[0]:.1%} | {len(more[0])} | {largest[1]:.1%} | {len(more[1])} |"
    )
    worst = {*sorted(scales, key=found.__getitem__, reverse=True)[:MOST], *more[0], *more[1]}
    return line, [
        f"| {name} | {key} | {found[key]:.2%} | {changes[0][key]:.2%} | {changes[1][key]:.2%} |"
        for key in sorted(worst)
    ]


if __name__ == "__main__":
    pairs = [rows(name) for name in sys.argv[1:] or MACHINES]
    text = f"""# Error of the coupling

Written by `python benchmarks/machine_tolerance.py`.

`tribofmu run` simulates each machine a second time, at every second of its communication points. The coupling is of
first order, so the difference is the error of the result; one and a half times the difference is stated for each output
(`system_models.machine.coupling_error`): the largest at any time, as the attribute `error_coupling` in result.nc. Left out are the first three of the double
steps after a change of the duty, and three on either side of where an output jumps by more than a tenth of its largest value:
where in a step a jump lies is not resolved.

Does it hold? Each machine is simulated as it is shipped, with half the tolerance, and with half of each step, which halves
the error. Errors and changes are relative to the output's largest value or, if that is more, a hundredth of its nominal
(temperatures in degC). An output counts as changing by more than is stated from {SMALL:.1%} on.

| machine | steps: double, as shipped, half the tolerance, half | outputs | stated, median | largest | largest change by half the tolerance | by more than stated | largest change by half the steps | by more than stated |
|---|---|---|---|---|---|---|---|---|
{chr(10).join(line for line, _ in pairs)}

The {MOST} outputs with the largest error stated, and all that change by more:

| machine | output | stated | half the tolerance | half the steps |
|---|---|---|---|---|
{chr(10).join(line for _, lines in pairs for line in lines)}
"""
    (DOCS / "machine_tolerance.md").write_text(text, "utf-8")
