"""Where the records of a run in two trees differ."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from golden_record import FAILED, NOTE, array_of, text_of

LONGEST = 200  # characters of a text that is shown
Values = Mapping[str, Mapping[str, Any]]


def differences(before: Values | None, after: Values | None) -> tuple[int, list[str], list[str]]:
    """Return how many values were compared, a line for each name that differs, and what else is to be said."""
    if before is None:
        return 0, [], ["new in the working tree"]
    if after is None:
        return 0, ["This run is in the revision only."], []
    count, added, texts = 0, 0, []
    found = [f"It has failed: {text_of(values[FAILED])}" for values in (before, after) if FAILED in values]
    for name in [*before, *(name for name in after if name not in before)]:
        if name.startswith(NOTE):
            continue
        if name not in before:
            added += 1
            continue
        if name not in after:
            found.append(f"{name}: is in the revision only")
            continue
        number, line = _compared(before[name], after[name])
        count += number
        if line and _reworded(text_of(before[name]), text_of(after[name])):
            texts.append(name)
        elif line:
            found.append(f"{name}{line}")
    notes = [f"{added} names added"] if added else []
    notes += [f"{len(texts)} texts reworded ({texts[0]})"] if texts else []
    notes += [f"{name.removeprefix(NOTE)}: {text_of(value)}" for name, value in after.items() if name.startswith(NOTE)]
    return count, found, notes


def _reworded(before: str | None, after: str | None) -> bool:
    """Return True for two texts; states, of which the digest is kept, may have another size but no other content."""
    if before is None or after is None:
        return False
    return "sha256" not in before or before.partition(",")[0] != after.partition(",")[0]


def _compared(before: Mapping[str, Any], after: Mapping[str, Any]) -> tuple[int, str]:
    """How many values, and what the first difference is; nothing if there is none."""
    one, two = text_of(before), text_of(after)
    if one is not None or two is not None:
        return 1, "" if one == two else _texts(one or "numbers", two or "numbers")
    old, new = array_of(before), array_of(after)
    if (old.dtype, old.shape) != (new.dtype, new.shape):
        return old.size, f": {old.dtype} {list(old.shape)} before, {new.dtype} {list(new.shape)} now"
    if old.tobytes() == new.tobytes():
        return old.size, ""
    bits = np.dtype(f"<u{old.dtype.itemsize}")
    where = np.flatnonzero(old.ravel().view(bits) != new.ravel().view(bits))
    first = int(where[0])
    index = tuple(int(i) for i in np.unravel_index(first, old.shape))
    place = f"[{', '.join(map(str, index))}]" if index else ""
    return old.size, (
        f"{place}: {_shown(old.ravel()[first])} before, {_shown(new.ravel()[first])} now; {len(where)} of {old.size} "
        "values differ"
    )


def _shown(value: np.generic) -> str:
    """A number in hex and decimal."""
    plain = value.item()
    return f"{plain.hex()} ({plain!r})" if isinstance(plain, float) else f"{int(plain):#x} ({plain!r})"


def _texts(old: str, new: str) -> str:
    """The first line in which two texts differ."""
    left, right = old.splitlines(), new.splitlines()
    pairs = zip(left, right, strict=False)
    number = next((i for i, (one, two) in enumerate(pairs) if one != two), min(len(left), len(right)))
    one, two = ("".join(lines[number : number + 1]) for lines in (left, right))
    start = next((i for i, (a, b) in enumerate(zip(one, two, strict=False)) if a != b), 0)
    start = max(0, start - 40)
    place = f" line {number + 1}, character {start + 1}" if max(len(left), len(right)) > 1 else ""
    return f"{place}: '{one[start : start + LONGEST]}' before, '{two[start : start + LONGEST]}' now"
