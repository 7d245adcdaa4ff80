"""A dimple on a rolling ball crosses the contact; the film around it follows in time (Mourier et al. 2006)."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from contact_core import Scene, initial_state, march

scene = Scene.from_toml("dimple_rolling", {"film.points": "65"})
point = scene.operation.point
crossing = scene.film.domain / point.speed_2  # s, in which the surface passes the grid

# the dimple starts in the middle, leaves on the right and comes in again from the left
times = np.linspace(0.0, 1.2 * crossing, 78)
shown = [0.75, 0.95, 1.1]  # crossings
figure, axes = plt.subplots(1, 3, figsize=(9.0, 3.2), layout="constrained", sharey=True)
middle = {}
for moment in march(scene, initial_state(scene), lambda time: point, times.tolist()):
    fields = moment.fields
    line = fields.gap[fields.gap.shape[0] // 2]
    middle[moment.time / crossing] = 1e9 * line[fields.x.size // 2]
    if shown and moment.time >= shown[0] * crossing - 1e-9:
        axis, share = axes[-len(shown)], shown.pop(0)
        axis.plot(1e6 * fields.x, 1e9 * line)
        axis.axvline(1e6 * scene.film.domain * (share - 1.0), color="grey", linestyle=":")
        axis.set(
            xlabel="x [um], along rolling", title=f"after {1e3 * moment.time:.1f} ms", xlim=(-200, 200), ylim=(0, 500)
        )
print(f"film in the middle: {min(middle.values()):.0f} to {max(middle.values()):.0f} nm")
axes[0].set_ylabel("film along the centre line [nm]")
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
