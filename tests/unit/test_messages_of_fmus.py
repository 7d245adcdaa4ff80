"""Messages of FMUs are logged by their status."""

import logging

import pytest

from system_models.fmu.messages import cause, pass_on, said


@pytest.mark.parametrize(
    ("status", "level"),
    [(0, "INFO"), (1, "WARNING"), (2, "WARNING"), (3, "ERROR"), (4, "CRITICAL"), (5, "CRITICAL")],
)
def test_ok_warning_discard_error_and_fatal_have_their_levels(
    status: int, level: str, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.DEBUG):
        pass_on("contact", status, b"oil at 80 \xc2\xb0C \xff")
    (record,) = caplog.records
    assert (record.levelname, record.getMessage()) == (level, "contact: oil at 80 °C �")
    assert (record.status, record.text) == (status, "oil at 80 °C �")  # type: ignore[attr-defined]


def test_a_message_may_be_empty(caplog: pytest.LogCaptureFixture) -> None:
    pass_on("contact", 3, None)
    assert caplog.records[0].getMessage() == "contact: "


def test_the_cause_is_the_first_line_of_the_last_message_of_something_wrong() -> None:
    said.clear()
    assert cause("a") == "It gave no message; ask who made it."
    for status, text in ((1, b"It is cold."), (3, b"It is stuck.\nat line 3"), (0, b"all is well"), (1, None)):
        pass_on("a", status, text)
    assert cause("a") == "It says: It is stuck."
