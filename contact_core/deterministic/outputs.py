"""Outputs of a step: the last block's contact on the surfaces as they are now, and how sure they are."""

from dataclasses import replace
from typing import Any

import numpy as np

from ..scene import Case, Side
from ..state import Body, ContactState, Outputs, RangeFlag
from ..state.bulk_temperature import heat_flows, power_loss
from ..surfaces.patches import surface_now
from ..surfaces.roughness import mean_roughness, rms_roughness

_COVERED = 1e-9  # a thinner tribofilm does not count as coverage [m]
_UPPER = 0.8  # of the thickest tribofilm: nodes of the mean of the thick film


def outputs_of(case: Case, state: ContactState, suggested_step: float) -> Outputs:
    """Return the last block's contact outputs with those of the surfaces now."""
    values: dict[str, Any] = {}
    for side, body in zip(case.sides, state.bodies, strict=True):
        found = _of_surface(case, side, body) | {"temperature": side.temperature}
        values |= {f"{name}_{side.body + 1}": value for name, value in found.items()}
    out = state.outputs
    flags = RangeFlag(out.range_flags) & ~RangeFlag.TRIBOFILM_TEMPERATURE
    if not all(case.scene.tribofilm.covers(side.temperature) for side in case.sides):
        flags |= RangeFlag.TRIBOFILM_TEMPERATURE
    return replace(
        out,
        **values,
        **_errors(state, values),
        range_flags=int(flags),
        friction_fluid=out.friction_force - out.friction_solid,
        heat_flow_2=heat_flows(case, out)[1],
        power_loss=power_loss(case, out),
        suggested_step=suggested_step,
    )


def _of_surface(case: Case, side: Side, body: Body) -> dict[str, float]:
    """Return the outputs of one surface by their names without the body's number."""
    heights, rough, track, middle = surface_now(case.scene, body, side.body)
    film = body.tribofilm
    rubbed = film[track]
    covered, upper = rubbed > _COVERED, rubbed > _UPPER * rubbed.max()
    return {
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
    }


def uncertainty(state: ContactState) -> dict[str, tuple[float, float]]:
    """Return the errors by time steps and by sampling of the moving surfaces, apart from each other.

    Keys are names of outputs, values half widths (two sigma) in the unit of the output. The grid's error is in neither.
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
    """Return both errors together, relative to the outputs they belong to."""
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
