"""Traction of an oil against the slide-to-roll ratio: a liquid at small slip, limited by its stress at large slip."""

from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from contact_core import Scene, advance, initial_state

smooth = {f"surface_{body}.{key}": "0 nm" for body in (1, 2) for key in ("rq", "microroughness.rms")}
scene = Scene.from_toml("mtm_zddp", {"film.model": "regression", "tribofilm.model": "none"} | smooth)
state, point = initial_state(scene), scene.operation.point
ratios, speed = np.geomspace(1e-3, 0.5, 25), 2.0  # m/s
figure, axis = plt.subplots(figsize=(6.0, 3.6), layout="constrained")
curves = {}
for load in (10.0, 30.0, 75.0):
    traction = []
    for ratio in ratios:
        now = replace(point, load=load, speed_1=speed * (1.0 + ratio / 2.0), speed_2=speed * (1.0 - ratio / 2.0))
        traction.append(advance(scene, now, state, 1e-6)[1].friction_coefficient)
    pressure = 1e-9 * scene.hertz(load).pressure_max
    axis.semilogx(100.0 * ratios, traction, label=f"{pressure:.2f} GPa")
    curves[pressure] = np.array(traction)
    print(f"{pressure:.2f} GPa: {traction[0]:.4f} at 0.1 %, {traction[-1]:.4f} at 50 %")
axis.set(xlabel="slide-to-roll ratio [%]", ylabel="traction coefficient", ylim=(0.0, None))
axis.legend(title="Hertz pressure")
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
