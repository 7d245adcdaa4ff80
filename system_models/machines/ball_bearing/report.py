"""The report of a bearing's run: its contacts, torque beside SKF's and Palmgren's, heat and motion."""

import math

import xarray as xr

from contact_core.kernels.arrays import Array
from contact_core.quantities import CELSIUS

from ...run.cosim_report import aligned
from ..assembly import Assembly
from . import rating
from .lives import RatedRun
from .record import CAPPED, FEWEST, BearingRun

_RPM = 30.0 / math.pi
_NM, _NMM = 1e9, 1e3  # per m, per N m
_NOTHING = 1e-3  # nm: less of a film or wear is none
_UNLOADED = 0.5  # N: less is printed as none, and its film says nothing
_HEADS = (
    ("contacts", ""), ("balls", ""), ("load", "N"), ("p_max", "GPa"), ("h_c", "nm"), ("lambda", ""), ("mu", ""),
    ("solids", ""), ("tribofilm b", "nm"), ("tribofilm r", "nm"), ("wear b", "nm"), ("wear r", "nm"),
)  # fmt: skip
LEGEND = {
    "balls": "how many a class of contacts stands for",
    "load": "of one of them",
    "p_max": "largest pressure, after Hertz",
    "h_c": "mean film over the inner 2/3 of the contact",
    "lambda": "h_c / present roughness, not that of handbooks",
    "mu": "friction coefficient",
    "solids": "load on asperities",
    "tribofilm, wear": "mean thickness and mean wear depth on ball (b) and ring (r)",
    "P": "equivalent load",
    "kappa, a_ISO": "viscosity ratio and life factor of ISO 281",
}
_SOLIDS, _LAYERS = "contact_load_ratio", ("tribofilm_1", "tribofilm_2", "wear_depth_1", "wear_depth_2")


def lines(assembly: Assembly, dataset: xr.Dataset) -> list[str]:
    """Return contacts, torque, heat and motion, at the last moment in which the shaft turns."""
    run = BearingRun(assembly, dataset)
    row = run.last
    return [
        f"At {run.time[row]:g} s: {run.speed[row] * _RPM:.0f} rpm, {run.radial[row]:g} N radial, "
        f"{run.axial[row]:g} N axial, oil at {run.of('housing.temperature_oil')[row] - CELSIUS:.1f} degC.",
        "",
        *_contacts(run, row),
        "",
        *_torques(run, row),
        *_heat(run, row),
        *_motion(run, row),
        *_starts(run),
        "",
        *_lives(RatedRun(run), row),
    ]


def _contacts(run: BearingRun, row: int) -> list[str]:
    rows = [[name for name, _ in _HEADS], [unit for _, unit in _HEADS]]
    for which in run.classes:
        load, balls = (run.given(which, name)[row] for name in ("load", "count"))
        if balls < FEWEST:
            continue
        h_c, ratio, mu, solids, *layers = (
            run.solved(which, name)[row] for name in ("h_c", "lambda_ratio", "friction_coefficient", _SOLIDS, *_LAYERS)
        )
        pressure = 1e-9 * run.pressure(which.race, load)
        film = f"{ratio:.2f}" if ratio < CAPPED else "-"
        carried = [f"{pressure:.2f}", f"{_NM * h_c:.0f}", film, f"{mu:.4f}", f"{solids:.1%}"]
        shown = carried if load >= _UNLOADED else len(carried) * ["-"]
        rows.append([which.contact, f"{balls:.2f}", f"{load:.0f}", *shown, *map(_nanometres, layers)])
    return [*aligned(rows, 1), *_damage(run, row)]


def _damage(run: BearingRun, row: int) -> list[str]:
    """Return the largest damage by load cycles, if the contacts have a law of fatigue."""
    found = {
        (which.contact, body): float(run.solved(which, f"damage_{i}")[row])
        for which in run.classes
        for i, body in enumerate(("ball", "ring"), 1)
    }
    (contact, body), most = max(found.items(), key=lambda item: item[1])
    if most == 0.0:
        return []
    return [f"Damage by load cycles: most in the {body} of {contact}, {most:.3g} of a life so far."]


def _nanometres(length: float) -> str:
    return f"{_NM * length:.3g}" if _NM * length >= _NOTHING else "0"


def _torques(run: BearingRun, row: int) -> list[str]:
    """Return the friction torque of the contacts and by the textbooks, in parts."""
    if not run.runs[row]:
        return ["The shaft does not turn: there is no friction torque to compare."]
    found = []
    for who, parts in (("the contacts", run.torque), ("SKF", run.skf), ("Palmgren", run.palmgren)):
        values = {name: _NMM * float(part[row]) for name, part in parts.items()}
        shown = ", ".join(f"{name} {value:.3g}" for name, value in values.items())
        found.append(f"{sum(values.values()):.3g} N mm by {who} ({shown})")
    return [f"Friction torque, without drag and seals: {'; '.join(found)}."]


def _heat(run: BearingRun, row: int) -> list[str]:
    """Return the imbalance of heat, as heat flows now and as energies so far."""
    loss, left = run.of("bearing.power_loss")[row], run.of("housing.heat_to_ambient")[row]
    stored, gone = run.heat_stored, float(run.of("housing.energy_to_ambient")[-1])
    return [
        f"Heat: {loss:.4g} W from friction, {left:.4g} W to the surroundings{_warming(loss - left, loss)}.",
        f"Energy to the end: {run.heat_in:.5g} J from friction; {stored:.5g} J are stored and {gone:.5g} J gone"
        f"{_apart(stored + gone, run.heat_in)}.",
    ]


def _warming(rest: float, loss: float) -> str:
    """Return what the heat flow [W] that friction makes above that to the surroundings does to the parts."""
    share = f" ({abs(rest) / loss:.2%} of the friction's)" if loss > 0.0 else ""
    if rest < 0.0:
        return f"; the parts cool and give {-rest:.4g} W{share} of it"
    return f"; the rest, {rest:.4g} W{share}, warms the parts" if rest > 0.0 else ""


def _apart(value: float, reference: float) -> str:
    if reference <= 0.0:
        return ""
    apart = round(value / reference - 1.0, 4)
    return f", {apart:+.2%}" if apart else ", 0.00%"


def _motion(run: BearingRun, row: int) -> list[str]:
    if not run.runs[row]:
        return []
    cage, speed = run.of("bearing.cage_speed")[row], run.speed[row]
    inner, outer = (run.of(f"bearing.contact_angle_{race}")[row] for race in ("inner", "outer"))
    return [
        f"Cage: {cage * _RPM:.0f} rpm, {cage / speed:.4f} of the shaft. Largest contact angles: inner "
        f"{math.degrees(inner):.2f} deg, outer {math.degrees(outer):.2f} deg."
    ]


def _starts(run: BearingRun) -> list[str]:
    peaks = run.start_peaks
    if len(peaks) < 2:
        return []
    last = f", {_NMM * peaks[-1]:.3g} N mm in the last" if len(peaks) > 2 else ""
    return [
        f"{len(peaks)} starts: largest friction torque while the shaft turns {_NMM * peaks[1]:.3g} N mm in the second"
        f"{last}. The first is not compared: the motor may be at its speed from the beginning."
    ]


def _lives(rated: RatedRun, row: int) -> list[str]:
    """Return lives at a row and of the duty, by both standards and by the stress."""
    if not rated.run.runs[row]:
        return ["The shaft does not turn: there is no rating life."]
    listed: list[tuple[str, Array, Array | None, Array]] = [
        ("L10 of ISO 281", rated.equivalent_load, None, rated.basic),
        ("L10r of ISO 16281", rated.reference_load, None, rated.reference),
    ]
    for name, kappa in (("by viscosity", rated.kappa_of_viscosity), ("= lambda^1.3", rated.kappa_of_film)):
        listed.append((f"L10mr, kappa {name}", rated.reference_load, kappa, rated.modified(kappa)))
    listed.append(("stress integral, friction", rated.reference_load, None, rated.stressed))
    rows = [["life, 90 % survive", "P", "kappa", "a_ISO", "now", "duty repeated"], ["", "N", "", "", "h", "h"]]
    for name, load, ratio, lives in listed:
        factors = ["-", "-"] if ratio is None else [f"{ratio[row]:.3g}", f"{rated.life_factor(ratio)[row]:.3g}"]
        hours = rated.hours(lives, row), rated.hours_of_duty(lives)
        rows.append([name, _figure(load[row], ".0f"), *factors, *(_figure(each, ".4g") for each in hours)])
    return [*aligned(rows, 1), *_rated_by(rated, row)]


def _figure(value: float, digits: str) -> str:
    return format(value, digits) if math.isfinite(value) else "-"


def _rated_by(rated: RatedRun, row: int) -> list[str]:
    geometry = rated.run.bearing.dimensions
    own = rating.dynamic_rating(geometry)
    given = f"{1e-3 * rated.dynamic_rating:.1f} kN of the file (by ISO 281 {1e-3 * own:.1f} kN)"
    rated_with = given if rated.given.dynamic_rating else f"{1e-3 * own:.1f} kN by ISO 281 from the dimensions"
    found = [
        f"C_r = {rated_with}, C_u = {1e-3 * rated.fatigue_load_limit:.2f} kN, contamination e_C = "
        f"{rated.given.contamination:g}. lambda = {rated.film_ratio[row]:.3g}: our h_c over the undeformed roughness "
        "of the loaded class that has least. Stress integral: L10r of smooth contacts with our friction, no a_ISO. "
        f"The run takes {rated.consumed(rated.reference):.2g} of L10r."
    ]
    for kappa, name in ((rated.kappa_of_viscosity, "by viscosity"), (rated.kappa_of_film, "by lambda")):
        below = (kappa < rating.LEAST_KAPPA) & rated.run.runs
        if below.any():
            found.append(
                f"kappa {name} is below {rating.LEAST_KAPPA:g}, where ISO 281 has no a_ISO, in {below.mean():.1%} of "
                f"the rows, down to {kappa[below].min():.2g}: taken as {rating.LEAST_KAPPA:g}."
            )
    return found
