"""The base of all slaves: variables by value reference, and a sentence in the log for what cannot be got or set."""

import sys
from abc import abstractmethod
from collections.abc import Callable, Collection, Sequence
from typing import Any

from pythonfmu import Fmi2Slave
from pythonfmu.enums import Fmi2Status

from contact_core import ContactError

from ..phases import Phase
from ..variables import ZERO, Causality, Kind, Value, Variable
from . import loader


class ByReference(Fmi2Slave):
    """A model with variables by value reference, among them the output `valid` and the independent `time`.

    Attributes, to be read only; places in both lists are value references:

    values : the present value of each variable. The list object stays the same for the life of the instance.
    layout : for each variable its kind ("Real", "Integer", ...) and its role (see `_role`). An isolated FMU's process
        sends this to the host.
    phase : phase of the instance.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._module = type(self).__module__  # of the FMU's own class: names the FMU in its resources and states
        loader.tidy(self.resources, type(self).__name__)
        try:
            self._variables = self._read()
        except ContactError as error:
            print(error, file=sys.stderr)  # the host only learns that the FMU cannot be instantiated
            raise
        self._references = {v.name: vr for vr, v in enumerate(self._variables)}
        self.values: list[Value] = [v.start for v in self._variables]
        direct = {name for v in self._variables for name in v.direct}
        self.layout = tuple((v.kind, _role(v, direct)) for v in self._variables)
        self._inputs = [(v.name, vr) for vr, v in enumerate(self._variables) if v.causality == "input"]
        self._settable = {
            (kind, stepping): {vr for vr in self._references.values() if not self._objection(vr, kind, stepping)}
            for kind in ZERO
            for stepping in (False, True)
        }
        self.phase = Phase.NEW

    @abstractmethod
    def _read(self) -> Sequence[Variable]:
        """Read the model from the resources and return its variables. Raises ContactError if it cannot be used."""

    @abstractmethod
    def refresh(self) -> None:
        """Bring the outputs up to date before they are read."""

    @abstractmethod
    def _guard(self, action: Callable[..., None], *arguments: Any) -> None:
        """Run `action`; an exception becomes one log entry and valid = false."""

    def _refuse(self, reason: str, status: Fmi2Status, category: str) -> None:
        self.values[self._references["valid"]] = False
        self._message(reason, status, category)

    def _message(self, message: str, status: Fmi2Status, category: str) -> None:
        # the host reads the message as a printf format, the binary as strict UTF-8
        self.log(message.replace("%", "%%").encode("utf-8", "backslashreplace").decode(), status, category)

    def _value(self, name: str) -> Value:
        return self.values[self._references[name]]

    def _parameters(self, values: Sequence[Value]) -> dict[str, Any]:
        pairs = zip(self._variables, values, strict=True)
        return {v.name: value for v, value in pairs if v.causality == "parameter"}

    def _get(self, references: list[int], kind: Kind) -> list[Any]:
        if any(self._causality(vr) == "output" for vr in references):
            self.refresh()
        found = []
        for vr in references:
            known = self._causality(vr) is not None and self._variables[vr].kind == kind
            if not known:
                reason = f"There is no {kind} variable with value reference {vr}."
                self._refuse(reason, Fmi2Status.warning, "logStatusWarning")
            found.append(self.values[vr] if known else ZERO[kind])
        return found

    def _set(self, references: list[int], values: Sequence[Value], kind: Kind) -> None:
        stepping = self.phase is Phase.STEPPING
        settable = self._settable[kind, stepping]
        pairs = list(zip(references, values, strict=True))
        if not settable.issuperset(references):
            for reference in references:
                if objection := self._objection(reference, kind, stepping):
                    self._refuse(objection, Fmi2Status.warning, "logStatusWarning")
            pairs = [(reference, value) for reference, value in pairs if reference in settable]
        if pairs:
            self._guard(self._store, pairs)

    def _store(self, pairs: Sequence[tuple[int, Value]]) -> None:
        """Store values by reference."""
        for reference, value in pairs:
            self.values[reference] = value
        if self.phase is Phase.SETTLED:
            self.phase = Phase.UNSETTLED

    def _objection(self, reference: int, kind: Kind, stepping: bool) -> str:
        """Return why a variable of this kind cannot be set now; an empty text if it can."""
        causality = self._causality(reference)
        if causality is None or self._variables[reference].kind != kind:
            return f"There is no {kind} variable with value reference {reference}."
        name = self._variables[reference].name
        if causality == "output":
            return f"{name} is an output and cannot be set."
        if causality == "independent":
            return f"{name} is the independent variable: fmi2SetupExperiment and fmi2DoStep set it."
        if stepping and self._variables[reference].variability == "fixed":
            return f"{name} is a parameter: set it before initialisation ends, or reset the FMU first."
        return ""

    def _causality(self, reference: int) -> Causality | None:
        return self._variables[reference].causality if 0 <= reference < len(self._variables) else None

    def get_real(self, vrs: list[int]) -> list[float]:
        """Return values of Real variables."""
        return self._get(vrs, "Real")

    def get_integer(self, vrs: list[int]) -> list[int]:
        """Return values of Integer variables."""
        return self._get(vrs, "Integer")

    def get_boolean(self, vrs: list[int]) -> list[bool]:
        """Return values of Boolean variables."""
        return self._get(vrs, "Boolean")

    def get_string(self, vrs: list[int]) -> list[str]:
        """Return values of String variables."""
        return self._get(vrs, "String")

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        """Set Real inputs or parameters; values are checked when they are used."""
        self._set(vrs, values, "Real")

    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        """Set Integer parameters."""
        self._set(vrs, values, "Integer")

    def set_boolean(self, vrs: list[int], values: list[bool]) -> None:
        """Refuse: no Boolean can be set."""
        self._set(vrs, values, "Boolean")

    def set_string(self, vrs: list[int], values: list[str | None]) -> None:
        """Set String parameters; a null pointer is an empty text."""
        self._set(vrs, [value or "" for value in values], "String")


def _role(variable: Variable, direct: Collection[str]) -> str:
    """Return the role of a variable for the host: its causality, "direct" or "tunable"; time is an "output"."""
    if variable.name in direct:
        return "direct"
    if variable.causality == "independent":
        return "output"  # it changes in every step
    return "tunable" if variable.variability == "tunable" else variable.causality
