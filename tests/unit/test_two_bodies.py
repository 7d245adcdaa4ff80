"""No body comes first: a contact whose bodies change places gives each body's outputs to the other."""

from dataclasses import asdict, replace

import pytest
from cheap_scene import CHEAP
from comparison import approx

from contact_core import OperatingPoint, Scene, advance, initial_state
from contact_core.surfaces.track_means import means_of

BODIES = {
    "geometry.track_length_1": "60 mm", "geometry.track_length_2": "250 mm",
    "heat.conductivity_1": "40 W/(m.K)", "heat.conductivity_2": "20 W/(m.K)",
    "heat.diffusivity_1": "12 mm2/s", "heat.diffusivity_2": "8 mm2/s",
    "heat.bulk.heat_capacity_1": "2 J/K", "heat.bulk.heat_capacity_2": "5 J/K",
    "heat.bulk.conductance_1": "0.5 W/K", "heat.bulk.conductance_2": "0.2 W/K",
}  # fmt: skip
COMMON = CHEAP | {
    "heat.model": "field", "heat.bulk.model": "lumped", "wear.sliding": "surface_speed",
    "control.driver": "dry",
}  # fmt: skip
ROUGH = {
    "surface_1.rq": "20 nm", "surface_2.rq": "150 nm", "surface_2.correlation_length": "20 um",
    "tribofilm.beyond_fit": "extrapolate",
}  # fmt: skip
# rough ones are others where they change places, and films and wear of few instants are uneven
SMOOTH = {"surface_1.rq": "0 nm", "surface_2.rq": "0 nm", "tribofilm.model": "none"}
UNEVEN = ("roughness", "error", "suggested_step")
SIGNED = (
    "friction_force",
    "friction_solid",
    "friction_fluid",
    "dfriction_dload",
    "dfriction_dtemperature",
    "dfriction_dspeed_1",
    "dfriction_dspeed_2",
)


def swapped(table):
    other = {"1": "2", "2": "1"}

    def place(name):
        words = name.split(".")
        return ".".join(word[:-1] + other[word[-1]] if word[-2:] in ("_1", "_2") else word for word in words)

    return {place(name): value for name, value in table.items()}


@pytest.mark.parametrize(
    ("level", "surfaces", "steps", "near"),
    [("regression", ROUGH, (0.0, 5.0, 60.0), 1e-7), ("deterministic", SMOOTH, (2.0,), 3e-2)],
)
def test_bodies_that_change_places_take_their_outputs_along(level, surfaces, steps, near):
    changes, inputs = BODIES | surfaces, {"speed_1": 0.5, "speed_2": 0.3}
    found = []
    for table, point in ((changes, inputs), (swapped(changes), swapped(inputs))):
        scene = Scene.from_toml("azam_case_a", COMMON | table).at_level(level)
        op, state = OperatingPoint(load=60.0, temperature=363.0, **point), initial_state(scene)
        if level == "regression":  # whose means begin with the random roughness of the patches
            fresh = [
                replace(mean, roughness=surface.rq)
                for mean, surface in zip(means_of(scene, state), (scene.surface_1, scene.surface_2), strict=True)
            ]
            state = replace(state, means=(fresh[0], fresh[1]))
        for dt in steps:
            state, outputs = advance(scene, op, state, dt)
        found.append(asdict(outputs))
    one, other = found[0], swapped(found[1])
    for name, value in one.items():
        if level == "deterministic" and name.startswith(UNEVEN):
            continue
        sign = -1.0 if name in SIGNED else 1.0
        assert sign * other[name] == approx(value, rel=near), name
    pairs = [name[:-2] for name in one if name.endswith("_1") and one[name] != 0.0]
    assert len(pairs) > 8
    assert [name for name in pairs if one[f"{name}_1"] == one[f"{name}_2"]] == []
