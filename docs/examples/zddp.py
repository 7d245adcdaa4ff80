"""Two hours of a mini traction machine, with ZDDP and without: the tribofilm grows, and saves the steel."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from contact_core import Scene, advance, initial_state

MINUTES = np.arange(0, 121)
figure, axes = plt.subplots(1, 3, figsize=(9.5, 3.2), layout="constrained")
runs = {}
for name, changes in (("ZDDP", {}), ("without", {"tribofilm.model": "none"})):
    scene = Scene.from_toml("mtm_zddp", {"film.model": "regression"} | changes)
    state, rows = initial_state(scene), []
    for step in (1e-3, *120 * [60.0]):  # s
        state, out = advance(scene, scene.operation.point, state, step)
        rows.append(out)
    runs[name] = rows
    print(f"{name}: friction {out.friction_coefficient:.3f}, tribofilm {1e9 * out.tribofilm_2:.0f} nm on the disc, "
          f"wear of the ball {1e9 * out.wear_depth_1:.0f} nm")  # fmt: skip
    for axis, key, factor in zip(
        axes, ("tribofilm_2", "friction_coefficient", "wear_depth_1"), (1e9, 1, 1e9), strict=True
    ):
        axis.plot(MINUTES, [factor * getattr(row, key) for row in rows], label=name)
for axis, label in zip(
    axes, ("tribofilm on the disc [nm]", "friction coefficient", "wear of the ball [nm]"), strict=True
):
    axis.set(xlabel="time [min]", ylabel=label)
axes[2].legend()
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
