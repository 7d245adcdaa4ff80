"""Numbers of a machine that look like mistakes: roughness of its contacts, and what its duty asks of a test rig."""

from collections.abc import Iterator
from dataclasses import replace

from contact_core.scene import OperatingPoint

from .assembly import Assembly
from .kind import Kind
from .reading import Machine, duty_of
from .registry import kinds

_OF_CONTACT = ("entrainment_speed", "slide_roll_ratio", "load")  # signals of a duty that set a contact's inputs


def doubts(machine: Machine, assembly: Assembly) -> list[str]:
    """Return a sentence, with the way out, on each number that looks like a mistake.

    Loads and speeds of a contact follow from the duty alone where this is that of a test rig; those of other machines
    are known after the run.
    """
    kind = kinds()[machine.kind]
    found: dict[str, str] = {}  # contact by sentence: contacts of one scene have the same
    for name, contact in assembly.contacts.items():
        scene = contact.own_scene
        for sentence in scene.doubts(_points(machine, kind, scene.operation.point)):
            found.setdefault(sentence, name)
    return [f"{name}: {sentence}" for sentence, name in found.items()]


def _points(machine: Machine, kind: Kind, point: OperatingPoint) -> Iterator[tuple[str, OperatingPoint]]:
    """Yield the operating points that a rig's duty asks for, and the words for their rows."""
    if not {*_OF_CONTACT} <= {*kind.signals}:
        return
    table = machine.table.get("duty", {})
    where = f" of '{table['file']}'" if "file" in table else " of [duty]"
    for i, (time, values) in enumerate(duty_of(machine).filled()):
        speed, half = values["entrainment_speed"], 0.5 * values["slide_roll_ratio"]
        moved = replace(point, load=values["load"], speed_1=speed * (1.0 + half), speed_2=speed * (1.0 - half))
        yield f"row {i + 1}{where} (at {time:g} s)", moved
