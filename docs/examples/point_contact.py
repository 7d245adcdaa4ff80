"""Pressure and film of a ball on a flat, node by node: the horseshoe of the film, and the error of each number."""

from pathlib import Path

import matplotlib.pyplot as plt

from contact_core import point_contact

contact = point_contact(
    load=50.0,  # N
    radius_x=0.01,  # m
    reduced_modulus=230e9,  # Pa
    speed_1=0.5,  # m/s
    speed_2=0.5,
    viscosity=0.01,  # Pa s
    pressure_viscosity=18e-9,  # 1/Pa
    grid=129,
)
for name in ("h_central", "h_min", "pressure_max"):
    print(f"{name} = {getattr(contact, name):.4g} +- {contact.error_estimate[name]:.2g}")

figure, (left, right) = plt.subplots(1, 2, figsize=(8.0, 3.4), layout="constrained", sharey=True)
x, y = 1e6 * contact.x, 1e6 * contact.y
for axis, field, label in (
    (left, 1e-9 * contact.pressure, "pressure [GPa]"),
    (right, (1e9 * contact.film).clip(max=100.0), "film [nm]; 100 is 100 or more"),
):
    figure.colorbar(axis.contourf(x, y, field, 20), ax=axis, label=label)
    axis.set(xlabel="x [um], along entrainment", xlim=(-200, 200), ylim=(-200, 200), aspect="equal")
left.set_ylabel("y [um]")
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
