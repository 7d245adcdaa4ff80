"""An .ssp file in an importer: ssp_runner.py IMPORTER FILE STEP COUNT VARIABLE... prints the values after each step.

Every importer runs in a process of its own; the exit code is UNUSABLE if it is not installed, or lacks a library.
"""

import importlib
import json
import sys
from collections.abc import Callable, Iterator

UNUSABLE = 77


def with_libcosimpy(file: str, step: float, count: int, names: list[str]) -> Iterator[list[float]]:
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver

    execution = CosimExecution.from_ssp_file(file, round(step * 1e9))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    slaves = {info.name.decode(): info.index for info in execution.slave_infos()}
    places = []
    for name in names:
        owner, variable = name.split(".")
        references = {v.name.decode(): v.reference for v in execution.slave_variables(slaves[owner])}
        places.append((slaves[owner], [references[variable]]))
    for _ in range(count):
        if not execution.step():
            raise RuntimeError(f"libcosim could not step: {execution.status()}")
        yield [observer.last_real_values(*place)[0] for place in places]


def with_ecospy(file: str, step: float, count: int, names: list[str]) -> Iterator[list[float]]:
    from ecospy import EcosSimulation

    with EcosSimulation(ssp_path=file, step_size=step) as simulation:
        simulation.init(parameter_set="initialValues")
        for _ in range(count):
            simulation.step()
            yield [simulation.get_real(name.replace(".", "::")) for name in names]


def with_fmpy(file: str, step: float, count: int, names: list[str]) -> Iterator[list[float]]:
    from fmpy.ssp.simulation import simulate_ssp

    rows = simulate_ssp(file, stop_time=(count - 0.5) * step, step_size=step)
    yield from ([float(row[name]) for name in names] for row in rows)


IMPORTERS: dict[str, Callable[[str, float, int, list[str]], Iterator[list[float]]]] = {
    "fmpy": with_fmpy,
    "libcosimpy": with_libcosimpy,
    "ecospy": with_ecospy,
}

if __name__ == "__main__":
    importer, file, step, count, *names = sys.argv[1:]
    try:
        importlib.import_module(importer)
    except (ImportError, OSError) as error:
        print(error, file=sys.stderr)
        sys.exit(UNUSABLE)
    print(json.dumps(list(IMPORTERS[importer](file, float(step), int(count), names))))
