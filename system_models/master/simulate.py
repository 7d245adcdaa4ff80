"""The time loop."""

import bisect
import json
import logging
from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..fmu import messages
from ..fmu.errors import CouplingError
from ..fmu.instance import Instance
from ..store.checkpoint import Checkpoint
from . import reach, saving
from .controlled import ControlledStepper
from .coupled import Coupled
from .interrupt import deferred
from .recorder import Recorder
from .sequence import direct_loops
from .settings import Settings
from .stepping import Ended, Statistics, Stepper
from .system import System

log = logging.getLogger(__name__)

Observer = Callable[[float, Mapping[str, Instance]], None]

_MISJUDGED = 10.0  # times the largest value of an output: such a magnitude loosens the tolerance


def simulate(
    system: System,
    stop_time: float,
    step_size: float,
    *,
    outputs: Iterable[str] | None = None,
    checkpoint: str | Path | Checkpoint | None = None,
    resume: bool = False,
    about: Mapping[str, str] | None = None,
    history: Mapping[str, Callable[[float], float]] | None = None,
    progress: Callable[[float], None] | None = None,
    observe: Observer | None = None,
    **options: Any,
) -> xr.Dataset:
    """Simulate a system from the time 0 to `stop_time` [s] with the communication step `step_size` [s].

    options: the other fields of `Settings`: algorithm, order, iterate, tolerance and so on.

    outputs: the variables to record, by default all outputs; `valid` of FMUs of tribofmu comes with them. checkpoint: a
    folder in which the state is kept; with `resume` the simulation continues from there, bit for bit. Or a Checkpoint
    of the caller, who knows what it belongs to: its `saved` point, if any, is continued from. about: texts that a
    checkpoint keeps for its readers. history: the course of coupled outputs before the time 0, f(t) by name, for hold
    orders above 0. progress is called with the time reached; observe, before a checkpoint, with the time [s] of the
    first row and of the last one of each step, and with the running FMUs, which it must leave as they are.

    Returns a Dataset along `time`: the recorded variables by name, with units; "master.*", statistics of each step;
    "bond.*", the difference between the powers that the two FMUs of a bond compute. Its attributes count steps,
    iterations, unconverged, below_min_step, events and stopped_early among the steps that stand, and those rejected;
    invalid counts the rows in which one of the FMUs invalid_by, of tribofmu, says that it could not use its inputs,
    invalid_why what they have said last of something wrong;
    ended_by is the FMU that has asked for the end, receives_means those that take no derivatives of inputs, and `cost`
    gives, as JSON, all steps of each FMU and its seconds.

    Raises CouplingError for settings that make no sense or that the FMUs cannot serve, for an FMU that fails, and for
    values that are not finite; StateError for a checkpoint that is damaged or of another simulation.
    """
    settings = Settings(stop_time, step_size, **options)
    settings.check(system)
    reach.check(settings, system)
    ports = system.outputs(outputs)
    with ExitStack() as exits:
        store = checkpoint if isinstance(checkpoint, Checkpoint) else None
        if checkpoint is not None and store is None:
            past = {name: [float(course(time)) for time in settings.past] for name, course in (history or {}).items()}
            run = asdict(settings) | {"outputs": [port.name for port in ports], "history": past}
            store = exits.enter_context(saving.kept(Path(str(checkpoint)), system, ports, run, resume, about))
        check_interrupt = exits.enter_context(deferred())
        coupled = Coupled(system, ports, settings, exits)
        recorder = Recorder(coupled, ports)
        _warn_of_loops(system, settings)
        coupled.initialise()
        check_interrupt()  # an FMU that it has reached gives no initial values
        if history:
            _remember(coupled, history)
        if settings.tolerance is None:
            stepper = Stepper(coupled, recorder)
        else:
            stepper = ControlledStepper(coupled, recorder, settings.tolerance)
        stepper.check_interrupt = check_interrupt
        if store and store.saved:
            states, master = saving.unpack(store.saved.state)
            coupled.continue_from(states, master["coupled"])
            if store is checkpoint:
                saving.check_taken(coupled.instances, states, coupled.time)
            stepper.continue_from(master["stepper"])
            recorder.restore(store.saved.rows)
        else:
            recorder.add(recorder.start())
            if observe:
                observe(coupled.time, coupled.instances)
            if store:
                _save(store, coupled, recorder, stepper)
        _run(coupled, recorder, stepper, progress or (lambda time: None), observe, store, check_interrupt)
        _report(coupled, stepper.statistics)
        dataset = recorder.dataset(_attributes(coupled, stepper))
        return dataset.assign_attrs(_verdicts(system, dataset))


def _run(
    coupled: Coupled,
    recorder: Recorder,
    stepper: Stepper,
    progress: Callable[[float], None],
    observe: Observer | None,
    store: Checkpoint | None,
    check_interrupt: Callable[[], None],
) -> None:
    stop_time = coupled.settings.stop_time
    end = stop_time - coupled.settings.margin(stop_time)
    times = sorted({time for steps in coupled.system.schedule.values() for time, _ in steps if 0.0 < time < end})
    while coupled.time < end and not stepper.statistics.ended_by:
        try:
            rows = stepper.step(_limit(coupled, times))
        except Ended:
            break
        for row in rows:
            recorder.add(row)
        if coupled.set_scheduled(lambda time: abs(time - coupled.time) <= coupled.settings.margin(coupled.time)):
            stepper.begin_anew()
        if observe:
            observe(coupled.time, coupled.instances)
        if store and store.due():
            _save(store, coupled, recorder, stepper)
        progress(coupled.time)
        check_interrupt()
    if store and recorder.count > store.count and not stepper.statistics.ended_by:
        _save(store, coupled, recorder, stepper)


def _limit(coupled: Coupled, times: list[float]) -> float:
    """Return the time [s] beyond which the next step must not go: the end, an announced event or one of some times.

    Of those that are the same it is the event: its FMU waits for that very time.
    """
    settings, now = coupled.settings, coupled.time
    following = bisect.bisect_right(times, now + settings.margin(now))
    limit = min([settings.stop_time, *times[following : following + 1]])
    event = coupled.next_event()
    return min(event, settings.stop_time) if event <= limit + settings.margin(limit) else limit


def _save(store: Checkpoint, coupled: Coupled, recorder: Recorder, stepper: Stepper) -> None:
    states, memory = coupled.stored()
    state = saving.pack(states, {"coupled": memory, "stepper": stepper.stored()})
    store.save(coupled.time, state, recorder.table(store.count))


def _warn_of_loops(system: System, settings: Settings) -> None:
    if settings.iterate is None:
        for loop in direct_loops(system):
            log.warning(
                "%s depend on one another without delay, which one pass after a step does not solve. Use `iterate`.",
                ", ".join(loop),
            )


def _remember(coupled: Coupled, history: Mapping[str, Callable[[float], float]]) -> None:
    coupled_outputs = {coupled.wiring.outputs[place] for place in coupled.wiring.source}
    missing = sorted(coupled_outputs - set(history))
    if missing:
        raise CouplingError(
            f"The history lacks '{missing[0]}', which sets an input. Give its course before the time 0."
        )
    past = []
    for time in coupled.settings.past:
        outputs = coupled.outputs.copy()
        for name in coupled_outputs:
            outputs[coupled.wiring.output_place[name]] = history[name](time)
        past.append((time, outputs))
    coupled.remember(past)


def _report(coupled: Coupled, statistics: Statistics) -> None:
    """Warn of doubtful results."""
    if statistics.unconverged:
        log.warning(
            "The iteration has not converged in %d of %d steps; `master.residual` shows in which. Take smaller steps, "
            "or another method.",
            statistics.unconverged,
            statistics.steps,
        )
    if statistics.below_min_step:
        log.warning(
            "%d of %d steps are less accurate than the tolerance asks for, at min_step = %g s. Lower it, or look for "
            "an event that is not named.",
            statistics.below_min_step,
            statistics.steps,
            coupled.settings.smallest_step,
        )
    for place in np.flatnonzero(coupled.magnitudes.expected > _MISJUDGED * coupled.magnitudes.known):
        log.warning(
            "The tolerance was taken relative to %g for '%s', which has reached %g only: it names no nominal, and the "
            "first step was too long to judge it. Take a smaller step_size.",
            coupled.magnitudes.expected[place],
            coupled.wiring.outputs[place],
            coupled.magnitudes.known[place],
        )
    if statistics.ended_by:
        log.warning("The FMU '%s' has ended the simulation at %g s.", statistics.ended_by, coupled.time)


def _attributes(coupled: Coupled, stepper: Stepper) -> dict[str, Any]:
    instances = coupled.instances
    costs = {name: {"steps": each.steps, "seconds": each.seconds} for name, each in instances.items()}
    smooth = {name: not coupled.wiring.sampled[own].all() for name, own in coupled.wiring.input_of.items()}
    receives_means = [name for name, each in instances.items() if smooth[name] and not each.interpolates]
    if not coupled.settings.order:
        receives_means = []
    return asdict(stepper.statistics) | {"receives_means": ", ".join(receives_means), "cost": json.dumps(costs)}


def _verdicts(system: System, dataset: xr.Dataset) -> dict[str, Any]:
    """Return how many answers of the FMUs are invalid, as attributes, and warn of them."""
    invalid = {name: ~dataset[column].values.astype(bool) for name, column in system.verdicts.items()}
    by = ", ".join(name for name, rows in invalid.items() if rows.any())
    rows = np.logical_or.reduce([np.zeros(dataset.sizes["time"], dtype=bool), *invalid.values()])
    count = int(rows.sum())
    if count:
        log.warning(
            "%d of %d rows are invalid, the first at %g s: the outputs of %s stand as they were before.",
            count,
            len(rows),
            dataset["time"].values[rows][0],
            by,
        )
    why = " ".join(messages.cause(name, f"{name} says") for name in by.split(", ") if name in messages.said)
    return {"invalid": count, "invalid_by": by, "invalid_why": why}
