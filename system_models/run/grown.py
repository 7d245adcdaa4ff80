"""Why there is a tribofilm where solids do not touch: a sentence on films that the shear of the oil has grown."""

import numpy as np
import xarray as xr

from contact_core.scene import Case, Scene

from ..charts.half_widths import with_error
from .flags import operating_point

_TOUCH, _THIN = 1e-3, 1e-10  # least share of the load of solids that touch; m: least film that is printed
_MOST = 0.5  # share of a film grown without contact above which the film is due to the oil


def by_oil(scene: Scene, rows: xr.Dataset) -> str:
    """Return a sentence on the tribofilms of a contact at the end of its run, if oil has grown most of them.

    With their errors and the mean shear stress at the last row under load; empty if solids have grown them.
    """
    loaded = np.flatnonzero(rows["load"].values > 0.0)
    films = {i: rows[f"tribofilm_{i}"].values for i in (1, 2) if _by_oil(rows, f"tribofilm_{i}")}
    if not loaded.size or not films:
        return ""
    row = rows.isel(time=int(loaded[-1]))
    case = Case.at(scene, operating_point(row))
    shear = abs(float(row["friction_coefficient"])) * case.hertz.pressure_mean
    told = " and ".join(f"{_stated(rows, f'tribofilm_{i}')} nm on body {i}" for i in films)
    return (
        f"Tribofilm, {told}: grown by the oil's shear stress, {1e-6 * shear:.0f} MPa on average, not by contact, of "
        f"which there is hardly any at lambda {float(row['lambda_ratio']):.2g}. The law tribofilm.model = "
        f"'{scene.tribofilm.name}' grows films under stress of either; 'arrhenius' grows none without contact."
    )


def _by_oil(rows: xr.Dataset, name: str) -> bool:
    """Return True if most of a film has come in rows in which solids carry next to nothing."""
    film, parted = rows[name].values, rows["contact_load_ratio"].values < _TOUCH
    came = np.diff(film, prepend=0.0)
    return bool(film[-1] > _THIN and came[parted].sum() > _MOST * film[-1])


def _stated(rows: xr.Dataset, name: str) -> str:
    half = rows.get(f"{name}_error")
    return with_error(1e9 * float(rows[name][-1]), 1e9 * float(half[-1]) if half is not None else 0.0, 2)
