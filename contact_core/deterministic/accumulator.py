"""What a block's instants add up to: what each surface point feels, and the mean outputs of the contact."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..film.outputs import disc, film_outputs, open_outputs
from ..reference import SmoothContact, dowson_line, hamrock_dowson
from ..scene import OperatingPoint, Scene
from ..state import ContactState, RangeFlag
from ..surfaces.patches import contact_grid, on_patch, patch_nodes
from .friction import Film, derivatives
from .instant import ContactFields

Array = NDArray[np.float64]

_LAMBDA_CAP = 1e3
_MANY = 0.1  # share of unconverged solutions that raises a flag


@dataclass
class Sweep:
    """Sums over the instants of a block; fields of both bodies lie on their patches."""

    pressures: tuple[Array, Array]
    exposures: tuple[Array, Array]
    since: tuple[Array, Array]  # passes since a node was last exposed
    outputs: list[dict[str, float]] = field(default_factory=list)
    iterations: int = 0
    mixed: int = 0
    missed: int = 0  # solutions that stayed short of the tolerance
    fallbacks: int = 0
    flags: RangeFlag = field(default_factory=lambda: RangeFlag(0))
    sheared: Film | None = None  # the last instant's

    @staticmethod
    def before(state: ContactState) -> "Sweep":
        """Sums of nothing, at the beginning of a block."""
        first, second = (body.since.copy() for body in state.bodies)
        zeros = [np.zeros_like(first) for _ in range(4)]
        return Sweep((zeros[0], zeros[1]), (zeros[2], zeros[3]), (first, second))

    @property
    def all_flags(self) -> RangeFlag:
        """The instants' flags, and one if many of them are not converged."""
        many = self.count > 0 and self.missed > _MANY * self.count
        return self.flags | (RangeFlag.NOT_CONVERGED if many else RangeFlag(0))

    @property
    def count(self) -> int:
        """Instants so far."""
        return len(self.outputs)

    def add(
        self,
        case: Case,
        state: ContactState,
        fields: ContactFields,
        passes: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Count one instant in. `passes`: the part of a pass through the contact each body makes until the next."""
        exposures = self.touch(case, state, fields, passes)
        for i, body in enumerate(state.bodies):
            self.pressures[i][:] += on_patch(fields.solid_pressure, patch_nodes(case.scene, body))
            self.exposures[i][:] += exposures[i]
        self.outputs.append(observed(case, fields))
        self.sheared = fields.sheared
        self.iterations += fields.iterations
        self.mixed += fields.route == "mixed"
        self.missed += not fields.converged
        self.fallbacks += fields.route == "fallback"
        self.flags |= _flags(case, fields)

    def touch(
        self,
        case: Case,
        state: ContactState,
        fields: ContactFields,
        passes: tuple[float, float],
    ) -> list[Array]:
        """Note which points are exposed in an instant; return the exposure on both patches."""
        found = [
            on_patch(exposure, patch_nodes(case.scene, body))
            for exposure, body in zip(_exposures(case, fields), state.bodies, strict=True)
        ]
        for since, exposed, part in zip(self.since, found, passes, strict=True):
            since += part
            since[exposed > 0.0] = 0.0
        return found

    def slopes(self, case: Case) -> dict[str, float]:
        """Derivatives of the friction in the last instant."""
        return derivatives(case, self.sheared) if self.sheared else {}

    def means(self) -> dict[str, float]:
        """Mean outputs of the instants."""
        return {name: sum(seen[name] for seen in self.outputs) / self.count for name in self.outputs[0]}

    def spread(self, *, apart: bool) -> dict[str, float]:
        """Standard deviation of these means, the instants being apart from each other or a march of neighbours."""
        effective = self.count if apart else 1
        return {name: float(np.std([seen[name] for seen in self.outputs])) / effective**0.5 for name in self.outputs[0]}


def _exposures(case: Case, fields: ContactFields) -> tuple[Array, Array]:
    """Exposure of both bodies on the grid, each at the temperature of its surface."""
    stresses = (fields.solid_pressure, fields.shear, fields.friction.slide if case.op.spin else case.op.sliding_speed)
    warm_1, warm_2 = fields.temperatures.surface_1, fields.temperatures.surface_2
    first = case.scene.tribofilm.exposure(*stresses, warm_1)
    alike = warm_1 is warm_2 or (isinstance(warm_1, float) and isinstance(warm_2, float) and warm_1 == warm_2)
    return first, first if alike else case.scene.tribofilm.exposure(*stresses, warm_2)


def observed(case: Case, fields: ContactFields) -> dict[str, float]:
    """What one instant gives to the outputs."""
    grid = contact_grid(case.scene, fields.y.size)
    found, warm = fields.friction, fields.temperatures
    seen = {
        "friction_force": found.force_solid + found.force_fluid,
        "friction_solid": found.force_solid,
        "spin_torque": found.spin_torque,
        "flash_temperature_rise": warm.flash_rise,
        "heat_flow_1": warm.into_1 * grid.repeats,
    }
    formula, sigma = 0.0, 0.0
    if case.loaded:
        hertz = case.hertz
        inside = disc(grid, hertz)
        carried = fields.pressure[inside].sum()
        slope = np.gradient(fields.fluid_pressure, case.scene.film.spacing, axis=1)
        seen |= film_outputs(grid, fields.film, fields.gap, case.op.load, hertz)
        seen |= {
            "rolling_resistance": float((0.5 * fields.gap * slope).sum()) * grid.cell,
            "contact_area_ratio_disc": float((fields.solid_pressure[inside] > 0.0).mean()),
            "contact_load_ratio_disc": float(fields.solid_pressure[inside].sum() / carried) if carried > 0.0 else 0.0,
        }
        sigma = float(fields.roughness[inside].std())
        formula = _formula_film(case)
    else:
        seen |= open_outputs(grid, fields.film, fields.gap)
        none = ("rolling_resistance", "contact_area_ratio_disc", "contact_load_ratio_disc")
        seen |= dict.fromkeys(none, 0.0)
    for name, film in (("lambda_ratio", seen["h_c"]), ("lambda_conventional", formula)):
        seen[name] = min(film / sigma, _LAMBDA_CAP) if sigma > 0.0 else _LAMBDA_CAP
    return seen


def _formula_film(case: Case) -> float:
    """Conventional central film [m] of the smooth bodies: Hamrock & Dowson's, for lines Dowson & Toyoda's; zero without
    entrainment.
    """
    if not case.entrained:
        return 0.0
    oil = case.scene.lubricant.viscosity, case.op.inlet_temperature
    contact = case.shape.smooth(case.op.load, case.op.entrainment_speed, *oil, case.scene.solids.reduced_modulus)
    formula = hamrock_dowson(contact) if isinstance(contact, SmoothContact) else dowson_line(contact)
    return formula[0]


def _flags(case: Case, fields: ContactFields) -> RangeFlag:
    """What makes one instant less sure."""
    flags = RangeFlag(0)
    if not case.loaded:
        return RangeFlag.LAMBDA_CAPPED
    if fields.route == "fallback":
        flags |= RangeFlag.FALLBACK
    if fields.route == "mixed" and fields.inlet_nodes < 3.0:
        flags |= RangeFlag.INLET_UNRESOLVED
    edges = [fields.solid_pressure[:, [1, -2]]]
    if not case.scene.shape().periodic:
        edges.append(fields.solid_pressure[[1, -2], :])
    if max(edge.max() for edge in edges) > 0.01 * fields.pressure.max():
        flags |= RangeFlag.DOMAIN_EDGE
    if 2.0 * case.hertz.a < 8.0 * case.scene.film.spacing:
        flags |= RangeFlag.FEW_NODES
    if not fields.roughness.any():
        flags |= RangeFlag.LAMBDA_CAPPED
    return flags
