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
            "Against the deterministic level at random points of azam_case_a outside the fitted set, relative",
            _CHECK,
            "regression/curves.md",
            _BANDS,
            (
                ("below 0.05", "8", "0.001", "0.039", "0.027", "0.046", "0.003", "0.025"),
                ("0.05 to 0.2", "7", "0.032", "0.038", "0.020", "0.044", "0.012", "0.034"),
                ("0.2 to 1", "6", "0.108", "0.271", "0.024", "0.056", "0.043", "0.121"),
                ("above 1", "3", "0.139", "0.173", "0.059", "0.063", "0.000", "0.001"),
            ),
        ),
        Table(
            "The same for mtm_zddp",
            _CHECK,
            "regression/curves.md",
            _BANDS,
            (
                ("below 0.05", "11", "0.001", "0.014", "0.059", "0.090", "0.004", "0.010"),
                ("0.05 to 0.2", "3", "0.103", "0.274", "0.055", "0.080", "0.090", "0.225"),
                ("0.2 to 1", "4", "0.080", "0.538", "0.068", "0.134", "0.047", "0.266"),
                ("above 1", "6", "0.075", "0.127", "0.042", "0.083", "0.001", "0.006"),
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
                    "0.0932 / 0.0954",
                    "0.736 / 0.737",
                    "0.186 / 0.173",
                    "63.9 / 63.9",
                    "90.9 / 78",
                    "43.8 / 49.4",
                    "42.4 / 43.2",
                    "11.1 / 10.7",
                ),
                (
                    "azam_case_a",
                    "120",
                    "0.0854 / 0.0905",
                    "0.665 / 0.683",
                    "0.174 / 0.169",
                    "58.5 / 47.3",
                    "69.5 / 65.4",
                    "45.3 / 47",
                    "88.1 / 93.2",
                    "22.3 / 21.8",
                ),
                (
                    "mtm_zddp",
                    "20",
                    "0.104 / 0.11",
                    "0.85 / 0.878",
                    "0.186 / 0.18",
                    "79.7 / 80",
                    "73.7 / 77.6",
                    "33.6 / 36.3",
                    "19.3 / 19.1",
                    "7.27 / 7.6",
                ),
                (
                    "mtm_zddp",
                    "120",
                    "0.104 / 0.105",
                    "0.874 / 0.868",
                    "0.203 / 0.227",
                    "63.1 / 70.4",
                    "148 / 150",
                    "62.1 / 76.9",
                    "66.8 / 66.6",
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
                ("ellipse", "check", "yes", "6", "83 % of 6", "100 % of 6"),
                ("circle", "check", "yes", "4", "100 % of 4", "100 % of 4"),
                ("soft line", "check", "yes", "3", "100 % of 3", "67 % of 3"),
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
            ("azam_case_a", "0", "12"),
            ("azam_case_a", "120", "1.1e+02"),
            ("mtm_zddp", "0", "18"),
            ("mtm_zddp", "120", "1.2e+02"),
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
