"""The evolution over time: between two solved blocks, tribofilm and wear run on in closed form.

A block holds until the geometry has changed by `control.change`, a limit of time is reached or the inputs have moved,
however short or long the caller's steps are.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .deterministic.block import has_moved, instant_time, is_due, is_marching, solve_block, solve_instant
from .deterministic.growth_and_wear import area_of_node, evolved, track_rows, wear_speed
from .errors import OperatingPointError
from .laws.tribofilm import thickness
from .quantities import TABLE
from .regression.evolution import advance_means
from .scene import OperatingPoint, Scene, with_bodies
from .state import Body, ContactState, Outputs, RangeFlag
from .surfaces.patches import bare_heights, heights_of, roughness_of
from .surfaces.roughness import mean_roughness, rms_roughness
from .surfaces.track_means import folded

Array = NDArray[np.float64]

_COVERED = 1e-9  # a thinner tribofilm does not count as coverage [m]
_UPPER = 0.8  # of the thickest tribofilm: nodes of the mean of the thick film
_THIN = 3  # every third node along x and y is enough to tell the change of geometry
_GROOVE = 0.2  # weight of a groove's depth among changes of geometry
_NO_TIME = 1e-9  # s: shorter than any block
_LONGEST_STEP = 1e9  # s: a longer one is a mistake, and would never end


def advance(scene: Scene, op: OperatingPoint, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """Return the state and outputs after `dt` [s] under a held operating point; `state` stays as it is.

    dt = 0 evaluates the contact without moving time. Outputs hold at the end of the step; a wear rate is the step's
    volume divided by it. Raises OperatingPointError for inputs that cannot be used and ConvergenceError if the
    contact has no solution.
    """
    op.check()
    for refusal in (scene.refusal(op), *map(scene.tribofilm.refusal, _given_temperatures(scene, op))):
        if refusal:
            raise OperatingPointError(refusal)
    if not 0.0 <= dt <= _LONGEST_STEP:
        raise OperatingPointError(f"The step dt = {dt!r} s must be at least 0 and at most {_LONGEST_STEP:g} s.")
    if scene.film.name == "regression":
        return _advance_means(scene, op, state, dt)
    state = folded(scene, state)
    before = [body.worn for body in state.bodies]
    given, left = op, dt
    while True:
        op = _with_bodies(scene, given, state)
        marching = is_marching(scene, op, state)
        if not marching and is_due(scene, op, state):
            state = solve_block(scene, op, state)
        if left <= 0.0:
            break
        if marching:
            step, change = min(left, instant_time(scene, op)), 0.0
            state = solve_instant(scene, op, state, step)
        else:
            step, change = _longest_step(scene, op, state, left)
        left -= step
        flash = state.outputs.flash_temperature_rise
        first, second = (evolved(scene, op, body, i, step, flash) for i, body in enumerate(state.bodies))
        state = replace(
            state,
            time=state.time + step,
            bodies=(first, second),
            change=state.change + change,
            held=state.held + step,
            trends=state.trends.over(step, state.held),
            temperatures=_temperatures_after(scene, op, state, step),
        )
    if dt > 0.0:
        rates = [(body.worn - worn) / dt for body, worn in zip(state.bodies, before, strict=True)]
    else:
        rates = [_wear_rate_now(scene, op, state.bodies[i], i) for i in (0, 1)]
    outputs = replace(_with_surfaces(scene, op, state), wear_rate_1=rates[0], wear_rate_2=rates[1])
    return replace(state, outputs=outputs), outputs


def _advance_means(scene: Scene, op: OperatingPoint, state: ContactState, dt: float) -> tuple[ContactState, Outputs]:
    """`advance` at the fast level; where the bodies warm up, in steps in which neither oil nor surfaces change much."""
    hertz = scene.unit_hertz_at(op)
    pressure = hertz.pressure_max * hertz.growth(op.load)[0]
    if pressure > scene.plasticity.hardness:
        raise OperatingPointError(
            f"load = {op.load:g} N presses smooth bodies together with {pressure:.3g} Pa, above plasticity.hardness = "
            f"{scene.plasticity.hardness:g} Pa: film.model = 'regression' knows no such contact. Lower the load or "
            "enlarge the radii."
        )
    if scene.heat.bulk.name != "lumped" or dt == 0.0:
        return advance_means(scene, _with_bodies(scene, op, state), state, dt)
    before, left = [state.outputs.wear_volume_1, state.outputs.wear_volume_2], dt
    while left > 0.0:
        now, step = _with_bodies(scene, op, state), left
        after, outputs = advance_means(scene, now, state, step)
        while step > (longest := min(outputs.suggested_step, _cool_time(scene, now, after, step))) > _NO_TIME:
            step = longest
            after, outputs = advance_means(scene, now, state, step)
        warm = _temperatures_after(scene, now, after, step)
        state, left = replace(after, temperatures=warm), left - step
    rates = [(out - old) / dt for out, old in zip((outputs.wear_volume_1, outputs.wear_volume_2), before, strict=True)]
    bodies = _with_bodies(scene, op, state).bodies
    outputs = replace(
        outputs, wear_rate_1=rates[0], wear_rate_2=rates[1], temperature_1=bodies[0], temperature_2=bodies[1]
    )
    return replace(state, outputs=outputs), outputs


def _given_temperatures(scene: Scene, op: OperatingPoint) -> tuple[float, ...]:
    """The temperatures that the caller decides and the tribofilm feels; what bodies warm up to is told by a flag."""
    return with_bodies(scene, op, None).bodies if scene.heat.bulk.name == "inputs" else (op.temperature,)


def _with_bodies(scene: Scene, op: OperatingPoint, state: ContactState) -> OperatingPoint:
    """The operating point with bulk temperatures. Raises OperatingPointError if bodies have warmed out of all range."""
    now = with_bodies(scene, op, state.temperatures)
    hottest = TABLE["body_temperature_1"].maximum
    if scene.heat.bulk.name == "lumped" and not max(now.bodies) <= hottest:
        raise OperatingPointError(
            f"The bodies have warmed to {now.bodies[0]:.4g} K and {now.bodies[1]:.4g} K, above {hottest:g} K. Raise "
            "heat.bulk.conductance_1 and _2, or lower load or sliding speed."
        )
    return now


def _temperatures_after(scene: Scene, op: OperatingPoint, state: ContactState, step: float) -> tuple[float, float]:
    """Bulk temperatures [K] after `step` [s] of the present flow of heat."""
    return scene.heat.bulk.after(op.bodies, _heat_flows(op, state.outputs), op.temperature, step)


def _power_loss(op: OperatingPoint, outputs: Outputs) -> float:
    return max(0.0, -outputs.friction_force * op.sliding_speed - outputs.spin_torque * op.spin)


def _heat_flows(op: OperatingPoint, outputs: Outputs) -> tuple[float, float]:
    """What the contact puts into the bodies [W]: all of the power, together."""
    return outputs.heat_flow_1, _power_loss(op, outputs) - outputs.heat_flow_1


def _longest_step(scene: Scene, op: OperatingPoint, state: ContactState, left: float) -> tuple[float, float]:
    """Time [s] in which the block is used up, at most `left`, and the change of geometry [m] in it."""
    budget = scene.control.change - state.change
    rest = max(state.hold - state.held, _NO_TIME)
    step = min(left, rest, _cool_time(scene, op, state, left))
    samples = [_thinned(scene, body) for body in state.bodies]
    flash = state.outputs.flash_temperature_rise
    while True:  # the film's growth slows down: this ends within few rounds
        after = [evolved(scene, op, body, i, step, flash) for i, body in enumerate(samples)]
        change = max(_distance(*pair) for pair in zip(samples, after, strict=True))
        if change <= 1.01 * budget:
            return step, change if change < 0.9 * budget else budget  # near enough: the block is used up
        step *= min(max(budget / change, 0.05), 0.95)


def _cool_time(scene: Scene, op: OperatingPoint, state: ContactState, left: float) -> float:
    """A time [s] in which the bodies' own temperatures change the oil too little to ask for a new solution."""
    step = left
    while step > _NO_TIME:
        after = _temperatures_after(scene, op, state, step)
        if not has_moved(scene, replace(op, body_temperature_1=after[0], body_temperature_2=after[1]), op):
            break
        step *= 0.5
    return step


def _thinned(scene: Scene, body: Body) -> Body:
    """A body of every third node of its track."""
    rows = np.flatnonzero(track_rows(scene, body.wear.shape[0]))[::_THIN]
    return replace(body, **{name: getattr(body, name)[rows, ::_THIN] for name in Body.ARRAYS})


def _distance(before: Body, after: Body) -> float:
    """Rms change [m] of the heights by tribofilm and wear. Wear that is the same all along a row deepens the groove;
    the contact notices that far less than what happens to its asperities.
    """
    film = thickness(after.growth, after.removal) - thickness(before.growth, before.removal)
    worn = after.wear - before.wear
    groove = worn.mean(axis=1, keepdims=True)
    return float(np.sqrt(np.mean((film - worn + (1.0 - _GROOVE) * groove) ** 2)))


def _wear_rate_now(scene: Scene, op: OperatingPoint, body: Body, i: int) -> float:
    """Volume [m3/s] that a body loses now."""
    speed = wear_speed(scene, op, body, i, thickness(body.growth, body.removal))
    return float(speed.sum()) * area_of_node(scene, op, i)


def _with_surfaces(scene: Scene, op: OperatingPoint, state: ContactState) -> Outputs:
    """The last block's contact outputs with what the surfaces are now."""
    rows = state.rows
    track, middle = track_rows(scene, rows), track_rows(scene, rows, 2.0 / 3.0)
    values: dict[str, Any] = {}
    for i, (bare, body) in enumerate(zip(bare_heights(scene, rows), state.bodies, strict=True)):
        film, heights = thickness(body.growth, body.removal), heights_of(bare, body)
        rough = roughness_of(bare, heights)
        rubbed = film[track]
        covered, upper = rubbed > _COVERED, rubbed > _UPPER * rubbed.max()
        found = {
            "wear_volume": body.worn,
            "wear_depth": float(body.wear[track].mean()),
            "tribofilm": float(rubbed.mean()),
            "tribofilm_covered": float(rubbed[covered].mean()) if covered.any() else 0.0,
            "tribofilm_upper": float(rubbed[upper].mean()) if upper.any() else 0.0,
            "tribofilm_roughness": rms_roughness(film, middle),
            "roughness": rms_roughness(rough, middle),
            "roughness_ra": mean_roughness(rough, middle),
            "roughness_raw": rms_roughness(heights, middle),
            "coverage": float(covered.mean()),
            "load_cycles": body.cycles,
            "temperature": op.bodies[i],
        }
        values |= {f"{name}_{i + 1}": value for name, value in found.items()}
    flags = RangeFlag(state.outputs.range_flags) & ~RangeFlag.TRIBOFILM_TEMPERATURE
    if not all(scene.tribofilm.covers(temperature) for temperature in op.bodies):
        flags |= RangeFlag.TRIBOFILM_TEMPERATURE
    out = state.outputs
    power, heat = _power_loss(op, out), _heat_flows(op, out)
    step, _ = _longest_step(scene, op, state, 10.0 * scene.operation.duration)
    return replace(
        out,
        **values,
        **_errors(state, values),
        range_flags=int(flags),
        friction_fluid=out.friction_force - out.friction_solid,
        heat_flow_2=heat[1],
        power_loss=power,
        suggested_step=step,
    )


def uncertainty(state: ContactState) -> dict[str, tuple[float, float]]:
    """Half widths (two sigma, in the unit of the output) of the errors by time steps and by sampling of the moving
    surfaces, apart from each other, by the names of the outputs. The grid's error is in neither.
    """
    found = state.trends.half_widths()
    force = abs(state.outputs.friction_force)
    scale = state.outputs.friction_coefficient / force if force > 0.0 else 0.0
    for i, body in enumerate(state.bodies):
        name = f"roughness_{i + 1}"
        roughness = getattr(state.outputs, name)
        if roughness > 0.0:  # the noise of wear adds to its square
            found[name] = found[name][0], min(0.5 * body.noise / roughness, roughness)
    time, sampling = found["friction_force"]
    return found | {"friction_coefficient": (time * scale, sampling * scale)}


def _errors(state: ContactState, values: dict[str, Any]) -> dict[str, Any]:
    """Both errors together, relative to the outputs they belong to."""
    found = uncertainty(state)

    def relative(name: str, value: float) -> float:
        return float(np.hypot(*found[name])) / abs(value) if value != 0.0 else 0.0

    out = state.outputs
    return {
        "error_friction": relative("friction_coefficient", out.friction_coefficient),
        "error_film": relative("h_c", out.h_c),
        "error_tribofilm": max(relative(name, values[name]) for name in ("tribofilm_1", "tribofilm_2")),
        "error_wear": max(relative(name, values[name]) for name in ("wear_depth_1", "wear_depth_2")),
    }
