"""What a scene assumes, and between which values it may lie; docs/how-to/scenes.md has an example.

Values that were found together are all at their first ends, or all at their last. Named sets and defaults bring their
own; a value set beside them has none unless its scene gives one. What they are worth: `contact_core.assumed`.
"""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

from ..errors import SceneError
from ..laws.asperity_layer import AsperityLayer
from ..quantities import out_of_range
from .toml import file_of_set, flat, models_of, read_table
from .units import parse

Ends = tuple[Any, Any]  # least and largest value, as in a scene
_LONGEST = 4e-6  # m: of waves below the grid where a scene has none
_AND = ", "
_ROUNDED = 0.02  # part of an interval by which its ends may be rounded
_GIVEN = "operation."  # keys of the duty: nobody assumes them


@dataclass(frozen=True)
class Interval:
    """The least and the largest value of what a scene assumes, as text with a unit or as a percentage of its value."""

    key: str  # dotted; of values that go together all, with `_AND` between them as between their ends
    least: str
    most: str

    @property
    def keys(self) -> tuple[str, ...]:
        """The dotted keys of the values."""
        return tuple(self.key.split(_AND))

    def ends(self, scene: Any) -> tuple[dict[str, float], dict[str, float]]:
        """Return least and largest values [SI] by key for a scene. Raises SceneError if they cannot be."""
        least, most = (self._end(scene, texts.split(_AND)) for texts in (self.least, self.most))
        if least[self.keys[0]] > most[self.keys[0]]:
            raise SceneError(f"{self.name} = ['{self.least}', '{self.most}']: the least comes first. Exchange them.")
        return least, most

    def _end(self, scene: Any, texts: list[str]) -> dict[str, float]:
        if len(texts) != len(self.keys):
            raise SceneError(f"{self.name} has {len(self.keys)} values, but an end of it {len(texts)}: '{texts}'.")
        return {key: _end(text, *value_of(scene, key), self.name) for key, text in zip(self.keys, texts, strict=True)}

    @property
    def name(self) -> str:
        """What the interval is called in a scene."""
        return f'intervals."{self.key}"'


def listed(intervals: Mapping[str, Ends]) -> list[dict[str, str]]:
    """Return tables of intervals, as records are built from. Raises SceneError for what is none."""
    return [_table(key, ends) for key, ends in flat(intervals).items()]


def _table(key: str, ends: Any) -> dict[str, str]:
    if not isinstance(ends, list | tuple) or len(ends) != 2:
        raise SceneError(f"intervals.\"{key}\" = {ends!r} must be the least and the largest value, ['4 um', '16 um'].")
    least, most = (_AND.join(map(str, end)) if isinstance(end, list | tuple) else str(end) for end in ends)
    return {"key": _AND.join(name.strip() for name in key.split(",")), "least": least, "most": most}


def of_sets(table: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Ends]]:
    """Yield the intervals of the named sets that a scene's tables take, but of values that stand beside them."""
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from of_sets(value, f"{path}.{key}" if path else key)
        elif key == "set":
            with suppress(SceneError):  # reading the set will refuse it
                yield from _of_set(str(value), path, flat(table, f"{path}."))


def _of_set(chosen: str, path: str, beside: Mapping[str, Any]) -> Iterator[tuple[str, Ends]]:
    file, name = file_of_set(chosen, path)
    sets = {key.lower(): value for key, value in read_table(file, "set").items() if isinstance(value, Mapping)}
    for key, ends in flat(sets.get(name, {}).get("intervals", {})).items():
        keys = [each.strip() for each in key.split(",")]
        if all(each.startswith(f"{path}.") and each not in beside for each in keys):
            yield key, ends


def applicable(scene: Any) -> tuple[Interval, ...]:
    """Return the intervals of a scene but for those of laws that others have taken the place of."""
    return tuple(i for i in scene.intervals if not any(_of_another_law(scene, key) for key in i.keys))


def _of_another_law(scene: Any, key: str) -> bool:
    path, _, name = key.rpartition(".")
    record = scene
    for part in path.split("."):
        record = getattr(record, part, None)
    others = {f.name for law in models_of(path) for f in fields(law)}
    return name in others and record is not None and not hasattr(record, name)


def errors(scene: Any) -> Iterator[str]:
    """Yield sentences on intervals that cannot be."""
    for interval in applicable(scene):
        try:
            for end, text in zip(interval.ends(scene), (interval.least, interval.most), strict=True):
                if "%" not in text:  # what is relative moves with the value
                    yield from (
                        f"{interval.name}: {said}" for key in end for said in _out_of_range(scene, key, end[key])
                    )
        except SceneError as error:
            yield str(error)


def _out_of_range(record: Any, key: str, value: float) -> Iterator[str]:
    """Yield sentences on an end [SI] that the value of a dotted key may not be."""
    *path, last = key.split(".")
    for name in path:
        record = _part(record, name)
    yield from (said for said in out_of_range(replace(record, **{last: value}), ".".join(path)) if key in said)


def doubts(scene: Any) -> Iterator[str]:
    """Yield sentences on intervals that do not hold the value of their scene."""
    for interval in applicable(scene):
        ends = interval.ends(scene)
        for key in interval.keys:
            (value, unit), (least, most) = value_of(scene, key), sorted(end[key] for end in ends)
            slack = _ROUNDED * (most - least)
            if not least - slack <= value <= most + slack:
                given = f"{value:.4g} {unit}".rstrip()
                yield (
                    f"{interval.name} = ['{interval.least}', '{interval.most}'] does not hold {key} = {given}. "
                    "Which of the two is right?"
                )


def replaced(scene: Any, key: str, value: float) -> Any:
    """Return a scene, or a record of it, with another value [SI] of a dotted key, unchecked."""
    name, _, rest = key.partition(".")
    part = replaced(_part(scene, name), rest, value) if rest else value
    if isinstance(scene, tuple):
        return (*scene[: int(name)], part, *scene[int(name) + 1 :])
    return replace(scene, **{name: part})


def spread(record: Any, key: str) -> Iterator[str]:
    """Yield a dotted key of a record; for one that leads through lists that of each item, with its number from 0."""
    name, _, rest = key.partition(".")
    if isinstance(record, tuple):
        yield from (f"{k}.{each}" for k, item in enumerate(record) for each in spread(item, key))
    elif rest:
        yield from (f"{name}.{each}" for each in spread(_part(record, name), rest))
    else:
        yield key


def _part(record: Any, name: str) -> Any:
    if isinstance(record, tuple):
        return record[int(name)]
    if isinstance(record, Mapping):
        return record.get(name)
    part = getattr(record, name, None)
    return AsperityLayer(0.0, _LONGEST) if part is None and name == "microroughness" else part


def value_of(record: Any, key: str) -> tuple[float, str]:
    """Return the value [SI] of a dotted key and its unit, of a record or of records by name."""
    if key.startswith(_GIVEN):
        raise SceneError(
            f'intervals."{key}": what the contact is run at is given, not assumed, so it has none. `tribofmu sweep` '
            "varies it."
        )
    *path, last = key.split(".")
    for name in path:
        record = _part(record, name)
    field = next((f for f in fields(record) if f.name == last), None) if is_dataclass(record) else None
    value = getattr(record, last, None)
    if field is None or not isinstance(value, float):
        raise SceneError(f'intervals."{key}" is no number that may vary. `tribofmu explain` lists them by their keys.')
    return value, field.metadata["unit"]


def _end(text: str, value: float, unit: str, name: str) -> float:
    if text.rstrip().endswith("%"):
        return value * (1.0 + 0.01 * parse(text.rstrip()[:-1].strip(), "", name))
    return parse(text, unit, name)
