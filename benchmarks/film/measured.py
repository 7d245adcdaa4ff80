"""Films against measurements: central films from 5 mm/s to 4 m/s, and a dimple that crosses a contact.

    python -m benchmarks.film.measured

Writes docs/measured/film.md and docs/measured/film/measured.png in about a minute. The data are in
system_models/validation/data.
"""

from matplotlib.figure import Figure

from benchmarks.pages import Page
from system_models.validation.dimple import BESIDE, GRIDS, errors, measured, rolling
from system_models.validation.optical_films import DENSITY, SLOW, films

COEFFICIENTS = (18e-9, 22e-9, 26e-9)  # 1/Pa: the oil's own is not given


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
        for grid in (*GRIDS, 257) if coefficient == COEFFICIENTS[1] else (129,):
            every = films(coefficient, grid)
            for text, part in (("all", every), (f"below {SLOW:g} m/s", every.below(SLOW))):
                (slope, found), (factor, scatter, least) = part.slopes(), part.factor()
                page.row(coefficient * 1e9, grid, text, slope, found, factor, 100.0 * scatter, least)
                if coefficient == COEFFICIENTS[1] and grid == 129 and text == "all":
                    page.verdict(
                        "slope within 0.04 of the measured one",
                        f"{found:.3f}, measured {slope:.3f}",
                        abs(found - slope) < 0.04,
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
    for points in GRIDS:
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
                x, gap = measured(profile)
                ax.plot(x * 1e6, gap * 1e9, "ko", ms=2)
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
