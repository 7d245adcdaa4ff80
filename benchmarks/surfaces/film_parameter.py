"""Film parameter of Hansen et al., (h_m + h_c f_q) / Spk, of a scene: film formulas and the heights of its surfaces.

The abstract (Hansen, Prajapati, Björling & Larsson 2025, doi:10.1007/s11249-025-02060-6) gives this form, with the transition at 1. It does not give f_q, which
stands for the elastic flattening of asperities under oil and depends on their lay. Here it is bounded. f_q = 0 leaves
them rigid. At the other end h_c f_q = Spk - Spk', with Spk' of the surfaces as amplitude reduction theory, which the
abstract names as an alternative, deforms them: the parameter is then 1 where h_m = Spk'.
"""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.surfaces.peaks import BearingCurve
from contact_core import OperatingPoint, Scene
from contact_core.reference.line_films import SmoothLine, dowson_line
from contact_core.reference.point_films import SmoothContact, hamrock_dowson
from contact_core.scene import Case
from contact_core.surfaces.patches import bare_heights

Array = NDArray[np.float64]

SLOWEST, FASTEST = 1e-4, 60.0  # m/s, between which the film parameter may be 1


def point_at(scene: Scene, speed: float) -> OperatingPoint:
    """Return the scene's own operating point at an entrainment speed [m/s], with the slide-to-roll ratio kept."""
    point = scene.operation.point
    times = speed / point.entrainment_speed
    return replace(point, speed_1=point.speed_1 * times, speed_2=point.speed_2 * times)


def smooth_contact(scene: Scene, speed: float) -> SmoothContact | SmoothLine:
    """Return the contact of a scene in the terms of film formulas."""
    case = Case.bind(scene, point_at(scene, speed))
    oil, op = scene.lubricant.viscosity, case.op
    return case.shape.smooth(op.load, op.entrainment_speed, oil, op.inlet_temperature, scene.solids.reduced_modulus)


def films(scene: Scene, speed: float) -> tuple[float, float]:
    """Return central and minimum film [m] of the smooth bodies: Hamrock & Dowson; Dowson & Toyoda, Dowson for lines."""
    contact = smooth_contact(scene, speed)
    return dowson_line(contact) if isinstance(contact, SmoothLine) else hamrock_dowson(contact)


class Peaks:
    """Spk of both surfaces of a scene together, new: of the heights on its grid and the microroughness below it."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._heights = [z[: scene.period] for z in bare_heights(scene, scene.period)]
        self.rigid = self._together(self._heights)

    def deformed(self, speed: float) -> float:
        """Return Spk' [m] under oil at an entrainment speed [m/s]; microroughness is too short to be flattened."""
        share = self._left(speed)
        return self._together([np.fft.ifft2(np.fft.fft2(z) * share).real for z in self._heights])

    def _together(self, heights: list[Array]) -> float:
        below = [surface.microroughness for surface in (self._scene.surface_1, self._scene.surface_2)]
        first, second = (
            BearingCurve.of(z, layer.rms if layer else 0.0) for z, layer in zip(heights, below, strict=True)
        )
        return first.beside(second).reduced_peak_height

    def _left(self, speed: float) -> Array:
        """Return the share that is left of each wave's amplitude in pure rolling.

        Points: Venner & Lubrecht, Proc. IMechE J 214 (2000) 523. Lines: Venner, Couhert & Lubrecht, Leeds-Lyon 23 (1997).
        """
        contact = smooth_contact(self._scene, speed)
        load, oil = contact.moes_parameters
        half_width = Case.bind(self._scene, point_at(self._scene, speed)).hertz.a
        rows, nodes = self._heights[0].shape
        height, length = self._scene.patch_size
        along, across = np.fft.fftfreq(nodes, length / nodes)[None, :], np.fft.fftfreq(rows, height / rows)[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            shorter = 1.0 / np.maximum(np.abs(along), np.abs(across))
            ratio = np.nan_to_num(
                np.abs(across) / np.abs(along), nan=1.0, posinf=np.inf
            )  # of length along x to that along y
            lay = np.where(ratio > 1.0, np.exp(1.0 - 1.0 / np.maximum(ratio, 1.0)), 1.0)
            if isinstance(contact, SmoothLine):
                wave = shorter / half_width * load**0.75 / math.sqrt(oil)
                left = 1.0 / (1.0 + 0.125 * wave + 0.04 * wave**2)
            else:
                wave = lay * shorter / half_width * math.sqrt(load / oil)
                left = 1.0 / (1.0 + 0.15 * wave + 0.015 * wave**2)
        left[0, 0] = 1.0
        return left


def speed_of_one(scene: Scene, peaks: Peaks, *, deformed: bool) -> float:
    """Return the entrainment speed [m/s] at which the film parameter is 1; infinite above FASTEST."""

    def too_thin(speed: float) -> bool:
        return films(scene, speed)[1] < (peaks.deformed(speed) if deformed else peaks.rigid)

    low, high = SLOWEST, FASTEST
    if too_thin(high):
        return math.inf
    while high > 1.002 * low:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if too_thin(middle) else (low, middle)
    return math.sqrt(low * high)
