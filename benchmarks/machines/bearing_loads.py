"""Ball bearings: loads against textbook figures, convergence and cost of the equilibrium, error of load classes.

python -m benchmarks.machines.bearing_loads
"""

import math
import time
from itertools import product

import numpy as np
from matplotlib.figure import Figure

from benchmarks.pages import Page
from contact_core import OperatingPoint, Scene, advance, initial_state
from system_models.machines.ball_bearing.equilibrium import Equilibrium, RingLoads, solve
from system_models.machines.ball_bearing.geometry import BEARING_209, BEARING_218, RACES, BallBearingGeometry
from system_models.machines.ball_bearing.kinematics import SLIDE_COULOMB, motion
from system_models.machines.ball_bearing.load_classes import classify
from system_models.machines.ball_bearing.textbook import sjovall

MM, RPM = 10**4.5, math.pi / 30.0
BEARINGS = {"209": BEARING_209, "218": BEARING_218}
SPEEDS = (0, 1, 10, 100, 1000, 3000, 6000, 10000)  # rpm
RADIAL = (0.0, 1.0, 10.0, 100.0, 1e3, 5e3, 10e3, 20e3)  # N
AXIAL = (0.0, 1.0, 10.0, 100.0, 1e3, 5e3, 10e3)
MOMENTS = (0.0, 100.0)  # N m
LEVELS = (1, 2, 3, 5)
SJOVALL = (
    (0.2, 0.1590, 0.1707), (0.3, 0.1892, 0.2110), (0.4, 0.2117, 0.2462), (0.5, 0.2288, 0.2782),
    (0.6, 0.2416, 0.3084), (0.7, 0.2505, 0.3374), (0.8, 0.2559, 0.3658), (0.9, 0.2576, 0.3945),
    (1.0, 0.2546, 0.4244), (1.25, 0.2289, 0.5044), (2.5, 0.1339, 0.7240), (5.0, 0.0711, 0.8558),
)  # fmt: skip


def textbook(report: Page) -> None:
    report.say(
        "### Textbook figures\n\nThe examples of Harris' Rolling Bearing Analysis: deep groove bearing 209 (9 balls of "
        "12.7 mm on 65 mm, grooves of 0.52, clearance 15 um) and angular contact bearing 218 (16 balls of 22.225 mm on "
        "125.26 mm, grooves of 0.5232, 40 degrees), E 206.84 GPa, at rest. Expected: independent calculations from these inputs."
    )
    report.header("bearing", "load", "quantity", "expected", "found", "off [%]")
    off = []

    def row(bearing: str, load: str, name: str, expected: float, found: float) -> None:
        off.append(abs(found / expected - 1.0))
        report.row(bearing, load, name, f"{expected:.6g}", f"{found:.6g}", 100.0 * (found / expected - 1.0))

    b = BEARING_209
    for race, expected in (("inner", (0.20178, 0.93996, 1.0184e6)), ("outer", (0.13780, 0.91209, 1.0766e6))):
        shape = b.race(race)
        found = shape.curvature_sum * 1e-3, shape.curvature_difference, shape.stiffness / MM
        names = "sum of curvatures [1/mm]", "difference", "K [N/mm^1.5]"
        for name, e, f in zip(names, expected, found, strict=True):
            row("209", "", f"{race}: {name}", e, f)
    row("209", "", "K_n [N/mm^1.5]", 3.701e5, b.stiffness / MM)
    row("209", "", "free contact angle [deg]", 9.858, math.degrees(b.free_angle))
    row("209", "", "endplay [mm]", 0.1739, b.endplay * 1e3)
    found = solve(b, RingLoads(y=8900.0), 0.0)
    radial = "radial 8900 N"
    for j, expected in ((1, 4526.6), (2, 2840.6), (3, 61.4)):
        row("209", radial, f"load of ball {j} [N]", expected, float(found.load_inner[j - 1]))
    row("209", radial, "displacement [mm]", 0.06058, found.displacement[1] * 1e3)
    extent = 0.5 * (1.0 - b.clearance / (2.0 * found.displacement[1]))
    row("209", radial, "extent of the load zone", 0.438, extent)
    for race, expected in (("inner", (2.548, 0.2744, 3091.0)), ("outer", (2.471, 0.3387, 2582.0))):
        e = b.race(race).ellipse(float(found.load_inner.max()))
        values = e.b * 1e3, e.a * 1e3, e.pressure_max * 1e-6
        for name, want, value in zip(("long [mm]", "short [mm]", "pressure [MPa]"), expected, values, strict=True):
            row("209", radial, f"{race}: {name}", want, value)
    b = BEARING_218
    row("218", "", "distance of groove centres [mm]", 1.0312, b.separation * 1e3)
    row("218", "", "K_n [N/mm^1.5]", 4.659e5, b.stiffness / MM)
    found = solve(b, RingLoads(x=17800.0), 0.0)
    row("218", "thrust 17 800 N", "contact angle [deg]", 41.50, math.degrees(float(found.angle_inner[0])))
    row("218", "thrust 17 800 N", "load of a ball [N]", 1679.0, float(found.load_inner[0]))
    row("218", "thrust 17 800 N", "displacement [mm]", 0.0360, found.displacement[0] * 1e3)
    for race, expected in (("inner", 1525.0), ("outer", 1348.0)):
        pressure = b.race(race).ellipse(float(found.load_inner[0])).pressure_max
        row("218", "thrust 17 800 N", f"{race}: pressure [MPa]", expected, pressure * 1e-6)
    report.verdict("bearings 209 and 218 to 0.5 %", f"worst {100.0 * max(off):.2f} %", max(off) <= 5e-3)


def integrals(report: Page) -> None:
    report.say("### Sjovall's integrals")
    report.header("extent", "J_r tabulated", "J_r", "J_a tabulated", "J_a")
    worst = 0.0
    for extent, radial, axial in SJOVALL:
        r, a = sjovall(extent)
        worst = max(worst, abs(r - radial), abs(a - axial))
        report.row(extent, f"{radial:.4f}", f"{r:.6f}", f"{axial:.4f}", f"{a:.6f}")
    report.verdict("Sjovall's integrals to 4 digits", f"worst {worst:.1e}", worst < 5.1e-5)
    ratio = sjovall(1.25)[0] / sjovall(1.25)[1]
    report.say(f"J_r / J_a at an extent of 1.25 is {ratio:.4f}; Harris' table 7.4 prints .4338, a misprint of .4538.")


def convergence(report: Page) -> None:
    report.say(
        f"### Convergence\n\nAll combinations of n = {', '.join(map(str, SPEEDS))} rpm, F_r = "
        f"{', '.join(f'{f:g}' for f in RADIAL)} N, F_a = {', '.join(f'{f:g}' for f in AXIAL)} N, M = "
        f"{', '.join(f'{m:g}' for m in MOMENTS)} N m across the radial load, without a start ('cold'). Residual: largest "
        "force out of balance over the largest force, at least 1 N; converged: below 1e-9. 'Warm': each load changed "
        "by 1 % and solved again from there. Times include NumPy and Python, on the machine that wrote this page."
    )
    report.header(
        "bearing", "n [rpm]", "cases", "converged", "worst residual", "median [ms]", "99 % below [ms]", "warm [ms]",
        "warm 99 % below [ms]",
    )  # fmt: skip
    every, worst, warm_times = True, 0.0, []
    for (name, bearing), n in product(BEARINGS.items(), SPEEDS):
        residuals, cold, warm = [], [], []
        for radial, axial, moment in product(RADIAL, AXIAL, MOMENTS):
            loads = RingLoads(axial, radial, 0.0, 0.0, moment)
            first, seconds = _timed(bearing, loads, n * RPM, None)
            more = RingLoads(*(1.01 * f for f in loads))
            second, again = _timed(bearing, more, n * RPM, first.start)
            residuals += [first.residual, second.residual]
            every = every and first.converged and second.converged
            cold.append(1e3 * seconds)
            warm.append(1e3 * again)
        worst = max(worst, *residuals)
        warm_times += warm
        share = sum(r <= 1e-9 for r in residuals) / len(residuals)
        report.row(
            name, n, len(residuals) // 2, f"{100.0 * share:.1f} %", max(residuals), np.median(cold),
            np.quantile(cold, 0.99), np.median(warm), np.quantile(warm, 0.99),
        )  # fmt: skip
    report.verdict(
        "converges for n 0-10 000 rpm, F_r 0-20 kN, F_a 0-10 kN, and tilted", f"worst residual {worst:.1e}", every
    )
    median = float(np.median(warm_times))
    report.verdict("a warm solution in less than 1 ms", f"median {median:.2f} ms", median < 1.0)
    report.say(
        "A 218 without enough thrust loses its contact angle: the ring moves back until the balls touch the middle of the grooves, and at speed the contact angles reach 90 degrees and more, beyond the end of real grooves. The equilibrium assumes grooves without end; see `contact_angle_inner`."
    )


def _timed(
    bearing: BallBearingGeometry, loads: RingLoads, speed: float, start: tuple[float, ...] | None
) -> tuple[Equilibrium, float]:
    begin = time.perf_counter()
    found = solve(bearing, loads, speed, start)
    return found, time.perf_counter() - begin


def inertia(report: Page) -> None:
    report.say(
        "### Common orbit of all balls\n\nThe balls' inertia is that of the cage's speed, the mean of their own. Spread: of the orbits that follow from their contact angles, rms weighted with the inner load, and largest where the load "
        "is at least a tenth of the largest; the centrifugal force of a single ball would be off by twice that. The "
        "tilt of the ring is held."
    )
    report.header(
        "bearing", "n [rpm]", "F_a [N]", "F_r [N]", "cage / shaft", "rms [%]", "largest [%]", "F_c / Q_o max [%]"
    )
    cases = (
        ("209", 3000, 1e3, 5e3),
        ("209", 10000, 1e3, 5e3),
        ("218", 3000, 10e3, 5e3),
        ("218", 10000, 10e3, 0.0),
        ("218", 10000, 10e3, 5e3),
    )
    for name, n, axial, radial in cases:
        bearing, speed = BEARINGS[name], n * RPM
        found = solve(bearing, RingLoads(axial, radial), speed, tilt_stiffness=1e7)
        away = np.abs(found.rolling[:, 0] / found.cage - 1.0)
        mean = math.sqrt(found.load_inner @ away**2 / found.load_inner.sum())
        driven = found.load_inner > 0.1 * found.load_inner.max()
        force = 0.5 * bearing.mass * bearing.pitch_diameter * (found.cage * speed) ** 2
        report.row(
            name, n, axial, radial, found.cage, 100.0 * mean, 100.0 * away[driven].max(),
            100.0 * force / found.load_outer.max(),
        )  # fmt: skip
    report.say(
        "Where they differ by several percent, balls press on the cage's pockets or slip on the inner race. This is not modelled: each ball still rolls at its own orbit in its contacts."
    )


CASES = (
    ("209", 0.0, 1000.0, 3000),
    ("209", 0.0, 8900.0, 3000),
    ("209", 1000.0, 3000.0, 3000),
    ("209", 0.0, 2000.0, 10000),
    ("218", 17800.0, 0.0, 3000),
    ("218", 10000.0, 10000.0, 3000),
    ("218", 10000.0, 5000.0, 10000),
)


def levels(report: Page) -> list[tuple[str, list[float]]]:
    scene = Scene.from_toml("ball_209_inner").at_level("regression")
    report.say(
        "### Load classes in place of balls\n\nSums over the classes of both races against the sums over all "
        "balls: of Q^(4/3), to which friction of spin is proportional; of the power that the contacts of the scene "
        "`ball_209_inner` lose when new, with sliding and spin of each ball, and with those of each class; of their "
        "rolling resistance; and of the mean of their film, weighted with the load. In percent. The tilt of the ring is "
        "held."
    )
    report.header("bearing", "F_a [N]", "F_r [N]", "n [rpm]", "levels", "Q^(4/3)", "power", "rolling", "film")
    curves, worst = [], {k: 0.0 for k in LEVELS}
    for name, axial, radial, n in CASES:
        bearing, speed = BEARINGS[name], n * RPM
        found = solve(bearing, RingLoads(axial, radial), speed, tilt_stiffness=1e7)
        exact = _balls(scene, bearing, found, speed)
        errors = []
        for k in LEVELS:
            off = 100.0 * (_classes(scene, bearing, found, speed, k) / exact - 1.0)
            worst[k] = max(worst[k], abs(off[1]))
            errors.append(float(off[1]))
            report.row(name, axial, radial, n, k, *off)
        curves.append((f"{name}: {axial / 1e3:g}, {radial / 1e3:g} kN, {n} rpm", errors))
    said = ", ".join(f"{worst[k]:.2g} % with {k}" for k in LEVELS)
    report.say(f"Worst error of the power: {said}.")
    report.verdict("power of the default 3 levels within 1 %", f"worst {worst[3]:.2g} %", worst[3] <= 1.0)
    return curves


def _contact(scene: Scene, load: float, ball: float, ring: float, spin: float, rx: float, ry: float) -> np.ndarray:
    """Power, power of rolling and film of a new contact."""
    point = OperatingPoint(load, ball, ring, 363.15, spin, radius_x=rx, radius_y=ry)
    _, out = advance(scene, point, initial_state(scene), 0.0)
    rolling = out.rolling_resistance * (ball + ring)
    return np.array([load ** (4 / 3), out.power_loss + rolling, rolling, load * out.h_c, load])


def _mean_film(sums: np.ndarray) -> np.ndarray:
    return np.array([*sums[:3], sums[3] / sums[4]])


def _balls(scene: Scene, bearing: BallBearingGeometry, found: Equilibrium, speed: float) -> np.ndarray:
    sums = np.zeros(5)
    for name, loads in zip(RACES, (found.load_inner, found.load_outer), strict=True):
        race, moving = bearing.race(name), motion(bearing, found, name)
        sign = -1.0 if name == "inner" else 1.0
        for j in np.flatnonzero(loads > 0.0):
            load, middle = float(loads[j]), float(moving.entrainment[j])
            slide = SLIDE_COULOMB * float(moving.bend[j]) * race.ellipse(load).b ** 2
            radius = 0.5 * bearing.ball_diameter * (1.0 + sign * bearing.ratio * math.cos(moving.angle[j]))
            ball, ring = speed * (middle - 0.5 * slide), speed * (middle + 0.5 * slide)
            sums += _contact(scene, load, ball, ring, speed * abs(float(moving.spin[j])), radius, race.radius_y)
    return _mean_film(sums)


def _classes(scene: Scene, bearing: BallBearingGeometry, found: Equilibrium, speed: float, count: int) -> np.ndarray:
    sums = np.zeros(5)
    for name, loads in zip(RACES, (found.load_inner, found.load_outer), strict=True):
        race = bearing.race(name)
        c = classify(bearing, race, loads, motion(bearing, found, name), count)
        for k in range(count):
            values = (c.load[k], speed * c.ball[k], speed * c.ring[k], speed * c.spin[k], c.radius_x[k])
            sums += c.count[k] * _contact(scene, *map(float, values), race.radius_y)
    return _mean_film(sums)


def picture(report: Page, curves: list[tuple[str, list[float]]]) -> None:
    figure = Figure(figsize=(13.0, 4.2), layout="constrained")
    zone, angles, sharing = (
        figure.add_subplot(1, 3, 1, projection="polar"),
        figure.add_subplot(1, 3, 2),
        figure.add_subplot(1, 3, 3),
    )
    for radial, axial, colour in ((8900.0, 0.0, "tab:blue"), (5000.0, 2000.0, "tab:orange")):
        found = solve(BEARING_209, RingLoads(axial, radial), 0.0, tilt_stiffness=1e7)
        label = f"F_r {radial / 1e3:g}, F_a {axial / 1e3:g} kN"
        zone.bar(found.azimuth, found.load_inner / 1e3, 0.3, color=colour, alpha=0.6, label=label)
    zone.set_theta_zero_location("S")
    zone.set_title("209: loads of the balls [kN]")
    zone.legend(loc="upper left", bbox_to_anchor=(-0.2, 1.15), fontsize=8)
    speeds = np.linspace(0.0, 10000.0, 41)
    for thrust, colour in ((2000.0, "tab:blue"), (5000.0, "tab:orange"), (10000.0, "tab:green"), (17800.0, "tab:red")):
        start, inner, outer = None, [], []
        for n in speeds:
            found = solve(BEARING_218, RingLoads(x=thrust), n * RPM, start)
            start = found.start
            inner.append(math.degrees(found.angle_inner[0]))
            outer.append(math.degrees(found.angle_outer[0]))
        angles.plot(speeds, inner, color=colour, label=f"{thrust / 1e3:g} kN")
        angles.plot(speeds, outer, "--", color=colour)
    angles.set_xlabel("speed [rpm]")
    angles.set_ylabel("contact angle [deg]")
    angles.set_title("218 under thrust: inner (full), outer (dashed)")
    angles.legend(fontsize=8)
    for label, errors in curves:
        sharing.plot(LEVELS, np.maximum(np.abs(errors), 1e-3), "o-", label=label)
    sharing.set_yscale("log")
    sharing.set_xticks(LEVELS)
    sharing.set_xlabel("levels")
    sharing.set_ylabel("error of the power [%]")
    sharing.set_title("classes against all balls (F_a, F_r)")
    sharing.legend(fontsize=7)
    report.picture(figure, "bearing_loads.png", "Load zone, contact angles against speed, and error of the classes")


def main() -> None:
    report = Page("machines/bearing_loads", "Loads in ball bearings")
    textbook(report)
    integrals(report)
    solve(BEARING_209, RingLoads(1.0, 1.0), 1.0)  # compiled before it is timed
    convergence(report)
    inertia(report)
    picture(report, levels(report))
    report.write()
    print(f"wrote {report.path}")


if __name__ == "__main__":
    main()
