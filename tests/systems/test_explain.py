"""`tribofmu explain`: nothing that a scene uses is missing, and every number has a source or says that it has none."""

from dataclasses import fields
from pathlib import Path

import pytest

import contact_core
from contact_core import Scene, SceneError, shipped_scenes
from contact_core.scene import Surface
from contact_core.scene.fields import SceneFields
from contact_core.scene.in_use import in_use
from contact_core.scene.origins import Kind, comments_of, origins
from contact_core.scene.toml import flat, models_of
from system_models.cli.main import main
from system_models.explain import left_out
from system_models.explain.scene import SECTIONS, explain
from system_models.explain.terminal import NARROWEST, readable, render
from system_models.explain.wording import readable as number
from system_models.machines.files import shipped
from system_models.machines.reading import read
from system_models.machines.tables import contact_of

OTHERS = {  # laws that the shipped scenes do not use
    "lubricant.set": "m100",
    "lubricant.rheology": "newtonian",
    "lubricant.density": "none",
    "lubricant.flow": "local",
    "lubricant.cavitation": "mass_conserving",
    "lubricant.supply.model": "film",
    "lubricant.supply.thickness": "1 um",
    "heat.model": "field",
    "heat.inlet_shear": "gupta",
    "heat.bulk": "lumped",
    **{f"heat.bulk.heat_capacity_{i}": "50 J/K" for i in (1, 2)},
    **{f"heat.bulk.conductance_{i}": "2 W/K" for i in (1, 2)},
    "tribofilm.set": "combined_80c",
    "tribofilm.beyond_fit": "extrapolate",
    "oxide.model": "logarithmic",
    "stress.model": "half_space",
    "fatigue.set": "bearing_52100_basquin",
    "scuffing.set": "gear_oil_clp",
    "film.model": "regression",
    "control.accuracy": "5 %",
}
CASES = [*((name, {}) for name in shipped_scenes()), ("mtm_zddp", OTHERS), ("fzg_flank", OTHERS)]


def named(explanation):
    """Return the dotted keys that an explanation tells."""
    parts = [part for section in explanation.sections for part in section.parts]
    keys = {value.key for part in parts for value in part.values}
    keys |= {f"{part.path}.model" for part in parts if part.origin}
    return keys | {absent.key for absent in explanation.left_out}


@pytest.mark.parametrize(("name", "settings"), CASES)
def test_every_value_and_every_law_of_a_scene_is_told(name, settings):
    scene, explanation = Scene.from_toml(name, settings), explain(name, settings)
    assert set(flat(scene.to_dict())) - {"name", "description", "intervals"} <= named(explanation)
    parts = {part.path: part for section in explanation.sections for part in section.parts}
    absent = {absent.key for absent in explanation.left_out}
    for law in in_use(scene):
        if law.law.source:
            assert parts[law.path].equations[0].lines
            assert parts[law.path].source == law.law.source
        else:
            assert f"{law.path}.model" in absent
    for shown in (*scene.film.governing(scene.geometry, scene.lubricant), scene.film.friction):
        assert shown.title in parts


@pytest.mark.parametrize(("name", "settings"), CASES)
def test_the_text_has_all_of_it_in_a_narrow_window(name, settings):
    explanation = explain(name, settings)
    text = render(explanation, 40)
    assert max(map(len, text.splitlines())) <= NARROWEST
    lines = " ".join(text.split())
    for section in explanation.sections:
        for part in section.parts:
            for value in part.values:
                assert value.key.rpartition(".")[2] in lines
                assert " ".join(value.shown.split()) in lines
            if part.source:
                assert " ".join(part.source.split()) in lines
            for equation in (line for shown in part.equations for line in shown.lines):
                assert all(" ".join(readable(phrase).split()) in lines for phrase in equation.split(",   "))
    for absent in explanation.left_out:
        assert " ".join(absent.cost.split()) in lines


@pytest.mark.parametrize("name", shipped_scenes())
def test_a_shipped_scene_says_of_each_number_where_it_is_from(name):
    found = origins(name, Scene.from_toml(name).to_dict())
    silent = [key for key, origin in found.items() if origin.kind is Kind.FILE and not (origin.remark or origin.source)]
    assert {key for key in silent if not key.endswith("model")} == {"name", "description"}


def test_origins_follow_sets_settings_and_accuracy():
    settings = {"heat.model": "field", "surface_1.rq": "30 nm", "control.accuracy": "5 %"}
    found = origins("mtm_zddp", Scene.from_toml("mtm_zddp", settings).to_dict(), settings)
    assert found["surface_1.rq"].kind is found["heat.model"].kind is Kind.SETTING
    assert found["heat.conductivity_1"].set_name == "steel, solids.toml"  # a setting of `model` keeps the set's values
    assert found["lubricant.viscosity.viscosity"].written == "4 mPa s"
    assert "Azam" in found["lubricant.viscosity.viscosity"].source
    assert found["lubricant.viscosity.temperature_coefficient"].word == "assumed"
    assert found["lubricant.viscosity.reference_temperature"].remark == "the thesis keeps the viscosity of case A"
    assert found["surface_1.microroughness.rms"].remark == "assumed: lapped steel"  # of an inline table
    assert found["film.points"].kind is found["control.change"].kind is Kind.ACCURACY
    assert found["film.domain"].kind is Kind.FILE
    assert found["control.longest"].word == "default"
    own = Scene.from_toml("mtm_zddp", {"lubricant.set": "m100"})
    found = origins("mtm_zddp", own.to_dict(), {"lubricant.set": "m100"})
    assert found["lubricant.viscosity.vogel_slope"].set_name == "m100, lubricants.toml"


def test_numbers_of_ones_own_scene_and_set_are_assumed_until_the_files_name_a_source(tmp_path: Path):
    (tmp_path / "fitted.toml").write_text(
        '[mine]\nsource = "my rig"\n[mine.boundary_friction]\nmodel = "film_blend"\nbare = 0.2  # assumed\nfilm = 0.1\n'
        'slip_speed = "1 um/s"\n[mine.wear]  # a paper\nmodel = "archard"\nbare = 1e-5\nfilm = 1e-6\n',
        "utf-8",
    )
    text = (Path(contact_core.__file__).parent / "data" / "scenes" / "mtm_zddp.toml").read_text("utf-8")
    text = text.replace("[surface_1]  # Rq: Azam, PhD thesis 2018, section 6.3.3", "[surface_1]")
    head, tail = text.split("[boundary_friction]")
    rest = tail[tail.index("[heat]") :]
    scene = tmp_path / "mine.toml"
    scene.write_text(f'{head}[boundary_friction]\nset = "fitted.toml:mine"\n\n{rest}', "utf-8")
    settings = {"wear.set": f"{tmp_path / 'fitted.toml'}:mine"}
    found = origins(scene, Scene.from_toml(scene, settings).to_dict(), settings)
    assert found["surface_1.rq"].word == "assumed"
    assert found["boundary_friction.film"].source == "my rig"
    assert found["boundary_friction.film"].set_name == "mine, fitted.toml"
    assert found["boundary_friction.bare"].word == "assumed"
    assert found["boundary_friction.film"].word == ""
    assert found["wear.film"].source == "a paper"  # nearer than that of the whole set


def test_comments_are_read_as_toml_has_them():
    found = comments_of(
        '# Source: a book.\nname = "a # b"  # said\n# more\n[a]  # of all\nx = 1\n# no\n[a.b]\ny = {z = "#"} # inline\n'
    )
    assert found.about == "Source: a book. more"
    assert found.by_key == {"name": "said", "a.b.y": "inline"}
    assert found.by_table == {"a": "of all"}
    assert (found.source("a.x"), found.source("a.b.y.z"), found.remark("a.b.y.z")) == ("of all", "of all", "inline")


def test_sections_hold_every_table_of_a_scene():
    tables = [table for _, tables in SECTIONS for table in tables]
    assert sorted(tables) == sorted({f.name for f in fields(SceneFields)} - {"name", "description", "intervals"})


def test_options_that_are_told_as_left_out_exist():
    parts = {f.name: f.type for f in fields(SceneFields)}
    for option, costs in left_out.OPTIONS.items():
        table, _, name = option.rpartition(".")
        assert table.partition(".")[0] in parts
        for chosen in costs:
            if name == "model":
                assert chosen in {law.name for law in models_of(table)}
                continue
            records = models_of(table) or _records(table)
            metadata = [f.metadata for record in records for f in fields(record) if f.name == name]
            assert metadata, option
            assert chosen is None or any(chosen in said["choices"] for said in metadata), option


def _records(table):
    scene = Scene.from_toml("mtm_zddp")
    return (type(getattr(scene, table)), Surface)


def test_what_is_switched_on_is_not_said_to_be_left_out():
    off = {absent.key for absent in explain("mtm_zddp").left_out}
    on = {absent.key for absent in explain("mtm_zddp", OTHERS).left_out}
    assert {"lubricant.flow", "heat.inlet_shear", "oxide.model", "stress.model", "fatigue.model"} <= off - on
    assert {"surface_1.microroughness", "solids.film_modulus"} & off == {"solids.film_modulus"}
    assert "surface_1.microroughness" in {absent.key for absent in explain("mtm_zddp_thesis").left_out}
    assert "film.model" in on - off


def test_the_command_prints_it_and_refuses_errors(capsys):
    assert main(["explain", "mtm_zddp", "--set", "wear.model=none"]) == 0
    said = capsys.readouterr().out
    assert said.startswith("mtm_zddp: Azam's case B")
    assert "(wear.model: none)" in said
    assert main(["explain", "mtm_zdd"]) == 2
    assert "Did you mean 'mtm_zddp'?" in capsys.readouterr().err
    with pytest.raises(SceneError, match="no key"):
        explain("mtm_zddp", {"wear.bar": "1"})


OF_A_KIND = ("mtm_rig", "bearing_209", "gear_fzg_c")  # the others of their kinds, and what takes as long, in .ci/full


@pytest.mark.parametrize(
    "name", [name if name in OF_A_KIND else pytest.param(name, marks=pytest.mark.long) for name in shipped()]
)
def test_of_a_machine_the_command_tells_the_contact_as_its_file_changes_it(name, capsys):
    assert main(["explain", name, "--set", "contact.control.longest=100 s"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    base, changes = contact_of(read(name, {"contact.control.longest": "100 s"}).table)
    assert f"The contact of this machine is the scene {base}," in said
    assert "longest 100 s set" in said
    assert f"tribofmu run {name} " in said
    found = origins(base, Scene.from_toml(base, changes).to_dict(), changes)
    changed = {key for key, origin in found.items() if origin.kind is Kind.SETTING}
    assert {key for key in changes if not key.endswith((".set", ".bulk"))} <= changed


@pytest.mark.parametrize(
    ("value", "unit", "shown"),
    [
        (1.5e-9, "m/s", "1.5 nm/s"),
        (6e9, "Pa", "6 GPa"),
        (2e-10, "m", "0.2 nm"),
        (0.0, "m", "0 m"),
        (0.14, "W/(m K)", "0.14 W/(m K)"),
    ],
)
def test_numbers_have_prefixes_that_people_read(value, unit, shown):
    assert number(value, unit) == shown


def test_powers_are_written_as_superscripts():
    assert readable("p_{max}^2 (x^{−12} + y^{1/2})") == "p_max² (x⁻¹² + y^{1/2})"
