"""Share of the load on the solids over lambda: solved contacts beside published fits of rigid roughness."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy

from contact_core import OperatingPoint, Outputs, Scene, advance, initial_state
from contact_core.laws.asperity_layer import ELASTIC_HEIGHT, PLASTIC_HEIGHT
from contact_core.scene import Case

from .model import Outcome, Row, compared
from .tables import read

PAGE = "docs/measured/surfaces.md"
LEFT_OUT = "mk_caseB"  # its formula was written down from memory, for one contact
LAMBDAS = (0.75, 1.25)  # of the table
_THICKEST = 1.5  # lambda, beyond which fits fall to 0
_REASON = "least and largest of seven published fits, none measured"
FASTEST = 99.0  # m/s, of a surface
NODES = 65

_FLATTENED = (
    "no fit for it: the fits leave roughness rigid; here oil presses long waves flat, the more so under sliding, and "
    f"waves below the grid are too low to cross the film: {PAGE}"
)
_HARD = (
    "no fit for it: the fits are 1 at lambda 0 whatever the load; roughness as steep as this would carry several times "
    f"the load there: {PAGE}"
)

# Surfaces of a roller bearing by their traces, less the line that the instrument adds: contact_core/data/finishes.toml
_LENGTHS, _BELOW = ("18 um", "6 um"), 0.2  # correlation lengths along the lay and across it; rms below 4 um over Rq
_OF_BOTH = 0.5**0.5  # of the composite roughness, on each of two like bodies


def line_contact(surface: Mapping[str, str]) -> dict[str, str]:
    """Return the changes that make the scene `fzg_flank` a roller on a raceway, both with such a surface.

    A line contact of 4 mm radius at 1.2 GPa in rolling with 1 % of slip.
    """
    changes = {
        "geometry.radius_x": "4 mm", "geometry.face_width": "9 mm", "film.domain": "0.38 mm", "film.width": "0.19 mm",
        "operation.load": "1416 N", "operation.speed_1": "1.005 m/s", "operation.speed_2": "0.995 m/s",
    }  # fmt: skip
    return changes | {f"surface_{body}.{key}": value for body in (1, 2) for key, value in surface.items()}


def bearing(rq: float) -> dict[str, str]:
    """Return the changes that make `fzg_flank` a roller on a raceway of a composite roughness [m]."""
    along, across = _LENGTHS
    each = _OF_BOTH * rq
    return line_contact({
        "rq": f"{each:.4g} m", "correlation_length": along, "correlation_length_across": across,
        "microroughness.rms": f"{_BELOW * each:.4g} m", "microroughness.longest": "4 um",
    })  # fmt: skip


@dataclass(frozen=True)
class Contact:
    """A shipped scene with changes, and why it gets no verdict."""

    scene: str
    changes: Mapping[str, str]
    not_judged: str = ""


def composite(scene: Scene) -> float:
    """Return the rms height [m] of both bodies, with what is below the grid."""
    bodies = (scene.surface_1, scene.surface_2)
    parts = [part for body in bodies for part in (body.rms, body.microroughness.rms if body.microroughness else 0.0)]
    return float(np.linalg.norm(parts))


def at_lambda(scene: Scene, ratio: float) -> OperatingPoint:
    """Return the scene's operating point at the speed that makes the film of smooth bodies `ratio` times Rq."""
    op, rough = scene.operation.point, composite(scene)

    def faster(log: float) -> OperatingPoint:
        times = float(np.exp(log))
        return replace(op, speed_1=op.speed_1 * times, speed_2=op.speed_2 * times)

    def excess(log: float) -> float:
        return float(np.log(Case.bind(scene, faster(log)).smooth_film / (ratio * rough)))

    most = np.log(FASTEST / max(abs(op.speed_1), abs(op.speed_2)))
    return faster(float(scipy.optimize.brentq(excess, most - 16.0, most, xtol=1e-4)))


def scene_of(name: str, changes: Mapping[str, str]) -> Scene:
    """Return a scene at the deterministic level on a small grid, with changes; a block takes 24 instants."""
    given = {"film.model": "deterministic", "film.points": str(NODES), "control.mixed_instants": "24"}
    return Scene.from_toml(name, given | dict(changes))


def solved(name: str, ratio: float, changes: Mapping[str, str], seed: int | None = None) -> Outputs:
    """Return the outputs of one solved block of fresh surfaces of a scene, at a lambda."""
    scene = scene_of(name, changes)
    op = at_lambda(scene, ratio)
    scene = scene if seed is None else scene.realisation(seed)
    return advance(scene, op, initial_state(scene), 0.0)[1]


def fits() -> dict[str, dict[float, float]]:
    """Return the share of the load on the solids by each published fit, over lambda."""
    rows = read("asperity_load_share.csv")
    names = [name for name in rows[0] if name not in ("lambda", LEFT_OUT)]
    return {name: {row["lambda"]: row[name] for row in rows if np.isfinite(row[name])} for name in names}


def band(ratio: float) -> tuple[float, float]:
    """Return the least and the largest share of the fits at a lambda of the table."""
    shares = [over[ratio] for over in fits().values() if ratio in over]
    return min(shares), max(shares)


CONTACTS = {
    "mtm_zddp": Contact("mtm_zddp", {}),
    "azam_case_a": Contact("azam_case_a", {}),
    "fzg_flank": Contact("fzg_flank", {}, _FLATTENED),
    "ball_209_inner": Contact("ball_209_inner", {}, _FLATTENED),
    "pin_on_disc": Contact("pin_on_disc", {}, _FLATTENED),
    "raceway, Rq 0.16 um": Contact("fzg_flank", bearing(0.16e-6), _HARD),
    "rib, Rq 0.24 um": Contact("fzg_flank", bearing(0.24e-6), _HARD),
    "fine raceway, Rq 0.10 um": Contact("fzg_flank", bearing(0.10e-6), _HARD),
}


def _statistics(ratio: float) -> Row:
    """Compare our law of dry roughness, read as the fits are: pressure at a mean gap over that without one."""
    elastic, yielding = (float(np.exp(-ratio / height)) for height in (ELASTIC_HEIGHT, PLASTIC_HEIGHT))
    return Row(
        f"dry roughness by the fits' method, lambda {ratio:g}", "", band(ratio), 0.5 * (elastic + yielding), 0.0,
        _REASON, 0.5 * abs(yielding - elastic),
    )  # fmt: skip


def _contact(name: str, k: int) -> Row:
    contact, ratio = CONTACTS[name], LAMBDAS[k]
    out, of_fits = solved(contact.scene, ratio, contact.changes), band(ratio)
    return Row(
        f"{name}, lambda {ratio:g}", "", of_fits, out.contact_load_ratio, 0.0, _REASON, out.error_load_ratio,
        not_judged=contact.not_judged,
    )  # fmt: skip


def run() -> Outcome:
    """Compare our law of dry roughness, read as the fits are, and one block of solved contacts at each lambda."""
    ratios = [ratio for ratio in fits()["erfc"] if ratio <= _THICKEST]
    law = [_statistics(ratio) for ratio in ratios]
    rows = [*law, *(_contact(name, k) for name in CONTACTS for k in range(len(LAMBDAS)))]
    at, shares = zip(*((x, y) for over in fits().values() for x, y in over.items() if x <= _THICKEST), strict=True)
    computed = np.array(ratios), np.array([row.computed for row in law])
    curve = compared(
        "our dry roughness by the method of the fits", "lambda", "share of the load on the solids",
        (np.array(at), np.array(shares)), computed, logarithmic=True,
    )  # fmt: skip
    return Outcome(tuple(rows), (curve,))
