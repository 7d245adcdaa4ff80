"""The stated error of the coupling of machines, compared with simulations with far shorter steps.

    OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1 python -m benchmarks.machines.tolerance [MACHINE ...]

Simulations are kept in results/machines/tolerance, so a run can be taken up again. Writes
docs/measured/machines.md of all machines that are there.
"""

import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from benchmarks.claims import kept
from benchmarks.pages import save
from system_models.machines import reading
from system_models.machines.assembly import Assembly
from system_models.machines.coupling_error import coarser, differences, relative, settled, stated
from system_models.master import simulate

SECTION = "machines/tolerance"
# up to which time of its duty each is simulated, and into how many parts its steps are cut for the truth
MACHINES = {
    "mtm_rig": ("", 8),
    "bearing_209": ("", 4),
    "bearing_218": ("", 4),
    "gear_fzg_c": ("32 min", 8),
    "gear_fzg_a": ("32 min", 8),
    "cam_follower": ("", 4),
}
MOST = 5  # outputs of each that are shown
SMALL = 1e-3  # of the largest value: changes that nobody sees


def assembled(name: str) -> Assembly:
    """A machine with the part of its duty that is simulated."""
    end = MACHINES[name][0]
    return reading.assemble(reading.read(name, {"simulate.stop_time": end} if end else {}))


def finer(run: xr.Dataset, settings: Mapping[str, Any], parts: int) -> dict[str, Any]:
    """Each step of a result in so many."""
    times = run["time"].values
    points = [times[:-1] + np.diff(times) * k / parts for k in range(1, parts)]
    same = {key: value for key, value in settings.items() if key in ("stop_time", "step_size", "algorithm", "order")}
    return {**same, "points": np.unique(np.concatenate([*points, times[1:]])).tolist()}


def simulated(name: str) -> None:
    """Make those simulations of a machine that are not there."""
    assembly, parts = assembled(name), MACHINES[name][1]
    with tempfile.TemporaryDirectory() as folder:
        system = assembly.system(Path(folder))

        def made(kind: str, settings: Mapping[str, Any]) -> xr.Dataset:
            path = kept(SECTION) / f"{name}_{kind}.nc"
            if not path.exists():
                found = simulate(system, **{**settings, "outputs": assembly.outputs()})
                found.to_netcdf(path.with_suffix(".new"))
                path.with_suffix(".new").replace(path)
                print(name, kind, found.attrs["steps"], flush=True)
            return xr.load_dataset(path)

        run = made("run", assembly.settings)
        made("coarse", coarser(run, assembly.settings, assembly.schedule))
        made("fine", finer(run, assembly.settings, parts))


def rows(name: str) -> tuple[str, list[str]]:
    """A line for a machine, and lines for the outputs with the largest errors and those that are not covered."""
    assembly, (end, parts) = assembled(name), MACHINES[name]
    run, coarse, fine = (xr.load_dataset(kept(SECTION) / f"{name}_{kind}.nc") for kind in ("run", "coarse", "fine"))
    times = settled(coarse, assembly.schedule)
    run = stated(run, coarse, assembly.schedule)
    found = relative(run, assembly.nominals())
    scales = {key: run[key].attrs["error_coupling"] / error for key, error in found.items() if error}
    change = {key: value / scales[key] for key, value in differences(run, fine, times).items() if key in scales}
    more, tenth = ([key for key in scales if change[key] > max(part * found[key], SMALL)] for part in (1.0, 0.1))
    worst = max(scales, key=lambda key: change[key] / found[key] if change[key] > SMALL else 0.0)
    line = (
        f"| {name}{f', first {end}' if end else ''} | {coarse.attrs['steps']}, {run.attrs['steps']}, "
        f"{fine.attrs['steps']} | 1/{parts} | {len(found)} | {np.median([*found.values()]):.2%} "
        f"| {max(found.values()):.1%} | {max(change.values()):.1%} | {len(more)} "
        f"| {found[worst]:.2%}, {change[worst]:.2%} | {len(tenth)} |"
    )
    shown = {*sorted(scales, key=found.__getitem__, reverse=True)[:MOST], *more}
    return line, [f"| {name} | {key} | {found[key]:.2%} | {change[key]:.2%} |" for key in sorted(shown)]


def page() -> str:
    """The page of all machines that were simulated."""
    there = [name for name in MACHINES if (kept(SECTION) / f"{name}_fine.nc").exists()]
    missing = [name for name in MACHINES if name not in there]
    pairs = [rows(name) for name in there]
    lacks = f"\n\nNot compared yet: {', '.join(missing)}." if missing else ""
    return f"""# Error of the coupling

Written by `python -m benchmarks.machines.tolerance`.

`tribofmu run` simulates each machine a second time, with every second of its communication points. The coupling is of
first order, so the difference would be the error of the result if steps were short enough. Two step sizes cannot
prove this. Therefore three times the difference is stated for each output (`system_models.machines.coupling_error`),
the largest at any time, and at least any jump of the output in one step by less than a tenth of its largest value,
since finer steps may have it in another step. It is the attribute `error_coupling` in result.nc.

The first three double steps after a change of the duty are left out, and three on either side of a jump of an output
by more than a tenth of its largest value: the time of such a jump within a step is not resolved, and the error there
may be as large as the output.

Test: each machine is simulated again with every step divided by four or eight, as given in the table. The change is
the error except for a quarter or an eighth of it. Errors and changes are relative to the output's largest value or,
if that is more, a hundredth of its nominal (temperatures in degC). An output counts as not covered from {SMALL:.1%}
on. The last column counts those that a tenth of the stated error would not cover.{lacks}

| machine | steps: double, as shipped, shortest | cut | outputs | stated, median | largest | largest change | not covered | worst ratio: stated, change | not covered by a tenth |
|---|---|---|---|---|---|---|---|---|---|
{chr(10).join(line for line, _ in pairs)}

The {MOST} outputs of each with the largest error stated, and all that are not covered:

| machine | output | stated | changed by the shortest steps |
|---|---|---|---|
{chr(10).join(line for _, lines in pairs for line in lines)}
"""


if __name__ == "__main__":
    for machine in sys.argv[1:] or MACHINES:
        simulated(machine)
    save(SECTION, page())
