"""A native FMU in a host in C: time of a step, memory of many instances, random calls.

    python -m benchmarks.fmu.native FILE.fmu ... [--rounds 1000000] [--sequences 10000] [--instances 10000]

Prints, for each FMU (of FMI 2 or 3, with its sources inside): median, 99th and 99.99th percentile and maximum of the time
of a round (set the load, step, get five outputs) in one process on one CPU, after a tenth as many rounds that are not
measured; the same with the derivatives of friction among the outputs, and with each step taken back by a saved state. Then
the resident memory of an instance in a crowd of them, the size of the FMU, and whether the sources of both versions of FMI
survive so many sequences of random calls under the address and undefined behaviour sanitizers and without an allocation.
Times include two readings of the clock, whose own time stands beside them. Needs Linux and gcc.
"""

import argparse
import os
import subprocess
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import fmpy

from benchmarks.hosts import native_fuzz
from fmu_src.isolated.native.build import headers
from fmu_src.native.build import runtime

SOURCE = Path(__file__).parents[1] / "hosts" / "step_time.c"
READ = ("friction_force", "friction_coefficient", "power_loss", "heat_flow_1", "heat_flow_2")
STEP = 1e-3  # s
PLATFORM = {"2.0": "linux64", "3.0": "x86_64-linux"}


def compiled(folder: Path) -> Path:
    """The host that times steps."""
    program = folder / "step_time"
    flags = ("-std=c11", "-O2", "-Wall", "-Wextra", "-Werror", "-isystem", str(headers()))
    subprocess.run(["gcc", *flags, str(SOURCE), "-ldl", "-o", str(program)], check=True)
    return program


def times(program: Path, fmu: Path, folder: Path, rounds: int) -> Iterator[str]:
    """Rows of the table of times [us]."""
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
            shown = " | ".join(f"{int(value) / 1e3:.2f}" for value in line.split())
            yield f"| FMI {version} | {text}{how} | {shown} |"


def sources(fmu: Path) -> dict[str, bytes]:
    """The FMU's own sources, with those of the other version of FMI."""
    with zipfile.ZipFile(fmu) as archive:
        names = [name for name in archive.namelist() if name.startswith("sources/") and name.endswith((".c", ".h"))]
        found = {Path(name).name: archive.read(name) for name in names}
    if "contact.c" not in found:
        raise FileNotFoundError(f"{fmu} has no sources/contact.c: it is no native FMU with its sources.")
    return runtime(2) | runtime(3) | found


def checked(fmu: Path, folder: Path, sequences: int, instances: int) -> Iterator[str]:
    """Lines on memory and random calls."""
    counted = native_fuzz.compiled(folder / "counted", sources(fmu), "-O2", *native_fuzz.COUNTED)
    sanitized = native_fuzz.compiled(folder / "sanitized", sources(fmu), *native_fuzz.SANITIZED)
    each = native_fuzz.kilobytes(counted, instances)
    yield f"{instances} instances after their first step: {each:.1f} kB each, {each * instances / 1e3:.0f} MB."
    answers = {native_fuzz.digest(program, sequences) for program in (counted, sanitized)}
    if len(answers) != 1:
        raise RuntimeError("Random calls give other answers under the sanitizers.")
    yield f"{sequences} sequences of random calls: no allocation, nothing found by the sanitizers, {answers.pop()}."
    yield f"The FMU has {fmu.stat().st_size / 1e3:.0f} kB."


def main(argv: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fmu.native")
    parser.add_argument("fmu", type=Path, nargs="+", metavar="FILE")
    parser.add_argument("--rounds", type=int, default=1_000_000, help="measured steps (default: %(default)s)")
    parser.add_argument("--sequences", type=int, default=10_000, help="of random calls (default: %(default)s)")
    parser.add_argument("--instances", type=int, default=10_000, help="in one process (default: %(default)s)")
    arguments = parser.parse_args(argv)
    print("| FMI | round | median [us] | 99 % [us] | 99.99 % [us] | longest [us] | clock alone [us] |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        program = compiled(Path(name))
        for k, fmu in enumerate(arguments.fmu):
            for row in times(program, fmu, Path(name, str(k)), arguments.rounds):
                print(row, flush=True)
        for k, fmu in enumerate(arguments.fmu):
            print(f"\n{fmu.name}:", flush=True)
            for line in checked(fmu, Path(name, f"sources{k}"), arguments.sequences, arguments.instances):
                print(line, flush=True)


if __name__ == "__main__":
    main()
