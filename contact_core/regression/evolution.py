"""The evolution over time at the regression level: the track means of both surfaces. A step solves nothing.

The patches of the state stay; `surfaces.track_means` brings them up to date when a run returns to the other level.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..errors import ConvergenceError, OperatingPointError
from ..scene import Case, Scene, Side
from ..state import Classes, ContactState, Mean, Outputs, changed
from ..state.bulk_temperature import NO_TIME, cool_time, temperatures_after
from ..state.parts import check_parts, check_tries
from ..surfaces.damage_classes import classes_of
from ..surfaces.track_means import means_of
from .contact import MeanContact, evaluate
from .exposure import abrasion, doses, oxidised, solid_rate, track_area, wear_rate
from .fatigue import fatigued, harm_by, outputs_below
from .outputs import outputs_of
from .surfaces import Means, Tribofilms, added_friction, composite_roughness, mean_cover, regression_film, tribofilms_of

_SAME = 1e-4  # a contact evaluated before the surfaces changed by less, relative, is the contact after it
_AGREED = 0.05  # of control.change: contacts at both ends of a step may change the surfaces differently by so much
_TRIAL = 1.0  # s: step by which the speed of the surfaces' change is measured if no other step is known
_FURTHER = 2.0  # longest step over the last one that was right: a step that fails has cost its parts for nothing
_SHORT = 1e-6  # s: over a shorter step, differences of the surfaces are lost in rounding


ContactOf = Callable[[Case, Tribofilms], MeanContact]  # of a case and of both tribofilms


def advance(
    case: Case, state: ContactState, dt: float, contact_of: ContactOf = evaluate
) -> tuple[ContactState, Outputs]:
    """Return the state and outputs after `dt` [s] at the regression level.

    Where the bodies warm up, it takes steps in which neither oil nor surfaces change much. `contact_of` evaluates
    each contact, the one of the outputs last.
    """
    scene = case.scene
    _check_pressure(case)
    if not scene.heat.bulk.stores_heat:
        return _stepped(case, state, dt, contact_of, 0)[:2]
    if dt == 0.0:
        return _stepped(case.warmed(state.temperatures), state, dt, contact_of, 0)[:2]
    outputs, left, parts, trial = state.outputs, dt, 0, dt
    before = outputs.wear_volume_1, outputs.wear_volume_2
    while left > 0.0:
        now, step = case.warmed(state.temperatures), min(left, trial)
        after, outputs, parts = _stepped(now, state, step, contact_of, parts)
        while step > (longest := min(outputs.suggested_step, cool_time(now, after.outputs, step))) > NO_TIME:
            step = longest
            after, outputs, parts = _stepped(now, state, step, contact_of, parts)
        warm = temperatures_after(now, after.outputs, step)
        state, left = changed(after, temperatures=warm), left - step
        trial = _FURTHER * max(step, outputs.suggested_step)
    if dt >= _SHORT:
        volumes = outputs.wear_volume_1, outputs.wear_volume_2
        rates = [(out - old) / dt for out, old in zip(volumes, before, strict=True)]
        outputs = changed(outputs, wear_rate_1=rates[0], wear_rate_2=rates[1])
    bodies = case.warmed(state.temperatures).op.bodies
    outputs = changed(outputs, temperature_1=bodies[0], temperature_2=bodies[1])
    return changed(state, outputs=outputs), outputs


def _check_pressure(case: Case) -> None:
    """Raise OperatingPointError if smooth bodies would yield: no curve was fitted to such a contact."""
    hertz, hardness = case.unit_hertz, case.scene.plasticity.hardness
    pressure = hertz.pressure_max * case.growth[0]
    if pressure > hardness:
        raise OperatingPointError(
            f"load = {case.op.load:g} N presses smooth bodies together with {pressure:.3g} Pa, above "
            f"plasticity.hardness = {hardness:g} Pa: film.model = 'regression' has no such contact. Lower the load or "
            "enlarge the radii."
        )


def _stepped(
    case: Case, state: ContactState, dt: float, contact_of: ContactOf, parts: int
) -> tuple[ContactState, Outputs, int]:
    """Return the state and outputs after `dt` [s] at held bulk temperatures, and the parts of the caller's step so far.

    `parts` are those before.
    """
    before = state.means or means_of(case.scene, state)
    means, films, left = before, tribofilms_of(before), dt
    classes = classes_at(case.scene, state)
    contact = contact_of(case, films)
    harm = None if classes is None else harm_by(case, contact)
    step, speed = 0.0, 0.0  # of the last part [s]; at which the surfaces change [m/s]
    while left > 0.0:
        check_parts(case, parts)
        parts += 1
        start, newer = means, False
        step, means, films, speed = _substep(case, contact, start, left)
        left -= step
        if _has_changed(case, contact, films):
            contact, newer = contact_of(case, films), True
            settled = _settled(case, start, means, _evolved(case, contact, start, step))
            if settled is not means:
                means, films = settled, tribofilms_of(settled)
                contact = contact_of(case, films)
        if classes is not None and harm is not None:
            classes = fatigued(case.scene, classes, harm, start, means)
            if newer:
                harm = harm_by(case, contact)
    if step < _SHORT:
        speed = _substep(case, contact, means, _TRIAL)[3]
    if dt >= _SHORT:
        rates = [(now.worn - then.worn) / dt for now, then in zip(means, before, strict=True)]
    else:
        pairs = zip(case.sides, films, strict=True)
        rates = [wear_rate(case, side, contact, film.thickness, film.oxide) for side, film in pairs]
    if not math.isfinite(contact.solid + contact.fluid + contact.gap):
        op = case.op
        raise ConvergenceError(
            f"Friction or film at load = {op.load:g} N, speeds {op.speed_1:g} and {op.speed_2:g} m/s is not finite: "
            "the laws of the oil do not reach that far. Lower load or sliding speed."
        )
    below = {}
    if case.scene.stress.samples:
        below = outputs_below(case, state.outputs, harm or harm_by(case, contact), classes, means)
    outputs = outputs_of(case, state.outputs, contact, means, films, rates, speed, below)
    state = changed(state, time=state.time + dt, means=means, classes=classes, outputs=outputs, solved_for=None)
    return state, outputs, parts


def classes_at(scene: Scene, state: ContactState) -> Classes | None:
    """Return the damage of a state by classes; None where nothing damages."""
    if not (scene.stress.samples and scene.fatigue.damages):
        return state.classes
    return state.classes or classes_of(scene, state)


def _substep(case: Case, contact: MeanContact, means: Means, left: float) -> tuple[float, Means, Tribofilms, float]:
    """Return the time [s], at most `left`, in which the surfaces change by control.change; they after it; their speed.

    The speed [m/s] is the change over the time.
    """
    step, budget, tries = left, case.scene.control.change, 0
    while True:
        check_tries(case, tries)
        tries += 1
        after = _evolved(case, contact, means, step)
        change = max(_distance(means[0], after[0]), _distance(means[1], after[1]))
        if change <= 1.01 * budget:
            return step, after, tribofilms_of(after), change / step
        step *= min(max(budget / change, 0.05), 0.95)


def _settled(case: Case, start: Means, after: Means, again: Means) -> Means:
    """Return the surfaces after a step that contacts of its beginning and its end agree on, to first order.

    The contact of the start makes `after` of them, the contact after that makes `again`. Where more tribofilm grows
    less, the first goes too far, and a long step would swing about the balance of growth and removal.
    """
    first = np.array([_change(*pair) for pair in zip(start, after, strict=True)])
    second = np.array([_change(*pair) for pair in zip(start, again, strict=True)])
    back = float(np.vdot(first - second, first))
    if back <= 0.0 or float(np.abs(first - second).max()) < _AGREED * case.scene.control.change:
        return after
    share = 1.0 / (1.0 + back / float(np.vdot(first, first)))
    one, two = (_between(*pair, share) for pair in zip(after, again, strict=True))
    return one, two


def _between(one: Mean, other: Mean, share: float) -> Mean:
    return Mean(*(a + share * (b - a) for a, b in zip(one.__dict__.values(), other.__dict__.values(), strict=True)))


def _change(then: Mean, now: Mean) -> tuple[float, float]:
    """Return the changes [m] of a body's tribofilm, as rms over the track, and of its solid's roughness."""
    film = (now.growth - now.removal) - (then.growth - then.removal)
    return film / math.sqrt(max(now.coverage, 1e-3)), now.roughness - then.roughness


def _distance(then: Mean, now: Mean) -> float:
    """Return the size of the change [m]."""
    film, roughness = _change(then, now)
    return abs(film) + abs(roughness)


def _has_changed(case: Case, contact: MeanContact, films: Tribofilms) -> bool:
    """Return True if the surfaces differ from those that the contact was evaluated for."""
    return (
        abs(composite_roughness(films) - contact.sigma) > _SAME * contact.sigma
        or abs(mean_cover(case.scene, films) - contact.cover) > _SAME
        or abs(added_friction(case.scene, films) - added_friction(case.scene, contact.tribofilms)) > _SAME
    )


def _evolved(case: Case, contact: MeanContact, means: Means, step: float) -> Means:
    """Return both bodies after `step` [s] of the contact."""
    first, second = (
        _body_after(case, side, contact, mean, step, coverage, exposure * step)
        for side, mean, (coverage, exposure) in zip(case.sides, means, doses(case, contact, means), strict=True)
    )
    return first, second


def _body_after(
    case: Case, side: Side, contact: MeanContact, mean: Mean, step: float, coverage: float, exposed: float
) -> Mean:
    """Return a body whose covered part was `exposed`, worn under the mean of the old and the new tribofilm.

    Wear takes heights that stand out of the composite roughness by `smoothing` of it. A body's share in such a height
    is that of its variance, so its roughness falls by smoothing Rq_i / sigma for each depth worn (assumed).
    """
    growth, removal, formed, new = mean.growth, mean.removal, mean.formed, 0.0
    if coverage > 0.0:
        law: Any = case.scene.tribofilm
        abraded = abrasion(case, side, contact) * step / coverage
        warm = side.temperature + contact.rise
        before = growth / coverage, removal / coverage
        grown, removed = law.evolve(*before, exposed, abraded, warm)
        formed += coverage * float(law.formed(*before, grown, exposed, abraded, warm))
        growth, removal, new = float(grown) * coverage, float(removed) * coverage, max(float(grown - removed), 0.0)
    film = 0.5 * (contact.tribofilms[side.body].thickness + new)
    oxide, halfway, lost = oxidised(case, side, contact, film, mean.oxide, step)
    volume = step * solid_rate(case, side, contact, film, halfway) + lost * track_area(case, side)
    depth = volume / track_area(case, side)
    smoothing = regression_film(case.scene).smoothing
    smoother = math.exp(-smoothing * depth / contact.sigma) if contact.sigma > 0.0 else 1.0
    return changed(
        mean,
        growth=growth,
        removal=removal,
        coverage=coverage,
        wear=mean.wear + depth,
        roughness=mean.roughness * smoother,
        worn=mean.worn + volume,
        cycles=mean.cycles + abs(side.speed) * step / side.track_length,
        formed=formed,
        oxide=oxide,
    )


def warm_up(case: Case, state: ContactState) -> None:
    """Evaluate the contact once."""
    advance(case, state, 0.0)
