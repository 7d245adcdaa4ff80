"""Every rule answered, one after the other, and the lines that are printed."""

from collections import Counter
from collections.abc import Iterable, Iterator

from . import deep, static
from .package import Package
from .verdict import Finding, Verdict, failed

_WIDTH = max(map(len, [*static.RULES, *deep.RULES]))


def findings(
    package: Package, thorough: bool, limit: float, budget: float, settings: Iterable[tuple[str, str]] = ()
) -> Iterator[Finding]:
    """Yield the answers of the static rules and, if `thorough`, of those that run the FMU.

    `limit` [s] is for a call, `budget` [s] for a rule.

    `settings` are start values of the run.
    """
    for name, rule in static.RULES.items():
        try:
            answer = rule(package)
        except ValueError as error:
            answer = failed(f"A value cannot be read: {error}.")
        yield Finding(name, *answer)
    if thorough:
        yield from deep.findings(package, limit, budget, settings)


def line(finding: Finding) -> str:
    """Return the name, verdict and evidence."""
    return f"{finding.rule:{_WIDTH}}  {finding.verdict:4}  {finding.evidence}"


def summary(found: Iterable[Finding]) -> str:
    """Return the number of each verdict, and of the rules that were not finished."""
    listed = list(found)
    count = Counter(finding.verdict for finding in listed)
    text = ", ".join(f"{count[verdict]} {verdict}" for verdict in Verdict)
    unfinished = sum(finding.evidence.startswith(deep.UNFINISHED) for finding in listed)
    return f"{text}; {unfinished} not finished in time" if unfinished else text


def exit_code(found: Iterable[Finding]) -> int:
    """Return 0 if no rule failed, 1 if some did, 3 if none did but the FMU has not been seen to run."""
    listed = list(found)
    if any(finding.verdict is Verdict.FAIL for finding in listed):
        return 1
    ran = all(
        f.verdict is not Verdict.NOT_APPLICABLE and not f.evidence.startswith(deep.UNFINISHED)
        for f in listed
        if f.rule == "run"
    )
    return 0 if ran else 3
