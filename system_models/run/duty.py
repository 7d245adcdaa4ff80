"""The duty: load, speeds, temperature and radii against time, each operating point held to the next one's time.

Constant (the scene's `[operation]`), `[[operation.steps]]`, or a CSV file (see `duty_table`).
"""

import bisect
import hashlib
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from pathlib import Path

from contact_core.errors import SceneError
from contact_core.quantities import TABLE
from contact_core.scene import Assumed, OperatingPoint, Scene, Step

from . import duty_table

_SIGNALS = {f.name: TABLE[f.name] for f in fields(OperatingPoint)}


@dataclass(frozen=True)
class Duty:
    """Operating points, each held from its time [s] on; the first time is 0, and times increase."""

    times: tuple[float, ...]
    points: tuple[OperatingPoint, ...]

    def __post_init__(self) -> None:
        increasing = all(early < late for early, late in pairwise(self.times))
        if len(self.times) != len(self.points) or self.times[:1] != (0.0,) or not increasing:
            raise SceneError(f"The duty's times {self.times} must start at 0, increase, and be as many as its points.")

    @staticmethod
    def from_steps(point: OperatingPoint, steps: Sequence[Step] = ()) -> "Duty":
        """Begin at `point` and hold it until a step changes some of its values; the others stay as at the beginning."""
        names = [f.name for f in fields(OperatingPoint)]
        given = [{name: getattr(step, name) for name in names if getattr(step, name) is not None} for step in steps]
        points = (point, *(replace(point, **values) for values in given))
        return Duty((0.0, *(step.time for step in steps)), points)

    @staticmethod
    def from_csv(path: str | Path, reference: OperatingPoint) -> "Duty":
        """Read a table of steps; columns that are not there keep the value of `reference`.

        Raises SceneError with one sentence that names file, line, column, value and remedy.
        """
        rows = duty_table.read(Path(path), _SIGNALS)
        return Duty(tuple(time for time, _ in rows), tuple(replace(reference, **values) for _, values in rows))

    @staticmethod
    def of_scene(scene: Scene, folder: Path | None = None) -> "Duty":
        """Return the duty of a scene's `[operation]`; a relative `operation.file` is looked for in `folder`."""
        point = scene.operation.point
        if not scene.operation.file:
            return Duty.from_steps(point, scene.operation.steps)
        return Duty.from_csv((folder or Path()) / scene.operation.file, point)

    def named(self, scene: Scene) -> Iterator[tuple[str, OperatingPoint]]:
        """Yield the operating points with words for where a scene has them: its [operation], a step, or a row."""
        file = scene.operation.file
        for i, (time, point) in enumerate(zip(self.times, self.points, strict=True)):
            step = f"operation.steps[{i - 1}]" if i else "operation"
            yield f"Row {i + 1} of '{file}' (at {time:g} s)" if file else step, point

    def at(self, time: float) -> OperatingPoint:
        """Return the operating point held from `time` [s] on."""
        return self.points[max(bisect.bisect_right(self.times, time) - 1, 0)]

    def fingerprint(self) -> str:
        """Return a text that is the same for the same duty, bit for bit, and for no other."""
        values = [[getattr(point, f.name) for f in fields(point)] for point in self.points]
        points = [tuple(None if value is None else float(value).hex() for value in row) for row in values]
        digest = hashlib.sha256(repr([[float(time).hex() for time in self.times], points]).encode()).hexdigest()
        return f"{len(self.times)} rows, fingerprint {digest[:16]}"

    def for_grid(self, scene: Scene, assumed: Iterable[Assumed]) -> dict[str, str]:
        """Return what to override in a scene of an `assumed` domain for a grid of the duty's loads, if needed."""
        largest = max(point.load for point in self.points)
        chosen = any(each.key == "film.domain" for each in assumed)
        return {"operation.largest_load": f"{largest!r} N"} if chosen and largest > scene.largest_load else {}

    def sized(self, scene: Scene) -> Scene:
        """Return the scene with `operation.largest_load` raised to the duty's, so that its checks hold throughout.

        Raises SceneError if the grid cannot hold the contact at that load, or at the radii of a point.
        """
        for refusal in filter(None, map(scene.refusal, self.points)):
            raise SceneError(refusal)
        largest = max(point.load for point in self.points)
        if largest <= scene.largest_load:
            return scene
        sized = replace(scene, operation=replace(scene.operation, largest_load=largest))
        errors = sized.check()
        if errors:
            raise SceneError(" ".join(sentence for _, sentence in errors))
        return sized


def refuse_hidden(scene: Scene, folder: Path, changes: Collection[str]) -> None:
    """Raise SceneError if a key that was changed in a scene has no effect, because its duty has a column for it."""
    if scene.operation.file:
        duty_table.refuse_hidden(folder / scene.operation.file, _SIGNALS, "operation", changes)
