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
            (("1e-3", "0.38", "0.849"), ("3e-3", "0.65", "0.845"), ("1e-2", "1.27", "0.832")),
        ),
        Table(
            "Grid: the first block of mtm_zddp on fresh surfaces; no error_* output includes it",
            "python -m benchmarks.film.moving",
            "film/moving.md",
            ("scene", "realisation", "nodes", "W_c", "A_c", "friction", "h_c"),
            (
                ("mtm_zddp", "1", "65", "0.8329", "0.1876", "0.1083", "46.63"),
                ("mtm_zddp", "1", "129", "0.8357", "0.1809", "0.1087", "52.33"),
                ("mtm_zddp", "1", "257", "0.8022", "0.1734", "0.1043", "54.12"),
            ),
        ),
    ),
    "regression": (
        Table(
            "Against the deterministic level at random points of azam_case_a, which the fit knows, relative",
            _CHECK,
            "regression/curves.md",
            _BANDS,
            (
                ("below 0.05", "8", "0.009", "0.045", "0.026", "0.047", "0.006", "0.031"),
                ("0.05 to 0.2", "7", "0.037", "0.087", "0.036", "0.071", "0.029", "0.084"),
                ("0.2 to 1", "6", "0.065", "0.092", "0.019", "0.077", "0.031", "0.042"),
                ("above 1", "3", "0.032", "0.064", "0.055", "0.062", "0.000", "0.001"),
            ),
        ),
        Table(
            "The same for mtm_zddp",
            _CHECK,
            "regression/curves.md",
            _BANDS,
            (
                ("below 0.05", "11", "0.005", "0.037", "0.029", "0.060", "0.005", "0.046"),
                ("0.05 to 0.2", "3", "0.056", "0.110", "0.014", "0.020", "0.050", "0.099"),
                ("0.2 to 1", "4", "0.034", "0.174", "0.032", "0.077", "0.014", "0.100"),
                ("above 1", "6", "0.011", "0.048", "0.033", "0.057", "0.000", "0.009"),
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
                    "60",
                    "0.0932 / 0.0971",
                    "0.736 / 0.751",
                    "0.186 / 0.171",
                    "63.9 / 59.3",
                    "90.9 / 78.1",
                    "43.8 / 49.1",
                    "42.4 / 42.8",
                    "11.1 / 10.6",
                ),
                (
                    "azam_case_a",
                    "120",
                    "0.0854 / 0.0973",
                    "0.665 / 0.746",
                    "0.174 / 0.172",
                    "58.5 / 57",
                    "69.5 / 65.4",
                    "45.3 / 47",
                    "88.1 / 94.9",
                    "22.3 / 22.2",
                ),
                (
                    "mtm_zddp",
                    "20",
                    "0.104 / 0.109",
                    "0.85 / 0.867",
                    "0.186 / 0.174",
                    "79.7 / 66.3",
                    "73.7 / 76.9",
                    "33.6 / 36.1",
                    "19.3 / 19.2",
                    "7.27 / 7.63",
                ),
                (
                    "mtm_zddp",
                    "120",
                    "0.104 / 0.106",
                    "0.874 / 0.873",
                    "0.203 / 0.228",
                    "63.1 / 71.9",
                    "148 / 150",
                    "62.1 / 76.7",
                    "66.8 / 66.8",
                    "25.8 / 27.7",
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
                ("line", "check", "yes", "8", "88 % of 8", "100 % of 8"),
                ("ellipse", "check", "yes", "6", "83 % of 6", "83 % of 6"),
                ("circle", "check", "yes", "4", "100 % of 4", "50 % of 4"),
                ("soft line", "check", "yes", "3", "67 % of 3", "100 % of 3"),
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
            ("azam_case_a", "0", "9"),
            ("azam_case_a", "120", "67"),
            ("mtm_zddp", "0", "13"),
            ("mtm_zddp", "120", "83"),
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
