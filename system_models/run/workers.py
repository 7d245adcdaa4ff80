"""Workers that solve the knots of maps and the points of sweeps: this process, others on this machine, or a cluster."""

import signal
import threading
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
from itertools import islice
from multiprocessing import get_context
from typing import Any, TypeVar

from contact_core.errors import ContactError

Result = TypeVar("Result")
_CLUSTER = "dask://"
_AHEAD = 2  # tasks for each worker that are asked for


@contextmanager
def workers(processes: int, where: str | None) -> Iterator[tuple[Executor | None, int]]:
    """Give an executor and how many tasks it works on at a time; None for this process.

    `where` is "dask://HOST:PORT" of a scheduler. Raises ContactError if it cannot be used.
    """
    if where:
        with _cluster(where) as found:
            yield found
    elif processes == 1:
        yield None, 1
    else:
        with ProcessPoolExecutor(processes, get_context("spawn"), _end_when_interrupted) as pool:
            try:
                yield pool, processes
            finally:
                pool.shutdown(wait=False, cancel_futures=True)


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Hold an interrupt back while processes start.

    Those that start inherit a blocked signal; without it they would print a traceback. Another thread of this process
    may get the signal, so that its handler waits, too.
    """
    if threading.current_thread() is not threading.main_thread() or not hasattr(signal, "pthread_sigmask"):
        yield  # interrupts are for the main thread; Windows has no masks
        return
    held: list[int] = []
    handler = signal.signal(signal.SIGINT, lambda number, frame: held.append(number))
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        signal.signal(signal.SIGINT, handler)
        if held:
            signal.raise_signal(signal.SIGINT)


def _end_when_interrupted() -> None:
    """Let an interrupt, also one that was held back, end this worker without a word: the command has the word."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})


@contextmanager
def _cluster(where: str) -> Iterator[tuple[Executor, int]]:
    if not where.startswith(_CLUSTER):
        raise ContactError(f"--executor = '{where}' is not {_CLUSTER}HOST:PORT.")
    try:
        from distributed import Client
    except ImportError:
        raise ContactError(
            "--executor dask://... needs dask.distributed: pip install 'tribofmu[dask]', or use --processes."
        ) from None
    try:
        client = Client(f"tcp://{where.removeprefix(_CLUSTER)}", timeout="10s")
    except (OSError, TimeoutError, ValueError) as error:
        raise ContactError(f"There is no scheduler at '{where}' ({error}). Start one: dask scheduler.") from None
    with client:
        threads = sum(client.nthreads().values())
        if not threads:
            raise ContactError(f"The scheduler at '{where}' has no workers. Start some: dask worker HOST:PORT.")
        yield client.get_executor(pure=False), threads


def done_by(
    given: tuple[Executor | None, int], task: Callable[..., Result], arguments: Iterator[tuple[Any, ...]]
) -> Generator[Result]:
    """Yield the results of a task as they come; more are asked for as long as results are taken."""
    executor, count = given
    if executor is None:
        for each in arguments:
            yield task(*each)
        return
    asked: set[Future[Result]] = set()
    while True:
        with _interrupts_held():
            asked.update(executor.submit(task, *each) for each in islice(arguments, _AHEAD * count - len(asked)))
        if not asked:
            return
        finished, asked = wait(asked, return_when=FIRST_COMPLETED)
        for future in finished:
            try:
                yield future.result()
            except BrokenExecutor:
                raise ContactError(
                    "A worker process has ended before its task: killed, or out of memory. What is done is kept: the "
                    "same command goes on from there. With less memory use fewer --processes."
                ) from None
