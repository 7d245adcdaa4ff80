"""Two measured traces of a bearing: what of them is roughness, what the instrument's, and the surfaces that ship.

    python -m benchmarks.surfaces.finishes

Writes docs/measured/surfaces.md, and contact_core/data/surfaces/*.csv, which the sets of surfaces.toml name.
"""

import argparse
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from benchmarks.folders import ROOT
from benchmarks.pages import cells, save

Array = NDArray[np.float64]

DATA = Path(__file__).parent / "data"
SHIPPED = ROOT / "contact_core" / "data" / "surfaces"
STEPS = {"nu206_raceway": 1.736111, "nu206_roller": 1.240079}  # um
CUT_OFF = 800.0  # um, of waviness
LINE, BESIDE = (0.18, 0.285), ((0.14, 0.18), (0.285, 0.32))  # of the sampling rate: a peak, and what is beside it
WHITE = 0.42  # of it, beyond which the spectrum is level: noise
SHORTEST = 8.0  # um: of the waves that ship
BANDS = ((40.0, 80.0), (20.0, 40.0), (10.0, 20.0), (5.0, 10.0))  # um
LONGEST = 4.0  # um, of microroughness


class Spectrum(NamedTuple):
    """Variance [um^2] of the waves of a trace by frequency [1/um]: as it is, without the line, without noise either."""

    frequency: Array
    raw: Array
    without_line: Array
    roughness: Array

    def rms(self, which: Array, shortest: float, longest: float = 900.0) -> float:
        """Return the rms height [um] of the waves between two lengths [um]."""
        return float(np.sqrt(np.sum(which[self._within(shortest, longest)])))

    def length(self, which: Array, shortest: float) -> float:
        """Return the correlation length [um] of Gaussian heights with the rms height and slope of the longer waves."""
        inside = self._within(shortest, 900.0)
        slope_2 = np.sum((2.0 * np.pi * self.frequency[inside]) ** 2 * which[inside])
        return float(np.sqrt(2.0 * np.sum(which[inside]) / slope_2))

    def _within(self, shortest: float, longest: float) -> NDArray[np.bool_]:
        return (self.frequency < 1.0 / shortest) & (self.frequency > 1.0 / longest)


def levelled(name: str) -> Array:
    """Return a trace [um] without its ends, its form (a polynomial of degree 8) and its waviness."""
    z = np.loadtxt(DATA / f"{name}.csv")
    z = z[int(0.08 * z.size) : int(0.92 * z.size)]
    t = np.linspace(-1.0, 1.0, z.size)
    z = z - np.polynomial.legendre.legval(t, np.polynomial.legendre.legfit(t, z, 8))
    width = CUT_OFF / STEPS[name] * np.sqrt(np.log(2.0) / 2.0) / np.pi  # Gaussian filter of ISO 16610-21
    return np.asarray(z - gaussian_filter1d(z, width, mode="reflect"))


def spectrum(z: Array, step: float) -> Spectrum:
    """Return the spectrum of a trace [um] of a step [um]."""
    window = np.hanning(z.size)
    raw = 2.0 * np.abs(np.fft.rfft(z * window)) ** 2 / (np.sum(window**2) * z.size)
    frequency = np.fft.rfftfreq(z.size, step)
    share = frequency * step
    beside = np.any([(share > low) & (share < high) for low, high in BESIDE], axis=0)
    flat = np.where((share > LINE[0]) & (share < LINE[1]), raw[beside].mean(), raw)
    return Spectrum(frequency, raw, flat, flat - raw[share > WHITE].mean())


def shipped(name: str) -> tuple[Array, float]:
    """Return the waves of a trace [um] from 0.8 mm down to 8 um and their step [um]: as coarse as holds them."""
    z, step = levelled(name), STEPS[name]
    every = int(SHORTEST / 2.0 / step)
    waves = np.fft.rfft(z)
    waves[np.fft.rfftfreq(z.size, step) > 1.0 / SHORTEST] = 0.0
    return np.fft.irfft(waves, z.size)[::every], every * step


def row(name: str) -> list[str | float]:
    """Return a row of the page."""
    found = spectrum(levelled(name), STEPS[name])
    octave = found.rms(found.roughness, 5.0, 10.0)
    # of a Hurst exponent H the variance of all waves below a length goes with the length to the power 2 H
    below = [octave * np.sqrt((LONGEST / 10.0) ** (2 * h) / (1.0 - 0.5 ** (2 * h))) for h in (0.8, 0.5)]
    level = octave * np.sqrt(3.0)  # of octaves alike, of which three reach from 4 to 0.5 um
    raw = float(np.sqrt(found.raw.sum()))
    return [
        name,
        raw,
        1.0 - found.without_line.sum() / found.raw.sum(),
        float(np.sqrt(found.roughness.sum())),
        *(found.rms(found.roughness, low, high) for low, high in BANDS),
        *(found.length(found.roughness, least) for least in (20.0, 10.0, 6.0)),
        *(1e3 * each for each in (*below, level)),
    ]


HEAD = (
    "trace", "Rq [um]", "share of the line", "Rq without it and noise [um]",
    *(f"{low:g}-{high:g} um" for low, high in BANDS), "l, waves over 20 um", "over 10", "over 6",
    "below 4 um by H = 0.8 [nm]", "0.5", "0",
)  # fmt: skip


def write(name: str) -> None:
    """Write the heights that ship."""
    about = [line for line in (DATA / f"{name}.csv").read_text("utf-8").splitlines() if line.startswith("#")]
    z, step = shipped(name)
    own = about[2].partition("; form")[0]
    text = "\n".join([*about[:2], f"{own}. Waves of 8 um to 0.8 mm, in um, one a line, {step:.6f} um apart."])
    (SHIPPED / f"{name}.csv").write_text(text + "\n" + "\n".join(f"{each:.4f}" for each in z) + "\n", "utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.parse_args()
    for name in STEPS:
        write(name)
    lines = [
        "# Two measured traces of a bearing, and what a finish takes from them",
        "",
        "Written by `python -m benchmarks.surfaces.finishes`. Traces of a raceway and of a roller of a bearing NU206, along the axis and "
        "so across the lay (M. Ploss, MIT licence; benchmarks/surfaces/data). Form and waves over 0.8 mm are taken out.",
        "",
        cells(HEAD),
        cells(["---"] * len(HEAD)),
        *(cells(row(name)) for name in STEPS),
        "",
        "- Both traces have a peak at a quarter of their sampling rate, at waves of 6.7 um in one and of 5.0 um in the other: it follows the instrument, not "
        "the steel, and is *the line*. *Noise* is a white spectrum as high as that of the shortest waves. The autocorrelation of the raw traces falls to 1/e "
        "within 1.2 to 2.1 um by the line and the noise.",
        "- *l* is the correlation length of Gaussian heights with the rms height and the rms slope of the measured waves over 20, 10 and 6 um: no one length "
        "describes a spectrum in which each octave has about the same height.",
        "- *Below 4 um* nothing is measured: the octave of 5 to 10 um is continued with a Hurst exponent of 0.8, of 0.5 (Majumdar & Tien, Wear 136 (1990) 313, of "
        "short waves on steel of several finishes), or with octaves alike down to 0.5 um. Finishes take a fifth of Rq, and 0.08 to 0.5 of it as the interval.",
        "- Rollers NU206 and 81212 have crowns of one shape, `geometry.profile.model = \"measured\"`, whose depth at the ends is 11.3 and 13.2 um.",
        "- The sets `nu206_raceway` and `nu206_roller` are the waves of 8 um to 0.8 mm: of a trace that runs across the lay, the same all along it.",
    ]  # fmt: skip
    save("surfaces/finishes", "\n".join(lines))


if __name__ == "__main__":
    main()
