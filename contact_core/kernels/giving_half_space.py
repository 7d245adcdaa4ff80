"""An elastic half space under a surface that gives way node by node."""

from .arrays import Array
from .half_space import Convolution, HalfSpace
from .surface_give import SurfaceGive


class GivingHalfSpace(HalfSpace):
    """A half space under a surface that gives way. Inverses are those of the half space, which are stiffer."""

    def __init__(self, base: HalfSpace, give: SurfaceGive) -> None:
        self.base, self.give = base, give
        self.shape, self.scale, self.library, self.near = base.shape, base.scale, base.library, base.near
        self.periodic = base.periodic

    def deform_padded(self, pressure: Array) -> Array:
        """Return the deformation in the first nx columns of scratch, which the next call overwrites."""
        deformed = self.base.deform_padded(pressure)
        deformed[:, : self.shape[1]] += self.give.at(pressure)
        return deformed

    def respond(self, pressure: Array, step: Array) -> Array:
        """Return the change of the deformation with a small step from a pressure."""
        return self.base.deform(step) + self.give.slope_at(pressure) * step

    def press(self, gap: Array) -> Array:
        """Return the pressure that would open a small gap of the half space."""
        return self.base.press(gap)

    def press_part(self, height: int, width: int) -> Convolution:
        """Return `HalfSpace.press_part` of the half space."""
        return self.base.press_part(height, width)

    def window(self, ny: int, nx: int, width: int) -> HalfSpace:
        """Refuse: parts of such a surface differ."""
        raise NotImplementedError("use `solve_dry_giving`")


def giving(base: HalfSpace, give: SurfaceGive | None) -> HalfSpace:
    """Return a half space under a surface that gives way; None: as it is."""
    return base if give is None else GivingHalfSpace(base, give)
