"""Scenes that have, among them, every law and every choice of the regression level."""

import random
from collections.abc import Iterator

from contact_core import Scene
from contact_core.errors import SceneError
from fmu_src.variables import variables

Change = dict[str, str]


def _slot(slot: str, **values: str) -> Change:
    return {f"{slot}.{name}": value for name, value in values.items()}


def _of(slot: str, model: str, **values: str) -> Change:
    return _slot(slot, model=model, **values)


_LUMPED = {f"heat_capacity_{i}": "2000 J/K" for i in (1, 2)} | {f"conductance_{i}": "50 W/K" for i in (1, 2)}
_ACTIVATED = "zhang_spikes_80c_octyl"

# by slot: every law, with every choice that the regression level reads
CHOICES: dict[str, list[Change]] = {
    "shape": [
        {},
        {"geometry.radius_y": "30 mm", "film.width": "1 mm"},
        {"geometry.radius_y": "5 mm"},
        {"geometry.model": "line", "geometry.face_width": "1 mm", "film.width": "0.1 mm"},
        _of("geometry", "roller", face_width="1 mm", **{"profile.model": "logarithmic", "profile.depth": "1 um"})
        | {"operation.spin": "10 rad/s"},
        {"operation.spin": "-20 rad/s"},
    ],
    "surfaces": [
        {},
        {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm"},
        {"surface_1.rq": "200 nm", "surface_1.microroughness.rms": "0 nm", "surface_2.microroughness.rms": "0 nm"},
        {"surface_1.rq": "0 nm", "surface_2.microroughness.rms": "0 nm"},
    ],
    "viscosity": [
        {},
        _of("lubricant.viscosity", "barus"),
        {"lubricant.set": "m100"},
        {"lubricant.set": "n100"},
        {"lubricant.set": "fva3"},
    ],
    "density": [{}, {"lubricant.density": "none"}],
    "rheology": [
        {},
        _of("lubricant.rheology", "eyring", limiting_coefficient="0"),
        _of("lubricant.rheology", "newtonian"),
        _of("lubricant.rheology", "newtonian", limiting_coefficient="0.05"),
        _of("lubricant.rheology", "eyring", limiting_coefficient="0.061", limiting_fall="0.0055 K^-1")
        | {"lubricant.conductivity_rise": "1.72 GPa^-1", "lubricant.conductivity_bend": "0.54 GPa^-1"},
        _of("lubricant.rheology", "carreau", critical_stress="5 MPa", exponent="0.5"),
        _of("lubricant.rheology", "carreau", critical_stress="1 MPa", exponent="0.7") | {"lubricant.flow": "local"},
    ],
    "supply": [
        {},
        _of("lubricant.supply", "film", thickness="40 nm") | {"lubricant.cavitation": "mass_conserving"},
        _of("lubricant.supply", "meniscus", distance="0.4 mm"),
    ],
    "double_layer": [
        {},
        _of(
            "lubricant.double_layer",
            "electroviscous",
            zeta_energy="4e-21 J",
            debye_length="10 nm",
            relative_permittivity="3",
            ion_radius="0.5 nm",
        ),
    ],
    "plasticity": [{}, _slot("plasticity", indentation="total"), _slot("plasticity", film_hardness="6 GPa")],
    "boundary_friction": [{}, _slot("boundary_friction", bare="0.1", film="0.1", slip_speed="1 mm/s")],
    "heat": [
        {},
        _slot("heat", inlet_shear="gupta"),
        _of("heat", "none"),
        _of("heat", "field"),
        _of("heat", "field", inlet_shear="gupta"),
    ],
    "bulk": [{}, _of("heat.bulk", "inputs"), _of("heat.bulk", "lumped", **_LUMPED)],
    "tribofilm": [
        {},
        _slot("tribofilm", dose="contact_length", nodes="stressed", least_shear="50 MPa", supply_rate="0.1 nm/s"),
        _slot("tribofilm", dose="clock", beyond_fit="extrapolate"),
        {"tribofilm.model": "none"},
        {"tribofilm.set": "andersson_90c", "tribofilm.beyond_fit": "extrapolate", "tribofilm.least_power": "1e5 W/m2"},
        {"tribofilm.set": _ACTIVATED, "tribofilm.dose": "contact_length", "tribofilm.edge_weight": "1"},
        {
            "tribofilm.set": _ACTIVATED,
            "tribofilm.least_shear": "50 MPa",
            "tribofilm.removal_coefficient": "0 1/(Pa m)",
        },
        {"tribofilm.set": "gosvami"},
        {"tribofilm.set": "gosvami", "tribofilm.dose": "contact_length", "tribofilm.supply_rate": "10 nm/s"},
        {"tribofilm.set": "combined_80c"},
        {"tribofilm.set": "combined_80c", "tribofilm.dose": "residence", "tribofilm.beyond_fit": "extrapolate"},
        {"tribofilm.set": "zddp_60_100c", "tribofilm.dose": "clock"},
        {"tribofilm.set": "zddp_60_100c", "tribofilm.dose": "contact_length", "tribofilm.beyond_fit": "extrapolate"},
        {"tribofilm.set": "zddp_80_90c", "tribofilm.dose": "residence"},
    ],
    "wear": [
        {},
        _slot("wear", sliding="surface_speed"),
        _of("wear", "film_first", thin="10 nm"),
        _of("wear", "film_first", thin="10 nm", sliding="surface_speed"),
        _of("wear", "none"),
    ],
    "oxide": [
        {},
        _of("oxide", "logarithmic"),
    ],
    "fatigue": [
        {},
        {"stress.set": "bearing_52100", "fatigue.set": "bearing_52100"},
        _of("stress", "half_space", layers="3", residual="-200 MPa") | {"fatigue.set": "bearing_52100_basquin"},
        {"stress.set": "gear_case_carburised", "stress.layers": "5", "fatigue.set": "bearing_52100_morrow"},
        {"stress.set": "bearing_52100"},
    ],
    "scuffing": [{}, {"scuffing.set": "mineral_oil"}],
    "change": [{}, {"control.change": "0.5 nm"}],
}

COSTLY = ("bulk", "fatigue")  # Python is slow where bodies warm up; classes of stress are many equations


def scene_of(changes: Change) -> Scene:
    return Scene.from_toml("mtm_zddp", changes | {"film.model": "regression"})


def inputs_of(scene: Scene) -> dict[str, float]:
    """The start values of the inputs."""
    return {v.name: v.start for v in variables(scene) if v.causality == "input"}


def merged(numbers: dict[str, int]) -> Change:
    """The changes of one choice a slot."""
    return {key: value for slot, number in numbers.items() for key, value in CHOICES[slot][number].items()}


def selection(seed: int = 0) -> Iterator[tuple[str, Change]]:
    """Scenes that contain every choice at least once, slots shuffled against one another."""
    rng = random.Random(seed)
    left = {slot: rng.sample(range(len(listed)), len(listed)) for slot, listed in CHOICES.items()}
    while any(left.values()):
        numbers = {slot: rest[-1] if rest else rng.randrange(len(CHOICES[slot])) for slot, rest in left.items()}
        for slot in COSTLY:  # once for each choice
            numbers[slot] = numbers[slot] if left[slot] else 0
        while not usable(numbers):
            slot = rng.choice([each for each in numbers if each != "tribofilm"])
            numbers[slot] = rng.randrange(len(CHOICES[slot]))
        for slot, rest in left.items():
            if numbers[slot] in rest:
                rest.remove(numbers[slot])
        yield " ".join(f"{slot}{number}" for slot, number in numbers.items() if number), merged(numbers)


def usable(numbers: dict[str, int]) -> bool:
    try:
        scene_of(merged(numbers))
    except SceneError:
        return False
    return True
