"""The faults that the tests are judged by are those of the code as it is."""

from dataclasses import replace

import pytest

from benchmarks.house.faults import listed, misfits


def test_the_faults_fit_the_code_and_name_tests_that_are_there() -> None:
    assert misfits(listed()) == []


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"changes": (("contact_core/errors.py", "what never stood there", ""),)}, "occurs 0 times"),
        ({"tests": ("tests/unit/test_fault_list.py::test_that_is_gone",)}, "there is no test"),
        ({"tests": ()}, "either tests or a reason"),
    ],
)
def test_a_fault_that_fits_no_longer_is_said(change: dict[str, tuple], said: str) -> None:
    fault = next(fault for fault in listed() if fault.tests)
    assert said in misfits([replace(fault, **change)])[0]
