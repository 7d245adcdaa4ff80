"""One run of an FMU in each importer: importers.py IMPORTER FMU prints the Real outputs after every step.

Every importer runs in a process of its own: what one does to a process does not reach the others. The exit code
is UNUSABLE if the importer is not installed, or lacks a library of the system. Two are in no package registry and are
found by the environment: TRIBOFMU_TEST_FMUSIM names the program fmusim (else the one on PATH), TRIBOFMU_TEST_PYFMI a
Python that has PyFMI, which needs nothing else.
"""

import contextlib
import csv
import importlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from xml.etree import ElementTree

UNUSABLE = 77
PRINTED_DIGITS = {"fmusim": 16}  # of importers that print numbers, and not enough digits for every bit
STEP = 20.0  # s
STIMULI = [
    {"load": 53.7, "speed_1": 0.1025, "temperature": 353.15},
    {"load": 40.0, "speed_1": 0.12, "temperature": 353.15},
    {"load": 40.0, "speed_1": 0.08, "temperature": 357.0},
    {"load": 60.0, "speed_1": 0.1, "temperature": 350.0},
]


def _variables(fmu: str) -> list[ElementTree.Element]:
    with zipfile.ZipFile(fmu) as archive:
        return ElementTree.fromstring(archive.read("modelDescription.xml")).findall("ModelVariables/ScalarVariable")


def real_outputs(fmu: str) -> dict[str, int]:
    outputs = [v for v in _variables(fmu) if v.get("causality") == "output" and v.find("Real") is not None]
    return {v.attrib["name"]: int(v.attrib["valueReference"]) for v in outputs}


def _inputs(fmu: str) -> list[int]:
    references = {v.attrib["name"]: int(v.attrib["valueReference"]) for v in _variables(fmu)}
    return [references[name] for name in STIMULI[0]]


def with_fmpy(fmu: str) -> Iterator[list[float]]:
    import fmpy

    with tempfile.TemporaryDirectory() as folder:
        fmpy.extract(fmu, folder)
        slave = fmpy.instantiate_fmu(folder, fmpy.read_model_description(fmu))
        slave.setupExperiment()
        slave.enterInitializationMode()
        slave.exitInitializationMode()
        for n, row in enumerate(STIMULI):
            slave.setReal(_inputs(fmu), list(row.values()))
            slave.doStep(n * STEP, STEP)
            yield slave.getReal(list(real_outputs(fmu).values()))
        slave.terminate()
        slave.freeInstance()


def with_fmu_manipulation_toolbox(fmu: str) -> Iterator[list[float]]:
    """Through a container: an FMU whose native library imports the FMUs that it holds."""
    from fmu_manipulation_toolbox.assembly import AssemblyNode

    with tempfile.TemporaryDirectory() as folder:
        node = AssemblyNode("container.fmu", step_size=STEP)
        node.add_fmu(Path(fmu).name)
        shutil.copy(fmu, folder)
        node.make_fmu(Path(folder))
        yield from with_fmpy(str(Path(folder, "container.fmu")))


def with_fmuloader(fmu: str) -> Iterator[list[float]]:
    import fmpy
    from fmuloader.fmi2 import Fmi2Slave, Fmi2Type

    description = fmpy.read_model_description(fmu)
    with Fmi2Slave(fmu, model_identifier=description.coSimulation.modelIdentifier) as slave:
        slave.instantiate("contact", Fmi2Type.CO_SIMULATION, guid=description.guid)
        slave.setup_experiment(start_time=0.0)
        slave.enter_initialization_mode()
        slave.exit_initialization_mode()
        for n, row in enumerate(STIMULI):
            slave.set_real(_inputs(fmu), list(row.values()))
            slave.do_step(n * STEP, STEP)
            yield slave.get_real(list(real_outputs(fmu).values()))
        slave.terminate()


def with_libcosimpy(fmu: str) -> Iterator[list[float]]:
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(int(STEP * 1e9))
    slave = execution.add_local_slave(CosimLocalSlave(fmu, "contact"))
    manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    execution.add_manipulator(manipulator)
    execution.add_observer(observer)
    for row in STIMULI:
        manipulator.slave_real_values(slave, _inputs(fmu), list(row.values()))
        if not execution.step():
            raise RuntimeError(f"libcosim could not step: {execution.status()}")
        yield observer.last_real_values(slave, list(real_outputs(fmu).values()))


def with_ecospy(fmu: str) -> Iterator[list[float]]:
    from ecospy import EcosSimulation, EcosSimulationStructure

    structure = EcosSimulationStructure()
    structure.add_model("contact", fmu)
    with EcosSimulation(structure=structure, step_size=STEP) as simulation:
        simulation.init()
        for row in STIMULI:
            for name, value in row.items():
                simulation.set_real(f"contact::{name}", value)
            simulation.step()
            yield [simulation.get_real(f"contact::{name}") for name in real_outputs(fmu)]


def with_pyfmi(fmu: str) -> Iterator[list[float]]:
    from pyfmi import load_fmu

    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):  # it writes its log where it runs
        slave = load_fmu(fmu, kind="CS")
        slave.setup_experiment()
        slave.enter_initialization_mode()
        slave.exit_initialization_mode()
        for n, row in enumerate(STIMULI):
            slave.set(list(row), list(row.values()))
            if (status := slave.do_step(n * STEP, STEP)) != 0:
                raise RuntimeError(f"PyFMI could not step: status {status}")
            yield [float(slave.get(name)[0]) for name in real_outputs(fmu)]
        slave.terminate()
        slave.free_instance()


def _fmusim() -> str | None:
    return shutil.which(os.environ.get("TRIBOFMU_TEST_FMUSIM") or "fmusim")


def with_fmusim(fmu: str) -> Iterator[list[float]]:
    """One whole simulation: its inputs come from a table. It has set the first row's before initialisation ends."""
    with tempfile.TemporaryDirectory() as folder:
        inputs, outputs = Path(folder, "inputs.csv"), Path(folder, "outputs.csv")
        with inputs.open("w", newline="") as file:
            table = csv.writer(file)
            table.writerow(["time", *STIMULI[0]])
            table.writerows([n * STEP, *row.values()] for n, row in enumerate(STIMULI))
        times = ["--stop-time", str(len(STIMULI) * STEP), "--set-stop-time", "--output-interval", str(STEP)]
        files = ["--input-file", str(inputs), "--output-file", str(outputs)]
        subprocess.run([str(_fmusim()), "--interface-type", "cs", *times, *files, fmu], check=True, stdout=sys.stderr)
        with outputs.open(newline="") as file:
            rows = list(csv.DictReader(file))
        assert [float(row["time"]) for row in rows] == [n * STEP for n in range(len(STIMULI) + 1)]
        yield from ([float(row[name]) for name in real_outputs(fmu)] for row in rows[1:])


IMPORTERS: dict[str, Callable[[str], Iterator[list[float]]]] = {
    "fmpy": with_fmpy,
    "libcosimpy": with_libcosimpy,
    "ecospy": with_ecospy,
    "fmuloader": with_fmuloader,
    "fmu_manipulation_toolbox": with_fmu_manipulation_toolbox,
    "pyfmi": with_pyfmi,
    "fmusim": with_fmusim,
}


def _missing(name: str) -> str | None:
    """Reason why an importer cannot be used here, or None."""
    if name == "fmusim":
        return None if _fmusim() else "no such program"
    try:
        importlib.import_module(name)
    except (ImportError, OSError) as error:
        return str(error)
    return None


if __name__ == "__main__":
    name, file = sys.argv[1:]
    if why := _missing(name):
        print(why, file=sys.stderr)
        sys.exit(UNUSABLE)
    rows = [[value.hex() for value in row] for row in IMPORTERS[name](str(Path(file).resolve()))]
    print(json.dumps(rows))
