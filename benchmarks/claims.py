"""What is claimed of this code, the command that measures it, and a short run that says whether the code is still the same.

    python -m benchmarks.claims                      every claim, and the state of its numbers
    python -m benchmarks.claims --check [NAME ...]   run sentinels and compare; pages then say what has moved
    python -m benchmarks.claims --keep NAME ...      take the sentinels' numbers as those of the section that is there

A sentinel (`benchmarks/sentinels.py`) gives a few numbers in seconds. benchmarks/sentinels.json keeps those of the time at which
the long benchmark ran, and a benchmark that writes its section keeps them anew. When they move, the section says at its head
that its numbers are of older code.
"""

import argparse
import contextlib
import fcntl
import functools
import json
import math
import sys
import time
from collections.abc import Iterable, Iterator, Mapping
from datetime import date
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks import sections, sentinels
from benchmarks.folders import RESULTS, ROOT
from benchmarks.sections import Section
from benchmarks.sentinels import Numbers, Sentinel

PATH = ROOT / "benchmarks" / "sentinels.json"
SOLVED = 5e-3  # relative: solvers on other processors end at other iterates within their tolerance
SMALL = 1e-12  # relative to the largest number of a sentinel: differences of rounding about zero


class Claim(NamedTuple):
    """A claim, the section of docs/measured that backs it, and what tells whether that is of today's code."""

    section: str
    says: str  # with its bound; the values are in the section
    commands: tuple[str, ...]  # behind python -m benchmarks.
    minutes: float  # that they take on one core
    sentinel: Sentinel
    relative: float = 1e-3  # change of a number that counts

    @property
    def name(self) -> str:
        """The claim's name: that of its section."""
        return self.section


_CONTACTS = "of contacts of the shipped scenes"
CLAIMS = {
    claim.section: claim
    for claim in (
        # one contact at one instant
        Claim("film/error_estimate", "The error that one call estimates covers the true one at nine of ten random points.",
              ("film.error_estimate",), 30, sentinels.single_call, SOLVED),
        Claim("film/flux", "Smooth films of circles are within 1 % on 129 nodes up to M = 1000; ellipses and lines miss more, as said.",
              ("film.flux",), 5, sentinels.smooth_films),
        Claim("film/grid_error", f"Stated errors by the grid cover 90 to 99 % {_CONTACTS}.",
              ("film.grid_error",), 60, sentinels.grid_errors, SOLVED),
        Claim("film/hard_cases", "Random and listed extreme contacts converge, or say that they have not; other code agrees.",
              ("film.hard_cases random --to 444", "film.hard_cases random --shape ellipse --to 60",
               "film.hard_cases random --shape line --to 300", "film.hard_cases rows", "film.hard_cases report"),
              90, sentinels.random_points, SOLVED),
        Claim("film/inlet", "What a domain takes from the film by its upstream edge is within what is stated.",
              ("film.inlet",), 10, sentinels.short_inlet, SOLVED),
        Claim("film/measured", "Films have the measured slope over the speed, and a dimple's profiles are within 8 %.",
              ("film.measured",), 1, sentinels.optical_films),
        Claim("film/moving", "First blocks on 65 nodes are within 5 % of 257, on 129 within 2 %: not met, by how much is said.",
              ("film.moving",), 30, sentinels.first_blocks, SOLVED),
        Claim("film/peers", "Dry rough contacts are those of other open solvers, and take a part of their time.",
              ("film.peers",), 5, sentinels.dry_ball),
        Claim("film/time_step", "A first block is within 2 % (film 3 %) of that by an eighth of the time step; over hard floors it is not.",
              ("film.time_step",), 10, sentinels.shorter_steps, SOLVED),
        Claim("film/tolerance", "At the shipped tolerance the pressure of a step of a march is within 2 %.",
              ("film.tolerance",), 2, sentinels.march_of_steps, SOLVED),
        Claim("film/two_hours", "Stated errors of two hours of rubbing cover what a finer grid changes at 93 % of the times.",
              ("film.two_hours",), 40, sentinels.minutes_driven_mixed, SOLVED),
        Claim("speed_error", "What levels and accuracies cost, how far off they are, and how often stated errors cover that; 90 % of contacts, 95 % of times asked.",
              ("film.grid_error", "speed_error"), 60, sentinels.accuracy_asked_for, SOLVED),
        # surfaces over hours
        Claim("surfaces/evolution", "Friction, film, tribofilms and wear of two hours are within 5 % rms of runs ten times finer in time.",
              ("surfaces.evolution",), 30, sentinels.minutes_of_rubbing, SOLVED),
        Claim("surfaces/asperity_load_share", "The solids' share of the load over lambda is beside published fits.",
              ("surfaces.asperity_load_share",), 5, sentinels.load_share, SOLVED),
        Claim("surfaces/finishes", "The shipped finishes have the spectra of two measured traces.",
              ("surfaces.finishes",), 1, sentinels.traces),
        Claim("thesis/validation", "Claims of the thesis about its cases agree, or a cause is shown.",
              ("thesis.validation",), 60, sentinels.minutes_of_the_thesis, SOLVED),
        # the regression level
        Claim("regression/held_back", "At points that nothing was fitted to, stated errors of the regression level cover 90 to 99 %.",
              ("regression.held_back solve", "regression.held_back page"), 60, sentinels.regression_points),
        Claim("regression/cost", "A step of the regression level takes a fraction of a millisecond.",
              ("regression.cost",), 1, sentinels.regression_steps),
        Claim("friction/published_traction", "Friction of full films is within 20 % of published traction: met for most.",
              ("friction.published_traction",), 5, sentinels.discs),
        # stress
        Claim("stress/field", "Stress below 65 nodes of a contact is within 1 % from a depth of one spacing on.",
              ("stress.field",), 1, sentinels.below_a_circle),
        Claim("stress/micropitting", "Micropitting has the published trends with lay, sliding and wear; its level is not predicted.",
              ("stress.micropitting",), 60, sentinels.pitted_roller, SOLVED),
        # machines
        Claim("machines/bearing_torque", "The torque of ball bearings is within a factor of two of SKF's, 1000 to 3000 rpm.",
              ("machines.bearing_torque",), 3, sentinels.bearing_torques),
        Claim("machines/bearing_life", "Rating lives are within 1 % of published ones.",
              ("machines.bearing_life",), 5, sentinels.bearing_lives),
        Claim("machines/gear_friction", "Mean friction of gears beside Schlenk's and ISO's, and states solved again within stated errors.",
              ("machines.gear_friction",), 10, sentinels.gear_friction),
        Claim("machines/gear_ratings", "Ratings of gears return the classes of oils that tests are defined by, with flanks that stay new.",
              ("machines.gear_ratings",), 5, sentinels.gear_safety),
        Claim("machines/rolling", "Rolling resistance of both levels agrees within the stated error; bearings beside measured torques.",
              ("machines.rolling",), 5, sentinels.rolling_bodies),
        Claim("machines/tolerance", "The stated error of a machine's coupling covers what far shorter steps change, but for few outputs.",
              ("machines.tolerance",), 30, sentinels.coupled_machine),
        # co-simulation and FMUs
        Claim("coupling/accuracy", "The master has the orders of its schemes, and keeps to a tolerance.",
              ("coupling.accuracy",), 5, sentinels.two_masses),
        Claim("coupling/ssp_importers", "Exported machines run in other importers with the master's results, but for fmpy's first step.",
              ("coupling.ssp_importers",), 10, sentinels.exported_machine),
        Claim("fmu/overhead", "An FMU's step costs tens of microseconds more than the model's own time.",
              ("fmu.overhead",), 3, sentinels.direct_steps),
        Claim("fmu/native", "A step of a native FMU takes about a microsecond.",
              ("fmu.native",), 10, sentinels.native_steps),
        # tests and code
        Claim("house/faults", "Every fault that is listed is noticed by its tests.",
              ("house.faults",), 240, sentinels.listed_faults, 0.0),
        Claim("house/stays", "Scene, state and operating point travel through few functions.",
              ("house.stays",), 1, sentinels.stays, 0.0),
    )
}  # fmt: skip


class State(NamedTuple):
    """What is kept of a sentinel."""

    numbers: Numbers  # of the code that the section was measured with, or if that is not known of the first known after
    kept: str  # date of these numbers
    measured: bool  # whether they are of the code that the section was measured with
    moved: Numbers  # the numbers that differ, as they were when last seen; none if all agree

    @property
    def current(self) -> bool:
        """Whether the section is of today's code, as far as is known."""
        return self.measured and not self.moved


def states() -> dict[str, State]:
    """What is kept of each sentinel."""
    return {name: State(**kept) for name, kept in json.loads(PATH.read_text(encoding="utf-8")).items()}


def store(found: Mapping[str, State]) -> None:
    """Keep the states in the order of the claims."""
    ordered = {name: found[name]._asdict() for name in CLAIMS if name in found}
    PATH.write_text(json.dumps(ordered, indent=1) + "\n", encoding="utf-8")


def moved(claim: Claim, then: Numbers, now: Numbers) -> list[str]:
    """Names of the numbers of a sentinel that differ by more than rounding and other processors explain."""
    scale = SMALL * max(map(abs, then.values()), default=0.0)
    return [
        name
        for name in sorted({*then, *now})
        if not (name in then and name in now)
        or not math.isclose(then[name], now[name], rel_tol=claim.relative, abs_tol=scale)
    ]


def checked(claim: Claim, state: State) -> State:
    """Run a sentinel and return the state with what has moved."""
    now = claim.sentinel()
    return state._replace(moved={name: now.get(name, math.nan) for name in moved(claim, state.numbers, now)})


def note(section: Section) -> str:
    """What stands at the head of a section whose numbers are of older code; nothing if they are of today's."""
    return said(section, states().get(section.name))


def said(section: Section, state: State | None) -> str:
    """The note of a section by the state of its sentinel."""
    why = []
    if state is None or not state.measured:
        why.append(f"not measured since {section.measured}")
    if state is not None and state.moved:
        name, now = next(iter(state.moved.items()))
        then = state.numbers.get(name, math.nan)
        more = f", and {len(state.moved) - 1} more" if len(state.moved) > 1 else ""
        why.append(f"its sentinel has moved, {name} was {then:.4g}, is {now:.4g}{more}")
    return f"The numbers of this section are of older code: {'; '.join(why)}." if why else ""


def keep(names: Iterable[str]) -> None:
    """Keep the numbers of sentinels as those of the code that their sections were measured with."""
    today, new = date.today().isoformat(), {name: CLAIMS[name].sentinel() for name in names}
    with _alone():
        store(states() | {name: State(numbers, today, True, {}) for name, numbers in new.items()})
        refresh()


def check(names: Iterable[str]) -> dict[str, State]:
    """Run sentinels; keep what has moved, and let pages say so. Return the states."""
    found = {name: checked(CLAIMS[name], states()[name]) for name in names}
    with _alone():
        store(states() | found)
        refresh()
    return found


@contextlib.contextmanager
def _alone() -> Iterator[None]:
    """Let no other process write the kept numbers and the pages meanwhile."""
    RESULTS.mkdir(exist_ok=True)
    with (RESULTS / "claims.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def refresh() -> None:
    """Write the pages that say what is of older code: of all rooms, docs/trust.md, an FMU's, and all that link to sections."""
    from benchmarks.house import fmu_figures, trust  # need this module

    sections.render(note)
    trust.write()
    fmu_figures.write()
    for page in sections.citing():
        page.write_text(sections.marked(page.read_text(encoding="utf-8"), note), encoding="utf-8")


@functools.cache
def kept(section: str) -> Path:
    """Folder for the runs of a benchmark that takes hours: one in which its sentinel had today's numbers, or a new one."""
    claim, now = CLAIMS[section], CLAIMS[section].sentinel()
    folders = sorted((RESULTS / section).glob("*/sentinel.json"))
    for file in reversed(folders):
        if not moved(claim, json.loads(file.read_text(encoding="utf-8")), now):
            return file.parent
    folder = RESULTS / section / str(len(folders) + 1)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "sentinel.json").write_text(json.dumps(now), encoding="utf-8")
    return folder


def line(claim: Claim, state: State | None) -> str:
    """A line of the list."""
    why = said(sections.read(claim.section), state).partition(": ")[2] or "of today's code"
    return f"{claim.name:28} {why}\n    {claim.says}\n    python -m benchmarks.{', '.join(claim.commands)}"


def main(argv: list[str] | None = None) -> int:
    """List, check or keep."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--check", action="store_true", help="run the sentinels")
    how.add_argument("--keep", action="store_true", help="keep their numbers")
    parser.add_argument("names", nargs="*", metavar="NAME", help="of claims")
    asked: Any = parser.parse_args(argv)
    if unknown := sorted({*asked.names} - {*CLAIMS}):
        parser.error(f"{', '.join(unknown)}: no such claim. There are {', '.join(CLAIMS)}.")
    if asked.keep:
        if not asked.names:
            parser.error("--keep needs names: a benchmark that is run keeps its own.")
        keep(asked.names)
        return 0
    if not asked.check:
        known = states()
        print(*(line(CLAIMS[name], known.get(name)) for name in asked.names or CLAIMS), sep="\n")
        return 0
    wrong = 0
    for name in asked.names or CLAIMS:
        start = time.perf_counter()
        state = check([name])[name]
        wrong += bool(state.moved)
        said_of = f"moved: {', '.join(state.moved)}" if state.moved else "as it was"
        print(f"{name:28} {time.perf_counter() - start:5.1f} s  {said_of}", flush=True)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
