"""The errors of a contact's outputs at the end of a run, apart by their causes, from the run's checkpoint."""

import json
import logging
from collections.abc import Mapping
from typing import Any

from contact_core import ContactState, Scene, StateError, uncertainty
from fmu_src.runtime.snapshot import contact_state

from ..master.saving import unpack
from ..store.checkpoint import Checkpoint

log = logging.getLogger(__name__)

ATTRIBUTE = "errors_json"  # of a contact's result: half widths by output and cause

Causes = Mapping[str, Mapping[str, float]]  # half widths (95 %) in the unit of the output, by output and by cause


def by_cause(scene: Scene, serialised: bytes) -> Causes:
    """Return the half widths of all outputs that have an error, from the serialised state of the contact's FMU."""
    data = contact_state(serialised)
    if not data:
        return {}
    errors = uncertainty(scene, ContactState.from_bytes(data, scene))
    return {name: dict(error._asdict()) for name, error in errors.items() if error.together > 0.0}


def at_point(scene: Scene, checkpoint: Checkpoint) -> Causes:
    """Return the same at the point that a checkpoint has saved; empty if it has none."""
    if checkpoint.saved is None:
        return {}
    states, _ = unpack(checkpoint.saved.state)
    (serialised,) = states.values()
    return by_cause(scene, serialised)


def attribute(scene: Scene, checkpoint: Checkpoint, end: float) -> dict[str, Any]:
    """Return the errors at the end of a run [s] as an attribute of its result; none if no checkpoint is at the end."""
    try:
        read = Checkpoint.read(checkpoint.file.parent)
    except StateError as error:  # the result is worth more than this
        log.warning("The errors are not known by their causes. %s", error)
        return {}
    if read is None or read[0].saved is None or read[0].saved.time != end:  # a disk that has refused
        return {}
    return {ATTRIBUTE: json.dumps(at_point(scene, read[0]))}
