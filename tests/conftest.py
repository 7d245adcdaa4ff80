"""What all tests share: markers, of which `long` waits for .ci/full; random inputs repeat in every run."""

import gc
import os
import signal
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

# the benchmarks; behind the installed packages, which are what is tested
sys.path.append(str(Path(__file__).parents[1]))

# before numpy is loaded: threads that wait for each other on matrices of six rows take half of the time of some files
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import lark
import pytest
from built import Built
from filelock import FileLock
from hypothesis import HealthCheck, settings
from numba.core.compiler_lock import global_compiler_lock
from numba.core.dispatcher import Dispatcher

# a background job of a shell inherits that Ctrl-C is ignored; tests of interrupts raise it themselves
signal.signal(signal.SIGINT, signal.default_int_handler)

gc.disable()  # until all tests are found, of which nothing is garbage

UNTIMED = [HealthCheck.too_slow]  # which a busy machine fails
EXAMPLES = int(os.environ.get("TRIBOFMU_TEST_EXAMPLES", "25"))  # of each property: more in .ci/full
settings.register_profile(
    "repeatable", derandomize=True, deadline=None, database=None, max_examples=EXAMPLES, suppress_health_check=UNTIMED
)
settings.load_profile("repeatable")


def pytest_xdist_auto_num_workers() -> int:
    """One more than there are processors: some tests wait for processes and for limits of time."""
    return (os.cpu_count() or 1) + 1


def pytest_collection_finish() -> None:
    """What is there by now stays: searches for garbage leave it alone."""
    gc.freeze()
    gc.enable()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    later = pytest.mark.skipif("TRIBOFMU_TEST_LONG" not in os.environ, reason="TRIBOFMU_TEST_LONG is not set")
    for item in items:
        if item.get_closest_marker("long"):
            item.add_marker(later)
        item.add_marker(item.path.relative_to(Path(__file__).parent).parts[0])


@pytest.fixture(scope="session")
def built(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Built:
    return Built(request, tmp_path_factory)


@pytest.fixture(scope="session", autouse=True)
def _native_fmus_share_their_parts(built: Built) -> Iterator[None]:
    with built.sharing():
        yield


@pytest.fixture(scope="session", autouse=True)
def _each_kernel_compiled_once(built: Built) -> Iterator[None]:
    """By the process that needs it first; the others wait for it."""
    compiled = Dispatcher.compile

    @cache
    def lock(kernel: Any) -> FileLock:
        return FileLock(built.root / f"{kernel.__module__}.{kernel.__qualname__}.lock")

    def compile_once(self: Any, signature: Any) -> Any:
        with global_compiler_lock, lock(self.py_func):
            return compiled(self, signature)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Dispatcher, "compile", compile_once)
        yield


@pytest.fixture(scope="session", autouse=True)
def _each_name_parsed_once() -> Iterator[None]:
    """fmpy parses the names of an FMU's variables whenever it validates one, which takes half a second."""
    parse, known = lark.Lark.parse, dict[tuple[str, str], Any]()

    def parse_once(self: lark.Lark, text: str) -> Any:
        key = self.source_grammar, text
        if key not in known:
            known[key] = parse(self, text)
        return known[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(lark.Lark, "parse", parse_once)
        yield
