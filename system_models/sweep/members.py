"""An ensemble of a scene as one result: its plan, means along time with their bands, and a table of the ends.

Each output is the mean of the members, `_error` the mean of their stated half widths, which are common to them, and
`_band` the half width (95 %, Student's t) of the mean by the scatter of the members.
"""

import json
import math
from typing import Any

import numpy as np
import xarray as xr

from contact_core.errors import ContactError
from contact_core.scene.ensemble import Members

from ..run.cosim_report import aligned
from ..run.report import COLUMNS
from ..store.results import BAND, ERROR, with_half_widths
from .ensemble import MEMBER, SD, averaged
from .plan import Factor, Plan
from .points import Outcome, ends

ATTRIBUTE = "ensemble_json"  # of a result: its members
FILE = "members"  # of the members' own results
HEADINGS = ("mean", "+- surfaces", "sd", "+- stated")  # of numbers at the end
HALVES = "stated error and scatter of the surfaces together (95 %)"
EXPLAINED = (
    "+- surfaces: half width (95 %, Student's t) of the mean by the scatter of the surfaces; more surfaces make it "
    "smaller. sd: how far a single surface is off. +- stated: mean half width (95 %) of the errors that the runs state "
    "(grid, time, sampling, curves), which is common to them and comes on top."
)
_ALIKE = (
    "The members do not differ: nothing in these results depends on what differs between their surfaces. At the "
    "regression level it is rms height, slope and microroughness that count, and a seed has no effect."
)
_ROUNDING = 1e-12  # relative standard deviation of members that are the same
_ANY = "range_flags"  # of members: raised by any of them


def plan_of_members(members: Members) -> Plan:
    return Plan((Factor(MEMBER, members.names, together=members.settings),), np.empty((0, 0)), "ensemble")


def refuse_missing(members: Members, outcomes: dict[int, Outcome]) -> None:
    """Raise ContactError if a member has no result: a mean of the others would be that of another ensemble."""
    for number, outcome in outcomes.items():
        if outcome.refused:
            raise ContactError(
                f"Member '{members.names[number]}' of the ensemble cannot be run: {outcome.refused} The others are "
                "kept; mend it, or leave it out of the list."
            )


def attribute(members: Members) -> str:
    return json.dumps({"keys": members.keys, "members": members.names})


def mean_of(members: Members, plan: Plan, dataset: xr.Dataset) -> xr.Dataset:
    """Return the result of an ensemble along time, from its members as `points.gathered` returns them."""
    reals = [str(name) for name, column in dataset.data_vars.items() if column.dtype.kind == "f"]
    found = averaged(plan, dataset, reals)
    variables: dict[str, Any] = {name: found[name] for name in reals}
    for name, column in dataset.data_vars.items():
        if column.dtype.kind in "bi":
            variables[str(name)] = _counted(str(name), column)
    result = with_half_widths(xr.Dataset(variables))
    halves = {
        key: (dataset.coords[key].mean(MEMBER)).assign_attrs(dataset.coords[key].attrs)
        for key in map(str, result.coords)
        if key.endswith(ERROR)
    }
    scatter: dict[str, xr.DataArray] = {}
    for name in reals:
        if not name.startswith("error_"):
            differs = found[f"{name}{SD}"] > _ROUNDING * np.abs(found[name])
            scatter |= {key: found[key].where(differs, 0.0) for key in (f"{name}{SD}", f"{name}{BAND}")}
    result = result.assign_coords(halves | scatter)
    return result.assign_attrs({**dataset.attrs, ATTRIBUTE: attribute(members)})


def with_scatter(result: xr.Dataset) -> xr.Dataset:
    """Return the result of an ensemble with bands and standard deviations as variables, for a table of all numbers."""
    return result.reset_coords([key for key in map(str, result.coords) if key.endswith((BAND, SD))])


def _counted(name: str, column: xr.DataArray) -> xr.DataArray:
    """Return a truth, sum of flags or count of an ensemble: of all members, of any, or their mean."""
    values = column.transpose(MEMBER, ...).values
    if column.dtype.kind == "b":
        found = values.all(axis=0)
    elif name == _ANY:
        found = np.bitwise_or.reduce(values, axis=0)
    else:
        found = np.rint(values.mean(axis=0)).astype(values.dtype)
    return column.isel({MEMBER: 0}, drop=True).copy(data=found)


def ends_of(result: xr.Dataset, members: xr.Dataset) -> list[tuple[str, list[float], int]]:
    """Return, of each main quantity at the end, heading with unit, numbers in that unit and their digits.

    The numbers are the mean, its band, the standard deviation, the stated half width (nan: none), and each member.
    """
    last, each = ends(result), ends(members)
    found = []
    for column in COLUMNS:
        name, values = column.name, np.asarray(each[column.name].values, dtype=float)
        if np.nan_to_num(values).any():
            stated = float(last[f"{name}{ERROR}"]) if f"{name}{ERROR}" in last.coords else math.nan
            own = [float(last[f"{name}{end}"]) for end in ("", BAND, SD)]
            found.append((column.title, [column.factor * x for x in (*own, stated, *values.tolist())], column.digits))
    return found


def table(members: Members, result: xr.Dataset, dataset: xr.Dataset) -> tuple[list[str], str]:
    """Return the ends of an ensemble as lines of text, and a paragraph on its columns."""
    shown = [f"{number}" for number in range(1, len(members.names) + 1)]
    rows = [["at the end", *HEADINGS, *shown]]
    for title, numbers, digits in ends_of(result, dataset):
        rows.append([title, *("none" if math.isnan(number) else f"{number:.{digits}f}" for number in numbers)])
    names = ", ".join(f"{number} {name}" for number, name in zip(shown, members.names, strict=True))
    alike = all(numbers[2] == 0.0 for _, numbers, _ in ends_of(result, dataset))
    return list(aligned(rows, 0)), f"{EXPLAINED} Members: {names}." + (f" {_ALIKE}" if alike else "")
