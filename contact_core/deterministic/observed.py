"""Outputs and range flags of one instant."""

from ..film.outputs import disc, film_outputs, open_outputs
from ..scene import Case
from ..state import RangeFlag
from .instant import ContactFields
from .rolling import couple

LAMBDA_CAP = 1e3
_HOTTEST = 0.01  # of Hertz's area: a single node's temperature depends on the grid


def observed(case: Case, fields: ContactFields) -> dict[str, float]:
    """Return the outputs of one instant by their names."""
    scene, grid = case.scene, case.grid(fields.y.size)
    nodes = max(round(_HOTTEST * case.hertz.area / grid.cell), 1) if case.loaded else 1
    hottest = fields.temperatures.hottest(nodes)
    found, warm = fields.friction, fields.temperatures
    seen = {
        "friction_force": found.force_solid + found.force_fluid,
        "friction_solid": found.force_solid,
        "friction_fluid": found.force_fluid,
        "spin_torque": found.spin_torque,
        "power_loss": found.power,
        "flash_temperature_rise": warm.flash_rise,
        "contact_temperature_max": hottest,
        "scuffing_ratio": scene.scuffing.ratio(hottest, case.op.temperature),
        "heat_flow_1": warm.into_1 * grid.repeats,
        "heat_flow_2": warm.into_2 * grid.repeats,
    }
    formula, sigma = 0.0, 0.0
    if case.loaded:
        hertz = case.hertz
        inside = disc(grid, hertz)
        carried = fields.pressure[inside].sum()
        seen |= film_outputs(grid, fields.film, fields.gap, fields.touching, case.op.load, hertz)
        seen |= {
            "rolling_resistance": couple(grid, fields.gap, fields.fluid_pressure),
            "contact_area_ratio_disc": float(fields.touching[inside].mean()),
            "contact_load_ratio_disc": float(fields.solid_pressure[inside].sum() / carried) if carried > 0.0 else 0.0,
        }
        sigma = float(fields.roughness[inside].std())
        formula = case.conventional_film
    else:
        seen |= open_outputs(grid, fields.film, fields.gap)
        none = ("rolling_resistance", "contact_area_ratio_disc", "contact_load_ratio_disc")
        seen |= dict.fromkeys(none, 0.0)
    for name, film in (("lambda_ratio", seen["h_c"]), ("lambda_conventional", formula)):
        seen[name] = min(film / sigma, LAMBDA_CAP) if sigma > 0.0 else LAMBDA_CAP
    return seen


def instant_flags(case: Case, fields: ContactFields) -> RangeFlag:
    """Return what makes one instant less sure."""
    flags = RangeFlag(0)
    if not case.loaded:
        return RangeFlag.LAMBDA_CAPPED
    if fields.route == "fallback":
        flags |= RangeFlag.FALLBACK
    if not fields.resolved:
        flags |= RangeFlag.INLET_UNRESOLVED
    edges = [fields.solid_pressure[:, [1, -2]]]
    if not case.shape.periodic:
        edges.append(fields.solid_pressure[[1, -2], :])
    if max(edge.max() for edge in edges) > 0.01 * fields.pressure.max():
        flags |= RangeFlag.DOMAIN_EDGE
    if 2.0 * case.hertz.a < 8.0 * case.scene.film.spacing:
        flags |= RangeFlag.FEW_NODES
    if not fields.roughness.any():
        flags |= RangeFlag.LAMBDA_CAPPED
    return flags
