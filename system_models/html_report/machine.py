"""Report and pictures of a machine, and the states that its run has solved again."""

from collections.abc import Iterator
from pathlib import Path

from fmu_src.html.markup import bullets, heading, paragraph, picture, printed, section, table

from ..charts.files import png
from ..charts.units import stated
from ..machines import report as machine_report
from ..machines import trust
from ..store import results
from .opened import Run

_NAMES = {
    "overview": "The run at a glance", "path": "Along the path of contact", "time": "Against time",
    "safety": "Safety factors", "load_zone": "Loads of the balls", "surfaces": "Surfaces",
}  # fmt: skip
_RESOLVED = "resolved.nc"


def sections(run: Run) -> str:
    """Return the section of the machine; nothing for a contact."""
    if run.of_contact:
        return ""
    parts = [*_lines(run), *_resolved(run.folder), *_pictures(run)]
    return section("machine", "The machine", *parts) if parts else ""


def _lines(run: Run) -> Iterator[str]:
    """Yield the tables that the machine's run prints."""
    if run.machine:
        kind, assembly = run.machine.kind, run.machine.assembly
        yield printed(kind.lines(assembly, run.dataset))
        yield bullets(trust.told(kind, assembly, run.dataset))
        if run.finished:  # before that they are not counted
            yield heading("Costs and levels")
            yield printed(machine_report.lines(assembly, run.dataset))


def _pictures(run: Run) -> Iterator[str]:
    """Yield the pictures of the machine: drawn anew, or else those that lie in the folder."""
    if run.machine:
        drawn = {k: png(sheet) for k, sheet in run.machine.kind.pictures(run.machine.assembly, run.dataset).items()}
    else:
        drawn = {file.stem: file.read_bytes() for file in sorted(run.folder.glob("*.png")) if run.finished}
    if drawn:
        yield heading("Pictures")
    for name, data in drawn.items():
        yield picture(data, _NAMES.get(name, name.replace("_", " ")))


def _resolved(folder: Path) -> Iterator[str]:
    """Yield the states that the run has solved deterministically to test its errors."""
    file = folder / _RESOLVED
    if not file.exists():
        return
    found = results.read(file)
    yield heading("States solved again, node by node")
    yield paragraph(
        "A few states of the run were solved once more at the deterministic level. An error is honest if the deviation "
        "lies within it."
    )
    rows = []
    for k in range(found.sizes["state"]):
        row = {str(name).removeprefix("resolved."): found[name].values[k] for name in found.data_vars}
        verdict = ("yes" if row["valid"] else "NO") if row["solved"] else "not decided"
        cells = [row["contact"], f"{float(row['time']):.4g}"]
        for name, factor in (("friction_coefficient", 1.0), ("h_c", 1e9)):
            error = "error_friction" if factor == 1.0 else "error_film"
            value, solved = (factor * float(row[f"{name}.{level}"]) for level in ("regression", "deterministic"))
            cells += [stated(value, value * float(row[f"{name}.{error}"])), stated(solved)]
        rows.append([*cells, verdict])
    heads = [
        "contact",
        "time [s]",
        "µ as run [–]",
        "µ solved [–]",
        "h_c as run [nm]",
        "h_c solved [nm]",
        "within error",
    ]
    yield table(heads, rows, "numbers")
