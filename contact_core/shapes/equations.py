"""Equations that several shapes share, for documentation."""

from ..laws.equations import Equations

HALF_SPACE = Equations(
    ("d(x, y) = 2/(π E′) ∬ p(x′, y′) [(x − x′)^2 + (y − y′)^2]^{−1/2} dx′ dy′",),
    "p is the pressure of oil and solids together.",
    title="Elastic deformation (half space)",
    source="Love 1929, doi:10.1098/rsta.1929.0009",
)
LOAD_BALANCE = Equations(("W = ∬ p dx dy",), "It determines the rigid gap h0.", title="Load balance")
PARABOLAS = "Hertz 1882; Johnson, Contact Mechanics, 1985, doi:10.1017/CBO9781139171731, section 4.1"  # of the gap
REDUCED = (
    "σ the present composite rms roughness. Heating (heat.inlet_shear), thinning (lubricant.flow) in the inlet "
    "and starvation (lubricant.supply) reduce the film."
)
ROLLING_NOTE = (
    "Smooth bodies with a flooded inlet, U = 2 η0 u_e/(E′ Rx) (Biboulet and Houpert 2010), times s, as solids hold the "
    "inlet open. Inlet heating and thinning act as a less viscous oil; of a short supply, what the inlet lacks is "
    "taken off."
)
HELD_OPEN = "s = 1 − W_c^{1/2} [1 − min(h_s/h_c, 1)^{1/2}]"
