"""A progress bar that moves while nothing is finished."""

import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st

from contact_core.progress import ALGORITHM, tell
from system_models.cli import alive, progress


class Bar:
    """Keeps what a bar is told to show."""

    def __init__(self, wanted: str) -> None:
        self.shown: list[str] = []
        self.wanted, self.seen = wanted, threading.Event()

    def set_postfix_str(self, text: str, refresh: bool) -> None:
        self.shown.append(text)
        if text == self.wanted:
            self.seen.set()


@pytest.fixture(autouse=True)
def often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(alive, "_EVERY_IN_A_FILE", 0.01)
    monkeypatch.setattr(alive, "_EVERY", 0.01)


def test_the_bar_shows_what_is_being_solved_and_forgets_it_at_the_end() -> None:
    bar = Bar("instant 3 of 35, algorithm 2 of 4")
    with alive.alive(bar):
        tell("instant", 3, 35)
        tell(ALGORITHM, 2, 4)
        assert bar.seen.wait(10.0)
    assert bar.shown[-1] == ""


def test_kernels_that_compile_are_told() -> None:
    from numba import njit

    begun, go_on = threading.Event(), threading.Event()
    bar = Bar("compiling kernels, once after installation: 0 so far")
    with alive.alive(bar):
        from numba.core import event

        class Halt(event.Listener):
            def on_start(self, event: object) -> None:
                begun.set()
                go_on.wait(10.0)

            def on_end(self, event: object) -> None:
                pass

        with event.install_listener("numba:compile", Halt()):
            thread = threading.Thread(target=lambda: njit(lambda x: x + 1)(1))
            thread.start()
            assert begun.wait(10.0)
            assert bar.seen.wait(10.0)
            go_on.set()
            thread.join()


def test_time_left_is_estimated_from_the_parts_done(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [100.0]
    monkeypatch.setattr(alive, "monotonic", lambda: clock[0])
    doing = alive._Doing()
    for number, now in ((1, 100.0), (2, 102.0), (5, 108.0)):
        clock[0] = now
        doing.told("instant", number, 8)
    assert doing.text() == "instant 5 of 8, about 8 s left of them"


def test_nothing_is_shown_once_no_part_is_left() -> None:
    doing = alive._Doing()
    doing.told("instant", 1, 8)
    doing.told("instant", 8, 8)
    doing.told("", 0, 0)
    assert doing.text() == ""


def test_time_left_of_parts_leaves_out_what_compiling_took(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [100.0]
    monkeypatch.setattr(alive, "monotonic", lambda: clock[0])
    doing = alive._Doing()
    doing.told("instant", 1, 8)
    for depth_and_time in ((1, 101.0), (1, 102.0), (-1, 120.0), (-1, 131.0)):  # a kernel within another, 30 s
        clock[0] = depth_and_time[1]
        doing.begins() if depth_and_time[0] > 0 else doing.ends()
    for number, now in ((2, 132.0), (5, 138.0)):
        clock[0] = now
        doing.told("instant", number, 8)
    assert doing.text() == "instant 5 of 8, about 8 s left of them"


WORK = st.lists(st.floats(0.5, 1.5), min_size=20, max_size=20)  # seconds of each part


@given(parts=WORK, compiling=st.floats(0.0, 60.0), tiny=st.integers(0, 60), kept=st.integers(0, 8))
def test_time_left_does_not_jump_by_what_the_first_steps_cost(
    parts: list[float], compiling: float, tiny: int, kept: int
) -> None:
    """Compiling, steps that begin tiny, and parts that are kept from before; near the end the time is known."""
    pace = progress.Pace(0.0, float(len(parts)))
    elapsed, rows = compiling, []
    for k in range(tiny):
        elapsed += 0.05
        rows.append((elapsed, 1e-6 * (k + 1)))
    for k, seconds in enumerate(parts):
        elapsed += seconds if k >= kept else 0.001
        rows.append((elapsed, float(k + 1)))
    for now, done in rows:
        rate = pace.at(now, done)
        if rate:
            left = (len(parts) - done) / rate
            assert left < 1800.0, "no hours in a run of minutes"
            if done >= 16.0:
                assert left <= 3.0 * (elapsed - now) + 20.0
    assert rate > 0.0


def test_before_there_is_enough_work_no_time_is_estimated() -> None:
    pace = progress.Pace(100.0, 200.0)
    assert pace.at(0.0, 100.0) == 0.0
    assert pace.at(60.0, 102.4) == 0.0
    assert pace.at(61.0, 102.5) > 0.0


def test_a_counter_shows_what_compiles_while_no_part_is_done(capsys: pytest.CaptureFixture[str]) -> None:
    bar_moves = threading.Event()

    class Wakes(alive._Doing):
        def text(self) -> str:
            bar_moves.set()
            return "what is being done"

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(alive, "_Doing", Wakes)
        with progress.counted("mine", "runs", 3) as show:
            show(1, "mine, second")
            bar_moves.clear()
            assert bar_moves.wait(10.0)
            progress.say("a finished part")
    out, err = capsys.readouterr()
    assert out == "a finished part\n"
    assert "mine, second  33 %|" in err
    assert "1/3 runs [" in err
    assert "what is being done" in err
