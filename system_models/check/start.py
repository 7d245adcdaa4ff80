"""Start values with which the rules run an FMU, where they are not its own."""

from collections.abc import Iterable

from fmpy.model_description import ModelDescription, ModelVariable

from ..fmu.errors import FmuError
from ..fmu.kinds import kind
from .variables import Start, attribute, is_readable

_LEVEL = "fidelity"  # an Integer parameter: the lowest is the cheapest
_TRUTH = {"true": 1, "1": 1, "false": 0, "0": 0}


def asked(description: ModelDescription, settings: Iterable[tuple[str, str]]) -> Start:
    """Return the start values that a user has given. Raises FmuError for what cannot be set."""
    variables = {v.name: v for v in description.modelVariables}
    found = {}
    for name, text in settings:
        variable = variables.get(name)
        if variable is None or variable.causality not in ("input", "parameter"):
            raise FmuError(f"'{name}' is no input or parameter of the FMU. Name one of them in --set.")
        if not is_readable(variable):
            raise FmuError(f"'{name}' is no single number, Boolean or String. Name another variable in --set.")
        try:
            found[name] = _value(variable, text)
        except (KeyError, ValueError):
            raise FmuError(f"{name} = '{text}' is no {variable.type}. Correct it in --set.") from None
        _check_range(variable, found[name])
    return found


def _check_range(variable: ModelVariable, value: float | int | str) -> None:
    """Raise FmuError for a number outside the declared range."""
    low, high = attribute(variable, "min"), attribute(variable, "max")
    if isinstance(value, str) or ((low is None or float(low) <= value) and (high is None or value <= float(high))):
        return
    if low == high:
        raise FmuError(f"{variable.name} = {value:g}: this FMU has no other value than {low}. Leave it out of --set.")
    bounds = [f"at least {low}"] * (low is not None) + [f"at most {high}"] * (high is not None)
    raise FmuError(f"{variable.name} = {value:g} must be {' and '.join(bounds)}. Correct it in --set.")


def _value(variable: ModelVariable, text: str) -> float | int | str:
    wanted = kind(variable)
    if wanted == "boolean":
        return _TRUTH[text.lower()]
    return text if wanted == "string" else int(text) if wanted == "integer" else float(text)


def cheapest(description: ModelDescription) -> Start:
    """Return the lowest level of an FMU that has several and starts at a higher one."""
    for variable in description.modelVariables:
        if variable.name == _LEVEL and variable.causality == "parameter" and kind(variable) == "integer":
            try:
                lowest, own = int(attribute(variable, "min") or ""), int(variable.start)
            except (TypeError, ValueError):  # the static rules say so
                return {}
            return {_LEVEL: lowest} if lowest < own else {}
    return {}


def sentence(description: ModelDescription, start: Start, wanted: Start) -> str:
    """Return a sentence on start values given by the user and chosen by the check; empty if there are none."""
    own = {v.name: v.start for v in description.modelVariables}
    said = [
        f"{name} = {value} (--set)"
        if name in wanted
        else f"{name} = {value}, the cheapest, where it starts with {own[name]} (--set {name}={own[name]} runs it so)"
        for name, value in start.items()
    ]
    if not said:
        return ""
    return f"The rules below run it with {', '.join(said)}; reference results are replayed with its own."
