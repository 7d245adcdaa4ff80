"""Friction torques of bearings that mostly roll, beside the rolling resistance of their contacts by formula."""

import math
from typing import NamedTuple

from scipy.optimize import brentq

from contact_core import OperatingPoint, Outputs, Scene, advance, initial_state
from contact_core.quantities import CELSIUS

from .model import Cause, Outcome, Row, exactly, relative
from .tables import read

RPM = math.pi / 30.0
CIRCLE, GROOVE = 18e-3, 4.16e-3  # m: radii of the ball circle, and of the raceway across
ROLLERS, ROLLER, LENGTH, PITCH = 16, 17e-3, 22.7e-3, 108.5e-3  # of the 32216, lengths in m
OUTER, INNER = math.radians(14.17), math.radians(11.5)  # half angles of the raceways
PRINTED, READ = 0.15, 0.08  # relative: dry torque within the measured one, and its radius; reading off a figure
ANY_TEMPERATURE = {"film.model": "regression", "tribofilm.beyond_fit": "extrapolate"}


class Rolling(NamedTuple):
    """A torque by the rolling resistance of all contacts [N m], its relative error, and the last contact's outputs."""

    torque: float
    error: float
    contact: Outputs


def ball_race(row: dict[str, float]) -> Rolling:
    """Return the torque of three balls between two races, six contacts, of which each turns with half the speed."""
    radius_x = 0.5e-3 * row["ball_mm"]
    radius_y = 1.0 / (1.0 / radius_x - 1.0 / GROOVE)
    scene = Scene.from_toml("ball_209_inner", ANY_TEMPERATURE | {
        "geometry.radius_x": f"{radius_x} m", "geometry.radius_y": f"{radius_y} m",
        "surface_1.rq": "30 nm", "surface_2.rq": "60 nm", "operation.load": f"{row['load_per_ball_N']} N",
    })  # fmt: skip

    def thick(kelvin: float) -> float:
        return float(scene.lubricant.viscosity(0.0, kelvin)) - row["viscosity_Pa_s"]

    speed = 0.5 * CIRCLE * row["start_rpm"] * RPM
    warm = float(brentq(thick, 260.0, 420.0))  # where a mineral oil of another grade is as thick
    point = OperatingPoint(load=row["load_per_ball_N"], speed_1=speed, speed_2=speed, temperature=warm)
    found = advance(scene, point, initial_state(scene), 0.0)[1]
    return Rolling(6.0 * CIRCLE * found.rolling_resistance, found.error_rolling, found)


def tapered_rollers(row: dict[str, float], inlet: str = "gupta", layer: float | None = None) -> Rolling:
    """Return the torque of the rollers on both raceways.

    `inlet`: heat.inlet_shear; `layer`: oil on both surfaces before each contact [m], None: flooded.
    """
    turn, share = row["rpm"] * RPM, ROLLER * math.cos(OUTER) / PITCH
    speed = 0.25 * turn * PITCH * (1.0 - share**2)  # of the rollers' pitch circle past either raceway
    point = OperatingPoint(
        load=row["axial_N"] / (ROLLERS * math.sin(OUTER)), speed_1=speed, speed_2=speed,
        temperature=row["oil_degC"] + CELSIUS,
    )  # fmt: skip
    torque, error = 0.0, 0.0
    for side in (-1.0, 1.0):  # inner and outer raceway
        given = ANY_TEMPERATURE | {
            "geometry.radius_x": f"{0.5 * ROLLER * (1.0 + side * share)} m", "geometry.face_width": f"{LENGTH} m",
            "surface_1.rq": "0.113 um", "surface_2.rq": "0.113 um", "heat.inlet_shear": inlet,
        }  # fmt: skip
        if layer is not None:
            given |= {"lubricant.supply.model": "film", "lubricant.supply.thickness": f"{layer} m"}
            given |= {"lubricant.cavitation": "mass_conserving"}
        scene = Scene.from_toml("fzg_flank", given)
        found = advance(scene, point, initial_state(scene), 0.0)[1]
        torque += ROLLERS * 2.0 * speed * found.rolling_resistance / turn
        error = max(error, found.error_rolling)
    return Rolling(torque, error, found)


def _ball_rows() -> list[Row]:
    rows = []
    for row in read("ball_race_torque.csv"):
        found, measured = ball_race(row), row["torque_uN_m"]
        computed = 1e6 * found.torque
        rows.append(Row(
            f"3 balls of {row['ball_mm']:g} mm, {row['start_rpm']:g} rpm", "uN m", exactly(measured), computed,
            relative(measured, PRINTED), "dry torque, 2 to 12 %, is in it; radius of the ball circle by catalogue",
            found.error * computed,
            Cause(
                "solved films with an inlet full as far as the radius of the ball, not a third of it, have .71 to 1.08 "
                "of the measured torques (docs/measured/machines.md#rolling-resistance); how full it was is not known",
                0.45 * measured, measured,
            ),
        ))  # fmt: skip
    return rows


def _roller_rows() -> list[Row]:
    rows = []
    for row in read("tapered_roller_torque.csv"):
        found, measured = tapered_rollers(row), row["torque_N_m"]
        rows.append(Row(
            f"32216, {row['rpm']:g} rpm, {row['oil_degC']:g} degC", "N m", exactly(measured), found.torque,
            relative(measured, READ), "read off a figure", found.error * found.torque,
            Cause(
                "a bath may not keep every inlet full: with a layer of 1 to 3 um of oil before each roller the "
                "contacts have .41 to 1.51 of the measured torque (docs/measured/machines.md#rolling-resistance); it "
                "was not measured",
                measured, 2.6 * measured,
            ),
        ))  # fmt: skip
    return rows


def run() -> Outcome:
    """Compare torques of both bearings."""
    return Outcome((*_ball_rows(), *_roller_rows()))
