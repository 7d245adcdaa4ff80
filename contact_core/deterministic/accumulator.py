"""Sums over the instants of a block: exposure and pressure of each surface point, mean outputs of the contact."""

from dataclasses import dataclass, field

import numpy as np

from ..film.instant import Grid
from ..kernels.arrays import Array
from ..scene import Case
from ..state import ContactState, RangeFlag, flag_of_scuffing
from ..surfaces.patches import on_patches
from .friction import Film, derivatives
from .instant import ContactFields
from .observed import instant_flags, observed
from .rolling import beyond_grid, couple
from .subsurface import Traction, traction_of

_LEAST_SHARE = 1e-12  # of a touching area, that stresses are divided by
MANY = 0.1  # share of unconverged solutions that raises a flag


@dataclass
class Accumulator:
    """Sums over the instants of a block; fields of both bodies lie on their patches."""

    pressures: tuple[Array, Array]
    exposures: tuple[Array, Array]
    since: tuple[Array, Array]  # passes since a node had the exposure in `peaks`
    peaks: tuple[Array, Array]  # largest exposure in the last pass
    fluid: Array  # pressure of the oil, on the grid
    gap: Array  # likewise
    beyond: float = 0.0  # rolling resistance before the edge of the grid [N], summed
    outputs: list[dict[str, float]] = field(default_factory=list)
    iterations: int = 0
    mixed: int = 0
    unconverged: int = 0  # solutions that have not converged
    fallbacks: int = 0
    flags: RangeFlag = field(default_factory=lambda: RangeFlag(0))
    tractions: list[Traction] = field(default_factory=list)  # of the instants, where stresses are asked for
    filmed: Grid | None = None  # where the oil flowed
    sheared: Film | None = None  # the last instant's

    @staticmethod
    def before(state: ContactState) -> "Accumulator":
        """Return empty sums at the beginning of a block."""
        since, peaks = ([getattr(body, name).copy() for body in state.bodies] for name in ("since", "peak"))
        zeros = [np.zeros_like(since[0]) for _ in range(4)]
        rows, columns = since[0].shape
        tracks = (zeros[0], zeros[1]), (zeros[2], zeros[3]), (since[0], since[1]), (peaks[0], peaks[1])
        return Accumulator(*tracks, *np.zeros((2, rows, columns + 1)))

    @property
    def all_flags(self) -> RangeFlag:
        """The instants' flags, and one if many of them are not converged."""
        return self.flags | (RangeFlag.NOT_CONVERGED if self.share_unconverged > MANY else RangeFlag(0))

    @property
    def share_unconverged(self) -> float:
        """Share of the solutions that have not converged."""
        return self.unconverged / max(self.count, 1)

    @property
    def count(self) -> int:
        """Number of instants so far."""
        return len(self.outputs)

    @property
    def driver(self) -> str:
        """Solutions that drive the block: "mixed", "dry" or, where dry ones replace most mixed ones, "fallback"."""
        return "fallback" if 2 * self.fallbacks > self.count else "mixed" if self.mixed else "dry"

    def add(
        self,
        case: Case,
        state: ContactState,
        fields: ContactFields,
        passes: tuple[float, float] = (0.0, 0.0),
        *,
        sampled: bool = True,
    ) -> None:
        """Add one instant; not `sampled`, only note which points are exposed in it.

        `passes` is the part of a pass through the contact that each body makes until the next instant.
        """
        exposures = on_patches(case.scene, state, _exposures(case, fields))
        for since, peak, exposed, part in zip(self.since, self.peaks, exposures, passes, strict=True):
            since += part
            highest = (exposed > 0.0) & ((exposed >= peak) | (since >= 1.0))
            since[highest], peak[highest] = 0.0, exposed[highest]
        if not sampled:
            return
        pressures = on_patches(case.scene, state, (fields.solid_pressure, fields.solid_pressure))
        for i in (0, 1):
            self.pressures[i][:] += pressures[i]
            self.exposures[i][:] += exposures[i]
        if case.scene.stress.samples:
            self.tractions.append(traction_of(case.scene, state, fields))
        self.fluid += fields.fluid_pressure
        self.gap += fields.gap
        seen = observed(case, fields)
        self.sheared = fields.sheared
        self.beyond += beyond_grid(case, case.grid(fields.y.size))
        self.filmed = case.grid(fields.y.size)
        self.outputs.append(seen)
        self.iterations += fields.iterations
        self.mixed += fields.route == "mixed"
        self.unconverged += not fields.converged
        self.fallbacks += fields.route == "fallback"
        self.flags |= instant_flags(case, fields) | flag_of_scuffing(seen["scuffing_ratio"])

    def slopes(self, case: Case) -> dict[str, float]:
        """Return the derivatives of the friction in that film; none where no instant had one."""
        return derivatives(case, self.sheared) if self.sheared else {}

    def means(self) -> dict[str, float]:
        """Return the mean outputs of the instants; rolling resistance is that of their mean film."""
        means = {name: sum(seen[name] for seen in self.outputs) / self.count for name in self.outputs[0]}
        if self.filmed:
            rolling = couple(self.filmed, self.gap / self.count, self.fluid / self.count)
            means["rolling_resistance"] = rolling + self.beyond / self.count
        return means

    def spread(self, alike: float) -> dict[str, float]:
        """Return the standard deviation of these means; `alike`: mean correlation of two instants.

        Alike instants scatter less than their mean does. The roughness that is left in the mean film scatters alike.
        """
        n = self.count
        factor = ((1.0 + (n - 1) * alike) / (max(n - 1, 1) * (1.0 - alike))) ** 0.5
        return {name: factor * float(np.std([seen[name] for seen in self.outputs])) for name in self.outputs[0]}


def _exposures(case: Case, fields: ContactFields) -> tuple[Array, Array]:
    """Return the exposure of both bodies on the grid, each at the temperature of its surface."""
    law, op = case.scene.tribofilm, case.op
    speed = fields.friction.slide if op.spin else op.sliding_speed
    slipping = case.slipping(speed)
    warm_1, warm_2 = fields.temperatures.surface_1, fields.temperatures.surface_2

    def exposure(warm: Array | float) -> Array:
        if case.microroughness is None:
            rubbed = np.where(fields.solid_pressure > 0.0, slipping, 1.0)
            return rubbed * law.exposure(fields.solid_pressure, fields.shear, speed, warm)
        share = fields.touching  # of a node's area: there the solids' stresses are higher, beside it there are none
        closer = np.maximum(share, _LEAST_SHARE)
        shear = fields.oil_shear + fields.rubbing_shear / closer
        touching = law.exposure(fields.solid_pressure / closer, shear, speed, warm)
        beside = law.exposure(np.zeros_like(share), fields.oil_shear, speed, warm)
        return slipping * share * touching + (1.0 - share) * beside

    first = exposure(warm_1)
    alike = warm_1 is warm_2 or (isinstance(warm_1, float) and isinstance(warm_2, float) and warm_1 == warm_2)
    return first, first if alike else exposure(warm_2)
