"""Constants of the curves of stress below rough bodies, fitted to passes that were solved."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from scipy.optimize import least_squares
from scipy.special import ndtri

from benchmarks.stress.points import EXPONENTS, PROBABILITIES, Seen
from contact_core.laws.load_sharing import rms_slope
from contact_core.regression.near_surface import Added, Largest, NearSurface, Pressures, Rough, meetings
from contact_core.regression.smooth_cycles import smooth_cycles
from contact_core.state.classes import EDGES
from contact_core.state.classes import WEIGHTS as SHARES
from contact_core.surfaces.damage_classes import rows_of

SCORES = ndtri(PROBABILITIES)
WEIGHTS = np.array([0.5, 0.7, 1.0, 1.0, 1.0, 1.0, 1.0])  # of the quantiles: the lowest do no damage
FAR = 0.1  # residuals beyond which a point counts by its distance
LEAST = 0.02  # of a stress over Hertz's largest pressure: below that it does nothing
OF_DAMAGE = 5.0  # weight of a stress that damages beside that of a quantile at one depth
MIDDLES, OF_CLASSES = ndtri(EDGES - 0.5 * SHARES), SHARES
Array = np.ndarray
_WIDE = {  # bounds of constants
    "steep": (0.5, 50.0), "parted": (0.0, 10.0), "film": (0.1, 4.0), "film_steep": (0.0, 4.0), "sliding": (0.005, 10.0),
    "size": (0.01, 2.0), "growth": (0.3, 3.0), "reach": (0.1, 10.0), "shape": (0.3, 3.0), "mean": (-3.0, 3.0),
    "meeting": (-1.0, 3.0), "rough": (-2.0, 3.0), "relief": (-0.5, 1.0), "skew": (-2.0, 4.0), "skew_rough": (-2.0, 6.0),
    "skew_parted": (-2.0, 4.0), "skew_reach": (0.1, 20.0), "skew_meeting": (0.0, 5.0), "spots": (0.0, 2.0),
}  # fmt: skip


@dataclass(frozen=True)
class Known:
    """What the curves are told of a contact, from what was solved."""

    seen: Seen
    rough: Rough
    chords: Array
    smooth: Array  # stresses of a `Cycle`, [3, layers, rows]
    peak: Array  # von Mises stress of smooth bodies, [layers]

    @staticmethod
    def of(seen: Seen) -> "Known":
        """Look the smooth bodies up."""
        case = seen.case
        scene, hertz, op = case.scene, case.hertz, case.op
        rq, length = np.array([scene.surface_1.rq, scene.surface_2.rq]), scene.surface_1.correlation_length
        slope = float(rms_slope(rq[0], length, rq[1], length))
        line = case.shape.along_face
        places = rows_of(scene) * scene.hertz(scene.operation.load).b / hertz.b
        table = smooth_cycles(None if line else hertz.b / hertz.a, scene.stress.dang_van_slope, 0.0)
        side = min(2.0 * hertz.b, scene.rows * scene.film.spacing)
        rough = Rough(
            0.5 * scene.solids.reduced_modulus * slope / hertz.pressure_max,
            case.smooth_film / float(np.hypot(*rq)),
            abs(seen.point.srr),
            seen.load_ratio,
            meetings((op.speed_1, op.speed_2), 2.0 * hertz.a / length, tuple((rq**2 / (rq @ rq)).tolist())),
            scene.depths / length,
            2.0 * hertz.a * side / length**2,
        )
        return Known(
            seen,
            rough,
            np.ones(1) if line else np.sqrt(np.maximum(1.0 - places**2, 0.0025)),
            *table.at(seen.friction, np.zeros(1) if line else places, scene.depths / hertz.a),
        )

    def pressure(self, curve: Pressures) -> tuple[Array, float]:
        """P by row, and its rms over the contact."""
        rows = curve.at(self.rough, self.chords)
        return rows, float(np.sqrt(self.chords @ rows**2 / self.chords.sum()))


def pressure_off(known: Sequence[Known], curve: Pressures) -> Array:
    """Logarithm of P by the curve over what was solved."""
    return np.array([np.log(each.pressure(curve)[1] / each.seen.pressure) for each in known])


def quantiles_off(known: Sequence[Known], curves: NearSurface, which: int) -> list[Array]:
    """Logarithm of the quantiles by the curve over those solved, each [bodies, quantiles, rows, layers]."""
    curve: Added = (curves.shear, curves.dang_van)[which]
    found = []
    for each in known:
        told = curve.quantiles(
            each.smooth[2 * which], each.pressure(curves.pressures)[0], each.chords, each.rough, SCORES
        )
        seen = each.seen.quantiles[:, :, :, 2 * which]
        found.append(np.log(np.maximum(told.transpose(0, 3, 2, 1), LEAST) / np.maximum(seen, LEAST)))
    return found


def equivalents_off(known: Sequence[Known], curves: NearSurface, which: int) -> Array:
    """Logarithm of the stresses that damage by the curve over those solved, [contacts, bodies, exponents]."""
    curve: Added = (curves.shear, curves.dang_van)[which]
    found = []
    for each in known:
        rows = each.pressure(curves.pressures)[0]
        worst = curve.quantiles(each.smooth[2 * which], rows, each.chords, each.rough, MIDDLES).max(axis=1)
        told = [((worst**m) @ OF_CLASSES).mean(axis=1) ** (1.0 / m) for m in EXPONENTS]
        found.append(np.log(np.stack(told, axis=1) / each.seen.equivalent[:, which]))
    return np.array(found)


def largest_off(known: Sequence[Known], curves: NearSurface) -> tuple[Array, list[Array]]:
    """Logarithm of the largest von Mises stress by the curve over that solved, and of those of the layers."""
    told = [curves.largest.at(each.peak, each.pressure(curves.pressures)[1], each.rough) for each in known]
    seen = [each.seen.von_mises for each in known]
    whole = np.array([np.log(a.max() / b.max()) for a, b in zip(told, seen, strict=True)])
    return whole, [np.log(a / b) for a, b in zip(told, seen, strict=True)]


def fitted(known: Sequence[Known], start: NearSurface) -> NearSurface:
    """Return the curves with the constants that fit best, one curve after the other."""

    def off(curve: Pressures) -> Array:
        return pressure_off(known, curve)

    curves = replace(start, pressures=_fit(start.pressures, off))
    for which, name in enumerate(("shear", "dang_van")):

        def of_cycle(curve: Added, which: int = which, name: str = name, curves: NearSurface = curves) -> Array:
            parts = quantiles_off(known, replace(curves, **{name: curve}), which)
            weights = [np.sqrt(each.chords) * (2.0 if each.chords.size == 1 else 1.0) for each in known]
            off = [
                (part * WEIGHTS[None, :, None, None] * w[:, None]).ravel()
                for part, w in zip(parts, weights, strict=True)
            ]
            off.append(OF_DAMAGE * equivalents_off(known, replace(curves, **{name: curve}), which).ravel())
            return np.concatenate(off)

        curves = replace(curves, **{name: _fit(getattr(curves, name), of_cycle)})

    def of_largest(curve: Largest) -> Array:
        whole, layers = largest_off(known, replace(curves, largest=curve))
        return np.concatenate([2.0 * whole, 0.4 * np.concatenate(layers)])

    return replace(curves, largest=_fit(curves.largest, of_largest))


def _fit(curve: Any, off: Callable[[Any], Array]) -> Any:
    names = [f.name for f in fields(curve)]
    low, high = np.array([_WIDE[name] for name in names]).T
    start = np.clip([getattr(curve, name) for name in names], low + 1e-6, high - 1e-6)
    found = least_squares(
        lambda x: off(type(curve)(*x.tolist())), start, bounds=(low, high), loss="soft_l1", f_scale=FAR, max_nfev=80
    )
    return type(curve)(*[float(f"{value:.3g}") for value in found.x])
