"""Rules on the units of variables."""

import math

from fmpy.model_description import BaseUnit, DisplayUnit, ModelDescription

from contact_core.errors import SceneError
from contact_core.quantities import CELSIUS
from contact_core.scene import units

from .model_rules import described, reals_of
from .variables import attribute
from .verdict import Answer, failed, noted, passed, some

_ROUNDED = 1e-5  # relative difference of a conversion for display that was written with few digits


@described
def unit_of_reals(description: ModelDescription) -> Answer:
    """Check that every unit is defined; FMI leaves open whether a Real has one, and a unit a base unit."""
    units_of = {v.name: attribute(v, "unit") for v in reals_of(description)}
    defined = {unit.name: unit for unit in description.unitDefinitions}
    unknown = [f"'{unit}' of {name}" for name, unit in units_of.items() if unit is not None and unit not in defined]
    if unknown:
        return failed(f"Not in UnitDefinitions: the unit {some(unknown)}.")
    if bare := [name for name, unit in units_of.items() if unit is None]:
        return noted(f"Without a unit: {some(bare)}; hosts cannot compare them. A number without dimension has '1'.")
    if empty := sorted({unit for unit in units_of.values() if unit and defined[unit].baseUnit is None}):
        return noted(f"Without a BaseUnit: the unit {some(empty)}, which so cannot be converted or compared.")
    return passed(f"{len(units_of)} Reals with {len({*units_of.values()})} units.")


@described
def unit_audit(description: ModelDescription) -> Answer:
    """Check that units with names of SI units are these units, and that display units convert as they are named."""
    known = count = 0
    without_rad = []
    for unit in description.unitDefinitions:
        count += 1 + len(unit.displayUnits)
        base, expected = unit.baseUnit, _si(unit.name)
        if base is None or base.mol:  # our mol is a number
            continue
        if expected is not None:
            known += 1
            right = math.isclose(base.factor, expected.factor, rel_tol=1e-9) and base.offset == expected.offset
            if not right or _dimension(base) != _dimension(expected):
                declared = f"The unit '{unit.name}' is declared as {_base(base)}"
                return failed(f"{declared}; by its name it is {_base(expected)}.")
            if expected.rad and not base.rad:
                without_rad.append(f"'{unit.name}'")
        for shown in unit.displayUnits:
            meant = _si(shown.name)
            if meant is None or meant.rad != (expected or base).rad:  # 1/min may count turns
                continue
            known += 1
            if wrong := _misconverted(base, shown, meant):
                return failed(f"The display unit '{shown.name}' of '{unit.name}' {wrong}.")
    if without_rad:
        return noted(
            f"The BaseUnit of {some(without_rad)} lacks rad. Hosts that compare exponents, such as OMSimulator, refuse "
            "to connect it with a unit that has it."
        )
    return passed(f"{known} of {count} unit names are known here, and mean what they say.")


def _misconverted(base: BaseUnit, shown: DisplayUnit, meant: BaseUnit) -> str:
    """Return the error of display = factor * value + offset, where the display's unit is `meant`."""
    if _dimension(base) != _dimension(meant):
        return f"is by its name {_base(meant)}, and cannot show {_base(base)}"
    factor, offset = base.factor / meant.factor, (base.offset - meant.offset) / meant.factor
    if math.isclose(shown.factor, factor, rel_tol=_ROUNDED) and math.isclose(shown.offset, offset, rel_tol=_ROUNDED):
        return ""
    return (
        f"has factor={shown.factor:g} offset={shown.offset:g}; by its name it has factor={factor:g} offset={offset:g}"
    )


def _si(name: str | None) -> BaseUnit | None:
    """Return the unit that a name means, if it is known here."""
    if name in ("degC", "°C"):
        return BaseUnit(K=1, offset=CELSIUS)
    try:
        factor, (m, kg, s, kelvin, rad) = units.unit(name or "?")
    except (SceneError, OverflowError):
        return None
    return BaseUnit(m=m, kg=kg, s=s, K=kelvin, rad=rad, factor=factor) if 0.0 < factor < math.inf else None


def _dimension(base: BaseUnit) -> tuple[int, ...]:
    """Return exponents of the base units but rad, which is a number."""
    return base.kg, base.m, base.s, base.A, base.K, base.cd


def _base(base: BaseUnit) -> str:
    exponents = ((axis, getattr(base, axis)) for axis in ("kg", "m", "s", "A", "K", "mol", "cd", "rad"))
    text = " ".join(f"{axis}={n}" for axis, n in exponents if n) or "a plain number"
    factor = f" factor={base.factor:g}" if base.factor != 1.0 else ""
    return text + factor + (f" offset={base.offset:g}" if base.offset else "")
