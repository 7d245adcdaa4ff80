"""Measure everything anew: every benchmark that backs a claim, in a fixed order, each on one thread.

    python -m benchmarks.anew                    what is not of today's code
    python -m benchmarks.anew --list             in which order, and how long each takes
    python -m benchmarks.anew --only film thesis/validation --hours 2 --jobs 2

A room or names after `--only` leave the others out. What was measured with today's code is passed over, as its sentinel says
(`benchmarks/claims.py`), also what was cut off in between and had written its section; long benchmarks go on from the runs
that they keep in results/. After `--hours` no other one begins. What each prints is in results/anew, and how long it took.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

from benchmarks import claims
from benchmarks.claims import CLAIMS, Claim
from benchmarks.folders import RESULTS, ROOT

LOGS = RESULTS / "anew"
HOUR = 3600.0
ONE = ("OMP_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS")


def asked(only: list[str]) -> list[Claim]:
    """The claims of rooms or names, shortest first, so that most is known early; all without names."""
    unknown = [name for name in only if not any(name in (key, key.partition("/")[0]) for key in CLAIMS)]
    if unknown:
        raise SystemExit(f"{', '.join(unknown)}: no such room or claim. There are {', '.join(CLAIMS)}.")
    kept = (claim for key, claim in CLAIMS.items() if not only or key in only or key.partition("/")[0] in only)
    return sorted(kept, key=lambda claim: claim.minutes)


def current(claim: Claim) -> bool:
    """Whether the section is of today's code: measured with it, and its sentinel gives the same numbers now."""
    state = claims.states().get(claim.name)
    return state is not None and state.current and not claims.checked(claim, state).moved


def measured(claim: Claim) -> bool:
    """Run the commands of a claim; return whether all went well. What they print is kept."""
    file = LOGS / f"{claim.name.replace('/', '.')}.txt"
    file.parent.mkdir(parents=True, exist_ok=True)
    environment = os.environ | dict.fromkeys(ONE, "1")
    with file.open("w", encoding="utf-8") as log:
        for command in claim.commands:
            words = [sys.executable, "-m", *f"benchmarks.{command}".split()]
            if subprocess.run(words, cwd=ROOT, env=environment, stdout=log, stderr=subprocess.STDOUT).returncode:
                return False
    return True


def times() -> dict[str, float]:
    """Minutes that each took when it was last measured here."""
    file = LOGS / "minutes.json"
    found: dict[str, float] = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    return found


def expected(claim: Claim) -> float:
    """Minutes that a claim will take."""
    return times().get(claim.name, claim.minutes)


def run(todo: list[Claim], hours: float, jobs: int) -> Iterator[str]:
    """Measure; yield a line for each claim."""
    start = time.monotonic()

    def one(claim: Claim) -> str:
        if time.monotonic() - start > hours * HOUR:
            return f"{claim.name:28} left for another time"
        begin, said = time.monotonic(), expected(claim)
        ended = measured(claim)
        took = (time.monotonic() - begin) / 60.0
        if ended:
            (LOGS / "minutes.json").write_text(json.dumps(times() | {claim.name: round(took, 2)}), encoding="utf-8")
        return f"{claim.name:28} {'measured' if ended else 'FAILED'} in {took:.1f} min, {said:.3g} expected"

    left = []
    for claim in todo:
        if current(claim):
            yield f"{claim.name:28} of today's code"
        else:
            left.append(claim)
    with ThreadPoolExecutor(jobs) as pool:  # each waits for a process
        yield from pool.map(one, left)


def main() -> int:
    """Measure or list."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", default=[], metavar="ROOM|NAME")
    parser.add_argument("--hours", type=float, default=1e9, help="after which no other benchmark begins")
    parser.add_argument("--jobs", type=int, default=1, help="at a time (%(default)d)")
    parser.add_argument("--list", action="store_true", help="run nothing")
    given = parser.parse_args()
    todo = asked(given.only)
    if given.list:
        for claim in todo:
            print(f"{expected(claim):6.3g} min  {claim.name:28} python -m benchmarks.{', '.join(claim.commands)}")
        print(f"{sum(map(expected, todo)) / 60.0:.1f} h in all, expected, on one core")
        return 0
    failed = 0
    for line in run(todo, given.hours, given.jobs):
        failed += "FAILED" in line
        print(line, flush=True)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
