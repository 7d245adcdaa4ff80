"""What all tests share: markers, of which `long` waits for .ci/full; random inputs repeat in every run."""

import gc
import os
import signal
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

# the benchmarks; behind the installed packages, which are what is tested
sys.path.append(str(Path(__file__).parents[1]))

# before numpy is loaded: threads that wait for each other on matrices of six rows take half of the time of some files
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import lark
import pytest
from built import Built
from hypothesis import HealthCheck, settings

# a background job of a shell inherits that Ctrl-C is ignored; tests of interrupts raise it themselves
signal.signal(signal.SIGINT, signal.default_int_handler)

gc.disable()  # while tests are collected, which makes objects that all stay and nothing else

UNTIMED = [HealthCheck.too_slow]  # which a busy machine fails
EXAMPLES = int(os.environ.get("TRIBOFMU_TEST_EXAMPLES", "25"))  # of each property: more in .ci/full
settings.register_profile(
    "repeatable", derandomize=True, deadline=None, database=None, max_examples=EXAMPLES, suppress_health_check=UNTIMED
)
settings.load_profile("repeatable")


def pytest_xdist_auto_num_workers() -> int:
    """One more than there are processors: some tests wait for processes and for limits of time."""
    return (os.cpu_count() or 1) + 1


def pytest_configure(config: pytest.Config) -> None:
    """Compile the usual kernels once, while xdist's workers collect, instead of in each of them."""
    if config.getoption("numprocesses", None) and not hasattr(config, "workerinput"):
        process = subprocess.Popen([sys.executable, "-P", str(Path(__file__).with_name("kernels.py"))])
        config.add_cleanup(process.wait)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    later = pytest.mark.skipif("TRIBOFMU_TEST_LONG" not in os.environ, reason="TRIBOFMU_TEST_LONG is not set")
    for item in items:
        if item.get_closest_marker("long"):
            item.add_marker(later)
        item.add_marker(item.path.relative_to(Path(__file__).parent).parts[0])


def pytest_collection_finish() -> None:
    gc.freeze()
    gc.enable()


@pytest.fixture(scope="session")
def built(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Built:
    return Built(request, tmp_path_factory)


@pytest.fixture(scope="session", autouse=True)
def _native_fmus_share_their_parts(built: Built) -> Iterator[None]:
    with built.sharing():
        yield


@pytest.fixture(scope="session", autouse=True)
def _fmus_packed_less_densely() -> Iterator[None]:
    """Packing is half of the time in which an FMU is built."""
    compressor = zipfile._get_compressor  # type: ignore[attr-defined]

    def fast(kind: int, level: int | None = None) -> Any:
        return compressor(kind, 1 if level is None else level)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(zipfile, "_get_compressor", fast)
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
