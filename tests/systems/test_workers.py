"""Workers that are lost: the command ends with what has come and a sentence, and waits for nothing that cannot come."""

import itertools
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Executor, Future, wait
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from contact_core.errors import ContactError
from system_models.run import workers as module
from system_models.run.workers import Workers, _lost_of_cluster, done_by, workers

ENDS = ("result", "loss", "never")


class Scripted(Executor):
    """Gives each task the end that is written for it; `closed`: asking is a loss once so many are asked for."""

    def __init__(self, ends: list[str], closed: int) -> None:
        self._ends, self._closed, self.asked = iter(ends), closed, 0

    def submit(self, task: Callable[..., Any], /, *given: Any, **named: Any) -> Future[Any]:
        if self.asked == self._closed:
            raise CancelledError
        self.asked += 1
        future: Future[Any] = Future()
        end = next(self._ends)
        if end == "result":
            future.set_result(task(*given))
        elif end == "loss":
            future.set_exception(CancelledError())
        return future


@given(ends=st.lists(st.sampled_from(ENDS), min_size=1, max_size=8), count=st.integers(1, 3), closed=st.integers(0, 9))
def test_what_has_come_is_given_before_the_sentence_and_nothing_is_waited_for(
    ends: list[str], count: int, closed: int
) -> None:
    executor = Scripted(ends, closed)
    lost = Workers(executor, count, (CancelledError,), lambda loss: "Workers are lost.")
    got: list[int] = []
    waits = itertools.count()

    def bounded(*given: Any) -> Any:
        assert next(waits) <= len(ends), "it waits for ever"
        return wait(*given)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "_LOOK", 0.001)
        patch.setattr(module, "wait", bounded)
        try:
            got.extend(done_by(lost, abs, ((-k,) for k in range(len(ends)))))
        except ContactError as error:
            assert str(error) == "Workers are lost. What is done is kept: the same command goes on from there."
            assert closed < len(ends) or set(ends) != {"result"}
        else:
            assert len(got) == len(ends)
    assert sorted(got) == [k for k, end in enumerate(ends[: executor.asked]) if end == "result"]


class Cluster:
    """A client of a scheduler that answers with its workers, or not at all."""

    def __init__(self, scheduler: bool, now: int, soon: int) -> None:
        self.scheduler = self
        self.ncores = self._answers, scheduler, now, soon

    def _answers(self) -> None:
        raise NotImplementedError

    def sync(self, asked: tuple[Any, bool, int, int], callback_timeout: float) -> dict[str, int]:
        assert callback_timeout < 30.0
        if not asked[1]:
            raise OSError
        return {f"worker {k}": 1 for k in range(asked[2])}

    def wait_for_workers(self, count: int, timeout: float) -> None:
        assert timeout < 30.0
        if self.ncores[3] < count:
            raise TimeoutError


@pytest.mark.parametrize(
    ("cluster", "loss", "said"),
    [
        ((True, 2, 0), None, ""),
        ((True, 0, 1), None, ""),  # a nanny starts it again
        ((True, 0, 0), None, "All workers of 'dask://a:1' are lost. Start some: dask worker HOST:PORT."),
        ((False, 0, 0), None, "The scheduler at 'dask://a:1' is lost. Start it and its workers again."),
        ((True, 2, 0), CancelledError(), "The scheduler at 'dask://a:1' is lost. Start it and its workers again."),
        ((True, 2, 0), type("KilledWorker", (Exception,), {})(), "Workers of 'dask://a:1' ended again and again"),
    ],
)
def test_what_is_lost_of_a_cluster_is_named(cluster: tuple[bool, int, int], loss: Any, said: str) -> None:
    found = _lost_of_cluster(Cluster(*cluster), "dask://a:1", loss)
    assert found.startswith(said) and bool(found) == bool(said)


def test_a_process_that_is_killed_ends_the_command_with_a_sentence() -> None:
    with workers(2, None) as pool, pytest.raises(ContactError, match="A worker process has ended before its task"):
        list(done_by(pool, os._exit, iter([(1,)])))


def test_what_has_come_is_given_before_the_next_arguments_take_a_while() -> None:
    def arguments() -> Iterator[tuple[int] | None]:
        yield from ((-1,), (-2,), (-3,), None, None, (-4,))

    begin, executor = time.monotonic(), Scripted(["result", "never", "never", "result"], 9)
    results = done_by(Workers(executor, 1, (), lambda loss: "Lost."), abs, arguments(), 9)
    assert next(results) == 1 and executor.asked == 3
    assert next(results) == 4
    assert time.monotonic() - begin < module._LOOK
    assert list(done_by(Workers(), abs, arguments())) == [1, 2, 3, 4]


OF_POOL = """
import time
from system_models.run.workers import done_by, workers
with workers(2, None) as pool:
    for _ in done_by(pool, time.sleep, iter([(0.01,), (600.0,)])):
        {then}
"""


def test_a_command_that_is_interrupted_waits_for_no_task() -> None:
    """Where the interrupt is for it alone: a terminal gives it to the workers, too."""
    program = OF_POOL.format(then="raise KeyboardInterrupt")
    assert subprocess.run([sys.executable, "-c", program], timeout=60.0, stderr=subprocess.DEVNULL).returncode


def children(process: int) -> list[int]:
    return [int(one) for one in Path(f"/proc/{process}/task/{process}/children").read_text().split()]


def until(true: Callable[[], bool], seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end
        time.sleep(0.05)


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="looks for children in /proc")
def test_workers_end_with_a_command_that_is_killed() -> None:
    with subprocess.Popen([sys.executable, "-c", OF_POOL.format(then="pass")]) as command:
        until(lambda: len(children(command.pid)) == 3)  # of them one keeps count of resources
        time.sleep(2.0)  # the workers have begun
        left = children(command.pid)
        command.kill()
    until(lambda: not any(Path(f"/proc/{one}").exists() for one in left))


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
@pytest.mark.parametrize(
    ("killed", "said"),
    [((0,), "The scheduler at"), ((1, 2), "All workers of"), ((1,), "")],
    ids=["scheduler", "all workers", "one worker"],
)
def test_a_cluster_that_is_killed_ends_the_command_within_a_minute(killed: tuple[int, ...], said: str) -> None:
    pytest.importorskip("distributed")
    with socket.create_server(("127.0.0.1", 0)) as free:
        address = f"127.0.0.1:{free.getsockname()[1]}"
    port = address.partition(":")[2]
    node = [sys.executable, "-m"]
    scheduler = [*node, "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", port, "--no-dashboard"]
    worker = [*node, "distributed.cli.dask_worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
    with ExitStack() as exits:
        nodes = [
            exits.enter_context(subprocess.Popen(call, stderr=subprocess.DEVNULL))
            for call in (scheduler, worker, worker)
        ]
        for one in nodes:
            exits.callback(one.kill)
        time.sleep(8.0)
        got: list[Any] = []
        with workers(1, f"dask://{address}") as given:
            results = done_by(given, time.sleep, ((1.0,) for _ in range(8)))
            got.append(next(results))
            for k in killed:
                nodes[k].send_signal(signal.SIGKILL)
            begin = time.monotonic()
            try:
                got.extend(results)
            except ContactError as error:
                assert said and str(error).startswith(said)
            else:
                assert not said and len(got) == 8
        assert time.monotonic() - begin < 60.0
