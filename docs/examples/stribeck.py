"""A Stribeck curve of a rough steel ball in oil: from solids that carry the load to a full film."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from contact_core import Scene, advance, initial_state

SETTINGS = {"film.model": "regression", "tribofilm.model": "none", "surface_2.rq": "40 nm"}
speeds = np.geomspace(0.01, 10.0, 31)  # m/s, of entrainment; 5 % more and less than it on ball and disc
outputs = []
for speed in speeds:
    changes = {"operation.speed_1": f"{1.025 * speed} m/s", "operation.speed_2": f"{0.975 * speed} m/s"}
    now = Scene.from_toml("mtm_zddp", SETTINGS | changes)
    _, out = advance(now, now.operation.point, initial_state(now), 1e-3)
    outputs.append(out)
friction, error, share, film = (
    np.array([getattr(out, name) for out in outputs])
    for name in ("friction_coefficient", "error_friction", "contact_load_ratio", "h_c")
)
print(f"friction {friction[0]:.3f} at {speeds[0]} m/s, {friction[-1]:.3f} at {speeds[-1]:g} m/s")

figure, (top, bottom) = plt.subplots(2, 1, figsize=(6.0, 4.6), layout="constrained", sharex=True)
top.fill_between(speeds, friction * (1.0 - error), friction * (1.0 + error), alpha=0.25, label="stated error")
top.semilogx(speeds, friction, label="friction coefficient")
top.semilogx(speeds, 0.13 * share, "--", label="0.13 (dry steel) times the solids' share of the load")
bottom.semilogx(speeds, 1e9 * film)
top.set_ylim(0.0, 0.2)
top.legend(loc="upper right", fontsize="small")
bottom.set(ylim=(0.0, None), xlabel="entrainment speed [m/s]", ylabel="central film [nm]")
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
