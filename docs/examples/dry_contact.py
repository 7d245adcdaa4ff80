"""Rough, dry bodies touch on an area that grows almost in proportion to the load, between two theories."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from contact_core import dry_contact

NODES, SPACING, MODULUS = 256, 0.25e-6, 230e9  # m, Pa (E')

# a self-affine surface, Hurst exponent 0.8, wavelengths from 4 um (16 nodes) to 32 um, rms slope 0.1
rng = np.random.default_rng(1)
q = 2.0 * np.pi * np.hypot(*np.meshgrid(*2 * (np.fft.fftfreq(NODES, SPACING),)))
band = (q > 2.0 * np.pi / 32e-6) & (q < 2.0 * np.pi / 4e-6)
amplitude = np.where(band, q, np.inf) ** -1.8
waves = np.fft.fft2(rng.standard_normal((NODES, NODES))) * amplitude
heights = np.fft.ifft2(waves).real
heights *= 0.1 / np.fft.ifft2(q * waves).real.std()  # rms slope 0.1

side = NODES * SPACING
pressures = MODULUS * np.array([5e-4, 1e-3, 2e-3, 4e-3])
areas = [dry_contact(heights, SPACING, np.inf, p * side**2, MODULUS).contact_area / side**2 for p in pressures]
kappa = np.array(areas) * 0.1 * (MODULUS / 2.0) / pressures  # area = kappa p / (E* rms slope)
print("kappa =", kappa.round(2))

figure, axis = plt.subplots(figsize=(6.0, 3.6), layout="constrained")
axis.plot(1e-6 * pressures, areas, "o", label="solved")
for value, name in ((np.sqrt(8.0 / np.pi), "Persson, 1.60"), (np.sqrt(2.0 * np.pi), "Bush, Gibson & Thomas, 2.51")):
    axis.plot(1e-6 * pressures, value * pressures / (MODULUS / 2.0) / 0.1, "--", label=name)
axis.set(xlabel="mean pressure [MPa]", ylabel="real over nominal area", xlim=(0.0, None), ylim=(0.0, None))
axis.legend()
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
