"""A machine's run corrected by the states that are solved again: friction, film and W_c of all its contacts.

The run itself has not seen it. Method: `contact_core.corrections.kriging`; each state is judged by the others.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from contact_core import OperatingPoint
from contact_core.corrections.correction import CORRECTED
from contact_core.corrections.kriging import Conditioned, Conditioner, Knots, knots, pair_of, place
from contact_core.kernels.arrays import Array
from contact_core.quantities import LEVELS, TABLE
from contact_core.scene import Case, Scene

from .assembly import Assembly
from .report import loss_error, lost
from .resolve import COMPARED, FAST, Resolved, started


def knots_of(states: Sequence[Resolved]) -> Knots:
    """Return the states whose solutions have converged as knots."""
    known = [state for state in states if state.solved and state.place is not None]
    places = [state.place for state in known if state.place is not None]
    deep = [vars(state.deep) for state in known]
    return knots([state.pair for state in known], places, [vars(state.fast) for state in known], deep)


def corrected(assembly: Assembly, dataset: xr.Dataset, states: Sequence[Resolved]) -> xr.Dataset:
    """Return friction, film and W_c of a run's contacts, corrected, and their errors; of other levels as they are."""
    given, variables = Conditioner(knots_of(states)), {}
    for name, contact in assembly.contacts.items():
        scene, start = started(contact)
        recorded = {key: dataset[f"{name}.{key}"].values for key in assembly.inputs_of(name)}
        places = _places(scene, start, recorded, {key: dataset[f"{name}.{key}"].values for key in _NEEDED})
        told = given.at(np.full(len(places), pair_of(scene), object), places)
        raw = {key: dataset[f"{name}.{key}"].values for key in (*CORRECTED, *CORRECTED.values())}
        fast = dataset[f"{name}.fidelity_used"].values == 1 + LEVELS.index(FAST)
        for key, values in told.of(raw).items():
            text = f"{TABLE[key].text}; corrected by the states solved again"
            attributes = {"units": TABLE[key].unit or "1", "long_name": text}
            variables[f"{name}.{key}"] = ("time", np.where(fast, values, raw[key]), attributes)
    return xr.Dataset(variables, coords={"time": dataset["time"]})


_NEEDED = ("contact_load_ratio", "lambda_ratio", "friction_force", "friction_solid")


def _places(scene: Scene, start: OperatingPoint, recorded: dict[str, Array], outputs: dict[str, Array]) -> Array:
    """Return the places of a contact in the rows of its run, [rows, coordinates]; NaN without a load."""
    count = len(outputs["lambda_ratio"])
    rows = [replace(start, **{k: float(v[i]) for k, v in recorded.items()}) for i in range(count)]
    load = np.array([row.load for row in rows])
    speeds = np.array([row.speed_1 for row in rows]), np.array([row.speed_2 for row in rows])
    pressed = np.array([Case(scene, row).pressed if row.load > 0.0 else math.nan for row in rows])
    return np.stack(np.broadcast_arrays(*place(outputs, load, speeds, pressed)), axis=1)


def without_itself(states: Sequence[Resolved]) -> list[dict[str, Any] | None]:
    """Return each state's corrected outputs by the other states; None of one that is no knot."""
    given, found, k = knots_of(states), list[dict[str, Any] | None](), 0
    for state in states:
        if not state.solved or state.place is None:
            found.append(None)
            continue
        told = Conditioner(given.but(k)).at(given.pairs[k : k + 1], given.places[k : k + 1])
        found.append(Conditioned(told.mean[0], told.left[0]).of(vars(state.fast)))
        k += 1
    return found


def deviation(state: Resolved, values: dict[str, Any], name: str) -> float:
    """Return the deviation of a state's solution from its corrected value, relative to this."""
    solved = getattr(state.deep, name)
    return abs(float(solved / values[name]) - 1.0) if values[name] else math.inf


def covers(state: Resolved, values: dict[str, Any]) -> bool:
    """Return True if the errors of corrected values cover the deviations of a state."""
    return all(deviation(state, values, name) <= values[error] for name, error in COMPARED.items())


def lines(assembly: Assembly, dataset: xr.Dataset, better: xr.Dataset, states: Sequence[Resolved]) -> Iterator[str]:
    """Yield a table of the states, each corrected by the others, and the loss of the corrected run."""
    judged = [(s, v) for s, v in zip(states, without_itself(states), strict=True) if v is not None]
    if len(judged) < 2:
        return
    heads = f"{'corr.':>9} {'solved':>9} {'dev.':>7} {'stated':>7}"
    yield "Each state corrected by the others:"
    yield f"{'state':>24}  mu: {heads}  h_c: {heads}  valid"
    for s, v in judged:
        where, mu, film = f"{s.contact} at {s.time:.4g} s", "friction_coefficient", "h_c"
        yield (
            f"{where:>24}      {v[mu]:9.4f} {getattr(s.deep, mu):9.4f} {deviation(s, v, mu):7.1%} "
            f"{v[COMPARED[mu]]:7.1%}       {1e9 * v[film]:6.1f} nm {1e9 * getattr(s.deep, film):6.1f} nm "
            f"{deviation(s, v, film):7.1%} {v[COMPARED[film]]:7.1%}  {'yes' if covers(s, v) else 'NO'}"
        )
    before, after = loss_error(assembly, dataset), loss_error(assembly, with_corrected(dataset, better))
    energy = [lost(assembly, each) for each in (dataset, with_corrected(dataset, better))]
    if energy[0]:
        yield (
            f"Corrected by all of them, the contacts lose {energy[1]:.4g} J in place of {energy[0]:.4g} J, and their "
            f"errors are {after:.1%} of it in place of {before:.1%}. The run itself has not seen the correction."
        )


def with_corrected(dataset: xr.Dataset, better: xr.Dataset) -> xr.Dataset:
    """Return a run with corrected columns, and its contacts' power_loss by the corrected friction."""
    found = dataset.assign({name: better[name] for name in better.data_vars})
    for name in better.data_vars:
        contact, _, output = str(name).rpartition(".")
        if output == "friction_coefficient":
            raw = dataset[name].values
            factor = np.divide(better[name].values, raw, out=np.ones_like(raw), where=raw != 0.0)
            found[f"{contact}.power_loss"] = dataset[f"{contact}.power_loss"] * factor
    return found
