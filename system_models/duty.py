"""The duty: load, speeds, temperature and radii against time.

A duty holds each operating point from its time to the next one's. It is constant (the scene's `[operation]`), has the
`[[operation.steps]]` of the scene, or is a CSV file whose header names each column with its unit:

    time [min],load [N],temperature [degC]
    0,53.7,80
    30,53.7,100

`time` is needed, starts at 0 and increases; an input of the contact without a column keeps the scene's value.
"""

import bisect
import csv
import difflib
import hashlib
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from pathlib import Path

from contact_core import units
from contact_core.errors import SceneError
from contact_core.quantities import out_of_range
from contact_core.scene import OperatingPoint, Scene, Step

_SI_UNITS = {"time": "s"} | {f.name: f.metadata["unit"] for f in fields(OperatingPoint)}
_COLUMN = re.compile(r"\s*(\w+)\s*\[([^\]]+)\]\s*$")


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
        """Begin at `point` and hold it until a step changes what it names; the rest is as at the beginning."""
        names = [f.name for f in fields(OperatingPoint)]
        given = [{name: getattr(step, name) for name in names if getattr(step, name) is not None} for step in steps]
        points = (point, *(replace(point, **values) for values in given))
        return Duty((0.0, *(step.time for step in steps)), points)

    @staticmethod
    def from_csv(path: str | Path, reference: OperatingPoint) -> "Duty":
        """Read a table of steps; columns that are not there keep the value of `reference`.

        Raises SceneError with one sentence that names file, line, column and value, and what would be right.
        """
        return _read(Path(path), reference)

    @staticmethod
    def of_scene(scene: Scene, folder: Path | None = None) -> "Duty":
        """The duty of a scene's `[operation]`; a relative `operation.file` is looked for in `folder`."""
        point = scene.operation.point
        if not scene.operation.file:
            return Duty.from_steps(point, scene.operation.steps)
        return Duty.from_csv((folder or Path()) / scene.operation.file, point)

    def at(self, time: float) -> OperatingPoint:
        """The operating point held from `time` [s] on."""
        return self.points[max(bisect.bisect_right(self.times, time) - 1, 0)]

    def fingerprint(self) -> str:
        """A text that is the same for the same duty, bit for bit, and for no other."""
        values = [[getattr(point, f.name) for f in fields(point)] for point in self.points]
        points = [tuple(None if value is None else float(value).hex() for value in row) for row in values]
        digest = hashlib.sha256(repr([[float(time).hex() for time in self.times], points]).encode()).hexdigest()
        return f"{len(self.times)} rows, fingerprint {digest[:16]}"

    def sized(self, scene: Scene) -> Scene:
        """The scene with `operation.largest_load` raised to the duty's, so that its checks hold throughout.

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


def _read(path: Path, reference: OperatingPoint) -> Duty:
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file)
            rows = [(reader.line_num, row) for row in reader if any(cell.strip() for cell in row)]
    except OSError as error:
        raise SceneError(f"The duty file '{path}' cannot be read: {error.strerror}.") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise SceneError(f"The duty file '{path}' is not a CSV file in UTF-8: {error}.") from None
    if len(rows) < 2:
        raise SceneError(f"The duty file '{path}' needs a header such as 'time [s],load [N]' and a row below it.")
    (line, header), *body = rows
    columns = _columns(header, f"{path}, line {line}")
    times: list[float] = []
    points: list[OperatingPoint] = []
    for line, row in body:
        time, point = _row(row, columns, f"{path}, line {line}", reference)
        if not times and time != 0.0:
            raise SceneError(f"{path}, line {line}: time = {time:g} s, but the first row must be at time 0.")
        if times and time <= times[-1]:
            raise SceneError(
                f"{path}, line {line}: time = {time:g} s does not come after the {times[-1]:g} s of the row "
                "above. Sort the rows by time and give each time once."
            )
        times.append(time)
        points.append(point)
    return Duty(tuple(times), tuple(points))


def _columns(header: list[str], where: str) -> list[tuple[str, str]]:
    """Name and unit of every column."""
    columns: list[tuple[str, str]] = []
    for text in header:
        match = _COLUMN.match(text)
        if not match:
            raise SceneError(
                f"{where}: column '{text}' is not a name with a unit. "
                "Write for example 'time [s],load [N],temperature [degC]'."
            )
        name, unit = match[1], match[2].strip()
        if name not in _SI_UNITS:
            close = difflib.get_close_matches(name, _SI_UNITS, n=1, cutoff=0.5)
            hint = f" Did you mean '{close[0]}'?" if close else ""
            raise SceneError(f"{where}: there is no column '{name}'.{hint} Known are {', '.join(_SI_UNITS)}.")
        if name in (known for known, _ in columns):
            raise SceneError(f"{where}: column '{name}' is there twice. Keep one.")
        _si(1.0, name, unit, where)
        columns.append((name, unit))
    names = [name for name, _ in columns]
    if "time" not in names or len(names) < 2:
        raise SceneError(
            f"{where}: the columns are {', '.join(names)}; 'time' and at least one of "
            f"{', '.join(list(_SI_UNITS)[1:])} are needed."
        )
    return columns


def _row(
    cells: list[str], columns: list[tuple[str, str]], where: str, reference: OperatingPoint
) -> tuple[float, OperatingPoint]:
    """Time [s] and operating point of one row."""
    if len(cells) != len(columns):
        raise SceneError(
            f"{where}: {len(cells)} values for {len(columns)} columns. "
            "Put a comma between values and a point before decimals."
        )
    values: dict[str, float] = {}
    for cell, (name, unit) in zip(cells, columns, strict=True):
        here = f"{where}, column '{name} [{unit}]', value '{cell.strip()}'"
        try:
            number = float(cell)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise SceneError(f"{here}: not a finite number. Write for example 1.5.")
        values[name] = _si(number, name, unit, where)
        if name != "time":
            for sentence in out_of_range(replace(reference, **{name: values[name]}), ""):
                raise SceneError(f"{here}: {sentence}")
    return values.pop("time"), replace(reference, **values)


def _si(number: float, name: str, unit: str, where: str) -> float:
    try:
        return units.parse(f"{number!r} {unit}", _SI_UNITS[name], name)
    except SceneError as error:
        raise SceneError(f"{where}: {error}") from None
