"""Resources of a component's FMU for its slave: `part.json` and the script that makes it."""

import functools
import hashlib
import importlib
import json
from pathlib import Path
from typing import Any

import contact_core
from contact_core.entry_points import homes
from contact_core.errors import SceneError, did_you_mean
from contact_core.quantities import out_of_range, value_out_of_range
from contact_core.scene.toml import build, unbuild
from fmu_src.flavours import Flavour, Version
from fmu_src.runtime.resources import identity, script

from .part import MACHINES, Part

_HOME = "system_models"  # package of the components that resources may name, beside those that offer machines


def files(part: Part) -> dict[str, bytes]:
    """Return the name and content of every file in `resources/` that both flavours have."""
    module = _module(part)
    return {
        "part.json": (json.dumps(_table(part), indent=1) + "\n").encode(),
        "slavemodule.txt": module.encode(),
        f"{module}.py": script(part.name, "system_models.parts.slave.PartSlave", "The component of part.json."),
    }


def guid(part: Part, flavour: Flavour, fmi: Version = 2) -> str:
    """Return the FMU's identity as a UUID, from part, versions and flavour."""
    return identity(_fingerprint(part), flavour, fmi)


def check(part: Part) -> None:
    """Raise SceneError if a number is out of its range, some do not go together, or no such input can start."""
    for sentence in out_of_range(part, ""):
        raise SceneError(sentence)
    part.check()
    inputs = {q.name: q for q in part.inputs}
    for start in part.starts:
        if start.name not in inputs:
            raise SceneError(
                f"starts names no input: '{start.name}'.{did_you_mean(start.name, list(inputs))} "
                f"The inputs of a {part.name} are {', '.join(inputs) or 'none'}."
            )
        for sentence in value_out_of_range(inputs[start.name], start.value):
            raise SceneError(f"starts: {sentence}")


@functools.lru_cache(maxsize=256)
def read(folder: str, module: str) -> Part:
    """Return the component in an FMU's resources, for the script `module`. Raises SceneError if it cannot be used."""
    try:
        table = json.loads(Path(folder, "part.json").read_text("utf-8"))
        version, home, name, values = (table[key] for key in ("version", "module", "class", "values"))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise SceneError(f"The resources of the FMU in {folder} cannot be read ({error}). Build it again.") from None
    if version != contact_core.__version__:
        raise SceneError(
            f"The FMU was built with tribofmu {version}, but {contact_core.__version__} is installed. Build it again."
        )
    if str(home).partition(".")[0] not in {_HOME, *homes(MACHINES)}:
        raise SceneError(
            f"The FMU's component lies in '{home}', which is neither in this package nor in an installed one that "
            f"offers {MACHINES}. Install that package here, or build the FMU again."
        )
    part: Part = build(getattr(importlib.import_module(home), name), values, "")
    if _module(part) != module:
        raise SceneError(f"The component of the FMU in {folder} was changed after building. Build it again.")
    return part


def _table(part: Part) -> dict[str, Any]:
    kind = type(part)
    values = unbuild(part)
    return {
        "version": contact_core.__version__,
        "module": kind.__module__,
        "class": kind.__name__,
        "values": values,
    }


def _module(part: Part) -> str:
    """Return the name of the script, unique to part and version."""
    return f"{part.name.lower()}_{_fingerprint(part)[:16]}"


def _fingerprint(part: Part) -> str:
    return hashlib.sha256(json.dumps(_table(part), sort_keys=True).encode()).hexdigest()
