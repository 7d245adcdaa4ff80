"""Why rollers have a profile: pressure along the axis, by the shape of the ends."""

from pathlib import Path

import matplotlib.pyplot as plt

from contact_core import Logarithmic, Measured, Rounded, line_contact

LENGTH = 4e-3  # m
steel_and_oil = {
    "load": 300e3,  # N/m
    "radius": 8e-3,  # m
    "reduced_modulus": 230e9,
    "speed_1": 2.0,
    "speed_2": 2.0,
    "viscosity": 0.012,
    "pressure_viscosity": 17e-9,
}
long_line = line_contact(**steel_and_oil)
rollers = {
    "logarithmic, 2 um deep": Logarithmic(2e-6),
    "as measured on rollers, 11 um deep": Measured(),
    "cylinder, edges rounded by 1 mm": Rounded(straight=3.8e-3, radius=1e-3),
}
found = {
    name: line_contact(length=LENGTH, profile=profile, grid=129, **steel_and_oil) for name, profile in rollers.items()
}

figure, axis = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
for name, roller in found.items():
    print(f"{name}: {1e-9 * roller.pressure_max:.2f} GPa, least film {1e9 * roller.h_min:.0f} nm")
    axis.plot(1e3 * roller.y, 1e-9 * roller.pressure.max(axis=1), label=name)
axis.axhline(1e-9 * long_line.pressure_max, color="grey", linestyle="--", label="line without ends")
axis.set(xlabel="along the axis [mm]", ylabel="largest pressure across [GPa]", ylim=(0.0, None))
axis.legend()
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
