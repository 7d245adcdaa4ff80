"""Measured errors and costs shown in the documentation: figures of `docs/`, written there by the benchmarks.

Every row has the numbers of one line of its page; `tests/fmu/test_content.py` compares them.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Table:
    """Measured figures: title, the command and the page of docs/measured that they come from."""

    title: str
    command: str
    page: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


_CHECK = "python -m benchmarks.regression.curves check"
_BANDS = ("Z", "points", "friction, median", "90 %", "h_c, median", "90 %", "W_c (absolute), median", "90 %")

ERRORS: dict[str, tuple[Table, ...]] = {
    "deterministic": (
        Table(
            "Time steps and sampling: two hours of azam_case_a on 129 nodes against ten times shorter blocks, rms over "
            "time in %, of tribofilm and wear body 1 and 2",
            "python -m benchmarks.surfaces.evolution control",
            "surfaces/evolution.md",
            ("driver", "friction", "h_c", "W_c", "A_c", "tribofilm 1", "tribofilm 2", "wear 1", "wear 2"),
            (
                ("auto", "2.1", "1.2", "3.3", "1.7", "1.5", "0.9", "1.4", "2.2"),
                ("mixed", "1.9", "1.0", "2.7", "1.3", "0.0", "1.1", "1.3", "1.3"),
            ),
        ),
        Table(
            "The same for mtm_zddp, where most blocks are driven dry, against all blocks driven mixed",
            "python -m benchmarks.surfaces.evolution driver",
            "surfaces/evolution.md",
            ("scene", "driver", "blocks", "of them dry", "friction", "h_c", "W_c", "A_c", "tribofilm 1", "tribofilm 2"),
            (
                ("mtm_zddp", "auto", "95", "75", "2.6", "3.2", "3.8", "4.2", "3.6", "6.4"),
                ("mtm_zddp", "dry", "96", "96", "13.2", "10.4", "16.1", "6.0", "8.2", "3.8"),
            ),
        ),
        Table(
            "Iteration: one step of moving roughness, mtm_zddp on 129 nodes, against film.tolerance = 2e-4",
            "python -m benchmarks.film.tolerance mtm_zddp",
            "film/tolerance.md",
            ("film.tolerance", "pressure error %", "W_c"),
            (("1e-3", "0.65", "0.620"), ("3e-3", "1.35", "0.621"), ("1e-2", "3.02", "0.634")),
        ),
        Table(
            "Grid: the first block of mtm_zddp on fresh surfaces; no error_* output includes it",
            "python -m benchmarks.film.grid mtm_zddp",
            "film/grid.md",
            ("nodes", "friction coefficient", "W_c", "A_c", "h_c [m]"),
            (
                ("65", "0.106", "0.817", "0.479", "4.1e-08"),
                ("129", "0.0868", "0.614", "0.296", "5.75e-08"),
                ("193", "0.0725", "0.477", "0.225", "6.02e-08"),
            ),
        ),
    ),
    "regression": (
        Table(
            "Against the deterministic level at random points of azam_case_a outside the fitted set, relative",
            _CHECK,
            "regression/curves.md",
            _BANDS,
            (
                ("below 0.05", "35", "0.036", "0.131", "0.072", "0.152", "0.042", "0.095"),
                ("0.05 to 0.2", "28", "0.079", "0.196", "0.083", "0.149", "0.058", "0.099"),
                ("0.2 to 1", "22", "0.050", "0.111", "0.026", "0.105", "0.019", "0.038"),
                ("above 1", "15", "0.137", "0.336", "0.047", "0.126", "0.011", "0.050"),
            ),
        ),
        Table(
            "The same for mtm_zddp",
            _CHECK,
            "regression/curves.md",
            _BANDS,
            (
                ("below 0.05", "45", "0.020", "0.054", "0.058", "0.094", "0.022", "0.052"),
                ("0.05 to 0.2", "16", "0.039", "0.092", "0.056", "0.120", "0.029", "0.079"),
                ("0.2 to 1", "13", "0.051", "0.080", "0.025", "0.087", "0.013", "0.044"),
                ("above 1", "26", "0.211", "0.354", "0.053", "0.094", "0.037", "0.097"),
            ),
        ),
        Table(
            "After two hours of rubbing, and where the levels differ most: deterministic / regression; lengths in nm",
            _CHECK,
            "regression/curves.md",
            ("scene", "min", "friction", "W_c", "A_c", "h_c", "tribofilm 1", "tribofilm 2", "wear 1", "wear 2"),
            (
                (
                    "azam_case_a",
                    "120",
                    "0.0604 / 0.0761",
                    "0.391 / 0.513",
                    "0.306 / 0.264",
                    "73.8 / 58.4",
                    "64.4 / 64.3",
                    "27.1 / 28.2",
                    "71.4 / 74.3",
                    "18.4 / 19",
                ),
                (
                    "azam_case_a",
                    "20",
                    "0.0977 / 0.0866",
                    "0.811 / 0.641",
                    "0.411 / 0.267",
                    "91.2 / 81.9",
                    "110 / 109",
                    "45.1 / 47.8",
                    "13.6 / 11.5",
                    "3.49 / 2.94",
                ),
                (
                    "mtm_zddp",
                    "20",
                    "0.107 / 0.1",
                    "0.887 / 0.789",
                    "0.423 / 0.276",
                    "97.8 / 92.9",
                    "122 / 133",
                    "58.5 / 61.3",
                    "14.9 / 13.7",
                    "6.05 / 5.69",
                ),
                (
                    "mtm_zddp",
                    "120",
                    "0.106 / 0.0985",
                    "0.891 / 0.782",
                    "0.461 / 0.279",
                    "81.9 / 89.6",
                    "150 / 149",
                    "65.6 / 69.7",
                    "57.8 / 50.8",
                    "23.7 / 21.1",
                ),
            ),
        ),
        Table(
            "Share of points outside all fits at which error_friction and error_film cover the deviation; solved well: "
            "the deterministic level converged and its grid resolves the inlet",
            "python -m benchmarks.regression.shapes page",
            "regression/shapes.md",
            ("shape", "seed", "solved well", "points", "error_friction", "error_film"),
            (
                ("line", "check", "yes", "34", "97 % of 34", "97 % of 34"),
                ("line", "check", "no", "6", "100 % of 6", "100 % of 6"),
                ("ellipse", "check", "yes", "27", "100 % of 27", "100 % of 27"),
                ("ellipse", "check", "no", "13", "92 % of 13", "85 % of 13"),
                ("circle", "check", "yes", "36", "97 % of 36", "94 % of 36"),
                ("circle", "check", "no", "4", "75 % of 4", "100 % of 4"),
                ("soft line", "check", "yes", "9", "89 % of 9", "89 % of 9"),
                ("soft line", "check", "no", "1", "100 % of 1", "0 % of 1"),
            ),
        ),
    ),
}

COSTS: dict[str, Table] = {
    "deterministic": Table(
        "CPU seconds on 129 nodes, one thread: at 0 min for the first solution, at 120 min for the whole run",
        _CHECK,
        "regression/curves.md",
        ("scene", "min", "CPU s"),
        (
            ("azam_case_a", "0", "3.7"),
            ("azam_case_a", "120", "41"),
            ("mtm_zddp", "0", "3.1"),
            ("mtm_zddp", "120", "33"),
        ),
    ),
    "regression": Table(
        "Microseconds per step with changed load, speeds and temperature, as shipped and with the costliest laws",
        "python -m benchmarks.regression.cost",
        "regression/cost.md",
        ("scene", "laws", "median", "5 %", "95 %"),
        (
            ("azam_case_a", "as shipped", "132.8", "124.0", "418.2"),
            ("mtm_zddp", "as shipped", "129.0", "123.7", "286.6"),
            ("mtm_zddp", "all of them", "683.7", "491.1", "10421.4"),
        ),
    ),
}
