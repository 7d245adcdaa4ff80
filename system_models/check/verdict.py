"""The answer of one rule."""

from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple


class Verdict(StrEnum):
    """Verdict of a rule on an FMU."""

    PASS = "pass"
    FAIL = "fail"
    NOTE = "note"  # allowed, but worth knowing before the FMU is used
    NOT_APPLICABLE = "n/a"


class Answer(NamedTuple):
    """A verdict and its evidence, one sentence."""

    verdict: Verdict
    evidence: str


@dataclass(frozen=True)
class Finding:
    """The answer of the rule called `rule`."""

    rule: str
    verdict: Verdict
    evidence: str


def passed(evidence: str) -> Answer:
    """Return the answer of a rule that holds."""
    return Answer(Verdict.PASS, evidence)


def failed(evidence: str) -> Answer:
    """Return the answer of a rule that is broken."""
    return Answer(Verdict.FAIL, evidence)


def noted(evidence: str) -> Answer:
    """Return the answer of a rule that is not broken, but of which a user should know."""
    return Answer(Verdict.NOTE, evidence)


def not_applicable(evidence: str) -> Answer:
    """Return the answer of a rule that does not apply to this FMU."""
    return Answer(Verdict.NOT_APPLICABLE, evidence)


def some(names: list[str], count: int = 3) -> str:
    """Return the first few names, and how many more there are."""
    more = len(names) - count
    return ", ".join(names[:count]) + (f" and {more} more" if more > 0 else "")
