"""Unpacks the FMUs of a system and starts an instance of each."""

import tempfile
import threading
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path

import fmpy

from .errors import CouplingError
from .slave import Fmi2Slave, Slave
from .slave_fmi3 import Fmi3Slave
from .system import Port, System

_ALONE = threading.Lock()  # fmpy changes the working directory while it loads an FMU


def started(
    system: System,
    inputs: Mapping[str, list[Port]],
    outputs: Mapping[str, list[Port]],
    early_return: bool,
    exits: ExitStack,
) -> dict[str, Slave]:
    """An instance of every FMU by name, freed when `exits` closes: left alone, one may crash its host at exit."""
    _check_alone(system)
    folders: dict[Path, str] = {}
    slaves: dict[str, Slave] = {}
    for name, model in system.models.items():
        path = model.path.resolve()
        if path not in folders:
            folders[path] = exits.enter_context(tempfile.TemporaryDirectory(prefix="tribofmu-"))
            _check_folder(folders[path])
            fmpy.extract(str(path), folders[path])
        told, read = ([port.variable for port in ports[name]] for ports in (inputs, outputs))
        with _ALONE:
            if model.fmi3:
                slave: Slave = Fmi3Slave(model, folders[path], told, read, early_return)
            else:
                slave = Fmi2Slave(model, folders[path], told, read)
        exits.callback(slave.free)
        slaves[name] = slave
    return slaves


def _check_alone(system: System) -> None:
    for name, model in system.models.items():
        twins = [n for n, m in system.models.items() if m.description.guid == model.description.guid and n != name]
        if twins and model.capabilities.canBeInstantiatedOnlyOncePerProcess:
            raise CouplingError(
                f"The FMU of '{name}' is there as '{twins[0]}', too, but can be instantiated only once in a process. "
                "Export it without this limit, or use it once."
            )


def _check_folder(folder: str) -> None:
    if "%" in Path(folder).as_uri().replace("%20", ""):  # some FMUs crash there
        raise CouplingError(
            f"FMUs cannot be loaded from '{folder}'. Set TMPDIR to a folder named in plain letters and digits."
        )
