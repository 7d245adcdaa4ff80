"""Deterministic mixed lubrication: fluid and solid pressure node by node, from full film to dry contact."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar

from ..kernels.arrays import Array
from ..laws.base import Rheology, Tribofilm
from ..laws.equations import Equations, OfShape
from ..laws.load_sharing import FittedSharing
from ..quantities import parameter
from .instant import FilmSolution, FilmState, Grid, Instant, Settings, Step

_GOVERNING = (
    Equations(
        (
            "∂/∂x [ρ h^3/(12 η) ∂p_f/∂x] + ∂/∂y [ρ h^3/(12 η) ∂p_f/∂y] = u_e ∂(ρ h)/∂x + ∂(ρ h)/∂t",
            "p_f ≥ 0,   u_e = (u_1 + u_2)/2",
        ),
        "At every node, with the squeeze of the passing roughness: `residual` in kernels/mixed/reynolds.py, "
        "and the flows between nodes in flow.py beside it.",
        title="Flow of the oil (Reynolds)",
        source="Reynolds 1886, doi:10.1098/rstl.1886.0005",
    ),
    Equations(
        ("h = h_0 + g(x, y) − z_1 − z_2 + d",),
        "g is the gap of the undeformed bodies (geometry), z the present heights of both surfaces with tribofilm, wear "
        "and plastic depth, d the elastic deformation.",
        title="Gap",
    ),
)
_CAVITATION = {
    "reynolds": Equations(
        ("p_f = 0 where it would be negative",),
        "The gap counts as full there, so that oil appears behind a cavity (Reynolds' outlet condition).",
        title="Oil under tension: lubricant.cavitation = reynolds",
        left_out=(
            "Conservation of oil in cavities: behind a ruptured film the gap counts as full, so oil appears there, and "
            "what it feeds comes out too thick. 'mass_conserving' keeps count."
        ),
    ),
    "mass_conserving": Equations(
        ("p_f ≥ 0,   0 ≤ θ ≤ 1,   p_f (1 − θ) = 0", "ρ h → θ ρ h in entrainment and squeeze"),
        "θ is the share of the gap that oil fills. Oil that flows into a cavity flows out of it (Jakobsson, Floberg, "
        "Olsson; Elrod).",
        title="Oil under tension: lubricant.cavitation = mass_conserving",
        source="Elrod 1981, doi:10.1115/1.3251669; as a complementarity: Giacopini et al. 2010, doi:10.1115/1.4002215",
    ),
}
_SHARING = {
    "split": Equations(
        (
            "h > h_{floor}:   p = p_f",
            "h = h_{floor}:   p = p_f + p_s,   p_s ≥ 0",
            "0 ≤ p ≤ hardness,   W_c = ∬ p_s dx dy / W",
        ),
        "Solids touch where the gap is at its floor, film.floor, the thickness of the adsorbed layer. Overlap beyond "
        "the hardness remains as plastic depth.",
        title="Solids and oil share the load: film.criterion = split",
    ),
    "lumped": Equations(
        (
            "h > h_{floor}:   p is the oil's",
            "h = h_{floor}:   p is the solids'",
            "0 ≤ p ≤ hardness",
        ),
        "One pressure for both: where the gap is at film.floor, all of it counts as solid pressure.",
        title="Solids and oil share the load: film.criterion = lumped",
    ),
}


@dataclass(frozen=True)
class Deterministic:
    """Reynolds' equation for the fluid on every node, solids where the gap is at its floor, 0 <= p <= hardness.

    The half space deforms under the sum of both pressures. The grid is square and centred on the contact.
    """

    name: ClassVar[str] = "deterministic"
    fidelity: ClassVar[str] = "deterministic"  # one of `quantities.LEVELS`
    source: ClassVar[str] = (
        "Azam et al. 2019, doi:10.1016/j.triboint.2018.11.011; the split of fluid and solid pressure is ours"
    )

    on_grid: ClassVar[bool] = True  # the contact is solved on the nodes, which must hold it
    friction: ClassVar[Equations] = Equations(
        (
            "F = −∬ (τ_{oil} + τ_{solid}) v_x/|v| dx dy,   v = (u_1 − u_2 − ω y, ω x)",
            "τ_N = η(p_f, T) |v|/h",
        ),
        "Summed over the nodes; the rheology gives the stress of the oil from the Newtonian stress τN.",
        title="Friction",
    )

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
        "most iterations of one steady solution; an instant of a block gets at most 300",
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
    flux: str = parameter(
        "",
        "flow through the faces between nodes. upwind: of second order; fitted: exact for a constant flow in each cell",
        choices=("fitted", "upwind"),
        default="fitted",
    )

    @property
    def spacing(self) -> float:
        """Distance between nodes [m]."""
        return self.domain / (self.points - 1)

    @property
    def lumped(self) -> bool:
        """True if one pressure is that of oil and solids."""
        return self.criterion == "lumped"

    def with_sharing(self, sharing: FittedSharing) -> "Deterministic":
        """Return itself: this level shares the load node by node."""
        return self

    def warnings(self, flow: str, rheology: Rheology, tribofilm: Tribofilm) -> list[str]:
        """Return no sentence: this level resolves every law."""
        return []

    def governing(self, geometry: OfShape, lubricant: Any) -> tuple[Equations, ...]:
        """Return the equations of a contact of this geometry and lubricant at this level, for documentation."""
        shared = _CAVITATION[lubricant.cavitation], _SHARING[self.criterion]
        return *_GOVERNING, geometry.deformation, geometry.load_balance, *shared

    @property
    def settings(self) -> Settings:
        """Accuracy and algorithms of a solution."""
        fitted = self.flux == "fitted"
        return Settings(self.floor, self.tolerance, self.iterations, self.fft, self.lumped, fitted)

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
        return solve_film(now, grid, replace(self.settings, iterations=most), start, step)

    def conformed(self, now: Instant, grid: Grid, fluid: Array, load: float, soft: Array) -> Array:
        """Return the pressure [Pa] of solids that give way by `soft` [m/Pa] times it, as `routes.conformed`."""
        from .routes import conformed  # the kernels: loaded where a contact is solved

        return conformed(now, grid, self.settings, fluid, load, soft)
