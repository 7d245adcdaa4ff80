"""Outcomes as text: a table of the rows, the cause of each disagreement, and a summary."""

from collections import Counter
from collections.abc import Mapping

from ..run.cosim_report import aligned
from .model import Comparison, Outcome, Row, Verdict


def cells(row: Row) -> tuple[str, str, str, str, str]:
    """Return quantity, reference, computed value, deviation over what is allowed, and verdict."""
    low, high = row.reference
    off = not abs(row.deviation) < 1e-9 * abs(row.computed)  # more than rounding of the computer
    unit = f" {row.unit}" if row.unit else ""
    reference = (
        f"{low:.4g}" if low == high else f"at least {low:.4g}" if high == float("inf") else f"{low:.4g} to {high:.4g}"
    )
    if row.uncertainty:
        reference += f" ± {row.uncertainty:.2g}"
    computed = f"{row.computed:.4g}" + (f" ± {row.stated_error:.2g}" if row.stated_error else "")
    return (
        row.quantity,
        reference + unit,
        computed + unit,
        f"{row.deviation:+.2g}{unit}" if off else "none",
        row.verdict,
    )


HEADINGS = ("quantity", "reference", "computed", "off by", "verdict")


def render(name: str, comparison: Comparison, outcome: Outcome) -> str:
    """Return a comparison's rows as a table, each disagreement followed by its cause."""
    lines = [f"{name} ({comparison.kind}): {comparison.title}. {outcome.verdict}."]
    if outcome.failure:
        return "\n".join([*lines, f"  cannot be computed: {outcome.failure}"])
    rows = [list(HEADINGS), *(list(cells(row)) for row in outcome.rows)]
    texts = [f"  {text}" for text in aligned(rows, len(HEADINGS))]
    lines.append(texts[0])
    for text, row in zip(texts[1:], outcome.rows, strict=True):
        lines.append(text)
        lines.extend(f"    {sentence}" for sentence in remarks(row))
    return "\n".join(lines)


def remarks(row: Row) -> list[str]:
    """Return why a row is not judged, or the cause of a disagreement, if there is one."""
    if row.not_judged:
        return [f"not judged: {row.not_judged}"]
    if row.verdict is Verdict.EXPLAINED and row.cause is not None:
        return [f"cause: {row.cause.text}"]
    if row.verdict is Verdict.DISAGREES:
        known = f"; the known cause explains {row.cause.least:.4g} to {row.cause.largest:.4g}" if row.cause else ""
        return [f"no known cause{known}"]
    return []


def summary(outcomes: Mapping[str, Outcome]) -> str:
    """Return the number of rows of each verdict, and of comparisons that could not be computed."""
    count = Counter(row.verdict for outcome in outcomes.values() for row in outcome.rows)
    failed = sum(bool(outcome.failure) for outcome in outcomes.values())
    text = ", ".join(f"{count[verdict]} {verdict}" for verdict in Verdict if count[verdict])
    return f"{text}; {failed} not computed" if failed else text
