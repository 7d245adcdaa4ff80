"""Constants of the load-sharing curves from the sweep, with their intervals, and the page's part on them."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import least_squares

from benchmarks.pages import cells
from benchmarks.regression.points import SCENES, Columns, solved
from contact_core import RangeFlag, Scene
from contact_core.laws.asperity_layer import SLOPE
from contact_core.laws.load_sharing import FittedSharing, flattening_together, layer_height

RANGES = ((0.0, 0.05), (0.05, 0.2), (0.2, 1.0), (1.0, np.inf))
MOST = 15.0  # of the weight of a load ratio
LEAST = 1e-6  # of a constant
FAR = 0.1  # residuals beyond which a point counts by its distance
SWEPT = ("shipped", "amplitude", "length", "microroughness")  # groups of the sweep
OF_OIL = ("oil_pressure_excess", "oil_pressure_decay", "oil_steepness", "oil_kept", "oil_spread")
STUDENT = 1.96  # half width of a 95 % interval, in standard deviations
Array = np.ndarray


@dataclass(frozen=True)
class Table:
    """Columns by the names of the law's numbers."""

    columns: Columns

    @property
    def clearance(self) -> Array:
        return self.columns["lambda"]

    @property
    def flattening(self) -> Array:
        c = self.columns
        return c["mean_pressure"] / (0.5 * c["modulus"] * c["slope"])

    @property
    def below(self) -> Array:
        c = self.columns
        return c["mean_pressure"] / (0.5 * c["modulus"] * c["slope_below"])

    @property
    def layer(self) -> Array:
        return self.clearance / self.layers

    @property
    def layers(self) -> Array:
        c = self.columns
        return c["lambda"] * c["sigma"] / layer_height(c["floor"], c["microroughness"])

    @property
    def slip(self) -> Array:
        return self.columns["slip"]

    @property
    def pressed(self) -> Array:
        return self.columns["largest_pressure"] / self.columns["hardness"]

    def shared(self, law: FittedSharing) -> Array:
        """Load ratio by the law."""
        return law.load_ratio(self.clearance, self.layers, self.flattening, self.below, self.slip, self.pressed)

    @property
    def weight(self) -> Array:
        """Relative change of friction per change of the load ratio, at most `MOST`: what an error of it does."""
        c = self.columns
        bare = np.array([Scene.from_toml(name).boundary_friction.bare for name in np.unique(c["scene"])])
        solid = bare[np.unique(c["scene"], return_inverse=True)[1]]
        oil = np.clip(
            (c["friction_coefficient"] - solid * self.load_ratio) / (1.0 - self.load_ratio + 1e-9), 0.0, solid
        )
        return np.minimum((solid - oil) / c["friction_coefficient"], MOST)

    @property
    def dense(self) -> Array:
        return self.columns["lambda"] / self.columns["density"]

    @property
    def load_ratio(self) -> Array:
        return self.columns["contact_load_ratio"]

    @property
    def area_ratio(self) -> Array:
        return self.columns["contact_area_ratio"]

    @property
    def film_ratio(self) -> Array:
        return self.columns["h_c"] / self.columns["sigma"]

    def of(self, kept: Array) -> "Table":
        """Some of the rows."""
        return Table({name: values[kept] for name, values in self.columns.items()})


def fitted(residual: Callable[[Array], Array], start: list[float], least: float = LEAST) -> tuple[Array, Array, float]:
    """Least squares in which rows far off count by their distance: constants, half widths of their 95 % intervals,
    standard deviation of the residuals.
    """
    found = least_squares(
        residual, np.maximum(start, 2.0 * least), loss="soft_l1", f_scale=FAR, bounds=(least, np.inf), x_scale="jac"
    )
    freedom = found.fun.size - found.x.size
    variance = float(found.fun @ found.fun) / freedom
    widths = STUDENT * np.sqrt(np.diag(np.linalg.pinv(found.jac.T @ found.jac)) * variance)
    return found.x, widths, variance**0.5


class Fit:
    """The law of a shape with its constants fitted one curve after the other.

    `sweep` and what `others` there are together make the sharing of the load, the area, the gap and the oil's pressure;
    `dry` and `whole` passes, where there are any, the area of dry contacts and the exposure.
    """

    def __init__(
        self,
        law: FittedSharing,
        sweep: Columns,
        others: Columns | None = None,
        dry: Columns | None = None,
        whole: Columns | None = None,
    ) -> None:
        tables = [table for table in (sweep, others, dry, whole) if table is not None]
        self.refused = sum(int((~np.isfinite(table["contact_area_ratio"])).sum()) for table in tables)
        self.law, self.half_widths = law, dict[str, float]()
        self.sweep = Table(solved(sweep))
        self.all = rows = self.sweep if others is None else Table(shared([self.sweep.columns, told(solved(others))]))
        weight = rows.weight
        self._fit(
            (
                "load_factor",
                "load_exponent",
                "load_flattening",
                "load_below",
                "load_slip",
                "load_yield",
                "load_parted",
            ),
            lambda law: weight * (rows.shared(law) - rows.load_ratio),
        )
        self._fit(
            ("area_factor", "area_exponent"), self._area_residual(rows, None if dry is None else Table(solved(dry)))
        )
        open_gap = rows.of(rows.columns["h_c"] > 3.0 * rows.columns["floor"])
        self._fit(
            ("film_dry", "film_parted", "film_layer", "film_mixed", "film_factor", "film_exponent"),
            lambda law: np.log(
                law.film_ratio(open_gap.dense, open_gap.load_ratio, open_gap.flattening, open_gap.layer)
                / open_gap.film_ratio
            ),
        )
        sliding = Traction(rows)
        self._fit(OF_OIL, sliding.misfit)
        if dry is not None and whole is not None:
            self.dry, self.whole = Table(solved(dry)), Table(solved(whole))
            self._fit_exposure()
        found = predicted(self.law, rows)
        self.scatter = {
            "W_c": float(np.std(found["W_c"] - rows.load_ratio)),
            "h_c": float(np.std(np.log(found["h_c"] / rows.film_ratio))),
            "friction of the oil": float(np.std(sliding.misfit(self.law))),
        }

    def _fit(self, of_curve: tuple[str, ...], residual: Callable[[FittedSharing], Array]) -> None:
        names = tuple(name for name in of_curve if name not in self.law.CHOSEN)

        def of(x: Array) -> Array:
            return residual(replace(self.law, **dict(zip(names, x.tolist(), strict=True))))

        found, widths, _ = fitted(of, [getattr(self.law, name) for name in names])
        self.law = replace(self.law, **dict(zip(names, found.tolist(), strict=True)))
        self.half_widths |= dict(zip(names, widths.tolist(), strict=True))

    @staticmethod
    def _area_residual(rows: Table, dry: Table | None) -> Callable[[FittedSharing], Array]:
        def residual(law: FittedSharing) -> Array:
            off = law.area_ratio(rows.load_ratio, rows.flattening, rows.below) - rows.area_ratio
            if dry is None:
                return off
            alone = law.area_ratio(np.ones_like(dry.flattening), dry.flattening, dry.below) - dry.area_ratio
            return np.concatenate([off, alone])

        return residual

    def _fit_exposure(self) -> None:
        for is_dry, names in (
            (False, {True: ("exposure_rougher", "exposure_exponent"), False: ("exposure_smoother",)}),
            (True, {True: ("exposure_dry_rougher",), False: ("exposure_dry_smoother",)}),
        ):
            whole = self.whole.of((self.whole.columns["blocks_dry"] > 0.0) == is_dry)
            for rougher, which in names.items():
                self._fit(which, self._exposure_residual(whole, rougher, is_dry))

    @staticmethod
    def _exposure_residual(whole: Table, rougher: bool, dry: bool) -> Callable[[FittedSharing], Array]:
        seen = whole.columns["exposed_rougher" if rougher else "exposed_smoother"]
        within = covered(whole)
        return lambda law: within * law.exposed(whole.area_ratio, rougher=rougher, dry=dry) - seen


def told(columns: Columns) -> Columns:
    """Without what the deterministic level does not stand for: films short of the tolerance, and ellipses and lines whose
    inlet the grid does not resolve.
    """
    flags = columns["range_flags"].astype(int)
    unresolved = ~np.isin(columns["scene"], SCENES) & (flags & RangeFlag.INLET_UNRESOLVED > 0)
    kept = (flags & RangeFlag.NOT_CONVERGED == 0) & ~unresolved
    return {name: values[kept] for name, values in columns.items()}


def shared(parts: list[Columns]) -> Columns:
    """Tables below each other, of the columns that all of them have."""
    names = [name for name in parts[0] if all(name in part for part in parts)]
    return {name: np.concatenate([part[name] for part in parts]) for name in names}


class Traction:
    """Friction coefficient of the oil of solved points that slide without spin, if it carries its load at some factor
    of Hertz's pressure; with the solved load ratio and film. Where solids carry most of it, they leave it unsure.
    """

    def __init__(self, table: Table) -> None:
        c = table.columns
        self.scenes = {name: Scene.from_toml(name) for name in np.unique(c["scene"])}
        bare = np.array([self.scenes[name].boundary_friction.bare for name in c["scene"]])
        fluid = c["friction_coefficient"] - bare * c["contact_load_ratio"]
        swept = np.isin(c["group"], SWEPT)
        share = np.where(swept, 0.1, 0.3)  # of sweeps, where it counts for more
        kept = (c["contact_load_ratio"] < share) & (c["h_c"] > 2.0 * c["floor"]) & (fluid > 0.0) & (c["spin"] == 0.0)
        self.table, self.solved = table.of(kept), fluid[kept]
        nodes, weights = np.polynomial.legendre.leggauss(16)
        heights, cosine = 0.5 + 0.5 * nodes, np.cos(0.25 * np.pi * (1.0 + nodes))
        self.ellipse = heights, heights * weights  # of Hertz's pressure, and what they weigh in the mean
        self.strip = cosine, 0.25 * np.pi * weights * cosine

    def misfit(self, law: FittedSharing) -> Array:
        """Logarithm of the law's friction over the solved one."""
        return np.log(law.kept(self.table.flattening) * self.friction(self._raised(law)) / self.solved)

    def half_widths(self, law: FittedSharing) -> Array:
        """Half widths of the oil's friction that the law states, relative."""
        raised, faster = self._raised(law), 1.01
        slope = np.log(self.friction(raised, faster) / self.friction(raised)) / np.log(faster)
        return np.array([law.WIDTHS.of_oil(*each) for each in zip(self.table.clearance, slope, strict=True)])

    def _raised(self, law: FittedSharing) -> Array:
        """Pressure at which the oil carries load, over Hertz's."""
        t, c = self.table, self.table.columns
        return law.oil_pressure(t.clearance, t.flattening, c["thick_x"], c["thick_y"])

    def friction(self, factor: Array, faster: float = 1.0) -> Array:
        """Friction of the oil over the load, at `faster` times the sliding speed."""
        c = self.table.columns
        found = np.empty_like(factor)
        for i, name in enumerate(c["scene"]):
            oil, line = self.scenes[name].lubricant, c["thick_y"][i] == 0.0
            heights, weights = self.strip if line else self.ellipse
            most = min(factor[i], c["hardness"][i] / c["largest_pressure"][i])
            local = most * c["largest_pressure"][i] * heights
            rate = faster * abs(c["srr"][i]) * c["speed"][i] / c["h_c"][i]
            stress = weights @ oil.rheology(oil.viscosity(local, float(c["temperature"][i])) * rate, local)
            found[i] = stress / (most * c["mean_pressure"][i]) * (1.0 - c["contact_load_ratio"][i])
        return found


def covered(table: Table) -> Array:
    """Share of the track's width, that of the reference load, that Hertz's contact covers."""
    scene_b = {name: Scene.from_toml(name).hertz(Scene.from_toml(name).operation.load).b for name in SCENES}
    reference = np.array([scene_b[name] for name in table.columns["scene"]])
    return np.minimum(table.columns["width"] / reference, 1.0)


def predicted(law: FittedSharing, table: Table) -> Columns:
    """Return the outputs of the law for lambda, flattening and layers; h_c in sigma."""
    share = table.shared(law)
    return {
        "W_c": share,
        "A_c": law.area_ratio(share, table.flattening, table.below),
        "h_c": law.film_ratio(table.dense, share, table.flattening, table.layer),
    }


def alternatives(rows: Table) -> list[tuple[str, int, float, float]]:
    """Forms of W_c: what, how many constants, standard deviation and largest distance of the residuals."""
    lam, film, flat, below = rows.clearance, rows.layers, rows.flattening / 0.2, rows.below / 0.2
    slip, fine = 1.0 + rows.slip, rows.columns["correlation_length"] / rows.columns["spacing"]
    weight, share = rows.weight, rows.load_ratio

    def of(*numbers: Array) -> Callable[[Array], Array]:
        return lambda p: np.exp(-p[0] * np.prod([x**power for x, power in zip(numbers, p[1:], strict=True)], axis=0))

    def parting(*numbers: Array) -> Callable[[Array], Array]:
        return lambda p: of(*numbers)(p[:-1]) * np.exp(-p[-1] * lam**2)

    forms = [
        ("exp(-B lambda^C)", of(lam), 2),
        ("exp(-B f^C)", of(film), 2),
        ("exp(-B f^C s^m)", of(film, flat), 3),
        ("exp(-B f^C s^m s_m^l)", of(film, flat, below), 4),
        ("exp(-B f^C s^m s_m^l - b lambda^2)", parting(film, flat, below), 5),
        ("**exp(-B f^C s^m s_m^l (1 + slip)^v - b lambda^2)**", parting(film, flat, below, slip), 6),
        ("exp(-B f^C s^m s_m^l (1 + slip)^v r^q - b lambda^2)", parting(film, flat, below, slip, fine), 7),
    ]
    found = []
    for name, form, count in forms:
        start = [0.5, 1.0, *([0.3] * (count - 2))]
        constants, _, _ = fitted(lambda p, form=form: weight * (form(p) - share), start, -np.inf)
        off = form(constants) - share
        found.append((name, count, float(np.std(off)), float(np.abs(off).max())))
    return found


def table(names: tuple[str, ...], rows: list[tuple[Any, ...]]) -> list[str]:
    """Lines of a table."""
    return ["", cells(names), "|" + "---|" * len(names), *(cells(row) for row in rows), ""]


def by_range(clearance: Array, errors: Columns) -> list[str]:
    """Median and 90th percentile of errors by ranges of lambda."""
    rows = []
    for low, high in RANGES:
        inside = (clearance >= low) & (clearance < high)
        found = [
            f(np.abs(error[inside])) for error in errors.values() for f in (np.median, lambda e: np.quantile(e, 0.9))
        ]
        name = f"below {high:g}" if low == 0.0 else f"above {low:g}" if high == np.inf else f"{low:g} to {high:g}"
        rows.append((name, int(inside.sum()), *(f"{value:.3f}" for value in found)))
    heads = [f"{name}, {what}" for name in errors for what in ("median", "90 %")]
    return table(("lambda", "points", *heads), rows)


def errors_of(law: FittedSharing, data: Table) -> Columns:
    """Return the errors of the curves against solved points: W_c absolute, A_c absolute, h_c relative."""
    found = predicted(law, data)
    return {
        "W_c [1]": found["W_c"] - data.load_ratio,
        "A_c [1]": found["A_c"] - data.area_ratio,
        "h_c [rel.]": found["h_c"] / data.film_ratio - 1.0,
    }


def ends(rows: Table) -> dict[str, tuple[float, float]]:
    """Between which numbers the rows lie."""
    found = (
        ("lambda", rows.clearance),
        ("f", rows.layers),
        ("s", rows.flattening),
        ("s_m", rows.below),
        ("slip", rows.slip),
        ("pressed", rows.pressed),
    )
    return {name: (float(x.min()), float(x.max())) for name, x in found}


def widths_page(fit: Fit) -> list[str]:
    """Return how the half widths stated by the shipped law compare with the residuals about the fitted one."""
    rows, law, oil = fit.all, fit.law, Traction(fit.all)
    share = rows.shared(law)
    film = law.film_ratio(rows.dense, share, rows.flattening, rows.layer)
    residuals = {
        "W_c": (
            share - rows.load_ratio,
            [law.WIDTHS.of_load(*each) for each in zip(share, rows.clearance, strict=True)],
        ),
        "h_c": (rows.film_ratio / film - 1.0, [law.WIDTHS.of_film(each) for each in rows.clearance]),
        "friction of the oil": (np.expm1(-oil.misfit(law)), oil.half_widths(law)),
    }
    lines = []
    for name, (off, stated) in residuals.items():
        ratio = np.abs(off) / np.asarray(stated)
        middle, most = np.median(stated), np.quantile(ratio, 0.95)
        lines.append(
            (
                name,
                off.size,
                f"{np.median(np.abs(off)):.3f}",
                f"{middle:.3f}",
                f"{np.mean(ratio <= 1.0):.3f}",
                f"{most:.2f}",
            )
        )
    heads = (
        "quantity",
        "points",
        "median residual",
        "median half width",
        "covered",
        "times as wide, 95 % would be covered",
    )
    return ["Half widths (`WIDTHS`) against the residuals:", *table(heads, lines)]


def constants(fit: Fit) -> list[tuple[str, ...]]:
    """Rows of the table of constants."""
    shipped = type(fit.law)()
    return [
        (name, f"{getattr(fit.law, name):.4g}", f"{width:.2g}", f"{getattr(shipped, name):.4g}")
        for name, width in fit.half_widths.items()
    ]


def constants_page(fit: Fit) -> list[str]:
    """The fit's part of the page."""
    sweep, rows, dry, whole = fit.sweep, fit.all, fit.dry, fit.whole
    many = int((sweep.columns["unconverged"] > 0.1).sum())
    span = ", ".join(f"{name} {low:.3g} to {high:.3g}" for name, (low, high) in ends(rows).items())
    dry_off = fit.law.area_ratio(np.ones_like(dry.flattening), dry.flattening, dry.below) / dry.area_ratio - 1.0
    area_off = fit.law.area_ratio(rows.load_ratio, rows.flattening, rows.below) - rows.area_ratio
    film_off = fit.law.film_ratio(rows.dense, rows.load_ratio, rows.flattening, rows.layer)
    film_off = np.log(film_off / rows.film_ratio)
    oil = Traction(rows)
    plain = oil.misfit(replace(fit.law, oil_pressure_excess=1e-9, oil_spread=1e-9, oil_kept=1.0))
    exposed = []
    for rougher in (True, False):
        seen = whole.columns["exposed_rougher" if rougher else "exposed_smoother"]
        is_dry = whole.columns["blocks_dry"] > 0.0
        dry_share, mixed_share = (fit.law.exposed(whole.area_ratio, rougher=rougher, dry=d) for d in (True, False))
        off = covered(whole) * np.where(is_dry, dry_share, mixed_share) - seen
        exposed.append((("smoother", "rougher")[rougher], f"{np.std(off):.3f}", f"{np.abs(off).max():.3f}"))
    return [
        "## The sweep",
        "",
        f"{sweep.clearance.size} first blocks on fresh surfaces, {' and '.join(SCENES)} on their own grids (129 nodes over 0.5 mm), "
        "sliding as shipped; speed, load (0.3 to 1.3 of the reference), temperature (40 K below to 20 K above, for the viscosity), "
        "34 of each scene with the roughness as shipped, 14 with 0.3 to 1 of its amplitude, 12 with 1.25 to 3 times its correlation length, "
        "16 with 0.2 to 2 times the rms height of its microroughness. "
        f"{rows.clearance.size - sweep.clearance.size} more points: the random ones below, and circles and ellipses over the ranges of a rig and of a ball bearing (shapes.md). "
        f"Covered: {span}. {dry.clearance.size} dry contacts for the area, {whole.clearance.size} blocks of a whole pass for the exposure. "
        f"Refused by the solver: {fit.refused}. {many} blocks of the sweep had more than a tenth of their instants not converged; they are kept.",
        "",
        "## Constants",
        "",
        "Names as in `contact_core/laws/load_sharing.py`; half widths of 95 % intervals from the covariance, points taken as independent. "
        f"Chosen, not fitted: {', '.join(sorted(FittedSharing.CHOSEN))}.",
        *table(("constant", "fitted", "half width", "shipped"), constants(fit)),
        "Standard deviations about the curves, A_c and h_c with W_c from its own curve, the friction of the oil with the solved W_c and h_c; relative except for W_c:",
        *table(("name", "found"), [(k, f"{v:.3f}") for k, v in fit.scatter.items()]),
        *widths_page(fit),
        f"With the solved W_c: A_c {np.std(area_off):.3f}, h_c {np.std(film_off):.3f} (relative). "
        f"Friction of the oil if it had Hertz's pressure everywhere: {plain.std():.2f} (relative). "
        f"Dry A_c: {np.std(dry_off):.3f} (relative, at most {np.abs(dry_off).max():.3f}).",
        "",
        "Exposed share of each body's track |y| < b in a whole pass:",
        *table(("body", "scatter", "largest error"), exposed),
        "## Variables of W_c",
        "",
        "W_c does not depend on lambda alone: at the same lambda, roughness that is pressed flatter carries less, so do bodies with less "
        "roughness below the grid, and asperities that slide past each other. f = film of the smooth bodies / height to which roughness below the grid reaches (floor and rms height); "
        "s = p_m / (E* slope) of the roughness on the grid, s_m of the longest wave below it; slip = sliding over entrainment speed; r = correlation length / distance of the nodes.",
        *table(
            ("form", "constants", "scatter", "largest error"),
            [(n, k, f"{a:.3f}", f"{b:.3f}") for n, k, a, b in alternatives(rows)],
        ),
        "r adds nothing: W_c does not depend on the distance of the nodes.",
        "",
        "## Curves against the sweep they were fitted to",
        *by_range(sweep.clearance, errors_of(fit.law, sweep)),
    ]


def draw(fit: Fit) -> Figure:
    """Points and curves over the numbers that collapse them."""
    figure = Figure(figsize=(10.5, 7.0), layout="constrained")
    axes = figure.subplots(2, 2)
    sweep, dry = fit.sweep, fit.dry
    looks = {
        "shipped": ("#2471a3", "o"),
        "amplitude": ("#e59866", "s"),
        "length": ("#27ae60", "^"),
        "microroughness": ("#8e44ad", "v"),
    }
    touching, alone = (flattening_together(part.flattening, part.below, SLOPE) for part in (sweep, dry))
    found = predicted(fit.law, sweep)
    for group, (colour, marker) in looks.items():
        kept = sweep.columns["group"] == group
        style = {"color": colour, "marker": marker, "ls": "none", "ms": 4, "label": group}
        axes[0, 0].plot(found["W_c"][kept], sweep.load_ratio[kept], **style)
        axes[0, 1].plot(sweep.clearance[kept], sweep.load_ratio[kept], **style)
        axes[1, 0].plot(found["h_c"][kept], sweep.film_ratio[kept], **style)
        axes[1, 1].plot((touching * sweep.load_ratio)[kept], sweep.area_ratio[kept], **style)
    axes[0, 0].plot([0.0, 1.0], [0.0, 1.0], "k-", lw=1)
    axes[0, 0].set(xlabel="W_c by the curve", ylabel="W_c, solved")
    axes[0, 1].set(xscale="log", xlabel="lambda", ylabel="W_c", xlim=(2e-3, 10.0))
    axes[1, 0].plot([0.05, 5.0], [0.05, 5.0], "k-", lw=1)
    axes[1, 0].set(xscale="log", yscale="log", xlabel="h_c / sigma by the curve", ylabel="h_c / sigma, solved")
    axes[1, 1].plot(alone, dry.area_ratio, color="0.4", marker="x", ls="none", ms=4, label="dry")
    steps = np.linspace(1e-3, 0.75, 100)
    axes[1, 1].plot(steps, fit.law.area_ratio(1.0, steps, np.inf), "k-", lw=1, label="W_c = 1")
    axes[1, 1].set(xlabel="s_A W_c", ylabel="A_c")
    for panel in axes.ravel():
        panel.spines[["top", "right"]].set_visible(False)
        panel.grid(color="0.93")
        panel.legend(frameon=False, fontsize="small")
    return figure
