"""Deterministic mixed lubrication: fluid and solid pressure node by node, from full film to dry contact."""

from dataclasses import dataclass
from typing import ClassVar

from ..quantities import parameter
from .instant import FilmSolution, FilmState, Grid, Instant, Settings, Step


@dataclass(frozen=True)
class Deterministic:
    """Reynolds' equation for the fluid on every node, solids where the gap is at its floor, 0 <= p <= hardness.

    The half space deforms under the sum of both pressures. The grid is square and centred on the contact.
    """

    name: ClassVar[str] = "deterministic"
    source: ClassVar[str] = (
        "Azam et al. 2019, doi:10.1016/j.triboint.2018.11.011; the split of fluid and solid pressure is ours"
    )

    on_grid: ClassVar[bool] = True  # the contact is solved on the nodes, which must hold it

    points: int = parameter("", "grid nodes along x and along y", least=17, most=4097, shapes_arrays=True)
    domain: float = parameter(
        "m", "side of the square grid, centred on the contact", above=0.0, most=1.0, shapes_arrays=True
    )
    floor: float = parameter(
        "m", "gap at which solids touch: thickness of the adsorbed boundary layer", above=1e-11, most=1e-7
    )
    width: float = parameter(
        "m",
        "extent of the grid along y; 0: as along x, for a roller its length, for smooth lines a single row",
        least=0.0,
        most=1.0,
        default=0.0,
        shapes_arrays=True,
    )
    tolerance: float = parameter(
        "", "pressure change at which a solution counts as converged, relative", above=0.0, most=0.1, default=3e-3
    )
    iterations: int = parameter(
        "",
        "most iterations of one steady solution; an instant of a block gets at most 150",
        least=1,
        most=100_000,
        default=2000,
    )
    fft: str = parameter("", "library of the Fourier transforms", choices=("pyfftw", "scipy"), default="pyfftw")
    criterion: str = parameter(
        "",
        "split: fluid and solid pressure apart; lumped: one pressure for both, as in the thesis (floor = 0.47 nm)",
        choices=("split", "lumped"),
        default="split",
    )

    @property
    def spacing(self) -> float:
        """Distance between nodes [m]."""
        return self.domain / (self.points - 1)

    def with_sharing(self, sharing: object) -> "Deterministic":
        """Return itself: this level shares the load node by node."""
        return self

    def warnings(self, lubricant: object, tribofilm: object) -> list[str]:
        """Return no sentence: this level resolves every law."""
        return []

    def solve(
        self,
        now: Instant,
        grid: Grid,
        start: FilmState | None = None,
        step: Step | None = None,
        iterations: int | None = None,
    ) -> FilmSolution:
        """Solve one instant as `routes.solve_film`; `iterations`: fewer than the scene allows."""
        from .routes import solve_film  # the kernels: loaded where a film is solved

        most = min(iterations or self.iterations, self.iterations)
        settings = Settings(self.floor, self.tolerance, most, self.fft, self.criterion == "lumped")
        return solve_film(now, grid, settings, start, step)
