"""A sweep over load and roughness on the command line, and its result as one xarray Dataset."""

from pathlib import Path

import matplotlib.pyplot as plt
import xarray as xr

from system_models.cli.main import main

vary = ["operation.load=10 N:80 N:4:log", "surface_2.rq=30 nm,80 nm,150 nm"]
settings = ["film.model=regression", "operation.duration=1 s", "operation.interval=1 s"]
main(["sweep", "mtm_zddp", "--set", *settings, "--vary", *vary, "--force", "--out", "results/sweep"])

with xr.open_dataset("results/sweep/sweep.nc") as file:
    end = file.isel(time=-1).load()
figure, axes = plt.subplots(1, 2, figsize=(8.0, 3.2), layout="constrained")
for axis, name in zip(axes, ("friction_coefficient", "contact_load_ratio"), strict=True):
    for rq in end["surface_2.rq"].values:
        curve = end[name].sel({"surface_2.rq": rq})
        error = curve[f"{name}_error"]  # the stated half width of 95 %
        axis.errorbar(end["operation.load"], curve, error, capsize=3, label=f"Rq {rq:g} nm")
    axis.set(xlabel="load [N]", ylabel=name.replace("_", " "), ylim=(0.0, None))
axes[1].legend()
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
