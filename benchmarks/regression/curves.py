"""Load-sharing curves of the regression level: fitted points, fit, and comparison with the deterministic level.

    python -m benchmarks.regression.curves sweep                         # solve the sweep: an hour
    python -m benchmarks.regression.curves fit                           # fit the curves: the page without two hours of rubbing
    python -m benchmarks.regression.curves check [--deterministic-only]  # both levels on 24 random points of each scene, and over two hours: half an hour

Solved points stay in results/regression. `fit` and `check` write docs/measured/regression/curves.md, docs/measured/regression/curves.png and
tests/golden/load_sharing.csv.
"""

import argparse

import numpy as np

from benchmarks.folders import MEASURED, ROOT
from benchmarks.pages import save
from benchmarks.regression.check import curves_page, deterministic, hours_page, level_page
from benchmarks.regression.fit import Fit, Table, constants_page, draw, shared
from benchmarks.regression.points import (
    SCENES,
    Columns,
    dry_points,
    end_points,
    joined,
    observe_dry,
    pass_points,
    run,
    sweep_points,
)
from benchmarks.regression.shapes_points import fitted_to
from contact_core.laws.load_sharing import FittedSharing

WHOLE_PASS = {"control.mixed_instants": "128", "control.dry_instants": "8", "tribofilm.dose": "clock"}
GOLDEN = 9  # every ninth point of the sweep goes into the tests


def sweep() -> dict[str, Columns]:
    """The tables the curves are fitted to: dry contacts, first blocks, and blocks of a whole pass."""
    return {
        "dry": joined(run(f"dry_{name}", dry_points(name), {}, observe_dry) for name in SCENES),
        "sweep": joined(
            run(f"{part}_{name}", points(name), {})
            for part, points in (("sweep", sweep_points), ("ends", end_points))
            for name in SCENES
        ),
        "pass": joined(run(f"pass_{name}", pass_points(name), WHOLE_PASS) for name in SCENES),
    }


def write_golden(table: Table) -> None:
    """A few points of the sweep for the tests."""
    named = (
        "clearance",
        "layers",
        "flattening",
        "below",
        "slip",
        "pressed",
        "dense",
        "load_ratio",
        "area_ratio",
        "film_ratio",
    )
    rows = np.column_stack([getattr(table, name) for name in named])[::GOLDEN]
    file = ROOT / "tests" / "golden" / "load_sharing.csv"
    file.parent.mkdir(exist_ok=True)
    np.savetxt(file, rows, "%.5g", ",", header=",".join(named), comments="")


def write_page(*, fast: bool) -> None:
    """Fit, compare, and write what came out."""
    tables, solved = sweep(), deterministic()
    others = shared([*fitted_to(("circle", "ellipse", "light circle")), solved])
    fit = Fit(FittedSharing(), tables["sweep"], others, tables["dry"], tables["pass"])
    draw(fit).savefig(MEASURED / "regression" / "curves.png", dpi=130)
    lines = [
        "# The regression level: load-sharing curves and their errors",
        "",
        f"Written by `python -m benchmarks.regression.curves {'check' if fast else 'fit'}`.",
        "",
        *level_page(solved),
        "",
        *([*hours_page(), ""] if fast else []),
        *constants_page(fit),
        *curves_page(FittedSharing(), solved),
        "",
        "![load ratio against its curve and over lambda, mean gap and area against their curves](curves.png)",
    ]
    page = "\n".join(lines)
    save("regression/curves", page.replace("\n\n\n", "\n\n"))
    print(page)
    write_golden(fit.sweep)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", choices=("sweep", "fit", "check"))
    parser.add_argument("--deterministic-only", action="store_true", help="solve the check's points, compare nothing")
    args = parser.parse_args()
    if args.part == "sweep":
        sweep()
    elif args.deterministic_only:
        deterministic()
    else:
        write_page(fast=args.part == "check")


if __name__ == "__main__":
    main()
