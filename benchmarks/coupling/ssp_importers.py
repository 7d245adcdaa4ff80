"""Exported SSP files of all kinds of machines in every importer, compared with the master.

    python -m benchmarks.coupling.ssp_importers

Writes docs/measured/coupling.md. Importers take fixed steps, hold inputs, and set them all at the end of a step: Jacobi of
order 0, which the master takes for comparison, with the very FMUs of the file. What is too little to tell is the
coupling's error: how far the master's own answers are apart, with these steps, with double ones, and as the machine's
file has it, by Gauss-Seidel under error control. `pip install ".[importers]"` brings fmpy, libcosimpy and ecospy;
OMSimulator is found as benchmarks/hosts/omsimulator.py says. What is not installed is left out, and the page says so.
The exit code is 1 if an importer, other than fmpy with its first step, is off by more.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.hosts import omsimulator, ssp_runner
from benchmarks.hosts.ssp_runner import IMPORTERS, UNUSABLE
from benchmarks.pages import save
from fmu_src.flavours import Flavour
from system_models.machines import reading
from system_models.machines.export import with_timetable
from system_models.master import System, export_ssp, simulate

RUNNER = Path(ssp_runner.__file__)
OMSIMULATOR = "OMSimulator"
LEAST = 1e-6  # of a value: what is told of its error
STARTS_AT_ZERO = "fmpy"  # sets all connected inputs to zero for the first step
BEARING = (
    "bearing.friction_torque",
    "bearing.load_max",
    "shaft.speed",
    "housing.temperature_balls",
    "housing.temperature_inner",
    "housing.temperature_oil",
    "inner_2.friction_force",
)
GEARS = (
    "mesh.power_loss",
    "shafts.speed_1",
    "brake.torque",
    "gearbox.temperature_pinion",
    "gearbox.temperature_oil",
    "flank_03.friction_force",
    "flank_03.load",
)
RIG = (
    "arm.load",
    "ball.surface_speed",
    "disc.torque",
    "bath.temperature_oil",
    "contact.friction_force",
    "contact.wear_volume_2",
)


class Case(NamedTuple):
    """A machine, how many steps of which size [s], the values compared at their end, and the flavour of its contacts."""

    machine: str
    step: float
    steps: int
    names: tuple[str, ...]
    flavour: Flavour = "isolated"

    @property
    def end(self) -> float:
        """The time of the comparison [s]."""
        return self.steps * self.step


# steps are whole numbers of nanoseconds without rounding; the rig's duty jumps every 10 s, where it would only matter
# on which side a value is taken
CASES = (
    Case("bearing_209", 0.125, 160, BEARING),
    Case("bearing_218", 0.125, 160, BEARING),
    Case("gear_fzg_c", 0.125, 80, GEARS),
    Case("gear_fzg_a", 0.125, 80, GEARS),
    Case("gear_fzg_a", 0.0625, 160, GEARS),
    Case("mtm_rig", 0.125, 150, RIG),
    Case("mtm_rig", 0.125, 150, RIG, "native"),
)


class Answer(NamedTuple):
    """The end values of one importer, or why there are none, and what it took."""

    values: list[float] | None
    why: str
    seconds: float


def own(system: System, settings: dict[str, Any], case: Case) -> list[float]:
    """The master's answer."""
    dataset = simulate(system, case.end, outputs=case.names, **settings)
    return [float(dataset[name].values[-1]) for name in case.names]


def ours(system: System, settings: dict[str, Any], case: Case) -> tuple[list[float], list[float]]:
    """The master's answer by the importers' algorithm, and the coupling's error of each value."""
    theirs = [own(system, {"step_size": n * case.step, "algorithm": "jacobi", "order": 0}, case) for n in (1, 2)]
    given = own(system, {key: value for key, value in settings.items() if key != "stop_time"}, case)
    columns = zip(*theirs, given, strict=True)
    return theirs[0], [max(max(found) - min(found), LEAST * abs(found[0])) for found in columns]


def answered(importer: str, file: Path, case: Case) -> Answer:
    """Return the values of an importer for the file."""
    begin = time.perf_counter()
    if importer == OMSIMULATOR:
        if omsimulator.program() is None:
            return Answer(None, "not installed", 0.0)
        values = omsimulator.end_values(file, case.end, list(case.names))
        return Answer(values, "", time.perf_counter() - begin)
    call = [sys.executable, str(RUNNER), importer, str(file), repr(case.step), str(case.steps), *case.names]
    run = subprocess.run(call, capture_output=True, text=True)
    if run.returncode == UNUSABLE:
        return Answer(None, "not installed", 0.0)
    if run.returncode:
        raise RuntimeError(f"{importer} and {case.machine}: {run.stderr[-2000:]}")
    return Answer(json.loads(run.stdout.splitlines()[-1])[-1], "", time.perf_counter() - begin)


def cell(answer: Answer, i: int, value: float, error: float) -> str:
    """A value, and how far it is from the master's, over the coupling's error."""
    if answer.values is None:
        return answer.why
    return f"{answer.values[i]:.6g} ({abs(answer.values[i] - value) / error:.2g})"


def section(case: Case, folder: Path) -> tuple[list[str], dict[str, float]]:
    """The lines of a machine, and the largest deviation of each importer over the coupling's error."""
    assembly = with_timetable(reading.assemble(reading.read(case.machine)))
    system = assembly.system(folder, case.flavour)
    file = export_ssp(system, folder / f"{case.machine}.ssp", case.end, case.step)
    values, errors = ours(system, dict(assembly.settings), case)
    answers = {importer: answered(importer, file, case) for importer in (*IMPORTERS, OMSIMULATOR)}
    rows = [
        f"| `{name}` | {system.port(name).variable.unit} | {value:.6g} | {error:.1e} | "
        + " | ".join(cell(answer, i, value, error) for answer in answers.values())
        + " |"
        for i, (name, value, error) in enumerate(zip(case.names, values, errors, strict=True))
    ]
    worst = {
        importer: max(abs(x - y) / e for x, y, e in zip(answer.values, values, errors, strict=True))
        for importer, answer in answers.items()
        if answer.values is not None
    }
    took = [f"{answer.seconds:.0f} s" if answer.values else "-" for answer in answers.values()]
    lines = [
        f"## {case.machine}, {case.flavour} contacts, steps of {case.step:g} s",
        "",
        f"{len(assembly.parts)} components and {len(assembly.contacts)} contacts, {len(system.connections)} connections; "
        f"{case.end:g} s.",
        "",
        f"| value at the end | unit | master | coupling's error | {' | '.join(answers)} |",
        f"|{'---|' * (4 + len(answers))}",
        *rows,
        f"| took | | | | {' | '.join(took)} |",
        "",
    ]
    return lines, worst


def versions() -> str:
    """Return the versions of the importers."""
    found = []
    for name in IMPORTERS:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            found.append(f"{name}, which is not installed")
    program = omsimulator.program()
    if program is None:
        return ", ".join([*found, f"{OMSIMULATOR}, which is not installed"])
    said = subprocess.run([program, "--version"], capture_output=True, text=True).stdout.split()
    return ", ".join([*found, f"{OMSIMULATOR} {next((word for word in said if word[:2] in ('v2', 'v3')), '')}".strip()])


def largest(done: Sequence[tuple[list[str], dict[str, float]]], wanted: Callable[[str], bool]) -> float:
    """The largest deviation, over the coupling's error, of some importers."""
    return max((ratio for _, worst in done for name, ratio in worst.items() if wanted(name)), default=0.0)


def fed(importer: str) -> bool:
    """Return whether the first step of an importer has the inputs that the outputs give."""
    return importer != STARTS_AT_ZERO


def page(done: Sequence[tuple[list[str], dict[str, float]]]) -> str:
    """docs/measured/coupling.md."""
    lines = [
        "# Exported machines in importers of SSP",
        "",
        "Written by `python -m benchmarks.coupling.ssp_importers`, which describes the comparison: the file that `tribofmu run MACHINE",
        "--ssp FILE` writes, in",
        f"{versions()}.",
        "`took`: including the start of all FMUs, on a shared machine. Components are models in Python in any case; native contacts are C.",
        "",
        "`master` is the master with the importers' algorithm, fixed steps and Jacobi of order 0. Beside it is the error of the coupling: the range of its results with these steps, with double steps, and with the machine's own settings, at least a millionth of the value. The deviation of an importer is given in brackets, in units of this error:",
        f"{largest(done, fed):.2g} at most, for fmpy {largest(done, lambda name: not fed(name)):.2g}.",
        "",
        "fmpy passes none of the file's parameters to the FMUs, and sets every connected input to zero for its first step. Each FMU of the file has the machine's parameters as its own start values, so the missing parameters have no effect. The zero inputs do: a contact refuses that step, as 0 K is no valid temperature, but other components accept it, such as the shafts of the gears, which follow a drive at rest. The deviation is proportional to the step. It lies within the error of the coupling where that is large, and is visible where everything else has settled: `gear_fzg_a`, twice, with steps of half the size.",
        "",
        "In fmpy, libcosimpy and ecospy an output that depends directly on an input reaches the next FMU one step later than in the master, which evaluates such outputs in their order. OMSimulator does so as well, and solves loops of such outputs.",
        "",
        *(line for lines, _ in done for line in lines),
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    os.environ.setdefault("TRIBOFMU_PYTHON", sys.executable)
    sections = []
    for entry in CASES:
        with tempfile.TemporaryDirectory() as scratch:
            sections.append(section(entry, Path(scratch)))
        print("\n".join(sections[-1][0]), flush=True)
    save("coupling/ssp_importers", page(sections))
    sys.exit(int(largest(sections, fed) > 1.0))
