"""What lies in the FMU's resources for the slave, written and read in one place.

`scene.json` is the scene, `versions.json` the packages it was built with, `slavemodule.txt` names the script
that pythonfmu's binary loads. The script's name carries a fingerprint of scene and versions: two FMUs in one
process never share a module, and an edited scene is noticed.
"""

import functools
import hashlib
import json
import uuid
from pathlib import Path

import pythonfmu

import contact_core
from contact_core.errors import SceneError
from contact_core.scene import Scene

MODEL = "MixedContact"
VERSIONS = {"contact_core": contact_core.__version__, "pythonfmu": pythonfmu.__version__}

# The loader runs the file twice and takes the deepest subclass of Fmi2Slave among its names: let it be one.
_SCRIPT = f'''"""What pythonfmu's binary loads."""

from fmu_src import slave

# Each instantiation, pythonfmu 0.7 drops one reference too many to this module's names: hand it one to drop.
globals().setdefault("_references", []).append(globals())


class {MODEL}(slave.ContactSlave):
    """The contact of scene.json."""
'''


def guid(scene: Scene) -> str:
    """The FMU's identity as a UUID, from scene and versions."""
    return str(uuid.UUID(hex=_fingerprint(scene)[:32]))


def module_name(scene: Scene) -> str:
    """Name of the script, unique to scene and versions."""
    return f"mixed_contact_{_fingerprint(scene)[:16]}"


def _fingerprint(scene: Scene) -> str:
    return hashlib.sha256(json.dumps([scene.to_dict(), VERSIONS], sort_keys=True).encode()).hexdigest()


def files(scene: Scene) -> dict[str, bytes]:
    """Name and content of every file in `resources/`."""
    module = module_name(scene)
    return {
        "scene.json": (json.dumps(scene.to_dict(), indent=1) + "\n").encode(),
        "versions.json": (json.dumps(VERSIONS, indent=1) + "\n").encode(),
        "slavemodule.txt": module.encode(),
        f"{module}.py": _SCRIPT.encode(),
    }


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
