"""Spur gears of an FZG rig: load, sliding, film and friction along the path of contact, at load stage 10."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from system_models.runs import run_machine

STATIONS = range(1, 12)
changes = {
    "mesh.stations": "11",
    "duty.duration": "2 min",
    "duty.steps": '[{time = "1 s", torque = "265 N m"}]',
}
end = run_machine("gear_fzg_c", "results/gear", changes, checks=False, force=True).dataset.isel(time=-1)


def along(name):
    """Return an output of all stations; {} stands for their number."""
    return np.array([float(end[name.format(station)]) for station in STATIONS])


load = along("mesh.load[{}]")
sliding = along("mesh.speed_1[{}]") - along("mesh.speed_2[{}]")
friction, film = along("flank_{:02}.friction_coefficient"), along("flank_{:02}.h_c")
print(f"mean friction of the mesh {float(end['mesh.friction_coefficient_mean']):.3f}")

figure, axes = plt.subplots(1, 4, figsize=(10.5, 2.8), layout="constrained")
labels = ("load of a flank [kN]", "sliding speed [m/s]", "central film [um]", "friction coefficient")
for axis, values, label in zip(axes, (1e-3 * load, sliding, 1e6 * film, friction), labels, strict=True):
    axis.plot(STATIONS, values, "o-")
    axis.set(xlabel="station along the path", ylabel=label)
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
