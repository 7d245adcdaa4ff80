"""Starts an instance of each of several FMUs."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path

from fmpy.model_description import ModelVariable

from .errors import CouplingError
from .fmi2 import Fmi2Instance
from .fmi3 import Fmi3Instance
from .instance import Instance
from .loading import unpack
from .model import Model


def started(
    models: Mapping[str, Model],
    inputs: Mapping[str, Sequence[ModelVariable]],
    outputs: Mapping[str, Sequence[ModelVariable]],
    early_return: bool,
    exits: ExitStack,
) -> dict[str, Instance]:
    """Return an instance of every FMU by name, freed when `exits` closes: otherwise it may crash its host at exit.

    inputs, outputs: the Real variables that are set and read in every step. early_return: a step may end at an event.
    """
    _check_single(models)
    folders: dict[Path, str] = {}
    instances: dict[str, Instance] = {}
    for name, model in models.items():
        path = model.path.resolve()
        if path not in folders:
            folders[path] = unpack(path, exits)
        ports = list(inputs[name]), list(outputs[name])
        if model.fmi3:
            instance: Instance = Fmi3Instance(model, folders[path], *ports, early_return)
        else:
            instance = Fmi2Instance(model, folders[path], *ports)
        exits.callback(instance.free)
        instances[name] = instance
    return instances


def _check_single(models: Mapping[str, Model]) -> None:
    """Raise CouplingError for two instances of an FMU that allows only one in a process."""
    for name, model in models.items():
        twins = [n for n, m in models.items() if m.description.guid == model.description.guid and n != name]
        if twins and model.capabilities.canBeInstantiatedOnlyOncePerProcess:
            raise CouplingError(
                f"The FMU of '{name}' is there as '{twins[0]}', too, but can be instantiated only once in a process. "
                "Export it without this limit, or use it once."
            )
