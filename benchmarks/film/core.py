"""Accuracy, robustness and cost of the deterministic core. One part per call, each a few minutes on one thread.

    OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1 python -m benchmarks.film.core smooth|cost|accuracy|lambda|starts

smooth    Grid convergence of smooth films, the formula, the rigid limit, a hardness below the pressure
cost      Work units and milliseconds of cold and warm solutions
accuracy  Error against cost from full film to boundary lubrication
lambda    Contact over lambda ratio, grid, floor and criterion
starts    Independence of the start, and the dry limit

Each writes docs/measured/film/core_<part>.md, most a picture beside it.
"""

import argparse
import importlib
import time

PARTS = ("smooth", "cost", "accuracy", "lambda", "starts")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", choices=PARTS)
    part = parser.parse_args().part
    start = time.perf_counter()
    importlib.import_module(f"benchmarks.film.core_{part}").run()
    print(f"{part}: {time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
