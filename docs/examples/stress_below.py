"""Stress below Hertz's pressure: largest at a depth without friction, at the surface with much of it."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from contact_core import graded_depths, subsurface_stress

NODES, A, PRESSURE = 97, 100e-6, 1e9  # nodes along x and y, half width [m], largest pressure [Pa]
x = np.linspace(-2.0 * A, 2.0 * A, NODES)
radius = np.hypot(*np.meshgrid(x, x))
hertz = PRESSURE * np.sqrt(np.maximum(1.0 - (radius / A) ** 2, 0.0))
depths = graded_depths(x[1] - x[0], A, layers=24)

figure, axes = plt.subplots(1, 2, figsize=(8.0, 3.0), layout="constrained", sharey=True)
largest, where = {}, {}
for axis, friction in zip(axes, (0.0, 0.4), strict=True):
    stress = subsurface_stress(hertz, friction * hertz, None, x[1] - x[0], depths)
    plane = stress.von_mises[:, NODES // 2] / PRESSURE  # below the middle, along the shear
    largest[friction] = plane.max()
    where[friction] = depths[plane.max(axis=1).argmax()] / A
    print(f"friction {friction}: von Mises {largest[friction]:.3f} p_H at a depth of {where[friction]:.2f} a")
    drawn = axis.contourf(x / A, depths / A, plane, np.linspace(0.0, 0.85, 18))
    axis.set(xlabel="x / a", title=f"friction {friction}", ylim=(1.5, 0.0))
axes[0].set_ylabel("depth / a")
figure.colorbar(drawn, ax=axes, label="von Mises stress / p_H")
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
