"""Values in units people read."""

import math
from collections.abc import Mapping
from typing import Any

from contact_core.quantities import CELSIUS
from contact_core.scene.origins import Origin

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "u"), (1e-9, "n"))
_PREFIXED = frozenset({"m", "m/s", "Pa", "Pa s", "N", "J", "W"})


def written(value: Any, metadata: Mapping[str, Any], origin: Origin) -> str:
    """Return a value as its file has it, or in a unit people read; `metadata` are those of its field."""
    if isinstance(origin.written, str) and origin.written:
        return origin.written
    unit = metadata.get("unit", "")
    if isinstance(value, (list, tuple)):
        return f"{len(value)} given" if value else "none"
    if isinstance(value, str):
        return value or "none"
    if metadata.get("quantity") == "ThermodynamicTemperature":
        return f"{value - CELSIUS:.6g} degC"
    return readable(float(value), unit)


def readable(value: float, unit: str, digits: int = 6) -> str:
    """Return a value in SI with a prefix where its unit may have one."""
    if unit not in _PREFIXED or value == 0.0 or not math.isfinite(value):
        return f"{value:.{digits}g} {unit}".rstrip()
    factor, prefix = next(((f, p) for f, p in _PREFIXES if abs(value) >= 0.9999999 * f), _PREFIXES[-1])
    return f"{value / factor:.{digits}g} {prefix}{unit}"
