"""The regression level: film formulas and curves of load sharing for the means of rough surfaces."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar

from ..laws.base import Rheology, Tribofilm
from ..laws.equations import Equations, OfShape
from ..laws.load_sharing import FittedSharing
from ..quantities import parameter

# what may correct the level, and the fidelity that it then has
CORRECTIONS = {"none": "regression", "blocks": "auto", "map": "map"}
MAP_SUFFIX = ".json"  # of files of maps


@dataclass(frozen=True)
class Regression:
    """One mean film and one mean real contact instead of fields: microseconds per step.

    The grid is that of the patches in the state, on which nothing is solved at this level: with the same grid, a run
    changes between this level and the deterministic one at any step.
    """

    name: ClassVar[str] = "regression"
    source: ClassVar[str] = (
        "film: Nijenbanning, Venner & Moes 1994, doi:10.1016/0043-1648(94)90150-3, "
        "formula: reference/point_films.py; sharing: see its source; "
        "smoothing: fitted to solved contacts"
    )

    on_grid: ClassVar[bool] = False
    lumped: ClassVar[bool] = False  # solids and oil have pressures of their own

    friction: ClassVar[Equations] = Equations(
        (
            "F = −(μ W_c W + κ ⟨τ_{oil}⟩ A_{oil}) (u_1 − u_2)/|u_1 − u_2|,   κ = c^{exp[(0.45 − s)/1.15]}",
            "τ_N = η(p, T) |u_1 − u_2|/h_c",
            "A_{oil} = (1 − W_c) A_H/k,   p = k p_H",
            "k = [1 + K t^{−w} exp(−d Z t^{−q})] [(1 + S h_s R_x/a^2) (1 + S h_s R_y/b^2)]^{−1/2},   t = s/0.2",
        ),
        "⟨τ⟩ is the mean stress of the oil under k times the Hertz pressure, on the share 1/k of the Hertz area A H: "
        "between rough bodies oil carries load in spots; a thick film carries it on a larger area, of lines along x "
        "only. No pressure exceeds the hardness. κ: uneven pressure shears less than even pressure, for the limiting "
        "stress cuts its peaks; between smooth bodies it is even.",
        title="Friction",
        symbols={
            "c": "constant of load sharing, film.sharing.oil_kept [1]",
            "K": "constant of load sharing, film.sharing.oil_pressure_excess [1]",
            "w": "constant of load sharing, film.sharing.oil_steepness [1]",
            "d": "constant of load sharing, film.sharing.oil_pressure_decay [1]",
            "q": "constant of load sharing, film.sharing.oil_pressure_power [1]",
            "S": "constant of load sharing, film.sharing.oil_spread [1]",
            "Z": "film of the smooth bodies by formula over composite rms roughness [1]",
            "s": "flattening of the roughness on the grid [1]",
            "A_H": "area of Hertz's contact [m2]",
        },
    )

    points: int = parameter(
        "", "nodes of the state's patches along x and along y", least=17, most=4097, default=129, shapes_arrays=True
    )
    domain: float = parameter(
        "m", "side of the state's patches", above=0.0, most=1.0, default=0.5e-3, shapes_arrays=True
    )
    floor: float = parameter(
        "m", "gap at which solids touch: thickness of the adsorbed boundary layer", above=1e-11, most=1e-7, default=1e-9
    )
    width: float = parameter(
        "m",
        "extent of the grid along y; 0: as along x, for a roller its length, for smooth lines a single row",
        least=0.0,
        most=1.0,
        default=0.0,
        shapes_arrays=True,
    )
    sharing: FittedSharing = field(default=FittedSharing())
    smoothing: float = parameter(
        "",
        "mean height of what touches, over composite roughness: wear takes it away",
        least=0.0,
        most=5.0,
        default=2.3,
    )

    correction: str = parameter(
        "",
        "what corrects friction, h_c and W_c. blocks: deterministic ones, where friction or film are less sure than "
        "control.accuracy, 10 % without it; map: a map of solved contacts (tribofmu map)",
        choices=tuple(CORRECTIONS),
        default="none",
    )
    file: str = parameter(
        "", "the map: a file, or the name of a shipped one; empty: the shipped one of the scene's name", default=""
    )

    tolerance: ClassVar[None] = None  # of a solution: nothing is iterated

    @property
    def fidelity(self) -> str:
        """Name of the level with its correction, one of `quantities.LEVELS`."""
        return CORRECTIONS[self.correction]

    @property
    def spacing(self) -> float:
        """Distance between nodes [m]."""
        return self.domain / (self.points - 1)

    def with_sharing(self, sharing: FittedSharing) -> "Regression":
        """Return the record with other curves of load sharing."""
        return replace(self, sharing=sharing)

    def warnings(self, flow: str, rheology: Rheology, tribofilm: Tribofilm) -> list[str]:
        """Return sentences on laws of a scene that this level approximates."""
        found = []
        if flow == "local" and rheology.thins and rheology.inlet_thinning is None:
            found.append("film.model = 'regression' thins films by shear for the rheology 'carreau' only.")
        if tribofilm.abrades:
            found.append(
                f"tribofilm.model = '{tribofilm.name}' depends on local stresses; film.model = 'regression' knows "
                "their mean and takes them as exponentially distributed: within a factor of two to four."
            )
        return found

    def governing(self, geometry: OfShape, lubricant: Any) -> tuple[Equations, ...]:
        """Return the equations of a contact of this geometry and lubricant at this level, for documentation."""
        thinning = lubricant.rheology.inlet_thinning if lubricant.flow == "local" else None
        return geometry.smooth_film, geometry.rolling, *([thinning] if thinning else [])


def map_file(film: Any) -> str | None:
    """Return the map that a record names, empty: the shipped one of the scene's name; None without a map."""
    return film.file if film.fidelity == "map" else None


def with_map_found(film: Any, folders: tuple[Path, ...]) -> Any:
    """Return a record with the path of the file of its map as found in one of the folders, if there is any."""
    file = map_file(film)
    if file is not None and file.endswith(MAP_SUFFIX):
        for folder in folders:
            if (folder / file).is_file():
                return replace(film, file=str((folder / file).resolve()))
    return film
