"""A ball bearing at 3000 rpm warms up from 20 degC: its oil thins, so the torque falls, and with it the film."""

from pathlib import Path

import matplotlib.pyplot as plt

from system_models.runs import run_machine

changes = {
    "shaft.initial_speed": "3000 rpm",
    "duty.speed": "3000 rpm",
    "duty.steps": "[]",
    "duty.duration": "1 h",
    "bearing.levels": "2",
}
run = run_machine("bearing_209", "results/bearing", changes, checks=False, force=True).dataset
minutes = run["time"] / 60.0
figure, axes = plt.subplots(1, 3, figsize=(9.5, 3.2), layout="constrained")
axes[0].plot(minutes, 1e3 * run["bearing.friction_torque"])
axes[0].set_ylabel("friction torque [N mm]")
for node in ("balls", "inner", "outer", "oil"):
    axes[1].plot(minutes, run[f"housing.temperature_{node}"] - 273.15, label=node)
axes[1].set_ylabel("temperature [degC]")
axes[1].legend()
for race in ("inner", "outer"):
    axes[2].plot(minutes, 1e9 * run[f"{race}_2.h_c"], label=f"{race} race")
axes[2].set_ylabel("film of the most loaded balls [nm]")
axes[2].legend()
for axis in axes:
    axis.set(xlabel="time [min]", ylim=(0.0, None))
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
