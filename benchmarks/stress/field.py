"""Stress below contacts against closed forms: error by grid and depth, order, cost per depth.

    python -m benchmarks.stress.field

Writes docs/measured/stress.md and two pictures; half a minute. Pressures are means over cells, or those of `dry_contact`.
"""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from benchmarks.pages import Page
from benchmarks.stress.closed_forms import circle_stress, ellipse_axis_stress, line_stress
from benchmarks.timing import timed
from contact_core import dry_contact, graded_depths, subsurface_stress
from contact_core.kernels.half_space import HalfSpace
from contact_core.kernels.subsurface import Subsurface
from contact_core.reference import hertz_point

Array = NDArray[np.float64]

POISSON = 0.3
ACROSS = (17, 33, 65, 129)  # nodes per diameter or width of the contact
ASKED = 65
SIDE = 1.3  # half a grid over half a contact
DEPTHS = (0.0, 0.25, 0.5, 1.0, 2.0, 4.0)  # in spacings; and those of `DEEP`
DEEP = (0.25, 0.48, 0.78, 1.5)  # in half widths
NEAR = 2.0  # spacings from the edge of the contact, within which errors are counted apart
FRICTION = (0.0, 0.1, 0.2, 0.3, 0.4)
RATIOS = (0.1, 0.2, 0.5, 0.8)  # half width along x over that along y
COST = (65, 129, 257)
FINER = 5  # cells along a spacing that stand for piecewise linear pressure
PERCENT = 100.0


class Errors(NamedTuple):
    """Largest errors of any component over the largest pressure, by depth; away from the edge, and everywhere."""

    depths: Array  # in spacings
    away: Array
    anywhere: Array


def depths_of(spacing: float) -> Array:
    return np.array([*(depth * spacing for depth in DEPTHS), *DEEP])


def nodes_of(across: int) -> tuple[Array, float]:
    spacing = 2.0 / (across - 1)
    half = int(SIDE / spacing)
    return spacing * np.arange(-half, half + 1.0), spacing


def errors(found: Array, exact: Array, from_edge: Array, spacing: float) -> Errors:
    missed = np.abs(found - exact).max(axis=0)
    away = np.where(from_edge > NEAR * spacing, missed, 0.0)
    return Errors(depths_of(spacing) / spacing, away.max(axis=(1, 2)), missed.max(axis=(1, 2)))


def solved(xx: Array, spacing: float) -> Array:
    """Pressure of a ball by `dry_contact`."""
    hertz = hertz_point(50.0, 1e-2, 1e-2, 2.3e11)
    pressed = dry_contact(np.zeros(xx.shape), spacing * hertz.a, 1e-2, 50.0, 2.3e11)
    return pressed.pressure / hertz.pressure_max


def ellipse_means(xx: Array, yy: Array, spacing: float, ratio: float = 1.0) -> Array:
    """Means over cells of Hertz's pressure at x / a and y / b, a over b being the ratio."""
    part = ((np.arange(16) + 0.5) / 16 - 0.5) * spacing
    squares = ((xx + s) ** 2 + (yy + ratio * t) ** 2 for s in part for t in part)
    return np.mean([np.sqrt(np.maximum(1.0 - square, 0.0)) for square in squares], axis=0)


def linear(p: Array) -> Array:
    """Piecewise linear pressure between the nodes, on a grid `FINER` times as fine."""
    for _ in range(2):
        rows = np.arange(FINER * (p.shape[0] - 1) + 1) / FINER
        low = np.minimum(rows.astype(int), p.shape[0] - 2)
        p = (p[low] + (rows - low)[:, None] * (p[low + 1] - p[low])).T
    return p


@cache
def circle(across: int, kind: str = "means") -> Errors:
    x, spacing = nodes_of(across)
    xx, yy = np.meshgrid(x, x)
    p = ellipse_means(xx, yy, spacing) if kind == "means" else solved(xx, spacing)
    z = depths_of(spacing)
    if kind == "linear":
        fine = (subsurface_stress(linear(p), None, None, spacing / FINER, depth, poisson_ratio=POISSON) for depth in z)
        found = np.concatenate([below.stress[:, :, ::FINER, ::FINER] for below in fine], axis=1)
    else:
        found = subsurface_stress(p, None, None, spacing, z, poisson_ratio=POISSON).stress
    exact = circle_stress(xx, yy, z[:, None, None], 1.0, 1.0, POISSON)
    return errors(found, exact, np.abs(np.hypot(xx, yy) - 1.0), spacing)


def line_means(x: Array, spacing: float) -> Array:
    def sum_to(x: Array) -> Array:
        x = np.clip(x, -1.0, 1.0)
        return 0.5 * (x * np.sqrt(1.0 - x * x) + np.arcsin(x))

    return (sum_to(x + 0.5 * spacing) - sum_to(x - 0.5 * spacing)) / spacing


@cache
def line(across: int, friction: float) -> Errors:
    x, spacing = nodes_of(across)
    p, z = np.tile(line_means(x, spacing), (4, 1)), depths_of(spacing)
    found = subsurface_stress(p, friction * p, None, spacing, z, poisson_ratio=POISSON, periodic=True).stress
    exact = line_stress(x, z[:, None, None], 1.0, 1.0, POISSON, friction)
    return errors(found, exact, np.abs(np.abs(x) - 1.0)[None, :], spacing)


CASES: dict[str, Callable[[int], Errors]] = {
    "circle": circle,
    "circle, pressure of `dry_contact`": lambda across: circle(across, "solved"),
} | {f"line, traction {mu:g}": (lambda across, mu=mu: line(across, mu)) for mu in FRICTION}  # type: ignore[misc]


def order(coarse: float, fine: float) -> str:
    return f"{np.log2(coarse / fine):.1f}"


def depth_tables(page: Page) -> None:
    page.say(
        f"Largest error of any component in % of the largest pressure at {ASKED} nodes per contact, by depth in spacings h or half widths a. "
        f"First everywhere, then {NEAR:g} h and more away from the edge of the contact."
    )
    names = [*(f"{depth:g} h" for depth in DEPTHS), *(f"{depth:g} a" for depth in DEEP)]
    for which in ("anywhere", "away"):
        page.header(f"{which}", *names)
        for name, case in (
            *CASES.items(),
            ("circle, pressure of `dry_contact`, piecewise linear", lambda n: circle(n, "linear")),
        ):
            page.row(name, *(f"{PERCENT * error:.2f}" for error in getattr(case(ASKED), which)))
        page.say("")


def order_table(page: Page) -> None:
    page.say(
        "The same against nodes per contact, and the order from the last two grids. One depth in spacings is less deep on a finer grid: that is the "
        "error of the field near the surface."
    )
    page.header("case", "where", *(str(n) for n in ACROSS), "order")
    places: tuple[tuple[str, str, slice], ...] = (
        ("surface, away from the edge", "away", slice(0, 1)),
        ("0.25, 0.5 h, everywhere", "anywhere", slice(1, 3)),
        ("0.25, 0.5 h, away from the edge", "away", slice(1, 3)),
        ("1 h and deeper, everywhere", "anywhere", slice(3, None)),
        ("0.48 a, everywhere", "anywhere", slice(len(DEPTHS) + 1, len(DEPTHS) + 2)),
    )
    for name in ("circle", "circle, pressure of `dry_contact`", "line, traction 0", "line, traction 0.4"):
        for place, which, at in places:
            found = [float(getattr(CASES[name](n), which)[at].max()) for n in ACROSS]
            page.row(name, place, *(f"{PERCENT * error:.3f}" for error in found), order(*found[-2:]))


def largest_values(page: Page) -> None:
    """Sizes and depths of the largest stress of the circle."""
    x, spacing = nodes_of(ASKED)
    xx, yy = np.meshgrid(x, x)
    p = ellipse_means(xx, yy, spacing)
    page.header("depths", "largest shear / p_max", "its depth / a", "largest von Mises / p_max", "its depth / a")
    for name, z in (("200 even ones", np.linspace(0.0, 1.5, 201)[1:]), ("12 graded ones", graded_depths(spacing, 1.0))):
        found = subsurface_stress(p, None, None, spacing, z, poisson_ratio=POISSON)
        values = []
        for measure in (found.largest_shear, found.von_mises):
            layer, row, column = np.unravel_index(measure.argmax(), measure.shape)
            values += [float(measure[layer, row, column]), float(z[layer])]
        page.row(name, *values)
        if name.startswith("200"):
            page.verdict(
                "largest shear .310 p_max at .48 a",
                f"{values[0]:.4f} at {values[1]:.3f} a",
                abs(values[0] - 0.31) < 1e-3,
            )
            page.verdict(
                "largest von Mises .62 p_max (v = .3)",
                f"{values[2]:.4f} at {values[3]:.3f} a",
                abs(values[2] - 0.62) < 1e-3,
            )


def ellipse_table(page: Page) -> None:
    page.say(
        f"Elliptical contacts, {ASKED} nodes along their short side: errors on the axis below the centre against Boussinesq's potentials, and the largest "
        "shear on the axis (120 depths) beside its exact value."
    )
    page.header("a / b", "largest error on the axis, %", "largest shear / p_max", "exact", "its depth / a", "exact")
    worst = 0.0
    for ratio in RATIOS:
        x, spacing = nodes_of(ASKED)
        y = spacing * np.arange(-int(SIDE / ratio / spacing), int(SIDE / ratio / spacing) + 1.0)
        xx, yy = np.meshgrid(x, ratio * y)
        p = ellipse_means(xx, yy, spacing, ratio)
        z = np.linspace(0.0, 1.2, 121)[1:]
        middle = np.s_[:3, :, y.size // 2, x.size // 2]
        found = np.hstack(
            [Subsurface(p.shape, spacing, np.array([depth]), POISSON, "pyfftw").stress(p)[middle] for depth in z]
        )
        exact = ellipse_axis_stress(z, 1.0, 1.0 / ratio, 1.0, POISSON)
        shears = [0.5 * np.ptp(stress, axis=0) for stress in (found, exact)]
        worst = max(worst, float(np.abs(found - exact).max()))
        pairs = [*(shear.max() for shear in shears), *(z[shear.argmax()] for shear in shears)]
        page.row(ratio, f"{PERCENT * np.abs(found - exact).max():.3f}", *map(float, pairs))
    page.verdict("ellipses within 1 % on their axis", f"{PERCENT * worst:.2f} %", worst < 0.01)


def per_depth(below: Subsurface, given: tuple[Array, ...]) -> float:
    """CPU time of a depth [s]."""
    layers, seconds = timed(lambda: sum(1 for _ in below.layers(*given)), 25)
    return seconds / layers


def cost_table(page: Page) -> None:
    page.say(
        "CPU time of one depth over that of one deformation convolution (`HalfSpace.deform`) on the same grid; the first call makes the spectra of each "
        "depth and traction, which are kept, in MB per depth."
    )
    page.header(
        "nodes",
        "convolution, ms",
        "pressure",
        "and shear along x",
        "and along y",
        "first call, pressure",
        "MB",
        "MB with both shears",
    )
    for n in COST:
        p = np.random.Generator(np.random.Philox(n)).random((n, n))
        half_space = HalfSpace(n, n, 1.0, "pyfftw")
        half_space.deform(p)
        _, unit = timed(lambda: half_space.deform(p), 60)  # noqa: B023
        z = np.array([0.5, 1.0, 2.0, 4.0])
        below = Subsurface((n, n), 1.0, z, POISSON, "pyfftw")
        Subsurface((n, n), 1.0, z[:1], POISSON, "pyfftw").stress(p)
        _, first = timed(lambda: below.stress(p))  # noqa: B023
        below.stress(p, p, p)
        units = [per_depth(below, given) / unit for given in ((p,), (p, p), (p, p, p))]
        spectrum = 6 * 8e-6 * (below.plane[0] // 2 + 1) * (below.plane[1] // 2 + 1)
        page.row(n, 1e3 * unit, *units, first / z.size / unit, spectrum, 3.0 * spectrum)


def pictures(page: Page) -> None:
    x, spacing = nodes_of(ASKED)
    z = np.linspace(0.0, 1.5, 61)
    figure, axes = plt.subplots(1, 3, figsize=(12.0, 3.0), layout="constrained", sharey=True)
    p = np.tile(line_means(x, spacing), (2, 1))
    xx, yy = np.meshgrid(x, x)
    round_ = np.sqrt(np.maximum(1.0 - xx**2 - yy**2, 0.0))
    shown = [("circle: von Mises stress", subsurface_stress(round_, None, None, spacing, z).von_mises[:, x.size // 2])]
    slides = subsurface_stress(p, 0.3 * p, None, spacing, z, periodic=True)
    shown += [
        ("line, traction 0.3: von Mises stress", slides.von_mises[:, 0]),
        ("line, traction 0.3: stress xx", slides.stress[0, :, 0]),
    ]
    for axis, (title, values) in zip(axes, shown, strict=True):
        levels = np.linspace(0.0, 0.65, 14) if values.min() >= 0.0 else np.linspace(-1.1, 0.7, 19)
        drawn = axis.contourf(x, z, values, levels, cmap="viridis" if values.min() >= 0.0 else "RdBu_r", extend="both")
        figure.colorbar(drawn, ax=axis, label="over p_max")
        axis.set(title=title, xlabel="x / a")
    axes[0].set(ylabel="z / a")
    axes[0].invert_yaxis()
    page.picture(figure, "field.png", "Stress below a circle and a sliding line")
    page.picture(error_picture(), "field_errors.png", "Errors against nodes per contact")


def error_picture() -> Figure:
    figure, axes = plt.subplots(1, 2, figsize=(9.0, 3.4), layout="constrained", sharey=True)
    for axis, name in zip(axes, ("circle", "line, traction 0.4"), strict=True):
        for at, (label, which) in enumerate(
            (
                ("surface, away from the edge", "away"),
                ("h / 2, everywhere", "anywhere"),
                ("h / 2, away from the edge", "away"),
                ("h and deeper, everywhere", "anywhere"),
            )
        ):
            rows = (slice(0, 1), slice(2, 3), slice(2, 3), slice(3, None))[at]
            axis.loglog(
                ACROSS, [PERCENT * getattr(CASES[name](n), which)[rows].max() for n in ACROSS], "o-", label=label
            )
        deep = len(DEPTHS) + 1
        axis.loglog(ACROSS, [PERCENT * CASES[name](n).anywhere[deep] for n in ACROSS], "o-", label="0.48 a, everywhere")
        axis.axhline(1.0, color="grey", linewidth=0.8)
        axis.set(title=name, xlabel="nodes per contact", xticks=ACROSS, xticklabels=[str(n) for n in ACROSS])
        axis.minorticks_off()
    axes[0].set(ylabel="largest error, % of p_max")
    axes[1].legend(fontsize=7)
    return figure


def main() -> None:
    page = Page("stress/field", "Stress below contacts")
    page.say(
        "Half spaces with Poisson's ratio 0.3; errors by `contact_core.subsurface_stress`, over all six components and all nodes of a grid 1.3 contacts wide."
    )
    depth_tables(page)
    deep = max(float(case(ASKED).anywhere[3:].max()) for case in CASES.values())
    page.verdict(
        f"within 1 % at {ASKED} nodes per contact, from a depth of one spacing on",
        f"{PERCENT * deep:.2f} %",
        deep < 0.01,
    )
    for name, at in (("on the surface", slice(0, 1)), ("at 1/4 and 1/2 spacing", slice(1, 3))):
        for which, where in (("away", f"{NEAR:g} spacings away from the edge"), ("anywhere", "everywhere")):
            found = max(float(getattr(case(ASKED), which)[at].max()) for case in CASES.values())
            page.verdict(f"within 1 % {name}, {where}", f"{PERCENT * found:.2f} %", found < 0.01)
    order_table(page)
    page.say(
        "Pressure that is constant on cells cannot tell where within a cell Hertz's pressure ends, and there its slope is infinite: within a spacing or two of "
        "the edge and less than a spacing below the surface the error is that of the pressure itself and falls with the root of the spacing. Piecewise linear "
        "pressure, the last row of the first tables, helps there and harms below; it would not mend it."
    )
    page.say("Largest stress below the circle:")
    largest_values(page)
    ellipse_table(page)
    cost_table(page)
    pictures(page)
    page.write()


if __name__ == "__main__":
    main()
