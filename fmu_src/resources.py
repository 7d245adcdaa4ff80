"""What lies in the FMU's resources for the slave, written and read in one place.

`scene.json` is the scene, `versions.json` the packages it was built with, `slavemodule.txt` names the script
that makes the slave. The script's name carries a fingerprint of scene and versions: two FMUs in one process
never share a module, and an edited scene is noticed. An isolated FMU has besides: `start.py`, which its library
runs, `guid.txt`, and `python.txt` if it was told which Python is to run it.
"""

import functools
import hashlib
import json
import uuid
from importlib.resources import files as package_files
from pathlib import Path

import pythonfmu

import contact_core
from contact_core.errors import SceneError
from contact_core.scene import Scene

from .flavours import Flavour

MODEL = "MixedContact"
VERSIONS = {"contact_core": contact_core.__version__, "pythonfmu": pythonfmu.__version__}

# The loader runs the file twice and takes the deepest subclass of Fmi2Slave among its names: let it be one.
_SCRIPT = '''"""The slave that the FMU's library loads."""

from {package} import {module}

# Each instantiation, pythonfmu 0.7 drops one reference too many to this module's names: hand it one to drop.
globals().setdefault("_references", []).append(globals())


if "{model}" in globals():
    {model} = globals()["{model}"]  # one class for all instances: none is ever given back
else:

    class {model}({module}.{name}):
        """{text}"""
'''


def script(model: str, slave: str, text: str) -> bytes:
    """The script that makes the slave: the class `model`, of the class `slave` given as package.module.Class."""
    package, module, name = slave.rsplit(".", 2)
    return _SCRIPT.format(model=model, package=package, module=module, name=name, text=text).encode()


def guid(scene: Scene, flavour: Flavour) -> str:
    """The FMU's identity as a UUID, from scene, versions and flavour."""
    return identity(_fingerprint(scene), flavour)


def identity(fingerprint: str, flavour: Flavour) -> str:
    """The UUID of an FMU, from the fingerprint of what it is built from."""
    return str(uuid.uuid5(uuid.UUID(hex=fingerprint[:32]), flavour))


def module_name(scene: Scene) -> str:
    """Name of the script, unique to scene and versions."""
    return f"mixed_contact_{_fingerprint(scene)[:16]}"


def _fingerprint(scene: Scene) -> str:
    return hashlib.sha256(json.dumps([scene.to_dict(), VERSIONS], sort_keys=True).encode()).hexdigest()


def files(scene: Scene) -> dict[str, bytes]:
    """Name and content of every file in `resources/` that both flavours have."""
    module = module_name(scene)
    return {
        "scene.json": (json.dumps(scene.to_dict(), indent=1) + "\n").encode(),
        "versions.json": (json.dumps(VERSIONS, indent=1) + "\n").encode(),
        "slavemodule.txt": module.encode(),
        f"{module}.py": script(MODEL, "fmu_src.slave.ContactSlave", "The contact of scene.json."),
    }


def of_process(guid: str, python: str | None) -> dict[str, bytes]:
    """Name and content of the files in `resources/` that start an isolated FMU; `python` is its interpreter."""
    found = {"start.py": (package_files("fmu_src") / "native" / "start.py").read_bytes(), "guid.txt": guid.encode()}
    return found | ({"python.txt": python.encode()} if python else {})


@functools.lru_cache(maxsize=64)
def read(folder: str, module: str) -> Scene:
    """The scene in an FMU's resources, for the script `module`.

    Cached, so that a reset cannot fail. Raises SceneError if it was built with another version or edited.
    """
    try:
        versions = json.loads(Path(folder, "versions.json").read_text("utf-8"))
        table = json.loads(Path(folder, "scene.json").read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise SceneError(
            f"The resources of the FMU in {folder} cannot be read ({error}). Build the FMU again."
        ) from None
    for package, installed in VERSIONS.items():
        built_with = versions.get(package)
        if built_with != installed:
            raise SceneError(
                f"The FMU was built with {package} {built_with}, but {installed} is installed. "
                f"Build the FMU again, or install {package} {built_with}."
            )
    scene = Scene.from_dict(table)
    if module_name(scene) != module:
        raise SceneError(f"The scene of the FMU in {folder} was changed after building. Build the FMU again.")
    return scene
