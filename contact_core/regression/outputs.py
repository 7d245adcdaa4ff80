"""Outputs of the regression level."""

import math
from typing import Any

from ..laws.load_sharing import FittedSharing
from ..scene import Case, Scene
from ..state import (
    ContactState,
    Error,
    Outputs,
    RangeFlag,
    changed,
    flag_of_errors,
    flag_of_pits,
    flag_of_scuffing,
    flag_of_wear,
    flags_of_tribofilm,
)
from .contact import MeanContact
from .surfaces import Means, Tribofilms, regression_film

_LAMBDA_CAP = 1e3
_LONGEST = 10.0  # longest suggested step over the duty
_LAMBDA_CAPPED, _OUTSIDE_FIT = int(RangeFlag.LAMBDA_CAPPED), int(RangeFlag.OUTSIDE_FIT)  # numbers are faster to add up
_BLANK = Outputs()
# half widths of errors grow: twice beyond the fit, and by so much where a film or wear has changed the heights by this
# share of the roughness or more, for curves of fresh surfaces; not that of the exposure, which changes little in hours
_BEYOND, _RUN_IN, _CHANGED = 2.0, 2.0, 0.1
_UNKNOWN = 1e3  # relative error of wear where hardly any solids touch: wear is unknown there
# relative, of rolling resistance: of the formula, where solids carry all, and where no oil is left to the inlet
_ROLLING, _ROLLING_ON_SOLIDS, _ROLLING_STARVED = 0.33, 0.7, 0.7
# of roughness, which the formula has not: at lambda 1, falling with its square; at most; at most where a body stands
# still, whose roughness does not average out. By five shipped scenes at 0.2 to 30 times their speeds
_ROLLING_ROUGH, _ROLLING_ROUGHEST, _ROLLING_STANDING = 0.35, 0.8, 2.5
_LOCAL = 1.0  # relative error of tribofilms that grow by local stress: this level knows the mean stress only


def outputs_of(
    case: Case,
    before: Outputs,
    contact: MeanContact,
    means: Means,
    tribofilms: Tribofilms,
    rates: list[float],
    speed: float,
    below: dict[str, float],
) -> Outputs:
    """Return the outputs of this level; the others stay zero. Counters of solved blocks continue.

    `below` are those of what lies below the surfaces, with the error of what is damaged now.
    """
    force = contact.solid + contact.fluid
    hot_1, hot_2 = case.op.bodies
    first, second = means
    longest, errors = _LONGEST * case.scene.operation.duration, half_widths(case, contact)
    risk = case.scene.scuffing.ratio(contact.hottest, case.op.temperature)
    films = max(first.growth - first.removal, 0.0), max(second.growth - second.removal, 0.0)
    errors |= _of_history(before, films, means, errors)
    if below:
        errors["error_damage"] = _of_damage(before, below)
    return changed(
        _BLANK,
        friction_force=force,
        friction_coefficient=abs(force) / case.op.load if case.loaded else 0.0,
        friction_solid=contact.solid,
        friction_fluid=contact.fluid,
        dfriction_dspeed_1=contact.derivatives[0],
        dfriction_dspeed_2=contact.derivatives[1],
        dfriction_dload=contact.derivatives[2],
        dfriction_dtemperature=contact.derivatives[3],
        power_loss=contact.power,
        rolling_resistance=contact.rolling,
        wear_rate_1=rates[0],
        wear_rate_2=rates[1],
        wear_volume_1=first.worn,
        wear_volume_2=second.worn,
        wear_depth_1=first.wear,
        wear_depth_2=second.wear,
        h_c=contact.gap,
        h_central=contact.gap,
        lambda_ratio=_lambda_ratio(case, contact),
        tribofilm_1=films[0],
        tribofilm_2=films[1],
        tribofilm_grown_1=first.formed,
        tribofilm_grown_2=second.formed,
        tribofilm_removed_1=max(first.formed - films[0], 0.0),
        tribofilm_removed_2=max(second.formed - films[1], 0.0),
        oxide_1=first.oxide,
        oxide_2=second.oxide,
        tribofilm_roughness_1=tribofilms[0].roughness,
        tribofilm_roughness_2=tribofilms[1].roughness,
        roughness_1=tribofilms[0].both,
        roughness_2=tribofilms[1].both,
        contact_area_ratio=contact.area_ratio,
        contact_load_ratio=contact.load_ratio,
        flash_temperature_rise=contact.rise,
        contact_temperature_max=contact.hottest,
        scuffing_ratio=risk,
        temperature_1=hot_1,
        temperature_2=hot_2,
        heat_flow_1=contact.into_1,
        heat_flow_2=contact.power - contact.into_1,
        spin_torque=contact.spin_torque,
        approach=case.unit_hertz.approach_at(case.op.load) - contact.gap,
        range_flags=_flags(case, contact)
        | int(flag_of_errors(errors, case.scene.control.accuracy))
        | int(flag_of_scuffing(risk))
        | int(flag_of_wear(case.unit_hertz.a * case.growth[0], first.wear, second.wear))
        | int(
            flag_of_pits(*(below.get(f"profile_loss_{i}", mean.wear) - mean.wear for i, mean in enumerate(means, 1)))
        ),
        suggested_step=min(case.scene.control.change / speed, longest) if speed > 0.0 else longest,
        load_cycles_1=first.cycles,
        load_cycles_2=second.cycles,
        coverage_1=first.coverage,
        coverage_2=second.coverage,
        blocks_dry=before.blocks_dry,
        blocks_mixed=before.blocks_mixed,
        blocks_fallback=before.blocks_fallback,
        **({"profile_loss_1": first.wear, "profile_loss_2": second.wear} | below | errors),
    )


def _exposure_error(sharing: FittedSharing) -> float:
    """Return the relative half width of the exposed share of the rougher body: no tribofilm is less sure."""
    return sharing.HALF_WIDTHS["exposure_rougher"] / sharing.exposure_rougher


def _lambda_ratio(case: Case, contact: MeanContact) -> float:
    """Return lambda = h_c / sigma, at most 1000.

    sigma = composite rms roughness as worn: here of the track means, in a solved contact of the deformed surfaces over
    the area of h_c (`deterministic.observed`). The lambda of handbooks has new surfaces and the film by formula.
    """
    if contact.sigma == 0.0 or not case.loaded:
        return _LAMBDA_CAP
    return min(contact.gap / contact.sigma, _LAMBDA_CAP)


def _flags(case: Case, contact: MeanContact) -> int:
    flags = 0
    if contact.sigma == 0.0 or not case.loaded:
        flags |= _LAMBDA_CAPPED
    rough = contact.sigma > 0.0 or case.microroughness is not None
    if rough and case.loaded and not _fitted(case, contact):
        flags |= _OUTSIDE_FIT
    return flags | int(flags_of_tribofilm(case.scene.tribofilm, case.op.bodies))


def _fitted(case: Case, contact: MeanContact) -> bool:
    """Return True within the fit of the curves; those of exposure and coverage are of bodies that both move."""
    if contact.stated is not None and contact.stated.trust < 1.0:
        return False
    rubs_at_rest = case.op.slides and 0.0 in case.speeds
    return not rubs_at_rest and regression_film(case.scene).sharing.covers(*contact.fit)


def half_widths(case: Case, contact: MeanContact) -> dict[str, Any]:
    """Return the half widths (95 %) of the errors by the fit, relative, of contact_load_ratio absolute.

    Friction is wrong where load carried by oil is attributed to solids, and by the oil's own friction, but never by
    more than if solids carried all. Those of tribofilms and wear are of what grows and wears now. Without load the
    gap is that of bodies that just touch: nothing is known of it.
    """
    if not case.loaded:
        none = (
            "error_friction",
            "error_rolling",
            "error_load_ratio",
            "error_tribofilm_1",
            "error_tribofilm_2",
            "error_wear",
        )
        return dict.fromkeys(none, 0.0) | {"error_film": 1.0}
    force, share = abs(contact.solid + contact.fluid), contact.load_ratio
    sharing = regression_film(case.scene).sharing
    widths, clearance = sharing.WIDTHS, contact.fit.clearance
    beyond = 1.0 if _fitted(case, contact) else _BEYOND
    wider = run_in(case, contact) * beyond
    bare = contact.sigma > 0.0 and case.microroughness is None  # the curves know no solids that touch at a hard floor
    load = 1.0 if bare else wider * widths.of_load(share, clearance)
    oil = beyond * widths.of_oil(clearance, contact.oil_slope)  # rubbing changes what touches, not how oil shears
    solid = abs(contact.solid) / share if share > 0.0 else case.scene.boundary_friction.bare * case.op.load
    fluid = abs(contact.fluid) / (1.0 - share) if share < 1.0 else 0.0
    friction = math.hypot(abs(solid - fluid) * load, abs(contact.fluid) * oil)
    film = wider * widths.of_film(clearance)
    relative = min(friction / force, max(solid / force, 1.0)) if force > 0.0 else 0.0
    if contact.stated is not None:
        relative, film, load = contact.stated[:3]
    wear = min(load / share, _UNKNOWN) if share > 0.0 else _UNKNOWN * bare
    exposed = min(math.hypot(beyond * _exposure_error(sharing), wear), _UNKNOWN)
    grown = _LOCAL if case.scene.tribofilm.abrades else exposed
    return {
        "error_friction": relative,
        "error_rolling": _of_rolling(case, contact),
        "error_film": min(film, 1.0),
        "error_load_ratio": min(load, 1.0),
        "error_tribofilm_1": grown,
        "error_tribofilm_2": grown,
        "error_wear": wear,
    }


def _of_rolling(case: Case, contact: MeanContact) -> float:
    """Return the relative half width of the rolling resistance: by its formula, solids, short supply and roughness."""
    solids, starved = _ROLLING_ON_SOLIDS * contact.load_ratio, _ROLLING_STARVED * (1.0 - contact.supplied)
    rough = 0.0
    if contact.sigma > 0.0:
        most = _ROLLING_STANDING if 0.0 in case.speeds else _ROLLING_ROUGHEST
        rough = min(most, most / _ROLLING_ROUGHEST * _ROLLING_ROUGH * (contact.sigma / contact.gap) ** 2)
    return math.hypot(math.hypot(_ROLLING, solids), math.hypot(starved, rough))


def _of_history(before: Outputs, films: tuple[float, float], means: Means, now: dict[str, Any]) -> dict[str, float]:
    """Return the errors of tribofilms and wear: means of those before and of those of the growth, by amounts."""
    worn = max(means[0].wear - before.wear_depth_1 + means[1].wear - before.wear_depth_2, 0.0)
    depth = before.wear_depth_1 + before.wear_depth_2
    was = (before.tribofilm_1, before.error_tribofilm_1), (before.tribofilm_2, before.error_tribofilm_2)
    first, second = (
        _mean_error(error, held, now["error_tribofilm_1"], abs(film - held))
        for film, (held, error) in zip(films, was, strict=True)
    )
    return {
        "error_tribofilm_1": first,
        "error_tribofilm_2": second,
        "error_wear": _mean_error(before.error_wear, depth, now["error_wear"], worn),
    }


def _of_damage(before: Outputs, below: dict[str, float]) -> float:
    """Return the larger error of the damages: a mean of that before and of that of the growth, by amounts."""
    was = before.damage_1, before.damage_2
    return max(
        _mean_error(before.error_damage, held, below["error_damage"], abs(below[f"damage_{i}"] - held))
        for i, held in enumerate(was, 1)
    )


def _mean_error(before: float, held: float, now: float, made: float) -> float:
    return (before * held + now * made) / (held + made) if held + made > 0.0 else now


def errors_of(scene: Scene, state: ContactState) -> dict[str, Error]:
    """Return the errors of the outputs by name, each in the unit of its output; all by the curves."""
    out = state.outputs
    given = {
        "friction_force": abs(out.friction_force) * out.error_friction,
        "friction_coefficient": out.friction_coefficient * out.error_friction,
        "rolling_resistance": abs(out.rolling_resistance) * out.error_rolling,
        "h_c": out.h_c * out.error_film,
        "contact_load_ratio": out.error_load_ratio,
    }
    for body in (1, 2):
        given |= {
            f"{name}_{body}": getattr(out, f"{name}_{body}") * error
            for name, error in (
                ("tribofilm", getattr(out, f"error_tribofilm_{body}")),
                ("wear_depth", out.error_wear),
                ("damage", out.error_damage),
            )
        }
    return {name: Error(curves=half) for name, half in given.items()}


def run_in(case: Case, contact: MeanContact) -> float:
    """Return the factor by which errors are wider for surfaces that rubbing has changed."""
    if contact.sigma == 0.0:
        return 1.0
    pairs = zip(case.sides, contact.tribofilms, strict=True)
    changed = sum(film.thickness + abs(film.both - side.surface.rms) for side, film in pairs)
    return 1.0 + (_RUN_IN - 1.0) * min(changed / (_CHANGED * contact.sigma), 1.0)
