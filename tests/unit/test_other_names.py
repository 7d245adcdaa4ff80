"""Names that people write for the keys of a scene lead to the key, in one sentence."""

import copy
import tomllib
from importlib.resources import files
from typing import Any

import pytest

from contact_core import Scene, SceneError
from contact_core.scene.other_names import meant

TABLE: dict[str, Any] = {
    "geometry": {"radius_x": "10 mm"},
    "solids": {"set": "steel"},
    "surface_1": {"rq": "20 nm"},
    "surface_2": {"rq": "100 nm"},
    "lubricant": {
        "viscosity": {"viscosity_40": "46 mm2/s", "viscosity_100": "6.8 mm2/s", "density": "870 kg/m3"},
    },
    "operation": {"load": "50 N", "speed_1": "1.1 m/s", "speed_2": "0.9 m/s", "temperature": "60 degC"},
}


def refusal(path: str, key: str, other: str) -> str:
    """Return what is said of a scene with another name for a key."""
    table = copy.deepcopy(TABLE)
    place = table
    for part in path.split("."):
        place = place[part]
    place[other] = place.pop(key, "1 s")
    with pytest.raises(SceneError) as refused:
        Scene.from_dict(table)
    return str(refused.value)


@pytest.mark.parametrize(
    ("path", "key", "other", "said"),
    [
        ("geometry", "radius_x", "radius", "Did you mean 'radius_x'? It is the combined radius 1 / (1/R_1 + 1/R_2)"),
        ("geometry", "radius_x", "R1", "Did you mean 'radius_x'? It is the combined radius"),
        ("geometry", "radius_x", "diameter", "Give 'radius_x', half of it: the combined radius"),
        ("operation", "speed_1", "u1", "Did you mean 'speed_1'?"),
        ("operation", "speed_1", "velocity", "Give 'speed_1' and 'speed_2' [m/s]"),
        ("operation", "speed_2", "SRR", "u_e (1 + SRR / 2) and u_e (1 - SRR / 2)"),
        ("operation", "load", "F", "Did you mean 'load'?"),
        ("operation", "load", "hertz_pressure", "Give 'load' [N]"),
        ("operation", "temperature", "T", "Did you mean 'temperature'?"),
        ("operation", "temperature", "temp", "Did you mean 'temperature'?"),
        ("operation", "duration", "time", "Did you mean 'duration'?"),
        ("surface_1", "rq", "Rq", "Did you mean 'rq'?"),
        ("surface_2", "rq", "roughness", "Did you mean 'rq', the rms roughness?"),
        ("surface_2", "rq", "Ra", "Give 'rq', the rms roughness: of Gaussian heights 1.25 Ra."),
        ("solids", "set", "E", "Give 'reduced_modulus' [Pa], E' = 2 /"),
        ("solids", "set", "youngs_modulus", "or set = 'steel' for steel on steel."),
        ("lubricant", "viscosity", "eta", "Give the table [lubricant.viscosity] with"),
        ("lubricant", "viscosity", "alpha", "'pressure_coefficient' [GPa^-1] in [lubricant.viscosity]"),
        ("lubricant.viscosity", "viscosity_40", "KV40", "Did you mean 'viscosity_40' [mm2/s]?"),
        ("lubricant.viscosity", "viscosity_100", "vi", "follows from 'viscosity_40' and 'viscosity_100'"),
    ],
)
def test_another_name_leads_to_the_key(path: str, key: str, other: str, said: str) -> None:
    sentence = refusal(path, key, other)
    assert sentence.startswith(f"[{path}] has no key '{other}'. ")
    assert said in sentence


@pytest.mark.parametrize(("other", "said"), [("oil", "[lubricant]"), ("friction", "[boundary_friction]")])
def test_another_name_of_a_table_leads_to_it(other: str, said: str) -> None:
    with pytest.raises(SceneError, match=f"has no key '{other}'") as refused:
        Scene.from_dict(TABLE | {other: {}})
    assert said in str(refused.value)


def test_what_the_sentence_asks_for_is_not_called_missing_again() -> None:
    assert refusal("operation", "load", "force") == "[operation] has no key 'force'. Did you mean 'load'?"
    both = copy.deepcopy(TABLE)
    del both["operation"]["temperature"], both["operation"]["load"]
    both["operation"]["force"] = "50 N"
    with pytest.raises(SceneError, match=r"Did you mean 'load'\? 'operation.temperature' is missing"):
        Scene.from_dict(both)


def test_two_names_that_mean_the_same_keys_are_answered_once() -> None:
    table = copy.deepcopy(TABLE)
    del table["operation"]["speed_1"], table["operation"]["speed_2"]
    table["operation"] |= {"speed": "1 m/s", "srr": "10 %"}
    with pytest.raises(SceneError) as refused:
        Scene.from_dict(table)
    assert str(refused.value).count("Give 'speed_1' and 'speed_2'") == 1
    assert str(refused.value).endswith("[operation] has no key 'srr'.")


def test_a_name_of_no_key_is_answered_with_all_keys_and_nothing_far_off() -> None:
    sentence = refusal("operation", "load", "colour")
    assert "Did you mean" not in sentence
    assert "Known are load, speed_1" in sentence


def test_no_name_has_two_meanings_and_none_is_a_key_already() -> None:
    scene = Scene.from_toml("mtm_zddp").to_dict()
    data = (files("contact_core") / "data" / "other_names.toml").read_text("utf-8")
    for path, rows in tomllib.loads(data).items():
        names = [name for row in rows for name in row["names"].split()]
        assert len({*names}) == len(names), path
    assert not [key for key in scene if meant("", key)]
    assert not [key for key in scene["operation"] if meant("operation", key)]
