"""Identity of a contact's run: its scene, its duty, the version of this program."""

import json
from pathlib import Path
from typing import Any

import xarray as xr

import contact_core
from contact_core.scene import Scene

from ..store import results
from .duty import Duty


def identity(scene: Scene, duty: Duty, fields: int = 0) -> dict[str, Any]:
    """Return everything that decides the result of a run, as JSON has it; fields: how many times it keeps maps."""
    parts = {"version": contact_core.__version__, "duty": duty.fingerprint(), **scene.to_dict(), **_kept(fields)}
    return dict(json.loads(json.dumps(parts)))


def _kept(fields: int) -> dict[str, int]:
    return {"fields": fields} if fields else {}


def attributes(scene: Scene, duty: Duty, fields: int = 0) -> dict[str, Any]:
    """Return the same as attributes of a result."""
    return {
        "title": scene.description,
        "scene": scene.name,
        "scene_json": json.dumps(scene.to_dict()),
        "duty": duty.fingerprint(),
        "tribofmu_version": contact_core.__version__,
        **_kept(fields),
    }


def with_scene(dataset: xr.Dataset, scene: Scene, duty: Duty, fields: int = 0) -> xr.Dataset:
    """Return the dataset with its origin as attributes: Scene.from_dict makes the scene again from `scene_json`."""
    return dataset.assign_attrs(attributes(scene, duty, fields))


def find(folder: Path, scene: Scene, duty: Duty, fields: int = 0) -> xr.Dataset | None:
    """Return the result in `folder` of this scene and duty, with these fields, if there is one."""
    return results.find(attributes(scene, duty, fields), folder)
