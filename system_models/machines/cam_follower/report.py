"""The report of a cam's run: a table over the angle of the cam, mean losses, wear, energy."""

import math

import xarray as xr

from contact_core.quantities import CELSIUS

from ...run.cosim_report import aligned
from ..assembly import Assembly
from .record import Record

_RPM, _NM, _MM = 30.0 / math.pi, 1e9, 1e3
LEGEND = {
    "angle": "of the cam, from the nose",
    "radius": "combined radius of the contact",
    "u cam, u follower": "surface speeds relative to the contact",
    "p_H": "Hertz pressure",
    "h_c": "mean film over the inner 2/3 of the contact",
    "lambda": "h_c / present roughness, not that of handbooks",
    "mu": "friction coefficient",
    "loss": "heat of friction at this angle",
    "tribofilm, wear": "means over the track of cam 1 and follower 2",
}
_LEAST = 1e-9  # J: no energy
_HEADS = (
    ("angle", "deg"), ("lift", "mm"), ("load", "N"), ("radius", "mm"), ("u cam", "m/s"), ("u follower", "m/s"),
    ("p_H", "MPa"), ("h_c", "nm"), ("lambda", ""), ("mu", ""), ("loss", "W"),
    ("tribofilm 1", "nm"), ("tribofilm 2", "nm"), ("wear 1", "nm"), ("wear 2", "nm"),
)  # fmt: skip


def lines(assembly: Assembly, dataset: xr.Dataset) -> list[str]:
    """Return the table and sentences."""
    record = Record(assembly, dataset)
    return [_heading(record), "", *_table(record), "", *_losses(record), *_wear(record), _energy(record)]


def _heading(record: Record) -> str:
    row = record.last
    warm = [record.of(f"head.temperature_{node}")[row] - CELSIUS for node in ("oil", "cam", "follower")]
    return (
        f"At {record.time[row]:g} s: {record.of('shaft.speed')[row] * _RPM:.0f} rpm, oil at {warm[0]:.1f} degC, cam at "
        f"{warm[1]:.1f} degC, follower at {warm[2]:.1f} degC."
    )


def _table(record: Record) -> list[str]:
    row = record.last
    scaled = {
        "load": 1.0, "radius_x": _MM, "speed_1": 1.0, "speed_2": 1.0, "h_c": _NM, "lambda_ratio": 1.0,
        "friction_coefficient": 1.0, "power_loss": 1.0, "tribofilm_1": _NM, "tribofilm_2": _NM, "wear_depth_1": _NM,
        "wear_depth_2": _NM,
    }  # fmt: skip
    found = {name: factor * record.along(name)[row] for name, factor in scaled.items()}
    pressure = 1e-6 * record.pressures(row)
    rows = [[name for name, _ in _HEADS], [unit for _, unit in _HEADS]]
    for k, station in enumerate(record.cam.contacts):
        angle = "base" if k == record.cam.stations else f"{record.angles[k]:.1f}"
        rows.append(
            [
                angle,
                f"{_MM * station.lift:.3f}",
                f"{found['load'][k]:.0f}",
                f"{found['radius_x'][k]:.2f}",
                *(f"{found[f'speed_{i}'][k]:.3f}" for i in (1, 2)),
                f"{pressure[k]:.0f}",
                f"{found['h_c'][k]:.1f}",
                f"{found['lambda_ratio'][k]:.2f}",
                f"{found['friction_coefficient'][k]:.4f}",
                f"{found['power_loss'][k]:.1f}",
                *(f"{found[f'tribofilm_{i}'][k]:.1f}" for i in (1, 2)),
                *(f"{found[f'wear_depth_{i}'][k]:.3g}" for i in (1, 2)),
            ]
        )
    return aligned(rows, 0)


def _losses(record: Record) -> list[str]:
    row = record.last
    found = [
        f"Mean over a turn: {record.of('cam.power_loss')[row]:.1f} W lost, {record.of('cam.power_rolling')[row]:.2f} W "
        f"of them by rolling; the cam is resisted by {record.of('cam.friction_torque')[row]:.3f} N m."
    ]
    least = float(record.of("cam.load_least").min())
    if least < 0.0:
        found.append(f"WARNING: the spring lacks up to {-least:.0f} N: the follower would LEAVE the cam.")
    return found


def _wear(record: Record) -> list[str]:
    """Say where most is worn."""
    found = []
    for body, name in ((1, "cam"), (2, "follower")):
        depth = record.along(f"wear_depth_{body}")[-1]
        k = int(depth.argmax())
        where = "on the base circle" if k == record.cam.stations else f"at {record.angles[k]:.1f} deg"
        found.append(f"Wear of the {name}: most {where}, {_NM * depth[k]:.3g} nm.")
    return found


def _energy(record: Record) -> str:
    found = record.energies()
    left = found["friction"] + found["thermostats"] - found["stored"] - found["to the surroundings"]
    texts = ", ".join(f"{1e-3 * value:.4g} kJ {name}" for name, value in found.items())
    share = abs(left) / max(abs(found["friction"]), _LEAST)
    return f"Energy: {texts}; {share:.2%} of the friction's, which is summed over the rows, is left."
