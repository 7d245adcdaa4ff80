"""Judgement of a claim of the thesis: a measure gives a text and whether the claim holds; the verdict follows.

Where a claim does not hold, experiments look for the cause: the same measure on runs that differ in something,
or another measure on the same runs; the joint reading, in which all conventions of the thesis are together; or a closed
form that shows that the thesis contradicts itself.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from benchmarks.thesis.cases import CASES, SEEDS, Array, Book, Get, Missing, Run
from contact_core import Scene
from contact_core.reference import SmoothContact, hamrock_dowson


@dataclass(frozen=True)
class Finding:
    """Numbers as a text, and whether they bear the claim out; None: it cannot be judged."""

    text: str
    holds: bool | None = None


Measure = Callable[[Get], Finding]


@dataclass(frozen=True)
class Experiment:
    """Something done differently: other runs in place of some, or another measure."""

    text: str
    swap: Mapping[str, str] = field(default_factory=dict)
    measure: Measure | None = None

    def runs_in(self, numerics: str) -> bool:
        """Whether its runs are made in a column."""
        return all(numerics in CASES[name].numerics for name in self.swap.values())


@dataclass(frozen=True)
class Claim:
    """One thing that a figure shows."""

    figure: str
    shows: str
    asked: str  # when a result agrees with it
    measure: Measure
    experiments: tuple[Experiment, ...] = ()
    remark: str = ""  # what is known without a run, above all why a claim cannot be judged
    contradiction: str = ""  # closed form by which the thesis's printed inputs cannot give what its figure shows


@dataclass(frozen=True)
class Judged:
    """A claim in one numerics."""

    verdict: str  # agree, disagree, cannot be judged, not run
    text: str
    causes: tuple[str, ...] = ()
    seeds: str = ""  # in how many of the roughness seeds it holds

    @property
    def explained(self) -> bool:
        """Whether a cause is shown: by an experiment that makes it agree, or by a closed form."""
        return any(cause.startswith((TURNED, CLOSED)) for cause in self.causes)


JOINT = "joint"
TURNED, CLOSED = "agrees with", "closed form"  # how the cause of a disagreement begins
_TORN = 0.2  # a share of the surfaces so near to one half bears a claim neither out nor down
VERDICTS = ("agree", "disagree", "cannot be judged", "not run")


def verdict_of(finding: Finding) -> str:
    """In words."""
    return "cannot be judged" if finding.holds is None else "agree" if finding.holds else "disagree"


def judge(claim: Claim, book: Book, numerics: str) -> Judged:
    """Verdict, numbers and, where they disagree, what the experiments say."""
    get = book.getter(numerics)
    try:
        finding = claim.measure(get)
    except Missing as missing:
        return Judged("not run", str(missing))
    causes = tuple(_causes(claim, book, numerics)) if finding.holds is False else ()
    held, seen = _over_seeds(claim, book, numerics, finding)
    seeds = f"{held}/{seen}" if seen > 1 else ""
    if seen > 1 and abs(held / seen - 0.5) < _TORN:
        return Judged("cannot be judged", finding.text, (*causes, f"holds for {held} of {seen} rough surfaces"), seeds)
    return Judged(verdict_of(finding), finding.text, causes, seeds)


def _causes(claim: Claim, book: Book, numerics: str) -> Iterator[str]:
    """Yield what makes the claim hold, with its numbers, and the names of the other experiments.

    Beside a column's own experiments: the joint reading, and if nothing makes the claim hold, experiments on that.
    """
    if claim.contradiction:
        yield f"{CLOSED}: {claim.contradiction}"
    tried, missing = _all_tried(claim, book, numerics)
    if numerics != JOINT:
        tried += _all_tried(replace(claim, experiments=(Experiment("joint reading"),)), book, JOINT)[0]
        if not any(found.holds for _, found in tried):
            tried += [(f"joint reading, {text}", found) for text, found in _all_tried(claim, book, JOINT)[0]]
    for text, found in tried:
        if found.holds:
            yield f"{TURNED} *{text}*: {found.text}"
    idle = [text for text, found in tried if not found.holds]
    if idle:
        yield f"not by {', '.join(f'*{text}*' for text in idle)}"
    if missing:
        yield f"experiments not run yet: {missing}"
    elif idle and len(idle) == len(tried) and not claim.contradiction:
        yield "cause not found by these experiments"


def _all_tried(claim: Claim, book: Book, numerics: str) -> tuple[list[tuple[str, Finding]], int]:
    """The experiments of a column with what they found, and how many lack their runs."""
    made = [entry for entry in claim.experiments if entry.runs_in(numerics)]
    tried = [(entry.text, found) for entry in made if (found := _tried(entry, claim, book.getter(numerics)))]
    return tried, len(made) - len(tried)


def _tried(experiment: Experiment, claim: Claim, get: Get) -> Finding | None:
    def other(name: str) -> Run:
        return get(experiment.swap.get(name, name))

    try:
        return (experiment.measure or claim.measure)(other)
    except Missing:
        return None


def _over_seeds(claim: Claim, book: Book, numerics: str, first: Finding) -> tuple[int, int]:
    """For how many surfaces of how many a claim holds; of one where it needs runs that were made with one seed only."""
    if first.holds is None:
        return 0, 0
    held = [first.holds]
    for seed in SEEDS[1:]:
        try:
            held.append(bool(claim.measure(book.getter(numerics, seed)).holds))
        except Missing:
            continue
    return sum(held), len(held)


# what measures are made of


def nm(value: float) -> str:
    """A length [m] in nanometres."""
    return f"{1e9 * value:.3g} nm"


def values(numbers: Sequence[float], scale: float = 1e9, digits: int = 3) -> str:
    """Numbers behind each other, by default of metres in nanometres."""
    return ", ".join(f"{scale * value:.{digits}g}" for value in numbers)


def peak(run: Run, name: str) -> tuple[float, float]:
    """Minute and height of the largest value."""
    k = int(np.argmax(run[name]))
    return float(run.t[k]), float(run[name][k])


def takeovers(run: Run) -> Array:
    """Minutes at which dry pressures took over from mixed lubrication, or the reverse: outputs of the film jump there."""
    dry = np.diff(run["blocks_dry"]) > 0.0
    moved = np.diff(run["blocks_mixed"] + run["blocks_dry"]) > 0.0
    minutes, driver = run.t[1:][moved], dry[moved]
    return minutes[1:][driver[1:] != driver[:-1]]


def overshoot(run: Run, name: str) -> float:
    """Largest over last value."""
    return peak(run, name)[1] / run.end(name) if run.end(name) > 0.0 else float("inf")


def rising(numbers: Sequence[float]) -> bool:
    """Return whether each value is above the previous one."""
    return bool(np.all(np.diff(numbers) > 0.0))


def spread(numbers: Sequence[float]) -> float:
    """(largest - smallest) / mean."""
    mean = float(np.mean(numbers))
    return float(np.ptp(numbers)) / mean if mean > 0.0 else float("inf")


def rank_correlation(one: Sequence[float], other: Sequence[float]) -> float:
    """Spearman's, for values that are all different."""
    first, second = (np.argsort(np.argsort(numbers)) for numbers in (one, other))
    return float(np.corrcoef(first, second)[0, 1])


def time_above(one: Run, other: Run, name: str) -> float:
    """Share of the time, the first row aside, in which a column of one run is above that of the other."""
    n = min(one.t.size, other.t.size)
    if n < 2:
        raise Missing("the run is too short")
    return float((one[name][1:n] > other[name][1:n]).mean())


def crossover(one: Run, other: Run, name: str) -> float:
    """Minute from which on one run stays above the other: 0 always, nan if it ends below."""
    n = min(one.t.size, other.t.size)
    below = np.flatnonzero(one[name][1:n] <= other[name][1:n]) + 1
    if below.size == 0:
        return 0.0
    return float("nan") if below[-1] == n - 1 else float(one.t[below[-1] + 1])


def crossing_text(minute: float) -> str:
    """In words."""
    if np.isnan(minute):
        return "ends below"
    return "above from the start" if minute == 0.0 else f"above for good from {minute:.0f} min"


def two_hours(run: Run) -> Run:
    """The run, if it is as long as the claims are about."""
    if run.t[-1] < 119.5:
        raise Missing(f"run ends at {run.t[-1]:g} min")
    return run


def cannot(text: str) -> Measure:
    """Nothing to measure."""
    return lambda get: Finding(text)


def inside(run: Run, share: float = 1.0, field: str = "wear_1") -> Array:
    """Rows of a field with |y| < share * a."""
    return np.abs(run.y(field)) < share * run["a"]


def formula_contact(scene_name: str) -> SmoothContact:
    """The smooth contact of a shipped scene, for formulas."""
    scene = Scene.from_toml(scene_name)
    op, shape = scene.operation.point, scene.geometry
    low, high = scene.lubricant.viscosity(np.array([0.0, 1e6]), op.temperature)
    alpha = float(np.log(high / low)) * 1e-6
    speed, modulus = abs(op.entrainment_speed), scene.solids.reduced_modulus
    return SmoothContact(op.load, speed, float(low), alpha, shape.radius_x, shape.radius_y, modulus)


def viscosity_for(film: float, scene_name: str) -> float:
    """Viscosity [Pa s] at which Hamrock and Dowson's central film is `film` [m], pressure coefficient unchanged."""
    contact = formula_contact(scene_name)
    return contact.viscosity * float((film / hamrock_dowson(contact)[0]) ** (1.0 / 0.67))
