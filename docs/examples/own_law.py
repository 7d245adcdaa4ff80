"""A law of your own in a contact: McEwen's viscosity, softer under pressure than Barus', gives less friction."""

from dataclasses import dataclass, replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from contact_core import Scene, advance, initial_state
from contact_core.laws.viscosity import Barus
from contact_core.quantities import parameter


@dataclass(frozen=True)
class McEwen(Barus):
    """eta = eta_0 (1 + alpha p / q)^q, falling with temperature as Barus' law does."""

    name = "mcewen"
    exponent: float = parameter("", "q, where the curve bends; infinite: Barus' law", above=1.0, most=1e4, default=14.0)

    def __call__(self, pressure, temperature):
        """Return the viscosity [Pa s] at pressures [Pa] and temperatures [K]."""
        stiffer = (1.0 + self.pressure_coefficient * pressure / self.exponent) ** self.exponent
        return super().__call__(0.0 * pressure, temperature) * stiffer


scene = Scene.from_toml(
    "mtm_zddp", {"film.model": "regression", "operation.speed_1": "1.1 m/s", "operation.speed_2": "0.9 m/s"}
)
constants = {
    "viscosity": 0.0157,
    "reference_temperature": 353.15,
    "pressure_coefficient": 17.9e-9,
    "temperature_coefficient": 0.03,
}
oils = {"Barus": Barus(**constants), "McEwen": McEwen(**constants)}
pressures = np.linspace(0.0, 1.2e9, 61)
figure, axis = plt.subplots(figsize=(6.0, 3.6), layout="constrained")
found = {}
for name, oil in oils.items():
    now = replace(scene, lubricant=replace(scene.lubricant, viscosity=oil))
    _, found[name] = advance(now, now.operation.point, initial_state(now), 1e-6)
    label = f"{name}: friction {found[name].friction_coefficient:.3f}, film {1e9 * found[name].h_c:.0f} nm"
    print(label)
    axis.semilogy(1e-9 * pressures, oil(pressures, np.full(61, 353.15)), label=label)
axis.set(xlabel="pressure [GPa]", ylabel="viscosity at 80 degC [Pa s]")
axis.legend()
figure.savefig(Path(__file__).with_suffix(".png"), dpi=100)
