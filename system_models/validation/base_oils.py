"""Pressure coefficients of base oils by two viscosities and a family, beside measured ones."""

import csv
from importlib.resources import files

from contact_core.laws.viscosity import AstmD341
from contact_core.quantities import CELSIUS
from contact_core.scene.bases import base_of

from .model import Outcome, Row, exactly, relative

# relative half widths of the measured coefficients by how they are known: constants fitted to viscometry; a fit of
# others to measurements without a name; a printed table that does not define its coefficient (slope or secant)
_KNOWN = {"viscometry": 0.03, "fitted": 0.05, "printed": 0.1}


def run() -> Outcome:
    """Compare d ln(viscosity)/dp at p = 0 of each oil at its temperatures."""
    text = (files(__package__) / "data" / "pressure_coefficients.csv").read_text("utf-8")
    return Outcome(tuple(map(_row, csv.DictReader(text.splitlines()))))


def _row(measured: dict[str, str]) -> Row:
    base, celsius = base_of(measured["base"]), float(measured["temperature_C"])
    value, provenance = float(measured["coefficient_per_GPa"]), measured["provenance"]
    cold, hot = (1e-6 * float(measured[f"viscosity_{at}_mm2s"]) for at in (40, 100))
    sheet = AstmD341(cold, hot, float(measured["density_15"]), 0.0, celsius + CELSIUS)
    computed, known = 1e9 * base.oil(sheet).pressure_coefficient, _KNOWN[provenance]
    return Row(
        f"{measured['oil']} at {celsius:g} degC", "1/GPa", exactly(value), computed, relative(value, known),
        f"{provenance}: {100.0 * known:.0f} %, assumed", relative(computed, base.interval),
    )  # fmt: skip
