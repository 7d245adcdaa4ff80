"""Workers that solve the parts of maps, sweeps and Stribeck curves: this process, others here, or a cluster."""

import logging
import os
import signal
import threading
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    wait,
)
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import islice
from multiprocessing import active_children, get_context, parent_process
from typing import Any, TypeVar

from contact_core.errors import ContactError

Result = TypeVar("Result")
_CLUSTER = "dask://"
_AHEAD = 2  # tasks for each worker that are asked for


_LOOK = 5.0  # s without a result after which is asked whether any can come
_ANSWER = 15.0  # s in which a scheduler must answer
_PATIENCE = 20.0  # s in which lost workers of a cluster may start again
_GOES_ON = "What is done is kept: the same command goes on from there."


class WorkersLostError(ContactError):
    """No result can come any more; `reason` says why."""

    def __init__(self, reason: str) -> None:
        super().__init__(f"{reason} {_GOES_ON}")
        self.reason = reason


@dataclass(frozen=True)
class Workers:
    """Where tasks are done, and how their loss shows."""

    executor: Executor | None = None  # None: this process
    count: int = 1  # tasks at a time
    losses: tuple[type[BaseException], ...] = ()  # of a task, or when asking for one, once workers are lost
    lost: Callable[[BaseException | None], str] = lambda loss: ""  # why no result can come, by a loss or after a wait


@contextmanager
def workers(processes: int, where: str | None) -> Iterator[Workers]:
    """Give the workers: this process, others, or those of a cluster.

    `where` is "dask://HOST:PORT" of a scheduler. Raises ContactError if it cannot be used.
    """
    if where:
        with _cluster(where) as found:
            yield found
    elif processes == 1:
        yield Workers()
    else:
        others = active_children()
        with ProcessPoolExecutor(processes, get_context("spawn"), _begin_worker) as pool:
            try:
                yield Workers(pool, processes, (BrokenExecutor,), _lost_of_pool)
            except BaseException:  # nobody waits for what is being solved
                for process in set(active_children()).difference(others):
                    process.terminate()
                raise
            finally:
                pool.shutdown(wait=False, cancel_futures=True)


def cores() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _lost_of_pool(loss: BaseException | None) -> str:
    """Return why a pool has no more results; it breaks as soon as a process ends, so a wait says nothing."""
    if loss is None:
        return ""
    return (
        "A worker process has ended before its task: killed, or out of memory. With less memory use fewer --processes."
    )


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


def _begin_worker() -> None:
    """Let this worker end with the command, and without a word by an interrupt: the command has the word.

    An interrupt may have been held back.
    """
    threading.Thread(target=_end_with_command, daemon=True).start()
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})


def _end_with_command() -> None:
    """Wait for the end of the command; one that was killed would leave its workers waiting for tasks for ever."""
    command = parent_process()
    assert command is not None
    command.join()
    os._exit(1)


@contextmanager
def _cluster(where: str) -> Iterator[Workers]:
    if not where.startswith(_CLUSTER):
        raise ContactError(f"--executor = '{where}' is not {_CLUSTER}HOST:PORT.")
    try:
        from distributed import Client, KilledWorker
        from distributed.client import ClosedClientError
    except ImportError:
        raise ContactError(
            "--executor dask://... needs dask.distributed: pip install 'tribofmu[dask]', or use --processes."
        ) from None
    try:
        client = Client(f"tcp://{where.removeprefix(_CLUSTER)}", timeout="10s")
    except (OSError, TimeoutError, ValueError) as error:
        raise ContactError(f"There is no scheduler at '{where}' ({error}). Start one: dask scheduler.") from None
    with _quiet("distributed", "distributed.client", "tornado.application"), client:
        threads = sum(client.nthreads().values())
        if not threads:
            raise ContactError(f"The scheduler at '{where}' has no workers. Start some: dask worker HOST:PORT.")
        losses = (CancelledError, KilledWorker, ClosedClientError)
        yield Workers(client.get_executor(pure=False), threads, losses, partial(_lost_of_cluster, client, where))


def _lost_of_cluster(client: Any, where: str, loss: BaseException | None) -> str:
    """Return why a cluster has no more results; its workers may take some seconds to start again."""
    if type(loss).__name__ == "KilledWorker":
        return (
            f"Workers of '{where}' ended again and again at the same task: killed, or out of memory. Give them more "
            "memory, or fewer threads."
        )
    why = f"The scheduler at '{where}' is lost. Start it and its workers again."
    if loss:
        return why
    try:
        if not client.sync(client.scheduler.ncores, callback_timeout=_ANSWER):
            why = f"All workers of '{where}' are lost. Start some: dask worker HOST:PORT."
            client.wait_for_workers(1, _PATIENCE)
    except Exception:  # a lost connection shows in many ways
        return why
    return ""


@contextmanager
def _quiet(*names: str) -> Iterator[None]:
    """Keep loggers from tracebacks of lost connections: the command has the word."""
    loggers = [logging.getLogger(name) for name in names]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)


def done_by(
    given: Workers, task: Callable[..., Result], arguments: Iterator[tuple[Any, ...] | None], most: int = 0
) -> Generator[Result]:
    """Yield the results of a task as they come; more are asked for as long as results are taken.

    None among the arguments: the next ones take a while, and what has come is given first. At most so many tasks are
    asked for at a time; 0: a few for each worker. Raises WorkersLostError once no more can come, after all that have.
    """
    if given.executor is None:
        for each in arguments:
            if each is not None:
                yield task(*each)
        return
    most = most or _AHEAD * given.count
    asked: set[Future[Result]] = set()
    while True:
        tasks, later = _next(arguments, most - len(asked))
        reason = _asked_for(given, task, tasks, asked)
        if not (asked or later or reason):
            return
        finished, asked = wait(asked, 0.0 if later or reason else _LOOK, FIRST_COMPLETED)
        for future in finished:
            try:
                result = future.result()
            except given.losses as loss:
                reason = reason or given.lost(loss)
            else:
                yield result
        if reason := reason or ("" if finished or later else given.lost(None)):
            raise WorkersLostError(reason)


def _next(arguments: Iterator[tuple[Any, ...] | None], most: int) -> tuple[list[tuple[Any, ...]], bool]:
    """Return the next arguments, and whether None has ended them."""
    found: list[tuple[Any, ...]] = []
    for each in islice(arguments, most):
        if each is None:
            return found, True
        found.append(each)
    return found, False


def _asked_for(
    given: Workers, task: Callable[..., Result], tasks: list[tuple[Any, ...]], asked: set[Future[Result]]
) -> str:
    """Ask for results; return why none can come, else an empty text."""
    assert given.executor is not None
    with _interrupts_held():
        try:
            asked.update(given.executor.submit(task, *each) for each in tasks)
        except given.losses as loss:
            return given.lost(loss)
    return ""
