"""What to think of the numbers: flags with their times and remedies, statistics of the solver."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby

import numpy as np
import xarray as xr

from contact_core.quantities import TABLE
from contact_core.state import RangeFlag
from fmu_src.html.markup import heading, paragraph, printed, section, table, text

from ..charts.svg import figures
from ..charts.units import stated, time_unit, unit_for
from ..machines import trust as machine_trust
from ..run import cosim_report
from ..run.flags import by_how_much
from ..run.panels import Panel, chart, values
from .errors import named
from .opened import Run

_REMEDY = {  # of a flag; the quantities that show by how much
    RangeFlag.LAMBDA_CAPPED: ("Nothing to do: lambda says nothing here.", ()),
    RangeFlag.TRIBOFILM_TEMPERATURE: (
        "Use a tribofilm set fitted at these temperatures.", ("temperature", "temperature_1", "temperature_2"),
    ),
    RangeFlag.INLET_UNRESOLVED: ("Use a finer --grid, or a smaller film.domain.", ()),
    RangeFlag.NOT_CONVERGED: ("Use a finer --grid or more film.iterations.", ("unconverged",)),
    RangeFlag.FALLBACK: ("Use a finer --grid.", ("blocks_fallback",)),
    RangeFlag.DOMAIN_EDGE: ("Use a larger film.domain.", ()),
    RangeFlag.FEW_NODES: ("Use a finer --grid or a smaller film.domain.", ()),
    RangeFlag.SLOW_BODY: ("Means over the track are sound; do not read single places of it.", ()),
    RangeFlag.STIFF_WEAR: ("Use a smaller control.change.", ()),
    RangeFlag.OUTSIDE_FIT: ("Check single points with film.model = 'deterministic'.", ("error_friction", "error_film")),
    RangeFlag.OTHER_LEVEL: ("Use film.model = 'deterministic' for these outputs.", ()),
    RangeFlag.UNSURE: (
        "Use film.model = 'deterministic', with --accuracy or a finer --grid.", ("error_friction", "error_film"),
    ),
    RangeFlag.BY_THE_CLOCK: ("Use tribofilm.dose = 'residence'.", ()),
    RangeFlag.SCUFFING: ("Lower load, sliding or oil temperature.", ("scuffing_ratio",)),
    RangeFlag.WORN_SHAPE: ("Use film.model = 'deterministic'.", ("wear_depth_1", "wear_depth_2")),
    RangeFlag.PITTED: ("Trust the onset more than the growth.", ("micropitted_area_1", "micropitted_area_2")),
}  # fmt: skip


_EFFORT = (
    Panel("Film iterations", ("iterations",), ("iterations",), "iterations", "In the step that ends at each row."),
    Panel(
        "Solutions that did not converge",
        ("unconverged",),
        ("share",),
        "share",
        "Of the film solutions of the last block.",
    ),
)
_STEP = Panel("Communication step", ("master.step_size",), ("step",), "step", "")


def raised(run: Run) -> dict[RangeFlag, list[str]]:
    """Return the flags that some row has, each with the contacts that raise it."""
    found: dict[RangeFlag, list[str]] = {}
    for contact in run.contacts:
        name = run.of(contact, "range_flags")
        together = (
            int(np.bitwise_or.reduce(run.dataset.variables[name].values.astype(int))) if name in run.dataset else 0
        )
        for flag in RangeFlag:
            if together & flag:
                found.setdefault(flag, []).append(contact)
    return found


def invalid(run: Run) -> tuple[tuple[float, float], ...]:
    """Return the spans of time [s] in which some outputs stand as they were."""
    names = [name for name in run.dataset.data_vars if str(name).rpartition(".")[2] == "valid"]
    if not names:
        return ()
    bad = ~np.logical_and.reduce([run.dataset.variables[name].values.astype(bool) for name in names])
    return tuple(spans(run.dataset.variables["time"].values, bad))


def why_invalid(run: Run) -> str:
    """Return what it means that rows are not valid: the run of a machine with checks marks more of them."""
    resolved = any("comment" in run.dataset.variables[f"{contact}.valid"].attrs for contact in run.contacts if contact)
    unused = "inputs could not be used, and outputs stand there as they were before"
    if not resolved:
        return unused
    return f"a state solved again lies outside its stated error or could not be judged, or {unused}"


def spans(times: "np.ndarray[tuple[int], np.dtype[np.float64]]", marked: np.ndarray) -> Iterator[tuple[float, float]]:
    """Yield the stretches of time [s] of marked rows; a row stands for the step that ends there."""
    for mark, group in groupby(range(len(times)), key=lambda k: bool(marked[k])):
        rows = list(group)
        if mark:
            yield float(times[max(rows[0] - 1, 0)]), float(times[rows[-1]])


def sections(run: Run) -> str:
    """Return the sections on flags and on the solver."""
    return _flags(run) + _solver(run)


def _flags(run: Run) -> str:
    flags, spoiled = raised(run), invalid(run)
    clock = time_unit(run.reached)
    parts = []
    if spoiled:
        times = ", ".join(f"{clock.of(a):.3g} to {clock.of(b):.3g} {clock.name}" for a, b in spoiled[:5])
        parts.append(paragraph(f"Rows are not valid from {times}: {why_invalid(run)}.", "bad"))
    if not flags:
        return section(
            "flags", "Flags", *parts, paragraph("No flag was raised: nothing lies outside its range.", "good")
        )
    rows = [_flag_row(run, flag, contacts) for flag, contacts in flags.items()]
    note = paragraph("A flag says that an answer is less sure than usual. It changes no number.")
    heads = (
        ["what", "when", "by how much", "what to do"]
        if run.of_contact
        else ["what", "contacts", "when", "by how much", "what to do"]
    )
    return section("flags", "Flags", *parts, note, table(heads, rows, "flags"), _strip(run, flags))


def marked(run: Run, flag: RangeFlag, contacts: list[str]) -> np.ndarray:
    """Return for each row whether a flag is up in one of the contacts."""
    columns = [
        (run.dataset.variables[run.of(each, "range_flags")].values.astype(int) & int(flag)) > 0 for each in contacts
    ]
    return np.asarray(np.logical_or.reduce(columns))


def _flag_row(run: Run, flag: RangeFlag, contacts: list[str]) -> list[object]:
    times, up = run.dataset.variables["time"].values, marked(run, flag, contacts)
    clock, count = time_unit(run.reached), int(up.sum())
    found = list(spans(times, up))
    begin, end = found[0][0], found[-1][1]
    when = "throughout" if up.all() else f"{clock.of(begin):.3g} to {clock.of(end):.3g} {clock.name}"
    when += f", {count} of {len(times)} rows" + (f" in {len(found)} stretches" if len(found) > 1 else "")
    remedy, shown = _REMEDY[flag]
    beyond = _beyond(run, flag, contacts)
    much = [beyond] if beyond else [each for key in shown for each in _how_much(run, contacts, key, up)]
    who = [] if run.of_contact else [", ".join(contacts)]
    return [f"{flag.text[0].upper()}{flag.text[1:]}.", *who, when, "; ".join(much) or "–", remedy]


def _beyond(run: Run, flag: RangeFlag, contacts: list[str]) -> str:
    """Return which quantity is beyond which limit, in the most loaded contact that raises a flag."""
    if run.scene is not None:
        return by_how_much(flag, run.scene, run.dataset.isel(time=marked(run, flag, contacts)))
    if run.machine is None:
        return ""
    assembly = run.machine.assembly
    rows = {name: machine_trust.of_contact(assembly, run.dataset, name) for name in contacts}
    name, number = machine_trust.beyond(assembly, rows, flag)
    return f"{name}: {number}" if number and len(run.contacts) > 1 else number


def _how_much(run: Run, contacts: list[str], key: str, marked: np.ndarray) -> Iterator[str]:
    """Yield the largest value of a quantity in marked rows."""
    names = [run.of(each, key) for each in contacts if run.of(each, key) in run.dataset]
    if not names:
        return
    largest = max(float(values(run.dataset, name)[marked].max()) for name in names)
    if key.startswith("error_"):
        yield f"{key.removeprefix('error_')} ± {largest:.0%}"
        return
    unit = unit_for(TABLE[key].unit, [largest])
    yield f"{named(key)} up to {stated(float(unit.of(largest)))} {unit.name}".rstrip()


def _strip(run: Run, flags: dict[RangeFlag, list[str]]) -> str:
    """Return a drawing of the times at which each flag is up."""
    clock, width, row = time_unit(run.reached), 460.0, 22.0
    end = run.reached or 1.0
    parts = []
    for k, (flag, contacts) in enumerate(flags.items()):
        top = k * row + 4.0
        parts.append(
            f'<text class="end" x="150" y="{top + 12:g}">{text((flag.name or "").replace("_", " ").lower())}</text>'
        )
        parts.append(f'<line class="grid" x1="158" x2="{width - 10}" y1="{top + 8:g}" y2="{top + 8:g}"/>')
        for begin, until in spans(run.dataset.variables["time"].values, marked(run, flag, contacts)):
            left, right = (158.0 + (width - 168.0) * each / end for each in (begin, until))
            parts.append(
                f'<rect class="up" x="{left:.1f}" y="{top:g}" width="{max(right - left, 2.0):.1f}" height="16"/>'
            )
    bottom = len(flags) * row + 18.0
    parts.append(f'<text class="middle" x="158" y="{bottom:g}">0</text>')
    parts.append(f'<text class="end" x="{width - 10:g}" y="{bottom:g}">{clock.of(end):.4g} {clock.name}</text>')
    label = "times at which each flag is up"
    return (
        f'<figure class="strip"><svg viewBox="0 0 {width:g} {bottom + 6:g}" role="img" aria-label="{label}">'
        f"{''.join(parts)}</svg><figcaption>When each flag is up.</figcaption></figure>"
    )


def _solver(run: Run) -> str:
    dataset = run.dataset
    found = (_of_blocks(dataset), _iterations(dataset)) if run.of_contact else (_of_master(dataset, run.finished),)
    parts = [part for each in found for part in each]
    return section(
        "solver", "Solver", *(parts or [paragraph("This level has formulas only: nothing was iterated.", "quiet")])
    )


def _of_blocks(dataset: xr.Dataset) -> Iterator[str]:
    """Yield what drove the blocks of the evolution, and how the instants of the maps were solved."""
    kinds = {
        "dry": "dry contact",
        "mixed": "mixed lubrication",
        "fallback": "dry contact in place of a mixed solution that failed",
    }
    counts = {
        text_: int(dataset.variables[f"blocks_{kind}"].values[-1])
        for kind, text_ in kinds.items()
        if f"blocks_{kind}" in dataset
    }
    total = sum(counts.values())
    if total:
        rows = [[words, count, f"{count / total:.0%}"] for words, count in counts.items()]
        yield table(["pressures that drove tribofilm and wear", "blocks", "share"], rows, "numbers")
    if "instant_converged" in dataset:
        names = str(dataset.variables["instant_route"].attrs["flag_meanings"]).split()
        clock = time_unit(float(dataset.variables["time"].values[-1]))
        rows = [
            [f"{float(clock.of(time)):.4g} {clock.name}", names[int(route)], "yes" if converged else "NO"]
            for time, route, converged in zip(
                dataset.variables["field_time"].values,
                dataset.variables["instant_route"].values,
                dataset.variables["instant_converged"].values,
                strict=True,
            )
        ]
        yield table(["instant of the maps", "solved as", "converged"], rows, "numbers")


def _iterations(dataset: xr.Dataset) -> Iterator[str]:
    """Yield iterations and shares of solutions that did not converge, against time."""
    there = [each for each in _EFFORT if each.quantities[0] in dataset and values(dataset, each.quantities[0]).any()]
    if there == list(_EFFORT[:1]):
        yield paragraph("Every film solution converged.", "good")
    yield figures([chart(dataset, each, each.quantities) for each in there], "solver")


def _of_master(dataset: xr.Dataset, finished: bool) -> Iterator[str]:
    """Yield the master's closing lines, costs, and its steps against time."""
    if finished and "steps" in dataset.attrs:
        yield printed(cosim_report.closing_lines(dataset))
        yield heading("Cost of each part")
        yield printed(cosim_report.costs(dataset).splitlines())
    if "master.step_size" in dataset:
        later = dataset.isel(time=slice(1, None))
        if later.sizes["time"] > 1 and later["master.step_size"].values.min() > 0.0:
            yield figures([replace(chart(later, _STEP, _STEP.quantities), logarithmic=True)], "solver-step")
