"""One block: a sweep of the moving surfaces through the contact.

Mixed lubrication is marched through transient instants a node apart, until the faster surface has moved by one patch
length. Dry contact has no history: a few instants at surface offsets of low discrepancy sample it. Either way the
block ends with what a surface point feels (its mean solid pressure, whether it is rubbed) and with the mean outputs
of the contact.
"""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .contact import ContactFields, Transient, patch_nodes, solve
from .film.instant import Grid
from .film.outputs import disc, film_outputs, open_outputs
from .laws.tribofilm import Ghanbarzadeh
from .scene import OperatingPoint, Scene
from .state import ContactState, RangeFlag

Array = NDArray[np.float64]

_SETTLING = 80  # transient steps after a new start before the sweep is sampled: about one passage of the oil
_ITERATIONS = 40  # at most, of one transient step; a warm one needs about 20
_DRY_SNAPSHOTS = 8
_DRY_BLOCKS = 8  # blocks driven dry before a mixed solution is tried again
_GOLDEN = (0.7548776662466927, 0.5698402909980532)  # the additive sequence R2, of low discrepancy in the plane
_LAMBDA_CAP = 1e3
_MANY = 0.1  # share of unconverged solutions that raises a flag


def is_due(scene: Scene, op: OperatingPoint, state: ContactState) -> bool:
    """Whether geometry or inputs have moved so far that the contact has to be solved again."""
    used_up = state.change >= 0.999 * scene.control.change
    return state.solved_for is None or used_up or _has_moved(scene, op, state.solved_for)


def solve_block(scene: Scene, op: OperatingPoint, state: ContactState) -> ContactState:
    """Solve the contact over one sweep; time stands still. Store what the surfaces feel and what the contact gives."""
    same = state.solved_for is not None and not _has_moved(scene, op, state.solved_for)
    sweep = _Sweep.empty(state.bodies[0].wear.shape)
    dry = op.entrainment_speed == 0.0 or (same and state.dry_blocks_left > 0)
    if op.load == 0.0:
        sweep.add(scene, op, state, solve(scene, op, state))
        state = replace(state, film=None)
    elif dry:
        state = _dry_sweep(scene, op, state, sweep)
    else:
        state = _mixed_sweep(scene, op, state, sweep, same and state.film is not None)
    return _stored(scene, op, state, sweep)


def _has_moved(scene: Scene, op: OperatingPoint, old: OperatingPoint) -> bool:
    """Whether an input is further from the solved one than the scene tolerates; temperature counts by its viscosity."""
    viscosity = scene.lubricant.viscosity
    eta, eta_old = (float(viscosity(np.zeros(1), t)[0]) for t in (op.temperature, old.temperature))
    fastest = max(abs(op.speed_1), abs(op.speed_2), abs(old.speed_1), abs(old.speed_2))
    now_then_scale = (
        (op.load, old.load, max(op.load, old.load)),
        (op.entrainment_speed, old.entrainment_speed, fastest),
        (op.sliding_speed, old.sliding_speed, max(abs(op.sliding_speed), abs(old.sliding_speed))),
        (eta, eta_old, max(eta, eta_old)),
    )
    if (op.load == 0.0) != (old.load == 0.0) or (op.entrainment_speed == 0.0) != (old.entrainment_speed == 0.0):
        return True
    return any(abs(now - then) > scene.control.input_change * scale for now, then, scale in now_then_scale)


@dataclass
class _Sweep:
    """Sums over the instants of a block."""

    pressures: tuple[Array, Array]
    touched: tuple[Array, Array]
    sums: dict[str, float] = field(default_factory=dict)
    count: int = 0
    iterations: int = 0
    mixed: int = 0
    missed: int = 0  # solutions that stayed short of the tolerance
    fallbacks: int = 0
    flags: RangeFlag = field(default_factory=lambda: RangeFlag(0))

    @staticmethod
    def empty(shape: tuple[int, ...]) -> "_Sweep":
        """Sums of nothing."""
        return _Sweep((np.zeros(shape), np.zeros(shape)), (np.zeros(shape), np.zeros(shape)))

    def add(self, scene: Scene, op: OperatingPoint, state: ContactState, fields: ContactFields) -> None:
        """Count one instant in."""
        for i, body in enumerate(state.bodies):
            nodes = patch_nodes(scene, body)
            self.pressures[i][:] += _on_patch(fields.solid_pressure, nodes)
            self.touched[i][:] += _on_patch(fields.solid_pressure > 0.0, nodes)
        for name, value in _observed(scene, op, fields).items():
            self.sums[name] = self.sums.get(name, 0.0) + value
        self.count += 1
        self.iterations += fields.iterations
        self.mixed += fields.route == "mixed"
        self.missed += not fields.converged
        self.fallbacks += fields.route == "fallback"
        self.flags |= _flags(scene, op, fields)


def _dry_sweep(scene: Scene, op: OperatingPoint, state: ContactState, sweep: _Sweep) -> ContactState:
    steps = [scene.film.domain * golden * (speed != 0.0) for golden, speed in zip(_GOLDEN, _speeds(op), strict=True)]
    for _ in range(_DRY_SNAPSHOTS):
        state = _moved(scene, state, steps)
        fields = solve(scene, op, state, dry=True)
        sweep.add(scene, op, state, fields)
        state = _yielded(scene, replace(state, film=None), fields)
    return state


def _mixed_sweep(scene: Scene, op: OperatingPoint, state: ContactState, sweep: _Sweep, same: bool) -> ContactState:
    columns = scene.film.points - 1
    dt = scene.film.spacing / max(abs(speed) for speed in _speeds(op))
    rougher = 0 if scene.surface_1.rq > scene.surface_2.rq else 1
    if state.film is None:
        state = replace(state, film=solve(scene, op, state, dry=True).film)
    for k in range(0 if same else -_SETTLING, columns):
        before = patch_nodes(scene, state.bodies[rougher])
        state = _moved(scene, state, [speed * dt for speed in _speeds(op)])
        moved = (patch_nodes(scene, state.bodies[rougher]) - before + columns // 2) % columns - columns // 2
        fields = solve(scene, op, state, Transient(dt, moved, _ITERATIONS))
        if k >= 0:
            sweep.add(scene, op, state, fields)
        state = _yielded(scene, replace(state, film=fields.film), fields)
    return state


def _speeds(op: OperatingPoint) -> tuple[float, float]:
    return op.speed_1, op.speed_2


def _moved(scene: Scene, state: ContactState, steps: list[float]) -> ContactState:
    first, second = (
        replace(body, offset=(body.offset + step) % scene.film.domain)
        for body, step in zip(state.bodies, steps, strict=True)
    )
    return replace(state, bodies=(first, second))


def _yielded(scene: Scene, state: ContactState, fields: ContactFields) -> ContactState:
    """The state after half of the overlap has been pressed into each body, for good."""
    if not fields.overlap.any():
        return state
    first, second = (
        replace(body, plastic=body.plastic + 0.5 * _on_patch(fields.overlap, patch_nodes(scene, body)))
        for body in state.bodies
    )
    return replace(state, bodies=(first, second))


def _on_patch(grid: NDArray[Any], nodes: int) -> NDArray[Any]:
    """A field of the grid [ny, nx] on a patch [ny, nx - 1] shifted by `nodes`. The grid's last column carries no
    pressure.
    """
    return np.roll(grid[:, :-1], -nodes, axis=1)


def _observed(scene: Scene, op: OperatingPoint, fields: ContactFields) -> dict[str, float]:
    """The outputs of one instant."""
    cell = scene.film.spacing**2
    seen = {"flash_temperature_rise": fields.flash_rise}
    grid = Grid(fields.x, fields.y)
    if op.load > 0.0:
        hertz = scene.hertz(op.load)
        shear = float((fields.fluid_shear + fields.solid_shear).sum()) * cell
        slope = np.gradient(fields.fluid_pressure, scene.film.spacing, axis=1)
        seen |= film_outputs(grid, fields.film, fields.gap, op.load, hertz)
        seen |= {
            "friction_force": -shear,
            "friction_coefficient": abs(shear) / op.load,
            "rolling_resistance": float((0.5 * fields.gap * slope).sum()) * cell,
        }
        sigma = float(fields.roughness[disc(grid, hertz)].std())
    else:
        seen |= open_outputs(grid, fields.film, fields.gap)
        seen |= dict.fromkeys(("friction_force", "friction_coefficient", "rolling_resistance"), 0.0)
        sigma = 0.0
    seen["lambda_ratio"] = min(seen["h_c"] / sigma, _LAMBDA_CAP) if sigma > 0.0 else _LAMBDA_CAP
    return seen


def _flags(scene: Scene, op: OperatingPoint, fields: ContactFields) -> RangeFlag:
    """What makes one instant less sure."""
    flags = RangeFlag(0)
    if op.load == 0.0:
        return RangeFlag.LAMBDA_CAPPED
    if fields.route == "fallback":
        flags |= RangeFlag.FALLBACK
    if fields.route == "mixed" and fields.inlet_nodes < 3.0:
        flags |= RangeFlag.INLET_UNRESOLVED
    rows, columns = fields.solid_pressure[[1, -2], :], fields.solid_pressure[:, [1, -2]]
    if max(rows.max(), columns.max()) > 0.01 * fields.pressure.max():
        flags |= RangeFlag.DOMAIN_EDGE
    if 2.0 * scene.hertz(op.load).a < 8.0 * scene.film.spacing:
        flags |= RangeFlag.FEW_NODES
    if not fields.roughness.any():
        flags |= RangeFlag.LAMBDA_CAPPED
    return flags


def _stored(scene: Scene, op: OperatingPoint, state: ContactState, sweep: _Sweep) -> ContactState:
    """The state with a block's results: exposure of the surfaces, outputs, and what decides about the next block."""
    bodies = []
    slow, fast = sorted(abs(speed) for speed in _speeds(op))
    if op.load > 0.0 and 0.0 < slow < 0.9 * fast:
        sweep.flags |= RangeFlag.SLOW_BODY
    for i, (body, speed) in enumerate(zip(state.bodies, _speeds(op), strict=True)):
        # a moving point spends patch / track of its time in reach of the contact, a resting one all of it
        share = scene.film.domain / track_length(scene, i) if speed != 0.0 else 1.0
        pressure, rubbing = sweep.pressures[i] / sweep.count * share, _rubbing(scene, op, sweep, i)
        bodies.append(replace(body, pressure=pressure, rubbing=rubbing))
    seen = {name: total / sweep.count for name, total in sweep.sums.items()}
    driver = "fallback" if 2 * sweep.fallbacks > sweep.count else "mixed" if sweep.mixed else "dry"
    blocks, unconverged = f"blocks_{driver}", sweep.missed / sweep.count
    if unconverged > _MANY:
        sweep.flags |= RangeFlag.NOT_CONVERGED
    outputs = replace(
        state.outputs,
        **seen,
        **{blocks: getattr(state.outputs, blocks) + 1.0},
        range_flags=int(sweep.flags),
        iterations=sweep.iterations,
        unconverged=unconverged,
    )
    dry_left = max(state.dry_blocks_left - 1, 0)
    if driver == "mixed":
        dry_left = _DRY_BLOCKS if seen["contact_load_ratio"] > scene.control.dry_above else 0
    return replace(
        state, bodies=(bodies[0], bodies[1]), solved_for=op, change=0.0, dry_blocks_left=dry_left, outputs=outputs
    )


def _rubbing(scene: Scene, op: OperatingPoint, sweep: _Sweep, i: int) -> Array:
    """Rubbing time per test time of each node of a patch, by the dose the tribofilm's constants were fitted with."""
    law = scene.tribofilm
    if not isinstance(law, Ghanbarzadeh) or op.sliding_speed == 0.0:  # nothing rubs in pure rolling or at rest
        return np.zeros_like(sweep.touched[i])
    if law.dose == "clock":
        return (sweep.touched[i] > 0.0).astype(np.float64)
    return sweep.touched[i] / sweep.count * scene.film.domain / (2.0 * scene.hertz(op.load).a)


def track_length(scene: Scene, i: int) -> float:
    """Travel [m] of a point of body 1 (i = 0) or 2 (i = 1) between two passes."""
    return (scene.geometry.track_length_1, scene.geometry.track_length_2)[i]
