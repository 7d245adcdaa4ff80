"""Films against measurements: central films from 5 mm/s to 4 m/s, and a dimple that crosses a contact.

    python -m benchmarks.film.measured

Writes docs/measured/film/measured.md and docs/measured/film/measured.png in about a minute. The data are in benchmarks/data.
"""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from benchmarks.pages import Page
from contact_core import Scene, initial_state, march, point_contact
from contact_core.deterministic.transient import rolled
from contact_core.laws.viscosity import AstmD341

DATA = Path(__file__).parents[1] / "data"
BALL, MODULUS = 9.525e-3, 2.0 / ((1.0 - 0.3**2) / 207e9 + (1.0 - 0.22**2) / 75e9)  # m; Pa, steel on glass
DENSITY = 885.0  # kg/m3 at 15 degC, assumed
COEFFICIENTS = (18e-9, 22e-9, 26e-9)  # 1/Pa: the oil's own is not given
SLOW = 1.0  # m/s, below which the oil of the inlet stays cool
GRIDS = (65, 129, 257)
DIMPLE = {2: -87e-6, 3: -49e-6, 4: 24e-6, 5: 113e-6}  # m: middle of the dimple in each profile; not in the first one
BESIDE = 37e-6  # m from that middle: twice the radius of the dimple
A = 136.7e-6  # m, half width of Hertz's contact of the scene


def read(name: str) -> list[dict[str, float]]:
    """Return the rows of a table of measurements."""
    with (DATA / name).open() as lines:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(lines)]


@dataclass(frozen=True)
class Comparison:
    """Found over measured films, by speed."""

    speed: np.ndarray
    measured: np.ndarray
    found: np.ndarray

    def slopes(self) -> tuple[float, float]:
        """Return the exponents of speed, measured and found."""
        first, second = (float(np.polyfit(np.log(self.speed), np.log(h), 1)[0]) for h in (self.measured, self.found))
        return first, second

    def factor(self) -> tuple[float, float, float]:
        """Return the mean ratio of found to measured films, the scatter about it and the least ratio."""
        ratio = np.log(self.found / self.measured)
        return float(np.exp(ratio.mean())), float(ratio.std()), float(np.exp(ratio.min()))

    def below(self, most: float) -> "Comparison":
        """Return the part at lower speeds."""
        slow = self.speed < most
        return Comparison(self.speed[slow], self.measured[slow], self.found[slow])


def films(coefficient: float, grid: int = 129) -> Comparison:
    """Return the central films of all measured points."""
    oil = AstmD341(67.0e-6, 18.9e-6, DENSITY, coefficient, 304.65)
    rows, found = read("optical_films.csv"), []
    for row in rows:
        viscosity = float(oil(0.0, row["oil_temperature_degC"] + 273.15))
        speed = row["entrainment_speed_mm_s"] * 1e-3
        answer = point_contact(
            load=row["load_N"], radius_x=BALL, reduced_modulus=MODULUS, speed_1=speed, speed_2=speed,
            viscosity=viscosity, pressure_viscosity=coefficient, grid=grid, flux="fitted",
        )  # fmt: skip
        assert answer.converged, answer.shortfall
        found.append(answer.h_central)
    speed, measured = (np.array([row[key] for row in rows]) for key in ("entrainment_speed_mm_s", "film_nm"))
    return Comparison(speed * 1e-3, measured * 1e-9, np.array(found))


def rolling(points: int) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """Return x and gap [m] along the centre line, by profile, when the dimple is nearest to where it was measured."""
    scene = Scene.from_toml("dimple_rolling", {"film.points": str(points)})
    domain, op = scene.film.domain, scene.operation.point
    first = -0.45 * domain  # the dimple lies in the middle of its patch
    begin = rolled(scene, initial_state(scene), (0.0, first))
    times = np.arange(0.0, (0.9 * domain) / op.speed_2, scene.film.spacing / op.speed_2)
    best: dict[int, tuple[float, np.ndarray, np.ndarray]] = {}
    for moment in march(scene, begin, lambda _: op, times):
        where = first + op.speed_2 * moment.time
        for profile, middle in ({1: first} | DIMPLE).items():
            off = abs(where - middle)
            if profile not in best or off < best[profile][0]:
                gap = moment.fields.gap
                best[profile] = off, moment.fields.x + middle - where, gap[gap.shape[0] // 2].copy()
    return {profile: (x, gap) for profile, (_, x, gap) in best.items()}


def errors(found: dict[int, tuple[np.ndarray, np.ndarray]]) -> dict[int, float]:
    """Return the rms error of each profile over Hertz's contact, beside the dimple, relative to the measured film."""
    off = {}
    for profile, (x, gap) in found.items():
        rows = [row for row in read("dimple_rolling.csv") if row["profile"] == profile]
        at, measured = (np.array([row[key] for row in rows]) for key in ("x_um", "gap_nm"))
        at, measured = at * 1e-6, measured * 1e-9
        chosen = (np.abs(at) < A) & (np.abs(at - DIMPLE.get(profile, 1.0)) > BESIDE)
        ratio = np.interp(at[chosen], x, gap) / measured[chosen]
        off[profile] = float(np.sqrt(((ratio - 1.0) ** 2).mean()))
    return off


def optical(page: Page, axes) -> None:  # type: ignore[no-untyped-def]
    """Add the central films."""
    page.say(
        "### 21 central films, 5 mm/s to 4 m/s\n\nSteel ball on glass, 50 N, pure rolling, mineral oil, by optical interferometry. "
        "`point_contact` with flux fitted, else its defaults; viscosity by ASTM D341 at the measured temperature, "
        f"density {DENSITY:g} kg/m3 at 15 degC (assumed). The pressure coefficient is not given: the slope and the scatter about one factor count. "
        f"Above {SLOW:g} m/s the inlet warms up, which is left out here."
    )
    page.header(
        "pressure coefficient [1/GPa]",
        "nodes",
        "speeds",
        "slope measured",
        "slope found",
        "factor",
        "scatter [%]",
        "least ratio",
    )
    for coefficient in COEFFICIENTS:
        for grid in GRIDS if coefficient == COEFFICIENTS[1] else (129,):
            every = films(coefficient, grid)
            for text, part in (("all", every), (f"below {SLOW:g} m/s", every.below(SLOW))):
                (measured, found), (factor, scatter, least) = part.slopes(), part.factor()
                page.row(coefficient * 1e9, grid, text, measured, found, factor, 100.0 * scatter, least)
                if coefficient == COEFFICIENTS[1] and grid == 129 and text == "all":
                    page.verdict(
                        "slope within 0.04 of the measured one",
                        f"{found:.3f}, measured {measured:.3f}",
                        abs(found - measured) < 0.04,
                    )
                    page.verdict("scatter about one factor below 8 %", f"{100.0 * scatter:.1f} %", scatter < 0.08)
                    page.verdict("no film below half the measured", f"{least:.2f}", least > 0.5)
                    axes.loglog(every.speed, every.measured * 1e9, "ko", ms=4, label="measured")
                    axes.loglog(every.speed, every.found * 1e9, label="found, 129 nodes")
    axes.set(xlabel="entrainment speed [m/s]", ylabel="central film [nm]")
    axes.legend()


def dimple(page: Page, axes) -> None:  # type: ignore[no-untyped-def]
    """Add the dimple that crosses a contact."""
    page.say(
        "### A dimple that crosses a contact in rolling\n\nScene `dimple_rolling` as it ships, on several grids. The profiles are taken where "
        f"the dimple is nearest to its measured place; rms error over Hertz's contact, {BESIDE * 1e6:g} um and more from the dimple's middle."
    )
    page.header("nodes", *(f"profile {profile} [%]" for profile in range(1, 6)))
    for points in GRIDS[:2]:
        found = rolling(points)
        off = errors(found)
        page.row(points, *(100.0 * off[profile] for profile in range(1, 6)))
        if points == 129:
            worst = max(off.values())
            page.verdict(
                "five profiles of the dimple within 8 % rms beside it, 129 nodes",
                f"{100.0 * worst:.1f} %",
                worst < 0.08,
            )
            for ax, profile in zip(axes, range(1, 6), strict=True):
                rows = [row for row in read("dimple_rolling.csv") if row["profile"] == profile]
                ax.plot([row["x_um"] for row in rows], [row["gap_nm"] for row in rows], "ko", ms=2)
                ax.plot(found[profile][0] * 1e6, found[profile][1] * 1e9)
                ax.set(xlim=(-165, 165), ylim=(100, 500), title=f"profile {profile}", xlabel="x [um]")
    axes[0].set(ylabel="gap [nm]")


def main() -> None:
    page = Page("film/measured", "Films against measurements")
    figure = Figure(figsize=(13, 7), layout="constrained")
    upper, lower = figure.subfigures(2)
    optical(page, upper.subplots())
    dimple(page, lower.subplots(1, 5, sharey=True))
    page.picture(
        figure, "measured.png", "Central films over speed; profiles of the dimple, measured (points) and found"
    )
    page.write()


if __name__ == "__main__":
    main()
