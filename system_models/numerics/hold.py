"""The coupled inputs within a communication step: polynomials through their values at communication points.

A polynomial is its coefficients c [degree + 1, size], u(s) = sum c[j] s^j, with s [s] from the current communication
point. They follow from Newton's divided differences, so that steps may vary.
"""

from itertools import pairwise

import numpy as np

from .arrays import Array, Mask

Past = tuple[tuple[float, ...], tuple[Array, ...]]


class History:
    """The newest order + 1 values of the coupled inputs; less after an event, and the order of hold with them.

    sampled [size]: which inputs hold their values between communication points, whatever the order; by default none.
    Nothing stored is ever changed, so that a copy costs nothing and restores exactly.
    """

    def __init__(self, order: int, sampled: Mask | None = None) -> None:
        self._order = order
        self._sampled = sampled if sampled is not None and sampled.any() else None
        self._times: tuple[float, ...] = ()  # [s], newest first
        self._differences: tuple[Array, ...] = ()  # [j]: divided difference over the newest j + 1 times

    def __len__(self) -> int:
        return len(self._times)

    def push(self, time: float, values: Array) -> None:
        """Add the values [size] at a time [s] later than all before."""
        differences = self._extended(time, values.copy())
        self._times = (time, *self._times)[: len(differences)]
        self._differences = differences

    def ages(self) -> list[float]:
        """Return the ages [s] of the stored values, the newest first."""
        return [self._times[0] - time for time in self._times]

    def clear(self) -> None:
        """Forget the past, as after an event: it says nothing about the future."""
        self._times, self._differences = (), ()

    def copy(self) -> Past:
        """Return the memory for `restore`."""
        return self._times, self._differences

    def restore(self, past: Past) -> None:
        """Go back to a memory that `copy` has returned."""
        self._times, self._differences = past

    def extrapolate(self) -> Array:
        """Return coefficients of the polynomial through the stored values; there must be at least one."""
        now = self._times[0]
        return self._held(_expanded(self._differences, [time - now for time in self._times]), self._differences[0])

    def interpolate(self, step: float, end: Array, entries: slice = slice(None)) -> Array:
        """Return coefficients of the polynomial through the newest stored values and `end`, a `step` [s] from now.

        end [size of `entries`]: of all stored values or some.
        """
        if self._order == 0 or not self._times:
            return end[None].copy()
        now = self._times[0]
        differences = self._extended(now + step, end, entries)
        return self._held(_expanded(differences, [step, *(time - now for time in self._times)]), end, entries)

    def _held(self, coefficients: Array, values: Array, entries: slice = slice(None)) -> Array:
        """Return the coefficients, those of sampled inputs for `values` that do not change."""
        if self._sampled is not None:
            sampled = self._sampled[entries]
            coefficients[0, sampled] = values[sampled]
            coefficients[1:, sampled] = 0.0
        return coefficients

    def _extended(self, time: float, values: Array, entries: slice = slice(None)) -> tuple[Array, ...]:
        """Return divided differences, up to the order, with one more time."""
        differences = [values]
        for past_time, past in zip(self._times[: self._order], self._differences, strict=False):
            differences.append((differences[-1] - past[entries]) / (time - past_time))
        return tuple(differences)


def _expanded(differences: tuple[Array, ...], nodes: list[float]) -> Array:
    """Return coefficients of powers of s, of Newton's polynomial with its nodes at s [s]."""
    powers = [differences[-1]]
    for difference, node in zip(differences[-2::-1], nodes[len(differences) - 2 :: -1], strict=False):
        between = [low - node * high for low, high in pairwise(powers)]
        powers = [difference - node * powers[0], *between, powers[-1]]
    return np.array(powers)


def value(coefficients: Array, s: float) -> Array:
    """Return u(s) [size]."""
    total = coefficients[-1].copy()
    for c in coefficients[-2::-1]:
        total *= s
        total += c
    return total


def mean(coefficients: Array, step: float) -> Array:
    """Return the mean of u [size] over 0 <= s <= step."""
    total = coefficients[0].copy()
    for j in range(1, len(coefficients)):
        total += coefficients[j] * (step**j / (j + 1))
    return total
