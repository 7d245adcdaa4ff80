"""The errors of a contact's outputs at the end of a run, apart by their causes."""

import json
from collections.abc import Mapping

from contact_core import ContactState, Error, Scene, uncertainty
from fmu_src.runtime.snapshot import contact_state

from ..master.saving import unpack
from ..store.checkpoint import Checkpoint

ATTRIBUTE = "errors_json"  # of a contact's result: half widths by output and cause

Causes = Mapping[str, Mapping[str, float]]  # half widths (95 %) in the unit of the output, by output and by cause


def by_cause(errors: Mapping[str, Error]) -> Causes:
    """Return the half widths of all outputs that have an error."""
    return {name: dict(error._asdict()) for name, error in errors.items() if error.together > 0.0}


def attribute(errors: Mapping[str, Error]) -> dict[str, str]:
    """Return errors as an attribute of a result; none if nothing has been solved."""
    return {ATTRIBUTE: json.dumps(by_cause(errors))} if errors else {}


def at_point(scene: Scene, checkpoint: Checkpoint) -> Mapping[str, Error]:
    """Return the errors of a contact's outputs at the point that a checkpoint has saved; empty if it has none."""
    if checkpoint.saved is None:
        return {}
    states, _ = unpack(checkpoint.saved.state)
    (serialised,) = states.values()
    return of_state(scene, contact_state(serialised))


def of_state(scene: Scene, data: bytes) -> Mapping[str, Error]:
    """Return the errors of the outputs of a state, as bytes; empty without any: nothing has been solved."""
    return uncertainty(scene, ContactState.from_bytes(data, scene)) if data else {}
