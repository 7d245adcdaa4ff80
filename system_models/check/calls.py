"""Rules on calls that a host should not make, and on those at the edge: an FMU says so, and stands them."""

import math
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from fmpy.fmi1 import FMICallException

from ..fmu.kinds import kind
from .instance import Fmu, Instance, RefusedError, Row
from .library import Instead
from .rows import again, difference, reals_of
from .variables import is_readable
from .verdict import Answer, not_applicable, noted, passed, some

_OTHER_GUID = "00000000-0000-0000-0000-000000000000"
_LONG = b"x" * 100_000
_FOREIGN = b"\xff\xfe \xc3( \x80"  # no UTF-8


def guid(fmu: Fmu, notebook: Path) -> Answer:
    """Check that the binary refuses a guid, from FMI 3.0 on an instantiation token, that is not its own."""
    if _refused(fmu, {"token": _OTHER_GUID}):
        return passed("It refuses to be instantiated with another guid.")
    return noted("It is instantiated with another guid, too: nothing shows that description and binary do not match.")


def interface(fmu: Fmu, notebook: Path) -> Answer:
    """Check that an interface that the FMU does not have is refused."""
    if fmu.description.modelExchange is not None:
        return not_applicable("It has both interfaces.")
    if _refused(fmu, {"model_exchange": True}):
        return passed("It refuses to be instantiated for model exchange.")
    return noted("It is instantiated for model exchange, too, which it does not have.")


def resources(fmu: Fmu, notebook: Path) -> Answer:
    """Check that a missing resource location does no harm."""
    if _refused(fmu, {"resources": None}):
        return passed("Without a resource location it refuses to be instantiated.")
    return passed("It is instantiated without a resource location.")


def _refused(fmu: Fmu, instead: Instead) -> bool:
    try:
        instance = Instance(fmu, instead)
    except RefusedError:
        return True
    instance.free()
    return False


def stop_time(fmu: Fmu, notebook: Path) -> Answer:
    """Check that a step up to the stop time is made, and none beyond it."""
    stop = math.nextafter(fmu.start_time + fmu.step, -math.inf)  # hosts that add up their steps are as far beyond it
    fmu.where = f", with {stop!r} s as stop time"
    with fmu.instance() as instance:
        instance.initialise(stop=stop)
        instance.step()
        refused, said = instance.objection(instance.step)
    if refused:
        return passed(f"A step up to the stop time is taken, one beyond it is answered with {said}.")
    # FMI demands an error, but few exporters give it, and what was computed up to the stop time is right
    status = f" with {said}" if said else ", and nothing says so"
    error = f"{fmu.library.prefix}Error"
    return noted(f"A step beyond the stop time is taken{status}; FMI wants it to be answered with {error}.")


def communication_point(fmu: Fmu, notebook: Path) -> Answer:
    """Check that a step is noticed that does not begin where the last one has ended."""
    with fmu.started() as instance:
        instance.step()
        ended = instance.time
        instance.time += fmu.step
        refused, said = instance.objection(instance.step)
    about = f"A step from {ended + fmu.step:g} s after one that has ended at {ended:g} s"
    if refused or said:
        return passed(f"{about} is answered with {said}.")
    return noted(f"{about} is taken, and nothing says so: a host that loses a step will not know.")


def order(fmu: Fmu, notebook: Path) -> Answer:
    """Check that calls out of order are refused and change nothing."""
    accepted: list[str] = []

    def ask(instance: Instance, name: str, call: Callable[[], None]) -> None:
        refused, said = instance.objection(call)
        if not refused and not said:
            accepted.append(name)

    with fmu.instance() as instance:
        ask(instance, "a step before initialisation", instance.step)
    with again(fmu, steps=1) as get:
        expected = list(_onward(fmu, get()))
        instance = get()
        for name, call in (("Enter", instance.enter), ("Exit", instance.leave)):
            ask(instance, f"{fmu.library.prefix}{name}InitializationMode after a step", call)
        rows: list[Row] = []
        try:
            rows.extend(_onward(fmu, instance))
        except FMICallException:  # as FMI allows after an error
            fmu.fault = ""
        wrong = difference(rows, expected[: len(rows)])
    if wrong:
        return noted(f"After an initialisation mode that comes too late, {wrong}.")
    if accepted:
        return noted(f"Nothing is said to calls out of their turn: {some(accepted)}. They change nothing.")
    return passed("A step before initialisation, and an initialisation after a step, are refused and change nothing.")


def _onward(fmu: Fmu, instance: Instance) -> Iterator[Row]:
    """Yield outputs as they stand, and after another step."""
    yield reals_of(fmu, instance)
    instance.step()
    yield reals_of(fmu, instance)


def long_text(fmu: Fmu, notebook: Path) -> Answer | None:
    """Check that a String may be long. The next stage continues with other bytes."""
    if not _settable_texts(fmu):
        return not_applicable("There is no String to be set.")
    return _set_texts(fmu, _LONG)


def foreign_text(fmu: Fmu, notebook: Path) -> Answer:
    """Check that a String that is not UTF-8, by a mistake of the host, does no harm."""
    names = some(_settable_texts(fmu))
    return _set_texts(fmu, _FOREIGN) or passed(f"{names}: {len(_LONG)} bytes, and bytes that are no UTF-8, do no harm.")


def _settable_texts(fmu: Fmu) -> list[str]:
    """Return Strings that may be set before initialisation."""
    texts = [v for v in fmu.description.modelVariables if kind(v) == "string" and is_readable(v)]
    return [v.name for v in texts if v.causality in ("input", "parameter") and v.variability != "constant"]


def _set_texts(fmu: Fmu, text: bytes) -> Answer | None:
    """Set each String, get it again and initialise; refusals are allowed. An answer if one was fatal."""
    with fmu.instance() as instance:
        attempts: list[Callable[[], None]] = [
            partial(_set_and_get, instance, name, text) for name in _settable_texts(fmu)
        ]
        for attempt in (*attempts, instance.initialise):
            try:
                attempt()
            except FMICallException:
                if instance.fatal:
                    return noted(f"{fmu.fault}: no instance in the process may be used any more.")
                fmu.fault = ""  # it may refuse
    return None


def _set_and_get(instance: Instance, name: str, text: bytes) -> None:
    instance.put_text(name, text)
    instance.read([name])
