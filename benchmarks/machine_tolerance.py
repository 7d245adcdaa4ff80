"""What half the tolerance and half the step change in the machines' results: the error of their coupling.

    OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1 python benchmarks/machine_tolerance.py [MACHINE ...]

Writes docs/machine_tolerance.md; every machine runs through its own duty, as `tribofmu run` has it.
"""

import sys
import tempfile
import time
from pathlib import Path

from system_models.machine import reading
from system_models.machine.coupling_error import errors, finer
from system_models.master import simulate

DOCS = Path(__file__).parents[1] / "docs"
MACHINES = ("mtm_rig", "bearing_209", "gear_fzg_c")
MOST = 5  # outputs of each that are shown


def rows(name: str) -> list[str]:
    """The largest errors of a machine's outputs."""
    assembly = reading.assemble(reading.read(name))
    begin = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        system = assembly.system(Path(folder))
        both = (assembly.settings, finer(assembly.settings))
        runs = [simulate(system, **{**settings, "outputs": assembly.outputs()}) for settings in both]
    found = errors(*runs, assembly.schedule, assembly.nominals())
    worst = sorted(found, key=found.__getitem__, reverse=True)[:MOST]
    steps = " and ".join(str(run.attrs["steps"]) for run in runs)
    print(name, steps, f"{time.process_time() - begin:.0f} s", flush=True)
    return [f"| {name} | {steps} | {output} | {found[output]:.2%} |" for output in worst]


if __name__ == "__main__":
    lines = [line for name in sys.argv[1:] or MACHINES for line in rows(name)]
    text = f"""# Error of the coupling

Written by `python benchmarks/machine_tolerance.py`. Each machine is simulated as it is shipped, and again with half the
tolerance and half of `step_size` and `max_step`. The coupling is of first order, so its error is twice the difference
(`system_models.machine.coupling_error`): the largest at any time, of any output that a result keeps, over the output's largest
value or a hundredth of its nominal (temperatures in degC). Left out are the first three steps after a change of the duty, in which a jump may lie
anywhere. Of the gears, the coefficients of friction belong to the moment before they are loaded. The {MOST} outputs with the largest error:

| machine | steps | output | error |
|---|---|---|---|
"""
    (DOCS / "machine_tolerance.md").write_text(text + "\n".join(lines) + "\n", "utf-8")
