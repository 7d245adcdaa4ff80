"""Outputs of a step: the last block's contact on the surfaces as they are now, and how sure they are."""

from dataclasses import replace
from typing import Any

from ..scene import Case, Scene, Side
from ..state import (
    Body,
    ContactState,
    Error,
    Outputs,
    RangeFlag,
    flag_of_errors,
    flag_of_pits,
    flag_of_scuffing,
    flags_of_tribofilm,
)
from ..state.bulk_temperature import power_loss
from ..surfaces.patches import surface_now
from ..surfaces.roughness import mean_roughness, rms_roughness
from .damage import damage_of_track
from .solution_error import with_errors_of_the_solution

_COVERED = 1e-9  # a thinner tribofilm does not count as coverage [m]
_UPPER = 0.8  # of the thickest tribofilm: nodes of the mean of the thick film


def outputs_of(case: Case, state: ContactState, suggested_step: float) -> Outputs:
    """Return the last block's contact outputs with those of the surfaces now."""
    values: dict[str, Any] = {}
    for side, body in zip(case.sides, state.bodies, strict=True):
        found = _of_surface(case, side, body) | {"temperature": side.temperature}
        found["damage"] = damage_of_track(case.scene, state, side.body)
        values |= {f"{name}_{side.body + 1}": value for name, value in found.items()}
    out = with_heat(case, state)
    flags = RangeFlag(out.range_flags) & ~(RangeFlag.TRIBOFILM_TEMPERATURE | RangeFlag.BY_THE_CLOCK)
    flags |= flags_of_tribofilm(case.scene.tribofilm, case.op.bodies) | flag_of_scuffing(out.scuffing_ratio)
    flags |= flag_of_pits(values["micropitted_area_1"], values["micropitted_area_2"])
    errors = _error_outputs(case.scene, replace(state, outputs=replace(out, **values)), values)
    flags = flags & ~RangeFlag.UNSURE | flag_of_errors(errors, case.scene.control.accuracy)
    return replace(
        out,
        **values,
        **errors,
        range_flags=int(flags),
        suggested_step=suggested_step,
    )


def with_heat(case: Case, state: ContactState) -> Outputs:
    """Return the last block's outputs with power and heat at the present speeds, which differ little from its own.

    The bodies take a change of the power in the shares in which they took the block's. Where the film still follows
    inputs that have changed further, power and heat are those at the speeds of the last solution, as friction is.
    """
    out, block = state.outputs, state.trends.values()
    if state.solved_for is not None and case.differs_from(state.solved_for):
        case = Case(case.scene, state.solved_for)
    power, before, first = power_loss(case, out), block["power_loss"], block["heat_flow_1"]
    share = min(max(first / before, 0.0), 1.0) if before > 0.0 else 0.5
    first += share * (power - before)
    return replace(out, power_loss=power, heat_flow_1=first, heat_flow_2=power - first)


def _of_surface(case: Case, side: Side, body: Body) -> dict[str, float]:
    """Return the outputs of one surface by their names without the body's number."""
    heights, rough, track, middle = surface_now(case.scene, body, side.body)
    film = body.tribofilm
    rubbed = film[track]
    grown = float(body.formed[track].mean())
    covered, upper = rubbed > _COVERED, rubbed > _UPPER * rubbed.max()
    return {
        "wear_volume": body.worn,
        "wear_depth": float(body.wear[track].mean()),
        "micropitted_area": float((body.pits[track] > 0.0).mean()),
        "profile_loss": float((body.wear + body.pits)[track].mean()),
        "tribofilm": float(rubbed.mean()),
        "tribofilm_grown": grown,
        "tribofilm_removed": max(grown - float(rubbed.mean()), 0.0),
        "oxide": float(body.oxide[track].mean()),
        "tribofilm_covered": float(rubbed[covered].mean()) if covered.any() else 0.0,
        "tribofilm_upper": float(rubbed[upper].mean()) if upper.any() else 0.0,
        "tribofilm_roughness": rms_roughness(film, middle),
        "roughness": rms_roughness(rough, middle),
        "roughness_ra": mean_roughness(rough, middle),
        "roughness_raw": rms_roughness(heights, middle),
        "coverage": float(covered.mean()),
        "load_cycles": body.cycles,
    }


def errors_of(scene: Scene, state: ContactState) -> dict[str, Error]:
    """Return the errors of the outputs by name, each in the unit of its output, apart by their causes."""
    out, trends = state.outputs, state.trends
    found = {name: Error(time=time, sampling=sampling) for name, (time, sampling) in trends.half_widths().items()}
    for i, body in enumerate(state.bodies):
        name = f"roughness_{i + 1}"
        roughness = getattr(out, name)
        if roughness > 0.0:  # the noise of wear adds to its square
            found[name] = found[name]._replace(sampling=min(0.5 * body.noise / roughness, roughness))
    for i in (0, 1):
        late, sampling = state.below.errors(i) if state.below is not None else (0.0, 0.0)
        found[f"damage_{i + 1}"] = Error(time=late, sampling=sampling)
    if state.solved_for is not None and state.solved_for.load > 0.0:
        found = with_errors_of_the_solution(Case(scene, state.solved_for), out, found)
    force = abs(out.friction_force)
    scale = out.friction_coefficient / force if force > 0.0 else 0.0
    return found | {"friction_coefficient": found["friction_force"].scaled(scale)}


def _error_outputs(scene: Scene, state: ContactState, values: dict[str, Any]) -> dict[str, Any]:
    """Return the errors by all causes together, relative to the outputs they belong to."""
    found, out = errors_of(scene, state), state.outputs

    def relative(name: str, value: float) -> float:
        return found[name].together / abs(value) if value != 0.0 else 0.0

    return {
        "error_friction": relative("friction_coefficient", out.friction_coefficient),
        "error_rolling": relative("rolling_resistance", out.rolling_resistance),
        "error_film": relative("h_c", out.h_c),
        "error_load_ratio": found["contact_load_ratio"].together,
        **{f"error_{name}": relative(name, values[name]) for name in ("tribofilm_1", "tribofilm_2")},
        "error_wear": max(relative(name, values[name]) for name in ("wear_depth_1", "wear_depth_2")),
        "error_damage": max(relative(name, values[name]) for name in ("damage_1", "damage_2")),
    }
