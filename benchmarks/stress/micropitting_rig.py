"""A roller on a disc of a micropitting tester: the scene, its surfaces, and runs that are kept.

Inputs of Morales-Espejel & Brizmer, Tribol. Trans. 54 (2011) 625, doi:10.1080/10402004.2011.587633: tester, oil, load, speeds,
friction, hardness, roughness Rq and skewness, line of lives. Assumed, as not printed there: correlation lengths, their ratio and
distribution of heights; a line contact in place of one of 0.244 mm by 1.016 mm; dry contact, as the film is a tenth of Rq; the
coefficient of wear.
"""

import hashlib
import tomllib
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.stats import gamma, norm

from benchmarks.claims import kept
from contact_core import Scene, advance, initial_state

Array = NDArray[np.float64]

PAGE = "stress/micropitting"
CYCLES = 720_000  # of the roller
ROLLER = 12.57e-3  # travel of a point of the roller between two of the three discs [m]
SPEED = 1.0  # mean of both surfaces [m/s]
DOMAIN = 0.4e-3  # [m]
RQ_DISC, RQ_ROLLER = 0.5e-6, 0.05e-6  # [m]
SKEWNESS = -1.38  # of a disc like these
LENGTH, RATIO = 20e-6, 10.0  # correlation length across the lay [m], and that along it over it
UNBROKEN = 1300.0  # strength for one cycle [MPa] at which nothing breaks out
TIMES = 20  # at which damage is looked at

_SCENE = """
name = "micropitting_rig"
description = "A smooth roller on a rough disc"

[geometry]
model = "line"
radius_x = "4.9 mm"  # 6 mm and 27 mm
face_width = "1 mm"
track_length_1 = "12.57 mm"  # a third of the roller's circumference
track_length_2 = "170 mm"  # circumference of the disc

[solids]
reduced_modulus = "231 GPa"

[surface_1]
rq = "0 m"
correlation_length = "20 um"
seed = 1

[surface_2]
rq = "0 m"
correlation_length = "20 um"
seed = 2

[lubricant.viscosity]
model = "roelands"
viscosity = "3.4 mPa s"
reference_temperature = "75 degC"
pressure_coefficient = "20.78 GPa^-1"
temperature_coefficient = "0.03 K^-1"

[lubricant.density]
model = "dowson_higginson"

[lubricant.rheology]
model = "eyring"
eyring_stress = "3 MPa"
limiting_coefficient = 0.05

[plasticity]
model = "elastic_perfectly_plastic"
hardness = "4.3 GPa"
film_hardness = "4.3 GPa"

[boundary_friction]
model = "film_blend"
bare = 0.12
film = 0.12
slip_speed = "1 um/s"

[heat]
model = "none"

[tribofilm]
model = "none"

[wear]
model = "archard"

[stress]
set = "bearing_52100"
deepest = 0.25
layers = 8

[fatigue]
set = "bearing_52100"

[film]
model = "deterministic"
domain = "0.4 mm"
width = "0.4 mm"
floor = "1 nm"
tolerance = 3e-3
iterations = 2000

[control]
change = "1 um"
input_change = 0.02
driver = "dry"

[operation]
load = "300 N"
temperature = "75 degC"
duration = "3 h"
interval = "60 s"
"""


class Setting(NamedTuple):
    """What a run differs in."""

    lay: str = "transverse"
    seed: int = 1
    slide: float = 0.02  # (u_1 - u_2) / mean: positive where the roller is the faster
    wear: float = 4e-6  # Archard's coefficient
    strength: float = UNBROKEN  # amplitude in torsion that fails in one cycle [MPa]
    points: int = 65
    instants: int = 8  # of a pass
    longest: float = 80.0  # block [s]

    @property
    def duration(self) -> float:
        """Time [s] of the load cycles."""
        return CYCLES * ROLLER / self.speeds[0]

    @property
    def speeds(self) -> tuple[float, float]:
        """Speeds of roller and disc [m/s]."""
        return SPEED * (1.0 + 0.5 * self.slide), SPEED * (1.0 - 0.5 * self.slide)


class Run(NamedTuple):
    """What a run gives, of the roller where nothing else is said."""

    damage: Array  # largest below each point at any time, had no pit broken out before [rows, columns]
    pits: Array  # depth broken out [m], likewise
    area: Array  # share of the track pitted at `TIMES` times, of the roller and the disc [2, TIMES]
    roughness: Array  # of roller and disc at the end [m]
    wear: float  # depth worn [m]
    blocks: float
    stated: float  # error_damage
    dang_van: Array  # Dang Van's stress over the limit, at the times


@cache
def line_of_lives() -> tuple[float, float]:
    """Return the strength for one cycle and its fall per factor e of the life [MPa], of the set."""
    law: Any = scene_of(Setting(strength=0.0)).fatigue
    return 1e-6 * law.single_strength, 1e-6 * law.strength_drop


def scene_of(setting: Setting) -> Scene:
    """Return the scene of a run; a strength of 0 leaves the set's."""
    table = tomllib.loads(_SCENE)
    table["film"]["points"] = setting.points
    table["operation"] |= {f"speed_{k + 1}": f"{setting.speeds[k]!r} m/s" for k in (0, 1)}
    table["wear"] |= {"bare": setting.wear, "film": setting.wear}
    table["stress"]["instants"] = table["control"]["dry_instants"] = setting.instants
    table["stress"]["pits"] = "open"
    table["control"]["longest"] = f"{setting.longest} s"
    if setting.strength:
        table["fatigue"]["single_strength"] = f"{setting.strength!r} MPa"
    scene = Scene.from_dict(table)
    roller, disc = surfaces(setting)
    spacing = DOMAIN / disc.shape[1]
    return scene.with_heights(1, roller, spacing, "m", beyond="repeated").with_heights(
        2, disc, spacing, "m", beyond="repeated"
    )


def surfaces(setting: Setting) -> tuple[Array, Array]:
    """Return new heights [m] of roller and disc; the disc of a longitudinal lay is that of the transverse one, turned."""
    nodes = setting.points - 1
    disc = RQ_DISC * _skewed(_gaussian(LENGTH, LENGTH * RATIO, 2 * setting.seed, nodes))
    roller = RQ_ROLLER * _gaussian(LENGTH, LENGTH, 2 * setting.seed + 1, nodes)
    return roller, disc if setting.lay == "transverse" else disc.T


def _gaussian(x: float, y: float, seed: int, nodes: int) -> Array:
    """Return Gaussian heights of rms 1 and of correlation lengths [m], the same waves on every number of nodes."""
    waves = 32  # of the shortest kept: 12.5 um
    random = np.random.default_rng(seed).standard_normal((2, 2 * waves, waves))
    q = 2.0 * np.pi / DOMAIN
    along, across = q * np.arange(waves), q * np.fft.fftfreq(2 * waves, 1.0 / (2 * waves))
    power = np.exp(-((x * along[None, :]) ** 2 + (y * across[:, None]) ** 2) / 8.0)
    spectrum = np.zeros((nodes, nodes // 2 + 1), np.complex128)
    rows = np.fft.fftfreq(2 * waves, 1.0 / (2 * waves)).astype(int)
    spectrum[rows, :waves] = power * (random[0] + 1j * random[1])
    spectrum[0, 0] = 0.0
    heights = np.fft.irfft2(spectrum, s=(nodes, nodes))
    return (heights - heights.mean()) / heights.std()


def _skewed(heights: Array) -> Array:
    """Return heights in the same order, of a gamma distribution of `SKEWNESS`, of rms 1."""
    shape = 4.0 / SKEWNESS**2
    drawn = -gamma.ppf(norm.sf(heights), shape)
    return (drawn - drawn.mean()) / drawn.std()


def run(setting: Setting) -> Run:
    """Return a run, a kept one if there is one."""
    path = _place(setting)
    if path.exists():
        with np.load(path) as stored:
            return Run(**{name: stored[name] for name in Run._fields})
    scene = scene_of(setting)
    state, point = initial_state(scene), scene.operation.point
    worst = np.zeros(state.bodies[0].wear.shape)
    areas, stresses = [], []
    for _ in range(TIMES):
        state, out = advance(scene, point, state, setting.duration / TIMES)
        assert state.below is not None
        layers = state.below.damage_1.reshape(scene.depths.size, *worst.shape)
        worst = np.maximum(worst, layers.max(axis=0))
        areas.append((out.micropitted_area_1, out.micropitted_area_2))
        stresses.append(out.dang_van_ratio)
    found = Run(
        worst,
        state.bodies[0].pits,
        np.array(areas).T,
        np.array([out.roughness_1, out.roughness_2]),
        out.wear_depth_1,
        out.blocks_dry,
        out.error_damage,
        np.array(stresses),
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(path, **found._asdict())
    return found


def _place(setting: Setting) -> Path:
    name = hashlib.sha256(f"{_SCENE}{setting!r}{LENGTH}{RATIO}{SKEWNESS}".encode()).hexdigest()[:16]
    return kept(PAGE) / f"{name}.npz"


def failed(found: Run, strength: float) -> NDArray[np.bool_]:
    """Return where damage would have reached 1 at a strength for one cycle [MPa], before pits change the contact.

    Damage per cycle is in proportion to exp(-strength / fall).
    """
    return found.damage * np.exp((UNBROKEN - strength) / line_of_lives()[1]) >= 1.0
