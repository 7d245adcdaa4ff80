"""Resources of an FMU for its slave, written and read in one place.

`scene.json`, `heights_*.npy` and `map_*.json` of the scene, `versions.json` of packages, `slavemodule.txt` with the
name of the slave's script, in which a fingerprint of scene and versions keeps FMUs in one process apart; an isolated
FMU has `start.py`, `guid.txt` and `python.txt`, too.
"""

import functools
import hashlib
import json
import uuid
import zlib
from dataclasses import replace
from importlib import metadata
from pathlib import Path
from string import Template
from typing import Any

import pythonfmu

import contact_core
from contact_core.corrections.map import map_of
from contact_core.entry_points import versions
from contact_core.errors import SceneError
from contact_core.film.regression import MAP_SUFFIX, map_file
from contact_core.scene import Scene
from contact_core.scene.in_use import in_use

from ..flavours import Flavour, Version

MODEL = "MixedContact"
VERSIONS = {"contact_core": contact_core.__version__, "pythonfmu": pythonfmu.__version__}

# The binary runs the file twice and takes the deepest subclass of Fmi2Slave among its names: define one only.
_SCRIPT = Template(Path(__file__).with_name("slave.py.in").read_text("ascii"))


def script(model: str, slave: str, text: str) -> bytes:
    """Return the script that defines the slave: the class `model`, derived from `slave` (package.module.Class)."""
    package, module, name = slave.rsplit(".", 2)
    return _SCRIPT.substitute(model=model, package=package, module=module, name=name, text=text).encode()


def guid(scene: Scene, flavour: Flavour, version: Version = 2) -> str:
    """Return the UUID of the FMU of a scene; it depends on scene, versions, flavour and FMI's version."""
    return identity(_fingerprint(scene), flavour, version)


def identity(fingerprint: str, flavour: Flavour, version: Version = 2) -> str:
    """Return the UUID of an FMU from the fingerprint of its source."""
    kind = flavour if version == 2 else f"{flavour} FMI {version}"
    return str(uuid.uuid5(uuid.UUID(hex=fingerprint[:32]), kind))


def module_name(scene: Scene) -> str:
    """Return the name of the script, unique to scene and versions."""
    return f"mixed_contact_{_fingerprint(scene)[:16]}"


def _fingerprint(scene: Scene) -> str:
    built_with = versions_of(scene)
    return hashlib.sha256(json.dumps([packed(scene).to_dict(), built_with], sort_keys=True).encode()).hexdigest()


def versions_of(scene: Scene) -> dict[str, str]:
    """Return the versions of the packages that the FMU of a scene is built with, those of other packages' laws too."""
    return VERSIONS | versions(homes_of(scene) - {contact_core.__name__})


def homes_of(scene: Scene) -> set[str]:
    """Return the names of the packages that the laws of a scene come from."""
    return {type(used.law).__module__.partition(".")[0] for used in in_use(scene)}


def packed(scene: Scene) -> Scene:
    """Return the scene with its files of heights under the names that they have in an FMU."""
    first, second = (
        surface if surface.heights is None else replace(surface, heights=surface.heights.packed)
        for surface in (scene.surface_1, scene.surface_2)
    )
    return replace(scene, surface_1=first, surface_2=second, film=_packed_film(scene))


def _packed_film(scene: Scene) -> Any:
    """Return the record of the film with a map from a file under the name that it has in an FMU."""
    film: Any = scene.film
    text = _map_text(scene)
    return film if text is None else replace(film, file=f"map_{zlib.crc32(text):08x}{MAP_SUFFIX}")


def _map_text(scene: Scene) -> bytes | None:
    """Return the map of the scene if it is one from a file; shipped ones come with the package.

    Raises SceneError if a scene at the level of maps has none.
    """
    file = map_file(scene.film)
    if file is None:
        return None
    chart = map_of(scene)
    return chart.to_text().encode() if file.endswith(MAP_SUFFIX) else None


def files(scene: Scene) -> dict[str, bytes]:
    """Return name and content of every file in `resources/` that both flavours have."""
    module, chart, scene = module_name(scene), _map_text(scene), packed(scene)
    given = (surface.heights for surface in (scene.surface_1, scene.surface_2))
    return {
        **{heights.file: heights.npy() for heights in given if heights is not None},
        **({str(map_file(scene.film)): chart} if chart is not None else {}),
        "scene.json": (json.dumps(scene.to_dict(), indent=1) + "\n").encode(),
        "versions.json": (json.dumps(versions_of(scene), indent=1) + "\n").encode(),
        "slavemodule.txt": module.encode(),
        f"{module}.py": script(MODEL, "fmu_src.runtime.slave.ContactSlave", "The contact of scene.json."),
    }


def _installed(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "none"


@functools.lru_cache(maxsize=64)
def read(folder: str, module: str) -> Scene:
    """Return the scene in an FMU's resources, for the script `module`; cached, so that a reset cannot fail.

    Raises SceneError if the FMU was built with another version, or edited.
    """
    try:
        known = json.loads(Path(folder, "versions.json").read_text("utf-8"))
        table = json.loads(Path(folder, "scene.json").read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise SceneError(
            f"The resources of the FMU in {folder} cannot be read ({error}). Build the FMU again."
        ) from None
    for package in {**VERSIONS, **known}:
        built_with, installed = known.get(package), VERSIONS.get(package) or _installed(package)
        if built_with != installed:
            raise SceneError(
                f"The FMU was built with {package} {built_with}, but {installed} is installed. "
                f"Build the FMU again, or install {package} {built_with}."
            )
    scene = Scene.from_dict(table, Path(folder))
    if module_name(scene) != module:
        raise SceneError(f"The scene of the FMU in {folder} was changed after building. Build the FMU again.")
    return scene
