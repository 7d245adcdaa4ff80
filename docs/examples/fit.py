"""Two constants of a tribofilm fitted to its thickness at two temperatures: they are found again, with intervals."""

import csv
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from contact_core import Scene, advance, initial_state
from system_models.cli.main import main

# in place of a rig: films by constants that the fit does not know, with a scatter of 4 nm
SCENE = {"film.points": "65", "tribofilm.set": "gosvami", "control.change": "20 nm"}
TRUE = {"tribofilm.full_thickness": "150 nm", "tribofilm.activation_energy": "0.79 eV"}
rig = Scene.from_toml("mtm_zddp", SCENE | TRUE).at_level("regression")
random, rows = np.random.default_rng(1), []
for celsius in (60, 80):
    point, state = replace(rig.operation.point, temperature=celsius + 273.15), initial_state(rig)
    for minutes in range(10, 130, 10):
        state, out = advance(rig, point, state, 600.0)
        rows.append((minutes, celsius, 1e9 * out.tribofilm_1 + random.normal(0.0, 4.0)))
table = "\n".join(f"{minutes},{celsius},{film:.1f}" for minutes, celsius, film in rows)
Path("films.csv").write_text(f"time [min],temperature [degC],tribofilm_1 [nm]\n{table}\n", "utf-8")

settings = [f"{key}={value}" for key, value in SCENE.items()]
constants = ["tribofilm.full_thickness=50 nm:300 nm", "tribofilm.activation_energy=0.6 eV:1 eV"]
main(["fit", "films.csv", "mtm_zddp", "--set", *settings, "--vary", *constants, "--out", "results/fit", "--force"])

with Path("results/fit/fit.csv").open(encoding="utf-8") as file:
    fitted = list(csv.DictReader(file))
figure, axis = plt.subplots(figsize=(6.0, 3.8), layout="constrained")
for colour, celsius in (("C0", 60), ("C1", 80)):
    test = [row for row in fitted if round(float(row["temperature [K]"]) - 273.15) == celsius]
    time, measured, curve, low, high = (
        np.array([float(row[name]) for row in test]) for name in ("time [s]", "measured", "curve", "low", "high")
    )
    axis.plot(time / 60.0, 1e9 * measured, "o", color=colour, label=f"{celsius} degC")
    axis.plot(time / 60.0, 1e9 * curve, color=colour)
    axis.fill_between(time / 60.0, 1e9 * low, 1e9 * high, color=colour, alpha=0.2)
axis.set(xlabel="time [min]", ylabel="tribofilm on the ball [nm]", ylim=(0.0, None))
axis.legend()
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
