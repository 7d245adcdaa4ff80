"""Life of a rolling contact by the integral of its stress over the volume that it stresses.

A contact that is run over N times survives with the probability S:

    ln(1/S) = A N^e l integral (s - s_u)^c dA / z'^h,    e = 10/9, c = 31/3, h = 7/3

s(y, z) is the largest von Mises stress that the material at a place of the cross section sees while the contact passes,
s_u a limit below which it does not tire, z' its mean depth weighted with (s - s_u)^c, l the length of the track. A is
what makes a smooth contact without friction and limit live as long as its race by ISO 16281, which holds at any load as
both lives go with its inverse cube; so lives are known as factors on that one. Lundberg and Palmgren had in the place
of s the largest half range of the shear stress that rolling reverses, its depth for z', and no limit.

Sources: Ioannides & Harris, J. Tribology 107 (1985) 367; Lundberg & Palmgren, Acta Polytechnica, Mech. Eng. Ser. 1 (3)
(1947) (both from memory); exponents are theirs for ball bearings. ISO 281's limit, Hertz's pressure of 1500 MPa.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from contact_core.kernels.arrays import Array
from contact_core.kernels.stress_measures import von_mises
from contact_core.kernels.subsurface import Subsurface
from contact_core.reference import Hertz

from .geometry import Race
from .rating import FATIGUE_PRESSURE, WEIBULL

STRESS_POWER, DEPTH_POWER = 31.0 / 3.0, 7.0 / 3.0
DEPTHS = (0.01, 0.02, 0.04, 0.06, 0.09, 0.13, 0.18, 0.24, 0.31, 0.39, 0.47, 0.56, 0.66, 0.78, 0.92, 1.1, 1.35, 1.7, 2.2)
_NODES = 12  # on the half width along x
_FRICTION = (0.0, 0.01, 0.02, 0.035, 0.05, 0.07, 0.1, 0.13, 0.16, 0.2, 0.25, 0.3)
_REACH = 1.5  # half widths along x within which the largest stress is


def risk(stress: Array, depths: Array, spacing: float, limit: float = 0.0) -> float:
    """Return integral (s - s_u)^c dA / z'^h of stresses [..., nz, ny] in cross sections, the mean of all.

    Parameters
    ----------
    stress : largest of the material's cycle [Pa].
    depths : increasing [nz], in m.
    spacing : across the track [m].
    limit : s_u [Pa].

    Returns
    -------
    float
        [Pa^(31/3) m^(-1/3)]; 0 where all stress is below the limit.

    """
    over = np.maximum(stress - limit, 0.0) ** STRESS_POWER
    share = over.reshape(-1, *over.shape[-2:]).mean(axis=0).sum(axis=-1) * spacing  # [nz]
    whole = _integral(share, depths)
    if whole == 0.0:
        return 0.0
    return float(whole / (_integral(share * depths, depths) / whole) ** DEPTH_POWER)


def _integral(values: Array, depths: Array) -> float:
    """Return the trapezoidal rule from the surface on, where the value is that of the first depth."""
    return float(np.trapezoid(values, depths) + values[0] * depths[0])


def factor(changed: float, smooth: float) -> float:
    """Return how many times the life of a smooth contact is, by both risks; infinite without risk."""
    return float((smooth / changed) ** (1.0 / WEIBULL)) if changed > 0.0 else np.inf


@dataclass(frozen=True)
class SmoothContact:
    """Stress below Hertz's contact that slides along x, friction in proportion to the pressure."""

    hertz: Hertz
    poisson: float

    @property
    def depths(self) -> Array:
        """[m]."""
        return np.array(DEPTHS) * self.hertz.a

    @property
    def spacing(self) -> float:
        """[m]."""
        return self.hertz.a / _NODES

    @cached_property
    def _fields(self) -> tuple[Array, Array]:
        """Stress [nz, 6, ny, nx] of the pressure and of the shear stress that equals it, over the largest pressure."""
        a, b, step = self.hertz.a, self.hertz.b, self.spacing
        across = int(b / step) + 2
        x = np.arange(-int(_REACH * _NODES), int(_REACH * _NODES) + 1) * step
        y = np.arange(-across, across + 1) * step
        pressure = np.sqrt(np.maximum(1.0 - (x[None, :] / a) ** 2 - (y[:, None] / b) ** 2, 0.0))
        below = Subsurface(pressure.shape, step, self.depths, self.poisson, "scipy")
        nothing = np.zeros_like(pressure)
        pressed, rubbed = below.layers(pressure), below.layers(nothing, pressure)
        # y mirrors: half of it is enough
        return tuple(_stacked(each, across) for each in (pressed, rubbed))  # type: ignore[return-value]

    def stress(self, friction: float = 0.0) -> Array:
        """Return the largest von Mises stress [nz, ny] of the pass, from the middle of the track outward [Pa]."""
        pressed, rubbed = self._fields
        rows = [von_mises(p + friction * q).max(axis=-1) for p, q in zip(pressed, rubbed, strict=True)]
        return self.hertz.pressure_max * np.stack(rows)

    def risk(self, friction: float = 0.0, limit: float = 0.0) -> float:
        """Return the risk of the whole track, as `risk`; friction: coefficient, limit [Pa]."""
        half = self.stress(friction)
        return risk(np.concatenate([half[:, :0:-1], half], axis=1), self.depths, self.spacing, limit)

    def life_factor(self, friction: Array) -> Array:
        """Return how many times its life by ISO 16281 the contact lives with coefficients of friction, without a limit.

        Interpolated between coefficients of a table; larger ones count as its last. The same at any load.
        """
        return np.asarray(np.interp(np.abs(friction), _FRICTION, self._factors))

    @cached_property
    def _factors(self) -> Array:
        smooth = self.risk()
        return np.array([factor(self.risk(each), smooth) for each in _FRICTION])

    @cached_property
    def fatigue_limit(self) -> float:
        """Largest stress under ISO 281's pressure of 1500 MPa without friction [Pa]."""
        return float(self.stress().max() * FATIGUE_PRESSURE / self.hertz.pressure_max)


def _stacked(layers: Iterator[Array], middle: int) -> Array:
    return np.stack([layer[:, middle:].copy() for layer in layers])


@lru_cache(maxsize=8)
def smooth_contact(race: Race, poisson: float) -> SmoothContact:
    """Return the contact of a ball on a race at 1 N, kept for the next who asks."""
    return SmoothContact(race.unit, poisson)
