"""A dimple that crosses a point contact in rolling: five film profiles by interferometry."""

import numpy as np

from contact_core import Scene, initial_state, march
from contact_core.deterministic.transient import rolled
from contact_core.kernels.arrays import Array

from .model import Outcome, Row, compared, exactly, relative, rounding
from .tables import read

DIMPLE = {2: -87e-6, 3: -49e-6, 4: 24e-6, 5: 113e-6}  # m: middle of the dimple in each profile; not in the first one
BESIDE = 37e-6  # m from that middle: twice the radius of the dimple
A = 136.7e-6  # m, half width of Hertz's contact of the scene
GRIDS = (65, 129)
# (value, last printed digit, exponent of the central film by Hamrock and Dowson) of the conditions
PRINTED = ((0.09, 0.01, 0.67), (0.25, 0.01, 0.67), (22.0, 1.0, 0.53), (110.0, 1.0, -0.073), (15.0, 1.0, -0.067))
Profiles = dict[int, tuple[Array, Array]]


def rolling(points: int) -> Profiles:
    """Return x and gap [m] along the centre line, by profile, when the dimple is nearest to where it was measured."""
    scene = Scene.from_toml("dimple_rolling", {"film.points": str(points)})
    domain, op = scene.film.domain, scene.operation.point
    spacing = domain / (points - 1)
    first = -0.45 * domain  # the dimple lies in the middle of its patch
    begin = rolled(scene, initial_state(scene), (0.0, first))
    times = np.arange(0.0, (0.9 * domain) / op.speed_2, spacing / op.speed_2)
    best: dict[int, tuple[float, Array, Array]] = {}
    for moment in march(scene, begin, lambda _: op, times.tolist()):
        where = first + op.speed_2 * moment.time
        for profile, middle in ({1: first} | DIMPLE).items():
            off = abs(where - middle)
            if profile not in best or off < best[profile][0]:
                gap = moment.fields.gap
                best[profile] = off, moment.fields.x + middle - where, gap[gap.shape[0] // 2].copy()
    return {profile: (x, gap) for profile, (_, x, gap) in best.items()}


def measured(profile: int) -> tuple[Array, Array]:
    """Return x and gap [m] of a measured profile."""
    rows = [row for row in read("dimple_rolling.csv") if row["profile"] == profile]
    at, gap = (np.array([row[key] for row in rows]) for key in ("x_um", "gap_nm"))
    return at * 1e-6, gap * 1e-9


def ratios(found: Profiles, profile: int, within: float) -> Array:
    """Return computed over measured films of a profile for |x| < `within` [m], beside the dimple."""
    (x, gap), (at, film) = found[profile], measured(profile)
    chosen = (np.abs(at) < within) & (np.abs(at - DIMPLE.get(profile, 1.0)) > BESIDE)
    return np.asarray(np.interp(at[chosen], x, gap) / film[chosen])


def errors(found: Profiles) -> dict[int, float]:
    """Return the rms error of each profile over Hertz's contact, beside the dimple, relative to the measured film."""
    return {profile: float(np.sqrt(((ratios(found, profile, A) - 1.0) ** 2).mean())) for profile in found}


def run() -> Outcome:
    """Compare films of the flat middle, beside the dimple, on two grids of which the difference is the stated error."""
    coarse, fine = (rolling(points) for points in GRIDS)
    of_conditions = rounding(*PRINTED)
    rows, curves = [], []
    for profile in fine:
        at, film = measured(profile)
        chosen = (np.abs(at) < 0.5 * A) & (np.abs(at - DIMPLE.get(profile, 1.0)) > BESIDE)
        there, here, less = film[chosen].mean(), ratios(fine, profile, 0.5 * A), ratios(coarse, profile, 0.5 * A)
        digitised = film[chosen].std() / np.sqrt(chosen.sum())
        rows.append(
            Row(
                f"film in the middle, profile {profile}",
                "nm",
                exactly(1e9 * there),
                1e9 * there * float(here.mean()),
                1e9 * (relative(there, of_conditions) + float(digitised)),
                f"rounding of the printed speed, oil, bodies and load: {100.0 * of_conditions:.1f} % of the film; "
                "scatter of the digitised points",
                1e9 * there * abs(float(here.mean() - less.mean())),
            )
        )
        x, gap = fine[profile]
        shown = np.abs(x) < 1.2 * A
        curves.append(
            compared(
                f"profile {profile}", "x [um]", "gap [nm]", (1e6 * at, 1e9 * film), (1e6 * x[shown], 1e9 * gap[shown])
            )
        )
    return Outcome(tuple(rows), tuple(curves))
