"""What a load cycle does to a material point: amplitude of shear, largest hydrostatic stress, Dang Van's stress.

Components of stress are xx, yy, zz, yz, xz, xy; tension is positive.

Sources: amplitude by the smallest sphere around the deviators: Papadopoulos's definition, as in Bernasconi, Int. J.
Fatigue 24 (2002) 649, doi:10.1016/S0142-1123(01)00181-5, and Bernasconi & Papadopoulos, Comput. Mater. Sci. 34 (2005)
355; largest hydrostatic stress: Crossland, Int. Conf. Fatigue of Metals, London 1956 (from memory); largest shear of
what is beyond the sphere's centre: Dang Van, ASTM STP 1191 (1993) 120, on rolling contacts Desimone, Bernasconi &
Beretta, Wear 260 (2006) 567.
"""

from typing import NamedTuple

import numpy as np

from ..errors import ContactError
from .arrays import Array


class Cycle(NamedTuple):
    """Stresses of one load cycle [Pa]. Arrays of one shape."""

    shear: Array  # amplitude of sqrt(J2): radius of the smallest sphere around the deviators of the cycle
    hydrostatic: Array  # largest in the cycle, tension positive
    dang_van: Array  # largest of tau + slope times hydrostatic stress, tau: largest shear of deviator less centre


def cycle_of(history: Array, unloaded: Array, slope: float) -> Cycle:
    """Return the stresses of a cycle through the instants of a history and the unloaded state.

    Parameters
    ----------
    history
        Stress [Pa] of the instants of a cycle in any order, [n, 6, ...].
    unloaded
        Stress [Pa] between the loads, [6]: residual stress. It counts as one more instant.
    slope
        Weight of the hydrostatic stress in Dang Van's stress, 0 or more.

    Returns
    -------
    Cycle
        Arrays of the shape of the points. `shear` is at most 1e-9 above that of the smallest sphere, relative; the
        order of the instants changes nothing beyond that.

    Raises
    ------
    ContactError
        If a stress is not finite.

    """
    from .smallest_sphere import cycles  # the compiler: loaded where stresses are asked for

    if not (np.isfinite(history).all() and np.isfinite(unloaded).all()):
        raise ContactError("A stress in the history of a load cycle is not finite: the contact's pressure cannot be.")
    found = Cycle(*(np.empty(history.shape[2:]) for _ in range(3)))
    flat = np.ascontiguousarray(history, np.float64).reshape(*history.shape[:2], -1)
    cycles(flat, np.asarray(unloaded, np.float64), float(slope), *(field.reshape(-1) for field in found))
    return found
