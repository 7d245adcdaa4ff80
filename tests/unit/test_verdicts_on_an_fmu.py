"""The exit code of a check: 1 for a failed rule, 3 for an FMU that was not seen to run."""

import pytest

from system_models.check import deep
from system_models.check.report import exit_code, summary
from system_models.check.verdict import Finding, Verdict

RAN = Finding("run", Verdict.PASS, "It runs.")
NOT_SEEN = Finding("run", Verdict.NOTE, f"{deep.UNFINISHED} 20 s.")
CANNOT = Finding("run", Verdict.NOT_APPLICABLE, "There is no binary for this machine, linux64.")
SLOW = Finding("replay", Verdict.NOTE, f"{deep.UNFINISHED} 20 s.")
WRONG = Finding("replay", Verdict.FAIL, "It gives other bits.")


@pytest.mark.parametrize(
    ("found", "code"),
    [
        ([RAN], 0),
        ([RAN, SLOW], 0),
        ([NOT_SEEN], 3),
        ([CANNOT, SLOW], 3),
        ([RAN, WRONG], 1),
        ([NOT_SEEN, WRONG], 1),
        ([], 0),
    ],
)
def test_a_failure_comes_before_what_was_not_seen(found: list[Finding], code: int) -> None:
    assert exit_code(found) == code


def test_what_was_not_finished_is_counted() -> None:
    assert summary([RAN, SLOW, NOT_SEEN]).endswith("; 2 not finished in time")
    assert "not finished" not in summary([RAN, WRONG])
