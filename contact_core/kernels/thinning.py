"""Flow of an oil that thins under shear, between sliding walls under a pressure gradient: node by node."""

import numpy as np

from .compiled import jit

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(6)
_STEPS = 50  # of Newton's method at most
_PRECISION = 1e-6
_TANGENT = 1e-2  # pressure flow over sliding flow below which the first guess is as good as the table


@jit
def stress_of_flow(sheared, pressed, mean, half, log_least, log_step, log_ease):  # type: ignore[no-untyped-def]
    """Compute the shear stresses mean + s half, s = -1...1 across the film, of a sliding and a pressure flow.

    All fields are flat, stresses in Pa. sheared, pressed: what a Newtonian oil of the same viscosity would need for
    the same sliding (uniform) and for the same pressure flow (at the walls). `mean` and `half` hold the first guess,
    that the rates at the walls are those of the Newtonian oil, and are improved in place. `log_ease`: logarithm of rate
    times viscosity over stress, a table over the logarithm of the stress from `log_least` in steps `log_step`.

    The two conditions are the gradient of a convex function of (mean, half), whose minimum Newton's method seeks.
    """
    last = log_ease.size - 1
    for k in range(sheared.size):
        if pressed[k] < _TANGENT * sheared[k]:
            continue
        a, b = mean[k], half[k]
        for _ in range(_STEPS):
            by_a, by_b = -2.0 * sheared[k], -2.0 / 3.0 * pressed[k]
            aa, ab, bb = 0.0, 0.0, 0.0
            for n in range(_POINTS.size):
                s, w = _POINTS[n], _WEIGHTS[n]
                stress = a + s * b
                at = (np.log(abs(stress) + 1e-300) - log_least) / log_step
                easier, slope = 1.0, 1.0
                if at > 0.0:
                    i = min(int(at), last - 1)
                    rise = log_ease[i + 1] - log_ease[i]
                    easier = np.exp(log_ease[i] + min(at - i, 1.0) * rise)
                    slope = 1.0 + rise / log_step
                by_a += w * easier * stress
                by_b += w * s * easier * stress
                aa += w * easier * slope
                ab += w * s * easier * slope
                bb += w * s * s * easier * slope
            inverse = 1.0 / (aa * bb - ab * ab)
            da, db = (bb * by_a - ab * by_b) * inverse, (aa * by_b - ab * by_a) * inverse
            part = min(1.0, 0.8 * b / max(db, 1e-300))  # b stays positive
            a, b = a - part * da, b - part * db
            if abs(da) <= _PRECISION * abs(a) + _PRECISION * b and abs(db) <= _PRECISION * b:
                break
        mean[k], half[k] = a, b
