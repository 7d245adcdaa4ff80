"""Four systems of two FMUs each, with solutions that are independent of the FMUs."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.integrate import solve_ivp

Rate = Callable[[float, np.ndarray], Sequence[float]]


@dataclass(frozen=True)
class Case:
    """Two FMUs from benchmarks/models with other start values, coupled, and what they should give.

    bond: output and input of one FMU, output and input of the other; their products are the same power. inputs: at
    the start. rate and start: the system as one. signals: the outputs that are looked at, and which state each is.
    coarsest: steps of the coarsest run. energy [J]: what ECCO's absolute tolerance counts from. errors: where work is
    compared.
    """

    name: str
    text: str
    fmus: dict[str, tuple[str, dict[str, float]]]
    connections: tuple[tuple[str, str], ...]
    bond: tuple[str, str, str, str]
    inputs: dict[str, float]
    rate: Rate
    start: tuple[float, ...]
    signals: dict[str, int]
    stop: float
    coarsest: int
    energy: float
    errors: tuple[float, ...]
    settled: float = 0.0

    def error(self, times: np.ndarray, rows: np.ndarray) -> float:
        """Largest error of the signals [times, signals] from `settled` on, over their largest values there."""
        late = times > self.settled
        if not late.any() or not np.all(np.isfinite(rows)):
            return np.inf
        return float(np.max(np.abs(rows[late] - self._exact(times[late])) / self._scale))

    def _exact(self, times: np.ndarray) -> np.ndarray:
        return self._solution(times)[list(self.signals.values())].T

    @cached_property
    def _solution(self) -> Callable[[np.ndarray], np.ndarray]:
        end = 1.2 * self.stop  # ECCO ends after the stop time
        found = solve_ivp(self.rate, (0.0, end), self.start, "DOP853", dense_output=True, rtol=1e-12, atol=1e-16)
        return found.sol

    @cached_property
    def _scale(self) -> np.ndarray:
        return np.abs(self._exact(np.linspace(self.settled, self.stop, 2001))).max(axis=0)


def oscillator(t: float, y: np.ndarray) -> Sequence[float]:
    x1, v1, x2, v2 = y
    force = 10.0 * (x2 - x1) + 0.1 * (v2 - v1)
    return v1, force - 10.0 * x1 - 0.1 * v1, v2, -force - 10.0 * x2 - 0.1 * v2


def quarter_car(t: float, y: np.ndarray) -> Sequence[float]:
    x1, v1, x2, v2 = y
    force = 15e3 * (x2 - x1) + 1e3 * (v2 - v1)
    return v1, (force + 150e3 * (0.1 - x1)) / 40.0, v2, -force / 400.0


def pressed(t: float, y: np.ndarray) -> Sequence[float]:
    x, v = y
    force = max(300.0 * (x / 1.0795e-6) ** 1.5 + 50.0 * v, 0.0) if x > 0.0 else 0.0
    return v, (300.0 - force) / 1e-3


def dragged(t: float, y: np.ndarray) -> Sequence[float]:
    x, v = y
    u = v - 0.1
    return v, -10.0 * (0.25 + 0.15 * np.exp(-abs(u) / 0.1)) * np.tanh(u / 1e-3) - 50.0 * x


CASES = (
    Case(
        name="two-mass oscillator",
        text="Two masses of 1 kg, springs of 10 N/m, dampers of 0.1 N s/m, the first displaced by 1 m; 2 s.",
        fmus={"one": ("mass_1_force", {}), "two": ("mass_2_spring", {})},
        connections=(("one.x", "two.x1"), ("one.v", "two.v1"), ("two.F", "one.F")),
        bond=("one.v", "one.F", "two.F", "two.v1"),
        inputs={"one.F": -10.0, "two.x1": 1.0, "two.v1": 0.0},
        rate=oscillator,
        start=(1.0, 0.0, 0.0, 0.0),
        signals={"one.x": 0, "one.v": 1, "two.x": 2, "two.v": 3},
        stop=2.0,
        coarsest=25,
        energy=10.0,
        errors=(1e-1, 1e-2, 1e-3),
    ),
    Case(
        name="quarter car",
        text="A wheel of 40 kg on a tyre of 150 kN/m meets a step of 0.1 m; chassis of 400 kg on 15 kN/m, 1 kN s/m; 2 s.",
        fmus={"chassis": ("chassis_spring", {}), "wheel": ("wheel_force", {"road": 0.1})},
        connections=(("wheel.x", "chassis.x_wheel"), ("wheel.v", "chassis.v_wheel"), ("chassis.F", "wheel.F")),
        bond=("wheel.v", "wheel.F", "chassis.F", "chassis.v_wheel"),
        inputs={"wheel.F": 0.0, "wheel.road": 0.1, "chassis.x_wheel": 0.0, "chassis.v_wheel": 0.0},
        rate=quarter_car,
        start=(0.0, 0.0, 0.0, 0.0),
        signals={"wheel.x": 0, "wheel.v": 1, "chassis.x": 2, "chassis.v": 3},
        stop=2.0,
        coarsest=50,
        energy=75.0,
        errors=(1e-1, 1e-2, 3e-3),
    ),
    Case(
        name="stiff contact",
        text="1 g pressed by 300 N on a Hertz contact with 50 N s/m, equilibrium at 1.0795 um; error in the second half of 1 ms.",
        fmus={"contact": ("contact_point", {}), "mass": ("point_mass", {})},
        connections=(("mass.x", "contact.x"), ("mass.v", "contact.v"), ("contact.F", "mass.F")),
        bond=("mass.v", "mass.F", "contact.F", "contact.v"),
        inputs={"mass.F": 0.0, "contact.x": 0.0, "contact.v": 0.0},
        rate=pressed,
        start=(0.0, 0.0),
        signals={"mass.x": 0},
        stop=1e-3,
        coarsest=20,
        energy=3e-4,
        errors=(1e-2, 1e-3, 1e-4),
        settled=0.5e-3,
    ),
    Case(
        name="stick-slip",
        text="1 kg on 50 N/m on a belt of 0.1 m/s under 10 N, mu 0.4 falling to 0.25, regularised over 1 mm/s; 5 s.",
        fmus={"block": ("block", {}), "friction": ("friction", {"u_r": 1e-3})},
        connections=(("block.u", "friction.u"), ("friction.F", "block.F")),
        bond=("block.u", "block.F", "friction.F", "friction.u"),
        inputs={"block.F": 10.0 * (0.25 + 0.15 * np.exp(-1.0)), "friction.u": -0.1},
        rate=dragged,
        start=(0.0, 0.0),
        signals={"block.x": 0, "block.v": 1},
        stop=5.0,
        coarsest=100,
        energy=1.0,
        errors=(1e-1, 3e-2, 1e-2),
    ),
)
