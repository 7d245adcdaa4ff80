"""Every figure of Azam's thesis (University of Leeds 2018, chapters 5 to 7), compared by its numbers.

    python -m benchmarks.thesis.validation                 run what is not yet in results/thesis/validation, then write the page
    python -m benchmarks.thesis.validation --list          the cases and which of them are there
    python -m benchmarks.thesis.validation --report        only the page
    python -m benchmarks.thesis.validation --column ours   only that column's runs, then the page
    python -m benchmarks.thesis.validation --case 'A_*' --column ours --again --jobs 2

Writes docs/measured/thesis.md and its pictures. Results are found again by a fingerprint of the whole scene and of
the test time, as long as nothing has changed that the page depends on; with --earlier, those of other sources too, if the scene
is the same in every field that both know (the page lists them). A run that is killed loses the cases at work, no more. --hours and --points try the way quickly; they report to its trial.
"""

import argparse
import os
import sys
from concurrent.futures import ProcessPoolExecutor, as_completed
from fnmatch import fnmatchcase
from multiprocessing import get_context

from benchmarks.claims import kept
from benchmarks.pages import folder as pictures_of
from benchmarks.pages import save
from benchmarks.thesis.cases import CASES, NUMERICS, SECTION, Book, Case, Trial, run
from benchmarks.thesis.page import page
from benchmarks.thesis.plots import draw
from contact_core import ContactError

THREADS = ("OMP_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS")
Job = tuple[Case, str]


def jobs_of(patterns: list[str], columns: list[str]) -> list[Job]:
    """The asked cases in the asked columns."""
    for pattern in patterns:
        if not any(fnmatchcase(name, pattern) for name in CASES):
            raise SystemExit(f"--case {pattern}: no such case. There are {', '.join(CASES)}.")
    asked = [case for case in CASES.values() if any(fnmatchcase(case.name, pattern) for pattern in patterns)]
    return [(case, kind) for case in asked for kind in columns if kind in case.numerics]


def run_all(todo: list[Job], trial: Trial, workers: int) -> int:
    """Run the jobs, each in one thread. Returns how many failed."""
    os.environ.update(dict.fromkeys(THREADS, "1"))  # read by the libraries in the processes to come
    failed = 0
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        asked = {pool.submit(run, case.name, kind, trial): f"{case.name}, {kind}" for case, kind in todo}
        for k, done in enumerate(as_completed(asked), 1):
            try:
                said = done.result()
            except ContactError as error:
                said, failed = f"cannot be run: {error}", failed + 1
            print(f"{k}/{len(todo)} {asked[done]}: {said}", flush=True)
    return failed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--case", action="append", help="name or pattern; may be given again (all)")
    parser.add_argument("--column", choices=tuple(NUMERICS), action="append", help="may be given again (all)")
    parser.add_argument("--earlier", action="store_true", help="take missing runs from results of other sources")
    parser.add_argument("--hours", type=float, default=Trial.hours, help="test time (%(default)g)")
    parser.add_argument("--points", type=int, default=0, help="nodes along a side, with roughness to match")
    parser.add_argument("--jobs", type=int, default=1, help="processes (%(default)d)")
    parser.add_argument("--again", action="store_true", help="also run what is there")
    parser.add_argument("--report", action="store_true", help="run nothing")
    parser.add_argument("--list", action="store_true", help="say what there is")
    args = parser.parse_args()
    trial = Trial(args.hours, args.points)
    jobs = jobs_of(args.case or ["*"], args.column or list(NUMERICS))
    book = Book(trial, args.earlier)
    if args.list:
        for case, kind in jobs:
            print(f"{'there  ' if book.has(case.name, kind) else 'missing'} {case.name:20} {kind:7} {case.text}")
        return
    failed = 0
    if not args.report:
        todo = [(case, kind) for case, kind in jobs if args.again or not book.has(case.name, kind)]
        failed = run_all(todo, trial, args.jobs)
        book = Book(trial, args.earlier)  # with what has been run
    place = pictures_of("thesis") if trial.real else kept(SECTION) / "trial"
    place.mkdir(parents=True, exist_ok=True)
    pictures = draw(book, place)
    text = page(book, pictures)
    if trial.real and not args.earlier:
        save(SECTION, text)
    else:
        (place / "validation.md").write_text(text, "utf-8")
    print(f"{len(pictures)} plots written to {place}.")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
