"""Rigid sliders: pressure and oil of one-dimensional films in closed form, with cavitation that conserves mass."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy  # its parts are loaded at their first use
from numpy.typing import ArrayLike

from contact_core.kernels.arrays import Array


@dataclass(frozen=True)
class ParabolicSlider:
    """A rigid roller, h = h_0 + x^2 / (2 R), over which oil of constant viscosity is drawn from -x to +x.

    The film is full from the inlet on; it breaks where pressure and its slope vanish, and from there on the oil is
    carried along in streamers (Jakobsson & Floberg, Olsson). With x = sqrt(2 R h_0) tan(t) the pressure is
    12 eta u_e sqrt(2 R h_0) / h_0^2 {I(t) - I(t_in)}, I of cos^2(t) - cos^4(t) / cos^2(t_out).
    Source: Martin, Engineering 102 (1916) 119, for Sommerfeld's film; here with Reynolds' outlet.
    """

    gap: float  # h_0 [m]
    radius: float  # [m]
    viscosity: float  # [Pa s]
    entrainment_speed: float  # u_e = (u1 + u2) / 2 [m/s]
    inlet: float = -math.inf  # where the film becomes full [m], < 0

    @staticmethod
    def supplied(
        supply: float, gap: float, radius: float, viscosity: float, entrainment_speed: float
    ) -> "ParabolicSlider":
        """Return the slider whose surfaces bring a layer of oil [m], both together.

        It is thicker than gap, thinner than flooded.

        The oil that comes is the oil that leaves, so the outlet is known, and the inlet is where the pressure is zero.
        """
        flooded = ParabolicSlider(gap, radius, viscosity, entrainment_speed)
        if not gap < supply < flooded.film:
            raise ValueError(
                f"supply = {supply:g} m must lie between gap = {gap:g} m and the {flooded.film:g} m that a flooded "
                "slider lets through."
            )
        out = math.acos(math.sqrt(gap / supply))
        inlet = scipy.optimize.brentq(lambda t: _integral(out, out) - _integral(t, out), -0.5 * math.pi, -out)
        return ParabolicSlider(gap, radius, viscosity, entrainment_speed, flooded._length * math.tan(inlet))

    @property
    def _length(self) -> float:
        return math.sqrt(2.0 * self.radius * self.gap)

    @property
    def _start(self) -> float:
        return math.atan(self.inlet / self._length)

    @cached_property
    def _end(self) -> float:
        start = self._start
        return float(
            scipy.optimize.brentq(lambda t: _integral(t, t) - _integral(start, t), 0.0, min(-start, 0.6), xtol=1e-15)
        )

    @property
    def outlet(self) -> float:
        """Position of the film rupture [m]."""
        return self._length * math.tan(self._end)

    @property
    def film(self) -> float:
        """Flow of oil over u_e [m]: the gap at the largest pressure and at the film rupture."""
        return self.gap / math.cos(self._end) ** 2

    def pressure(self, x: ArrayLike) -> Array:
        """Return the pressure [Pa] at x [m]."""
        x = np.asarray(x)
        t = np.clip(np.arctan(x / self._length), self._start, self._end)
        scale = 12.0 * self.viscosity * self.entrainment_speed * self._length / self.gap**2
        pressure = scale * (_integral(t, self._end) - _integral(self._start, self._end))
        return np.where((x > self.inlet) & (x < self.outlet), pressure, 0.0)

    def oil(self, x: ArrayLike) -> Array:
        """Return the thickness [m] of the oil in the gap at x [m]: the gap where it is full, `film` elsewhere."""
        x = np.asarray(x)
        full = (x >= self.inlet) & (x <= self.outlet)
        return np.where(full, self.gap + x * x / (2.0 * self.radius), self.film)

    @property
    def load(self) -> float:
        """Load per length [N/m]."""
        scale = 12.0 * self.viscosity * self.entrainment_speed * (self._length / self.gap) ** 2
        start, end = self._start, self._end
        # by parts: of -tan(t) dI, because I is the same at both ends
        return scale * (_moment(start, end) - _moment(end, end))


def _integral(t: Any, end: float) -> Any:
    """Return the integral of cos^2 - cos^4 / cos(end)^2 from 0 to t."""
    second = 0.5 * t + 0.25 * np.sin(2.0 * t)
    fourth = 0.375 * t + 0.25 * np.sin(2.0 * t) + np.sin(4.0 * t) / 32.0
    return second - fourth / np.cos(end) ** 2


def _moment(t: float, end: float) -> float:
    """Return the integral of tan (cos^2 - cos^4 / cos(end)^2) from pi/2 to t."""
    c2 = math.cos(t) ** 2
    return -0.5 * c2 + 0.25 * c2 * c2 / math.cos(end) ** 2
