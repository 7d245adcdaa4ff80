"""Conversion from the unit of one variable to that of another."""

import logging
import math
import re

from fmpy.model_description import ModelDescription, ModelVariable

from contact_core.errors import SceneError
from contact_core.quantities import CELSIUS
from contact_core.scene.units import unit as known_unit

from ..fmu.errors import CouplingError

log = logging.getLogger(__name__)

_EXPONENTS = ("m", "kg", "s", "K", "A", "mol", "cd")  # rad is a number: tools write rad/s and 1/s for the same
_TURNS = re.compile("Hz|rpm|rev|r/|turn|min")  # in names of units that count turns, where they have no rad
_TEMPERATURE = (0, 0, 0, 1, 0, 0, 0)
_ROUNDED = 1e-4  # of a decade: factors are written with few digits
_BY_NAME = {
    "degC": (1.0, CELSIUS),
    "°C": (1.0, CELSIUS),
    "degF": (1.0 / 1.8, 459.67 / 1.8),
}  # factor and offset to K


def conversion(
    source: ModelVariable, source_model: ModelDescription, target: ModelVariable, target_model: ModelDescription
) -> tuple[float, float]:
    """Return the factor and offset that turn a value of `source` into the unit of `target`.

    A variable without a unit gives and takes any. A difference (FMI's relativeQuantity) is converted without an offset.
    Raises CouplingError, the second half of a sentence, if the units measure different things or cannot be compared, or
    if one is a difference of temperatures, the other is not, and their units have an offset; in K, that is warned of.
    """
    if source.unit is None or target.unit is None:
        return 1.0, 0.0
    here, there = _base(source.unit, source_model), _base(target.unit, target_model)
    if here is None or there is None:
        if source.unit == target.unit:
            return 1.0, 0.0
        unknown = source.unit if here is None else target.unit
        raise CouplingError(
            f"the units '{source.unit}' and '{target.unit}' cannot be compared: its FMU does not say what "
            f"'{unknown}' is. Add a BaseUnit to its UnitDefinitions."
        )
    if here[0] != there[0]:
        raise CouplingError(
            f"the unit '{source.unit}' measures another quantity than '{target.unit}'. "
            "Connect variables of one quantity, or correct the unit in the FMU."
        )
    (base, factor, offset), (_, own_factor, own_offset) = here, there
    if base == _TEMPERATURE and bool(source.relativeQuantity) != bool(target.relativeQuantity):
        relative, absolute = (source, target) if source.relativeQuantity else (target, source)
        meaning = (
            f"'{relative.name}' in {relative.unit} is a difference (relativeQuantity), '{absolute.name}' in "
            f"{absolute.unit} is not."
        )
        if offset or own_offset:
            raise CouplingError(f"{meaning} Connect variables of one meaning, or correct relativeQuantity in the FMU.")
        log.warning("%s The value is passed on as it is.", meaning)
    return factor / own_factor, 0.0 if source.relativeQuantity else (offset - own_offset) / own_factor


def turns(
    source: ModelVariable, source_model: ModelDescription, target: ModelVariable, target_model: ModelDescription
) -> float | None:
    """Return the factor that is missing where one variable counts turns, as in Hz, and the other an angle (rad/s)."""
    here, there = ((variable.unit or "", model) for variable, model in ((source, source_model), (target, target_model)))
    if _counts_turns(*here) and _has_angle(*there):
        return 2.0 * math.pi
    return 0.5 / math.pi if _has_angle(*here) and _counts_turns(*there) else None


def power(
    first: ModelVariable, model: ModelDescription, second: ModelVariable, other: ModelDescription
) -> float | None:
    """Return the factor to watt of the product of two variables; None if it is no power, or if a unit is unknown."""
    bases = [_base(v.unit, m) if v.unit else None for v, m in ((first, model), (second, other))]
    if None in bases:
        return None
    (one, factor_1, _), (two, factor_2, _) = bases  # type: ignore[misc]
    product = tuple(a + b for a, b in zip(one, two, strict=True))
    return factor_1 * factor_2 if product == (2, 1, -3, 0, 0, 0, 0) else None


def _base(unit: str, model: ModelDescription) -> tuple[tuple[int, ...], float, float] | None:
    """Return exponents of the base units, factor and offset to them: as the FMU defines the unit, else by its name."""
    for definition in model.unitDefinitions:
        if definition.name == unit and definition.baseUnit is not None:
            base = definition.baseUnit
            return tuple(getattr(base, name) for name in _EXPONENTS), base.factor, base.offset
    if unit in ("", "1", "-"):
        return (0,) * len(_EXPONENTS), 1.0, 0.0
    if unit in _BY_NAME:
        return _TEMPERATURE, *_BY_NAME[unit]
    try:
        factor, exponents = known_unit(unit)
    except (SceneError, ValueError, KeyError):
        return None
    return (*exponents[:4], 0, 0, 0), factor, 0.0


def _has_angle(unit: str, model: ModelDescription) -> bool:
    """Return True if an angle is among the exponents of a unit: as the FMU defines it, else by its name."""
    for definition in model.unitDefinitions:
        if definition.name == unit and definition.baseUnit is not None:
            return bool(definition.baseUnit.rad)
    try:
        return bool(known_unit(unit)[1][4])
    except (SceneError, ValueError, KeyError):
        return False


def _counts_turns(unit: str, model: ModelDescription) -> bool:
    """Return True for a unit such as Hz or 1/min, whose factor has no 2 pi."""
    base = None if _has_angle(unit, model) or not _TURNS.search(unit) else _base(unit, model)
    decades = [math.log10(base[1] * times) for times in (1.0, 60.0)] if base is not None and base[1] > 0.0 else []
    return any(abs(each - round(each)) < _ROUNDED for each in decades)
