"""Native FMUs in a host in C: time of a step, memory of many instances, random calls.

    python -m benchmarks.fmu.native [FILE.fmu ...] [--rounds 1000000] [--sequences 10000] [--instances 10000]

Without files, it builds the FMUs of three contacts (a ball on a disc, a gear's flank, a ball of a bearing) and writes
docs/measured/fmu.md; with them it only prints, of FMI 2 or 3, with their sources inside.

For each FMU: median, 99th and 99.99th percentile and maximum of the time of a round (set the load, step, get five outputs)
in one process on one CPU, after a tenth as many rounds that are not measured; the same with the derivatives of friction
among the outputs, and with each step taken back by a saved state. Beside it the same of rounds that only read the clock
for as long as the median: what the machine alone does to such a time. Then the resident memory of an instance in a crowd
of them, the size of the FMU, and whether the sources of both versions of FMI survive so many sequences of random calls
under the address and undefined behaviour sanitizers and without an allocation. Times include two readings of the clock,
whose own time stands beside them. Needs Linux and gcc.
"""

import argparse
import os
import subprocess
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import fmpy

from benchmarks.hosts import native_fuzz
from benchmarks.pages import Page
from contact_core import Scene
from fmu_src.isolated.library.build import headers
from fmu_src.native.build import runtime
from fmu_src.package.build import build

SOURCE = Path(__file__).parents[1] / "hosts" / "step_time.c"
READ = ("friction_force", "friction_coefficient", "power_loss", "heat_flow_1", "heat_flow_2")
STEP = 1e-3  # s
PLATFORM = {"2.0": "linux64", "3.0": "x86_64-linux"}
CONTACTS = ("mtm_zddp", "fzg_flank", "ball_209_inner")
MEDIAN, TAIL = 1.0, 5.0  # us, asked for on a quiet core
HEADER = ("FMU", "FMI", "round", "median [us]", "99 % [us]", "99.99 % [us]", "longest [us]",
          "machine alone, 99 % [us]", "99.99 % [us]", "longest [us]", "clock alone [us]")  # fmt: skip


class Times(NamedTuple):
    """Times of a kind of round [us]."""

    fmu: str
    fmi: str
    round: str
    median: float
    most: float  # 99 %
    nearly_all: float  # 99.99 %
    longest: float
    alone: tuple[float, float, float]  # the machine's own 99 %, 99.99 % and longest, of rounds as long as the median
    clock: float

    def row(self) -> tuple[str, ...]:
        """The row of the table."""
        numbers = (self.median, self.most, self.nearly_all, self.longest, *self.alone, self.clock)
        return self.fmu, self.fmi, self.round, *(f"{number:.2f}" for number in numbers)


def compiled(folder: Path) -> Path:
    """The host that times steps."""
    program = folder / "step_time"
    flags = ("-std=c11", "-O2", "-Wall", "-Wextra", "-Werror", "-isystem", str(headers()))
    subprocess.run(["gcc", *flags, str(SOURCE), "-ldl", "-o", str(program)], check=True)
    return program


def times(program: Path, fmu: Path, folder: Path, rounds: int) -> Iterator[Times]:
    """Times of each kind of round."""
    with zipfile.ZipFile(fmu) as archive:
        archive.extractall(folder)
    description = fmpy.read_model_description(str(folder), validate=False)
    references = {v.name: v.valueReference for v in description.modelVariables}
    load = next(float(v.start) for v in description.modelVariables if v.name == "load")
    model, version = description.coSimulation.modelIdentifier, description.fmiVersion
    library = folder / "binaries" / PLATFORM[version] / f"{model}.so"
    cpu = max(os.sched_getaffinity(0))
    derivatives = tuple(name for name in references if name.startswith("dfriction_d"))
    for text, names in (("five outputs", READ), ("five outputs and derivatives", (*READ, *derivatives))):
        words = (version[0], library, description.guid, cpu, rounds, STEP, references["load"], load, 0.9 * load)
        call = [program, *words, *(references[name] for name in names)]
        done = subprocess.run(list(map(str, call)), capture_output=True, text=True, check=True)
        for line, how in zip(done.stdout.splitlines(), ("", ", taken back"), strict=True):
            median, most, nearly_all, longest, *alone, clock = (int(value) / 1e3 for value in line.split())
            own = alone[1], alone[2], alone[3]
            yield Times(fmu.stem, version[0], f"{text}{how}", median, most, nearly_all, longest, own, clock)


def sources(fmu: Path) -> dict[str, bytes]:
    """The FMU's own sources, with those of the other version of FMI."""
    with zipfile.ZipFile(fmu) as archive:
        names = [name for name in archive.namelist() if name.startswith("sources/") and name.endswith((".c", ".h"))]
        found = {Path(name).name: archive.read(name) for name in names}
    if "contact.c" not in found:
        raise FileNotFoundError(f"{fmu} has no sources/contact.c: it is no native FMU with its sources.")
    return runtime(2) | runtime(3) | found


def checked(fmu: Path, folder: Path, sequences: int, instances: int) -> Iterator[str]:
    """Lines on memory, random calls and size."""
    found = sources(fmu)
    counted = native_fuzz.compiled(folder / "counted", found, "-O2", *native_fuzz.COUNTED)
    sanitized = native_fuzz.compiled(folder / "sanitized", found, *native_fuzz.SANITIZED)
    each = native_fuzz.kilobytes(counted, instances)
    yield f"{instances} instances after their first step: {each:.1f} kB each, {each * instances / 1e3:.0f} MB."
    answers = {native_fuzz.digest(program, sequences) for program in (counted, sanitized)}
    if len(answers) != 1:
        raise RuntimeError("Random calls give other answers under the sanitizers.")
    yield f"{sequences} sequences of random calls: no allocation, nothing found by the sanitizers, {answers.pop()}."
    lines = found["contact.c"].count(b"\n")
    with zipfile.ZipFile(fmu) as archive:
        platforms = len({name.split("/")[1] for name in archive.namelist() if name.startswith("binaries/")})
    yield f"The FMU, for {platforms} platforms, has {fmu.stat().st_size / 1e3:.0f} kB, its contact.c {lines} lines."


def main(argv: Sequence[str] | None = None) -> None:
    """Measure the FMUs asked for, or write the page."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fmu.native")
    parser.add_argument("fmu", type=Path, nargs="*", metavar="FILE")
    parser.add_argument("--rounds", type=int, default=1_000_000, help="measured steps (default: %(default)s)")
    parser.add_argument("--sequences", type=int, default=10_000, help="of random calls (default: %(default)s)")
    parser.add_argument("--instances", type=int, default=10_000, help="in one process (default: %(default)s)")
    arguments = parser.parse_args(argv)
    page = Page("fmu/native", "Native FMUs in a host in C")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        fmus = arguments.fmu or [_built(scene, folder, fmi) for scene in CONTACTS for fmi in (2, 3)]
        program, found = compiled(folder), []
        page.header(*HEADER)
        for k, fmu in enumerate(fmus):
            for each in times(program, fmu, folder / str(k), arguments.rounds):
                found.append(each)
                page.row(*each.row())
        page.say(
            f"{arguments.rounds} rounds, one CPU: set the load, step by {STEP:g} s, get. Taken back: the state is saved "
            "before a step, and restored and freed after it. The machine alone: rounds of the same median that only read "
            "the clock, so that what they take more is other work on that CPU, not the FMU's."
        )
        for k, fmu in enumerate(fmus[:: 1 if arguments.fmu else 2]):  # both versions of FMI have the same equations
            lines = checked(fmu, folder / f"sources{k}", arguments.sequences, arguments.instances)
            page.say("\n".join([f"{fmu.stem}:", "", *(f"- {line}" for line in lines)]))
    if not arguments.fmu:
        _judge(page, [each for each in found if each.round == "five outputs"])
        page.write()


def _built(scene: str, folder: Path, fmi: int) -> Path:
    """The native FMU of a shipped scene at the regression level."""
    (folder / f"of{fmi}").mkdir(exist_ok=True)
    given = Scene.from_toml(scene, {"film.model": "regression"})
    return build(given, folder / f"of{fmi}" / f"{scene}.fmu", "native", fmi=fmi, here=True)


def _judge(page: Page, steps: Sequence[Times]) -> None:
    median = max(steps, key=lambda each: each.median)
    tail = max(steps, key=lambda each: each.nearly_all)
    page.verdict(
        f"median of a step at most {MEDIAN:g} us",
        f"{min(each.median for each in steps):.2f} to {median.median:.2f} us",
        median.median <= MEDIAN,
    )
    page.verdict(
        f"99.99 % of steps at most {TAIL:g} us on a quiet core",
        f"{tail.nearly_all:.1f} us, where the machine alone has {tail.alone[1]:.1f} us",
        tail.nearly_all <= TAIL,
    )


if __name__ == "__main__":
    main()
