"""The first section: what was run, the end values with their errors, and what to think of them."""

from collections.abc import Iterator

from contact_core.quantities import CELSIUS
from contact_core.state import Error
from fmu_src.html.markup import Raw, paragraph, section, table, text

from ..charts.half_widths import UNKNOWN, says_nothing
from ..charts.units import Unit, negligible, stated, time_unit
from ..run.panels import MAIN, MORE, Panel, band, unit_of, values
from ..run.verdict import NAMES, Known, known
from .errors import CAUSES
from .opened import Run
from .trust import invalid, marked, raised, why_invalid

_LARGE = 0.2  # relative half width from which an end value is called uncertain
_MOST = 12  # contacts listed


_TITLES = {
    word: panel.title
    for name, word in NAMES.items()
    for panel in (*MAIN, *MORE)
    if panel.quantities[0] in (name, f"{name}_1")
}


def summary(run: Run) -> str:
    body = _cards(run) if run.of_contact else _of_contacts(run)
    return section("summary", "At a glance", _span(run), _conditions(run), body, _verdict(run))


def _span(run: Run) -> str:
    clock = time_unit(max(run.reached, run.planned))
    reached, planned = (f"{float(clock.of(each)):.4g} {clock.name}" for each in (run.reached, run.planned))
    if run.finished:
        return paragraph(f"{run.dataset.sizes['time']} rows from 0 to {reached}.")
    return paragraph(
        f"UNFINISHED: this run was interrupted, or is at work, at {reached} of {planned}. All that follows holds up to "
        "there. The same command with --resume continues it, to the same result, bit for bit.",
        "bad",
    )


def _conditions(run: Run) -> str:
    """Return a line on what a contact was under, as it was run, and on its level."""
    if run.scene is None:
        return ""
    scene, point = run.scene, run.scene.operation.point
    pressure = scene.hertz(point.load).pressure_max if point.load > 0.0 else 0.0
    roll = abs(point.entrainment_speed)
    parts = [
        f"load {point.load:.4g} N, {pressure / 1e9:.3g} GPa Hertz pressure",
        f"entrainment {roll:.4g} m/s",
        *([f"slide-to-roll ratio {(point.speed_1 - point.speed_2) / point.entrainment_speed:.2%}"] if roll else []),
        f"oil at {point.temperature - CELSIUS:.4g} °C",
    ]
    changing = " at the start of its duty" if len(scene.operation.steps) or scene.operation.file else ""
    return paragraph(f"{scene.name}, as it was run{changing}: {', '.join(parts)}; level {scene.film.fidelity}.")


def _end(run: Run, panel: Panel, contact: str) -> Iterator[tuple[str, float, float | None, Unit]]:
    """Yield label, value and half width of a panel's quantities at the end, in the unit people read, and this unit."""
    for name, label in zip(panel.quantities, panel.labels, strict=True):
        full = run.of(contact, name)
        if full in run.dataset:
            last = values(run.dataset, full)[-1:]
            unit = unit_of([(run.dataset, full)], name, slice(-1, None))
            half = band(run.dataset, full, unit)
            yield label, float(unit.of(last)[0]), None if half is None else float(half[-1]), unit


def _stated(panel: Panel, value: float, half: float | None) -> str:
    """Return a value of a panel with its half width, or that it is not known."""
    if panel.share and half is not None and says_nothing(panel.quantities[0], value, half):
        return UNKNOWN
    return stated(value, half)


def _unit(value: float, unit: Unit) -> str:
    """Return the unit behind a value; nothing is nothing in any unit."""
    return "" if negligible(value) and not unit.offset else unit.name


def _cards(run: Run) -> str:
    cards = []
    for panel in MAIN:
        lines = [
            f'<p><span class="value">{text(_stated(panel, value, half))}</span> {text(_unit(value, unit))}'
            + (f' <span class="who">{text(label)}</span>' if len(panel.quantities) > 1 else "")
            + "</p>"
            for label, value, half, unit in _end(run, panel, "")
        ]
        if lines:
            cards.append(f"<div><h3>{text(panel.title)}</h3>{''.join(lines)}</div>")
    note = paragraph(
        "At the end; ± is the half width of a 95 % interval by all causes that the model knows of.", "quiet"
    )
    return f'<div class="cards">{"".join(cards)}</div>{note}'


def _of_contacts(run: Run) -> str:
    """Return the end values of the contacts of a machine, those with the least lambda ratio first."""
    if not run.contacts:
        return ""
    ratio = {name: float(run.dataset.variables[run.of(name, "lambda_ratio")].values[-1]) for name in run.contacts}
    ordered = sorted(run.contacts, key=lambda name: ratio[name])[:_MOST]
    rows = []
    for contact in ordered:
        cells: list[object] = [contact]
        for panel in MAIN:
            found = list(_end(run, panel, contact))
            shown = (text(f"{_stated(panel, v, h)} {_unit(v, u)}".rstrip()) for _, v, h, u in found)
            cells.append(Raw("<br>".join(shown) or "–"))
        rows.append(cells)
    more = f" {len(run.contacts) - len(rows)} more are below." if len(run.contacts) > len(rows) else ""
    caption = f"Contacts at the end, the least lambda ratio first; of tribofilm and wear body 1 over body 2.{more}"
    return table(["contact", *(panel.title for panel in MAIN)], rows, "numbers", caption)


def _verdict(run: Run) -> str:
    """Return what to think of the numbers, as a list."""
    items = [*_of_notes(run), *_of_rows(run), *_of_flags(run), *_of_errors(run)]
    rows = "".join(f'<li class="{kind}">{text(words)}</li>' for kind, words in items)
    return f'<h3>What to think of it</h3><ul class="verdict">{rows}</ul>'


def _of_notes(run: Run) -> Iterator[tuple[str, str]]:
    for note in run.notes:
        yield "warn", note


def _of_rows(run: Run) -> Iterator[tuple[str, str]]:
    spoiled = invalid(run)
    if spoiled:
        yield "bad", f"Some rows are not valid, the first at {spoiled[0][1]:g} s: {why_invalid(run)}."
    else:
        yield "good", f"All {run.dataset.sizes['time']} rows could be computed."


def _of_flags(run: Run) -> Iterator[tuple[str, str]]:
    rows = run.dataset.sizes["time"]
    for flag, contacts in raised(run).items():
        count = int(marked(run, flag, contacts).sum())
        where = [] if run.of_contact else [f"{len(contacts)} of {len(run.contacts)} contacts"]
        where += ["throughout" if count == rows else f"in {count} of {rows} rows"]
        yield "warn", f"{flag.text[0].upper()}{flag.text[1:]} ({', '.join(where)})."


def _of_errors(run: Run) -> Iterator[tuple[str, str]]:
    """Yield a sentence on each output that is uncertain, with its main cause where it is known."""
    found: dict[str, list[tuple[Known, str]]] = {}
    for contact in run.contacts:
        causes = {name: Error(**parts) for name, parts in run.causes.get(contact, {}).items()}
        for each in known(run.alone(contact).isel(time=-1), causes):
            found.setdefault(each.word, []).append((each, contact))
    for word, pairs in found.items():
        worst, contact = max(pairs, key=lambda pair: pair[0].half)
        if worst.half > _LARGE and not worst.share:
            where = "" if run.of_contact else f" in contact {contact}"
            by = f", mostly by {CAUSES[max(worst.error._asdict().items(), key=_half)[0]]}" if worst.error else ""
            yield (
                "warn",
                f"{_TITLES[word]} is uncertain by {worst.half:.0%}{where}{by}: do not read more into its digits.",
            )
        count = sum(each.nothing for each, _ in pairs)
        if count:
            where = "" if run.of_contact else f" in {count} of {len(run.contacts)} contacts"
            yield "bad", f"{_TITLES[word]} is not known{where}: its error leaves all open."


def _half(cause: tuple[str, float]) -> float:
    return cause[1]
