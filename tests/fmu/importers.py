"""One run of an FMU in each importer: importers.py IMPORTER FMU prints the Real outputs after every step.

Every importer runs in a process of its own: what one does to a process does not reach the others. The exit code
is UNUSABLE if the importer is not installed, or lacks a library of the system.
"""

import importlib
import json
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import fmpy

UNUSABLE = 77
STEP = 20.0  # s
STIMULI = [
    {"load": 53.7, "speed_1": 0.1025, "temperature": 353.15},
    {"load": 40.0, "speed_1": 0.12, "temperature": 353.15},
    {"load": 40.0, "speed_1": 0.08, "temperature": 357.0},
    {"load": 60.0, "speed_1": 0.1, "temperature": 350.0},
]


def real_outputs(fmu: str) -> dict[str, int]:
    variables = fmpy.read_model_description(fmu).modelVariables
    return {v.name: v.valueReference for v in variables if (v.causality, v.type) == ("output", "Real")}


def _inputs(fmu: str) -> list[int]:
    references = {v.name: v.valueReference for v in fmpy.read_model_description(fmu).modelVariables}
    return [references[name] for name in STIMULI[0]]


def with_fmpy(fmu: str) -> Iterator[list[float]]:
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


def with_fmuloader(fmu: str) -> Iterator[list[float]]:
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


IMPORTERS: dict[str, Callable[[str], Iterator[list[float]]]] = {
    "fmpy": with_fmpy,
    "libcosimpy": with_libcosimpy,
    "ecospy": with_ecospy,
    "fmuloader": with_fmuloader,
}

if __name__ == "__main__":
    name, file = sys.argv[1:]
    try:
        importlib.import_module(name)
    except (ImportError, OSError) as error:
        print(error, file=sys.stderr)
        sys.exit(UNUSABLE)
    rows = [[value.hex() for value in row] for row in IMPORTERS[name](str(Path(file).resolve()))]
    print(json.dumps(rows))
