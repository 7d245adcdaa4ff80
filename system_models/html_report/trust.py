"""What to think of the numbers: errors by cause, flags with their times and remedies, statistics of the solver."""

from collections.abc import Iterator
from itertools import groupby

import numpy as np
import xarray as xr

from contact_core.quantities import TABLE
from contact_core.state import Error, RangeFlag

from ..machines.coupling_error import ATTRIBUTE as COUPLING
from ..run import cosim_report
from .chart import Chart, Line, figure
from .markup import Raw, heading, paragraph, printed, section, table, text
from .opened import Run
from .panels import values
from .shown import stated, time_unit, unit_for

CAUSES = {  # in words, by field of `Error`
    "time": "steps in time",
    "sampling": "few instants",
    "grid": "grid",
    "iteration": "early stop",
    "curves": "fitted curves",
    "inlet": "cut inlet",
}
_SHOWN = (
    "friction_coefficient", "h_c", "lambda_ratio", "contact_load_ratio", "tribofilm_1", "tribofilm_2",
    "wear_depth_1", "wear_depth_2", "roughness_1", "roughness_2", "contact_area_ratio", "damage_1", "damage_2",
)  # fmt: skip
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
_WORDS = {
    "h_c": "central film thickness",
    "contact_load_ratio": "load carried by solids",
    "contact_area_ratio": "contact area",
}
_WORST = 8  # errors of the coupling listed


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
    """Return the sections on errors, on flags, and on the solver."""
    return _errors(run) + _flags(run) + _solver(run)


def _errors(run: Run) -> str:
    words = paragraph(
        "A half width is that of a 95 % interval: with the causes named here, the true answer of the model lies within "
        "it in 19 of 20 cases. Causes count as independent: their squares add up. What the model leaves out is not "
        "in it; see “What was modelled”."
    )
    if run.of_contact:
        return section("errors", "Errors by cause", words, *_by_cause(run))
    return section("errors", "Errors by cause", words, *_of_contacts(run), *_of_coupling(run))


def _by_cause(run: Run) -> Iterator[str]:
    """Yield a table of the end's errors by cause, with bars of their shares."""
    names = [name for name in _SHOWN if name in run.causes and name in run.dataset]
    if not names:
        yield paragraph(
            "This result does not say its errors by cause: an older version has made it, or it had no checkpoint.",
            "quiet",
        )
        return
    used = [cause for cause in CAUSES if any(run.causes[name].get(cause, 0.0) > 0.0 for name in names)]
    rows = []
    for name in names:
        error = Error(**run.causes[name])
        value = float(run.dataset.variables[name].values[-1])
        unit = unit_for(run.dataset.variables[name].attrs["units"], [value])
        halves = [unit.factor * getattr(error, cause) for cause in used]
        together = unit.factor * error.together
        relative = f"{abs(error.together / value):.0%}" if value else "–"
        rows.append(
            [
                _named(name),
                stated(float(unit.of(value)), together),
                unit.name or "–",
                relative,
                *(f"{half:.2g}" if half else "–" for half in halves),
                Raw(_bar([(CAUSES[cause], half**2) for cause, half in zip(used, halves, strict=True)])),
            ]
        )
    heads = ["output", "at the end", "unit", "relative", *(CAUSES[cause] for cause in used), "shares of the square"]
    yield table(heads, rows, "numbers")
    yield paragraph(_causes_in_words(used), "quiet")


_MEANING = {
    "time": "steps in time: blocks of the evolution that are not infinitely short",
    "sampling": "few instants: each block is solved at a few instants of passing roughness",
    "grid": "grid: the distance of its nodes",
    "iteration": "early stop: solutions are stopped at film.tolerance",
    "curves": "fitted curves: the regression level's distance from the deterministic level",
    "inlet": "cut inlet: film.domain ends within the inlet, which leaves the film too thin",
}


def _causes_in_words(used: list[str]) -> str:
    return f"{'; '.join(_MEANING[cause] for cause in used)}.".capitalize() if used else ""


def _bar(parts: list[tuple[str, float]]) -> str:
    """Return a bar of shares."""
    total = sum(share for _, share in parts) or 1.0
    pieces = "".join(
        f'<span class="part part-{k}" style="width:{100.0 * share / total:.1f}%" '
        f'title="{text(name)}: {share / total:.0%}">{text(name) if share > 0.3 * total else ""}</span>'
        for k, (name, share) in enumerate(parts)
        if share > 0.0
    )
    return f'<span class="bar">{pieces}</span>'


def _named(name: str) -> str:
    """Return the name of an output in words."""
    stem, body = (name[:-2], f", body {name[-1]}") if name[-2:] in ("_1", "_2") else (name, "")
    return _WORDS.get(stem, stem.replace("_", " ")) + body


def _of_contacts(run: Run) -> Iterator[str]:
    """Yield a table of the errors that the contacts state at the end."""
    if not run.contacts:
        return
    yield heading("At the end, as each contact states it")
    kinds = {"error_friction": "friction", "error_film": "film thickness", "error_wear": "wear"}
    rows = []
    for contact in run.contacts:
        last = [
            float(run.dataset.variables[run.of(contact, key)].values[-1])
            for key in kinds
            if run.of(contact, key) in run.dataset
        ]
        rows.append([contact, *(f"{error:.0%}" for error in last)])
    yield table(["contact", *kinds.values()], rows, "numbers", "Half widths relative to the value")
    yield paragraph("Contacts at the regression level state one cause: its fitted curves.", "quiet")


def _of_coupling(run: Run) -> Iterator[str]:
    """Yield the largest errors by the communication steps, if the run was checked with double steps."""
    found = []
    for name in map(str, run.dataset.data_vars):
        error = run.dataset.variables[name].attrs.get(COUPLING)
        largest = float(np.abs(values(run.dataset, name)).max()) if error is not None else 0.0
        if error is not None and largest > 0.0:
            found.append((float(error) / largest, name, float(error), run.dataset.variables[name].attrs["units"]))
    yield heading("By the coupling of the parts")
    if not found:
        yield paragraph(
            "Not checked: a machine's run without --unchecked simulates once more with double steps, and says so.",
            "quiet",
        )
        return
    found.sort(reverse=True)
    middle = float(np.median([share for share, *_ in found]))
    yield paragraph(
        f"From a simulation with double steps, relative to the largest value of each output: {middle:.2g} in the "
        f"middle of {len(found)} outputs. The largest:"
    )
    rows = [[name, f"{share:.2%}", f"{error:.3g}", unit] for share, name, error, unit in found[:_WORST]]
    yield table(["output", "relative", "error", "unit"], rows, "numbers")


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
    much = [each for key in shown for each in _how_much(run, contacts, key, up)]
    who = [] if run.of_contact else [", ".join(contacts)]
    return [f"{flag.text[0].upper()}{flag.text[1:]}.", *who, when, "; ".join(much) or "–", remedy]


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
    yield f"{_named(key)} up to {stated(float(unit.of(largest)))} {unit.name}".rstrip()


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
        "dry": "dry contact at the measured share of load",
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
    clock = time_unit(float(dataset.variables["time"].values[-1]))
    shown = (
        ("iterations", "Film iterations", "iterations", "In the step that ends at each row."),
        ("unconverged", "Solutions that did not converge", "share", "Of the film solutions of the last block."),
    )
    figures = []
    for name, title, symbol, caption in shown:
        if name in dataset and np.any(dataset.variables[name].values):
            line = Line(symbol, clock.of(dataset.variables["time"].values), values(dataset, name))
            figures.append(
                figure(Chart(title, f"time {clock.label}", f"{symbol} [–]", [line], caption), f"solver-{name}")
            )
    counted = [name in dataset and bool(np.any(dataset.variables[name].values)) for name, *_ in shown]
    if counted == [True, False]:
        yield paragraph("Every film solution converged.", "good")
    if figures:
        yield f'<div class="charts">{"".join(figures)}</div>'


def _of_master(dataset: xr.Dataset, finished: bool) -> Iterator[str]:
    """Yield the master's closing lines, costs, and its steps against time."""
    if finished and "steps" in dataset.attrs:
        yield printed(cosim_report.closing_lines(dataset))
        yield heading("Cost of each part")
        yield printed(cosim_report.costs(dataset).splitlines())
    if "master.step_size" in dataset:
        clock, sizes = time_unit(float(dataset.variables["time"].values[-1])), values(dataset, "master.step_size")
        line = Line("step", clock.of(dataset.variables["time"].values[1:]), sizes[1:])
        if len(sizes) > 2 and sizes[1:].min() > 0.0:
            chart = Chart("Communication step", f"time {clock.label}", "step [s]", [line], "", logarithmic=True)
            yield f'<div class="charts">{figure(chart, "solver-step")}</div>'
