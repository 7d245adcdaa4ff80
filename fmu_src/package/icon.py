"""The FMU's icon: a ball on a plane, and the film of oil between them.

`python -m fmu_src.package.icon` draws it into fmu_src/package/icon.png, which the FMU contains as model.png.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contact_core.kernels.arrays import Array, Mask

SIZE = 256  # px
_FINER = 4  # oversampling, for smooth edges
_STEEL, _SHINE = (0.36, 0.42, 0.50), (0.90, 0.93, 0.96)
_PLANE, _GROUND = (0.55, 0.60, 0.66), (0.42, 0.47, 0.53)
_OIL, _LIGHT_OIL = (0.90, 0.58, 0.10), (0.99, 0.78, 0.32)

Image = Array


def png() -> bytes:
    """Return the shipped icon."""
    return Path(__file__).with_name("icon.png").read_bytes()


def draw() -> NDArray[np.uint8]:
    """Draw the icon: pixels [SIZE, SIZE, red green blue alpha]."""
    fine = SIZE * _FINER
    y, x = (np.mgrid[0:fine, 0:fine] + 0.5) / fine
    picture = np.zeros((fine, fine, 4))
    radius, centre, plane = 0.36, 0.40, 0.80
    ball = np.hypot(x - 0.5, y - centre) < radius
    # the film: a bank of oil ahead of the contact, a layer under the ball and behind it
    ends = np.sqrt(np.clip((x - 0.05) / 0.12, 0.0, 1.0) * np.clip((0.95 - x) / 0.12, 0.0, 1.0))
    film = ends * (0.045 + 0.075 * np.exp(-(((x - 0.26) / 0.12) ** 2)))
    _paint(picture, (y >= plane) & (y < 0.95) & (x > 0.03) & (x < 0.97), _PLANE, _GROUND, (y - plane) / 0.15)
    _paint(picture, (y < plane) & (y > plane - film), _LIGHT_OIL, _OIL, (y - 0.68) / 0.12)
    light = np.hypot(x - 0.39, y - 0.27) / (1.5 * radius)
    _paint(picture, ball, _SHINE, _STEEL, light)
    return _coarse(picture)


def _paint(
    picture: Image,
    where: Mask,
    start: tuple[float, float, float],
    end: tuple[float, float, float],
    share: Image,
) -> None:
    """Fill `where` with colours from `start` (share 0) to `end` (share 1)."""
    mix = np.clip(share, 0.0, 1.0)[..., None]
    colours = (1.0 - mix) * np.array(start) + mix * np.array(end)
    picture[where, :3] = colours[where]
    picture[where, 3] = 1.0


def _coarse(picture: Image) -> NDArray[np.uint8]:
    """Average the fine pixels of each pixel; opacity weights the colours."""
    blocks = picture.reshape(SIZE, _FINER, SIZE, _FINER, 4)
    alpha = blocks[..., 3].mean(axis=(1, 3))
    colours = (blocks[..., :3] * blocks[..., 3:]).mean(axis=(1, 3)) / np.maximum(alpha, 1e-9)[..., None]
    return np.rint(255.0 * np.dstack([colours, alpha])).astype(np.uint8)


if __name__ == "__main__":
    from matplotlib.image import imsave

    imsave(Path(__file__).with_name("icon.png"), draw())
