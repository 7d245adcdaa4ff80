"""Write the measured figures of the FMU's documentation from sections: fmu_src/package/document/measured.json.

python -m benchmarks.house.fmu_figures
"""

import json
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from benchmarks import claims, sections
from benchmarks.folders import ROOT
from benchmarks.house.tables import Pages

PATH = ROOT / "fmu_src" / "package" / "document" / "measured.json"


class Figures(NamedTuple):
    """Columns and rows of a table of a section; of the cells "2.1 (0.38)" the first word, if `first`."""

    title: str
    command: str
    section: str
    under: str  # begin of the heading
    columns: Mapping[str, str]  # by the head that they get
    rows: tuple[Mapping[str, str], ...]  # cells that choose them
    first: bool = False


_RUBBED = {
    "friction": "mu", "h_c": "h_c", "W_c": "W_c", "A_c": "A_c",
    "tribofilm 1": "film 1", "tribofilm 2": "film 2", "wear 1": "wear 1", "wear 2": "wear 2",
}  # fmt: skip
_HOURS = ("azam_case_a, two hours", "mtm_zddp, two hours")
ERRORS: dict[str, tuple[Figures, ...]] = {
    "deterministic": (
        Figures("Time steps and sampling: two hours of azam_case_a on 129 nodes against ten times shorter blocks, rms over time in %, of "
                "tribofilm and wear body 1 and 2",
                "surfaces.evolution control", "surfaces/evolution", "The shipped control", {"driver": "driver", "blocks": "blocks"} | _RUBBED,
                ({},), first=True),
        Figures("mtm_zddp driven in other ways, against all blocks driven mixed",
                "surfaces.evolution driver", "surfaces/evolution", "At the same surfaces",
                {"scene": "case", "driver": "driver", "blocks": "blocks", "of them dry": "dry blocks"} | _RUBBED,
                ({"case": "mtm_zddp"},)),
        Figures("Iteration: one step of moving roughness, mtm_zddp on 129 nodes, against film.tolerance = 2e-4",
                "film.tolerance mtm_zddp", "film/tolerance", "",
                {"film.tolerance": "film.tolerance", "pressure error": "pressure error", "W_c": "W_c"},
                tuple({"film.tolerance": value} for value in ("1e-3", "3e-3", "1e-2"))),
        Figures("Grid: the first block of mtm_zddp on fresh surfaces; no error_* output includes it",
                "film.moving", "film/moving", "Against the grid",
                {"scene": "scene", "realisation": "realisation", "nodes": "nodes", "W_c": "W_c", "A_c": "A_c", "friction": "friction",
                 "h_c [nm]": "h_c [nm]"},
                tuple({"scene": "mtm_zddp", "realisation": "1", "nodes": nodes} for nodes in ("65", "129", "257"))),
    ),
    "regression": (
        Figures("Against the deterministic level at random points that nothing was fitted to, on new and on rubbed surfaces: deviation, median "
                "and 90 %; share of them that error_friction and error_film cover",
                "regression.held_back page", "regression/held_back", "All",
                {"scene": "scene", "points": "points", "friction, median": "mu median", "friction, 90 %": "mu 90 %",
                 "error_friction, median": "mu stated", "friction, covered": "mu covered", "h_c, median": "h_c median", "h_c, 90 %": "h_c 90 %",
                 "error_film, median": "h_c stated", "h_c, covered": "h_c covered", "W_c (absolute), median": "W_c median",
                 "W_c (absolute), 90 %": "W_c 90 %"},
                ({},)),
        Figures("Two hours of rubbing against the deterministic level on 257 nodes: median of the deviation in %, and the share of the minutes at "
                "which the stated error covers it",
                "speed_error", "speed_error", "Two hours",
                {name: name for name in ("case", "friction", "h_c", "W_c", "tribofilm 1", "tribofilm 2", "wear 1", "wear 2")},
                tuple({"case": case, "setting": "regression"} for case in _HOURS)),
    ),
}  # fmt: skip
COSTS: dict[str, Figures] = {
    "deterministic": Figures(
        "CPU seconds of two hours, one thread, by the accuracy asked for (`control.accuracy`)",
        "speed_error", "speed_error", "Two hours", {"case": "case", "accuracy": "setting", "nodes": "nodes", "CPU s": "CPU [s]"},
        tuple({"case": case, "setting": setting} for setting in ("20 %", "10 %") for case in _HOURS)),
    "regression": Figures(
        "Microseconds per step with changed load, speeds and temperature, as shipped and with the costliest laws",
        "regression.cost", "regression/cost", "",
        {"scene": "scene", "laws": "laws", "median": "median [us]", "5 %": "5 % [us]", "95 %": "95 % [us]"},
        tuple({"scene": scene, "laws": laws, "inputs that change": "load, speeds, temperature"}
              for scene, laws in (("azam_case_a", "as shipped"), ("mtm_zddp", "as shipped"), ("mtm_zddp", "all of them")))),
}  # fmt: skip


def table(figures: Figures, pages: Pages) -> dict[str, Any]:
    """Return a table as the documentation shows it, with when it was measured."""
    section = sections.read(figures.section, pages.folder)
    *_, column = figures.columns.values()

    def rows() -> Iterator[list[str]]:
        for chosen in figures.rows:
            for row in pages.rows(figures.section, column, figures.under, **chosen):
                if all(row.get(name) for name in figures.columns.values()):
                    yield [row[name].split()[0] if figures.first else row[name] for name in figures.columns.values()]

    return {
        "title": figures.title,
        "command": f"python -m benchmarks.{figures.command}",
        "measured": section.measured,
        "older": bool(claims.note(section)),
        "head": list(figures.columns),
        "rows": list(rows()),
    }


def written(pages: Pages) -> str:
    """Return the file."""
    errors = {level: [table(each, pages) for each in found] for level, found in ERRORS.items()}
    costs = {level: table(each, pages) for level, each in COSTS.items()}
    return json.dumps({"errors": errors, "costs": costs}, indent=1, ensure_ascii=False) + "\n"


def write() -> None:
    """Write the file."""
    PATH.write_text(written(Pages()), encoding="utf-8")


if __name__ == "__main__":
    write()
