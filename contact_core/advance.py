"""The evolution over time: the contact is solved once per block, then tribofilm and wear run on in closed form.

A block samples the moving surfaces by a sweep of transient steps that carries each patch once through the contact. What a
surface point feels in it (its mean solid pressure, whether it is rubbed) drives tribofilm and wear until the geometry has changed
by `control.change` or the inputs have, however short or long the caller's steps are.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .contact import ContactFields, Transient, bare_heights, heights_of, patch_nodes, roughness_of, solve
from .errors import ContactError
from .laws.tribofilm import Ghanbarzadeh, thickness
from .scene import OperatingPoint, Scene
from .state import Body, ContactState, Outputs, RangeFlag, frozen
from .surfaces import rms_roughness

Array = NDArray[np.float64]

_SETTLING = 40  # transient steps after a new start before the sweep is sampled
_ITERATIONS = 30  # at most, of one transient step; a warm one needs about 20
_DRY_SNAPSHOTS = 8
_DRY_BLOCKS = 8  # blocks driven dry before a mixed solution is tried again
_GOLDEN = (0.7548776662466927, 0.5698402909980532)  # additive sequence R2 of Roberts (2018), low discrepancy in the plane
_LAMBDA_CAP = 1e3
_COVERED = 1e-9  # a thinner tribofilm does not count as coverage [m]


def advance(scene: Scene, op: OperatingPoint, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """Return the state and outputs after `dt` [s] under a held operating point; `state` stays as it is.

    dt = 0 evaluates the contact without moving time. Outputs hold at the end of the step; wear rates are the step's volume divided by
    it. Raises OperatingPointError for inputs that cannot be used and ConvergenceError if the contact has no solution.
    """
    op.check()
    if not (math.isfinite(dt) and dt >= 0.0):
        raise ContactError(f"The step dt = {dt!r} s must be finite and not negative.")
    volumes = [_wear_volume(scene, state.bodies[i], i) for i in (0, 1)]
    left = dt
    while True:
        if _is_due(scene, op, state):
            state = _solve_block(scene, op, state)
        if left <= 0.0:
            break
        step, change = _longest_step(scene, op, state, left)
        bodies = tuple(_evolved(scene, op, state, i, step) for i in (0, 1))
        left -= step
        state = replace(state, time=state.time + step, bodies=(bodies[0], bodies[1]), change=state.change + change)
    outputs = _with_surfaces(scene, op, state)
    if dt > 0.0:
        rates = [(_wear_volume(scene, state.bodies[i], i) - volumes[i]) / dt for i in (0, 1)]
    else:
        rates = [_wear_rate_now(scene, op, state, i) for i in (0, 1)]
    outputs = replace(outputs, wear_rate_1=rates[0], wear_rate_2=rates[1])
    return replace(state, outputs=outputs), outputs


# --- when the contact has to be solved again -----------------------------------------------------------------------------


def _is_due(scene: Scene, op: OperatingPoint, state: ContactState) -> bool:
    return state.solved_for is None or state.change >= scene.control.change or _has_changed(scene, op, state.solved_for)


def _has_changed(scene: Scene, op: OperatingPoint, old: OperatingPoint) -> bool:
    """Whether an input is further from the solved one than the scene tolerates (temperature: by the viscosity it makes)."""
    if (op.load == 0.0) != (old.load == 0.0):
        return True
    tolerated = scene.control.input_change
    speeds = max(abs(op.speed_1), abs(op.speed_2), abs(old.speed_1), abs(old.speed_2))
    slide = abs(op.sliding_speed - old.sliding_speed) > tolerated * max(abs(op.sliding_speed), abs(old.sliding_speed))
    viscosity = scene.lubricant.viscosity
    eta, eta_old = (float(viscosity(np.zeros(1), t)[0]) for t in (op.temperature, old.temperature))
    return (
        slide
        or abs(op.load - old.load) > tolerated * max(op.load, old.load)
        or abs(op.entrainment_speed - old.entrainment_speed) > tolerated * speeds
        or abs(eta - eta_old) > tolerated * max(eta, eta_old)
    )


def _longest_step(scene: Scene, op: OperatingPoint, state: ContactState, left: float) -> tuple[float, float]:
    """Time [s] until the change of geometry is used up, at most `left`, and the change [m] it makes."""
    allowed = max(scene.control.change - state.change, 1e-3 * scene.control.change)
    step = left
    for _ in range(60):
        change = _geometry_change(scene, op, state, step)
        if change <= allowed:
            return step, max(change, 0.0) if step == left else max(change, allowed)
        step *= max(0.9 * allowed / change, 0.1)
    return step, allowed


def _geometry_change(scene: Scene, op: OperatingPoint, state: ContactState, step: float) -> float:
    """Larger rms change of the two tracks' heights in a step."""
    changes = []
    for i in (0, 1):
        before, after = state.bodies[i], _evolved(scene, op, state, i, step)
        film = thickness(after.growth, after.removal) - thickness(before.growth, before.removal)
        changes.append(float(np.sqrt(np.mean((film - (after.wear - before.wear))[_track(scene, op)] ** 2))))
    return max(changes)


# --- tribofilm and wear between two solutions ---------------------------------------------------------------------------------


def _evolved(scene: Scene, op: OperatingPoint, state: ContactState, i: int, step: float) -> Body:
    """One body after `step` [s] of what its last solution made it feel."""
    body, law = state.bodies[i], scene.tribofilm
    speed = (op.speed_1, op.speed_2)[i]
    warm = op.temperature + state.outputs.flash_temperature_rise
    growth, removal = law.evolve(body.growth, body.removal, body.rubbing * step, warm)
    cover = 0.5 * (thickness(growth, removal) + thickness(body.growth, body.removal)) / law.full_thickness
    wear = body.wear + step * _wear_speed(scene, op, body, cover)
    cycles = body.cycles + abs(speed) * step / _track_length(scene, i)
    return replace(body, growth=frozen(growth), removal=frozen(removal), wear=frozen(wear), cycles=cycles)


def _wear_speed(scene: Scene, op: OperatingPoint, body: Body, cover: Array) -> Array:
    """Wear depth per second of a patch [m/s]."""
    return scene.wear.rate(body.pressure, cover, op.sliding_speed, scene.plasticity.hardness)


def _wear_rate_now(scene: Scene, op: OperatingPoint, state: ContactState, i: int) -> float:
    body = state.bodies[i]
    cover = thickness(body.growth, body.removal) / scene.tribofilm.full_thickness
    return float(_wear_speed(scene, op, body, cover).sum()) * _area_of_node(scene, i)


def _track_length(scene: Scene, i: int) -> float:
    return (scene.geometry.track_length_1, scene.geometry.track_length_2)[i]


def _area_of_node(scene: Scene, i: int) -> float:
    """Area of the track [m2] for which one node of the patch stands."""
    film = scene.film
    return film.spacing**2 * _track_length(scene, i) / film.domain


def _wear_volume(scene: Scene, body: Body, i: int) -> float:
    return float(body.wear.sum()) * _area_of_node(scene, i)


# --- one block: the sweep of the surfaces through the contact -------------------------------------------------------------------


@dataclass
class _Sweep:
    """Sums over the instants of a block."""

    pressures: tuple[Array, Array]
    touched: tuple[Array, Array]
    sums: dict[str, float]
    count: int = 0
    iterations: int = 0
    missed: int = 0  # mixed solutions that stayed short of the tolerance
    fallbacks: int = 0
    flags: RangeFlag = RangeFlag(0)


def _solve_block(scene: Scene, op: OperatingPoint, state: ContactState) -> ContactState:
    """Solve the contact over one sweep and store what the surfaces feel and what the contact gives."""
    shape = state.bodies[0].wear.shape
    sweep = _Sweep((np.zeros(shape), np.zeros(shape)), (np.zeros(shape), np.zeros(shape)), {})
    dry = state.dry_blocks_left > 0 and state.solved_for is not None and not _has_changed(scene, op, state.solved_for)
    if op.load == 0.0:
        _add(scene, op, state, solve(scene, op, state), sweep)
        state = replace(state, film=None)
    elif dry or op.entrainment_speed == 0.0:
        state = _dry_sweep(scene, op, state, sweep)
    else:
        state = _mixed_sweep(scene, op, state, sweep)
    return _with_block(scene, op, state, sweep, dry)


def _dry_sweep(scene: Scene, op: OperatingPoint, state: ContactState, sweep: _Sweep) -> ContactState:
    """Instants of dry contact at patch offsets of low discrepancy."""
    for _ in range(_DRY_SNAPSHOTS):
        speeds = (op.speed_1, op.speed_2)
        moves = [scene.film.domain * _GOLDEN[i] if speeds[i] != 0.0 else 0.0 for i in (0, 1)]
        state = _moved(scene, state, moves)
        fields = solve(scene, op, state, dry=True)
        _add(scene, op, state, fields, sweep)
        state = _yielded(scene, replace(state, film=None), fields)
    return state


def _mixed_sweep(scene: Scene, op: OperatingPoint, state: ContactState, sweep: _Sweep) -> ContactState:
    """Successive transient instants, a node apart, in which the faster surface moves by one patch length."""
    columns = scene.film.points - 1
    dt = scene.film.spacing / max(abs(op.speed_1), abs(op.speed_2))
    settled = state.film is not None and state.solved_for is not None and not _has_changed(scene, op, state.solved_for)
    start = -(0 if settled else _SETTLING)
    rougher = 0 if scene.surface_1.rq > scene.surface_2.rq else 1
    for k in range(start, columns):
        before = patch_nodes(scene, state.bodies[rougher])
        state = _moved(scene, state, [op.speed_1 * dt, op.speed_2 * dt])
        moved = (patch_nodes(scene, state.bodies[rougher]) - before + columns // 2) % columns - columns // 2
        fields = solve(scene, op, state, Transient(dt, moved, _ITERATIONS, settled or k > start))
        if k >= 0:
            _add(scene, op, state, fields, sweep)
        state = _yielded(scene, replace(state, film=_frozen_film(fields)), fields)
    return state


def _moved(scene: Scene, state: ContactState, moves: list[float]) -> ContactState:
    first, second = (
        replace(body, offset=(body.offset + move) % scene.film.domain) for body, move in zip(state.bodies, moves, strict=True)
    )
    return replace(state, bodies=(first, second))


def _yielded(scene: Scene, state: ContactState, fields: ContactFields) -> ContactState:
    """The state after half of the overlap has been pressed into each body, for good."""
    if not fields.overlap.any():
        return state
    first, second = (
        replace(body, plastic=frozen(body.plastic + 0.5 * _on_patch(fields.overlap, patch_nodes(scene, body))))
        for body in state.bodies
    )
    return replace(state, bodies=(first, second))


def _frozen_film(fields: ContactFields):  # type: ignore[no-untyped-def]
    film = fields.film
    for array in (film.pressure, film.fluid, film.solid, film.mass):
        frozen(array)
    return film


def _on_patch(field: Array, nodes: int) -> Array:
    """A field of the grid [ny, nx] on a patch [ny, nx - 1] that is shifted by `nodes`. The last column carries no pressure."""
    return np.roll(field[:, :-1], -nodes, axis=1)


def _add(scene: Scene, op: OperatingPoint, state: ContactState, fields: ContactFields, sweep: _Sweep) -> None:
    for i, body in enumerate(state.bodies):
        nodes = patch_nodes(scene, body)
        sweep.pressures[i][:] += _on_patch(fields.solid_pressure, nodes)
        sweep.touched[i][:] += _on_patch(fields.solid_pressure > 0.0, nodes)
    for name, value in _observed(scene, op, fields).items():
        sweep.sums[name] = sweep.sums.get(name, 0.0) + value
    sweep.count += 1
    sweep.iterations += fields.iterations
    sweep.missed += not fields.converged
    sweep.fallbacks += fields.route == "fallback"
    if fields.route == "mixed" and fields.inlet_nodes < 3.0:
        sweep.flags |= RangeFlag.INLET_UNRESOLVED
    edge = np.concatenate([fields.pressure[[1, -2], :].ravel(), fields.pressure[:, [1, -2]].ravel()])
    if fields.solid_pressure.any() and edge.max() > 0.01 * fields.pressure.max():
        sweep.flags |= RangeFlag.DOMAIN_EDGE


def _observed(scene: Scene, op: OperatingPoint, fields: ContactFields) -> dict[str, float]:
    """The outputs of one instant."""
    cell, load = scene.film.spacing**2, op.load
    shear = float((fields.fluid_shear + fields.solid_shear).sum()) * cell
    slope = np.gradient(fields.fluid_pressure, scene.film.spacing, axis=1)
    hertz = scene.hertz(load) if load > 0.0 else None
    x, y = fields.x[None, :], fields.y[:, None]
    nearest = (x**2 + y**2) <= (x**2 + y**2).min() * (1 + 1e-9)
    if hertz is not None:
        radius_2 = (x / hertz.a) ** 2 + (y / hertz.b) ** 2
        disc, inside = radius_2 < 4.0 / 9.0, radius_2 < 1.0
    else:
        disc = inside = nearest
    disc, inside = disc | nearest, inside | nearest
    h_c = float(fields.gap[disc].mean())
    sigma = float(fields.roughness[disc].std())
    contact = fields.solid_pressure > 0.0
    return {
        "friction_force": -shear,
        "friction_coefficient": abs(shear) / load if load > 0.0 else 0.0,
        "rolling_resistance": float((0.5 * fields.gap * slope).sum()) * cell,
        "h_c": h_c,
        "h_central": float(fields.gap[nearest].mean()),
        "h_min": float(fields.gap[inside].min()),
        "lambda_ratio": min(h_c / sigma, _LAMBDA_CAP) if sigma > 0.0 else _LAMBDA_CAP,
        "contact_area_ratio": float(contact.sum()) * cell / hertz.area if hertz else 0.0,
        "contact_load_ratio": float(fields.solid_pressure.sum()) * cell / load if load > 0.0 else 0.0,
        "pressure_max": float(fields.pressure.max()),
        "flash_temperature_rise": fields.flash_rise,
        "approach": -fields.film.rigid_gap,
    }


def _with_block(scene: Scene, op: OperatingPoint, state: ContactState, sweep: _Sweep, dry: bool) -> ContactState:
    """Store a block: exposure of the surfaces, outputs of the contact, and what decides about the next block."""
    old, columns = state.outputs, scene.film.points - 1
    bodies = []
    for i, body in enumerate(state.bodies):
        # a moving point is under the contact for patch / track of its time, a resting one always
        moving = (op.speed_1, op.speed_2)[i] != 0.0
        share = scene.film.domain / _track_length(scene, i) if moving else 1.0
        pressure = sweep.pressures[i] / sweep.count * share
        bodies.append(replace(body, pressure=frozen(pressure), rubbing=frozen(_rubbing(scene, op, sweep, i))))
    seen = {name: total / sweep.count for name, total in sweep.sums.items()}
    fallback = sweep.fallbacks > 0.5 * sweep.count
    mixed = not dry and not fallback and op.entrainment_speed != 0.0 and op.load > 0.0
    flags = sweep.flags
    if sweep.missed:
        flags |= RangeFlag.NOT_CONVERGED
    if sweep.fallbacks:
        flags |= RangeFlag.FALLBACK
    if op.load > 0.0 and 2.0 * scene.hertz(op.load).a < 8.0 * scene.film.spacing:
        flags |= RangeFlag.FEW_NODES
    if seen["lambda_ratio"] >= _LAMBDA_CAP or op.load == 0.0:
        flags |= RangeFlag.LAMBDA_CAPPED
    outputs = replace(
        old,
        **seen,
        range_flags=int(flags),
        iterations=sweep.iterations,
        blocks_dry=old.blocks_dry + (0 if mixed or fallback else 1),
        blocks_mixed=old.blocks_mixed + (1 if mixed else 0),
        blocks_fallback=old.blocks_fallback + (1 if fallback else 0),
    )
    if mixed and seen["contact_load_ratio"] > scene.control.dry_above:
        dry_left = _DRY_BLOCKS
    else:
        dry_left = max(state.dry_blocks_left - 1, 0) if dry else 0
    return replace(state, bodies=(bodies[0], bodies[1]), solved_for=op, change=0.0, dry_blocks_left=dry_left, outputs=outputs)


def _rubbing(scene: Scene, op: OperatingPoint, sweep: _Sweep, i: int) -> Array:
    """Rubbing time per test time of each node of a patch, by the dose the tribofilm's constants were fitted with."""
    law = scene.tribofilm
    if not isinstance(law, Ghanbarzadeh) or op.sliding_speed == 0.0 and op.entrainment_speed == 0.0:
        return np.zeros_like(sweep.touched[i])
    if law.dose == "clock":
        return (sweep.touched[i] > 0.0).astype(np.float64)
    return sweep.touched[i] / sweep.count * scene.film.domain / (2.0 * scene.hertz(op.load).a)


# --- outputs that follow from the surfaces ----------------------------------------------------------------------------------------


def _track(scene: Scene, op: OperatingPoint, share: float = 1.0) -> NDArray[np.bool_]:
    """Rows of the patches with |y| < share * b."""
    b = scene.hertz(op.load if op.load > 0.0 else scene.operation.load).b
    rows: NDArray[np.bool_] = np.abs(scene.film.axis) < max(share * b, 0.51 * scene.film.spacing)
    return rows


def _with_surfaces(scene: Scene, op: OperatingPoint, state: ContactState) -> Outputs:
    """The last block's contact outputs with what the surfaces are now."""
    track, middle = _track(scene, op), _track(scene, op, 2.0 / 3.0)
    values: dict[str, float] = {}
    for i, (bare, body) in enumerate(zip(bare_heights(scene), state.bodies, strict=True)):
        film, heights = thickness(body.growth, body.removal), heights_of(bare, body)
        found = {
            "wear_volume": _wear_volume(scene, body, i),
            "wear_depth": float(body.wear[track].mean()),
            "tribofilm": float(film[track].mean()),
            "tribofilm_roughness": rms_roughness(film, middle),
            "roughness": rms_roughness(roughness_of(bare, heights), middle),
            "roughness_raw": rms_roughness(heights, middle),
            "coverage": float((film[track] > _COVERED).mean()),
            "load_cycles": body.cycles,
            "temperature": op.temperature,
        }
        values |= {f"{name}_{i + 1}": value for name, value in found.items()}
    flags = RangeFlag(state.outputs.range_flags) & ~RangeFlag.TRIBOFILM_TEMPERATURE
    if not scene.tribofilm.covers(op.temperature):
        flags |= RangeFlag.TRIBOFILM_TEMPERATURE
    out = state.outputs
    step, _ = _longest_step(scene, op, state, 10.0 * scene.operation.duration)
    return replace(
        out, **values, range_flags=int(flags), power_loss=max(-out.friction_force * op.sliding_speed, 0.0), suggested_step=step
    )
