"""The fields that a run keeps at a few of its times, besides its time series: `tribofmu run --fields N`."""

import logging
from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
import xarray as xr

from contact_core import ContactState, Scene
from contact_core.errors import ContactError
from fmu_src.runtime.snapshot import contact_state

from ..fmu.instance import Instance
from . import maps
from .duty import Duty

log = logging.getLogger(__name__)

_MUCH, _MOST = 2e8, 4e9  # bytes uncompressed: worth a warning, refused


class Fields:
    """Keeps maps and profiles of a run of a contact, at `times` [s], which are rows of the run.

    They are made from the serialised state of the FMU: the run does not notice.
    """

    def __init__(self, scene: Scene, duty: Duty, points: Sequence[float], count: int) -> None:
        """Choose `count` of the rows at `points` [s], evenly spread from the first to the last; 1: the last.

        Raises ContactError if there are not so many, they are too large, or the level of the scene has none.
        """
        _check(scene, points, count)
        self.times = _spread(points, count)
        self.kept: list[bytes] = []
        self._scene = scene
        ops = [duty.at(points[0]), *(duty.at(before) for before, _ in pairwise(points))]  # held to the end of a step
        self._ops = dict(zip(points, ops, strict=True))

    def observe(self, time: float, instances: Mapping[str, Instance]) -> None:
        """Keep the fields if `time` [s] is the next of `times`; there is one FMU, that of the contact."""
        if len(self.kept) == len(self.times) or time < self.times[len(self.kept)]:
            return
        (instance,) = instances.values()
        data = contact_state(instance.serialised())
        state = ContactState.from_bytes(data, self._scene) if data else None
        self.kept.append(maps.taken(self._scene, self._ops[self.times[len(self.kept)]], state, time))

    def dataset(self) -> xr.Dataset:
        """Return the maps and profiles kept along `field_time` [s], with the dimensions y, x and x_track."""
        return maps.dataset_of(self._scene, self.times[: len(self.kept)], self.kept)


def _check(scene: Scene, points: Sequence[float], count: int) -> None:
    if not scene.film.on_grid:
        raise ContactError(
            f"--fields {count}: film.model = '{scene.film.name}' has no fields, its surfaces are means over the track. "
            "Use --set film.model=deterministic, or leave --fields out (in Python: fields)."
        )
    if not 1 <= count <= len(points):
        raise ContactError(
            f"--fields {count} must be at least 1 and at most {len(points)}, the rows of this run. Use such a number, "
            "or a shorter operation.interval for more rows (in Python: fields)."
        )
    each = maps.size_of(scene)
    size = count * each
    if size > _MOST:
        raise ContactError(
            f"--fields {count} would keep {size / 1e9:.3g} GB of maps, {each / 1e6:.3g} MB at each time; at most "
            f"{_MOST / 1e9:g} GB are kept. Use --fields {int(_MOST / each)} or less, or a coarser --grid "
            "(in Python: fields, film.points)."
        )
    if size > _MUCH:
        log.warning("--fields %d keeps %.2g GB of maps in memory; result.nc has them compressed.", count, size / 1e9)


def _spread(points: Sequence[float], count: int) -> list[float]:
    """Return `count` different points next to times that are evenly spread from the first to the last."""
    if count == 1:
        return [points[-1]]
    number = np.arange(count)
    wanted = np.linspace(points[0], points[-1], count)
    nearest = np.abs(np.asarray(points)[:, None] - wanted).argmin(axis=0)
    different = np.maximum.accumulate(nearest - number) + number
    return [points[k] for k in np.minimum(different, len(points) - count + number)]
