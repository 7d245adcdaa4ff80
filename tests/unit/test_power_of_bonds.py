"""Power at a bond between FMUs in different units, by hand."""

from types import SimpleNamespace

import numpy as np
from comparison import approx

from system_models.master.wiring import Wiring


def reals(name: str) -> SimpleNamespace:
    return SimpleNamespace(names=[name], count=1)


def connection(source: str, target: str, factor: float = 1.0, offset: float = 0.0) -> SimpleNamespace:
    ends = {"source": SimpleNamespace(name=source, kind="real"), "target": SimpleNamespace(name=target)}
    return SimpleNamespace(**ends, factor=factor, offset=offset, sampled=False)


def test_a_bond_of_temperature_and_entropy_has_one_power_in_kelvin_and_in_degrees() -> None:
    """300 K, received as 26.85 degC, and 2 W/K, received as 2e-3 kW/K: both sides reckon 600 W."""
    heat = connection("bath.T", "body.T_in", offset=-273.15)
    entropy = connection("body.S", "bath.S_in", factor=1e-3)
    system = SimpleNamespace(
        connections=[heat, entropy], bonds=[SimpleNamespace(watt=1.0, effort=heat, flow=entropy, name="bath.T")]
    )
    instances = {
        "bath": SimpleNamespace(outputs=reals("T"), inputs=reals("S_in")),
        "body": SimpleNamespace(outputs=reals("S"), inputs=reals("T_in")),
    }
    wiring = Wiring(system, instances)  # type: ignore[arg-type]
    outputs = np.array([{"bath.T": 300.0, "body.S": 2.0}[name] for name in wiring.outputs])
    held = wiring.inputs_from(outputs)
    assert dict(zip(wiring.inputs, held, strict=True)) == approx({"body.T_in": 26.85, "bath.S_in": 2e-3})
    assert wiring.power_residuals(outputs, held) == approx([0.0], abs=1e-9)
    warmer = np.where(np.array(wiring.inputs) == "body.T_in", held + 10.0, held)
    assert wiring.power_residuals(outputs, warmer) == approx([10.0 * 2.0])  # taken at 310 K, given at 300 K
