"""The runs that `validation.py` judges: scenes, numerics, and their results on disk."""

import hashlib
import json
import math
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.claims import kept
from contact_core import ContactError, ContactState, Scene, advance, initial_state, uncertainty
from contact_core.laws.tribofilm import thickness
from contact_core.scene.toml import flat
from contact_core.surfaces.patches import bare_heights, heights_of, roughness_of
from contact_core.surfaces.roughness import rms_roughness

SECTION = "thesis/validation"
INTERVAL = 60.0  # s between two rows
SNAPSHOTS = (1, 5, 10, 20)  # minutes at which the tribofilm is kept whole
SRR = (-10.0, -5.0, -2.0, -0.5, 0.5, 2.0, 5.0, 10.0)  # percent
SEEDS = (1, 2, 3, 4, 5)

# Columns of the page: changes of the shipped scenes. "ours" has none; "joint" has scenes of its own.
NUMERICS: dict[str, dict[str, str]] = {
    "thesis": {
        "film.points": "129",
        "film.domain": "0.5 mm",
        "film.criterion": "lumped",
        "film.flux": "upwind",
        "film.floor": "0.47 nm",
        "surface_1.microroughness.rms": "0 nm",
        "surface_2.microroughness.rms": "0 nm",
        "plasticity.indentation": "none",
        "tribofilm.dose": "clock",
        "wear.sliding": "difference",
        "control.driver": "mixed",
        "film.iterations": "20",  # one pressure never converges on this grid; 300 give the first instant to 1 %
    },
    "ours": {},
    "joint": {},
}
BARE = {"tribofilm.model": "none"}
SMOOTH = {**BARE, "surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "wear.model": "none"}
# viscosity at which Hamrock and Dowson's film is 0.04 of the composite roughness
THIN = {"lubricant.viscosity.viscosity": "0.65 mPa s"}
NEAR_WHITE = {"surface_1.correlation_length": "4 um", "surface_2.correlation_length": "4 um"}

CLOCK = {"tribofilm.dose": "clock"}
DRY = {"control.driver": "dry"}
DRY_SLIDING = DRY | {"wear.sliding": "difference"}
LESS_WEAR = {"wear.bare": "3e-6", "wear.film": "3e-7"}
WHITE_129 = {
    "film.points": "129",
    "surface_1.correlation_length": "3.90625 um",
    "surface_2.correlation_length": "3.90625 um",
}

OURS = ("ours",)  # columns of experiments, scatter and costly cases
JOINT = ("joint",)

Array = np.ndarray


class Missing(Exception):  # noqa: N818
    """A run that a judgement needs has not been made."""


@dataclass(frozen=True)
class Trial:
    """Version of the runs: the shipped scenes for two hours, or a shorter trial."""

    hours: float = 2.0
    points: int = 0  # 0: those of the scene

    @property
    def real(self) -> bool:
        """Whether the runs are full results."""
        return self == Trial()

    def changes(self) -> dict[str, str]:
        """Changes of the scene."""
        if not self.points:
            return {}
        return {"film.points": str(self.points), "film.tolerance": "1e-2", "film.iterations": "60"}


@dataclass(frozen=True)
class Case:
    """A shipped scene with changes. `srr` [%] is 2 (u_ball - u_disc) / (u_ball + u_disc); the ball is body 1."""

    name: str
    scene: str
    text: str
    changes: Mapping[str, str] = field(default_factory=dict)
    srr: float | None = None
    numerics: tuple[str, ...] = tuple(NUMERICS)
    rubs: bool = True  # else its first instant only

    def in_numerics(self, numerics: str, trial: Trial) -> Scene:
        """The scene that is run."""
        name = f"{self.scene}_thesis" if numerics == "joint" else self.scene
        changes = {**NUMERICS[numerics], **self.changes, **trial.changes()}
        changes = {key: value for key, value in changes.items() if not _dropped(key, self.changes)}
        if self.srr is not None:
            point = Scene.from_toml(name).operation.point
            for i, sign in ((1, 1.0), (2, -1.0)):
                speed = point.entrainment_speed * (1.0 + sign * self.srr / 200.0)
                changes[f"operation.speed_{i}"] = f"{speed:.9g} m/s"
        if trial.points:
            node = 500.0 / (trial.points - 1)
            for i in (1, 2):
                key = f"surface_{i}.correlation_length"
                length = float(changes.get(key, "7.8125 um" if numerics == "joint" else "8 um").split()[0])
                changes[key] = f"{max(length, 1.001 * node):.6g} um"
        return Scene.from_toml(name, changes)

    def file(self, numerics: str, trial: Trial) -> Path:
        """File of the results; its name contains a fingerprint of all inputs."""
        put_in = json.dumps(
            [self.in_numerics(numerics, trial).to_dict(), trial.hours, INTERVAL, self.rubs], sort_keys=True
        )
        return kept(SECTION) / f"{self.name}-{numerics}-{hashlib.sha256(put_in.encode()).hexdigest()[:12]}.npz"


def _dropped(key: str, changes: Mapping[str, str]) -> bool:
    """Whether a convention of a column belongs to a law that a case replaces."""
    slot = key.split(".")[0]
    other = changes.get(f"{slot}.model") or changes.get(f"{slot}.set")
    return other is not None and key not in changes


def srr_name(srr: float, group: str = "A") -> str:
    """Name of a case of set A at a slide-to-roll ratio [%]."""
    return group if srr == -2.0 else f"{group}_srr{srr:+g}"


def _cases() -> list[Case]:
    a, b = "azam_case_a", "mtm_zddp"
    found = [Case(srr_name(srr), a, f"set A, SRR {srr:+g} %", srr=srr) for srr in SRR]
    found += [
        Case("A_bare", a, "set A without additive", BARE),
        Case("B", b, "set B, 80 degC"),
        Case("B_bare", b, "set B without additive", BARE),
    ]
    # experiments that look for the cause of a difference
    sliding = "boundary lubrication, wear by u_1 - u_2"
    no_removal = {"tribofilm.removal_thickness": "0 nm"}
    found += [
        Case("A_no_removal", a, "set A, SRR +2 %, film without removal", no_removal, 2.0),
        Case("A_andersson", a, "set A, SRR +2 %, Andersson's law", {"tribofilm.set": "andersson_90c"}, 2.0),
        Case("A_length", a, "set A, dose by contact length", {"tribofilm.dose": "contact_length"}, numerics=OURS),
        Case("A_clock", a, "set A, dose by the clock", CLOCK, numerics=OURS),
        Case("A_dry", a, "set A, boundary lubrication", DRY, numerics=JOINT),
        *(
            Case(srr_name(srr, "A_sliding"), a, f"set A, SRR {srr:+g} %, {sliding}", DRY_SLIDING, srr, numerics=JOINT)
            for srr in SRR
        ),
        Case("A_sliding_clock", a, f"set A, {sliding}, dose by the clock", DRY_SLIDING | CLOCK, numerics=JOINT),
        Case("B_sliding", b, f"set B, {sliding}", DRY_SLIDING, numerics=JOINT),
        Case("B_bare_sliding", b, f"set B without additive, {sliding}", BARE | DRY_SLIDING, numerics=JOINT),
        Case("B_less", b, f"set B, {sliding}, less", DRY_SLIDING | LESS_WEAR, numerics=JOINT),
        Case(
            "B_bare_less", b, f"set B without additive, {sliding}, less", BARE | DRY_SLIDING | LESS_WEAR, numerics=JOINT
        ),
        Case("A_129", a, "set A on 129 nodes, white on them, first instant", WHITE_129, numerics=JOINT, rubs=False),
        Case(
            "A_smooth_fitted",
            a,
            "set A, smooth bodies, fitted flow, first instant",
            SMOOTH | {"film.flux": "fitted"},
            numerics=JOINT,
            rubs=False,
        ),
        Case("A_white", a, "set A, correlation length of one node", NEAR_WHITE, numerics=OURS),
        Case("A_thin", a, "set A, viscosity for λ = 0.04", THIN, numerics=OURS),
        Case("A_smooth", a, "set A, smooth bodies, first instant", SMOOTH, rubs=False),
        Case("B_smooth", b, "set B, smooth bodies, first instant", SMOOTH, rubs=False),
    ]
    for k in SEEDS[1:]:
        seeds = {"surface_1.seed": str(2 * k - 1), "surface_2.seed": str(2 * k)}
        for name, scene, changes in (("A", a, {}), ("B", b, {}), ("B_bare", b, BARE)):
            found.append(Case(f"{name}_seed{k}", scene, f"{name}, roughness {k}", {**changes, **seeds}, numerics=OURS))
    return found


CASES = {case.name: case for case in _cases()}


def compute(case: Case, numerics: str, trial: Trial) -> dict[str, Any]:
    """Run a case; arrays and numbers as they are stored."""
    scene = case.in_numerics(numerics, trial)
    op, start = scene.operation.point, time.process_time()
    state, out = advance(scene, op, initial_state(scene), 0.0)
    rows, films = [_row(scene, state)], {}
    for minute in range(1, 1 + round(trial.hours * 3600.0 / INTERVAL) if case.rubs else 1):
        state, out = advance(scene, op, state, INTERVAL)
        rows.append(_row(scene, state))
        if minute in SNAPSHOTS:
            films |= {f"film_{i}_{minute}": film for i, film in enumerate(_films(state), 1)}
    hertz = scene.hertz(op.load)
    last = {f"film_{i}_end": film for i, film in enumerate(_films(state), 1)}
    for i, (bare, body) in enumerate(zip(bare_heights(scene, state.rows), state.bodies, strict=True), 1):
        last |= {f"wear_{i}": body.wear, f"heights_{i}": heights_of(bare, body)}
    table = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    maps = {name: array.astype(np.float32) for name, array in (films | last).items()}
    facts = {"a": hertz.a, "pressure_hertz": hertz.pressure_max, "radius": scene.geometry.radius_x}
    return {
        **{f"row.{name}": values for name, values in table.items()},
        **{f"map.{name}": values for name, values in maps.items()},
        **facts,
        "spacing": scene.film.spacing,
        "load": op.load,
        "blocks": out.blocks_mixed + out.blocks_dry + out.blocks_fallback,
        "seconds": time.process_time() - start,
        "scene": json.dumps(scene.to_dict(), sort_keys=True),
    }


def _films(state: ContactState) -> list[Array]:
    return [thickness(body.growth, body.removal) for body in state.bodies]


def _row(scene: Scene, state: ContactState) -> dict[str, float]:
    """Outputs, their errors by time steps and by sampling, means over the whole patches, roughness under the films."""
    row: dict[str, float] = {"time": state.time, **asdict(state.outputs)}
    for name, error in uncertainty(scene, state).items():
        row |= {f"{name}.by_steps": error.time, f"{name}.by_sampling": error.sampling}
    bare, a = bare_heights(scene, state.rows), scene.hertz(scene.operation.load).a
    for i, (body, film) in enumerate(zip(state.bodies, _films(state), strict=True), 1):
        rows = film.shape[0]
        middle = np.abs(np.arange(rows) - 0.5 * (rows - 1)) * scene.film.spacing < 2.0 / 3.0 * a
        steel = roughness_of(bare[i - 1], heights_of(bare[i - 1], body) - film)
        row |= {f"roughness_steel_{i}": rms_roughness(steel, middle)}
        row |= {f"grown_{i}": body.growth.mean(), f"removed_{i}": body.removal.mean(), f"film_{i}": film.mean()}
        row |= {f"plastic_{i}": body.plastic.mean()}
    return row


def run(name: str, numerics: str, trial: Trial) -> str:
    """Run a case and store it, all or nothing. Returns a line about it."""
    case = CASES[name]
    file = case.file(numerics, trial)
    found = compute(case, numerics, trial)
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_suffix(".part.npz")
    np.savez_compressed(part, **found)
    part.replace(file)
    return f"{found['blocks']:.0f} blocks, {found['seconds']:.1f} s"


class Run:
    """Results of a case in SI: `run["h_c"]` is a column over the rows, `t` their time [min]."""

    def __init__(self, file: Path):
        with np.load(file) as stored:
            self._stored = {name: stored[name] for name in stored.files}
        self.t: Array = self["time"] / 60.0

    def __getitem__(self, name: str) -> Array:
        """A column, or a number."""
        if name in self._stored:
            return self._stored[name]
        try:
            return self._stored[f"row.{name}"]
        except KeyError:
            raise Missing(f"no {name}") from None

    def map(self, name: str) -> Array:
        """A field on a patch [rows, nx - 1]."""
        try:
            return self._stored[f"map.{name}"].astype(np.float64)
        except KeyError:
            raise Missing(f"no {name}: the run is too short") from None

    def at(self, name: str, minute: float) -> float:
        """A column at a time."""
        if minute > self.t[-1] + 1e-6:
            raise Missing(f"run ends at {self.t[-1]:g} min")
        return float(np.interp(minute, self.t, self[name]))

    def end(self, name: str) -> float:
        """Its last value."""
        return float(self[name][-1])

    def mean(self, name: str, since: float = 0.0) -> float:
        """Its mean over time, from a minute on."""
        if since >= self.t[-1]:
            raise Missing(f"run ends at {self.t[-1]:g} min")
        return float(self[name][self.t >= since].mean())

    def y(self, field: str = "wear_1") -> Array:
        """Rows of a field on a patch [m]; a worn track may have added rows since it was kept."""
        rows = self.map(field).shape[0]
        return (np.arange(rows) - 0.5 * (rows - 1)) * float(self["spacing"])


def _same_scene(file: Path, tables: dict[str, Any], trial: Trial) -> bool:
    """Whether a kept run is as long as the trial and its scene the same in every field that both know, texts aside."""
    with np.load(file) as stored:
        then, last = flat(json.loads(str(stored["scene"]))), float(stored["row.time"][-1])
    now = {key: value for key, value in flat(tables).items() if key not in ("name", "description")}
    rubbed = math.isclose(last, 3600.0 * trial.hours) or last == 0.0
    return rubbed and all(value == now[key] for key, value in then.items() if key in now)


Get = Callable[[str], Run]


class Book:
    """All results of a trial; with `earlier`, also those that other sources have left of the same scenes."""

    def __init__(self, trial: Trial, earlier: bool = False):
        self.trial, self.earlier = trial, earlier
        self._runs: dict[tuple[str, str], Run] = {}
        self._files: dict[tuple[str, str], Path | None] = {}

    def get(self, name: str, numerics: str) -> Run:
        """The run of a case; raises Missing."""
        key = name, numerics
        if key not in self._runs:
            file = self.file(name, numerics)
            if file is None:
                raise Missing(f"{name} not run")
            self._runs[key] = Run(file)
        return self._runs[key]

    def file(self, name: str, numerics: str) -> Path | None:
        """The results of a case. A scene that this version of the core refuses has none."""
        key = name, numerics
        if key not in self._files:
            self._files[key] = self._found(name, numerics)
        return self._files[key]

    def _found(self, name: str, numerics: str) -> Path | None:
        if numerics not in CASES[name].numerics:
            return None
        try:
            file = CASES[name].file(numerics, self.trial)
            tables = CASES[name].in_numerics(numerics, self.trial).to_dict()
        except ContactError:
            return None
        if file.exists():
            return file
        old = kept(SECTION).parent.glob(f"*/{name}-{numerics}-*.npz") if self.earlier else ()
        alike = [path for path in old if _same_scene(path, tables, self.trial)]
        return max(alike, key=lambda path: path.stat().st_mtime, default=None)

    def has(self, name: str, numerics: str) -> bool:
        """Return whether the run of a case exists."""
        return self.file(name, numerics) is not None

    def is_earlier(self, name: str, numerics: str) -> bool:
        """Return whether a run is one of other sources."""
        file = self.file(name, numerics)
        return file is not None and file.parent != kept(SECTION)

    def getter(self, numerics: str, seed: int = 1) -> Get:
        """Cases of one numerics, of the shipped surfaces or those of another seed."""

        def get(name: str) -> Run:
            if seed != 1:
                name = f"{name}_seed{seed}"
                if name not in CASES:
                    raise Missing(f"no {name}")
            return self.get(name, numerics)

        return get


def centre_depth(r: Run, body: int) -> float:
    """Wear [m] in the middle of the track, |y| < a/10, mean over x."""
    return float(r.map(f"wear_{body}")[np.abs(r.y()) < 0.1 * r["a"]].mean())


def scar_half_width(r: Run, body: int) -> float:
    """|y| [m] within which the mean profile is above a twentieth of its deepest."""
    profile = r.map(f"wear_{body}").mean(axis=1)
    return float(0.5 * (profile > 0.05 * profile.max()).sum() * r["spacing"])
