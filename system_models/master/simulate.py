"""The time loop."""

import json
import math
from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import Any, Literal

import numpy as np
import xarray as xr

from ..checkpoint import Checkpoint
from . import saving
from .coupled import Coupled, Scheme
from .errors import CouplingError
from .recorder import Recorder
from .stepping import ControlledStepper, Ended, Stepper
from .system import System

_MIN_STEP = 1e-6  # of the step


def simulate(
    system: System,
    stop_time: float,
    step_size: float,
    algorithm: Literal["jacobi", "gauss_seidel"] = "jacobi",
    order: int = 0,
    iterate: Literal["fixed_point", "aitken", "quasi_newton"] | None = None,
    tolerance: float | None = None,
    iteration_tolerance: float | None = None,
    min_step: float | None = None,
    checkpoint: str | Path | None = None,
    resume: bool = False,
    outputs: Iterable[str] | None = None,
    horizon: float | None = None,
    history: Mapping[str, Callable[[float], float]] | None = None,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Simulate a system from 0 to `stop_time` [s]."""
    scheme = Scheme(algorithm, order, iterate, iteration_tolerance or 1e-6)
    ports = system.outputs(outputs)
    min_step = _MIN_STEP * step_size if min_step is None else min_step
    settings = {
        "stop_time": stop_time,
        "step_size": step_size,
        "algorithm": algorithm,
        "order": order,
        "iterate": iterate,
        "tolerance": tolerance,
        "iteration_tolerance": iteration_tolerance,
        "min_step": min_step,
        "outputs": [port.name for port in ports],
        "horizon": horizon,
        "history": sorted(history or ()),
    }
    with ExitStack() as exits:
        store = None
        if checkpoint is not None:
            store = exits.enter_context(saving.kept(Path(checkpoint), system, ports, settings, resume))
        coupled = Coupled(system, ports, scheme, exits)
        recorder = Recorder(coupled, ports)
        coupled.initialise(stop_time, tolerance)
        if history:
            _remember(coupled, history, order, step_size)
        stepper = (
            Stepper(coupled, recorder, step_size, min_step)
            if tolerance is None
            else ControlledStepper(
                coupled, recorder, step_size, min_step, tolerance, horizon or stop_time, iteration_tolerance is None
            )
        )
        if store and store.saved:
            states, master = saving.unpack(store.saved.state)
            coupled.go_on(states, master["coupled"])
            stepper.go_on(master["stepper"])
            recorder.restore(store.saved.rows)
        else:
            recorder.add(recorder.start())
        _run(coupled, recorder, stepper, stop_time, progress or (lambda time: None), store)
        return recorder.dataset(_attributes(coupled, stepper))


def _run(
    coupled: Coupled,
    recorder: Recorder,
    stepper: Stepper,
    stop_time: float,
    progress: Callable[[float], None],
    store: Checkpoint | None,
) -> None:
    times = sorted({time for steps in coupled.system.schedule.values() for time, _ in steps if 0.0 < time < stop_time})
    while coupled.time < stop_time and not stepper.statistics.ended_by:
        limit = min([time for time in times if time > coupled.time], default=stop_time)
        try:
            rows = stepper.step(limit)
        except Ended:
            break
        for row in rows:
            recorder.add(row)
        if coupled.set_scheduled(coupled.time):
            stepper.begin_anew()
        if store and store.due():
            _save(store, coupled, recorder, stepper)
        progress(coupled.time)
    if store and recorder.count > store.count and not stepper.statistics.ended_by:
        _save(store, coupled, recorder, stepper)


def _save(store: Checkpoint, coupled: Coupled, recorder: Recorder, stepper: Stepper) -> None:
    states, memory = coupled.stored()
    state = saving.pack(states, {"coupled": memory, "stepper": stepper.stored()})
    store.save(coupled.time, state, recorder.table(store.count))


def _remember(coupled: Coupled, history: Mapping[str, Callable[[float], float]], order: int, step_size: float) -> None:
    past = []
    for n in range(order, 0, -1):
        outputs = coupled.outputs.copy()
        for name, course in history.items():
            outputs[coupled.names.index(name)] = course(-n * step_size)
        past.append((-n * step_size, outputs))
    coupled.remember(past)


def _attributes(coupled: Coupled, stepper: Stepper) -> dict[str, Any]:
    costs = {name: {"steps": slave.steps, "seconds": slave.seconds} for name, slave in coupled.slaves.items()}
    return asdict(stepper.statistics) | {"cost": json.dumps(costs)}
