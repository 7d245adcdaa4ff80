"""Heat capacities joined by conductances: temperatures and their integrals over any step, exact.

C T' = Q - K T, with K symmetric and without negative eigenvalues. Its modes are those of C^-1/2 K C^-1/2, which are
orthogonal, so stiff networks and long steps lose no digits.
"""

from dataclasses import dataclass

import numpy as np

from contact_core.arrays import Array


@dataclass(frozen=True)
class Modes:
    """Modes of a network of n nodes."""

    rates: Array  # [n] 1/s, of decay
    shapes: Array  # [n, n] T = shapes @ amplitudes
    inverse: Array  # [n, n] amplitudes = inverse @ T
    entry: Array  # [n, n] rate of change of the amplitudes = entry @ Q

    @staticmethod
    def of(capacities: Array, conductances: Array) -> "Modes":
        """Return the modes of heat capacities C [n] in J/K and the symmetric matrix K [n, n] in W/K."""
        root = np.sqrt(capacities)
        rates, vectors = np.linalg.eigh(conductances / np.outer(root, root))
        return Modes(np.maximum(rates, 0.0), vectors / root[:, None], vectors.T * root, vectors.T / root)

    def after(self, temperatures: Array, heat: Array, time: Array) -> tuple[Array, Array]:
        """Return temperatures [t, n] in K and their integrals [t, n] in K s after times [t], under held heat [n] in W.

        Temperatures count from that of the surroundings.
        """
        start, growth, span = self.inverse @ temperatures, self.entry @ heat, time[:, None]
        decay, first, second = _decays(span * self.rates)
        now = decay * start + span * first * growth
        summed = span * first * start + span**2 * second * growth
        return now @ self.shapes.T, summed @ self.shapes.T


def _decays(x: Array) -> tuple[Array, Array, Array]:
    """Return exp(-x), its mean over (0, x), and that mean's weighted one, (exp(-x) - 1 + x) / x^2, for x >= 0."""
    decay = np.exp(-x)
    safe = np.where(x > 0.0, x, 1.0)
    first = np.where(x > 0.0, -np.expm1(-x) / safe, 1.0)
    near = np.minimum(x, 0.5)  # there, the closed form cancels
    series = np.zeros_like(x)
    for k in range(14, 1, -1):
        series = (1.0 - series * near) / k
    return decay, first, np.where(x < 0.5, series, (1.0 - first) / safe)
