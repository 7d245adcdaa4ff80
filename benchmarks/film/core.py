"""Accuracy, robustness and cost of the deterministic core. One part per call, each a few minutes on one thread.

    OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1 python -m benchmarks.film.core smooth|cost|accuracy|lambda|starts|summary

Each writes docs/measured/film/core_<part>.md, most a picture beside it, and renews docs/measured/film/core.md, which collects what was asked and
found.
"""

import argparse
import importlib
import time

from benchmarks.folders import MEASURED

DOCS = MEASURED / "film"
PARTS = {
    "smooth": "Grid convergence of smooth films, the formula, the rigid limit, a hardness below the pressure",
    "cost": "Work units and milliseconds of cold and warm solutions",
    "accuracy": "Error against cost from full film to boundary lubrication",
    "lambda": "Contact over lambda ratio, grid, floor and criterion",
    "starts": "Independence of the start, and the dry limit",
}


def summarise() -> None:
    """Collect what the parts were asked and found."""
    lines = ["# The core in figures", "", "Written by `python -m benchmarks.film.core`; parts not run yet are missing.", ""]
    for part, text in PARTS.items():
        page = DOCS / f"core_{part}.md"
        if page.exists():
            asked = page.read_text().split("## Asked")[1].split("## Found")[0].strip()
            lines += [f"## [{text}](core_{part}.md)", "", asked, ""]
            lines += [f"![{text}](core_{part}.png)", ""] if (DOCS / f"core_{part}.png").exists() else []
    (DOCS / "core.md").write_text("\n".join(lines).rstrip() + "\n")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", choices=(*PARTS, "summary"))
    part = parser.parse_args().part
    if part != "summary":
        start = time.perf_counter()
        importlib.import_module(f"benchmarks.film.core_{part}").run()
        print(f"{part}: {time.perf_counter() - start:.0f} s")
    summarise()


if __name__ == "__main__":
    main()
