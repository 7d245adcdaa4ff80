"""What a sweep varies: keys of a scene, each on a grid, by choice, or within a range that samples fill."""

import hashlib
import itertools
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from contact_core.arrays import Array
from contact_core.errors import ContactError

SEED = 1  # of samples
METHODS = ("lhs", "sobol", "indices")
MOST = 100_000  # points
_DIGITS = 6  # of a value between the ends of a range
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*$")
_EXAMPLES = "surface_2.rq='50 nm:200 nm:4', operation.load='10 N:50 N:3:log', or tribofilm.set=zddp_80c,zddp_90c"


@dataclass(frozen=True)
class Factor:
    """One key that is varied: `choices` as they are written, or a range that samples fill."""

    key: str
    choices: tuple[str, ...] = ()
    low: float = 0.0
    high: float = 0.0
    unit: str = ""
    logarithmic: bool = False
    together: tuple[tuple[tuple[str, str], ...], ...] = ()  # of each choice: what it sets, if not the key to itself

    @property
    def sampled(self) -> bool:
        """True for a range that samples fill."""
        return not self.choices

    def settings(self, place: int) -> dict[str, str]:
        """Return what a choice sets, by dotted key."""
        return dict(self.together[place]) if self.together else {self.key: self.choices[place]}

    def at(self, share: float) -> float:
        """Return the value at a share, 0 to 1, of the range."""
        if self.logarithmic:
            return math.exp(math.log(self.low) + share * math.log(self.high / self.low))
        return self.low + share * (self.high - self.low)

    def text(self, value: float) -> str:
        """Return a value as a scene writes it."""
        return f"{value:.{_DIGITS}g} {self.unit}".strip()


class Point(NamedTuple):
    """One run of a sweep: its place on each axis, and the settings that it changes the scene by."""

    place: tuple[int, ...]
    settings: dict[str, str]


@dataclass(frozen=True)
class Plan:
    """All points of a sweep: the grid of all choices, with the same samples at each of its nodes."""

    factors: tuple[Factor, ...]
    shares: Array  # [samples, sampled factors], 0 to 1
    method: str  # of the samples

    @property
    def grid(self) -> tuple[Factor, ...]:
        """Factors with choices, one axis each."""
        return tuple(factor for factor in self.factors if not factor.sampled)

    @property
    def sampled(self) -> tuple[Factor, ...]:
        """Factors with ranges, which share the axis of the samples."""
        return tuple(factor for factor in self.factors if factor.sampled)

    @property
    def shape(self) -> tuple[int, ...]:
        """Points along each axis: those of the choices, then that of the samples if there are any."""
        return (*(len(factor.choices) for factor in self.grid), *([len(self.shares)] if self.sampled else []))

    @property
    def text(self) -> str:
        """What is varied, in words that are the same for the same plan alone."""
        digest = hashlib.sha256(self.shares.tobytes()).hexdigest()[:16]
        said = [
            f"{f.key}={':'.join([f.text(f.low), f.text(f.high), *(['log'] if f.logarithmic else [])])}"
            if f.sampled
            else f"{f.key}={','.join(f.choices)}"
            for f in self.factors
        ]
        return "; ".join([*said, *([f"{len(self.shares)} samples {digest}"] if self.sampled else [])])

    def points(self) -> Iterator[Point]:
        """Yield the points, the last axis fastest."""
        for place in itertools.product(*map(range, self.shape)):
            settings: dict[str, str] = {}
            for factor, k in zip(self.grid, place, strict=False):
                settings |= factor.settings(k)
            if self.sampled:
                row = self.shares[place[-1]]
                settings |= {f.key: f.text(f.at(float(s))) for f, s in zip(self.sampled, row, strict=True)}
            yield Point(place, settings)


def plan_of(texts: Sequence[str], samples: int | None, method: str, seed: int = SEED) -> Plan:
    """Return the plan of KEY=VALUES texts. Raises ContactError for what cannot be varied."""
    factors = tuple(map(factor_of, texts))
    keys = [factor.key for factor in factors]
    twice = sorted({key for key in keys if keys.count(key) > 1})
    if twice:
        raise ContactError(f"--vary names {', '.join(twice)} twice. Give each key once.")
    if not factors:
        raise ContactError(f"Nothing is varied. Give --vary KEY=VALUES, such as {_EXAMPLES}.")
    ranges = [factor.key for factor in factors if factor.sampled]
    if ranges and samples is None:
        raise ContactError(
            f"{', '.join(ranges)}: a range without a number of values is filled by samples. Give --samples N, or "
            "LOW:HIGH:N for a grid."
        )
    if samples is not None and not ranges:
        raise ContactError("--samples fills ranges, and no key has one. Give --vary KEY=LOW:HIGH, or leave it out.")
    shares = _shares(len(ranges), samples, method, seed) if ranges and samples is not None else np.empty((0, 0))
    found = Plan(factors, shares, method if ranges else "grid")
    count = math.prod(found.shape)
    if count > MOST:
        raise ContactError(f"That are {count:,} runs; there may be {MOST:,} at most. Vary fewer keys or values.")
    return found


def factor_of(text: str) -> Factor:
    """Return the factor that KEY=VALUES describes. Raises ContactError if it describes none."""
    key, equals, values = (part.strip() for part in text.partition("="))
    if not key or not equals or not values:
        raise ContactError(f"--vary '{text}' is not KEY=VALUES, such as {_EXAMPLES}.")
    if ":" not in values or ".toml:" in values:  # a set of a file is no range
        choices = tuple(part.strip() for part in values.split(","))
        if len({*choices}) < len(choices) or not all(choices) or len(choices) < 2:
            raise ContactError(f"--vary {key} = '{values}' must be two or more different values, apart by commas.")
        return Factor(key, choices)
    low, high, *rest = (part.strip() for part in values.split(":"))
    logarithmic = "log" in rest
    counts = [part for part in rest if part != "log"]
    if len(counts) > 1 or not all(part.isdecimal() for part in counts):
        raise ContactError(f"--vary {key} = '{values}' is not LOW:HIGH, LOW:HIGH:N or either with :log behind.")
    begin, end, unit = _ends(key, low, high)
    if not begin < end:
        raise ContactError(f"--vary {key} = '{values}' must begin below its end.")
    if logarithmic and begin <= 0.0:
        raise ContactError(f"--vary {key} = '{values}' begins at {begin:g}: even steps of the logarithm begin above 0.")
    factor = Factor(key, (), begin, end, unit, logarithmic)
    if not counts:
        return factor
    count = int(counts[0])
    if count < 2:
        raise ContactError(f"--vary {key} = '{values}' needs 2 values or more.")
    return Factor(key, tuple(factor.text(factor.at(k / (count - 1))) for k in range(count)))


def _ends(key: str, low: str, high: str) -> tuple[float, float, str]:
    """Return both ends of a range in the unit that they share."""
    found = [_NUMBER.match(part) for part in (low, high)]
    if not all(found):
        raise ContactError(f"--vary {key} = '{low}:{high}' needs a number at both ends, such as 50 nm:200 nm.")
    first, last = (match for match in found if match)
    units = {match[2] for match in (first, last) if match[2]}
    if len(units) > 1:
        raise ContactError(f"--vary {key} = '{low}:{high}' has two units. Give both ends in one.")
    return float(first[1]), float(last[1]), units.pop() if units else ""


def _shares(count: int, samples: int, method: str, seed: int) -> Array:
    """Return samples [samples, ranges] from 0 to 1."""
    from scipy.stats import qmc

    if samples < 1:
        raise ContactError(f"--samples = {samples} must be at least 1.")
    if method == "lhs":
        return np.asarray(qmc.LatinHypercube(count, seed=seed).random(samples))
    if samples & (samples - 1):
        near = 1 << round(math.log2(samples))
        raise ContactError(f"--samples = {samples}: Sobol's sequence needs a power of 2, such as {near}.")
    if method == "sobol":
        return np.asarray(qmc.Sobol(count, seed=seed).random(samples))
    both = np.asarray(qmc.Sobol(2 * count, seed=seed).random(samples))
    first, second = both[:, :count], both[:, count:]
    swapped = []
    for column in range(count):
        each = first.copy()
        each[:, column] = second[:, column]
        swapped.append(each)
    return np.vstack([first, second, *swapped])
