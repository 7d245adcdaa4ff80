"""One run of an FMU of FMI 2.0 or 3.0 in each importer: importers.py IMPORTER FMU prints the Real outputs of each step.

Every importer runs in a process of its own: what one does to a process does not reach the others. The exit code
is UNUSABLE if the importer is not installed, or lacks a library of the system. Three are in no package registry and are
found by the environment: TRIBOFMU_TEST_FMUSIM names the program fmusim (else the one on PATH), TRIBOFMU_TEST_PYFMI a
Python that has PyFMI, which needs nothing else, TRIBOFMU_TEST_OMSIMULATOR the library libOMSimulator.so.
"""

import contextlib
import csv
import ctypes
import importlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from imported_fmu import Fmu

UNUSABLE = 77
PRINTED_DIGITS = {"fmusim": 16}  # of importers that print numbers, and not enough digits for every bit
STEP = 20.0  # s
STIMULI = [
    {"load": 53.7, "speed_1": 0.1025, "temperature": 353.15},
    {"load": 40.0, "speed_1": 0.12, "temperature": 353.15},
    {"load": 40.0, "speed_1": 0.08, "temperature": 357.0},
    {"load": 60.0, "speed_1": 0.1, "temperature": 350.0},
]
_NAMED_BY = {  # what the environment names, for importers that cannot be imported by their name
    "fmusim": "TRIBOFMU_TEST_FMUSIM",
    "omsimulator": "TRIBOFMU_TEST_OMSIMULATOR",
}


def with_fmpy(fmu: Fmu) -> Iterator[list[float]]:
    import fmpy

    with tempfile.TemporaryDirectory() as folder:
        fmpy.extract(str(fmu.path), folder)
        slave = fmpy.instantiate_fmu(folder, fmpy.read_model_description(str(fmu.path)), fmi_type="CoSimulation")
        if fmu.fmi == 2:
            slave.setupExperiment()
        slave.enterInitializationMode()
        slave.exitInitializationMode()
        put, get = (getattr(slave, f"{verb}{fmu.real}") for verb in ("set", "get"))
        for n, row in enumerate(STIMULI):
            put(fmu.references(row), list(row.values()))
            slave.doStep(n * STEP, STEP)
            yield get(fmu.references(fmu.outputs))
        slave.terminate()
        slave.freeInstance()


def with_fmu_manipulation_toolbox(fmu: Fmu) -> Iterator[list[float]]:
    """Through a container: an FMU whose native library imports the FMUs that it holds."""
    from fmu_manipulation_toolbox.assembly import AssemblyNode

    with tempfile.TemporaryDirectory() as folder:
        node = AssemblyNode("container.fmu", step_size=STEP)
        node.add_fmu(fmu.path.name)
        shutil.copy(fmu.path, folder)
        node.make_fmu(Path(folder), fmi_version=fmu.fmi)
        yield from with_fmpy(Fmu.read(Path(folder, "container.fmu"), fmu.outputs))


def with_fmuloader(fmu: Fmu) -> Iterator[list[float]]:
    from fmuloader import fmi2, fmi3

    kind = fmi2.Fmi2Slave if fmu.fmi == 2 else fmi3.Fmi3Slave
    with kind(fmu.path, model_identifier=fmu.identifier) as slave:
        if fmu.fmi == 2:
            slave.instantiate("contact", fmi2.Fmi2Type.CO_SIMULATION, guid=fmu.token)
            slave.setup_experiment(start_time=0.0)
            put, get = slave.set_real, slave.get_real
        else:
            slave.instantiate_co_simulation("contact", instantiation_token=fmu.token)
            put, get = slave.set_float64, slave.get_float64
        slave.enter_initialization_mode()
        slave.exit_initialization_mode()
        for n, row in enumerate(STIMULI):
            put(fmu.references(row), list(row.values()))
            slave.do_step(n * STEP, STEP)
            yield get(fmu.references(fmu.outputs))
        slave.terminate()


def with_libcosimpy(fmu: Fmu) -> Iterator[list[float]]:
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(int(STEP * 1e9))
    slave = execution.add_local_slave(CosimLocalSlave(str(fmu.path), "contact"))
    manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    execution.add_manipulator(manipulator)
    execution.add_observer(observer)
    for row in STIMULI:
        manipulator.slave_real_values(slave, fmu.references(row), list(row.values()))
        if not execution.step():
            raise RuntimeError(f"libcosim could not step: {execution.status()}")
        yield observer.last_real_values(slave, fmu.references(fmu.outputs))


def with_ecospy(fmu: Fmu) -> Iterator[list[float]]:
    from ecospy import EcosSimulation, EcosSimulationStructure

    structure = EcosSimulationStructure()
    structure.add_model("contact", str(fmu.path))
    with EcosSimulation(structure=structure, step_size=STEP) as simulation:
        simulation.init()
        for row in STIMULI:
            for name, value in row.items():
                simulation.set_real(f"contact::{name}", value)
            simulation.step()
            yield [simulation.get_real(f"contact::{name}") for name in fmu.outputs]


def with_pyfmi(fmu: Fmu) -> Iterator[list[float]]:
    from pyfmi import load_fmu

    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):  # it writes its log where it runs
        slave = load_fmu(str(fmu.path), kind="CS")
        slave.setup_experiment()
        slave.enter_initialization_mode()
        slave.exit_initialization_mode()
        for n, row in enumerate(STIMULI):
            slave.set(list(row), list(row.values()))
            if (status := slave.do_step(n * STEP, STEP)) != 0:
                raise RuntimeError(f"PyFMI could not step: status {status}")
            yield [float(slave.get(name)[0]) for name in fmu.outputs]
        slave.terminate()
        slave.free_instance()


def _fmusim() -> str | None:
    return shutil.which(os.environ.get(_NAMED_BY["fmusim"]) or "fmusim")


def with_fmusim(fmu: Fmu) -> Iterator[list[float]]:
    """One whole simulation: its inputs come from a table. It has set the first row's before initialisation ends."""
    with tempfile.TemporaryDirectory() as folder:
        inputs, outputs = Path(folder, "inputs.csv"), Path(folder, "outputs.csv")
        with inputs.open("w", newline="") as file:
            table = csv.writer(file)
            table.writerow(["time", *STIMULI[0]])
            table.writerows([n * STEP, *row.values()] for n, row in enumerate(STIMULI))
        times = ["--stop-time", str(len(STIMULI) * STEP), "--set-stop-time", "--output-interval", str(STEP)]
        files = ["--input-file", str(inputs), "--output-file", str(outputs)]
        call = [str(_fmusim()), "--interface-type", "cs", *times, *files, str(fmu.path)]
        subprocess.run(call, check=True, stdout=sys.stderr)
        with outputs.open(newline="") as file:
            rows = list(csv.DictReader(file))
        assert [float(row["time"]) for row in rows] == [n * STEP for n in range(len(STIMULI) + 1)]
        yield from ([float(row[name]) for name in fmu.outputs] for row in rows[1:])


def _omsimulator() -> str | None:
    return os.environ.get(_NAMED_BY["omsimulator"])


def with_omsimulator(fmu: Fmu) -> Iterator[list[float]]:
    library = ctypes.CDLL(_omsimulator())

    def call(name: str, *arguments: object) -> None:
        values = [
            a.encode() if isinstance(a, str) else ctypes.c_double(a) if isinstance(a, float) else a for a in arguments
        ]
        if getattr(library, f"oms_{name}")(*values) > 1:  # ok, warning
            raise RuntimeError(f"oms_{name} of {arguments} failed")

    def value(name: str) -> float:
        found = ctypes.c_double()
        call("getReal", f"m.s.contact.{name}", ctypes.byref(found))
        return found.value

    with tempfile.TemporaryDirectory() as folder:
        call("setTempDirectory", folder)
        call("newModel", "m")
        call("addSystem", "m.s", 1)  # weakly coupled
        call("addSubModel", "m.s.contact", str(fmu.path))
        call("setFixedStepSize", "m.s", STEP)
        call("setStopTime", "m", STEP * len(STIMULI))
        call("setResultFile", "m", "", 0)
        call("instantiate", "m")
        call("initialize", "m")
        for n, row in enumerate(STIMULI, 1):
            for name, number in row.items():
                call("setReal", f"m.s.contact.{name}", number)
            call("stepUntil", "m", n * STEP)
            yield [value(name) for name in fmu.outputs]
        call("terminate", "m")
        call("delete", "m")


IMPORTERS: dict[str, Callable[[Fmu], Iterator[list[float]]]] = {
    "fmpy": with_fmpy,
    "libcosimpy": with_libcosimpy,
    "ecospy": with_ecospy,
    "fmuloader": with_fmuloader,
    "fmu_manipulation_toolbox": with_fmu_manipulation_toolbox,
    "pyfmi": with_pyfmi,
    "fmusim": with_fmusim,
    "omsimulator": with_omsimulator,
}


def _missing(name: str) -> str | None:
    """Reason why an importer cannot be used here, or None."""
    if name == "fmusim":
        return None if _fmusim() else "no such program"
    if name == "omsimulator":
        return None if _omsimulator() else "no such library"
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
    rows = [[value.hex() for value in row] for row in IMPORTERS[name](Fmu.read(Path(file).resolve()))]
    print(json.dumps(rows))
