"""Other masters on the FMUs of masters.py, each in its own process: masters_rivals.py RIVAL REQUEST ANSWER.

REQUEST (JSON) names the FMUs {name: path}, the connections [output, input], the values of the inputs at the start, the
bond of ECCO as (output, input) of one FMU and then of the other, the outputs to give back, the stop time in s, and the
runs. ANSWER (npz) has for each run the times after each step [s], the outputs there [steps, outputs] and the number
of calls of fmi2DoStep of all FMUs together; a run that failed has no steps. The exit code is UNUSABLE if the rival is
not installed, or lacks a library of the system.
"""

import contextlib
import importlib
import json
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave

UNUSABLE = 77
MODULES = {"libcosimpy": "libcosimpy", "PyCosimLibrary": "PyCosimLibrary", "CoFmuPy": "cofmupy"}
Rows = tuple[list[float], list[list[float]], int]


def split(name: str) -> tuple[str, str]:
    fmu, _, variable = name.partition(".")
    return fmu, variable


def references(fmus: dict[str, str]) -> dict[str, int]:
    """Value references by "fmu.variable"."""
    models = {name: fmpy.read_model_description(path) for name, path in fmus.items()}
    return {f"{name}.{v.name}": v.valueReference for name, model in models.items() for v in model.modelVariables}


@contextlib.contextmanager
def counted() -> Iterator[list[float]]:
    """The sizes of all steps that are taken through fmpy meanwhile."""
    sizes: list[float] = []
    step = FMU2Slave.doStep

    def do_step(self: FMU2Slave, currentCommunicationPoint: float, communicationStepSize: float, *rest: Any) -> int:
        sizes.append(communicationStepSize)
        step(self, currentCommunicationPoint, communicationStepSize, *rest)
        return 0  # fmi2OK, which PyCosimLibrary expects and fmpy has ceased to return: it raises what is not OK

    FMU2Slave.doStep = do_step
    try:
        yield sizes
    finally:
        FMU2Slave.doStep = step


def libcosimpy(request: dict[str, Any], run: dict[str, Any]) -> Rows:
    from libcosimpy.CosimAlgorithm import CosimAlgorithm, EccoParams
    from libcosimpy.CosimEnums import CosimVariableType
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.ERROR)
    if run["algorithm"] == "ecco":
        settings = EccoParams(
            step_size=run["step"],
            min_step_size=run["step"],
            max_step_size=request["stop"] / 10.0,
            min_change_rate=0.2,
            max_change_rate=1.5,  # at the default, 0.2, a step can only shrink
            abs_tolerance=run["tolerance"] * request["energy"],
            rel_tolerance=run["tolerance"],
        )
        algorithm = CosimAlgorithm.create_ecco_algorithm(settings)
        execution = CosimExecution.from_algorithm(algorithm)
    else:
        execution = CosimExecution.from_step_size(round(1e9 * run["step"]))
    reference = references(request["fmus"])
    slaves = {name: CosimLocalSlave(path, name) for name, path in request["fmus"].items()}
    index = {name: execution.add_local_slave(slave) for name, slave in slaves.items()}

    def place(name: str) -> tuple[int, int]:
        return index[split(name)[0]], reference[name]

    for source, target in request["connections"]:
        execution.connect_real_variables(*place(source), *place(target))
    if run["algorithm"] == "ecco":
        output, input_, other_output, other_input = request["bond"]
        algorithm.add_power_bond(*place(output), reference[input_], *place(other_output), reference[other_input])
    most = round(request["stop"] / run["step"]) + 10
    observer = CosimObserver.create_time_series(buffer_size=most)
    execution.add_observer(observer)
    for name in {*request["outputs"], *request["bond"]}:  # ECCO fails where nothing observes an input of its bond
        observer.start_time_series(*place(name), CosimVariableType.REAL)
    if not execution.simulate_until(round(1e9 * request["stop"])):
        raise RuntimeError(str(execution.status()))
    samples = [observer.time_series_real_samples(*place(name), 1, most) for name in request["outputs"]]
    times = [1e-9 * nanoseconds for nanoseconds in samples[0][0]]
    return times, np.transpose([values for _, _, values in samples]).tolist(), len(times) * len(index)


def py_cosim_library(request: dict[str, Any], run: dict[str, Any]) -> Rows:
    from PyCosimLibrary.gauss_seidel_runner import GaussSeidelRunner
    from PyCosimLibrary.jacobi_runner import JacobiRunner
    from PyCosimLibrary.jacobit_it_runner import JacobiIterativeRunner
    from PyCosimLibrary.loader import FMULoader
    from PyCosimLibrary.scenario import Connection, CosimScenario, OutputConnection, SignalType, VarType

    reference = references(request["fmus"])
    loaded = {name: FMULoader.load(path, name, None) for name, path in request["fmus"].items()}
    fmus = {name: found.fmu for name, found in loaded.items()}
    real: dict[str, Any] = {"value_type": VarType.REAL, "signal_type": SignalType.CONTINUOUS}

    def end(side: str, name: str) -> dict[str, Any]:
        return {f"{side}_fmu": fmus[split(name)[0]], f"{side}_vr": [reference[name]]}

    for fmu in fmus.values():
        fmu.instantiate()
    scenario = CosimScenario(
        fmus=list(fmus.values()),
        connections=[Connection(**real, **end("source", a), **end("target", b)) for a, b in request["connections"]],
        step_size=run["step"],
        print_interval=run["step"],
        stop_time=request["stop"],
        outputs=[OutputConnection(**real, **end("source", name)) for name in request["outputs"]],
    )
    runner = {
        "jacobi": JacobiRunner,
        "gauss_seidel": GaussSeidelRunner,
        "iterated": lambda: JacobiIterativeRunner(run["iterations"], run["tolerance"]),
    }[run["algorithm"]]()
    with counted() as steps:
        results = runner.run_cosim(scenario, None)
    for found in loaded.values():
        FMULoader.unload(found)
    columns = [results.out_signals[split(name)[0]][reference[name]][1:] for name in request["outputs"]]
    return results.timestamps[1:], np.transpose(columns).tolist(), len(steps)


def cofmupy(request: dict[str, Any], run: dict[str, Any]) -> Rows:
    from cofmupy import Coordinator

    def end(name: str) -> dict[str, str]:
        fmu, variable = split(name)
        return {"id": fmu, "variable": variable, "unit": "", "type": "fmu"}

    starts: dict[str, dict[str, float]] = {name: {} for name in request["fmus"]}
    for name, value in request["inputs"].items():
        fmu, variable = split(name)
        starts[fmu][variable] = value
    setup = {
        "fmus": [
            {"id": name, "name": name, "path": path, "initialization": starts[name]}
            for name, path in request["fmus"].items()
        ],
        "connections": [{"source": end(source), "target": end(target)} for source, target in request["connections"]],
        "cosim_method": run["algorithm"].removeprefix("iterated_"),
        "iterative": run["algorithm"].startswith("iterated_"),
        "root": "",
    }
    with tempfile.TemporaryDirectory() as folder, counted() as steps:
        path = Path(folder, "setup.json")
        path.write_text(json.dumps(setup))
        coordinator = Coordinator()
        coordinator.start(str(path))
        for _ in range(round(request["stop"] / run["step"])):
            coordinator.do_step(run["step"])
    found = coordinator.get_results()
    # the row of a step carries the time at which the step began
    times = [time + run["step"] for time in found["time"]]
    return times, np.transpose([found[split(name)] for name in request["outputs"]]).tolist(), len(steps)


RIVALS: dict[str, Callable[[dict[str, Any], dict[str, Any]], Rows]] = {
    "libcosimpy": libcosimpy,
    "PyCosimLibrary": py_cosim_library,
    "CoFmuPy": cofmupy,
}


def main(rival: str, request_path: str, answer_path: str) -> None:
    try:
        importlib.import_module(MODULES[rival])
    except (ImportError, OSError) as error:
        print(error, file=sys.stderr)
        sys.exit(UNUSABLE)
    request = json.loads(Path(request_path).read_text())
    answer: dict[str, Any] = {}
    for k, run in enumerate(request["runs"]):
        try:
            with Path(os.devnull).open("w") as sink, contextlib.redirect_stdout(sink):
                times, rows, calls = RIVALS[rival](request, run)
        except (RuntimeError, ArithmeticError, FMICallException) as error:
            times, rows, calls = [], [], 0
            print(f"{rival}, {run}: {error}", file=sys.stderr)
        answer |= {f"times_{k}": times, f"rows_{k}": rows, f"calls_{k}": calls}
    np.savez(answer_path, version=version(rival), **answer)


if __name__ == "__main__":
    main(*sys.argv[1:])
