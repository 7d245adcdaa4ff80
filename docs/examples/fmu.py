"""A contact as an FMU in fmpy: load and speed steps from a host, with the friction that it answers."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from fmpy import simulate_fmu

from contact_core import Scene
from fmu_src.package.build import build

scene = Scene.from_toml("mtm_zddp", {"film.model": "regression"})
fmu = build(scene, Path("contact.fmu"), "embedded")

columns = [("time", float), ("load", float), ("speed_1", float), ("speed_2", float)]
steps = np.array(
    [(0.0, 50.0, 0.1025, 0.0975), (20.0, 50.0, 0.1025, 0.0975), (20.0, 20.0, 0.1025, 0.0975),
     (40.0, 20.0, 0.1025, 0.0975), (40.0, 20.0, 1.025, 0.975), (60.0, 20.0, 1.025, 0.975)], columns,
)  # fmt: skip
outputs = ["friction_force", "friction_coefficient", "h_c", "valid"]
result = simulate_fmu(str(fmu), stop_time=60.0, output_interval=0.5, input=steps, output=outputs)
print(f"friction at the ends of the steps: {result['friction_force'][[38, 78, 118]].round(2)} N")

figure, axes = plt.subplots(1, 3, figsize=(9.5, 3.0), layout="constrained")
for axis, name, factor, label in zip(
    axes, outputs, (1, 1, 1e9), ("friction on body 1 [N]", "friction coefficient", "central film [nm]"), strict=False
):
    axis.plot(result["time"], factor * result[name])
    axis.set(xlabel="time [s]", ylabel=label)
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
