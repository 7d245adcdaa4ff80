"""What all tests share: a test's marker is the folder it lies in, random inputs repeat in every run, long tests wait for .ci/full."""

import os
import signal
import sys
from pathlib import Path

# the benchmarks; behind the installed packages, which are what is tested
sys.path.append(str(Path(__file__).parents[1]))

# before numpy is loaded: threads that wait for each other on matrices of six rows take half of the time of some files
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from hypothesis import HealthCheck, settings

# a background job of a shell inherits that Ctrl-C is ignored; tests of interrupts raise it themselves
signal.signal(signal.SIGINT, signal.default_int_handler)

UNTIMED = [HealthCheck.too_slow]  # which a busy machine fails
settings.register_profile(
    "repeatable", derandomize=True, deadline=None, database=None, max_examples=60, suppress_health_check=UNTIMED
)
settings.load_profile("repeatable")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    later = pytest.mark.skipif("TRIBOFMU_TEST_LONG" not in os.environ, reason="TRIBOFMU_TEST_LONG is not set")
    for item in items:
        if item.get_closest_marker("long"):
            item.add_marker(later)
        item.add_marker(item.path.relative_to(Path(__file__).parent).parts[0])
