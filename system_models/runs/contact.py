"""Runs one contact through its duty: its FMU, simulated, judged and written."""

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import xarray as xr

from contact_core.scene import Assumed, Scene
from contact_core.state import Error
from fmu_src.package.build import build

from ..charts import files
from ..run import assumed as assumed_values
from ..run import causes, contact, origin, report, track_picture, trust
from ..run.duty import Duty
from ..run.fields import Fields
from ..store import results
from ..store.checkpoint import Checkpoint, alone
from ..store.folders import made
from .job import Finished, continued_by_resume, finished, note_replaced
from .listener import QUIET, Listener
from .replacing import ask_before


def run_contact(
    scene: Scene | str | Path,
    folder: str | Path,
    duty: Duty | None = None,
    *,
    fields: int | None = None,
    assumed: Sequence[Assumed] = (),
    about: Sequence[str] = (),
    resume: bool = False,
    force: bool = False,
    listener: Listener = QUIET,
) -> Finished:
    """Run the contact of a scene through its duty; return the result, which is written to a folder.

    Parameters
    ----------
    scene : large enough for the duty (`Duty.sized`), or the name of a shipped one or the path of its file.
    duty : by default that of the scene.
    fields : at so many times of the run maps and profiles are kept.
    assumed : values that a `Scene` was not given (`Scene.read`), for the result's record.
    about : lines on the scene, beside what the run says before it starts.
    resume : continue from a checkpoint in the folder, bit for bit; a finished run is returned as it is.
    force : replace the result of another scene.

    Raises ContactError for what cannot be run; what was computed is kept in the folder.
    """
    if not isinstance(scene, Scene):
        scene, duty, assumed = _read(scene, duty)
    duty = duty or Duty.of_scene(scene)
    job = _Job(scene, duty, _fields(scene, duty, fields), made(Path(folder)), listener)
    for warning in scene.warnings():
        listener.warn(warning)
    with alone(job.folder):
        return job.run(assumed_values.attribute(assumed), about, resume, force)


def _read(source: str | Path, duty: Duty | None) -> tuple[Scene, Duty, Sequence[Assumed]]:
    """Return the scene of a name or a file, large enough for the duty, and the values that it does not give."""
    scene, assumed = Scene.read(source)
    duty = duty or Duty.of_scene(scene, Path(source).parent)
    if more := duty.for_grid(scene, assumed):
        scene, assumed = Scene.read(source, more)
    return duty.sized(scene), duty, assumed


def _fields(scene: Scene, duty: Duty, count: int | None) -> Fields | None:
    """Return what keeps the maps at so many times of a run."""
    if count is None:
        return None
    points = contact.communication_points(duty, scene.operation.duration, scene.operation.interval)
    return Fields(scene, duty, points, count)


def introduction(scene: Scene, duty: Duty, about: Sequence[str]) -> list[str]:
    """Return lines on what the contact is like, before it is solved."""
    return [*trust.wrapped(scene.description), *trust.before(scene, duty), *trust.wrapped(*about), ""]


class _Job(NamedTuple):
    """A contact, what drives it, and where its result goes."""

    scene: Scene
    duty: Duty
    fields: Fields | None
    folder: Path
    listener: Listener

    @property
    def times(self) -> int:
        """Number of times at which maps are kept."""
        return len(self.fields.times) if self.fields else 0

    def run(self, values: Mapping[str, str], about: Sequence[str], resume: bool, force: bool) -> Finished:
        """Simulate, from the checkpoint where there is one, and report."""
        checkpoint = self._checkpoint(resume, values)
        if resume and not checkpoint.saved:
            before = finished(origin.find(self.folder, self.scene, self.duty, self.times), self.folder, self.listener)
            if before is not None:
                return Finished(before, self.folder, reliable=not report.invalid_rows(before))
        if not checkpoint.saved:
            ask_before(self.folder, origin.attributes(self.scene, self.duty, self.times), force, self.listener)
            self.listener.say(*introduction(self.scene, self.duty, about))
        with continued_by_resume(lambda: checkpoint.file if checkpoint.count else None, self.listener):
            dataset, errors = self.simulate(checkpoint)
            dataset = assumed_values.with_half_widths(dataset, self.scene)
            done = self.report(dataset.assign_attrs(values), errors)
        checkpoint.remove()
        return done

    def _checkpoint(self, resume: bool, values: Mapping[str, str]) -> Checkpoint:
        """Return the checkpoint of the run; say whether the run continues from it."""
        identity = origin.identity(self.scene, self.duty, self.times)
        if not resume:
            checkpoint = Checkpoint(self.folder, identity, values)
            if checkpoint.file.exists():
                note_replaced(checkpoint.file, self.listener)
            return checkpoint
        checkpoint = Checkpoint.resume(self.folder, identity, values)
        if checkpoint.saved:
            self.listener.note(f"Continuing from '{checkpoint.file}' at {checkpoint.saved.time / 60.0:.1f} min.")
        return checkpoint

    def simulate(self, checkpoint: Checkpoint) -> tuple[xr.Dataset, Mapping[str, Error]]:
        """Build the FMU and drive it; return the errors at the end, too."""
        scene, since = self.scene, checkpoint.saved.time if checkpoint.saved else 0.0
        duration = scene.operation.duration
        bar = self.listener.progress(scene.name, duration, "{n:.1f}/{total:.1f} min", 60.0, since)
        with tempfile.TemporaryDirectory(prefix="tribofmu-") as files, bar as progress:
            fmu = build(scene, Path(files) / f"{scene.name}.fmu", "embedded")
            last: list[bytes] = []
            given = scene.operation.interval, progress, checkpoint, self.fields, last.append
            dataset = contact.run(fmu, self.duty, duration, *given)
        # a run that continues from its end takes no step, and looks at no state
        return dataset, causes.of_state(scene, last[0]) if last else causes.at_point(scene, checkpoint)

    def report(self, dataset: xr.Dataset, errors: Mapping[str, Error]) -> Finished:
        """Say and write the result."""
        scene, folder, fields = self.scene, self.folder, self.fields
        maps = fields.dataset() if fields and fields.kept else None
        dataset = origin.with_scene(dataset, scene, self.duty, self.times)
        dataset = dataset.assign_attrs(causes.attribute(errors))
        self.listener.say(report.table(dataset, trust.width()), *trust.legend())
        self.listener.say(*trust.wrapped(*report.closing_lines(dataset)), *trust.after(scene, dataset, errors))
        drawn = {"overview": report.overview(dataset)}
        drawn |= {"track": track_picture.picture(dataset, maps)} if maps else {}
        written = [*results.write(dataset, folder, maps=maps), *files.write(drawn, folder)]
        self.listener.say(f"Written: {', '.join(map(str, written))}")
        reliable = not report.invalid_rows(dataset)
        return Finished(dataset, folder, reliable, tuple(map(Path, written)), errors)
