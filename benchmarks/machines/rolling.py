"""Rolling resistance: both levels, starved inlets, and friction torques of bearings that mostly roll.

python -m benchmarks.machines.rolling
"""

import math
from typing import Any

import numpy as np

from benchmarks.machines.bearing_torque import machine, solved, textbooks
from benchmarks.pages import Page
from contact_core import Scene, advance, initial_state, point_contact
from contact_core.film.lengths import film_size
from contact_core.laws.viscosity import kinematic_viscosity
from contact_core.reference import hertz_point, nvm_film, rolling_beyond_point, rolling_point
from system_models.validation.rolling_torques import CIRCLE, GROOVE, RPM, ball_race, tapered_rollers
from system_models.validation.tables import read

SCENES = ("mtm_zddp", "azam_case_a", "fzg_flank", "cam_tappet", "ball_209_inner", "dimple_rolling")
MODULUS, RADIUS, PRESSURE, VISCOSITY = 2.27e11, 8e-3, 18e-9, 0.03  # Pa, m, 1/Pa, Pa s
LAYERS = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0)  # times the flooded film
OIL = (None, 100e-6, 10e-6, 3e-6, 1e-6)  # m, before each roller
LOADS = ((1000.0, 50.0), (4000.0, 50.0), (2000.0, 80.0))  # N, degC: of bearing 209
SPEEDS = (100.0, 1000.0, 3000.0, 10000.0)  # rpm


def couple(contact: Any) -> float:
    """Return the integral of (h/2) dp/dx [N] over a solved film."""
    spacing = contact.x[1] - contact.x[0]
    return 0.5 * float((contact.film * np.gradient(contact.fluid_pressure, spacing, axis=1)).sum()) * spacing**2


def levels(report: Page) -> None:
    report.say(
        "### Both levels\n\nShipped scenes at their own point, new surfaces, one block. The deterministic level has the couple of the mean film over the instants, and what lies beyond the grid in closed form."
    )
    report.header(
        "scene", "regression [mN]", "stated", "deterministic [mN]", "stated", "regression / deterministic", "W_c"
    )
    ratios, within = [], 0
    for name in SCENES:
        scenes = [Scene.from_toml(name, {"film.model": level}) for level in ("regression", "deterministic")]
        fast, deep = (advance(scene, scene.operation.point, initial_state(scene), 0.0)[1] for scene in scenes)
        one, other = fast.rolling_resistance, deep.rolling_resistance
        ratios.append(one / other)
        within += abs(one - other) <= fast.error_rolling * one
        stated = [f"{100.0 * out.error_rolling:.0f} %" for out in (fast, deep)]
        report.row(name, 1e3 * one, stated[0], 1e3 * other, stated[1], ratios[-1], deep.contact_load_ratio)
    report.verdict(
        "both levels of one sign, and within the error of the regression level",
        f"{within} of {len(SCENES)}; {min(ratios):.2f} to {max(ratios):.2f} times",
        within == len(SCENES) and min(ratios) > 0.0,
    )


def starved(report: Page) -> None:
    """Compare the law of a layer with solved films."""
    load, speed, step = 20.0, 1.0, 1.2e-5
    given: dict[str, Any] = {
        "load": load, "radius_x": RADIUS, "reduced_modulus": MODULUS, "speed_1": speed, "speed_2": speed,
        "viscosity": VISCOSITY, "pressure_viscosity": PRESSURE, "grid": (81, 61),
        "domain": (-40 * step, 20 * step, -40 * step, 40 * step),
    }  # fmt: skip
    flooded, a = point_contact(**given), hertz_point(load, RADIUS, RADIUS, MODULUS).a
    beyond = rolling_beyond_point(speed, VISCOSITY, RADIUS, RADIUS, 40 * step, 40 * step)
    whole = couple(flooded) + beyond
    formula = rolling_point(load, speed, VISCOSITY, RADIUS, RADIUS, MODULUS)
    report.say(
        f"### Short supply\n\nA ball of 8 mm, 20 N, 1 m/s, 0.03 Pa s: solved, flooded, {1e3 * whole:.3f} mN ({100.0 * beyond / whole:.0f} % of it beyond the grid), by formula {1e3 * formula:.3f} mN. A layer of oil, over the flooded film: film and rolling resistance over the flooded ones, solved, and the law, in which the inlet is full to a gap of twice the layer."
    )
    report.header("layer", "film", "rolling, solved", "rolling, law")
    off = []
    for share in LAYERS:
        short = point_contact(**given, cavitation="mass_conserving", supply=share * flooded.h_central)
        found, film = couple(short) / whole, short.h_central / flooded.h_central
        reach = math.sqrt(a**2 + 4.0 * RADIUS * share * flooded.h_central)
        far, near = (rolling_beyond_point(speed, VISCOSITY, RADIUS, RADIUS, d) / formula for d in (reach, a))
        law = film * max(1.0 - far - (1.0 - near) * (a / reach) ** 4, 0.0)
        off.append(abs(law - found))
        report.row(share, film, found, law)
    report.verdict("law of a layer within .1 of the flooded force", f"{max(off):.2f}", max(off) < 0.1)


def balls(report: Page) -> None:
    report.say(
        "### Three balls between two races\n\nBalan et al. 2015: two drops of oil, 0.05 Pa s. By formula: the regression level, flooded. Solved: smooth bodies, with the inlet full to a third and to all of the ball's radius. The closed form takes an inlet of ten half widths where elastic deformation rules and of the ball's radius where it does not."
    )
    report.header(
        "ball [mm]", "rpm", "measured [uN m]", "by formula", "stated", "solved, R/3", "solved, R", "formula / measured",
        "solved, R / measured", "lambda",
    )  # fmt: skip
    ratios, full = [], []
    for row in read("ball_race_torque.csv"):
        found, measured = ball_race(row), row["torque_uN_m"]
        third, all_of_it = (1e6 * 6.0 * CIRCLE * force for force in _solved_ball(row))
        ratios.append(1e6 * found.torque / measured)
        full.append(all_of_it / measured)
        report.row(
            row["ball_mm"], row["start_rpm"], measured, 1e6 * found.torque, f"{100.0 * found.error:.0f} %", third,
            all_of_it, ratios[-1], full[-1], found.contact.lambda_ratio,
        )  # fmt: skip
    report.verdict(
        "torques of balls, by formula, within 30 %",
        f"{min(ratios):.2f} to {max(ratios):.2f}, {sum(abs(r - 1.0) <= 0.3 for r in ratios)} of {len(ratios)}; solved with an inlet to R {min(full):.2f} to {max(full):.2f}",
        min(ratios) >= 0.7 and max(ratios) <= 1.3,
    )
    report.say(
        "What is left out: pivoting and sliding within the ellipse, hysteresis (dry torque, 2 to 12 % of the measured). How far the inlet was full was not measured; full to R it brings all but the lowest speeds within 20 %. At 60 rpm 28 % are missing still. Of the small balls the measured torque falls there with the speed to the power .12, where oil alone has about .85: a part of it is no couple of oil. Of the large ones it falls with .65, and no experiment here tells why."
    )


def _solved_ball(row: dict[str, float]) -> tuple[float, float]:
    """Return the rolling resistance [N] of smooth bodies, with an inlet full to R/3 and to R."""
    radius_x = 0.5e-3 * row["ball_mm"]
    radius_y = 1.0 / (1.0 / radius_x - 1.0 / GROOVE)
    load, speed, eta = row["load_per_ball_N"], 0.5 * CIRCLE * row["start_rpm"] * RPM, row["viscosity_Pa_s"]
    hertz = hertz_point(load, radius_x, radius_y, MODULUS)
    film = nvm_film(load, speed, eta, PRESSURE, radius_x, radius_y, MODULUS)
    size = film_size(hertz.a, radius_x, film)  # of the loaded zone along x
    step = size / 6.0
    before, beside, behind = (
        math.ceil(k * width / step) for k, width in ((12, size), (6, size * hertz.b / hertz.a), (5, size))
    )
    contact = point_contact(
        load=load, radius_x=radius_x, radius_y=radius_y, reduced_modulus=MODULUS, speed_1=speed, speed_2=speed,
        viscosity=eta, pressure_viscosity=PRESSURE, grid=(2 * beside + 1, before + behind + 1),
        domain=(-before * step, behind * step, -beside * step, beside * step),
    )  # fmt: skip
    third = couple(contact) + rolling_beyond_point(speed, eta, radius_x, radius_y, before * step, beside * step)
    reach = 0.1 * radius_x  # from there to R/3 and from 3 times that to R the same law holds
    decade = rolling_beyond_point(speed, eta, radius_x, radius_y, reach) - rolling_beyond_point(
        speed, eta, radius_x, radius_y, 3.0 * reach
    )
    return third, third + decade


def rollers(report: Page) -> None:
    report.say(
        "### Tapered roller bearing 32216\n\nWingertszahn et al. 2023: 6 kN axial, oil bath to half a roller, FVA 3. Torque of the raceways [N m]: flooded without and with inlet heating (the formula of Gupta et al.), then with a layer of oil before each contact; in brackets over the measured total."
    )
    report.header(
        "oil [degC]", "rpm", "measured", "isothermal", "flooded",
        *(f"layer {1e6 * layer:g} um" for layer in OIL if layer is not None), "SKF, rolling",
    )  # fmt: skip
    flooded, thicker, thin, heat = [], [], [], []
    law = Scene.from_toml("fzg_flank").lubricant.viscosity
    for row in read("tapered_roller_torque.csv"):
        measured, cold = row["torque_N_m"], tapered_rollers(row, "none").torque
        found = [tapered_rollers(row, layer=layer).torque for layer in OIL]
        flooded.append(found[0] / measured)
        thicker.append(found[-2] / measured)
        thin.append(found[-1] / measured)
        heat.append(1.0 - found[0] / cold)
        shown = [f"{value:.2f} ({value / measured:.2f})" for value in (cold, *found)]
        skf = skf_32216(row, float(kinematic_viscosity(law, row["oil_degC"] + 273.15)))
        report.row(row["oil_degC"], row["rpm"], measured, *shown, f"{skf:.2f} ({skf / measured:.2f})")
    report.verdict(
        "torques of tapered rollers, flooded, within 30 %", f"{min(flooded):.2f} to {max(flooded):.2f}",
        max(flooded) <= 1.3,
    )  # fmt: skip
    report.say(
        f"Flooded contacts have more than twice the measured total, and so has the rolling term of SKF at 500 rpm. Inlet heating takes {100.0 * min(heat):.0f} to {100.0 * max(heat):.0f} %, too little. Oil supply is enough: with layers of 3 and of 1 um the contacts have {max(thicker):.2f} and {min(thin):.2f} of the total at the extremes, so that about 1 um explains the rows at 500 rpm and 1 to 3 um those at 2000 and 4000. That is no proof: nobody measured the layer, and what ribs, cage and churning add is in the measured total and in no column. A layer is a number that a user gives (`lubricant.supply`). Bearings in another oil or in grease (Cruz 2021, Hu 2025) are not compared: no viscometry of it is at hand."
    )


def skf_32216(row: dict[str, float], viscosity: float) -> float:
    """Return SKF's rolling torque [N m]: its catalogue's constants of series 322, from memory, Y = 1.4."""
    nu, n, mean, bore, outside, k_z = 1e6 * viscosity, row["rpm"], 110.0, 80.0, 140.0, 6.0
    geometry = 2.31e-6 * mean**2.38 * (10.9 * 1.4 * row["axial_N"]) ** 0.31
    heating = 1.0 / (1.0 + 1.84e-9 * (n * mean) ** 1.28 * nu**0.64)
    supply = math.exp(-3e-8 * nu * n * (bore + outside) * math.sqrt(k_z / (2.0 * (outside - bore))))
    return 1e-3 * heating * supply * geometry * (nu * n) ** 0.6


def skf(report: Page) -> None:
    bearing, scene = machine(3)
    report.say(
        "### Rolling term of SKF, ball bearing 209\n\nN mm. Flooded, with inlet heating; SKF's exponents are .6 of speed and viscosity and .54 of load, those of a flooded inlet about .75 and .3. At high speed the bearing runs short of oil (SKF has a factor for it, here nothing is taken off), at low speed the fit of SKF to whole bearings is flatter than any inlet."
    )
    report.header("load [N]", "oil [degC]", "rpm", "rolling", "SKF rolling", "ratio")
    ratios = {}
    for load, celsius in LOADS:
        viscosity = float(kinematic_viscosity(scene.lubricant.viscosity, celsius + 273.15))
        for rpm in SPEEDS:
            own = solved(bearing, scene, load, celsius, rpm)[0]["rolling"]
            other = textbooks(load, celsius, rpm, viscosity)[0]["rolling"]
            ratios[load, celsius, rpm] = own / other
            report.row(load, celsius, rpm, 1e3 * own, 1e3 * other, own / other)
    middle = [ratio for (_, _, rpm), ratio in ratios.items() if 1000.0 <= rpm <= 3000.0]
    report.verdict(
        "rolling term of SKF, 1000 to 3000 rpm, within a factor of 2",
        f"{min(middle):.2f} to {max(middle):.2f}; {min(ratios.values()):.2f} to {max(ratios.values()):.2f} at all speeds",
        min(middle) >= 0.5 and max(middle) <= 2.0,
    )


def main() -> None:
    report = Page("machines/rolling", "Rolling resistance")
    levels(report)
    starved(report)
    balls(report)
    rollers(report)
    skf(report)
    report.write()


if __name__ == "__main__":
    main()
