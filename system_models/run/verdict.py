"""How well the outputs of a contact are known at the end of a run, in words, and by which cause."""

import math
from collections.abc import Iterable, Mapping
from typing import NamedTuple

import xarray as xr

from contact_core.quantities import UNSOLVED
from contact_core.scene import Scene
from contact_core.state import Error

from ..charts.half_widths import SHARES, says_nothing
from ..store.results import BAND, half_width

NAMES = {  # of an output with a stated error: in words
    "friction_coefficient": "friction",
    "h_c": "film",
    "contact_load_ratio": "W_c",
    "tribofilm": "tribofilm",
    "wear_depth": "wear",
    "damage": "damage",
}
_CAUSES = {
    "time": "the time steps",
    "sampling": "the few instants solved",
    "grid": "the grid",
    "iteration": "the steps between instants and early stops",
    "curves": "the fitted curves",
    "inlet": "a domain that cuts the inlet off",
}
_LEAST = 1e-3  # smallest half width of a share that is printed as a number
_POOR, _UNKNOWN = 0.35, 1.0  # half widths from which on a quantity is known roughly, and hardly at all


class Known(NamedTuple):
    """How well an output is known."""

    word: str  # its name
    half: float  # half width of its error: absolute of a share, else relative
    share: bool  # True of an output from 0 to 1
    nothing: bool  # True if the half width leaves all open
    error: Error | None  # the same by its causes, if they are known

    @property
    def text(self) -> str:
        """How well, in a few words."""
        if self.nothing:
            return f"{self.word} not at all"
        only = "only " if self.half > _POOR else ""
        if self.share:
            least = 0.0 < self.half < _LEAST
            return f"{self.word} to less than +- {_LEAST:g}" if least else f"{self.word} {only}to +- {self.half:.2g}"
        percent = f"{100.0 * self.half:.2g} %" if self.half < _UNKNOWN else f"a factor of {1.0 + self.half:.2g}"
        return f"{self.word} {only}to {percent}"


def sentence(scene: Scene, dataset: xr.Dataset, errors: Mapping[str, Error]) -> str:
    """Return a sentence: how well each output is known at the end of a contact's run, and what would make it surer.

    `errors` are those of the last state by `contact_core.uncertainty`; empty if they are not known.
    """
    valid, total = dataset["valid"].values, dataset.sizes["time"]
    if not valid.all():
        first = float(dataset["time"].values[~valid][0])
        return (
            f"Verdict: {int((~valid).sum())} of {total} rows are INVALID, the first at {first:g} s; their outputs "
            "stand as they were before."
        )
    found: dict[str, list[str]] = {}
    for each in known(dataset.isel(time=-1), errors):
        found.setdefault(_cause(each.error), []).append(each.text)
    if not found:
        return f"Verdict: all {total} rows were computed; no errors are stated."
    parts = [f"{', '.join(words)}{cause and f' ({cause})'}" for cause, words in found.items()]
    cut = any(_CAUSES["inlet"] in cause for cause in found)
    way = "Surer: the domain that the line Inlet names." if cut else way_out([scene])
    if any(str(name).endswith(BAND) for name in dataset.coords):
        rest = way.removeprefix("Surer: ")
        way = "Surer: more surfaces" + (f"; where '+- stated' is most of it: {rest}" if rest else ".")
    return f"Verdict: known at the end: {'; '.join(parts)}. {way}".rstrip()


def known(last: xr.Dataset, errors: Mapping[str, Error]) -> list[Known]:
    """Return how well the outputs of a contact are known at a row; of both bodies the one known less."""
    found: list[Known] = []
    for name, word in NAMES.items():
        outputs = [each for each in (name, f"{name}_1", f"{name}_2") if f"{each}_error" in last.coords]
        every = [_known(last, each, word, errors.get(each)) for each in outputs]
        found += sorted((each for each in every if each), key=lambda each: -each.half)[:1]
    return found


def _known(last: xr.Dataset, output: str, word: str, error: Error | None) -> Known | None:
    """Return how well an output is known; None of one that is zero and no share."""
    half, value = float(half_width(last, output)), abs(float(last[output]))  # type: ignore[arg-type]
    if output in SHARES:
        return Known(word, half, True, says_nothing(output, value, half), error)
    return Known(word, half / value, False, says_nothing(output, value, half), error) if value > 0.0 else None


def _cause(error: Error | None) -> str:
    """Return the cause of most of an error in words; empty if it is not known."""
    if error is None or error.together == 0.0:
        return ""
    name, half = max(error._asdict().items(), key=lambda item: item[1])
    others = math.sqrt(max(error.together**2 - half**2, 0.0))
    return _CAUSES[name] if half > 2.0 * others else f"mostly {_CAUSES[name]}"


def way_out(scenes: Iterable[Scene]) -> str:
    """Return what makes contacts of some scenes surer; empty if there is nothing more."""
    if any(scene.film.fidelity in UNSOLVED for scene in scenes):
        return "Surer: --set film.correction=blocks or film.model=deterministic."
    return "" if all(scene.control.accuracy for scene in scenes) else "Surer: --accuracy 5%."
