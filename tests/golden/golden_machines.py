"""Every shipped machine for some seconds, through the public command; the MTM rig on a coarse grid with its checks."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from golden_command import command, put_results, settings
from golden_record import Record

LONG = {"bearing_209": 2.0, "bearing_218": 1.5, "bearing_209_start_stop": 20.0}  # s; others:
USUAL = 10.0
SHORT = """time [s],entrainment_speed [m/s],slide_roll_ratio [1]
0,1,0.5
1,0.3,0.5
2,0.1,0.5
3,0.03,0.5
4,0.1,0.05
9,0.1,0.05
"""


def runs(before: Any) -> Iterator[tuple[str, Callable[[Record], None]]]:
    """Return the names and functions of all runs."""
    names = [line.split()[0] for line in command("list").stdout.splitlines()]
    machines = [name for name in names if name.startswith(("bearing", "gear", "mtm_rig"))]
    yield "tribofmu list", lambda record: record.put("names", names)
    for name in machines:
        yield f"{name}, {LONG.get(name, USUAL):g} s", partial(_run, name)
    yield "mtm_rig, Stribeck speeds, states solved again", _checked
    yield "mtm_rig, deterministic", _deterministic


def _run(name: str, record: Record) -> None:
    long = settings(simulate={"stop_time": f"{LONG.get(name, USUAL)} s"})
    command("run", name, "--unchecked", "--out", name, *long, fine=(0, 1))
    put_results(record, Path(name))


def _checked(record: Record) -> None:
    _duty()
    done = command("run", "mtm_rig", "--duty", "short.csv", "--out", "checked", *_small(), fine=(0, 1))
    record.put("exit code", done.returncode)
    put_results(record, Path("checked"), ("result", "resolved"))


def _deterministic(record: Record) -> None:
    _duty()
    words = ("run", "mtm_rig", "--duty", "short.csv", "--out", "deterministic", "--unchecked", *_small())
    command(*words, 'deterministic=["contact"]', "simulate.stop_time=0.2 s", fine=(0, 1))
    put_results(record, Path("deterministic"))


def _duty() -> None:
    Path("short.csv").write_text(SHORT, encoding="utf-8")


def _small() -> list[str]:
    rough = {f"surface_{i}.correlation_length": "32 um" for i in (1, 2)}
    return settings(contact={"film.points": "17"} | rough)
