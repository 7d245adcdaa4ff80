"""The record of a map: numbers, its file, and the scene that it belongs to."""

import hashlib
import json
from dataclasses import asdict, dataclass, fields
from importlib.resources import files
from pathlib import Path
from typing import Any

from ..errors import SceneError
from ..film.regression import MAP_SUFFIX, map_file
from ..scene import Scene
from .correction import CORRECTED
from .places import Place

Numbers = tuple[float, ...]
OUTPUTS = tuple(CORRECTED)  # in the order of `weights`, `uneven` and `own`
COORDINATES = (  # of a contact by the regression level, in the order of `query.coordinates`
    *Place._fields,
    "cover",  # mean cover of both bodies by tribofilm
    "roughness",  # ln of composite roughness over that of new surfaces
    "speed",  # ln of the entrainment speed in m/s
    "temperature",  # of the oil that is drawn in [K]
    "raised_1",  # by which the tribofilm of body 1 makes it rougher, over composite roughness of new surfaces
    "raised_2",  # likewise of body 2
    "worn_1",  # ln of (roughness of the solid of body 1 over that of a new one + 0.01)
    "worn_2",  # likewise of body 2
    "lead",  # s / (|s| + 0.1), s being how much faster the rougher body is over the entrainment speed
    "width",  # ln of Hertz's half width along x over the correlation length of the rougher body
)
STEEPEST = 3.0  # largest logarithm of a factor
_FORMAT = 2
_APART = ("name", "description", "operation", "control", "intervals")  # parts of a scene that no map depends on


@dataclass(frozen=True)
class Map:
    """A map of one scene; coordinates are scaled to -1..1 over their ranges.

    Term 0 is 1, and each other one is an earlier term times a coordinate. A polynomial is the sum of terms with
    weights.
    """

    scene: str  # name of it
    digest: str  # fingerprint of what a map of it depends on
    ranges: tuple[tuple[str, float, float], ...]  # of the operating points: name, lowest, highest [SI]
    knots: int  # solved contacts that it is made of
    picked: tuple[int, ...]  # its coordinates, by their place in `COORDINATES`
    centres: Numbers
    halves: Numbers  # half the range of each coordinate
    least_slip: float  # smallest sliding over entrainment speed of the knots
    radii: Numbers  # smallest and largest radius along x of the knots [m]
    term: tuple[int, ...]  # of each term but the first: the earlier term
    coordinate: tuple[int, ...]  # and the coordinate that it is multiplied by
    weights: tuple[Numbers, ...]  # of ln of the factors of friction, h_c, and W_c / (1 - W_c)
    spread: tuple[Numbers, ...]  # triangle: the squares of these sums of terms add up to the variance by few knots
    uneven: tuple[Numbers, ...]  # weights of ln half width (95 %) about a polynomial: of 1 and of each coordinate
    own: tuple[Numbers, ...]  # likewise of the half width of what all solutions share: grid and iteration

    @property
    def cost(self) -> int:
        """Multiplications and additions of one query, as pairs."""
        rows = sum(len(row) for row in self.spread)
        return len(self.term) + rows + len(self.spread) + sum(map(len, (*self.weights, *self.own, *self.uneven)))

    def to_text(self) -> str:
        """Return the map as JSON; equal maps give equal text."""
        return json.dumps({"format": _FORMAT, **asdict(self)}, indent=None, separators=(",", ":")) + "\n"

    @staticmethod
    def from_text(text: str, source: str) -> "Map":
        """Return the map that `to_text` wrote. Raises SceneError if it is damaged or of another version."""
        try:
            table = json.loads(text)
            found = table.pop("format")
            if found != _FORMAT:
                raise SceneError(
                    f"The map '{source}' has format {found}; this version reads {_FORMAT}. Make it anew: tribofmu map."
                )
            return Map(**{f.name: _frozen(table[f.name]) for f in fields(Map)})
        except (ValueError, KeyError, AttributeError, TypeError) as error:
            raise SceneError(f"The map '{source}' is damaged ({error!r}). Make it anew: tribofmu map.") from None


def _frozen(value: Any) -> Any:
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


def digest_of(scene: Scene) -> str:
    """Return the fingerprint of what a map of a scene depends on: all but its duty, control and name."""
    table = scene.at_level("map").to_dict()
    parts = {key: value for key, value in table.items() if key not in _APART}
    parts["film"] = {key: value for key, value in table["film"].items() if key not in ("model", "correction", "file")}
    parts["tribofilm"] = {key: value for key, value in table["tribofilm"].items() if key != "beyond_fit"}
    for surface in (parts["surface_1"], parts["surface_2"]):
        surface.get("heights", {}).pop("file", None)  # wherever they lie
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:16]


def map_of(scene: Scene) -> Map:
    """Return the map of a scene at the level of maps, read once and kept with it.

    Raises SceneError if there is none, or if it is one of another scene.
    """
    kept: Map | None = vars(scene).get("_map")
    if kept is None:
        file = map_file(scene.film) or scene.name
        kept = checked(scene, read(file), file)
        vars(scene)["_map"] = kept
    return kept


def checked(scene: Scene, found: Map, source: str) -> Map:
    """Return a map as it is. Raises SceneError if it is one of another scene."""
    digest = digest_of(scene)
    if found.digest != digest:
        raise SceneError(
            f"The map '{source}' belongs to another contact (fingerprint {found.digest}, scene '{scene.name}' has "
            f"{digest}): all but operation, control and name must be the same. Make one of this scene: tribofmu map "
            f"{scene.name}, and name it in film.file."
        )
    return found


def read(name: str) -> Map:
    """Return a map from a file, or a shipped one by name. Raises SceneError if there is none."""
    shipped = files("contact_core") / "data" / "maps" / f"{name}{MAP_SUFFIX}"
    try:
        if name.endswith(MAP_SUFFIX):
            text = Path(name).read_text("utf-8")
        elif "/" not in name and shipped.is_file():
            text = shipped.read_text("utf-8")
        else:
            raise SceneError(
                f"There is no shipped map '{name}'. Shipped are {', '.join(shipped_maps()) or 'none'}. Make one: "
                f"tribofmu map {name}, and give its .json file in film.file."
            )
    except OSError as error:
        raise SceneError(
            f"The map '{name}' cannot be read: {error.strerror}. Give the .json file that tribofmu map has written."
        ) from None
    return Map.from_text(text, name)


def shipped_maps() -> list[str]:
    """Return the names of the shipped maps."""
    folder = files("contact_core") / "data" / "maps"
    names = (entry.name for entry in folder.iterdir()) if folder.is_dir() else iter(())
    return sorted(name.removesuffix(MAP_SUFFIX) for name in names if name.endswith(MAP_SUFFIX))
