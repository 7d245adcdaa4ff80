"""What material carries through layers at fixed depths below a surface that is worn: see `damage`.

In a layer the values are linear, with limited slopes (van Leer, J. Comput. Phys. 32 (1979) 101,
doi:10.1016/0021-9991(79)90145-1), so that at its faces they are between its mean and those of its neighbours.
"""

import numpy as np

from .compiled import jit


@jit
def carried(values, gained, faces, removed):  # type: ignore[no-untyped-def]
    """Replace means of layers [nz, m] by those after the surface of the m columns was lowered by `removed` [m].

    `gained` [nz, m] is what material at rest would gain meanwhile, at an even rate; material gains it where it passes.
    `faces` [nz + 1] are the depths between which the layers lie.
    """
    count = faces.size - 1
    value, gain = np.empty(count), np.empty(count)
    steep, steep_gain = np.zeros(count), np.zeros(count)
    for column in range(removed.size):
        for i in range(count):
            value[i], gain[i] = values[i, column], gained[i, column]
        worn = removed[column]
        if worn == 0.0:
            for i in range(count):
                values[i, column] = value[i] + gain[i]
            continue
        _slopes(value, faces, steep)
        _slopes(gain, faces, steep_gain)
        least, most = value.min(), value.max()
        through, mean = _through(value, gain, steep, steep_gain, faces, 0, worn)
        for i in range(count):
            below, mean_below = _through(value, gain, steep, steep_gain, faces, i + 1, worn)
            width = faces[i + 1] - faces[i]
            moved = value[i] + (below - through) / width
            taken = max(gain[i] + (mean_below - mean) / width, 0.0)  # not below zero by rounding
            values[i, column] = min(max(moved, least), most) + taken
            through, mean = below, mean_below


@jit
def _slopes(value, faces, steep):  # type: ignore[no-untyped-def]
    """Write the slopes within the layers; the first one's is that to the second one, the last one has none.

    What is beyond the range of the means, above the middle of the first layer, can only leave.
    """
    if value.size > 1:
        down, half = value[1] - value[0], 0.5 * faces[1]
        steep[0] = np.sign(down) * min(2.0 * abs(down) / faces[2], abs(down) / half, value[0] / half)
    for i in range(1, value.size - 1):
        up, down = value[i] - value[i - 1], value[i + 1] - value[i]
        if up * down > 0.0:
            a, b = up / (faces[i + 1] - faces[i - 1]), down / (faces[i + 2] - faces[i])
            largest = min(abs(up), abs(down)) / (faces[i + 1] - faces[i])
            steep[i] = np.sign(up) * 2.0 * min(2.0 * abs(a * b / (a + b)), largest)
        else:
            steep[i] = 0.0


@jit
def _through(value, gain, steep, steep_gain, faces, face, worn):  # type: ignore[no-untyped-def]
    """Return what passes a face while the material rises by `worn`: of the values, and of the gain on the way."""
    passed, mean, done = 0.0, 0.0, 0.0
    for k in range(face, value.size):
        width = faces[k + 1] - faces[k]
        rest = worn - done
        x, half = min(rest, width), 0.5 * width
        first, second = 0.5 * x * x, x * (0.5 * x - half)
        passed += value[k] * x + steep[k] * second
        mean += gain[k] * (rest * x - first) + steep_gain[k] * (rest * second - x * x * (x / 3.0 - 0.5 * half))
        done += x
        if x == rest:
            break
    rest = max(worn - done, 0.0)  # below the last layer
    return passed + value[-1] * rest, (mean + 0.5 * gain[-1] * rest * rest) / worn
