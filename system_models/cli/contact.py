"""Runs one contact through its duty: builds its FMU, simulates and reports."""

import argparse
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from contact_core.errors import ContactError
from contact_core.scene import Scene

from .console import note, output_folder
from .overwriting import ask_before
from .progress import continued_by_resume, note_replaced, shown
from .scenes import chosen, contact_of, microroughness, settings_of, warn

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import xarray as xr

    from contact_core.scene import Assumed
    from contact_core.state import Error

    from ..run.duty import Duty
    from ..run.fields import Fields
    from ..store.checkpoint import Checkpoint


def run(arguments: argparse.Namespace) -> int:
    """Run the contact of a scene and return the exit code."""
    from ..store.checkpoint import alone

    scene, duty, _, assumed = contact_of(arguments, settings_of(arguments))
    fields = _fields(arguments.fields, scene, duty)
    folder = output_folder(arguments.out, Path(arguments.scene).stem)
    warn(scene.warnings())
    with alone(folder):
        return _run_in(folder, scene, duty, fields, assumed, arguments)


def _fields(given: str | None, scene: Scene, duty: "Duty") -> "Fields | None":
    """Return what keeps the fields of --fields. Raises ContactError for a value that cannot be used."""
    if given is None:
        return None
    from ..run.contact import communication_points
    from ..run.fields import Fields

    if not given.strip().isdecimal():
        raise ContactError(f"--fields = '{given}' must be a whole number of times, at least 1, such as --fields 5.")
    points = communication_points(duty, scene.operation.duration, scene.operation.interval)
    return Fields(scene, duty, points, int(given))


def _run_in(
    folder: Path,
    scene: Scene,
    duty: "Duty",
    fields: "Fields | None",
    assumed: "Sequence[Assumed]",
    arguments: argparse.Namespace,
) -> int:
    from ..run import assumed as assumed_values
    from ..run import origin

    about = assumed_values.attribute(assumed)
    count, resume = len(fields.times) if fields else 0, arguments.resume
    checkpoint = _checkpoint(folder, scene, duty, count, resume, about)
    if resume and not checkpoint.saved and (code := _finished(folder, scene, duty, count)) is not None:
        return code
    if not checkpoint.saved:
        ask_before(folder, origin.attributes(scene, duty, count), arguments.force)
        introduce(scene, duty, arguments.scene, settings_of(arguments))
    with continued_by_resume(lambda: checkpoint.file if checkpoint.count else None):
        dataset, errors = _simulate(scene, duty, checkpoint, fields)
        dataset = assumed_values.with_half_widths(dataset, scene)
        code = _report(dataset.assign_attrs(about), errors, scene, duty, folder, fields)
    checkpoint.remove()
    return code


def _checkpoint(
    folder: Path, scene: Scene, duty: "Duty", fields: int, resume: bool, about: "Mapping[str, str]"
) -> "Checkpoint":
    """Return the checkpoint of the run; say on stderr whether the run continues from it."""
    from ..run.origin import identity
    from ..store.checkpoint import Checkpoint

    run = identity(scene, duty, fields)
    if not resume:
        checkpoint = Checkpoint(folder, run, about)
        if checkpoint.file.exists():
            note_replaced(checkpoint.file)
        return checkpoint
    checkpoint = Checkpoint.resume(folder, run, about)
    if checkpoint.saved:
        note(f"Continuing from '{checkpoint.file}' at {checkpoint.saved.time / 60.0:.1f} min.")
    return checkpoint


def _finished(folder: Path, scene: Scene, duty: "Duty", fields: int) -> int | None:
    """Return the exit code of this very run if its result is there already."""
    from ..run import origin, report

    dataset = origin.find(folder, scene, duty, fields)
    if dataset is None:
        note(f"There is no checkpoint in '{folder}': the run starts from the beginning.")
        return None
    note(f"This run is finished, its result is in '{folder}'. Leave out --resume to compute it again.")
    return 1 if report.invalid_rows(dataset) else 0


def introduce(scene: Scene, duty: "Duty", source: str, settings: "Mapping[str, str]") -> None:
    """Print what the contact is like, before it is solved."""
    from ..run import trust

    layers = microroughness(scene, source, settings)
    below = [f"Body {body}: {text}." for body, text in enumerate(layers, 1)]
    about = [*trust.before(scene, duty), *trust.wrapped(*chosen(scene), *below)]
    print(*trust.wrapped(scene.description), *about, "", sep="\n", flush=True)


def _report(
    dataset: "xr.Dataset",
    errors: "Mapping[str, Error]",
    scene: Scene,
    duty: "Duty",
    folder: Path,
    fields: "Fields | None",
) -> int:
    """Print and write the result; return the exit code."""
    from ..run import causes, origin, report, track_picture, trust
    from ..store import results

    maps = fields.dataset() if fields and fields.kept else None
    dataset = origin.with_scene(dataset, scene, duty, len(fields.times) if fields else 0)
    dataset = dataset.assign_attrs(causes.attribute(errors))
    print(report.table(dataset, trust.width()), *trust.legend(), sep="\n")
    print(*trust.wrapped(*report.closing_lines(dataset)), *trust.after(scene, dataset, errors), sep="\n")
    written = [*results.write(dataset, folder, maps=maps), report.write_overview(dataset, folder / "overview.png")]
    if maps:
        written.append(track_picture.write(dataset, maps, folder / "track.png"))
    print(f"Written: {', '.join(map(str, written))}")
    return 1 if report.invalid_rows(dataset) else 0


def _simulate(
    scene: Scene, duty: "Duty", checkpoint: "Checkpoint", fields: "Fields | None"
) -> "tuple[xr.Dataset, Mapping[str, Error]]":
    """Build the FMU and drive it, with a progress bar in minutes of test time; return the errors at the end, too."""
    from fmu_src.package.build import build

    from ..run import causes
    from ..run.contact import run

    duration, since = scene.operation.duration, checkpoint.saved.time if checkpoint.saved else 0.0
    bar = shown(scene.name, duration, "{n:.1f}/{total:.1f} min", 60.0, since)
    with tempfile.TemporaryDirectory(prefix="tribofmu-") as folder, bar as progress:
        fmu = build(scene, Path(folder) / f"{scene.name}.fmu", "embedded")
        last: list[bytes] = []
        dataset = run(fmu, duty, duration, scene.operation.interval, progress, checkpoint, fields, last.append)
    # a run that continues from its end takes no step, and looks at no state
    return dataset, causes.of_state(scene, last[0]) if last else causes.at_point(scene, checkpoint)
