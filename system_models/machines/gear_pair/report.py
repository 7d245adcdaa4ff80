"""The report of a gear pair's run: load stages beside the textbook, safety factors, wear along the flanks, heat."""

from dataclasses import asdict

import numpy as np
import xarray as xr

from contact_core.kernels.arrays import Array
from contact_core.quantities import CELSIUS

from ...run.cosim_report import aligned
from ..assembly import Assembly
from ..report import heat_stored
from .rating import Rating
from .record import Record, Stage
from .safety import Safeties
from .textbook import ohlendorf

_MOST_ROWS = 16
_HEADS = (
    ("stage", ""), ("until", "min"), ("n1", "rpm"), ("T1", "N m"), ("p_H at C", "MPa"), ("lambda", ""),
    ("mu_mz", ""), ("Schlenk", ""), ("ISO/TR-1", ""), ("loss", "W"), ("oil", "degC"), ("pinion", "degC"),
    ("wheel", "degC"), ("flash", "K"), ("wear 1", "nm"), ("wear 2", "nm"),
)  # fmt: skip
_SAFETY_HEADS = (
    ("stage", ""), ("T1", "N m"), ("lambda_GF", ""), ("S_lambda", ""), ("h_c/Ra", "run"), ("S_lambda", "run"),
    ("bulk", "degC"), ("theta_B", "degC"), ("S_B", ""), ("theta_int", "degC"), ("S_intS", ""), ("hottest", "degC, run"),
    ("S_B", "run"),
)  # fmt: skip
LEGEND = {
    "stage": "of FZG's load stages where the duty has their torques, else counted from 1",
    "n1, T1": "speed and torque of the pinion",
    "p_H at C": "Hertz pressure at the pitch point, one pair carrying all",
    "lambda": "least and largest h_c / present roughness along the path",
    "mu_mz": "mean friction of the mesh, from its loss",
    "Schlenk, ISO/TR-1": "the same by formula",
    "loss": "of sliding and rolling",
    "oil, pinion, wheel": "temperatures",
    "flash": "largest rise above the bodies",
    "wear 1, wear 2": "largest depth on pinion and wheel",
    "lambda_GF, S_lambda": "film ratio and safety against micropitting by ISO/TS 6336-22",
    "h_c/Ra": "the least by the run",
    "bulk, theta_B, theta_int, hottest": "temperatures: of the bodies, of flash, integral, and by the run",
    "S_B, S_intS": "safety against scuffing",
}
_PROFILE = 7.5e-6  # m, mean deviation of the profile with which an oil fails the test of FVA 54/7


def lines(assembly: Assembly, dataset: xr.Dataset) -> list[str]:
    """Return a table of the load stages, and sentences."""
    record = Record(assembly, dataset)
    if not record.stages:
        return ["The duty has no stretch in which the gears turn under load.", *_heat(record)]
    return [*_table(record), "", *_notes(record), *_wear(record), *_heat(record), "", *_safety(record)]


def _table(record: Record) -> list[str]:
    shown = record.shown(_MOST_ROWS)
    rows = [[name for name, _ in _HEADS], [unit for _, unit in _HEADS], *(_row(record, stage) for stage in shown)]
    left = len(record.stages) - len(shown)
    return [*aligned(rows, 0), *([f"... and {left} stages more, in the files."] if left else [])]


def _row(record: Record, stage: Stage) -> list[str]:
    """Return the values at the end of a stage; flash is the largest in it."""
    row = stage.last
    ratio, formula = record.along("lambda_ratio")[row], record.textbook(row)
    warm = [record.of(f"gearbox.temperature_{node}")[row] - CELSIUS for node in ("oil", "pinion", "wheel")]
    worn = [1e9 * record.along(f"wear_depth_{body}")[row].max() for body in (1, 2)]
    iso = f"{formula.iso_14179_1:.4f}"
    return [
        str(stage.number),
        f"{stage.end / 60.0:.4g}",
        f"{30.0 / np.pi * record.of('shafts.speed_1')[row]:.0f}",
        f"{record.of('shafts.mesh_torque')[row]:.1f}",
        f"{1e-6 * record.pressure_at_pitch_point(record.of('shafts.mesh_torque')[row]):.0f}",
        f"{ratio.min():.2f}-{ratio.max():.2f}",
        f"{record.friction[row]:.4f}",
        f"{formula.schlenk:.4f}",
        iso if formula.covered else f"({iso})",
        f"{record.of('mesh.power_loss')[row]:.0f}",
        *(f"{value:.1f}" for value in warm),
        f"{record.of('mesh.flash_temperature_rise')[stage.rows].max():.1f}",
        *(f"{depth:.3g}" for depth in worn),
    ]


def _notes(record: Record) -> list[str]:
    row = record.stages[-1].last
    return [
        "At the end of each stage; flash: largest in it. Wear 1: largest depth on the pinion, 2: on the wheel. "
        f"Schlenk: Ra = {1e6 * record.roughness:.2f} um, X_L = 1. ISO/TR 14179-1 in brackets: beyond its range.",
        f"Loss factor H_V: {record.of('mesh.loss_factor')[row]:.4f} under the loads as they are, "
        f"{ohlendorf(record.pair):.4f} by Ohlendorf.",
    ]


def _safety(record: Record) -> list[str]:
    """Return a table of safety factors, by the standards and by the run, and what they start from."""
    found = Safeties(record)
    rows = [[name for name, _ in _SAFETY_HEADS], [unit for _, unit in _SAFETY_HEADS]]
    rows += [_safety_row(record, found, stage) for stage in record.shown(_MOST_ROWS)]
    rating, some = found.rating, found.scuffing(record.stages[-1].last)
    return [
        "Safety factors at the end of each stage",
        "",
        *aligned(rows, 0),
        "",
        f"Micropitting by ISO/TS 6336-22: least h_Y / Ra over 1.4 W_W {found.failing:.3f}, with which the oil fails "
        f"load stage {rating.micropitting_stage} of FVA 54/7. By the run: least h_c / Ra of the flanks as they are "
        f"over 1.4 W_W {found.own_failing:.3f}, that of such contacts in the same test with new flanks.",
        f"Scuffing at {some.flash.limit - CELSIUS:.0f} degC of flash temperature (ISO/TS 6336-20)"
        + (f", {some.integral.limit - CELSIUS:.0f} degC of integral temperature (-21)" if some.integral else "")
        + f", as the oil fails load stage {rating.scuffing_stage} of A/8.3/90. By the run: bulk and flash of the "
        "hottest contact, against the former. Loads of the standards: as the machine shares them, K factors 1.",
        *_assumed(record),
        *_classes(record, found),
    ]


def _safety_row(record: Record, found: Safeties, stage: Stage) -> list[str]:
    pits, seizes = found.micropitting(stage.last), found.scuffing(stage.last)
    integral = seizes.integral
    return [
        str(stage.number),
        f"{record.of('shafts.mesh_torque')[stage.last]:.1f}",
        f"{pits.standard:.3f}",
        _factor(pits.safety),
        f"{pits.own:.2f}",
        _factor(pits.own_safety),
        f"{found.films(stage.last).bulk - CELSIUS:.0f}",
        f"{seizes.flash.temperature.max() - CELSIUS:.0f}",
        _factor(seizes.flash.safety),
        f"{integral.temperature - CELSIUS:.0f}" if integral else "-",
        _factor(integral.safety) if integral else "-",
        f"{seizes.own - CELSIUS:.0f}",
        _factor(seizes.own_safety),
    ]


def _factor(value: float) -> str:
    return f"{value:.2f}" if value < 100.0 else ">100"


def _assumed(record: Record) -> list[str]:
    """Return a sentence on what the standards need and the machine's file does not say."""
    if "rating" in record.assembly.reported:
        return []
    values = ", ".join(f"{key} = {value:g}" for key, value in asdict(Rating()).items())
    return [f"ASSUMED, as the file has no table [rating]: {values}."]


def _classes(record: Record, found: Safeties) -> list[str]:
    """Return a sentence on the class of FVA 54/7, if the run is such a test."""
    both = found.classes()
    if both is None:
        return []
    worn = max(float(record.along(f"wear_depth_{body}")[-1].max()) for body in (1, 2))
    return [
        f"Class of FVA 54/7 with these flanks: {both[0]} by the standard, {both[1]} by the run (low: fails up to load "
        "stage 7, medium: 8 or 9, high: later). It fails once the ratio is nearer to that of the load stage at which "
        "the oil fails its test than to that of the one before.",
        f"Profile: {1e6 * worn:.2f} um of mild wear, of the {1e6 * _PROFILE:g} um that the test allows; micropits are "
        "not in it.",
    ]


def _wear(record: Record) -> list[str]:
    """Return the places of the most and the least wear."""
    pitch, found = record.pair.pitch_point, []
    for body, gear in ((1, "pinion"), (2, "wheel")):
        depth = record.along(f"wear_depth_{body}")[-1]
        most, least = (float(record.positions[k]) for k in (depth.argmax(), depth.argmin()))
        found.append(
            f"Wear of the {gear}: most at {1e3 * most:.2f} mm from T1 ({1e9 * depth.max():.3g} nm), least at "
            f"{1e3 * least:.2f} mm ({1e9 * depth.min():.3g} nm); C is at {1e3 * pitch:.2f} mm."
        )
        found += _pitted(record, body, gear)
    return found


def _pitted(record: Record, body: int, gear: str) -> list[str]:
    """Return where most of a gear has broken out, if the contacts have a law of fatigue."""
    area, damage = (record.along(f"{name}_{body}")[-1] for name in ("micropitted_area", "damage"))
    if not damage.any():
        return []
    most, factor = float(record.positions[area.argmax()]), 1.0 + record.along("error_damage")[-1].max()
    return [
        f"Micropits of the {gear}: most at {1e3 * most:.2f} mm from T1 ({area.max():.2%} of the flank there), "
        f"{area.mean():.2%} on average; error of damage: a factor of {factor:.3g} either way at most."
    ]


def _heat(record: Record) -> list[str]:
    """Return heat now, and energy since the start."""
    lost, given = record.of("mesh.power_loss"), _thermostats(record, "heater_power")
    out = float(record.of("gearbox.heat_to_ambient")[-1])
    now = float(lost[-1] + given[-1])
    stored = heat_stored(record.assembly, record.dataset, "gearbox")
    energies = {
        "friction": float(np.trapezoid(lost, record.time)),
        "thermostats": float(_thermostats(record, "heater_energy")[-1]),
        "stored": stored,
        "gone": float(record.of("gearbox.energy_to_ambient")[-1]),
    }
    inside = energies["friction"] + energies["thermostats"]
    open_ = abs(inside - stored - energies["gone"]) / max(abs(energies["friction"]), 1e-9)
    return [
        f"Heat at the end: {lost[-1]:.1f} W from the mesh and {given[-1]:.1f} W from thermostats come in, {out:.1f} W "
        f"leave: {abs(now - out) / max(abs(out), 1e-9):.2%} apart.",
        f"Energy: {1e-6 * energies['friction']:.4g} MJ from the mesh, {1e-6 * energies['thermostats']:.4g} MJ from "
        f"thermostats, {1e-6 * stored:.4g} MJ stored, {1e-6 * energies['gone']:.4g} MJ gone; {open_:.2%} of the "
        "mesh's, which is summed over the rows, is left.",
    ]


def _thermostats(record: Record, quantity: str) -> Array:
    """Return the sum over the thermostats of the gearbox, by row."""
    names = [str(name) for name in record.dataset if str(name).startswith(f"gearbox.{quantity}_")]
    return np.asarray(sum((record.of(name) for name in names), np.zeros(len(record.time))))
