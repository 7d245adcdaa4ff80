"""No result of another run is replaced without a word."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from contact_core.errors import ContactError
from contact_core.scene.toml import flat

from ..store import results
from .listener import Listener

_SHOWN = 4  # settings that are named


def ask_before(folder: Path, origin: Mapping[str, Any], force: bool, listener: Listener, file: str = "result") -> None:
    """Say what result in a folder a run will replace.

    origin: what the new result will be, as its attributes; file: its name, without the suffix. Raises ContactError if
    the result there is of another scene, unless `force`d.
    """
    path = folder / f"{file}.nc"
    before = results.attributes_of(path)
    if before is None or origin.items() <= before.items():
        return
    old, new = _name(before), _name(origin)
    if old != new and not force:
        raise ContactError(
            f"'{path}' is the result of '{old}', and this is '{new}'. Use another --out, or --force to replace it "
            "(in Python: folder, force=True)."
        )
    what = f"'{path}', a result {_of(before, origin)}"
    listener.note(f"{what}, will be replaced. To keep it, stop and use another --out (in Python: folder).")


def _name(attributes: Mapping[str, Any]) -> str:
    """Return what a result is of: the name of a scene or machine, or the title of another system."""
    return str(next((attributes[key] for key in ("scene", "machine", "title") if key in attributes), "another tool"))


def _of(before: Mapping[str, Any], origin: Mapping[str, Any]) -> str:
    """Return how the run of a result differs from another one, in words."""
    if _name(before) != _name(origin):
        return f"of '{_name(before)}'"
    old, new = (flat(json.loads(each.get("scene_json", "{}"))) for each in (before, origin))
    changed = [key for key in {**old, **new} if old.get(key) != new.get(key)]
    if not changed:
        return "of another run"
    told = "; ".join(f"{key} {old.get(key, 'not given')}, now {new.get(key, 'not given')}" for key in changed[:_SHOWN])
    return f"with other settings ({told}{'; ...' if len(changed) > _SHOWN else ''})"
